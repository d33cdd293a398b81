//! Equation 3.3 as written, in f64: the phase in radians, without reduction, as in the thesis' program.
//!
//! Phases reach 6e4 rad, so every sample has a rounding error of about 1e-11 of its amplitude. This is the floor of a map normalised by its minimum,
//! and so of the thesis' tables.

use super::path::thesis_path;
use super::samples::BeatSignal;
use crate::radar::Radar;
use crate::scattering::Sources;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Beat signal of all scatterers, `[elements, samples]`. They must have passed [`crate::scene::Scene::validate`]; otherwise samples may be infinite.
pub fn beat_signal<'a>(radar: &Radar, sources: impl Into<Sources<'a>>) -> BeatSignal {
    let sources = sources.into();
    let mut signal = BeatSignal::silence(radar);
    let wavelength = radar.wavelength_metres();
    let bins_per_metre = 1.0 / radar.range_resolution_metres();
    let carrier = radar.carrier.turns_per_wavelength();
    let samples = radar.samples as f64;
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
        let pair = radar.pair(n);
        let mut scattered = Vec::new();
        sources.scattered(pair, &mut scattered);
        let points = sources.points.iter().map(|r| {
            let (distance, amplitude) = thesis_path(radar, pair, r);
            (distance, amplitude, 0.0)
        });
        let bodies = scattered.iter().filter(|e| e.is_heard());
        let bodies = bodies.map(|e| (e.range_metres, e.amplitude.norm(), e.amplitude.arg()));
        for (distance, amplitude, phase_radians) in points.chain(bodies) {
            let carrier_phase = carrier * 2.0 * PI * distance / wavelength;
            let bins = distance * bins_per_metre;
            for (n1, sample) in row.iter_mut().enumerate() {
                let phase = (2.0 * PI * n1 as f64 / samples) * bins + (carrier_phase + phase_radians);
                *sample += Complex64::from_polar(amplitude, phase);
            }
        }
    });
    signal
}
