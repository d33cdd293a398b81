//! The range-Doppler map of the scene or recording on screen.

use super::derived::{Failure, Query};
use super::memo::Memo;
use super::source::Source;
use crate::app::state::State;
use crate::app::widgets::picture;
use crate::maps::doppler::{RangeDopplerMap, range_doppler_for};
use crate::maps::{LogMap, Normalisation};
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::recording::FrameLoops;
use crate::task::Task;
use eframe::egui::ColorImage;
use ndarray::s;
use std::sync::Arc;

#[derive(Clone, PartialEq)]
pub struct DopplerQuery {
    source: Source,
    static_clutter_out: bool,
    normalisation: Normalisation,
    colours: ColourMap,
}

impl DopplerQuery {
    /// The query for the scene or recording on screen; `None` where a scene's radar sends one chirp, and for a recording with unknown loops.
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

pub struct DopplerResult {
    pub radar: Radar,
    /// Whether the interval of the chirps is known.
    pub knows_interval: bool,
    /// Decades of amplitude, `[range bins, velocities]`.
    pub decades: LogMap,
    /// The map as a picture, the farthest row on top.
    pub image: Arc<ColorImage>,
}

impl Query for DopplerQuery {
    type Value = DopplerResult;
    /// The last map, so that another colour map or normalisation does not compute it again.
    type State = Memo<(Source, bool), DopplerMade>;
    const WHAT: &'static str = "Computing the range-Doppler map";

    fn compute(&self, kept: &mut Self::State, task: &Task) -> Result<DopplerResult, Failure> {
        let DopplerQuery { source, static_clutter_out, normalisation, colours } = self;
        let of = (source.clone(), *static_clutter_out);
        let made = kept.try_of(of, |(source, is_out)| source_map(source, *is_out, task))?;
        let (radar, knows_interval, decades) = made.clone();
        let map = decades.normalise(*normalisation);
        let image = picture(map.lambda.slice(s![..;-1, ..]), *colours);
        Ok(DopplerResult { radar, knows_interval, decades, image })
    }
}

/// The radar of the chirps, whether their interval is known, and the range-Doppler map.
type DopplerMade = (Radar, bool, LogMap);

/// The map of a scene's chirps, or of the loops of a recording's frame. There is no query of a recording without loops.
fn source_map(source: &Source, static_clutter_out: bool, task: &Task) -> Result<DopplerMade, String> {
    if let Some(origin) = source.recording.as_ref().and_then(|r| r.origin.as_ref()) {
        let FrameLoops { radar, mut samples, knows_interval } = origin.loops().map_err(|e| e.to_string())?;
        if static_clutter_out {
            samples.remove_static();
        }
        let decades = RangeDopplerMap::of(&radar, samples).log_magnitude();
        return Ok((radar, knows_interval, decades));
    }
    let Source { radar, scene, floor, .. } = source;
    let map = range_doppler_for(task, radar, scene, *floor, scene.noise_seed).map_err(|e| e.to_string())?;
    Ok((radar.clone(), true, map.log_magnitude()))
}
