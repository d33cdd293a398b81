//! Equation 3.3 in f64 with phases reduced exactly to turns: no rounding floor above the last bits of f64.

use super::path::Path;
use super::phase::EchoModel;
use super::samples::BeatSignal;
use crate::radar::Radar;
use crate::scattering::Sources;
use rayon::prelude::*;

/// Beat signal of all scatterers, `[elements, samples]`, within 1e-13 of its peak. They must have passed [`crate::scene::Scene::validate`].
pub fn beat_signal<'a>(radar: &Radar, sources: impl Into<Sources<'a>>) -> BeatSignal {
    let sources = sources.into();
    let mut signal = BeatSignal::silence(radar);
    let model = EchoModel::new(radar);
    signal.samples.outer_iter_mut().into_par_iter().enumerate().for_each(|(n, mut row)| {
        let pair = radar.pair(n);
        let mut scattered = Vec::new();
        sources.scattered(pair, &mut scattered);
        let bodies = scattered.iter().filter(|e| e.is_heard());
        let bodies = bodies.map(|e| model.of_path::<1, false>(Path::new([e.range_metres], [e.amplitude])).first());
        for echo in sources.points.iter().map(|r| model.echo(pair, r)).chain(bodies) {
            for (n1, sample) in row.iter_mut().enumerate() {
                *sample += echo.sample(n1);
            }
        }
    });
    signal
}
