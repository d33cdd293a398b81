//! The range-Doppler map on screen.

use super::derived::{Failure, Query};
use super::source::Source;
use crate::app::state::State;
use crate::app::widgets::textures::colour_table;
use crate::maps::doppler::range_doppler_for;
use crate::maps::{LogMap, Normalisation, RangeAngleMap};
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::task::Task;
use eframe::egui::ColorImage;
use std::sync::Arc;

/// What is on screen, and how it is drawn.
#[derive(Clone, PartialEq)]
pub struct DopplerQuery {
    source: Source,
    normalisation: Normalisation,
    colours: ColourMap,
}

impl DopplerQuery {
    /// The map of what is on screen; `None` where the radar sends one chirp.
    pub fn of(state: &State) -> Option<Self> {
        let (normalisation, colours) = (state.settings.normalisation, state.settings.colours);
        (state.radar().chirps > 1).then(|| DopplerQuery { source: Source::of(state), normalisation, colours })
    }
}

/// A map to be drawn.
pub struct DopplerResult {
    /// The radar whose chirps it is made of.
    pub radar: Radar,
    /// Decades of amplitude, `[range bins, velocities]`.
    pub decades: LogMap,
    /// The map as a picture, the farthest row on top.
    pub image: Arc<ColorImage>,
}

impl Query for DopplerQuery {
    type Value = DopplerResult;
    /// The decades of the last scene: colours and normalisation are chosen among many for one.
    type State = Option<(Source, LogMap)>;
    const THREAD: &'static str = "range-Doppler";
    const WHAT: &'static str = "Computing the range-Doppler map";
    const ADVICE: &'static str = "Change the scene to try again.";

    fn compute(&self, kept: &mut Self::State, task: &Task) -> Result<DopplerResult, Failure> {
        let DopplerQuery { source, normalisation, colours } = self;
        let decades = match kept.take() {
            Some((of, decades)) if of == *source => decades,
            _ => {
                let (scene, floor) = source.simulated()?;
                let map = range_doppler_for(task, &source.radar, scene, floor, scene.noise_seed);
                map.map_err(|e| e.to_string())?.log_magnitude()
            }
        };
        let image = picture(&decades.normalise(*normalisation), *colours);
        *kept = Some((source.clone(), decades.clone()));
        Ok(DopplerResult { radar: source.radar.clone(), decades, image })
    }
}

fn picture(map: &RangeAngleMap, colours: ColourMap) -> Arc<ColorImage> {
    let table = colour_table(colours);
    let cells = map.lambda.slice(ndarray::s![..;-1, ..]);
    let pixels = cells.iter().map(|v| table[(v.clamp(0.0, 1.0) * 255.0) as usize]).collect();
    Arc::new(ColorImage::new([cells.ncols(), cells.nrows()], pixels))
}
