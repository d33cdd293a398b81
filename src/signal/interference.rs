//! Somebody else's chirp in our receivers.

use super::samples::BeatSignal;
use crate::radar::{BuiltArray, Radar};
use crate::scene::Interferer;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// How steeply the receiver's filter cuts: gain `1 / sqrt(1 + (2f)^(2 n))` at f turns a sample.
const FILTER_ORDER: i32 = 8;

/// Adds what each element hears of `interferer`: where its frequency comes near ours the difference is a chirp of its own, through zero at
/// `crossing`, which the receiver's filter lets pass while it is below half a turn a sample.
///
/// The waves come one way only: an element's phase follows the wavelength once, whichever way echoes are counted.
pub fn add_interference(radar: &Radar, array: &BuiltArray, interferer: &Interferer, signal: &mut BeatSignal) {
    let samples = radar.samples as f64;
    let sweep = 1.0 / (interferer.duration * samples);
    let chirp: Vec<Complex64> = (0..radar.samples)
        .map(|k| {
            let since = k as f64 - interferer.crossing * samples;
            let turns_a_sample = sweep * since;
            let gain = 1.0 / (1.0 + (2.0 * turns_a_sample).powi(2 * FILTER_ORDER)).sqrt();
            Complex64::from_polar(gain, TAU * (0.5 * sweep * since * since).fract())
        })
        .collect();
    let way = radar.carrier.turns_per_wavelength().signum();
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut heard)| {
        let distance = (interferer.x_metres - array.element_x_metres(radar, n)).hypot(interferer.y_metres);
        let amplitude = radar.transmit_power_watts * interferer.strength / distance;
        let turns = (way * distance / radar.wavelength_metres()).fract();
        let factor = Complex64::from_polar(amplitude, TAU * turns);
        heard.iter_mut().zip(&chirp).for_each(|(v, c)| *v += factor * c);
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::LogMaps;
    use crate::scene::{Disturbances, Scene};
    use crate::signal::{Floor, simulate};

    fn radar() -> Radar {
        Radar { elements: 128, samples: 256, ..Radar::default() }
    }

    fn scene(interferer: Interferer) -> Scene {
        let disturbances = Disturbances { interferer: Some(interferer), ..Disturbances::default() };
        Scene { disturbances, ..Scene::default() }
    }

    #[test]
    fn it_is_heard_for_its_part_of_the_chirp_and_from_its_direction() {
        let interferer = Interferer { x_metres: 30.0, y_metres: 40.0, crossing: 0.5, duration: 0.25, strength: 0.1 };
        let signal = simulate(&radar(), &scene(interferer), Floor::Exact, 0).unwrap();
        let amplitude = 100.0 * 0.1 / 50.0;
        let heard = |k: usize| signal.samples[[64, k]].norm() / amplitude;
        assert!((heard(128) - 1.0).abs() < 0.01 && (heard(110) - 1.0).abs() < 0.01);
        assert!(heard(70) < 0.01 && heard(190) < 0.01, "{} {}", heard(70), heard(190));
        let map = LogMaps::of_signal(&radar(), &signal).full;
        // At every range alike, in one direction: cos(theta) = 0.6.
        for bin in [20, 60, 110] {
            let row = map.decades().row(bin);
            let strongest = row.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
            assert!((radar().cos_of_column(strongest as f64) - 0.6).abs() < 0.03, "bin {bin}: column {strongest}");
        }
    }

    #[test]
    fn it_raises_the_floor_of_the_whole_map() {
        let points = Scene::of_points([(0.0, 9.0)]);
        let median = |scene: &Scene| {
            let signal = simulate(&radar(), scene, Floor::Exact, 0).unwrap();
            LogMaps::of_signal(&radar(), &signal).full.median()
        };
        let disturbed = Scene { disturbances: scene(Interferer::default()).disturbances, ..points.clone() };
        assert!(median(&disturbed) > median(&points) + 1.0);
    }
}
