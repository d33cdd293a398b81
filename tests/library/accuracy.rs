//! Accuracy, step by step: the exact path is held to the judge (double-double, held to known phasors in its own file), the transforms to a sum
//! written out, and the plain f64 formula leaves the rounding floor on which the thesis' tables stand.

use crate::prelude::*;
use apertura::evaluate::Estimate;
use apertura::radar::hann;
use apertura::signal::{direct, exact};
use rayon::prelude::*;
use std::f64::consts::PI;

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

fn smallest_cell(kind: Kind, scenes: u32, simulate: impl Fn(&Radar, &[Reflector]) -> BeatSignal) -> f64 {
    let radar = Radar::default();
    let of_scene = |number| full_map(&radar, &simulate(&radar, &test_scene(kind, number).reflectors())).min();
    (0..scenes).map(of_scene).sum::<f64>() / f64::from(scenes)
}

/// The measured levels of the thesis' floor: the smallest cell lies at about -15.6 decades on set 1 and -15.0 on set 2.
#[test]
fn the_plain_formula_leaves_the_thesis_floor() {
    for (kind, min) in [(Kind::Set1, -15.6), (Kind::Set2, -15.0)] {
        let plain = smallest_cell(kind, 12, |radar, reflectors| direct::beat_signal(radar, reflectors));
        assert!((plain - min).abs() < 0.4, "{kind:?}: smallest cell {plain:.2} for about {min}");
    }
}

#[test]
fn exact_phases_lower_the_floor() {
    let exact = smallest_cell(Kind::Set1, 12, |radar, reflectors| exact::beat_signal(radar, reflectors));
    let judged = smallest_cell(Kind::Set1, 2, |radar, reflectors| judge::beat_signal(radar, reflectors));
    assert!((exact + 18.0).abs() < 0.7, "smallest cell {exact:.2} for about -18");
    assert!((judged + 18.0).abs() < 1.0, "judged smallest cell {judged:.2} for about -18");
}

/// The author's formula in the order of the author's program, whose f64 rounding is the floor of the thesis' tables: [elements, samples].
fn by_the_authors_program(radar: &Radar, reflectors: &[Reflector]) -> BeatSignal {
    const WAVELENGTH: f64 = 299.792458 / 77.0 * 0.001;
    let (light, bandwidth, samples, elements) = (299_792_458.0, 2e9, radar.samples, radar.elements);
    let antenna_x = |n: usize| n as f64 * (WAVELENGTH / 2.0) - (elements - 1) as f64 * (WAVELENGTH / 2.0) / 2.0;
    let mut signal = BeatSignal::silence(radar);
    for Reflector { x_metres, y_metres, reflectivity } in reflectors {
        let range = |n: usize| {
            let x = antenna_x(n) - x_metres;
            (x * x + y_metres * y_metres).sqrt()
        };
        let first_range = range(0);
        let first_phase = -2.0 * PI * first_range / WAVELENGTH;
        signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
            let range = range(n);
            let carrier = first_phase + -2.0 * PI * (range - first_range) / WAVELENGTH;
            let amplitude = 100.0 * reflectivity / (range * range);
            for (i, sample) in row.iter_mut().enumerate() {
                let phase = (2.0 * PI * i as f64 / samples as f64) * (range * 2.0 * bandwidth / light) + carrier;
                *sample += Complex64::new(phase.cos(), phase.sin()) * amplitude;
            }
        });
    }
    signal
}

/// Decades of amplitude that 2 % of the map's cells stay below.
fn dark_decades(radar: &Radar, signal: &BeatSignal) -> f64 {
    let mut cells: Vec<f64> = full_map(radar, signal).decades().iter().copied().collect();
    let at = cells.len() / 50;
    *cells.select_nth_unstable_by(at, f64::total_cmp).1
}

#[test]
fn the_floor_is_as_dark_as_the_authors_on_few_scenes() {
    let radar = Radar::default();
    for kind in Kind::TEST_SETS {
        let louder = (0..3).map(|number| {
            let scene = test_scene(kind, number);
            let floor = simulate(&radar, &scene, Floor::Thesis, scene.noise_seed).unwrap();
            dark_decades(&radar, &floor) - dark_decades(&radar, &by_the_authors_program(&radar, &scene.reflectors()))
        });
        let louder = Estimate::of(&louder.collect::<Vec<_>>());
        assert!(louder.mean.abs() < 0.03, "set {kind}: {louder:?}");
    }
}
