//! One method at work on the scene on screen: what it was asked for, what it made last, or why it made nothing.

use super::memo::Memo;
use super::scene_maps::{MapsRequest, MapsResult, Pair};
use super::source::Source;
use crate::app::shared::Shared;
use crate::maps::{Normalisation, RangeAngleMap};
use crate::platform::{self, Instant};
use crate::radar::Radar;
use crate::reconstruct::Attempt;
use crate::reconstruct::found::find;
use crate::reconstruct::{Detection, NoisePrior, ReconstructError, Reconstruction, Reconstructor, Request};
use crate::scene::Reflector;
use crate::signal::{LayoutSamples, TwoEnds};
use crate::task::{Reply, Task, Worker};
use std::sync::Arc;
use std::time::Duration;

/// A reconstruction that is slower than this is cancelled when the scene has moved on, unless it is being dragged: then the last one
/// finishes, so that something is seen.
const PATIENCE: Duration = Duration::from_millis(400);

/// What a method works on.
#[derive(Clone, PartialEq)]
pub struct Basis {
    radar: Radar,
    ends: Shared<TwoEnds>,
    /// What another layout hears in their place.
    heard: Option<Shared<LayoutSamples>>,
    noise: NoisePrior,
    normalisation: Normalisation,
    snapshot_range_metres: Option<f64>,
}

impl Basis {
    /// What a method gets of a scene; `None` where its ends were not wanted.
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

/// What a method is asked for.
#[derive(Clone)]
pub struct MethodRequest {
    /// Which document it is of.
    pub document: u64,
    /// Where the samples come from.
    pub source: Source,
    /// What it works on.
    pub basis: Basis,
    /// What it aims for; `None` where a recording has the two ends alone.
    pub target: Option<Shared<RangeAngleMap>>,
    pub method: Shared<dyn Reconstructor>,
    /// Whether what was found is to be listed.
    pub listed: bool,
    /// Whether the scene rests: the answer is then that of a method without a memory.
    pub at_rest: bool,
}

impl MethodRequest {
    /// Whether what was made for this one is an answer to the `other` too: one at rest answers one in motion, and the other way round
    /// only for a method without a memory.
    fn serves(&self, other: &MethodRequest) -> bool {
        self.basis == other.basis
            && self.method == other.method
            && self.listed == other.listed
            && (self.at_rest || !other.at_rest || self.method.following().is_none())
    }
}

/// What a method made.
#[derive(Clone)]
pub struct MethodResult {
    /// Its name.
    pub method: &'static str,
    /// Which document its samples are of.
    pub document: u64,
    /// Its map, and the one it aimed for.
    pub pair: Pair,
    /// The threshold that fits it, where the method read one off the samples.
    pub eta: Option<f32>,
    /// What it found, the strongest first, where a list was asked for.
    pub found: Option<Vec<Detection>>,
    /// Where it found reflectors.
    pub reflectors: Vec<Reflector>,
    /// What it tried, the first first.
    pub attempts: Vec<Attempt>,
    /// Time it took.
    pub took: Duration,
    basis: Basis,
}

impl MethodResult {
    /// The radar that it reconstructed for.
    pub fn radar(&self) -> &Radar {
        &self.basis.radar
    }
}

/// Why a method gave nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Its name.
    pub method: &'static str,
    /// Why.
    pub reason: String,
}

/// What a method made of the samples, and the list of what it found where one was asked for.
type Answer = (Reconstruction, Option<Vec<Detection>>);

type MethodReply = (MethodRequest, Result<Answer, ReconstructError>);

/// What the worker keeps from one request to the next.
struct MethodWorker {
    /// Threads of its own: on shared ones the maps would wait for the end of a slow reconstruction.
    threads: Option<rayon::ThreadPool>,
    /// The method asked last, with a memory where it can have one.
    follower: Memo<Shared<dyn Reconstructor>, Option<Arc<dyn Reconstructor>>>,
}

impl MethodWorker {
    fn new(thread: &'static str) -> MethodWorker {
        MethodWorker { threads: platform::pool(thread), follower: Memo::default() }
    }

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

/// The worker, what it was asked last, and what it made last.
pub struct MethodJob {
    worker: Worker<MethodRequest, MethodReply>,
    asked: Option<MethodRequest>,
    /// Since when the output belongs to something else than the maps.
    outdated: Option<Instant>,
    /// Whether a panel of the frame before drew something of it.
    was_drawn: bool,
    output: Option<MethodResult>,
    refusal: Option<Refusal>,
    /// A time that was not taken yet: for which radar, of which method.
    time: Option<(Radar, &'static str, Duration)>,
}

impl MethodJob {
    /// Starts the worker's `thread`; `wake` is called from it when there is something to show.
    pub fn start(thread: &'static str, wake: impl Fn() + Send + Sync + 'static) -> MethodJob {
        let work = |kept: &mut MethodWorker, q: MethodRequest, task: &Task| kept.work(q, task);
        let worker = Worker::spawn(thread, move || MethodWorker::new(thread), work, wake);
        MethodJob { worker, asked: None, outdated: None, was_drawn: false, output: None, refusal: None, time: None }
    }

