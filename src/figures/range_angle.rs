//! Figures 2-4, 2-5, 2-8, 2-9, 2-11, 2-12 (four points) and 3-4 to 3-7 (the maps of one scene).

use super::sheet::{PanelContent, Sheet, SheetAxis, SheetCells, SheetPanel};
use super::source::{FigureError, ScenePictures, SceneSource};
use crate::evaluate::TARGET_ETA;
use crate::maps::{ComplexMap, Normalisation, RangeAngleMap, channels_map};
use crate::picture::ColourMap;
use crate::radar::End;
use crate::scene::generate::Kind;
use ndarray::{Array2, s};
use std::f64::consts::{PI, TAU};

const FOUR_REFLECTORS: &str = "four-reflectors";
const LARGE_PANEL_PIXELS: (u32, u32) = (700, 520);

pub fn four_points(source: &SceneSource) -> Result<Sheet, FigureError> {
    let scene = super::source::preset(FOUR_REFLECTORS)?;
    Ok(Sheet::of(1, (800, 440), vec![source.scene_panel("Four equal points", &scene)]))
}

/// The radar matrix, and the delta peaks that infinite observation would give.
pub fn radar_matrix(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.preset(FOUR_REFLECTORS)?;
    let real: Array2<f64> = seen.signal.samples.slice(s![..;4, ..;2]).mapv(|v| v.re);
    let peak = real.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let matrix = SheetCells {
        x: SheetAxis::new("sample", 0.0, source.radar.samples as f64),
        y: SheetAxis::new("element", 0.0, source.radar.elements as f64),
        values: real.mapv(|v| (0.5 + 0.5 * v / peak) as f32),
        colours: ColourMap::Diverging,
        ends_of_bar: Some(("-1", "+1")),
        rings: Vec::new(),
    };
    let polar = seen.scene.reflectors().into_iter().map(|r| source.radar.polar_of(r.x_metres, r.y_metres));
    let rings = polar.map(|p| (p.cos_theta, p.range_metres)).collect();
    let empty = Array2::zeros((2, 2));
    let mut ideal = source.cells_panel("Ideal range-angle plot: four deltas (ringed)", empty, ColourMap::Grey, None);
    if let PanelContent::Cells(cells) = &mut ideal.content {
        cells.rings = rings;
    }
    Ok(Sheet::of(2, (620, 460), vec![SheetPanel::cells("Real part of the samples", matrix), ideal]))
}

/// The map of the four points, chosen as in [`map_of`].
pub fn four_points_map(source: &SceneSource, of: usize, title: &str) -> Result<Sheet, FigureError> {
    Ok(map_of(source, &source.preset(FOUR_REFLECTORS)?, of, title))
}

/// Λ of the first end (0), the last end (1) or the whole array (2).
pub fn map_of(source: &SceneSource, seen: &ScenePictures, of: usize, title: &str) -> Sheet {
    Sheet::of(1, LARGE_PANEL_PIXELS, vec![source.lambda_panel(title, &seen.lambda[of])])
}

pub fn thresholded(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.preset(FOUR_REFLECTORS)?;
    Ok(Sheet::of(1, LARGE_PANEL_PIXELS, vec![source.above_panel("Λ > 0.9", &seen.lambda[2], TARGET_ETA)]))
}

pub fn cartesian(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.preset(FOUR_REFLECTORS)?;
    let panel =
        source.cartesian_panel("512 samples × 1024 elements, from above", &seen.lambda[2], ColourMap::default());
    Ok(Sheet::of(1, (800, 460), vec![panel]))
}

pub fn truth_and_maps(source: &SceneSource) -> Result<Sheet, FigureError> {
    let seen = source.test_scene(Kind::Set3, 1)?;
    let [first, last, full] = &seen.lambda;
    let panels = vec![
        source.scene_panel("Ground truth", &seen.scene),
        source.lambda_panel("log |Y|, 1024 elements", full),
        source.lambda_panel("log |Y0|, elements 0 to 11", first),
        source.lambda_panel("log |Y1|, elements 1012 to 1023", last),
    ];
    Ok(Sheet::of(2, (560, 420), panels))
}

fn first_end(source: &SceneSource) -> Result<ComplexMap, FigureError> {
    let seen = source.test_scene(Kind::Set3, 1)?;
    Ok(channels_map(&source.radar, seen.signal.end(&source.radar, End::First)))
}

pub fn magnitude_and_phase(source: &SceneSource) -> Result<Sheet, FigureError> {
    let map = first_end(source)?;
    let magnitude = map.log_magnitude().normalise(Normalisation::MinMax);
    let phase = map.cells.mapv(|v| ((v.arg() + PI) / TAU) as f32);
    let panels = vec![
        source.lambda_panel("log |Y0|", &magnitude),
        source.cells_panel("arg Y0", phase, ColourMap::Viridis, Some(("-π", "+π"))),
    ];
    Ok(Sheet::of(2, (560, 420), panels))
}

pub fn cosine_sine_lambda(source: &SceneSource) -> Result<Sheet, FigureError> {
    let map = first_end(source)?;
    let part = |f: fn(f64) -> f64| map.cells.mapv(|v| (0.5 + 0.5 * f(v.arg())) as f32);
    let lambda: RangeAngleMap = map.log_magnitude().normalise(Normalisation::MinMax);
    let bar = Some(("-1", "+1"));
    let panels = vec![
        source.cells_panel("cos(arg Y0)", part(f64::cos), ColourMap::Diverging, bar),
        source.cells_panel("sin(arg Y0)", part(f64::sin), ColourMap::Diverging, bar),
        source.lambda_panel("Λ'0", &lambda),
    ];
    Ok(Sheet::of(3, (500, 400), panels))
}
