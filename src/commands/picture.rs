//! From a signal to a picture's bytes: what `apertura maps OUT.png` and a start without a display share.

use super::CommandError;
use crate::maps::{LogMaps, Normalisation};
use crate::picture::{ColourMap, Panels, encode_png, render};
use crate::radar::Radar;
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::Scene;
use crate::signal::{BeatSignal, Floor};

/// How the maps are made and painted.
#[derive(Debug, Clone, Copy, Default)]
pub struct Style {
    /// The floor beneath the signal.
    pub floor: Floor,
    /// How decades become Lambda.
    pub normalisation: Normalisation,
    /// Colours of the maps.
    pub colours: ColourMap,
}

/// Reconstructs and draws all panels; a PNG file's bytes.
pub fn draw(
    radar: &Radar,
    scene: &Scene,
    signal: &BeatSignal,
    method: &dyn Reconstructor,
    style: &Style,
) -> Result<Vec<u8>, CommandError> {
    let Style { floor, normalisation, colours } = *style;
    let maps = LogMaps::of_signal(radar, signal);
    let request = Request { floor, normalisation, ..Request::default() };
    let output = method.reconstruct(radar, &signal.two_ends(radar), &request).map_err(CommandError::failed)?;
    let picture = render(&Panels {
        scene,
        radar,
        conditions: &format!("floor {floor}, normalisation {normalisation}"),
        first: &maps.first.normalise(normalisation),
        last: &maps.last.normalise(normalisation),
        target: &maps.full.normalise(normalisation),
        output: &output.lambda,
        method: method.name(),
        eta: method.eta(),
        colours,
    })
    .map_err(CommandError::failed)?;
    encode_png(&picture).map_err(CommandError::failed)
}
