//! The search near a scene for another on which a method does worse, or for the smallest move after which it is right.
//!
//! Candidates move objects, turn bodies, change echoes against each other and draw other noise. The search draws a third of them anywhere within
//! reach, and the others around the worst so far. Their steps grow with success, shrink without, and start anew when they are small.
//! Candidate `n` of a search depends on the seed and on the results of earlier batches, so a search of a given number of tries repeats
//! itself.

mod candidate;
mod wanted;

pub use wanted::{Finding, WorseningGoal, WorseningMeasure, WorseningOutcome, WorseningSearch, summary};

use super::Target;
use super::trial::Trial;
use super::verdict::OutputVerdicts;
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::{Scene, SceneError};
use crate::task::Task;
use candidate::{BATCH_CANDIDATES, FIRST_STEP_PART, MIN_STEP_PART, WorseningState, distance};
use rayon::prelude::*;

/// A repaired squared error is at most this part of the one at the start.
const REPAIR_PART: f64 = 0.2;

impl WorseningSearch {
    /// Searches near `scene` for `method`. After every batch `on_try` gets the number of tries and the path so far; false ends the search.
    /// # Errors
    /// The reason when the start itself can't be tried. Candidates that can't be simulated are skipped.
    pub fn run(
        &self,
        scene: &Scene,
        method: &dyn Reconstructor,
        task: &Task,
        mut on_try: impl FnMut(u32, &[Finding]) -> bool,
    ) -> Result<WorseningOutcome, String> {
        if scene.objects.is_empty() {
            return Err("the scene is empty; expected an object to move".to_owned());
        }
        if !(self.within_metres > 0.0 && self.within_metres <= 1000.0) {
            let reach = self.within_metres;
            return Err(format!("a reach of {reach} m; expected more than 0 and at most 1000 m"));
        }
        let request = Request {
            noise: self.floor.into(),
            normalisation: self.normalisation,
            task: task.clone(),
            ..Request::default()
        };
        let trial = self.trial(scene).map_err(|error| error.to_string())?;
        let start = self.finding(scene, scene, &trial, method, &request, 0)?;
        let mut state = WorseningState { step: FIRST_STEP_PART, path: vec![start], tries: 0 };
        while state.tries < self.tries && !self.is_reached(&state) && on_try(state.tries, &state.path) {
            let batch = state.tries..(state.tries + BATCH_CANDIDATES).min(self.tries);
            state.tries = batch.end;
            let trials: Vec<(u32, Scene, Trial)> = batch
                .into_par_iter()
                .filter_map(|n| {
                    let candidate = self.candidate(scene, &state, n);
                    let trial = self.trial(&candidate).ok()?;
                    Some((n, candidate, trial))
                })
                .collect();
            let mut better = false;
            for (n, candidate, trial) in trials {
                match self.finding(&candidate, scene, &trial, method, &request, n + 1) {
                    Ok(found) if self.is_better(&found, &state.path) => {
                        state.path.push(found);
                        better = true;
                    }
                    Ok(_) => {}
                    // After a cancellation the path so far is the result.
                    Err(_) if task.is_cancelled() => return Ok(WorseningOutcome { path: state.path, tries: n }),
                    Err(error) => return Err(error),
                }
            }
            let factor = if better { 1.6 } else { 0.8 };
            // After the smallest steps without a worse scene the first step follows again.
            let next = state.step * factor;
            state.step = if next < MIN_STEP_PART { FIRST_STEP_PART } else { next.min(FIRST_STEP_PART) };
        }
        on_try(state.tries, &state.path);
        Ok(WorseningOutcome { path: state.path, tries: state.tries })
    }

    fn is_reached(&self, state: &WorseningState) -> bool {
        self.goal == WorseningGoal::Repair && state.path.len() == 1 && self.is_right(&state.path[0], &state.path[0])
    }

    fn trial(&self, scene: &Scene) -> Result<Trial, SceneError> {
        let (target, layout) = (Target::Measured, self.layout.as_deref());
        let trial = Trial::against(target, layout, &self.radar, scene, self.floor, self.normalisation)?;
        if self.measure != WorseningMeasure::SquaredError {
            trial.footprints();
        }
        Ok(trial)
    }

    fn finding(
        &self,
        scene: &Scene,
        start: &Scene,
        trial: &Trial,
        method: &dyn Reconstructor,
        request: &Request,
        tries: u32,
    ) -> Result<Finding, String> {
        let failed = |error| format!("{}: {error}", method.name());
        let answer = trial.ask(method, request).map_err(failed)?;
        let verdicts = match self.measure {
            WorseningMeasure::SquaredError => OutputVerdicts::default(),
            _ => trial.verdicts(&answer),
        };
        let moves = start.objects.iter().zip(&scene.objects).map(|(a, b)| distance(a, b));
        let moved_metres = moves.fold(0.0, f64::max);
        Ok(Finding { scene: scene.clone(), metrics: answer.metrics, verdicts, moved_metres, tries })
    }

    fn is_better(&self, found: &Finding, path: &[Finding]) -> bool {
        let [start, .., last] = path else {
            let start = &path[0];
            return match self.goal {
                WorseningGoal::Worsen => self.measure.of(found) > self.measure.of(start),
                WorseningGoal::Repair => self.is_right(found, start),
            };
        };
        match self.goal {
            WorseningGoal::Worsen => self.measure.of(found) > self.measure.of(last),
            WorseningGoal::Repair => self.is_right(found, start) && found.moved_metres < last.moved_metres,
        }
    }

    fn is_right(&self, found: &Finding, start: &Finding) -> bool {
        match self.measure {
            WorseningMeasure::SquaredError => found.metrics.squared_error <= REPAIR_PART * start.metrics.squared_error,
            _ => self.measure.of(found).0 == 0,
        }
    }
}

#[cfg(test)]
mod tests;
