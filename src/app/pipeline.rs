//! What to compute, and what came of it: the UI's side of the two workers.
//!
//! ```text
//!   scene, what is shown ──► maps worker (engine, pictures, scores) ──► LiveResult
//!                               ▲                                          │ ends
//!                               └── output map ◄── method worker ◄─────────┘
//! ```

use super::pictures::{MapKind, Paint, Painter, Picture, Subject};
use super::settings::{Projection, Settings};
use crate::evaluate::{Metrics, Roc, RocPoint};
use crate::live::{Engine, Frame, Wanted};
use crate::maps::RangeAngleMap;
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Reconstruction, Reconstructor, Request};
use crate::scene::{Scene, SceneError};
use crate::signal::TwoEnds;
use crate::task::{Reply, Worker};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

/// A reconstruction that is slower than this is cancelled when the scene has moved on.
const PATIENCE: Duration = Duration::from_millis(400);

/// What the maps worker is asked for.
#[derive(Clone)]
pub(super) struct LiveRequest {
    pub radar: Radar,
    pub scene: Arc<Scene>,
    pub wanted: Wanted,
    pub pictures: BTreeSet<MapKind>,
    pub output: Option<Arc<RangeAngleMap>>,
    pub colours: ColourMap,
    pub projection: Projection,
    pub target_eta: f32,
    pub output_eta: f32,
    /// Whether P_D, P_FA, SE and blobs are looked at.
    pub scores: bool,
    /// Whether the ROC is looked at.
    pub roc: bool,
}

impl LiveRequest {
    fn same(&self, other: &LiveRequest) -> bool {
        let output = match (&self.output, &other.output) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        output
            && Arc::ptr_eq(&self.scene, &other.scene)
            && self.radar == other.radar
            && self.wanted == other.wanted
            && self.pictures == other.pictures
            && (self.colours, self.projection) == (other.colours, other.projection)
            && (self.target_eta, self.output_eta) == (other.target_eta, other.output_eta)
            && (self.scores, self.roc) == (other.scores, other.roc)
    }
}

/// Figures of the shown output against the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scores {
    pub metrics: Metrics,
    /// Connected regions above the thresholds.
    pub target_blobs: usize,
    pub output_blobs: usize,
}

/// What the maps worker made.
#[derive(Clone)]
pub(super) struct LiveResult {
    pub scene: Arc<Scene>,
    pub frame: Frame,
    pub pictures: BTreeMap<MapKind, Picture>,
    pub scores: Option<Scores>,
    pub roc: Option<Arc<Vec<RocPoint>>>,
    /// Pictures painted since the start.
    pub painted: u64,
    pub took: Duration,
}

/// State that the maps worker keeps.
#[derive(Default)]
struct LiveState {
    engine: Option<Engine>,
    painter: Painter,
    roc: Option<RocOf>,
}

/// A characteristic and the maps it belongs to.
struct RocOf {
    target: Arc<RangeAngleMap>,
    output: Arc<RangeAngleMap>,
    points: Arc<Vec<RocPoint>>,
}

fn live_work(state: &mut LiveState, request: LiveRequest) -> Result<LiveResult, SceneError> {
    let engine = match &mut state.engine {
        Some(engine) if *engine.radar() == request.radar => engine,
        slot => slot.insert(Engine::new(request.radar.clone())),
    };
    let frame = engine.update(&request.scene, &request.wanted)?;
    let lambda = |map: &Option<crate::live::LiveMap>| map.as_ref().map(|m| m.lambda.clone());
    let target = lambda(&frame.full);
    let subject = |kind: MapKind| {
        let (map, minus, paint) = match kind {
            MapKind::Input0 => (lambda(&frame.first), None, Paint::Lambda(request.colours)),
            MapKind::Input1 => (lambda(&frame.last), None, Paint::Lambda(request.colours)),
            MapKind::Target => (target.clone(), None, Paint::Lambda(request.colours)),
            MapKind::Output => (request.output.clone(), None, Paint::Lambda(request.colours)),
            MapKind::TargetAbove => (target.clone(), None, Paint::Above(request.target_eta)),
            MapKind::OutputAbove => (request.output.clone(), None, Paint::Above(request.output_eta)),
            MapKind::Difference => (request.output.clone(), Some(target.clone()?), Paint::Difference),
        };
        Some(Subject { map: map?, minus, paint, projection: request.projection })
    };
    let mut pictures = BTreeMap::new();
    for &kind in &request.pictures {
        if let Some(subject) = subject(kind) {
            pictures.insert(kind, state.painter.paint(&request.radar, kind, &subject));
        }
    }
    state.painter.keep(|kind| request.pictures.contains(&kind));
    let pair = target.zip(request.output.clone());
    let scores = pair.as_ref().filter(|_| request.scores).map(|(target, output)| Scores {
        metrics: Metrics::of(target, output, request.output_eta),
        target_blobs: blobs(target, request.target_eta),
        output_blobs: blobs(output, request.output_eta),
    });
    let roc = pair.filter(|_| request.roc).map(|(target, output)| match &state.roc {
        Some(last) if Arc::ptr_eq(&last.target, &target) && Arc::ptr_eq(&last.output, &output) => last.points.clone(),
        _ => {
            let points: Arc<Vec<RocPoint>> = Arc::new(Roc::of(&target, &output).points().collect());
            state.roc = Some(RocOf { target, output, points: points.clone() });
            points
        }
    });
    Ok(LiveResult {
        scene: request.scene,
        frame,
        pictures,
        scores,
        roc,
        painted: state.painter.painted,
        took: Duration::ZERO,
    })
}

