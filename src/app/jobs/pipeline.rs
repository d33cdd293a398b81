//! What to compute, and what came of it: the UI's side of the two workers.
//!
//! ```text
//!   scene, what is shown ──► maps worker (engine, pictures, scores) ──► MapsResult
//!                               ▲                                          │ ends, target
//!                               └── pair of maps ◄── method worker ◄───────┘
//! ```

use super::recorded::Unexplained;
use super::rest::{Motion, Rest};
use super::scene_maps::{MapsRequest, MapsResult, MapsState, Pair, Scores};
use crate::app::state::{CutMap, MapKind, Panel, State};
use crate::engine::{Stage, Wanted};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::Radar;
use crate::reconstruct::found::find;
use crate::reconstruct::{Detection, ReconstructError, Reconstruction, Reconstructor, Request};
use crate::recording;
use crate::scene::Reflector;
use crate::signal::{Floor, TwoEnds};
use crate::task::{Reply, Task, Worker};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A reconstruction that is slower than this is cancelled when the scene has moved on, unless it is being dragged: then the last one
/// finishes, so that something is seen.
const PATIENCE: Duration = Duration::from_millis(400);

/// What is older than this on screen is marked as old: less would flicker.
const STALE: Duration = Duration::from_millis(400);

/// What a method works on.
#[derive(Clone)]
struct Basis {
    radar: Radar,
    ends: Arc<TwoEnds>,
    floor: Floor,
    normalisation: Normalisation,
    snapshot_range_metres: Option<f64>,
}

impl Basis {
    /// What the method gets of a scene; `None` where nobody wanted its ends.
    fn of(result: &MapsResult) -> Option<Basis> {
        let MapsRequest { radar, wanted, recording, .. } = &result.request;
        Some(Basis {
            radar: radar.clone(),
            ends: result.frame.ends.clone()?,
            floor: if recording.is_some() { recording::FLOOR } else { wanted.floor },
            normalisation: wanted.normalisation,
            snapshot_range_metres: recording.as_ref().and_then(|r| r.range_metres),
        })
    }

    fn same(&self, other: &Basis) -> bool {
        Arc::ptr_eq(&self.ends, &other.ends)
            && (self.floor, self.normalisation) == (other.floor, other.normalisation)
            && self.snapshot_range_metres == other.snapshot_range_metres
            && self.radar == other.radar
    }
}

/// What the method worker is asked for.
#[derive(Clone)]
struct MethodRequest {
    basis: Basis,
    /// What it aims for; `None` where a recording has the two ends alone.
    target: Option<Arc<RangeAngleMap>>,
    method: Arc<dyn Reconstructor>,
    /// Whether what was found is to be listed.
    listed: bool,
}

impl MethodRequest {
    fn same(&self, other: &MethodRequest) -> bool {
        self.basis.same(&other.basis) && self.method.name() == other.method.name() && self.listed == other.listed
    }
}

