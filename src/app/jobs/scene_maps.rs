//! The maps of a scene, their pictures and their figures: what the maps worker is asked for, and what it makes.

use super::painter::{Paint, Painter, Picture, Subject};
use crate::app::state::{DifferenceView, MapKind, Projection};
use crate::engine::{Engine, Frame, ReadyMap, Wanted};
use crate::evaluate::{Metrics, Roc, RocPoint, blobs};
use crate::maps::RangeAngleMap;
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::scene::{Scene, SceneError};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

/// An output and the target it aimed for: figures are always of such a pair, whatever has changed since.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The whole array's map.
    pub target: Arc<RangeAngleMap>,
    /// What the method made of the ends of the same scene.
    pub output: Arc<RangeAngleMap>,
}

impl Pair {
    fn same(&self, other: &Pair) -> bool {
        Arc::ptr_eq(&self.target, &other.target) && Arc::ptr_eq(&self.output, &other.output)
    }
}

/// What the maps worker is asked for.
#[derive(Clone)]
pub struct MapsRequest {
    /// The radar.
    pub radar: Radar,
    /// What stands before it.
    pub scene: Arc<Scene>,
    /// Which maps, and how.
    pub wanted: Wanted,
    /// Whether the scene rests: its maps are then those of the command line, bit for bit.
    pub at_rest: bool,
    /// Maps that somebody looks at.
    pub pictures: BTreeSet<MapKind>,
    /// The latest output, if there is one, with its target.
    pub pair: Option<Pair>,
    /// Colours of Lambda.
    pub colours: ColourMap,
    /// Coordinates.
    pub projection: Projection,
    /// How the difference is drawn.
    pub difference: DifferenceView,
    /// Whether the window is dark.
    pub dark: bool,
    /// eta'.
    pub target_eta: f32,
    /// eta.
    pub output_eta: f32,
    /// Whether P_D, P_FA, SE and blobs are looked at.
    pub scores: bool,
    /// Whether the ROC is looked at.
    pub roc: bool,
}

impl MapsRequest {
    /// Whether both would give the same result.
    pub fn same(&self, other: &MapsRequest) -> bool {
        let pair = match (&self.pair, &other.pair) {
            (Some(a), Some(b)) => a.same(b),
            (None, None) => true,
            _ => false,
        };
        pair && Arc::ptr_eq(&self.scene, &other.scene)
            && self.radar == other.radar
            && (self.wanted, self.at_rest) == (other.wanted, other.at_rest)
            && self.pictures == other.pictures
            && (self.colours, self.projection) == (other.colours, other.projection)
            && (self.difference, self.dark) == (other.difference, other.dark)
            && (self.target_eta, self.output_eta) == (other.target_eta, other.output_eta)
            && (self.scores, self.roc) == (other.scores, other.roc)
    }
}

/// Figures of an output against its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scores {
    /// SE, P_D and P_FA.
    pub metrics: Metrics,
    /// Connected regions of the target above eta'.
    pub target_blobs: usize,
    /// Connected regions of the output above eta.
    pub output_blobs: usize,
}

/// What the maps worker made.
#[derive(Clone)]
pub struct MapsResult {
    /// What was asked for.
    pub request: MapsRequest,
    /// The maps.
    pub frame: Frame,
    /// Their pictures.
    pub pictures: BTreeMap<MapKind, Picture>,
    /// Figures of the pair that was asked about.
    pub scores: Option<Scores>,
    /// P_D against P_FA of that pair.
    pub roc: Option<Arc<Vec<RocPoint>>>,
    /// Pictures painted since the start.
    pub painted: u64,
    /// Time of it all.
    pub took: Duration,
}

/// State that the maps worker keeps.
#[derive(Default)]
pub struct MapsState {
    engine: Option<Engine>,
    painter: Painter,
    scores: Option<ScoresOf>,
    roc: Option<RocOf>,
}

/// Figures, and what they belong to.
struct ScoresOf {
    pair: Pair,
    etas: [f32; 2],
    scores: Scores,
}

/// A characteristic and the maps it belongs to.
struct RocOf {
    pair: Pair,
    points: Arc<Vec<RocPoint>>,
}

impl MapsState {
    /// Does what was asked, and nothing that was done before.
    ///
    /// # Errors
    /// [`SceneError`] for a scene that has no maps.
    pub fn work(&mut self, request: MapsRequest) -> Result<MapsResult, SceneError> {
        let engine = match &mut self.engine {
            Some(engine) if *engine.radar() == request.radar => engine,
            slot => slot.insert(Engine::new(request.radar.clone())),
        };
        let frame = match request.at_rest {
            true => engine.settle(&request.scene, &request.wanted)?,
            false => engine.update(&request.scene, &request.wanted)?,
        };
        let mut pictures = BTreeMap::new();
        for &kind in &request.pictures {
            if let Some(subject) = subject(&frame, &request, kind) {
                pictures.insert(kind, self.painter.paint(&request.radar, kind, &subject));
            }
        }
        self.painter.keep(|kind| request.pictures.contains(&kind));
        let scored = request.pair.as_ref().filter(|_| request.scores);
        let scores = scored.map(|pair| self.scores(pair, [request.target_eta, request.output_eta]));
        let roc = request.pair.as_ref().filter(|_| request.roc).map(|pair| self.roc(pair));
        let painted = self.painter.painted;
        Ok(MapsResult { request, frame, pictures, scores, roc, painted, took: Duration::ZERO })
    }

    fn scores(&mut self, pair: &Pair, etas: [f32; 2]) -> Scores {
        if let Some(last) = self.scores.as_ref().filter(|s| s.pair.same(pair) && s.etas == etas) {
            return last.scores;
        }
        let [target_eta, output_eta] = etas;
        let scores = Scores {
            metrics: Metrics::of(&pair.target, &pair.output, output_eta),
            target_blobs: blobs(&pair.target, target_eta),
            output_blobs: blobs(&pair.output, output_eta),
        };
        self.scores = Some(ScoresOf { pair: pair.clone(), etas, scores });
        scores
    }

    fn roc(&mut self, pair: &Pair) -> Arc<Vec<RocPoint>> {
        if let Some(last) = self.roc.as_ref().filter(|r| r.pair.same(pair)) {
            return last.points.clone();
        }
        let points: Arc<Vec<RocPoint>> = Arc::new(Roc::of(&pair.target, &pair.output).points().collect());
        self.roc = Some(RocOf { pair: pair.clone(), points: points.clone() });
        points
    }
}

/// What the picture of one map shows; `None` where there is no such map.
fn subject(frame: &Frame, request: &MapsRequest, kind: MapKind) -> Option<Subject> {
    let lambda = |map: &Option<ReadyMap>| map.as_ref().map(|m| m.lambda.clone());
    let pair = request.pair.as_ref();
    let output = pair.map(|p| p.output.clone());
    let colours = Paint::Lambda(request.colours);
    let above = |eta| Paint::Above { eta, dark: request.dark };
    let (map, minus, paint) = match kind {
        MapKind::Input0 => (lambda(&frame.first), None, colours),
        MapKind::Input1 => (lambda(&frame.last), None, colours),
        MapKind::Target => (lambda(&frame.full), None, colours),
        MapKind::Output => (output, None, colours),
        MapKind::TargetAbove => (lambda(&frame.full), None, above(request.target_eta)),
        MapKind::OutputAbove => (output, None, above(request.output_eta)),
        MapKind::Difference => (
            output,
            pair.map(|p| p.target.clone()),
            Paint::Difference { view: request.difference, colours: request.colours },
        ),
    };
    Some(Subject { map: map?, minus, paint, projection: request.projection })
}
