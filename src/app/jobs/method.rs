//! One method at work on the scene on screen: its last request and its last output, or the reason why it has none.

use super::memo::Memo;
use super::scene_maps::{MapsRequest, MapsResult, Origin, Pair};
use super::source::Source;
use crate::app::shared::Shared;
use crate::app::state::MethodTimes;
use crate::maps::{Normalisation, RangeAngleMap};
use crate::platform::{self, Instant};
use crate::radar::Radar;
use crate::reconstruct::found::find;
use crate::reconstruct::{Attempt, Detection, NoisePrior, ReconstructError, Reconstruction, Reconstructor, Request};
use crate::scene::Reflector;
use crate::signal::{LayoutSamples, TwoEnds};
use crate::task::{Reply, Task, Worker};
use std::sync::Arc;
use std::time::Duration;

/// Longest time of a reconstruction of a scene that has moved on; a slower one is cancelled. During a drag the last one finishes, so that the user sees it.
const PATIENCE: Duration = Duration::from_millis(400);

/// Most origins kept of those on screen since the output on screen; an output older than them is marked anyway.
const MAX_ORIGINS: usize = 64;

/// The inputs of a method.
#[derive(Clone, PartialEq)]
pub struct Basis {
    radar: Radar,
    ends: Shared<TwoEnds>,
    /// Samples of the layout in use, in place of the two ends.
    heard: Option<Shared<LayoutSamples>>,
    noise: NoisePrior,
    normalisation: Normalisation,
    snapshot_range_metres: Option<f64>,
}

impl Basis {
    /// The inputs from a result of the maps' worker; `None` where it has no samples of the ends.
    pub fn of(result: &MapsResult) -> Option<Basis> {
        let MapsRequest { source: Source { radar, recording, .. }, wanted, layout, .. } = &result.request;
        Some(Basis {
            radar: radar.clone(),
            ends: result.frame.ends.as_ref()?.into(),
            heard: if layout.is_some() { Some(result.heard.clone()?) } else { None },
            noise: if recording.is_some() { NoisePrior::UNKNOWN } else { wanted.floor.into() },
            normalisation: wanted.normalisation,
            snapshot_range_metres: recording.as_ref().and_then(|r| r.range_metres),
        })
    }

    fn request(&self, may_follow: bool, task: Task) -> Request {
        Request {
            noise: self.noise,
            normalisation: self.normalisation,
            snapshot_range_metres: self.snapshot_range_metres,
            may_follow,
            heard: self.heard.as_deref().cloned(),
            task,
        }
    }
}

/// A request for a method's output.
#[derive(Clone)]
pub struct MethodRequest {
    pub document: u64,
    pub origin: Origin,
    pub basis: Basis,
    /// The target map; `None` where a recording has the two ends alone.
    pub target: Option<Shared<RangeAngleMap>>,
    pub method: Shared<dyn Reconstructor>,
    pub listed: bool,
    /// Whether the scene rests. The answer is then that of a method without a memory.
    pub at_rest: bool,
}

impl MethodRequest {
    /// Whether the answer to this request answers `other` too. An answer at rest serves a request in motion; the opposite holds only for a method without a
    /// memory.
    fn serves(&self, other: &MethodRequest) -> bool {
        self.basis == other.basis
            && self.method == other.method
            && self.listed == other.listed
            && (self.at_rest || !other.at_rest || self.method.following().is_none())
    }
}

/// The output of a method.
#[derive(Clone)]
pub struct MethodResult {
    pub document: u64,
    pub pair: Pair,
    /// The threshold that the method derived from the samples, if it did.
    pub eta: Option<f32>,
    /// Detections, the strongest first, where a list was requested.
    pub found: Option<Vec<Detection>>,
    pub reflectors: Vec<Reflector>,
    pub attempts: Vec<Attempt>,
    pub took: Duration,
    basis: Basis,
}

impl MethodResult {
    /// Name of the method.
    pub fn method(&self) -> &'static str {
        self.pair.origin.method
    }

    /// The radar of the samples.
    pub fn radar(&self) -> &Radar {
        &self.basis.radar
    }
}

/// A method's failure to give an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    pub method: &'static str,
    pub reason: String,
}

/// A method's reconstruction, and the list of detections where one was requested.
type Answer = (Reconstruction, Option<Vec<Detection>>);

type MethodReply = (MethodRequest, Result<Answer, ReconstructError>);

/// State of the worker between requests.
struct MethodWorker {
    /// Threads of its own: on shared ones the maps would wait for a slow reconstruction.
    threads: Option<rayon::ThreadPool>,
    /// The method of the last request, with a memory where it has such a form.
    follower: Memo<Shared<dyn Reconstructor>, Option<Arc<dyn Reconstructor>>>,
}

