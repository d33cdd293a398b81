//! The worker of one method for the scene on screen: the last request, and the last output or the reason why there is none.

use super::derived::MAX_OUTDATED_WORK_TIME;
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

/// Most entries of [`MethodJob::wanted`]. An output older than all of them is marked as outdated in any case.
const MAX_ORIGINS: usize = 64;

/// The inputs of a method: samples of the two ends or of a layout, the radar, and the noise prior.
#[derive(Clone, PartialEq)]
pub struct Basis {
    radar: Radar,
    ends: Shared<TwoEnds>,
    /// Samples of the layout in use, in place of the two ends.
    layout_samples: Option<Shared<LayoutSamples>>,
    noise: NoisePrior,
    normalisation: Normalisation,
    snapshot_range_metres: Option<f64>,
}

impl Basis {
    /// The inputs in a result of the maps' worker. `None` where it lacks the samples of the ends, or those of the layout in use.
    pub fn of(result: &MapsResult) -> Option<Basis> {
        let MapsRequest { source: Source { radar, recording, .. }, wanted, layout, .. } = &result.request;
        Some(Basis {
            radar: radar.clone(),
            ends: result.frame.ends.as_ref()?.into(),
            layout_samples: if layout.is_some() { Some(result.layout_samples.clone()?) } else { None },
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
            layout_samples: self.layout_samples.as_deref().cloned(),
            task,
        }
    }
}

/// A request for a method's output.
#[derive(Clone)]
pub struct MethodRequest {
    /// Identifier of the document on screen.
    pub document: u64,
    pub origin: Origin,
    pub basis: Basis,
    /// The target map, `[range bins, columns]`; `None` where a recording has the two ends alone.
    pub target: Option<Shared<RangeAngleMap>>,
    pub method: Shared<dyn Reconstructor>,
    /// Whether a list of detections is requested.
    pub listed: bool,
    /// Whether the scene is not being changed. The method then computes from scratch, without its memory of the last answer.
    pub at_rest: bool,
}

impl MethodRequest {
    /// Whether the answer to this request answers `other` too. An answer from scratch serves a request during a change of the scene. The opposite
    /// holds only for a method without a memory.
    fn serves(&self, other: &MethodRequest) -> bool {
        self.basis == other.basis
            && self.method == other.method
            && self.listed == other.listed
            && (self.at_rest || !other.at_rest || self.method.following().is_none())
    }
}

#[derive(Clone)]
pub struct MethodResult {
    /// Identifier of the document that the output belongs to.
    pub document: u64,
    pub pair: Pair,
    /// The threshold on Lambda that the method derived from the samples, if it did.
    pub eta: Option<f32>,
    /// Detections, the strongest first, where a list was requested.
    pub found: Option<Vec<Detection>>,
    /// The method's reflectors, or those of the detections where it has none.
    pub reflectors: Vec<Reflector>,
    /// The search's attempts, in order.
    pub attempts: Vec<Attempt>,
    pub took: Duration,
    basis: Basis,
}

impl MethodResult {
    pub fn method(&self) -> &'static str {
        self.pair.origin.method
    }

    pub fn radar(&self) -> &Radar {
        &self.basis.radar
    }
}

/// The method that gave no output, and the reason as a clause.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    pub method: &'static str,
    pub reason: String,
}

/// A method's reconstruction, and the list of detections where one was requested.
type Answer = (Reconstruction, Option<Vec<Detection>>);

type MethodReply = (MethodRequest, Result<Answer, ReconstructError>);

struct MethodWorker {
    /// The worker's own threads: on shared ones the maps would wait for a slow reconstruction.
    threads: Option<rayon::ThreadPool>,
    /// The form with a memory of the last request's method, if it has one.
    follower: Memo<Shared<dyn Reconstructor>, Option<Arc<dyn Reconstructor>>>,
}

impl MethodWorker {
    fn work(&mut self, request: MethodRequest, task: &Task) -> MethodReply {
        let follower = self.follower.of(request.method.clone(), |method| method.following());
        let method = follower.as_deref().unwrap_or(&**request.method);
        let result = match &self.threads {
            Some(threads) => threads.install(|| reconstruct(&request, method, task)),
            None => reconstruct(&request, method, task),
        };
        (request, result)
    }
}

pub struct MethodJob {
    worker: Worker<MethodRequest, MethodReply>,
    last_request: Option<MethodRequest>,
    /// Origins that the frames wanted since the output on screen became outdated, the oldest first, each with the time at which it was first wanted.
    /// Empty where no panel of the last frame drew the output.
    wanted: Vec<(Origin, Instant)>,
    /// Time since which the output or its picture belongs to another origin than the wanted one.
    outdated: Option<Instant>,
    output: Option<MethodResult>,
    refusal: Option<Refusal>,
}

impl MethodJob {
    /// Starts the worker on a thread named `thread`. It calls `wake` when there is a reply.
    pub fn start(thread: &'static str, wake: impl Fn() + Send + Sync + 'static) -> MethodJob {
        let work = |state: &mut MethodWorker, request: MethodRequest, task: &Task| state.work(request, task);
        let start = move || MethodWorker { threads: platform::pool(thread), follower: Memo::default() };
        let worker = Worker::spawn(thread, start, work, wake);
        let wanted = Vec::new();
        MethodJob { worker, last_request: None, wanted, outdated: None, output: None, refusal: None }
    }

