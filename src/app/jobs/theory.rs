//! Predictions and position bound of one reflector by formulas, drawn over the maps.

use super::bounds::BoundsRequest;
use super::derived::{Failure, Query};
use crate::app::state::{BoundsSettings, Panel, State};
use crate::bounds::{cramer_rao, noise_variance};
use crate::maps::Aperture;
use crate::radar::End;
use crate::task::Task;
use crate::theory::{Ellipse, Overlay};

/// A query of the theory of the reflector whose bounds these are.
#[derive(Debug, Clone, PartialEq)]
pub struct TheoryRequest(BoundsRequest);

pub struct TheoryResult {
    /// The reflector, and the elements and noise of the bound.
    pub request: BoundsRequest,
    /// Overlays for the maps of the first end, the last end and the whole array; `None` for a reflector without an echo.
    pub overlays: [Option<Overlay>; 3],
    /// Ellipse of the position bound; `None` where the position isn't bounded.
    pub ellipse: Option<Ellipse>,
}

impl TheoryRequest {
    /// The query of the reflector drawn over the maps on screen; `None` where none is drawn.
    pub fn of(state: &State) -> Option<Self> {
        let looked_at = state.arrangement.shown().iter().any(|panel| matches!(panel, Panel::Map(_)));
        (state.settings.show_theory && looked_at).then(|| BoundsRequest::of(state)).flatten().map(TheoryRequest)
    }
}

impl Query for TheoryRequest {
    type Value = TheoryResult;
    type State = ();
    const WHAT: &'static str = "Computing the theory";
    const ADVICE: &'static str = "Move the reflector to try again.";

    fn compute(&self, (): &mut (), _: &Task) -> Result<TheoryResult, Failure> {
        let BoundsRequest { radar, reflector, settings: BoundsSettings { elements, seed, snr, .. }, .. } = &self.0;
        let apertures = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
        let overlays = apertures.map(|aperture| Overlay::of(radar, reflector, aperture));
        let ellipse = elements.layout(radar, *seed).ok().and_then(|layout| {
            let variance = noise_variance(radar, &layout, reflector, *snr);
            let bounds = cramer_rao(radar, &layout, std::slice::from_ref(reflector), variance).ok()?;
            Ellipse::of(bounds.first()?)
        });
        Ok(TheoryResult { overlays, ellipse, request: self.0.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::scene::Reflector;

    fn found(y_metres: f64) -> TheoryResult {
        let request = BoundsRequest {
            radar: Radar { elements: 64, samples: 32, ..Radar::default() },
            name: "point 1".to_owned(),
            reflector: Reflector { x_metres: 1.5, y_metres, reflectivity: 1.0 },
            settings: BoundsSettings::default(),
        };
        TheoryRequest(request).compute(&mut (), &Task::default()).unwrap()
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
