//! Another radar's chirp in our receivers.

use super::samples::BeatSignal;
use crate::radar::{BuiltArray, Radar};
use crate::scene::Interferer;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Order of the receiver's low-pass filter: gain `1 / sqrt(1 + (2f)^(2 n))` at f turns a sample.
const FILTER_ORDER: i32 = 8;

/// Adds the signal of `interferer` at each element: the difference of both frequencies is a chirp that passes zero at `crossing`, and the
/// receiver's filter while it is below half a turn a sample. Propagation is one-way for both carriers.
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
    let way = radar.carrier_turns_per_metre().signum();
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut heard)| {
        let [_, [receiver_x, receiver_y]] = array.pair(radar, n).places_metres();
        let across = interferer.x_metres - receiver_x;
        let ahead = interferer.y_metres - receiver_y;
        let distance = across.hypot(ahead);
        let left = radar.pattern().map_or(1.0, |pattern| pattern.amplitude(ahead / distance));
        let amplitude = left * radar.transmit_power_watts * interferer.strength / distance;
        let turns = (way * distance / radar.wavelength_metres()).fract();
        let factor = Complex64::from_polar(amplitude, TAU * turns);
        heard.iter_mut().zip(&chirp).for_each(|(v, c)| *v += factor * c);
    });
}
