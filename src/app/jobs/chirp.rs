//! The beat of one element and its spectrum, computed off the UI thread.

use super::phasors::Source;
use crate::app::state::State;
use crate::maps::channels_range_transform;
use crate::signal::BeatSignal;
use crate::task::{Reply, Task, Worker};
use ndarray::s;
use num_complex::Complex64;

#[derive(Clone)]
struct Request {
    source: Source,
    element: usize,
}

/// What one element hears in a chirp.
pub struct ChirpResult {
    /// The element.
    pub element: usize,
    /// The samples of the beat.
    pub samples: Vec<Complex64>,
    /// Amplitude of each range bin of its spectrum under the radar's window.
    pub spectrum: Vec<f64>,
}

/// The samples of the last scene: an element is chosen among many of one scene.
#[derive(Default)]
struct Kept {
    signal: Option<(Source, BeatSignal)>,
}

impl Kept {
    fn work(&mut self, request: &Request) -> Result<ChirpResult, String> {
        let Request { source, element } = request;
        let signal = match self.signal.take() {
            Some((of, signal)) if of.same(source) => signal,
            _ => source.signal()?,
        };
        let row = signal.samples.slice(s![*element..element + 1, ..]);
        let profile = channels_range_transform(&source.radar, row).profiles;
        let samples = row.iter().copied().collect();
        let spectrum = profile.iter().map(|cell| cell.norm()).collect();
        self.signal = Some((source.clone(), signal));
        Ok(ChirpResult { element: *element, samples, spectrum })
    }
}

/// The worker, what it was asked last, and what it found last.
pub struct Chirps {
    worker: Worker<Request, Result<ChirpResult, String>>,
    asked: Option<Request>,
    result: Option<Result<ChirpResult, String>>,
    requests: u64,
}

impl Chirps {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Chirps> {
        let work = |kept: &mut Kept, request: Request, _: &Task| kept.work(&request);
        Ok(Chirps {
            worker: Worker::spawn("chirps", Kept::default, work, wake)?,
            asked: None,
            result: None,
            requests: 0,
        })
    }

    /// Asks for the beat of the chosen element, unless it was asked for last.
    pub fn ask(&mut self, state: &State) {
        let element = state.settings.chirp.element.min(state.radar().elements - 1);
        let request = Request { source: Source::of(state), element };
        let is_new = |asked: &Request| !asked.source.same(&request.source) || asked.element != element;
        if self.asked.as_ref().is_none_or(is_new) {
            self.requests += 1;
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// What was found last, or why nothing was.
    pub fn result(&self) -> Option<Result<&ChirpResult, &str>> {
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
                    message = Some(format!("Computing the beat failed ({said}). Change the scene to try again."));
                }
            }
        }
        message
    }
}
