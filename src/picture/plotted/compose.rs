//! The bytes of a picture from a signal: maps, reconstruction, panels.

use super::error::Composed;
use super::{DetectedCells, Drawing, InputMap, Panels, PictureError, encode_png, render, render_svg};
use crate::evaluate::TARGET_ETA;
use crate::evaluate::verdict::Footprints;
use crate::maps::cfar::{Cfar, DETECTION_THRESHOLD};
use crate::maps::{LogMaps, Normalisation};
use crate::picture::ColourMap;
use crate::radar::{Carrier, LayoutKind, Radar, counted};
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::Scene;
use crate::signal::{BeatSignal, Floor};
use std::path::Path;

/// Kind of picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    Png,
    /// Lines and text as such, maps as bitmaps.
    Svg,
}

impl PictureFormat {
    /// The format by the ending of a file's name, if it is one of these.
    pub fn of_path(path: &Path) -> Option<PictureFormat> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(PictureFormat::Png),
            "svg" => Some(PictureFormat::Svg),
            _ => None,
        }
    }

    /// The bytes of a file with `drawing`.
    /// # Errors
    /// [`PictureError`] when plotters can't draw.
    pub fn bytes_of(self, drawing: &impl Drawing) -> Result<Vec<u8>, PictureError> {
        Ok(match self {
            PictureFormat::Png => encode_png(&render(drawing)?)?,
            PictureFormat::Svg => render_svg(drawing)?.into_bytes(),
        })
    }
}

/// Settings of the maps, of their thresholds and of their colours.
#[derive(Debug, Clone)]
pub struct Style {
    /// The floor beneath a scene's signal; a recording has noise of its own.
    pub floor: Floor,
    /// The elements that the method hears; those of the two ends where `None`.
    pub layout: Option<LayoutKind>,
    pub normalisation: Normalisation,
    pub colours: ColourMap,
    /// Threshold of the output; the method's own where `None`.
    pub eta: Option<f32>,
    pub target_eta: f32,
    /// The detector in the place of both thresholds, if one is in use.
    pub cfar: Option<Cfar>,
}

impl Default for Style {
    fn default() -> Self {
        let (floor, normalisation, colours) = Default::default();
        Style { floor, layout: None, normalisation, colours, eta: None, target_eta: TARGET_ETA, cfar: None }
    }
}

/// Reconstructs and draws all panels; the bytes of a file.
/// # Errors
/// [`ComposeError`](super::ComposeError) when the method fails or the panels can't be drawn.
pub fn compose(
    radar: &Radar,
    scene: &Scene,
    signal: &BeatSignal,
    method: &dyn Reconstructor,
    style: &Style,
    format: PictureFormat,
) -> Composed {
    let Style { floor, normalisation, .. } = *style;
    let elements = &scene.disturbances.elements;
    let maps = LogMaps::of_elements(radar, elements, signal);
    let (layout_samples, inputs) =
        InputMap::of(radar, elements, Some(signal), [&maps.first, &maps.last], (style.layout.as_ref(), normalisation))?;
    let request = Request { noise: floor.into(), normalisation, layout_samples, ..Request::default() };
    let output = method.reconstruct(radar, &signal.two_ends(radar), &request)?;
    let bodies = scene.objects.iter().filter(|o| o.body().is_some()).count();
    let reflectors = match (scene.reflector_count(), bodies) {
        (0, 0) => "no reflector".to_owned(),
        (n, 0) => counted(n, "reflector", "reflectors"),
        (0, bodies) => counted(bodies, "body", "bodies"),
        (n, bodies) => format!("{}, {}", counted(n, "reflector", "reflectors"), counted(bodies, "body", "bodies")),
    };
    let target = maps.full.normalise(normalisation);
    let scale = maps.full.scale(normalisation);
    let detect = |cfar| DetectedCells::of(cfar, scale, [&target, &output.lambda]);
    let detected = style.cfar.map(detect).transpose()?;
    let eta = style.eta.unwrap_or_else(|| method.eta_of(&output));
    let above =
        detected.as_ref().map_or_else(|| output.lambda.above(eta), |cells| cells.output.above(DETECTION_THRESHOLD));
    let verdicts = Footprints::new(radar, scene, &target, scale).judge_cells(&target, &output.lambda, &above);
    let panels = Panels {
        scene,
        found: None,
        radar,
        about: &format!("{reflectors}, {}, floor {floor}, normalisation {normalisation}", carrier_words(radar)),
        inputs: &inputs,
        target: Some(&target),
        output: &output.lambda,
        method: method.name(),
        etas: [eta, style.target_eta],
        verdicts: Some(&verdicts),
        detected: detected.as_ref(),
        colours: style.colours,
    };
    Ok(format.bytes_of(&panels)?)
}

pub(super) fn carrier_words(radar: &Radar) -> &'static str {
    match radar.carrier {
        Carrier::OneWay => "one-way carrier",
        Carrier::TwoWay => "two-way carrier",
    }
}