/// Number of regions of touching cells (8 neighbours, columns wrap around) above `eta`.
fn blobs(map: &RangeAngleMap, eta: f32) -> usize {
    let (rows, columns) = map.lambda.dim();
    let mut open = map.above(eta).cells;
    let (mut count, mut stack) = (0, Vec::new());
    for row in 0..rows {
        for column in 0..columns {
            if !open[[row, column]] {
                continue;
            }
            count += 1;
            open[[row, column]] = false;
            stack.push((row, column));
            while let Some((r, c)) = stack.pop() {
                for r in r.saturating_sub(1)..(r + 2).min(rows) {
                    for c in [(c + columns - 1) % columns, c, (c + 1) % columns] {
                        if std::mem::take(&mut open[[r, c]]) {
                            stack.push((r, c));
                        }
                    }
                }
            }
        }
    }
    count
}

/// What the method worker is asked for.
#[derive(Clone)]
struct MethodRequest {
    radar: Radar,
    ends: Arc<TwoEnds>,
    method: Arc<dyn Reconstructor>,
    wanted: Wanted,
}

/// What a method made.
#[derive(Clone)]
pub(super) struct MethodResult {
    pub method: &'static str,
    pub ends: Arc<TwoEnds>,
    pub lambda: Arc<RangeAngleMap>,
    pub found: Arc<Reconstruction>,
    pub took: Duration,
}

type MethodReply = (MethodRequest, Result<Reconstruction, ReconstructError>);

/// The workers, what they were asked last, and what they made last.
pub(super) struct Pipeline {
    live: Worker<LiveRequest, Result<LiveResult, SceneError>>,
    method: Worker<MethodRequest, MethodReply>,
    asked: Option<LiveRequest>,
    method_asked: Option<MethodRequest>,
    /// The latest maps.
    pub result: Option<LiveResult>,
    /// The latest output.
    pub output: Option<MethodResult>,
    /// Why the scene on screen can't be computed.
    pub scene_error: Option<String>,
    /// Why the method has no output for the scene on screen.
    pub method_error: Option<String>,
    /// The method used where nobody chose one.
    preferred: &'static str,
    /// Every method, in order.
    pub methods: Vec<Arc<dyn Reconstructor>>,
    /// Requests sent to the maps worker: a test asks that an idle app sends none.
    pub requests: u64,
}

impl Pipeline {
    /// Starts the workers; `wake` is called from their threads when there is something to show.
    pub fn start(
        methods: Vec<Arc<dyn Reconstructor>>,
        wake: impl Fn() + Clone + Send + 'static,
    ) -> std::io::Result<Pipeline> {
        let live = Worker::spawn("maps", LiveState::default, |s, q, _| live_work(s, q), wake.clone())?;
        // Threads of its own: on shared ones the maps would wait for the end of a slow reconstruction.
        let threads = || rayon::ThreadPoolBuilder::new().thread_name(|i| format!("reconstruction {i}")).build().ok();
        let work = |threads: &mut Option<rayon::ThreadPool>, q: MethodRequest, task: &crate::task::Task| {
            let request = Request {
                floor: q.wanted.floor,
                normalisation: q.wanted.normalisation,
                task: task.clone(),
                ..Request::default()
            };
            let reconstruct = || q.method.reconstruct(&q.radar, &q.ends, &request);
            let result = match threads {
                Some(threads) => threads.install(reconstruct),
                None => reconstruct(),
            };
            (q, result)
        };
        let method = Worker::spawn("reconstruction", threads, work, wake)?;
        Ok(Pipeline {
            live,
            method,
            asked: None,
            method_asked: None,
            result: None,
            output: None,
            scene_error: None,
            method_error: None,
            preferred: crate::methods::preferred().name(),
            methods,
            requests: 0,
        })
    }

