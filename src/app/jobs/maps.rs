//! The worker of the maps on screen, its last request and its last result.

use super::derived::MAX_OUTDATED_WORK_TIME;
use super::rest::Rest;
use super::scene_maps::{MapsRequest, MapsResult, MapsState};
use crate::engine::EngineStage;
use crate::platform::Instant;
use crate::signal::SimulationError;
use crate::task::{Reply, Task, Worker};
use std::time::Duration;

pub struct MapsJob {
    worker: Worker<MapsRequest, Result<MapsResult, SimulationError>>,
    /// The task of all requests at rest, until the scene changes.
    settling: Task,
    /// Whether maps were cancelled since the last ones arrived. The next ones are then finished, so that the user sees some.
    gave_up: bool,
    asked: Option<MapsRequest>,
    rest: Rest,
    /// Time until the scene on screen rests; `None` where it rests, or an object is held.
    pub rests_in: Option<Duration>,
    /// Time of the first request without an answer.
    pub waiting: Option<Instant>,
    result: Option<MapsResult>,
    /// Time of the last maps that followed a change.
    pub took: Option<Duration>,
    scene_error: Option<String>,
    pub requests: u64,
}

impl MapsJob {
    /// Starts the worker; `wake` is called from its thread when there is something to show.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> MapsJob {
        let work = |state: &mut MapsState, request: MapsRequest, task: &Task| state.work(request, task);
        let worker = Worker::spawn("maps", MapsState::default, work, wake);
        MapsJob {
            worker,
            settling: Task::default(),
            gave_up: false,
            asked: None,
            rest: Rest::default(),
            rests_in: None,
            waiting: None,
            result: None,
            took: None,
            scene_error: None,
            requests: 0,
        }
    }

    /// Takes in the worker's maps; `on_maps` is called with each result that arrived. Returns messages for the user.
    pub fn poll(&mut self, mut on_maps: impl FnMut(&MapsResult)) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.worker.replies() {
            self.waiting = self.waiting.filter(|_| self.worker.is_busy());
            match reply {
                Reply::Done { result: Ok(mut result), elapsed, .. } => {
                    result.took = elapsed;
                    self.take_in(result, &mut on_maps);
                }
                Reply::Done { result: Err(SimulationError::Scene(error)), .. } => {
                    self.scene_error = Some(error.to_string())
                }
                // The newer request is on its way.
                Reply::Done { result: Err(SimulationError::Cancelled(_)), .. } => {}
                Reply::Panicked { message, .. } => {
                    self.waiting.get_or_insert_with(Instant::now);
                    messages.push(format!(
                        "Computing the maps failed ({message}). The last maps stay; undo the last change (Ctrl+Z) or change the scene."
                    ));
                }
            }
        }
        messages
    }

    /// Keeps the samples of the last result where they are the same bits, as they are whether a scene rests or not. A method's output of them then stays
    /// valid, with the latest target.
    fn take_in(&mut self, mut result: MapsResult, on_maps: &mut impl FnMut(&MapsResult)) {
        let before = self.result.as_ref().and_then(|r| r.frame.ends.as_ref());
        if let (Some(ends), Some(before)) = (&mut result.frame.ends, before)
            && **ends == **before
        {
            *ends = before.clone();
        }
        on_maps(&result);
        let only_settled = result.request.at_rest && result.frame.report.ran(EngineStage::Signal);
        if !only_settled || self.took.is_none() {
            self.took = Some(result.took);
        }
        self.result = Some(result);
        self.scene_error = None;
        self.gave_up = false;
    }

    /// Asks for maps, unless the last request was the same; at rest if the scene rests. `held` while an object is dragged.
    pub fn ask(&mut self, mut request: MapsRequest, held: bool) {
        let rests_in = self.rest.time_until_rest(&request.source, held, Instant::now());
        self.rests_in = rests_in.filter(|left| !left.is_zero());
        // Maps that follow a drag come first: those at rest may take long, and would replace a waiting request.
        let follows = self.result.as_ref().is_some_and(|r| r.request.source == request.source);
        request.at_rest = rests_in == Some(Duration::ZERO) && follows;
        if self.asked.as_ref() != Some(&request) {
            self.requests += 1;
            if self.asked.as_ref().is_some_and(|a| a.source != request.source) {
                self.make_way(held);
            }
            let task = if request.at_rest { self.settling.clone() } else { Task::default() };
            self.worker.request_for(task, request.clone());
            if !request.at_rest {
                // The same maps at rest do not make those on screen old.
                self.waiting.get_or_insert_with(Instant::now);
            }
            self.asked = Some(request);
        }
    }

    /// Cancels work on the scene before its change: maps at rest at once, others where they take long and no object is held.
    fn make_way(&mut self, held: bool) {
        std::mem::take(&mut self.settling).cancel();
        if !held && !self.gave_up {
            self.gave_up = self.worker.cancel_older_than(MAX_OUTDATED_WORK_TIME);
        }
    }

    pub fn result(&self) -> Option<&MapsResult> {
        self.result.as_ref()
    }

    /// The reason why the scene on screen can't be computed.
    pub fn scene_error(&self) -> Option<&str> {
        self.scene_error.as_deref()
    }

    /// Whether the worker is busy, or will be as soon as the scene rests.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy() || self.rests_in.is_some()
    }

    /// Whether the maps are those of the scene on screen at rest.
    pub fn is_settled(&self) -> bool {
        let latest = self.asked.as_ref().zip(self.result.as_ref());
        latest.is_some_and(|(asked, result)| result.frame.settled && *asked == result.request)
    }

    /// Whether maps of the scene at rest are being computed.
    pub fn is_settling(&self) -> bool {
        self.worker.is_busy() && self.asked.as_ref().is_some_and(|asked| asked.at_rest) && !self.is_settled()
    }

    /// Whether the last request was for the samples of the ends.
    pub fn wants_ends(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked.wanted.ends)
    }
}
