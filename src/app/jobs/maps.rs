//! The maps of the scene on screen: what their worker was asked for, and what it made last.

use super::rest::{Motion, Rest};
use super::scene_maps::{MapsRequest, MapsResult, MapsState};
use crate::engine::EngineStage;
use crate::platform::Instant;
use crate::signal::Unfinished;
use crate::task::{Reply, Task, Worker};
use std::time::Duration;

/// Maps of a scene that has changed are given up when they took longer than this.
const PATIENCE: Duration = Duration::from_millis(400);

/// The worker, what it was asked last, and what it made last.
pub struct MapsJob {
    worker: Worker<MapsRequest, Result<MapsResult, Unfinished>>,
    /// What every request at rest works on, until the scene changes.
    settling: Task,
    /// Whether maps were given up since the last ones arrived: the next come to an end, so that something is seen.
    gave_up: bool,
    asked: Option<MapsRequest>,
    rest: Rest,
    motion: Motion,
    /// When the worker was asked for what it hasn't answered yet.
    waiting: Option<Instant>,
    result: Option<MapsResult>,
    /// Time of the last maps that followed a change.
    took: Option<Duration>,
    scene_error: Option<String>,
    requests: u64,
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
            motion: Motion::default(),
            waiting: None,
            result: None,
            took: None,
            scene_error: None,
            requests: 0,
        }
    }

    /// Takes in what the worker made; `on_maps` is called with all maps that arrived. Returns messages for the user.
    pub fn poll(&mut self, mut on_maps: impl FnMut(&MapsResult)) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.worker.replies() {
            self.waiting = self.waiting.filter(|_| self.worker.is_busy());
            match reply {
                Reply::Done { result: Ok(mut result), elapsed, .. } => {
                    result.took = elapsed;
                    self.take_in(result, &mut on_maps);
                }
                Reply::Done { result: Err(Unfinished::Scene(error)), .. } => self.scene_error = Some(error.to_string()),
                // What was asked for instead is on its way.
                Reply::Done { result: Err(Unfinished::Cancelled(_)), .. } => {}
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

    /// The samples of a scene's ends are the same bits whether it rests or not: what a method made of them before stays its output, but
    /// aims for the latest target.
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

    /// Asks for maps, unless it was asked for just these; at rest if the scene rests. `held` while something is dragged.
    pub fn ask(&mut self, mut request: MapsRequest, held: bool) {
        self.motion = self.rest.look(&request.source, held, Instant::now());
        // Maps that follow the hand come first: those at rest may take long, and would push a request that waits aside.
        let follows = self.result.as_ref().is_some_and(|r| r.request.source == request.source);
        request.at_rest = self.motion == Motion::AtRest && follows;
        if self.asked.as_ref() != Some(&request) {
            self.requests += 1;
            if self.asked.as_ref().is_some_and(|a| a.source != request.source) {
                self.make_way(held);
            }
            let task = if request.at_rest { self.settling.clone() } else { Task::default() };
            self.worker.request_for(task, request.clone());
            if !request.at_rest {
                // Maps that are only computed once more are not old meanwhile.
                self.waiting.get_or_insert_with(Instant::now);
            }
            self.asked = Some(request);
        }
    }

    /// The scene has changed: what was only computed once more is given up at once, other maps where they take long and nothing is
    /// held.
    fn make_way(&mut self, held: bool) {
        std::mem::take(&mut self.settling).cancel();
        if !held && !self.gave_up {
            self.gave_up = self.worker.cancel_older_than(PATIENCE);
        }
    }

    /// The latest maps.
    pub fn result(&self) -> Option<&MapsResult> {
        self.result.as_ref()
    }

    /// Why the scene on screen can't be computed.
    pub fn scene_error(&self) -> Option<&str> {
        self.scene_error.as_deref()
    }

    /// Requests sent to the worker.
    pub fn requests(&self) -> u64 {
        self.requests
    }

    /// Whether it has something to do, or will as soon as the scene rests.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy() || self.rests_in().is_some()
    }

    /// How long until the scene on screen rests; `None` where it does, or is held.
    pub fn rests_in(&self) -> Option<Duration> {
        match self.motion {
            Motion::RestsIn(left) => Some(left),
            Motion::Held | Motion::AtRest => None,
        }
    }

    /// Whether the maps are those of the scene on screen at rest.
    pub fn is_settled(&self) -> bool {
        let latest = self.asked.as_ref().zip(self.result.as_ref());
        latest.is_some_and(|(asked, result)| result.frame.settled && *asked == result.request)
    }

    /// Whether they are being computed.
    pub fn is_settling(&self) -> bool {
        self.worker.is_busy() && self.asked.as_ref().is_some_and(|asked| asked.at_rest) && !self.is_settled()
    }

    /// Time of the last maps and pictures that followed a change.
    pub fn took(&self) -> Option<Duration> {
        self.took
    }

    /// Whether the samples of the ends were asked for.
    pub fn wants_ends(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked.wanted.ends)
    }

    /// Since when it has been asked for maps that it hasn't made yet.
    pub fn waiting(&self) -> Option<Instant> {
        self.waiting
    }
}
