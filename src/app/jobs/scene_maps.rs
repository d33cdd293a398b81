//! Requests to the maps' worker and its results: maps of a scene, their pictures and their figures.

use super::detected::{Detected, Detector};
use super::heard::Heard;
use super::memo::Memo;
use super::one_scale::OneScale;
use super::painter::{Painter, Picture, largest_difference};
use super::recorded::{RecordedMaps, Unexplained};
use super::source::Source;
use super::subject::{Paint, Subject};
use crate::app::shared::Shared;
use crate::app::state::{DifferenceView, MapKind, Projection};
use crate::engine::{Engine, EngineFrame, MapRequest, ReadyMap};
use crate::evaluate::{Metrics, Roc, RocPoint, blobs, squared_error};
use crate::maps::cfar::{Cfar, DETECTION_THRESHOLD};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::picture::ColourMap;
use crate::radar::{BuiltArray, Radar};
use crate::recording::Recording;
use crate::signal::{LayoutSamples, SimulationError};
use crate::task::Task;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Duration;

/// What an output is made of. Equal ones have equal outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    pub source: Source,
    pub normalisation: Normalisation,
    /// Numbers of the elements that methods use in place of the two ends.
    pub layout: Option<Vec<usize>>,
    pub method: &'static str,
}

/// An output and its target. Figures always compare such a pair, even where the scene has changed since.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// What the output is made of; the target is of the same samples.
    pub origin: Origin,
    /// Map of the whole array; `None` where a recording has the two ends alone.
    pub target: Option<Shared<RangeAngleMap>>,
    pub output: Shared<RangeAngleMap>,
    /// The method's expected error of each cell, where it gives one.
    pub doubt: Option<Shared<RangeAngleMap>>,
}

#[derive(Clone, PartialEq)]
pub struct MapsRequest {
    pub document: u64,
    pub source: Source,
    pub wanted: MapRequest,
    /// Numbers of the elements that methods use in place of the two ends. Their map then replaces that of the first end, and there is none of the last.
    pub layout: Option<Vec<usize>>,
    /// Whether the scene rests. Its maps are then those of the command line, bit for bit.
    pub at_rest: bool,
    pub pictures: BTreeSet<MapKind>,
    /// The latest output of either method, if there is one, with its target.
    pub pairs: [Option<Pair>; 2],
    pub colours: ColourMap,
    pub projection: Projection,
    pub one_scale: bool,
    /// Whether maps of few elements are drawn on more columns.
    pub fine_columns: bool,
    pub difference: DifferenceView,
    pub dark: bool,
    pub target_eta: f32,
    pub etas: [f32; 2],
    /// The detector in place of these thresholds, if one is in use.
    pub cfar: Option<Cfar>,
    /// Whether P_D, P_FA, SE and blobs are wanted.
    pub scores: bool,
    pub roc: bool,
}

/// Figures of an output against its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scores {
    pub metrics: Metrics,
    /// Connected regions of the target above eta'.
    pub target_blobs: usize,
    /// Connected regions of the output above eta.
    pub output_blobs: usize,
}

#[derive(Clone)]
pub struct MapsResult {
    pub request: MapsRequest,
    /// The engine's maps of the scene, or those of a recording.
    pub frame: EngineFrame,
    /// Samples of the layout's elements, where a layout is in use.
    pub layout_samples: Option<Shared<LayoutSamples>>,
    /// The unexplained part of a recording, where its map is in sight, or the reason why it can't be fitted.
    pub unexplained: Option<Result<Unexplained, String>>,
    pub detected: Detected,
    pub on_one_scale: BTreeMap<MapKind, ReadyMap>,
    pub pictures: BTreeMap<MapKind, Picture>,
    pub scores: [Option<Scores>; 2],
    /// P_D against P_FA of the first method's pair.
    pub roc: Option<Arc<Vec<RocPoint>>>,
    /// Pictures painted since the start.
    pub painted: u64,
    pub took: Duration,
}

impl MapsRequest {
    /// The origin of an output that `method` makes of these maps' samples.
    pub fn origin(&self, method: &'static str) -> Origin {
        let (source, layout) = (self.source.clone(), self.layout.clone());
        Origin { source, normalisation: self.wanted.normalisation, layout, method }
    }
}

impl MapsResult {
    /// Map of all elements, the target of methods.
    pub fn target(&self) -> Option<Shared<RangeAngleMap>> {
        self.frame.full.as_ref().map(|full| Shared::from(&full.lambda))
    }
}

/// Inputs of the scores: the pair, thresholds of target and output, the detector.
type Scored = (Pair, [f32; 2], Option<Cfar>);