    /// The method called `name`, or else the preferred one, or else the first.
    pub fn method_named(&self, name: &str) -> Option<&Arc<dyn Reconstructor>> {
        let named = |name: &str| self.methods.iter().find(|m| m.name() == name);
        named(name).or_else(|| named(self.preferred)).or_else(|| self.methods.first())
    }

    /// Takes in what the workers made since the last frame. Returns messages for the user.
    pub fn poll(&mut self) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.live.replies() {
            match reply {
                Reply::Done { result: Ok(mut result), elapsed, .. } => {
                    result.took = elapsed;
                    self.result = Some(result);
                    self.scene_error = None;
                }
                Reply::Done { result: Err(error), .. } => self.scene_error = Some(error.to_string()),
                Reply::Panicked { message, .. } => messages.push(format!(
                    "Computing the maps failed ({message}). The last maps stay; undo the last change (Ctrl+Z) or change the scene."
                )),
            }
        }
        for reply in self.method.replies() {
            match reply {
                Reply::Done { result: (request, Ok(found)), elapsed, .. } => {
                    let found = Arc::new(found);
                    self.method_error = None;
                    self.output = Some(MethodResult {
                        method: request.method.name(),
                        ends: request.ends,
                        lambda: Arc::new(found.lambda.clone()),
                        found,
                        took: elapsed,
                    });
                }
                // Cancelled by the user, or because the scene moved on and the next request waits.
                Reply::Done { result: (_, Err(ReconstructError::Cancelled)), .. } => {}
                Reply::Done { result: (_, Err(error)), .. } => self.method_error = Some(error.to_string()),
                Reply::Panicked { message, .. } => {
                    self.method_error = Some(format!("failed: {message}"));
                    messages.push(format!(
                        "The reconstruction failed ({message}). It was started afresh; choose another method, or change the scene to try again."
                    ));
                }
            }
        }
        messages
    }

    /// Asks the maps worker for `request`, unless it was asked for just that.
    pub fn ask(&mut self, request: LiveRequest) {
        if !self.asked.as_ref().is_some_and(|a| a.same(&request)) {
            self.requests += 1;
            self.live.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// Asks the method worker for an output of the latest maps, unless it was asked for just that.
    pub fn ask_method(&mut self, radar: &Radar, settings: &Settings, wanted: Wanted) {
        let Some(ends) = self.result.as_ref().and_then(|r| r.frame.ends.clone()) else { return };
        let Some(method) = self.method_named(&settings.method).cloned() else { return };
        let same = |a: &MethodRequest| {
            Arc::ptr_eq(&a.ends, &ends)
                && a.method.name() == method.name()
                && (a.wanted.floor, a.wanted.normalisation) == (wanted.floor, wanted.normalisation)
        };
        if !self.method_asked.as_ref().is_some_and(same) {
            self.method.cancel_older_than(PATIENCE);
            let request = MethodRequest { radar: radar.clone(), ends, method, wanted };
            self.method.request(request.clone());
            self.method_asked = Some(request);
        }
    }

    /// Stops the reconstruction that runs.
    pub fn cancel_method(&mut self) {
        self.method.cancel();
        self.method_error = Some("cancelled; change the scene or the method to start again".to_owned());
    }

    /// Progress of the reconstruction, 0 to 1; `None` when none runs.
    pub fn method_progress(&self) -> Option<f32> {
        self.method.progress()
    }

    /// Whether either worker has something to do.
    pub fn is_busy(&self) -> bool {
        self.live.is_busy() || self.method.is_busy()
    }

    /// Whether the shown output belongs to an older scene than the shown maps.
    pub fn output_is_stale(&self) -> bool {
        let ends = self.result.as_ref().and_then(|r| r.frame.ends.as_ref());
        match (ends, &self.output) {
            (Some(ends), Some(output)) => !Arc::ptr_eq(ends, &output.ends),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn blobs_touch_at_corners_and_around_the_edge() {
        let map = RangeAngleMap {
            lambda: array![[1.0f32, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 1.0, 0.0]],
        };
        assert_eq!(blobs(&map, 0.5), 2);
        assert_eq!(blobs(&map, 1.0), 0);
    }
}
