//! What the formulas say of one reflector on every map.

use super::bounds::subject;
use super::derived::{Failure, Query};
use crate::app::state::{BoundsSettings, Elements, Panel, State};
use crate::bounds::{cramer_rao, noise_variance};
use crate::maps::Aperture;
use crate::radar::{Decibels, End, Radar};
use crate::scene::Reflector;
use crate::task::Task;
use crate::theory::{Ellipse, Overlay};

/// What is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct TheoryRequest {
    pub radar: Radar,
    /// What the reflector is called.
    pub name: String,
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

impl TheoryRequest {
    /// The reflector that is drawn over the maps on screen; `None` where none is.
    pub fn of(state: &State) -> Option<Self> {
        let looked_at = state.arrangement.shown().iter().any(|panel| matches!(panel, Panel::Map(_)));
        let (name, reflector) = subject(&state.editor).filter(|_| state.settings.show_theory && looked_at)?;
        let BoundsSettings { elements, seed, snr, .. } = state.settings.bounds;
        Some(TheoryRequest { radar: state.radar().clone(), name, reflector, elements, seed, snr })
    }
}

impl Query for TheoryRequest {
    type Value = TheoryResult;
    type State = ();
    const THREAD: &'static str = "theory";
    const WHAT: &'static str = "Computing the theory";
    const ADVICE: &'static str = "Move the reflector to try again.";

    fn compute(&self, (): &mut (), _: &Task) -> Result<TheoryResult, Failure> {
        let TheoryRequest { radar, reflector, elements, seed, snr, .. } = self;
        let apertures = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
        let overlays = apertures.map(|aperture| Overlay::of(radar, reflector, aperture));
        let ellipse = elements.layout(radar, *seed).ok().and_then(|layout| {
            let variance = noise_variance(radar, &layout, reflector, *snr);
            let bounds = cramer_rao(radar, &layout, std::slice::from_ref(reflector), variance).ok()?;
            Ellipse::of(bounds.first()?)
        });
        Ok(TheoryResult { overlays, ellipse, request: self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a point this far ahead of the array.
    fn found(y_metres: f64) -> TheoryResult {
        let request = TheoryRequest {
            radar: Radar { elements: 64, samples: 32, ..Radar::default() },
            name: "point 1".to_owned(),
            reflector: Reflector { x_metres: 1.5, y_metres, reflectivity: 1.0 },
            elements: Elements::TwoEnds,
            seed: 0,
            snr: Decibels(20.0),
        };
        request.compute(&mut (), &Task::default()).unwrap()
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
