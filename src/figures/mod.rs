//! Every figure of the thesis that shows data, drawn from this program's; the others are kept as drawn.
//!
//! A figure is a function from a [`SceneSource`] of simulated data to a [`Sheet`](sheet::Sheet) of panels; `draw` draws sheets, [`pages`]
//! the page of all figures. [`ALL`] lists the figures with their subjects and their differences from the printed ones.

mod draw;
mod outputs;
pub mod pages;
mod range_angle;
pub mod sheet;
mod source;
mod waves;

pub use source::{FigureError, SceneSource};

use crate::scene::generate::Kind;
use sheet::Sheet;

type SheetOf = fn(&SceneSource) -> Result<Sheet, FigureError>;

pub struct Figure {
    /// Its number in the thesis, as `4-7`.
    pub number: &'static str,
    pub shows: &'static str,
    /// The differences from the printed figure, and their reasons.
    pub differs: &'static str,
    /// `None` for a picture without simulated data, which is kept as drawn in `docs/figures`.
    pub sheet: Option<SheetOf>,
}

const fn figure((number, sheet): (&'static str, SheetOf), shows: &'static str, differs: &'static str) -> Figure {
    Figure { number, shows, differs, sheet: Some(sheet) }
}

const fn kept(number: &'static str, shows: &'static str, differs: &'static str) -> Figure {
    Figure { number, shows, differs, sheet: None }
}

const SCENE_OPEN: &str = "The printed scene's places are not given; these are the preset \"four-reflectors\".";
const TEST_SCENE: &str = "The printed scene is not given; this is a test scene of seed 0. `live` and `hybrid` are added for comparison, \
the thesis' network has a quarter of its filters.";
const MAP_SCENE: &str = "The printed scene is not given; this is test scene 1 of set 3, seed 0.";

pub const ALL: &[Figure] = &[
    figure(
        ("1-2", waves::band_sparsity),
        "A signal that is non-zero in a few bands only: the prior of multi-coset imaging.",
        "A beat signal of three groups of points stands for the printed drawing; reflectivities rise with range squared so that all bands are equally high.",
    ),
    kept(
        "1-3",
        "Nearly random element placement on the aperture, as that prior needs.",
        "Elements keep to the half-wavelength grid; the two ends and the whole array stand beside them.",
    ),
    kept(
        "1-4",
        "A 3 × 4 MIMO array and its 12 virtual elements.",
        "The pair that each virtual element stands for is written beneath it.",
    ),
    kept(
        "2-1",
        "Transmitted and received chirp over time, and the mixer's constant difference frequency.",
        "The chirp's duration is not given; 1 µs is chosen, far shorter than a real one, so that the delay of 21 m can be seen.",
    ),
    figure(
        ("2-2", waves::range_profile),
        "Range profile, the transform of one element's samples, of a point at 21 m.",
        "In decibels, over no floor, so that the side lobes show.",
    ),
    kept(
        "2-3",
        "A plane wave on a uniform array: the path differs by d cos θ from element to element.",
        "Drawn for θ = 60 degrees.",
    ),
    figure(
        ("2-4", range_angle::four_points),
        "Four points in Cartesian coordinates, the scene of figures 2-5, 2-8, 2-9, 2-11 and 2-12.",
        SCENE_OPEN,
    ),
    figure(
        ("2-5", range_angle::radar_matrix),
        "The radar matrix, and the delta peaks that infinite observation would give.",
        "The matrix shows every second sample of every fourth element; the deltas are ringed, since a single cell could not be seen.",
    ),
    figure(
        ("2-6", waves::windows),
        "Windows of length 64 and their transforms.",
        "The four windows that a radar can be given here.",
    ),
    figure(
        ("2-7", waves::angle_spectra),
        "Angle spectrum at one range with 12 and with 1024 elements: two points at cos θ = 0.35 and 0.5, merged and apart.",
        "The range is not given; at 20 m chosen here the array is in its near field, so each point is a plateau of about 40 columns, and 2.6 % nearer to the middle (the squint of the thesis' convention).",
    ),
    figure(
        ("2-8", |source| range_angle::four_points_map(source, 2, "512 samples × 1024 elements")),
        "Range-angle plot of the four points, 512 samples × 1024 elements.",
        SCENE_OPEN,
    ),
    figure(
        ("2-9", |source| range_angle::four_points_map(source, 0, "512 samples × 12 elements")),
        "The same with 12 elements.",
        SCENE_OPEN,
    ),
    kept(
        "2-10",
        "The plane-wave assumption against true paths for a near reflector.",
        "Nine elements stand for the array; the place is chosen.",
    ),
    figure(
        ("2-11", range_angle::thresholded),
        "Figure 2-8 above a threshold: patches of different shapes for identical points.",
        "The threshold is not given; 0.9, the target's own, is chosen.",
    ),
    figure(
        ("2-12", range_angle::cartesian),
        "Figure 2-8 projected into Cartesian coordinates: resolution falls towards the edge of the field of view.",
        SCENE_OPEN,
    ),
    kept("3-1", "The U-Net.", "The shipped U-Net's own sizes; the printed one's are not all given."),
    figure(
        ("3-2", outputs::unet_on_training),
        "The U-Net on a training sample, thresholded and Cartesian: its output is near zero.",
        "The shipped U-Net was trained here, at a size two processor cores can train, and fails alike.",
    ),
    kept(
        "3-3",
        "The encoder-decoder.",
        "Sizes are those of the author's program (128 × 16 × 32 in the middle); the text's 64 × 16 × 32 does not follow from its own layers.",
    ),
    figure(
        ("3-4", range_angle::truth_and_maps),
        "Ground truth, the whole array's map and both ends' of one scene.",
        MAP_SCENE,
    ),
    figure(
        ("3-5", |source| {
            Ok(range_angle::map_of(source, &source.test_scene(Kind::Set3, 1)?, 2, "Λ of all 1024 elements"))
        }),
        "Λ of the whole array for that scene.",
        MAP_SCENE,
    ),
    figure(("3-6", range_angle::magnitude_and_phase), "Magnitude and phase of the first end's map.", MAP_SCENE),
    figure(("3-7", range_angle::cosine_sine_lambda), "Cosine and sine of that phase, and Λ'0.", MAP_SCENE),
    kept("3-8", "Flow chart: scene, simulation, ends and whole, transforms, network, loss.", "Redrawn."),
    figure(
        ("4-1", |source| outputs::beside(source, &source.test_scene(Kind::Set2, 0)?, outputs::EXPERIMENT_1)),
        "Experiment 1's network on set 2: inputs, target, output.",
        TEST_SCENE,
    ),
    figure(
        ("4-2", |source| outputs::beside(source, &source.test_scene(Kind::Set3, 0)?, outputs::EXPERIMENT_1)),
        "Experiment 1's network on set 3, whose lines it never saw.",
        TEST_SCENE,
    ),
    figure(
        ("4-3", outputs::merged_and_apart),
        "Experiment 1 against experiment 2 on one scene: two points at range 31 m, merged and apart.",
        "The angles are not given; cos θ = 0.3 and 0.4 are chosen. At a quarter of the filters neither network keeps them apart as the printed experiment 2 does.",
    ),
    figure(
        ("4-4", |source| outputs::beside(source, &source.test_scene(Kind::Set2, 0)?, outputs::EXPERIMENT_2)),
        "Experiment 2's network on set 2.",
        TEST_SCENE,
    ),
    figure(
        ("4-5", |source| outputs::beside(source, &source.test_scene(Kind::Set1, 0)?, outputs::EXPERIMENT_2)),
        "Experiment 2's network on set 1.",
        TEST_SCENE,
    ),
    figure(
        ("4-6", |source| outputs::beside(source, &source.test_scene(Kind::Set3, 0)?, outputs::EXPERIMENT_2)),
        "Experiment 2's network on set 3.",
        TEST_SCENE,
    ),
    figure(
        ("4-7", outputs::thresholds),
        "Experiment 2's network on set 3 before and after thresholds of 0.7 and 0.9.",
        TEST_SCENE,
    ),
    figure(
        ("4-8", outputs::baseline),
        "The baseline: Λ0 above 0.9 beside the target above 0.9.",
        "The printed scene is not given; this is test scene 0 of set 3, seed 0.",
    ),
    kept(
        "5-1",
        "Two deltas; an estimate shifted by one sample and a flat one have the same squared error of 4.",
        "The flat estimate's level follows from 512 samples.",
    ),
    kept(
        "5-2",
        "A sparse and a denser signal, each estimated 1.2 times too large: the denser one's squared error is larger.",
        "Two and ten points are chosen.",
    ),
    figure(
        ("5-3", |source| outputs::beside(source, &source.preset("points-by-a-line")?, outputs::EXPERIMENT_2)),
        "Points beside a line, reconstructed as a line.",
        "The preset \"points-by-a-line\"; `live` and `hybrid` are added.",
    ),
    figure(
        ("5-4", outputs::a_tenth_of_a_radian),
        "Λ0 of one point at (0, 20) m and of one a tenth of a radian off: alike in the middle, different at the edges.",
        "Their difference is added.",
    ),
    figure(
        ("5-5", |source| outputs::beside(source, &source.preset("gaussian-clusters")?, outputs::EXPERIMENT_2)),
        "Experiment 2's network on Gaussian clusters: detected, drawn as vertical lines.",
        "The preset \"gaussian-clusters\"; `live` and `hybrid` are added.",
    ),
    kept(
        "5-6",
        "Fields of view of the two ends, and where they overlap.",
        "The ends are drawn far apart, and 50 degrees are chosen for half the angle.",
    ),
    figure(
        ("5-7", outputs::hidden),
        "A point hidden behind a line for one end.",
        "Above, points cast no shadows: what hides the point are the line's side lobes, through which the whole array sees it. Below, a wall hides a point from the last end, to which its echo is 40 dB weaker, and not from the first. Every map is normalised by itself, over about 200 dB, so that 40 dB are a fifth of Λ.",
    ),
    figure(
        ("6-1", outputs::cylinder_and_cube),
        "A cylinder and a cube at an angle.",
        "The printed one is a ray-tracing solver's, at 40 minutes a scene, and its sizes are not given; here physical optics in the plane takes a moment. The preset \"cylinder-and-cube\".",
    ),
];

pub fn by_number(number: &str) -> Option<&'static Figure> {
    ALL.iter().find(|f| f.number == number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_figure_of_the_thesis_is_listed_once() {
        let counts = [(1, 2..=4), (2, 1..=12), (3, 1..=8), (4, 1..=8), (5, 1..=7), (6, 1..=1)];
        let wanted: BTreeSet<String> =
            counts.into_iter().flat_map(|(c, f)| f.map(move |f| format!("{c}-{f}"))).collect();
        let listed: BTreeSet<String> = ALL.iter().map(|f| f.number.to_owned()).collect();
        assert_eq!(listed, wanted);
        assert_eq!(ALL.len(), wanted.len());
        assert!(ALL.iter().all(|f| f.shows.ends_with('.') && f.differs.ends_with('.')), "sentences");
    }

    #[test]
    fn figures_without_a_search_are_drawn() {
        const SLOW: [&str; 10] = ["3-2", "4-1", "4-2", "4-3", "4-4", "4-5", "4-6", "4-7", "5-3", "5-5"];
        let source = SceneSource::default();
        for figure in ALL.iter().filter(|f| !SLOW.contains(&f.number)) {
            let Some(sheet) = figure.sheet else {
                let picture = format!("{}/docs/figures/{}.png", env!("CARGO_MANIFEST_DIR"), figure.number);
                assert!(std::path::Path::new(&picture).exists(), "{picture}");
                continue;
            };
            let sheet = sheet(&source).unwrap_or_else(|e| panic!("figure {}: {e}", figure.number));
            assert!(!sheet.panels.is_empty());
            let png = crate::picture::PictureFormat::Png
                .bytes_of(&sheet)
                .unwrap_or_else(|e| panic!("figure {}: {e}", figure.number));
            let picture = image::load_from_memory(&png).unwrap().to_rgb8();
            let ink = picture.pixels().filter(|p| p.0 != picture.get_pixel(1, 1).0).count();
            assert!(ink > 2000, "figure {}: {ink} pixels of ink", figure.number);
        }
    }
}