impl MethodWorker {
    fn work(&mut self, q: MethodRequest, task: &Task) -> MethodReply {
        let follower = self.follower.of(q.method.clone(), |method| method.following());
        let method = follower.as_deref().unwrap_or(&**q.method);
        let result = match &self.threads {
            Some(threads) => threads.install(|| reconstruct(&q, method, task)),
            None => reconstruct(&q, method, task),
        };
        (q, result)
    }
}

/// The worker of one method slot, its last request and its last output.
pub struct MethodJob {
    worker: Worker<MethodRequest, MethodReply>,
    asked: Option<MethodRequest>,
    /// Origins wanted by the frames since the output on screen became old, the oldest first, with the times at which they came on screen; none where no panel
    /// of the last frame drew the output.
    wanted: Vec<(Origin, Instant)>,
    /// Time since which the output or its picture belongs to another origin than the one wanted.
    outdated: Option<Instant>,
    output: Option<MethodResult>,
    refusal: Option<Refusal>,
}

impl MethodJob {
    /// Starts the worker's `thread`; `wake` is called from it when there is an output to show.
    pub fn start(thread: &'static str, wake: impl Fn() + Send + Sync + 'static) -> MethodJob {
        let work = |kept: &mut MethodWorker, q: MethodRequest, task: &Task| kept.work(q, task);
        let start = move || MethodWorker { threads: platform::pool(thread), follower: Memo::default() };
        let worker = Worker::spawn(thread, start, work, wake);
        let wanted = Vec::new();
        MethodJob { worker, asked: None, wanted, outdated: None, output: None, refusal: None }
    }

    /// Takes in the worker's answers. Answers to the `latest` maps get their document, origin and target. Adds the
    /// duration of answers from scratch to `times`. Returns messages for the user.
    pub fn poll(&mut self, latest: Option<&MapsResult>, times: &mut MethodTimes) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: (request, Ok(answer)), elapsed, .. } => {
                    // A method with a memory is faster than from scratch; users choose methods by the time from scratch.
                    if request.at_rest || request.method.following().is_none() {
                        times.record(&request.basis.radar, request.method.name(), elapsed);
                    }
                    self.take_in(request, answer, elapsed, latest);
                }
                // Cancelled by the user, or because the scene moved on and the next request waits.
                Reply::Done { result: (_, Err(ReconstructError::Cancelled)), .. } => {}
                Reply::Done { result: (request, Err(error)), .. } => {
                    self.refuse(request.method.name(), error.to_string());
                }
                Reply::Panicked { message, .. } => {
                    let method = self.asked.as_ref().map_or("", |q| q.method.name());
                    self.refuse(method, format!("failed: {message}"));
                    messages.push(format!(
                        "The reconstruction failed ({message}). It was started afresh; choose another method, or change the scene to try again."
                    ));
                }
            }
        }
        messages
    }

    fn take_in(
        &mut self,
        request: MethodRequest,
        (answer, found): Answer,
        took: Duration,
        latest: Option<&MapsResult>,
    ) {
        let MethodRequest { document, origin, basis, target, method, .. } = request;
        let Reconstruction { lambda, mut reflectors, eta, doubt, trace: attempts, .. } = answer;
        if reflectors.is_empty() {
            reflectors = found.iter().flatten().map(Detection::reflector).collect();
        }
        let latest = latest.filter(|r| Basis::of(r).is_some_and(|latest| latest == basis));
        let document = latest.map_or(document, |r| r.request.document);
        let pair = Pair {
            origin: latest.map_or(origin, |r| r.request.origin(method.name())),
            target: latest.and_then(MapsResult::target).or(target),
            output: Shared::new(lambda),
            doubt: doubt.map(Shared::new),
        };
        self.refusal = None;
        self.output = Some(MethodResult { document, pair, eta, found, reflectors, attempts, took, basis });
    }

    /// Records a failure and drops the last output, which is not of this scene.
    fn refuse(&mut self, method: &'static str, reason: String) {
        self.output = None;
        self.refusal = Some(Refusal { method, reason });
    }

    /// Gives the output the document, origin and target of new maps, where they are of the same samples, as when a scene comes to rest.
    pub fn aim(&mut self, maps: &MapsResult) {
        if let Some(output) = &mut self.output
            && Basis::of(maps).is_some_and(|basis| basis == output.basis)
        {
            output.document = maps.request.document;
            output.pair.origin = maps.request.origin(output.method());
            output.pair.target = maps.target().or(output.pair.target.take());
        }
    }

    /// Notes the origin of the output that panels of this frame want to draw, `None` where none does, and decides how old is what they draw: the output, and
    /// the pictures and figures of it or of one before it, `pictured`. The age goes on from the change of the scene until its pictures are there, however long
    /// maps, output and pictures take one after another. An output that became old out of sight is dropped, since its age is unknown.
    pub fn look(&mut self, wanted: Option<Origin>, pictured: Option<&Pair>) {
        let Some(wanted) = wanted else {
            (self.wanted, self.outdated) = (Vec::new(), None);
            return;
        };
        if self.wanted.is_empty() && self.output.as_ref().is_some_and(|o| o.pair.origin != wanted) {
            (self.output, self.asked) = (None, None);
        }
        if self.wanted.last().is_none_or(|(last, _)| *last != wanted) {
            self.wanted.push((wanted, Instant::now()));
        }
        // Both are old since the origin after theirs, or since the first one where theirs was never seen.
        let after = |pair: &Pair| self.wanted.iter().rposition(|(of, _)| *of == pair.origin).map_or(0, |at| at + 1);
        let drawn = [pictured, self.output.as_ref().map(|output| &output.pair)];
        let next = drawn.into_iter().flatten().map(after).min().unwrap_or(self.wanted.len());
        self.outdated = self.wanted.get(next).map(|(_, since)| *since);
        self.wanted.drain(..next.saturating_sub(1));
        if self.wanted.len() > MAX_ORIGINS {
            self.wanted.remove(2);
        }
    }

    /// Asks for an output, unless the last request serves; `held` while an object is dragged.
    pub fn ask(&mut self, request: MethodRequest, held: bool) {
        if !self.asked.as_ref().is_some_and(|a| a.serves(&request)) {
            if !held {
                self.worker.cancel_older_than(PATIENCE);
            }
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// Cancels the work at the user's request.
    pub fn cancel(&mut self) {
        self.worker.cancel();
        let method = self.asked.as_ref().map_or("", |q| q.method.name());
        let reason = "cancelled; change the scene or the method to start again".to_owned();
        self.refusal = Some(Refusal { method, reason });
    }

    /// Cancels the work while it is out of sight; the next frame with it in sight asks again.
    pub fn rest(&mut self) {
        if self.worker.is_busy() {
            self.worker.cancel();
            self.asked = None;
        }
    }

    /// The latest output.
    pub fn output(&self) -> Option<&MethodResult> {
        self.output.as_ref()
    }

    /// The reason why there is no output for the scene on screen.
    pub fn refusal(&self) -> Option<&Refusal> {
        self.refusal.as_ref()
    }

    /// Progress, 0 to 1; `None` when no work runs.
    pub fn progress(&self) -> Option<f32> {
        self.worker.progress()
    }

    /// Whether the worker is busy.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Name of the method of the shown output, where it is of the samples on screen and another method works on them.
    pub fn of_another_method(&self) -> Option<&'static str> {
        let (output, asked) = (self.output.as_ref()?, self.asked.as_ref()?);
        let is_only_method = output.basis == asked.basis && output.method() != asked.method.name();
        (is_only_method && self.is_busy()).then_some(output.method())
    }

    /// Time since which the output or its picture belongs to other samples or another method than those on screen, if it does.
    pub fn outdated(&self) -> Option<Instant> {
        self.outdated
    }
}

