//! Sparse answers as maps: the exact map of a few reflectors with complex gains.

use super::answer::{Reconstruction, Request};
use super::power::lambda_of_power;
use crate::maps::{Aperture, angle_transform, range_transform};
use crate::radar::Radar;
use crate::scene::Reflector;
use crate::signal::BeatSignal;
use crate::signal::echo::add_echo;
use crate::signal::phase::EchoModel;
use num_complex::Complex64;
use rayon::prelude::*;

/// A place and the complex gain found for it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gained {
    pub reflector: Reflector,
    pub gain: Complex64,
}

/// The whole array's map of `found` over the measured noise.
pub(super) fn of_echoes(radar: &Radar, found: &[Gained], noise_variance: f64, request: &Request) -> Reconstruction {
    let model = EchoModel::new(radar);
    let mut signal = BeatSignal::silence(radar);
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
        let Some(samples) = row.as_slice_mut() else { return };
        for f in found {
            add_echo(&model, radar.element_x_metres(n), &f.reflector, f.gain, samples);
        }
    });
    let map = angle_transform(radar, &range_transform(radar, &signal), Aperture::Full);
    let power = map.cells.mapv(|v| v.norm_sqr());
    let reflectors = found.iter().map(|f| Reflector { reflectivity: f.gain.norm(), ..f.reflector }).collect();
    Reconstruction { lambda: lambda_of_power(radar, power, noise_variance, request), reflectors }
}
