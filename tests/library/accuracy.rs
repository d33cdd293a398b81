//! How trust is built: the judge (double-double) is checked against known phasors in its own file and against the plain formula
//! here; the exact path is held to the judge; the transforms are held to a sum written out; and the plain f64 formula is shown to
//! leave the rounding floor on which the thesis' tables stand.

use apertura::maps::{Aperture, LogMap, angle_transform, range_transform};
use apertura::radar::{End, Radar, hann};
use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
use apertura::scene::{Reflector, Scene};
use apertura::signal::{BeatSignal, direct, exact, floor, judge};
use ndarray::Array2;
use num_complex::Complex64;
use std::f64::consts::TAU;

fn test_scene(kind: Kind, number: u32) -> Scene {
    Generator::new(&Radar::default(), Reading::Program, Purpose::Test, 21).scene(kind, number)
}

/// Largest difference from the judge over a few elements, relative to the judge's largest sample there.
fn error_against_judge(radar: &Radar, reflectors: &[Reflector], signal: &BeatSignal) -> f64 {
    let (mut error, mut peak) = (0.0f64, 0.0f64);
    for element in [0, 11, 511, 777, 1023] {
        for (judged, found) in judge::element_signal(radar, reflectors, element).iter().zip(signal.samples.row(element))
        {
            error = error.max((judged - found).norm());
            peak = peak.max(judged.norm());
        }
    }
    error / peak
}

#[test]
fn the_exact_path_is_within_1e_13_of_the_judge() {
    let radar = Radar::default();
    for (kind, number) in [(Kind::Set1, 0), (Kind::Set1, 1), (Kind::Set2, 0), (Kind::Set3, 0)] {
        let reflectors = test_scene(kind, number).reflectors();
        let error = error_against_judge(&radar, &reflectors, &exact::beat_signal(&radar, &reflectors));
        assert!(error <= 1e-13, "{kind:?} {number}: {error:e}");
    }
}

#[test]
fn the_plain_formula_agrees_with_the_judge_up_to_its_rounding() {
    let radar = Radar::default();
    let reflectors = test_scene(Kind::Set2, 1).reflectors();
    let error = error_against_judge(&radar, &reflectors, &direct::beat_signal(&radar, &reflectors));
    assert!((1e-13..1e-10).contains(&error), "phases of 6e4 rad cost about 1e-11, found {error:e}");
}

#[test]
fn transforms_equal_the_written_out_sum() {
    let radar = Radar { samples: 16, elements: 24, end_elements: 5, ..Radar::default() };
    let value = |n: usize, n1: usize| Complex64::from_polar(1.0 + n as f64, (n * n + 3 * n1) as f64);
    let signal = BeatSignal { samples: Array2::from_shape_fn((24, 16), |(n, n1)| value(n, n1)) };
    let profiles = range_transform(&radar, &signal);
    for (aperture, elements) in
        [(Aperture::Full, 0..24), (Aperture::End(End::First), 0..5), (Aperture::End(End::Last), 19..24)]
    {
        let map = angle_transform(&radar, &profiles, aperture);
        let (over_range, over_elements) = (hann(16), hann(elements.len()));
        for ((k1, column), found) in map.cells.indexed_iter() {
            let k2 = (column + 12) % 24;
            let mut sum = Complex64::default();
            for ((i, n), element_weight) in elements.clone().enumerate().zip(&over_elements) {
                for (n1, range_weight) in over_range.iter().enumerate() {
                    let turns = (k1 * n1) as f64 / 16.0 + (k2 * i) as f64 / 24.0;
                    let weight = range_weight * element_weight;
                    sum += value(n, n1) * weight * Complex64::from_polar(1.0, -TAU * turns);
                }
            }
            sum /= (16.0f64 * 24.0).sqrt();
            assert!((sum - found).norm() < 1e-12, "{aperture:?} [{k1}, {column}]: {found} for {sum}");
        }
    }
}

fn full_map(radar: &Radar, signal: &BeatSignal) -> LogMap {
    angle_transform(radar, &range_transform(radar, signal), Aperture::Full).log_magnitude()
}

/// Mean over scenes of the smallest and of the median cell of log10|Y|.
fn floor_levels(kind: Kind, scenes: u32, simulate: impl Fn(&Radar, &[Reflector], u64) -> BeatSignal) -> (f64, f64) {
    let radar = Radar::default();
    let (mut min, mut median) = (0.0, 0.0);
    for number in 0..scenes {
        let map = full_map(&radar, &simulate(&radar, &test_scene(kind, number).reflectors(), number.into()));
        min += map.min() / f64::from(scenes);
        median += map.median() / f64::from(scenes);
    }
    (min, median)
}

/// The measured levels of the thesis' floor: the smallest cell lies at about -15.6 decades on set 1 and -15.0 on set 2.
#[test]
fn the_plain_formula_leaves_the_thesis_floor() {
    for (kind, min) in [(Kind::Set1, -15.6), (Kind::Set2, -15.0)] {
        let plain = floor_levels(kind, 12, |radar, reflectors, _| direct::beat_signal(radar, reflectors));
        assert!((plain.0 - min).abs() < 0.4, "{kind:?}: smallest cell {:.2} for about {min}", plain.0);
    }
}

/// With exact phases a single point's floor drops by more than two decades, to where the judge puts it.
#[test]
fn exact_phases_lower_the_floor() {
    let exact = floor_levels(Kind::Set1, 12, |radar, reflectors, _| exact::beat_signal(radar, reflectors));
    let judged = floor_levels(Kind::Set1, 2, |radar, reflectors, _| judge::beat_signal(radar, reflectors));
    assert!((exact.0 + 18.0).abs() < 0.7, "smallest cell {:.2} for about -18", exact.0);
    assert!((judged.0 + 18.0).abs() < 1.0, "judged smallest cell {:.2} for about -18", judged.0);
}

/// White noise of the matched variance may stand for the rounding error: same smallest and same median cell.
#[test]
fn matched_noise_is_as_deep_as_the_thesis_floor() {
    let plain = floor_levels(Kind::Set1, 8, |radar, reflectors, _| direct::beat_signal(radar, reflectors));
    let matched = floor_levels(Kind::Set1, 8, |radar, reflectors, seed| {
        let mut signal = exact::beat_signal(radar, reflectors);
        floor::add_noise(&mut signal, &floor::thesis_noise_variance(radar, reflectors), seed);
        signal
    });
    assert!((plain.0 - matched.0).abs() < 0.3, "smallest cell: {plain:?} and {matched:?}");
    assert!((plain.1 - matched.1).abs() < 0.1, "median cell: {plain:?} and {matched:?}");
}
