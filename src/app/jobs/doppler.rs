//! The range-Doppler map on screen, computed off the UI thread.

use super::phasors::Source;
use crate::app::state::State;
use crate::app::widgets::textures::colour_table;
use crate::maps::doppler::range_doppler_for;
use crate::maps::{LogMap, Normalisation, RangeAngleMap};
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::task::{Reply, Task, Worker};
use eframe::egui::ColorImage;
use std::sync::Arc;

#[derive(Clone)]
struct Request {
    source: Source,
    normalisation: Normalisation,
    colours: ColourMap,
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

/// The decades of the last scene: colours and normalisation are chosen among many for one.
#[derive(Default)]
struct Kept(Option<(Source, LogMap)>);

impl Kept {
    fn work(&mut self, request: &Request, task: &Task) -> Result<DopplerResult, String> {
        let Request { source, normalisation, colours } = request;
        let decades = match self.0.take() {
            Some((of, decades)) if of.same(source) => decades,
            _ => {
                let (scene, floor) = source.simulated()?;
                let map = range_doppler_for(task, &source.radar, scene, floor, scene.noise_seed);
                map.map_err(|e| e.to_string())?.log_magnitude()
            }
        };
        let image = picture(&decades.normalise(*normalisation), *colours);
        self.0 = Some((source.clone(), decades.clone()));
        Ok(DopplerResult { radar: source.radar.clone(), decades, image })
    }
}

fn picture(map: &RangeAngleMap, colours: ColourMap) -> Arc<ColorImage> {
    let table = colour_table(colours);
    let cells = map.lambda.slice(ndarray::s![..;-1, ..]);
    let pixels = cells.iter().map(|v| table[(v.clamp(0.0, 1.0) * 255.0) as usize]).collect();
    Arc::new(ColorImage::new([cells.ncols(), cells.nrows()], pixels))
}

/// The worker, what it was asked last, and what it found last.
pub struct Dopplers {
    worker: Worker<Request, Result<DopplerResult, String>>,
    asked: Option<Request>,
    result: Option<Result<DopplerResult, String>>,
    requests: u64,
}

impl Dopplers {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Dopplers> {
        let work = |kept: &mut Kept, request: Request, task: &Task| kept.work(&request, task);
        Ok(Dopplers {
            worker: Worker::spawn("range-Doppler", Kept::default, work, wake)?,
            asked: None,
            result: None,
            requests: 0,
        })
    }

    /// Asks for the map of what is on screen, unless it was asked for last.
    pub fn ask(&mut self, state: &State) {
        let (normalisation, colours) = (state.settings.normalisation, state.settings.colours);
        let request = Request { source: Source::of(state), normalisation, colours };
        let is_new = |asked: &Request| {
            !asked.source.same(&request.source) || (asked.normalisation, asked.colours) != (normalisation, colours)
        };
        if self.asked.as_ref().is_none_or(is_new) {
            self.requests += 1;
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// What was found last, or why nothing was.
    pub fn result(&self) -> Option<Result<&DopplerResult, &str>> {
        self.result.as_ref().map(|r| r.as_ref().map_err(String::as_str))
    }

    /// Requests so far: a test asks that a hidden panel makes none.
    pub fn requests(&self) -> u64 {
        self.requests
    }

    /// Whether it computes.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Takes in what was found. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result, .. } => self.result = Some(result),
                Reply::Panicked { message: said, .. } => {
                    message = Some(format!(
                        "Computing the range-Doppler map failed ({said}). Change the scene to try again."
                    ));
                }
            }
        }
        message
    }
}