/// What a method made.
#[derive(Clone)]
pub struct MethodResult {
    /// Its name.
    pub method: &'static str,
    /// Its map, and the one it aimed for.
    pub pair: Pair,
    /// What it found, the strongest first, where a list was asked for.
    pub found: Option<Vec<Detection>>,
    /// Where it found reflectors.
    pub reflectors: Vec<Reflector>,
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

/// The workers, what they were asked last, and what they made last.
pub struct Pipeline {
    maps: Worker<MapsRequest, Result<MapsResult, String>>,
    method: Worker<MethodRequest, MethodReply>,
    asked: Option<MapsRequest>,
    rest: Rest,
    motion: Motion,
    /// When the maps worker was asked for what it hasn't answered yet.
    waiting: Option<Instant>,
    method_asked: Option<MethodRequest>,
    /// Since when the output belongs to something else than the maps.
    outdated: Option<Instant>,
    result: Option<MapsResult>,
    /// Time of the last maps that followed a change.
    took: Option<Duration>,
    output: Option<MethodResult>,
    scene_error: Option<String>,
    refusal: Option<Refusal>,
    requests: u64,
}

impl Pipeline {
    /// Starts the workers; `wake` is called from their threads when there is something to show.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Clone + Send + 'static) -> std::io::Result<Pipeline> {
        let work = |state: &mut MapsState, request: MapsRequest, _: &Task| state.work(request);
        let maps = Worker::spawn("maps", MapsState::default, work, wake.clone())?;
        // Threads of its own: on shared ones the maps would wait for the end of a slow reconstruction.
        let threads = || rayon::ThreadPoolBuilder::new().thread_name(|i| format!("reconstruction {i}")).build().ok();
        let work = |threads: &mut Option<rayon::ThreadPool>, q: MethodRequest, task: &Task| {
            let Basis { floor, normalisation, snapshot_range_metres, .. } = q.basis;
            let request = Request { floor, normalisation, snapshot_range_metres, task: task.clone() };
            let reconstruct = || {
                let answer = q.method.reconstruct(&q.basis.radar, &q.basis.ends, &request)?;
                let list = || find(q.method.as_ref(), &q.basis.radar, &q.basis.ends, &request, &answer);
                let found = q.listed.then(list).transpose()?;
                Ok((answer, found))
            };
            let result = match threads {
                Some(threads) => threads.install(reconstruct),
                None => reconstruct(),
            };
            (q, result)
        };
        let method = Worker::spawn("reconstruction", threads, work, wake)?;
        Ok(Pipeline {
            maps,
            method,
            asked: None,
            rest: Rest::default(),
            motion: Motion::default(),
            waiting: None,
            method_asked: None,
            outdated: None,
            result: None,
            took: None,
            output: None,
            scene_error: None,
            refusal: None,
            requests: 0,
        })
    }