#[derive(Default)]
pub struct MapsState {
    engine: Memo<Radar, Engine>,
    recorded: Memo<(Shared<Recording>, Radar, BuiltArray), RecordedMaps>,
    heard: Memo<(Source, Vec<usize>), Option<Heard>>,
    painter: Painter,
    one_scale: OneScale,
    detector: Detector,
    scores: [Memo<Scored, Scores>; 2],
    roc: Memo<Pair, Arc<Vec<RocPoint>>>,
}

impl MapsState {
    /// Answers a request; repeats no computation of an unchanged part.
    ///
    /// # Errors
    /// The reason why a scene has no maps, or that `task` was cancelled.
    pub fn work(&mut self, request: MapsRequest, task: &Task) -> Result<MapsResult, SimulationError> {
        let (mut frame, unexplained) = self.frame(&request, task)?;
        let layout_samples = self.heard(&request, task, &mut frame)?;
        let shows = |kind| request.pictures.contains(&kind) || request.scores;
        let output =
            |slot: usize, above| request.pairs[slot].as_ref().filter(|_| shows(above)).map(|pair| &*pair.output);
        let outputs = [output(0, MapKind::OutputAbove), output(1, MapKind::SecondAbove)];
        let needs_target = outputs.iter().any(Option::is_some) || shows(MapKind::TargetAbove);
        let detected = self.detector.detect(request.cfar, &frame, needs_target, outputs);
        let outputs = request.pairs.each_ref().map(|pair| pair.as_ref().map(|pair| &pair.output));
        let on_one_scale = if request.one_scale { self.one_scale.of(&frame, outputs) } else { BTreeMap::new() };
        let mut pictures = BTreeMap::new();
        for &kind in &request.pictures {
            if let Some(mut subject) = subject(&frame, unexplained.as_ref(), &request, &detected, kind) {
                if let Some(rescaled) = on_one_scale.get(&kind) {
                    subject.map = Shared::from(&rescaled.lambda);
                }
                pictures.insert(kind, self.painter.paint(&request.source.radar, kind, &subject));
            }
        }
        self.painter.keep(|kind| request.pictures.contains(&kind));
        // Objects drawn over a recording tell nothing of its echoes.
        let is_silent = request.source.recording.is_none() && request.source.scene.is_silent();
        let scores = [0, 1].map(|slot| {
            let pair = request.pairs[slot].as_ref().filter(|_| request.scores)?;
            let detected = detected.target.as_ref().zip(detected.outputs[slot].as_ref());
            let of = (pair.clone(), [request.target_eta, request.etas[slot]], request.cfar);
            let made = |(pair, etas, cfar): &Scored| scored(is_silent, pair, *etas, *cfar, detected).ok_or(());
            self.scores[slot].try_of(of, made).ok().copied()
        });
        let roc = request.pairs[0].as_ref().filter(|_| request.roc).and_then(|pair| self.roc(is_silent, pair));
        Ok(MapsResult {
            request,
            frame,
            layout_samples,
            unexplained,
            detected,
            on_one_scale,
            pictures,
            scores,
            roc,
            painted: self.painter.painted,
            took: Duration::ZERO,
        })
    }

    /// The maps of the scene, or of the recording in its place and its unexplained part.
    fn frame(
        &mut self,
        request: &MapsRequest,
        task: &Task,
    ) -> Result<(EngineFrame, Option<Result<Unexplained, String>>), SimulationError> {
        let MapsRequest { source: Source { radar, scene, recording, .. }, wanted, .. } = request;
        if let Some(recording) = recording {
            scene.validate(radar)?;
            let seen = (recording.clone(), radar.clone(), scene.disturbances.elements.clone());
            let maps =
                self.recorded.of(seen, |(recording, radar, elements)| RecordedMaps::new(recording, radar, elements));
            let frame = maps.frame(wanted);
            let looked_at = request.pictures.contains(&MapKind::Unexplained);
            return Ok((frame, looked_at.then(|| maps.unexplained(scene, wanted.normalisation))));
        }
        self.recorded = Memo::default();
        let engine = self.engine.of(radar.clone(), |radar| Engine::new(radar.clone()));
        let frame = match request.at_rest {
            true => engine.settle_for(task, scene, wanted)?,
            false => engine.update_for(task, scene, wanted)?,
        };
        Ok((frame, None))
    }

    /// Samples of the layout's elements, where there is a layout; their map becomes the first one of `frame`.
    fn heard(
        &mut self,
        request: &MapsRequest,
        task: &Task,
        frame: &mut EngineFrame,
    ) -> Result<Option<Shared<LayoutSamples>>, SimulationError> {
        let Some(layout) = &request.layout else {
            self.heard = Memo::default();
            return Ok(None);
        };
        let of = (request.source.clone(), layout.clone());
        let heard = self.heard.try_of(of, |(source, layout)| Heard::of(task, source, layout))?;
        frame.first = heard.as_mut().map(|heard| heard.map(request.wanted.normalisation));
        Ok(heard.as_ref().map(|heard| heard.samples.clone()))
    }

