//! From a signal to a picture's bytes: maps, reconstruction, panels.

use super::{ColourMap, Panels, PictureError, encode_png, render, render_svg};
use crate::maps::{LogMaps, Normalisation};
use crate::radar::{Carrier, Radar, counted};
use crate::reconstruct::{ReconstructError, Reconstructor, Request};
use crate::scene::Scene;
use crate::signal::{BeatSignal, Floor};
use std::path::Path;

/// Kind of picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// A bitmap.
    Png,
    /// Lines and text as such, maps as bitmaps.
    Svg,
}

impl PictureFormat {
    /// The kind that a file's name says, if it is one of these.
    pub fn of_path(path: &Path) -> Option<PictureFormat> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(PictureFormat::Png),
            "svg" => Some(PictureFormat::Svg),
            _ => None,
        }
    }
}

/// How the maps are made and painted.
#[derive(Debug, Clone, Copy, Default)]
pub struct Style {
    /// The floor beneath a scene's signal; a recording has noise of its own.
    pub floor: Floor,
    /// How decades become Lambda.
    pub normalisation: Normalisation,
    /// Colours of the maps.
    pub colours: ColourMap,
    /// Threshold of the output; the method's own where `None`.
    pub eta: Option<f32>,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // Names and messages say it.
pub enum ComposeError {
    #[error(transparent)]
    Reconstruct(#[from] ReconstructError),
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// Reconstructs and draws all panels; the bytes of a file.
/// # Errors
/// [`ComposeError`] when the method fails or the panels can't be drawn.
pub fn compose(
    radar: &Radar,
    scene: &Scene,
    signal: &BeatSignal,
    method: &dyn Reconstructor,
    style: &Style,
    format: PictureFormat,
) -> Result<Vec<u8>, ComposeError> {
    let Style { floor, normalisation, colours, eta } = *style;
    let maps = LogMaps::heard_by(radar, &scene.disturbances.elements, signal);
    let request = Request { noise: floor.into(), normalisation, ..Request::default() };
    let output = method.reconstruct(radar, &signal.two_ends(radar), &request)?;
    let carrier = match radar.carrier {
        Carrier::OneWay => "one-way carrier",
        Carrier::TwoWay => "two-way carrier",
    };
    let bodies = scene.objects.iter().filter(|o| o.body().is_some()).count();
    let reflectors = match (scene.reflector_count(), bodies) {
        (0, 0) => "no reflector".to_owned(),
        (n, 0) => counted(n, "reflector", "reflectors"),
        (0, bodies) => counted(bodies, "body", "bodies"),
        (n, bodies) => format!("{}, {}", counted(n, "reflector", "reflectors"), counted(bodies, "body", "bodies")),
    };
    let panels = Panels {
        scene,
        found: None,
        radar,
        about: &format!("{reflectors}, {carrier}, floor {floor}, normalisation {normalisation}"),
        first: &maps.first.normalise(normalisation),
        last: &maps.last.normalise(normalisation),
        target: Some(&maps.full.normalise(normalisation)),
        output: &output.lambda,
        method: method.name(),
        eta: eta.unwrap_or_else(|| method.eta_of(&output)),
        colours,
    };
    Ok(match format {
        PictureFormat::Png => encode_png(&render(&panels)?)?,
        PictureFormat::Svg => render_svg(&panels)?.into_bytes(),
    })
}