    /// Takes in what the workers made since the last frame. Returns messages for the user.
    pub fn poll(&mut self) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.maps.replies() {
            self.waiting = self.waiting.filter(|_| self.maps.is_busy());
            match reply {
                Reply::Done { result: Ok(mut result), elapsed, .. } => {
                    result.took = elapsed;
                    self.take_in_maps(result);
                }
                Reply::Done { result: Err(error), .. } => self.scene_error = Some(error),
                Reply::Panicked { message, .. } => messages.push(format!(
                    "Computing the maps failed ({message}). The last maps stay; undo the last change (Ctrl+Z) or change the scene."
                )),
            }
        }
        for reply in self.method.replies() {
            match reply {
                Reply::Done { result: (request, Ok(answer)), elapsed, .. } => self.take_in(request, answer, elapsed),
                // Cancelled by the user, or because the scene moved on and the next request waits.
                Reply::Done { result: (_, Err(ReconstructError::Cancelled)), .. } => {}
                Reply::Done { result: (request, Err(error)), .. } => {
                    self.refuse(request.method.name(), error.to_string());
                }
                Reply::Panicked { message, .. } => {
                    let method = self.method_asked.as_ref().map_or("", |q| q.method.name());
                    self.refuse(method, format!("failed: {message}"));
                    messages.push(format!(
                        "The reconstruction failed ({message}). It was started afresh; choose another method, or change the scene to try again."
                    ));
                }
            }
        }
        messages
    }

    /// The samples of a scene's ends are the same bits whether it rests or not: what a method made of them before stays its output, but
    /// aims for the latest target.
    fn take_in_maps(&mut self, mut result: MapsResult) {
        let before = self.result.as_ref().and_then(|r| r.frame.ends.as_ref());
        if let (Some(ends), Some(before)) = (&mut result.frame.ends, before)
            && **ends == **before
        {
            *ends = before.clone();
        }
        if let (Some(target), Some(output)) = (target_of(&result), &mut self.output)
            && Basis::of(&result).is_some_and(|basis| basis.same(&output.basis))
        {
            output.pair.target = Some(target);
        }
        let only_settled = result.request.at_rest && result.frame.report.ran(Stage::Signal);
        if !only_settled || self.took.is_none() {
            self.took = Some(result.took);
        }
        self.result = Some(result);
        self.scene_error = None;
    }

    fn take_in(&mut self, request: MethodRequest, (answer, found): Answer, took: Duration) {
        let MethodRequest { basis, target, method, .. } = request;
        let Reconstruction { lambda, mut reflectors } = answer;
        if reflectors.is_empty() {
            reflectors = found.iter().flatten().map(Detection::reflector).collect();
        }
        let latest = self.result.as_ref().filter(|r| Basis::of(r).is_some_and(|latest| latest.same(&basis)));
        let pair = Pair { target: latest.and_then(target_of).or(target), output: Arc::new(lambda) };
        self.refusal = None;
        self.output = Some(MethodResult { method: method.name(), pair, found, reflectors, took, basis });
    }

    /// There is no output, and the last one is not its own: nothing of it stays.
    fn refuse(&mut self, method: &'static str, reason: String) {
        self.output = None;
        self.refusal = Some(Refusal { method, reason });
    }

    /// Asks the workers for what the panels of this frame need, if that changed.
    pub fn ask(&mut self, state: &State) {
        let shown = state.arrangement.shown();
        let map = |kind| shown.contains(&Panel::Map(kind));
        let (cuts, roc) = (shown.contains(&Panel::Cuts), shown.contains(&Panel::Roc));
        let listed = shown.contains(&Panel::Found);
        let output = MapKind::ALL.into_iter().any(|k| k.needs_output() && map(k)) || cuts || roc || listed;
        let recording = state.editor.document().recording().cloned();
        let settings = &state.settings;
        let wanted = Wanted {
            floor: settings.floor,
            seed: state.editor.scene().noise_seed,
            normalisation: settings.normalisation,
            first: map(MapKind::Input0) || cuts,
            last: map(MapKind::Input1) || cuts,
            full: map(MapKind::Target) || map(MapKind::TargetAbove) || output || map(MapKind::Unexplained),
            ends: output,
        };
        let (scene, held) = (state.editor.scene(), state.editor.dragged().is_some());
        self.motion = self.rest.look(scene, state.radar(), settings.floor, held, Instant::now());
        self.ask_maps(MapsRequest {
            radar: state.radar().clone(),
            scene: scene.clone(),
            recording: recording.clone(),
            wanted,
            at_rest: self.motion == Motion::AtRest,
            pictures: MapKind::ALL.into_iter().filter(|k| map(*k)).collect(),
            pair: self.output.as_ref().filter(|o| output && o.radar() == state.radar()).map(|o| o.pair.clone()),
            colours: settings.colours,
            projection: settings.projection,
            difference: settings.difference,
            dark: state.dark,
            target_eta: settings.target_eta,
            output_eta: state.output_eta(),
            scores: output && (recording.is_some() || !scene.objects.is_empty()),
            roc,
        });
        if output {
            self.ask_method(state, listed || recording.is_some());
        }
    }

    fn ask_maps(&mut self, request: MapsRequest) {
        if !self.asked.as_ref().is_some_and(|a| a.same(&request)) {
            self.requests += 1;
            self.maps.request(request.clone());
            if !request.at_rest {
                // Maps that are only computed once more are not old meanwhile.
                self.waiting.get_or_insert_with(Instant::now);
            }
            self.asked = Some(request);
        }
    }

    /// Asks for an output of the latest maps, unless it was asked for just that.
    fn ask_method(&mut self, state: &State, listed: bool) {
        let latest = self.result.as_ref().and_then(|r| {
            let target = target_of(r);
            // A recording of the two ends has none; a scene has one as soon as somebody wants it.
            (target.is_some() || r.request.recording.is_some()).then_some((Basis::of(r)?, target))
        });
        let Some(((basis, target), method)) = latest.zip(state.method().cloned()) else { return };
        let request = MethodRequest { basis, target, method, listed };
        let current =
            self.output.as_ref().is_none_or(|o| o.method == request.method.name() && o.basis.same(&request.basis));
        self.outdated = if current { None } else { self.outdated.or_else(|| Some(Instant::now())) };
        if !self.method_asked.as_ref().is_some_and(|a| a.same(&request)) {
            if state.editor.dragged().is_none() {
                self.method.cancel_older_than(PATIENCE);
            }
            self.method.request(request.clone());
            self.method_asked = Some(request);
        }
    }

    /// Stops the reconstruction that runs.
    pub fn cancel_method(&mut self) {
        self.method.cancel();
        let method = self.method_asked.as_ref().map_or("", |q| q.method.name());
        let reason = "cancelled; change the scene or the method to start again".to_owned();
        self.refusal = Some(Refusal { method, reason });
    }

    /// The latest maps.
    pub fn result(&self) -> Option<&MapsResult> {
        self.result.as_ref()
    }

    /// The latest output.
    pub fn output(&self) -> Option<&MethodResult> {
        self.output.as_ref()
    }

    /// The maps that can be cut.
    pub fn cut_maps(&self) -> Vec<CutMap> {
        let frame = self.result.as_ref().map(|r| &r.frame);
        let scale = frame.and_then(|f| f.full.as_ref()).map(|m| m.scale);
        let ready = [
            (MapKind::Input0, frame.and_then(|f| f.first.as_ref())),
            (MapKind::Input1, frame.and_then(|f| f.last.as_ref())),
            (MapKind::Target, frame.and_then(|f| f.full.as_ref())),
        ];
        let ready = ready.into_iter().filter_map(|(kind, map)| {
            let map = map?;
            Some(CutMap { kind, map: map.lambda.clone(), scale: Some(map.scale) })
        });
        // A method aims for the target's Lambda, so its decibels are the target's.
        let output = self.output.as_ref().map(|o| CutMap { kind: MapKind::Output, map: o.pair.output.clone(), scale });
        ready.chain(output).collect()
    }

    /// What the reflectors on screen leave of the recording, where somebody looks at it.
    pub fn unexplained(&self) -> Option<&Unexplained> {
        self.result.as_ref()?.unexplained.as_ref()?.as_ref().ok()
    }

    /// Why the reflectors can't be fitted to the recording.
    pub fn why_unexplained(&self) -> Option<&str> {
        self.result.as_ref()?.unexplained.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// Figures of that output, against the target of the same scene.
    pub fn scores(&self) -> Option<Scores> {
        self.output.as_ref()?;
        self.result.as_ref()?.scores
    }

    /// Why the scene on screen can't be computed.
    pub fn scene_error(&self) -> Option<&str> {
        self.scene_error.as_deref()
    }

    /// Why the method has no output for the scene on screen.
    pub fn refusal(&self) -> Option<&Refusal> {
        self.refusal.as_ref()
    }

    /// Progress of the reconstruction, 0 to 1; `None` when none runs.
    pub fn method_progress(&self) -> Option<f32> {
        self.method.progress()
    }

    /// Requests sent to the maps worker: a test asks that an idle app sends none.
    pub fn requests(&self) -> u64 {
        self.requests
    }

    /// Whether either worker has something to do, or will as soon as the scene rests.
    pub fn is_busy(&self) -> bool {
        self.maps.is_busy() || self.method.is_busy() || self.rests_in().is_some()
    }

    /// How long until the scene on screen rests; `None` where it does, or is held.
    pub fn rests_in(&self) -> Option<Duration> {
        match self.motion {
            Motion::RestsIn(left) => Some(left),
            Motion::Held | Motion::AtRest => None,
        }
    }

    /// Whether the maps are those of the scene on screen at rest, as every command computes them.
    pub fn is_settled(&self) -> bool {
        let latest = self.asked.as_ref().zip(self.result.as_ref());
        latest.is_some_and(|(asked, result)| result.frame.settled && asked.same(&result.request))
    }

    /// Time of the last maps and pictures that followed a change.
    pub fn took(&self) -> Option<Duration> {
        self.took
    }

    /// Whether somebody looks at an output, or would if there were one.
    pub fn wants_output(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked.wanted.ends)
    }

    /// Whether the shown output belongs to something else than the shown maps.
    pub fn output_is_outdated(&self) -> bool {
        self.outdated.is_some()
    }

    /// Whether a map has belonged to an earlier scene for so long that it must be told.
    pub fn is_stale(&self, kind: MapKind) -> bool {
        let old = |since: Option<Instant>| since.is_some_and(|t| t.elapsed() > STALE);
        old(self.waiting) || (kind.needs_output() && old(self.outdated))
    }
}

/// The map that a method aims for.
fn target_of(result: &MapsResult) -> Option<Arc<RangeAngleMap>> {
    result.frame.full.as_ref().map(|full| full.lambda.clone())
}
