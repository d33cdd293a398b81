//! What the formulas say of one reflector on every map, computed off the UI thread.

use super::bounds::subject;
use crate::app::state::{Elements, Panel, State};
use crate::bounds::{cramer_rao, noise_variance};
use crate::maps::Aperture;
use crate::radar::{Decibels, End, Radar};
use crate::scene::Reflector;
use crate::task::{Reply, Task, Worker};
use crate::theory::{Ellipse, Overlay};

/// What is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct TheoryRequest {
    /// The radar.
    pub radar: Radar,
    /// What the reflector is called.
    pub name: String,
    /// The reflector.
    pub reflector: Reflector,
    /// Which elements listen for the bound.
    pub elements: Elements,
    /// Seed of random elements.
    pub seed: u64,
    /// Signal-to-noise ratio of a sample, for the bound.
    pub snr: Decibels,
}

/// What the formulas say.
pub struct TheoryResult {
    /// What was asked.
    pub request: TheoryRequest,
    /// On the maps of the first end, of the last and of the whole array; `None` for a reflector without an echo.
    pub overlays: [Option<Overlay>; 3],
    /// How well the reflector's place can be known; `None` where it isn't bounded.
    pub ellipse: Option<Ellipse>,
}

fn work(request: TheoryRequest) -> TheoryResult {
    let TheoryRequest { radar, reflector, elements, seed, snr, .. } = &request;
    let apertures = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
    let overlays = apertures.map(|aperture| Overlay::of(radar, reflector, aperture));
    let ellipse = elements.layout(radar, *seed).ok().and_then(|layout| {
        let variance = noise_variance(radar, &layout, reflector, *snr);
        let bounds = cramer_rao(radar, &layout, std::slice::from_ref(reflector), variance).ok()?;
        Ellipse::of(bounds.first()?)
    });
    TheoryResult { overlays, ellipse, request }
}

/// The worker, what it was asked last, and what it found last.
pub struct Theory {
    worker: Worker<TheoryRequest, TheoryResult>,
    asked: Option<TheoryRequest>,
    result: Option<TheoryResult>,
}

impl Theory {
    /// Starts the worker, which waits; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Theory> {
        let work = |_: &mut (), request: TheoryRequest, _: &Task| work(request);
        Ok(Theory { worker: Worker::spawn("theory", || (), work, wake)?, asked: None, result: None })
    }

    /// Asks for what is drawn over the maps on screen, if that changed; forgets it when nobody looks.
    pub fn ask(&mut self, state: &State) {
        let looked_at = state.arrangement.shown().iter().any(|panel| matches!(panel, Panel::Map(_)));
        let subject = subject(&state.editor).filter(|_| state.settings.show_theory && looked_at);
        let Some((name, reflector)) = subject else {
            (self.asked, self.result) = (None, None);
            return;
        };
        let bounds = state.settings.bounds;
        let request = TheoryRequest {
            radar: state.radar().clone(),
            name,
            reflector,
            elements: bounds.elements,
            seed: bounds.seed,
            snr: bounds.snr,
        };
        if self.asked.as_ref() != Some(&request) {
            self.asked = Some(request.clone());
            self.worker.request(request);
        }
    }

    /// What is to be drawn.
    pub fn result(&self) -> Option<&TheoryResult> {
        self.result.as_ref()
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
                // Nobody looks at it any more where nothing is asked.
                Reply::Done { result, .. } => self.result = Some(result).filter(|_| self.asked.is_some()),
                Reply::Panicked { message: said, .. } => {
                    message = Some(format!("Computing the theory failed ({said}). Move the reflector to try again."));
                }
            }
        }
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a point this far ahead of the array.
    fn found(y_metres: f64) -> TheoryResult {
        work(TheoryRequest {
            radar: Radar { elements: 64, samples: 32, ..Radar::default() },
            name: "point 1".to_owned(),
            reflector: Reflector { x_metres: 1.5, y_metres, reflectivity: 1.0 },
            elements: Elements::TwoEnds,
            seed: 0,
            snr: Decibels(20.0),
        })
    }

    #[test]
    fn every_map_has_its_own_overlay() {
        let [first, last, full] = found(1.0).overlays.map(|o| o.unwrap().blob.peak);
        assert!(first != last && last != full);
    }

    #[test]
    fn a_reflector_on_the_axis_of_the_array_has_no_ellipse() {
        assert!(found(1.0).ellipse.is_some());
        assert!(found(0.0).ellipse.is_none(), "y is not bounded there");
    }
}
