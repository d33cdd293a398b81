//! Geometry of both ends' channels, and the phase of an echo over distance and time.

use crate::radar::{End, Pair, Radar};
use crate::scene::Reflector;
use crate::signal::phase::EchoModel;
use crate::signal::simd::LANES_F64;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Least distance of a reflector from an antenna in a fit, metres: amplitudes are divided by its square.
pub const MIN_DISTANCE_METRES: f64 = 1e-3;

/// Channels that are computed together, one in each lane.
pub const W: usize = LANES_F64;

/// Geometry and constants of both ends. A channel is an element of an end; those of the first end come first.
#[derive(Debug, Clone)]
pub struct Sensor {
    pub model: EchoModel,
    /// x of each channel's element, metres.
    pub element_x: Vec<f64>,
    /// Antennas of each channel's element.
    pub pairs: Vec<Pair>,
    /// Whether each element transmits and receives.
    pub is_monostatic: bool,
    pub samples: usize,
    pub end_elements: usize,
    /// Whether each channel has samples; one without has no echoes.
    pub has_samples: Vec<bool>,
    carrier_radians_per_metre: f64,
    beat_radians_per_metre: f64,
}

impl Sensor {
    pub fn new(radar: &Radar) -> Self {
        let elements = || End::BOTH.iter().flat_map(|&e| radar.end_range(e));
        Sensor {
            model: EchoModel::new(radar),
            element_x: elements().map(|n| radar.element_x_metres(n)).collect(),
            pairs: elements().map(|n| radar.pair(n)).collect(),
            is_monostatic: radar.is_monostatic(),
            samples: radar.samples,
            end_elements: radar.end_elements,
            has_samples: vec![true; 2 * radar.end_elements],
            carrier_radians_per_metre: TAU * radar.carrier.turns_per_wavelength() / radar.wavelength_metres(),
            beat_radians_per_metre: TAU / radar.max_range_metres(),
        }
    }

    /// The sensor for the channels of `flat`, `[channels * samples]`, that are not all zero.
    pub fn with_channels_of(mut self, flat: &[Complex64]) -> Self {
        for (has_samples, channel) in self.has_samples.iter_mut().zip(flat.chunks_exact(self.samples)) {
            *has_samples = channel.iter().any(|v| v.norm_sqr() > 0.0);
        }
        self
    }

    /// The sensor for chirps with the samples of `radar`.
    pub fn sampled_as(&self, radar: &Radar) -> Self {
        Sensor { has_samples: self.has_samples.clone(), ..Sensor::new(radar) }
    }

    /// Number of samples of both ends together.
    pub fn sample_count(&self) -> usize {
        self.element_x.len() * self.samples
    }

    /// Distance after which the carrier's phase repeats, metres.
    pub fn wavelength_metres(&self) -> f64 {
        TAU / self.carrier_radians_per_metre.abs()
    }

    /// Phase for each metre of distance at the middle of the chirp, and its increase over the whole chirp, radians.
    pub fn radians_per_metre_over_chirp(&self) -> [f64; 2] {
        let middle = (self.samples as f64 - 1.0) / 2.0;
        let at_middle = self.carrier_radians_per_metre + self.beat_radians_per_metre * middle;
        [at_middle, self.beat_radians_per_metre * self.samples as f64]
    }
}

/// `r`, moved ahead of an antenna that is nearer than [`MIN_DISTANCE_METRES`].
pub fn with_min_distance(sensor: &Sensor, r: &Reflector) -> Reflector {
    let is_near = |[x, y]: &[f64; 2]| (x - r.x_metres).powi(2) + (y - r.y_metres).powi(2) < MIN_DISTANCE_METRES.powi(2);
    let nearest = sensor.pairs.iter().flat_map(Pair::places_metres).find(is_near);
    let y_metres = nearest.map_or(r.y_metres, |[_, y]| y + MIN_DISTANCE_METRES);
    Reflector { y_metres, ..*r }
}