    /// Takes in what the worker made of the `latest` maps or earlier ones. Returns messages for the user.
    pub fn poll(&mut self, latest: Option<&MapsResult>) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: (request, Ok(answer)), elapsed, .. } => {
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
        let MethodRequest { document, source, basis, target, method, at_rest, .. } = request;
        // A method with a memory is faster than the same from scratch, by which methods are chosen.
        if at_rest || method.following().is_none() {
            self.time = Some((basis.radar.clone(), method.name(), took));
        }
        let Reconstruction { lambda, mut reflectors, eta, doubt, trace: attempts, .. } = answer;
        if reflectors.is_empty() {
            reflectors = found.iter().flatten().map(Detection::reflector).collect();
        }
        let latest = latest.filter(|r| Basis::of(r).is_some_and(|latest| latest == basis));
        let document = latest.map_or(document, |r| r.request.document);
        let pair = Pair {
            source: latest.map_or(source, |r| r.request.source.clone()),
            target: latest.and_then(MapsResult::target).or(target),
            output: Shared::new(lambda),
            doubt: doubt.map(Shared::new),
        };
        self.refusal = None;
        let method = method.name();
        self.output = Some(MethodResult { method, document, pair, eta, found, reflectors, attempts, took, basis });
    }

    /// There is no output, and the last one is not its own: nothing of it stays.
    fn refuse(&mut self, method: &'static str, reason: String) {
        self.output = None;
        self.refusal = Some(Refusal { method, reason });
    }

    /// The time of the latest answer from scratch, once.
    pub fn take_time(&mut self) -> Option<(Radar, &'static str, Duration)> {
        self.time.take()
    }

    /// New maps of the same samples, as when a scene comes to rest: the output stays, is theirs, and aims for their target.
    pub fn aim(&mut self, maps: &MapsResult) {
        if let Some(output) = &mut self.output
            && Basis::of(maps).is_some_and(|basis| basis == output.basis)
        {
            output.document = maps.request.document;
            output.pair.source.clone_from(&maps.request.source);
            output.pair.target = maps.target().or(output.pair.target.take());
        }
    }

    /// Notes whether a panel of this frame draws something of its output. What changed out of sight is not drawn: its age is not known.
    pub fn look(&mut self, is_drawn: bool, source: &Source, method: Option<&str>) {
        let is_current = |o: &MethodResult| o.pair.source == *source && Some(o.method) == method;
        if is_drawn && !self.was_drawn && !self.output.as_ref().is_none_or(is_current) {
            (self.output, self.asked) = (None, None);
        }
        self.was_drawn = is_drawn;
    }

    /// Asks for an output, unless it was asked for just that; `held` while something is dragged.
    pub fn ask(&mut self, request: MethodRequest, held: bool) {
        let current =
            self.output.as_ref().is_none_or(|o| o.method == request.method.name() && o.basis == request.basis);
        self.outdated = if current { None } else { self.outdated.or_else(|| Some(Instant::now())) };
        if !self.asked.as_ref().is_some_and(|a| a.serves(&request)) {
            if !held {
                self.worker.cancel_older_than(PATIENCE);
            }
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// Stops what runs, as the user wished.
    pub fn cancel(&mut self) {
        self.worker.cancel();
        let method = self.asked.as_ref().map_or("", |q| q.method.name());
        let reason = "cancelled; change the scene or the method to start again".to_owned();
        self.refusal = Some(Refusal { method, reason });
    }

    /// Stops what runs, since it is out of sight; it is asked for again once it is in sight.
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

    /// Why there is no output for the scene on screen.
    pub fn refusal(&self) -> Option<&Refusal> {
        self.refusal.as_ref()
    }

    /// Progress, 0 to 1; `None` when nothing runs.
    pub fn progress(&self) -> Option<f32> {
        self.worker.progress()
    }

    /// Whether it has something to do.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// The method whose output is shown, where it is of the samples on screen and another method is at work on them.
    pub fn of_another_method(&self) -> Option<&'static str> {
        let (output, asked) = (self.output.as_ref()?, self.asked.as_ref()?);
        let is_only_method = output.basis == asked.basis && output.method != asked.method.name();
        (is_only_method && self.is_busy()).then_some(output.method)
    }

    /// Since when the output belongs to something else than the maps, where it does.
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
