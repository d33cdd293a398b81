//! The search for a worse scene near the one on screen, or for its repair, in the background.

use crate::app::jobs::derived::Failure;
use crate::app::jobs::rows::{Plan, RowJob, Teller};
use crate::app::state::State;
use crate::evaluate::worsen::{Finding, WorseningGoal, WorseningMeasure, WorseningSearch};
use crate::radar::counted;
use crate::reconstruct::Reconstructor;
use crate::scene::Scene;
use std::sync::Arc;

/// A search, its first scene, that scene's document, and the method.
pub struct SearchPlan {
    search: WorseningSearch,
    scene: Arc<Scene>,
    document: u64,
    method: Arc<dyn Reconstructor>,
}

impl Plan for SearchPlan {
    type Row = Finding;
    type End = ();
    const WHAT: &'static str = "The search";
    const ADVICE: &'static str = "Choose another method, or move something.";

    fn run(&self, teller: &Teller<'_, Finding>) -> Result<(), Failure> {
        let mut told = 0;
        let on_try = |tries: u32, path: &[Finding]| {
            path[told..].iter().for_each(|finding| teller.row(finding.clone()));
            told = path.len();
            teller.part(tries as f32 / self.search.tries.max(1) as f32);
            !teller.task.is_cancelled()
        };
        let outcome = self.search.run(&self.scene, self.method.as_ref(), teller.task, on_try)?;
        // Findings of the last batch before it was stopped.
        outcome.path[told..].iter().for_each(|finding| teller.row(finding.clone()));
        Ok(())
    }
}

/// The worker of searches, and the path of the last one.
pub struct Search {
    /// Its rows are the path: the first scene, and every later one that was better by the goal than all before it.
    pub job: RowJob<SearchPlan>,
    /// Whether `poll` has reported the end of the search.
    told: bool,
}

impl Search {
    /// Starts the worker, idle at first; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> Search {
        Search { job: RowJob::start(wake), told: true }
    }

    /// Begins a search near the scene on screen.
    pub fn begin(&mut self, state: &State, search: WorseningSearch) {
        let Some(method) = state.method().cloned() else { return };
        let scene = state.editor.scene().clone();
        let search = WorseningSearch {
            radar: state.radar().clone(),
            floor: state.settings.floor,
            normalisation: state.settings.normalisation,
            layout: state.settings.layout_numbers(state.radar()),
            ..search
        };
        let document = state.editor.document().id();
        self.told = false;
        self.job.begin(SearchPlan { search, scene, document, method });
    }

    /// Drops the search with its path.
    pub fn forget(&mut self) {
        self.job.forget();
        self.told = true;
    }

    /// Centres of every object along the path, `[x, y]` in metres, while the search's document is on screen.
    pub fn trails(&self, document: u64) -> Vec<Vec<[f64; 2]>> {
        let is_shown = self.job.plan().is_some_and(|plan| plan.document == document);
        let scenes = self.job.rows().iter().map(|finding| &finding.scene.objects).filter(|_| is_shown);
        let objects = scenes.clone().map(Vec::len).max().unwrap_or(0);
        (0..objects).map(|i| scenes.clone().filter_map(|of| Some(of.get(i)?.centre_metres())).collect()).collect()
    }

    /// Whether the scene on screen is still the search's first one.
    pub fn is_about(&self, scene: &Arc<Scene>) -> bool {
        self.job.plan().is_some_and(|plan| Arc::ptr_eq(&plan.scene, scene))
    }

    /// Takes in findings. Returns whether the search ended just now, and a message for the user.
    pub fn poll(&mut self) -> (bool, Option<String>) {
        let panicked = self.job.poll();
        let ended = !self.told && self.job.progress().is_none();
        self.told |= ended;
        (ended, panicked)
    }

    /// The result of the search in words.
    pub fn summary(&self) -> Option<String> {
        let SearchPlan { search, method, .. } = self.job.plan()?;
        let method = method.name();
        let [start, .., end] = self.job.rows() else {
            let nothing = if search.goal == WorseningGoal::Repair { "right" } else { "worse" };
            return (self.job.progress().is_none() && self.job.note().is_none())
                .then(|| format!("No scene {nothing} for {method} within {} m.", search.within_metres));
        };
        let told = |finding: &Finding| match search.measure {
            WorseningMeasure::SquaredError => format!("SE {:.1}", finding.metrics.squared_error),
            WorseningMeasure::Missed => format!("{} missed", finding.verdicts.missed()),
            WorseningMeasure::Ghosts => counted(finding.verdicts.ghosts.len(), "false alarm", "false alarms"),
        };
        Some(format!("{method}: {} here, {} after {:.2} m", told(start), told(end), end.moved_metres))
    }

    /// Drops a search that began in another document than the one on screen.
    pub fn keep_to(&mut self, document: u64) {
        if self.job.plan().is_some_and(|plan| plan.document != document) {
            self.forget();
        }
    }
}
