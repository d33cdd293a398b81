//! The threshold at which a method keeps a rate of false alarms, looked for in the background.

use super::rows::{Plan, Stopped, Teller};
use crate::app::state::{State, ThresholdChoice};
use crate::evaluate::threshold::{KeptThreshold, ThresholdSearch};
use crate::radar::counted;
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use std::sync::Arc;

/// Which method is tried on which scenes.
pub struct ThresholdPlan {
    search: ThresholdSearch,
    method: Arc<dyn Reconstructor>,
}

/// A threshold that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptEta {
    /// Name of the method.
    pub method: &'static str,
    /// Its threshold.
    pub eta: f32,
    /// What is known of it, in words.
    pub told: String,
}

impl ThresholdPlan {
    /// For the method in use, with the radar, floor and normalisation in use; `None` where there is no method.
    pub fn of(state: &State, choice: ThresholdChoice) -> Option<Self> {
        let ThresholdChoice { false_alarm_percent, kinds, count } = choice;
        let search = ThresholdSearch {
            radar: state.radar().clone(),
            layout: state.settings.heard(state.radar()),
            floor: state.settings.floor,
            normalisation: state.settings.normalisation,
            kinds,
            count,
            false_alarm_percent,
            ..ThresholdSearch::default()
        };
        Some(ThresholdPlan { search, method: state.method()?.clone() })
    }
}

impl Plan for ThresholdPlan {
    type Row = KeptEta;
    type End = ();
    const THREAD: &'static str = "thresholds";
    const WHAT: &'static str = "The search for a threshold";
    const ADVICE: &'static str = "Choose another method.";

    fn run(&self, teller: &Teller<'_, KeptEta>) -> Result<(), Stopped> {
        let ThresholdPlan { search, method } = self;
        let found = search.run(method.as_ref(), teller.task, |part| teller.part(part));
        // Unlike rows, half a search has found nothing that could stay.
        let why =
            |cancelled: bool, said: String| if cancelled { "Cancelled; η stays as it is.".to_owned() } else { said };
        let found = found.map_err(|error| Stopped::Failed(why(error.is_cancelled(), error.to_string())))?;
        let found = KeptThreshold { eta: rounded_up(found.eta), ..found };
        teller.row(KeptEta { method: method.name(), eta: found.eta, told: told(search, method.name(), &found) });
        Ok(())
    }
}

/// A threshold to three decimals, as fields show it. Rounded up, it has no more false alarms than before.
fn rounded_up(eta: f32) -> f32 {
    (eta * 1000.0).ceil() / 1000.0
}

/// What is known of a threshold, and on which condition.
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
