//! Search for the threshold of a method at a given rate of false alarms, in the background.

use super::derived::Failure;
use super::rows::{Plan, Teller};
use crate::app::state::State;
use crate::evaluate::threshold::{KeptThreshold, ThresholdSearch};
use crate::radar::counted;
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use std::sync::Arc;

/// A search for a threshold, and its method.
pub struct ThresholdPlan {
    search: ThresholdSearch,
    method: Arc<dyn Reconstructor>,
}

/// A threshold found by a search.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptEta {
    pub method: &'static str,
    pub eta: f32,
    /// Message about the threshold's rates and the scenes it was tried on.
    pub told: String,
}

impl ThresholdPlan {
    /// The search for the method in use, with the radar, floor and normalisation in use; `None` where there is no method.
    pub fn of(state: &State, search: ThresholdSearch) -> Option<Self> {
        let search = ThresholdSearch {
            radar: state.radar().clone(),
            layout: state.settings.heard(state.radar()),
            floor: state.settings.floor,
            normalisation: state.settings.normalisation,
            ..search
        };
        Some(ThresholdPlan { search, method: state.method()?.clone() })
    }
}

impl Plan for ThresholdPlan {
    type Row = KeptEta;
    type End = ();
    const WHAT: &'static str = "The search for a threshold";
    const ADVICE: &'static str = "Choose another method.";

    fn run(&self, teller: &Teller<'_, KeptEta>) -> Result<(), Failure> {
        let ThresholdPlan { search, method } = self;
        let found = search.run(method.as_ref(), teller.task, |part| teller.part(part));
        // Half a search has found no threshold that could stay.
        let found = found.map_err(|error| match error.is_cancelled() {
            true => "Cancelled; η stays as it is.".to_owned(),
            false => error.to_string(),
        })?;
        // Rounded up to three decimals, as fields show it: a higher threshold has no more false alarms.
        let found = KeptThreshold { eta: (found.eta * 1000.0).ceil() / 1000.0, ..found };
        teller.row(KeptEta { method: method.name(), eta: found.eta, told: told(search, method.name(), &found) });
        Ok(())
    }
}

/// The message about a threshold: its rates, and the scenes it was tried on.
fn told(search: &ThresholdSearch, method: &str, found: &KeptThreshold) -> String {
    let KeptThreshold { eta, tried } = found;
    let kinds: Vec<String> = search.kinds.iter().map(Kind::to_string).collect();
    format!(
        "η of {method} is {eta:.3}: at most {} % false alarms on average over further scenes like the {} it was tried on (kinds {}; P_FA \
         {:.2} %, P_D {:.1} % there); {}",
        search.false_alarm_percent,
        counted(tried.scenes, "validation scene", "validation scenes"),
        kinds.join(", "),
        100.0 * tried.false_alarm,
        100.0 * tried.detection,
        search.told_left(tried.scenes)
    )
}