    fn roc(&mut self, is_silent: bool, pair: &Pair) -> Option<Arc<Vec<RocPoint>>> {
        let target = pair.target.as_ref()?;
        let points = |pair: &Pair| Arc::new(Roc::of_echoes(!is_silent, target, &pair.output).points().collect());
        Some(self.roc.of(pair.clone(), points).clone())
    }
}

/// Figures of a pair at the thresholds of target and output, or by a detector's maps; `None` where there is no target or no detector's map.
fn scored(
    is_silent: bool,
    pair: &Pair,
    etas: [f32; 2],
    cfar: Option<Cfar>,
    detected: Option<(&Arc<RangeAngleMap>, &Arc<RangeAngleMap>)>,
) -> Option<Scores> {
    let target = pair.target.as_ref()?;
    let (above, [target_eta, output_eta]) = match cfar {
        None => ((&**target, &*pair.output), etas),
        Some(_) => (detected?, [DETECTION_THRESHOLD; 2]),
    };
    // Hits and misses are counted against the map that the target's picture shows.
    let truth = if cfar.is_some() { above.0 } else { target };
    let metrics = Metrics::of_echoes(!is_silent, truth, above.1, output_eta);
    Some(Scores {
        metrics: Metrics { squared_error: squared_error(target, &pair.output), ..metrics },
        target_blobs: blobs(above.0, target_eta),
        output_blobs: blobs(above.1, output_eta),
    })
}

/// Largest difference of the other method's output, where both differences are in sight.
fn beside(request: &MapsRequest, slot: usize) -> f32 {
    let both = [MapKind::Difference, MapKind::SecondDifference];
    let other = request.pairs[1 - slot].as_ref().filter(|_| both.iter().all(|kind| request.pictures.contains(kind)));
    let of_pair = |pair: &Pair| Some(largest_difference(&pair.output, pair.target.as_ref()?));
    other.filter(|_| !request.difference.whole).and_then(of_pair).unwrap_or(0.0)
}

/// The maps and colours of one picture; `None` where there is no such map.
fn subject(
    frame: &EngineFrame,
    unexplained: Option<&Result<Unexplained, String>>,
    request: &MapsRequest,
    detected: &Detected,
    kind: MapKind,
) -> Option<Subject> {
    let lambda = |map: &Option<ReadyMap>| map.as_ref().map(|m| Shared::from(&m.lambda));
    let shared = |map: &Option<Arc<RangeAngleMap>>| map.as_ref().map(Shared::from);
    let slot = kind.slot().map(|slot| slot as usize);
    let pair = slot.and_then(|slot| request.pairs[slot].as_ref());
    let output = pair.map(|p| p.output.clone());
    let colours = Paint::Lambda(request.colours);
    let dark = request.dark;
    let (target, target_eta) = match request.cfar {
        None => (lambda(&frame.full), request.target_eta),
        Some(_) => (shared(&detected.target), DETECTION_THRESHOLD),
    };
    let (map, minus, paint) = match kind {
        MapKind::Input0 => (lambda(&frame.first), None, colours),
        MapKind::Input1 => (lambda(&frame.last), None, colours),
        MapKind::Target => (lambda(&frame.full), None, colours),
        MapKind::Output | MapKind::Second => (output, None, colours),
        MapKind::Doubt => (pair?.doubt.clone(), None, Paint::Doubt(request.colours)),
        MapKind::TargetAbove => (target, None, Paint::Above { eta: target_eta, dark }),
        MapKind::OutputAbove | MapKind::SecondAbove => {
            let of_pair = pair?.target.clone();
            let (output, target, eta) = match request.cfar {
                None => (output, of_pair, request.etas[slot?]),
                Some(_) => {
                    (shared(&detected.outputs[slot?]), target.filter(|_| of_pair.is_some()), DETECTION_THRESHOLD)
                }
            };
            (output, target, Paint::Above { eta, dark })
        }
        MapKind::Difference | MapKind::SecondDifference => (
            output,
            Some(pair?.target.clone()?),
            Paint::Difference { view: request.difference, colours: request.colours, beside: beside(request, slot?) },
        ),
        MapKind::Unexplained => (lambda(&unexplained?.as_ref().ok().map(|u| u.map.clone())), None, colours),
    };
    Some(Subject { map: map?, minus, paint, projection: request.projection, is_fine: request.fine_columns })
}