fn reconstruct(q: &MethodRequest, method: &dyn Reconstructor, task: &Task) -> Result<Answer, ReconstructError> {
    let Basis { radar, ends, .. } = &q.basis;
    let request = q.basis.request(!q.at_rest, task.clone());
    let answer = method.reconstruct(radar, ends, &request)?;
    let list = || find(method, radar, ends, &request, &answer);
    let found = q.listed.then(list).transpose()?;
    Ok((answer, found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::Normalisation;
    use crate::scene::Scene;
    use crate::signal::Floor;

    #[test]
    fn a_picture_is_old_since_the_change_after_its_scene() {
        let origins: Vec<Origin> = [1.0, 2.0, 3.0]
            .map(|y| {
                let scene = Shared::new(Scene::of_points([(0.0, y)]));
                let source = Source { radar: Radar::default(), scene, recording: None, floor: Floor::Thesis };
                Origin { source, normalisation: Normalisation::MinMax, layout: None, method: "stub" }
            })
            .into();
        let output = Shared::new(RangeAngleMap { lambda: Default::default() });
        let mut job = MethodJob::start("old pictures", || ());
        let mut since = |wanted: usize, pictured: usize| {
            let pair = Pair { origin: origins[pictured].clone(), target: None, output: output.clone(), doubt: None };
            job.look(Some(origins[wanted].clone()), Some(&pair));
            job.outdated()
        };
        assert_eq!(since(0, 0), None);
        let first = since(1, 0).unwrap();
        std::thread::sleep(Duration::from_millis(2));
        assert_eq!([since(1, 0), since(2, 0)], [Some(first); 2], "further changes make it no younger");
        assert!(since(2, 1).unwrap() > first, "the next picture is old since a later change");
        assert_eq!(since(2, 2), None);
    }
}
