//! The range-Doppler map on screen.

use super::derived::{Failure, Query};
use super::memo::Memo;
use super::source::Source;
use crate::app::state::State;
use crate::app::widgets::textures::picture;
use crate::maps::doppler::{RangeDopplerMap, range_doppler_for};
use crate::maps::{LogMap, Normalisation};
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::recording::FrameLoops;
use crate::task::Task;
use eframe::egui::ColorImage;
use ndarray::s;
use std::sync::Arc;

/// What is on screen, and how it is drawn.
#[derive(Clone, PartialEq)]
pub struct DopplerQuery {
    source: Source,
    static_clutter_out: bool,
    normalisation: Normalisation,
    colours: ColourMap,
}

impl DopplerQuery {
    /// The map of what is on screen; `None` where the radar of a scene sends one chirp, and of a recording whose loops are not known.
    pub fn of(state: &State) -> Option<Self> {
        let (normalisation, colours) = (state.settings.normalisation, state.settings.colours);
        let source = Source::of(state);
        let has_chirps = match &source.recording {
            None => source.radar.chirps > 1,
            Some(recording) => recording.origin.is_some(),
        };
        let static_clutter_out = state.settings.static_clutter_out && source.recording.is_some();
        has_chirps.then_some(DopplerQuery { source, static_clutter_out, normalisation, colours })
    }
}

/// A map to be drawn.
pub struct DopplerResult {
    /// The radar whose chirps it is made of.
    pub radar: Radar,
    /// Whether their interval is known.
    pub knows_interval: bool,
    /// Decades of amplitude, `[range bins, velocities]`.
    pub decades: LogMap,
    /// The map as a picture, the farthest row on top.
    pub image: Arc<ColorImage>,
}

impl Query for DopplerQuery {
    type Value = DopplerResult;
    /// The decades of the last scene or recording, and the radar: colours and normalisation are chosen among many for one.
    type State = Memo<(Source, bool), DopplerMade>;
    const THREAD: &'static str = "range-Doppler";
    const WHAT: &'static str = "Computing the range-Doppler map";
    const ADVICE: &'static str = "Change the scene to try again.";

    fn compute(&self, kept: &mut Self::State, task: &Task) -> Result<DopplerResult, Failure> {
        let DopplerQuery { source, static_clutter_out, normalisation, colours } = self;
        let of = (source.clone(), *static_clutter_out);
        let made = kept.try_of(of, |(source, is_out)| source_map(source, *is_out, task))?;
        let DopplerMade { radar, knows_interval, decades } = made.clone();
        let map = decades.normalise(*normalisation);
        let image = picture(map.lambda.slice(s![..;-1, ..]), *colours);
        Ok(DopplerResult { radar, knows_interval, decades, image })
    }
}

/// A map, and the radar whose chirps it is made of.
#[derive(Clone)]
pub struct DopplerMade {
    radar: Radar,
    knows_interval: bool,
    decades: LogMap,
}

/// The map of a scene's chirps, or of the loops of a recording's frame.
fn source_map(source: &Source, static_clutter_out: bool, task: &Task) -> Result<DopplerMade, String> {
    if let Some(origin) = source.recording.as_ref().and_then(|r| r.origin.as_ref()) {
        let FrameLoops { radar, mut samples, knows_interval } = origin.loops().map_err(|e| e.to_string())?;
        if static_clutter_out {
            samples.take_out_static();
        }
        let decades = RangeDopplerMap::of(&radar, samples).log_magnitude();
        return Ok(DopplerMade { radar, knows_interval, decades });
    }
    let (scene, floor) = source.simulated()?;
    let map = range_doppler_for(task, &source.radar, scene, floor, scene.noise_seed).map_err(|e| e.to_string())?;
    Ok(DopplerMade { radar: source.radar.clone(), knows_interval: true, decades: map.log_magnitude() })
}
