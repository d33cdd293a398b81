//! Equation 3.3 in f64 with phases reduced exactly to turns: no rounding floor above the last bits of f64.

use super::phase::EchoModel;
use super::samples::BeatSignal;
use crate::radar::Radar;
use crate::scene::Reflector;
use rayon::prelude::*;

/// Beat signal of `reflectors`, `[elements, samples]`, within 1e-13 of its peak.
///
/// The reflectors must have passed [`crate::scene::Scene::validate`].
pub fn beat_signal(radar: &Radar, reflectors: &[Reflector]) -> BeatSignal {
    let mut signal = BeatSignal::silence(radar);
    let model = EchoModel::new(radar);
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
        let pair = radar.pair(n);
        for r in reflectors {
            let echo = model.echo(pair, r);
            for (n1, sample) in row.iter_mut().enumerate() {
                *sample += echo.sample(n1);
            }
        }
    });
    signal
}