    /// Reads the worker's replies. An answer for the samples of the `latest` maps gets their document, origin and target. Adds the duration of
    /// answers from scratch to `times`. Returns messages for the user.
    pub fn poll(&mut self, latest: Option<&MapsResult>, times: &mut MethodTimes) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: (request, Ok(answer)), elapsed, .. } => {
                    // Users choose methods by the time from scratch, and a method with a memory takes less.
                    if request.at_rest || request.method.following().is_none() {
                        times.record(&request.basis.radar, request.method.name(), elapsed);
                    }
                    self.set_output(request, answer, elapsed, latest);
                }
                // Cancelled by the user, or because the scene has changed and the next request waits.
                Reply::Done { result: (_, Err(ReconstructError::Cancelled)), .. } => {}
                Reply::Done { result: (request, Err(error)), .. } => {
                    self.refuse(request.method.name(), error.to_string());
                }
                Reply::Panicked { message, .. } => {
                    let method = self.last_request.as_ref().map_or("", |request| request.method.name());
                    self.refuse(method, format!("failed: {message}"));
                    messages.push(format!(
                        "The reconstruction failed ({message}). It was started afresh; choose another method, or change the scene to try again."
                    ));
                }
            }
        }
        messages
    }

    /// Makes an answer the output, with the `latest` maps' document, origin and target where they are of the same samples.
    fn set_output(
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

    /// Gives the output the document, origin and target of new maps, where they are of the same samples. They are when a drag ends.
    pub fn attach_maps(&mut self, maps: &MapsResult) {
        if let Some(output) = &mut self.output
            && Basis::of(maps).is_some_and(|basis| basis == output.basis)
        {
            output.document = maps.request.document;
            output.pair.origin = maps.request.origin(output.method());
            output.pair.target = maps.target().or(output.pair.target.take());
        }
    }

    /// Takes the origin `wanted` by the panels of this frame, `None` where none draws the output, and sets the time since which they draw something
    /// outdated. They draw the output, and the pictures and figures of `pictured`, which is the output or an earlier one. The time counts from the
    /// change of the scene until its pictures are there: maps, output and pictures take their time one after another. An output that became outdated
    /// while no panel drew it is dropped, since the time is unknown.
    pub fn track_outdated_output(&mut self, wanted: Option<Origin>, pictured: Option<&Pair>) {
        let Some(wanted) = wanted else {
            (self.wanted, self.outdated) = (Vec::new(), None);
            return;
        };
        if self.wanted.is_empty() && self.output.as_ref().is_some_and(|o| o.pair.origin != wanted) {
            (self.output, self.last_request) = (None, None);
        }
        if self.wanted.last().is_none_or(|(last, _)| *last != wanted) {
            self.wanted.push((wanted, Instant::now()));
        }
        // Each is outdated since the origin after its own came, or since the first one where its own was never wanted.
        let after = |pair: &Pair| self.wanted.iter().rposition(|(of, _)| *of == pair.origin).map_or(0, |at| at + 1);
        let drawn = [pictured, self.output.as_ref().map(|output| &output.pair)];
        let next = drawn.into_iter().flatten().map(after).min().unwrap_or(self.wanted.len());
        self.outdated = self.wanted.get(next).map(|(_, since)| *since);
        self.wanted.drain(..next.saturating_sub(1));
        if self.wanted.len() > MAX_ORIGINS {
            // The first two set the time.
            self.wanted.remove(2);
        }
    }

    /// Sends a request to the worker, unless the last one serves. `held` is whether an object is being dragged.
    pub fn ask(&mut self, request: MethodRequest, held: bool) {
        if !self.last_request.as_ref().is_some_and(|last| last.serves(&request)) {
            if !held {
                self.worker.cancel_older_than(MAX_OUTDATED_WORK_TIME);
            }
            self.worker.request(request.clone());
            self.last_request = Some(request);
        }
    }

    /// Cancels the work at the user's request.
    pub fn cancel(&mut self) {
        self.worker.cancel();
        let method = self.last_request.as_ref().map_or("", |request| request.method.name());
        let reason = "cancelled; change the scene or the method to start again".to_owned();
        self.refusal = Some(Refusal { method, reason });
    }

    /// Cancels the work while no panel shows its output. The next frame with such a panel sends the request again.
    pub fn cancel_hidden_work(&mut self) {
        if self.worker.is_busy() {
            self.worker.cancel();
            self.last_request = None;
        }
    }

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

    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Name of the method of the output on screen, where the output is of the requested samples and another method works on them.
    pub fn of_another_method(&self) -> Option<&'static str> {
        let (output, requested) = (self.output.as_ref()?, self.last_request.as_ref()?);
        let is_only_method = output.basis == requested.basis && output.method() != requested.method.name();
        (is_only_method && self.is_busy()).then_some(output.method())
    }

    pub fn outdated(&self) -> Option<Instant> {
        self.outdated
    }
}

fn reconstruct(
    method_request: &MethodRequest,
    method: &dyn Reconstructor,
    task: &Task,
) -> Result<Answer, ReconstructError> {
    let MethodRequest { basis, listed, at_rest, .. } = method_request;
    let Basis { radar, ends, .. } = basis;
    let request = basis.request(!at_rest, task.clone());
    let answer = method.reconstruct(radar, ends, &request)?;
    let list = || find(method, radar, ends, &request, &answer);
    let found = listed.then(list).transpose()?;
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
            job.track_outdated_output(Some(origins[wanted].clone()), Some(&pair));
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
