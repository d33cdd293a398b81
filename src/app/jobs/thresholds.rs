//! The threshold at which a method keeps a rate of false alarms, looked for in the background.

use super::rows::{RowJob, Stopped, Teller};
use crate::app::state::{State, ThresholdChoice};
use crate::evaluate::threshold::{KeptThreshold, ThresholdSearch};
use crate::radar::counted;
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use std::sync::Arc;

/// Which method is tried on which scenes.
struct Plan {
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

/// The worker.
pub struct Thresholds {
    job: RowJob<Plan, KeptEta, ()>,
}

impl Thresholds {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> std::io::Result<Self> {
        Ok(Thresholds { job: RowJob::start("thresholds", run, wake)? })
    }

    /// Begins afresh, for the method in use, with the radar, floor and normalisation in use.
    pub fn begin(&mut self, state: &State, choice: ThresholdChoice) {
        let Some(method) = state.method().cloned() else { return };
        let ThresholdChoice { false_alarm_percent, kinds, count } = choice;
        let search = ThresholdSearch {
            radar: state.radar().clone(),
            floor: state.settings.floor,
            normalisation: state.settings.normalisation,
            kinds,
            count,
            false_alarm_percent,
            ..ThresholdSearch::default()
        };
        self.job.begin(Plan { search, method });
    }

    /// Stops after the map that is being made.
    pub fn cancel(&mut self) {
        self.job.cancel();
    }

    /// The part that is done, while it runs.
    pub fn progress(&self) -> Option<f32> {
        self.job.progress()
    }

    /// How the last search ended, if not well.
    pub fn note(&self) -> Option<&str> {
        self.job.note()
    }

    /// Takes in what was found: once each threshold, and what a panic said.
    pub fn poll(&mut self) -> (Vec<KeptEta>, Option<String>) {
        let panicked = self.job.poll();
        let said = panicked.map(|said| format!("The search for a threshold failed ({said}). Choose another method."));
        (self.job.take_rows(), said)
    }
}

fn run(plan: &Plan, teller: &Teller<'_, KeptEta>) -> Result<(), Stopped> {
    let Plan { search, method } = plan;
    let found = search.run(method.as_ref(), teller.task, |part| teller.part(part));
    // Unlike rows, half a search has found nothing that could stay.
    let why = |cancelled: bool, said: String| if cancelled { "Cancelled; η stays as it is.".to_owned() } else { said };
    let found = found.map_err(|error| Stopped::Failed(why(error.is_cancelled(), error.to_string())))?;
    let found = KeptThreshold { eta: rounded_up(found.eta), ..found };
    teller.row(KeptEta { method: method.name(), eta: found.eta, told: told(search, method.name(), &found) });
    Ok(())
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
