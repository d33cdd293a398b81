//! The verdict on every object in the outputs on screen, and their ghosts.

use super::derived::{Derived, Failure, Query};
use super::memo::Memo;
use super::pipeline::Pipeline;
use super::scene_maps::MapsResult;
use super::source::Source;
use crate::app::shared::Shared;
use crate::app::state::{MethodSlot, Panel, State};
use crate::evaluate::median_bound_metres;
use crate::evaluate::verdict::{CellIndex, Footprints, OutputVerdicts};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Layout;
use crate::scene::Scene;
use crate::task::Task;

/// An output, and the threshold of its detections.
#[derive(Clone, PartialEq)]
struct Output {
    lambda: Shared<RangeAngleMap>,
    /// The map compared with the threshold: the output itself, or a detector's map of it.
    judged: Shared<RangeAngleMap>,
    eta: f32,
}

/// A query of the verdicts on both outputs on screen, by the target.
#[derive(Clone, PartialEq)]
pub struct KindsQuery {
    source: Source,
    /// Numbers of the elements that methods use in place of the two ends.
    layout: Option<Vec<usize>>,
    target: Shared<RangeAngleMap>,
    scale: LambdaScale,
    outputs: [Option<Output>; 2],
}

/// The cells of one object or of a ghost, which a map marks with the verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct VerdictMark {
    pub object: Option<usize>,
    pub cells: usize,
    /// The brightest of these cells in the output.
    pub brightest: Option<CellIndex>,
}

/// One output with the verdicts on it.
#[derive(Debug, Clone)]
pub struct JudgedOutput {
    pub scene: Shared<Scene>,
    /// Verdict on every object, and the ghosts.
    pub verdicts: OutputVerdicts,
    /// Every object of the scene, in its order, then every ghost.
    pub marks: Vec<VerdictMark>,
    pub eta: f32,
    /// Median position bound of the found points, metres: no unbiased estimate is nearer on average. `None` without noise.
    pub bound_metres: Option<f64>,
    output: Shared<RangeAngleMap>,
    target: Shared<RangeAngleMap>,
}

/// The output of either method, judged.
type Made = [Option<JudgedOutput>; 2];

#[derive(Default)]
pub struct JudgeMemory {
    footprints: Memo<Shared<RangeAngleMap>, Footprints>,
    last: Made,
}

impl JudgeMemory {
    fn footprints(&mut self, query: &KindsQuery) -> &Footprints {
        let KindsQuery { source: Source { radar, scene, .. }, target, scale, .. } = query;
        self.footprints.of(target.clone(), |target| Footprints::new(radar, scene, target, *scale))
    }
}

impl KindsQuery {
    /// The query of the outputs on screen, where verdicts on them are shown and they belong to the maps.
    pub fn of(state: &State, pipeline: &Pipeline) -> Option<Self> {
        let told = state.arrangement.shown().contains(&Panel::Failures) && state.row_on_screen().is_some();
        // The headline of an output is made once the scene rests, so a drag doesn't pay for it.
        if !(state.settings.show_kinds || told || pipeline.maps.is_settled()) || !pipeline.maps.wants_ends() {
            return None;
        }
        let MapsResult { request, frame, .. } = pipeline.maps.result()?;
        let full = frame.full.as_ref().filter(|_| request.source.recording.is_none())?;
        let target = Shared::from(&full.lambda);
        let output = |slot| {
            let pair = pipeline.method(slot).output().map(|o| &o.pair)?;
            let of_it = pair.target.as_ref() == Some(&target);
            let (judged, eta) = pipeline.judged(state, slot).filter(|_| of_it)?;
            Some(Output { lambda: pair.output.clone(), judged: judged.into(), eta })
        };
        let outputs = MethodSlot::BOTH.map(output);
        let (source, layout) = (request.source.clone(), request.layout.clone());
        Some(KindsQuery { source, layout, target, scale: full.scale, outputs })
    }
}

impl Query for KindsQuery {
    type Value = Made;
    type State = JudgeMemory;
    const WHAT: &'static str = "Telling kinds of failure apart";

    fn compute(&self, kept: &mut JudgeMemory, _: &Task) -> Result<Made, Failure> {
        if self.outputs.iter().all(Option::is_none) {
            return Ok(kept.last.clone());
        }
        let made = judge(kept.footprints(self), self);
        for (last, made) in kept.last.iter_mut().zip(made) {
            *last = made.or(last.take());
        }
        Ok(kept.last.clone())
    }
}

/// The verdicts on a method's output, and whether they belong to the output on screen and it is fresh.
pub fn judged_output<'a>(
    kinds: &'a Derived<KindsQuery>,
    slot: MethodSlot,
    pipeline: &Pipeline,
) -> Option<(&'a JudgedOutput, bool)> {
    let judged = kinds.value()?.ok()?[slot as usize].as_ref()?;
    let pair = &pipeline.method(slot).output()?.pair;
    let is_of_it = pair.target.as_ref() == Some(&judged.target) && pair.output == judged.output;
    Some((judged, is_of_it && !pipeline.is_stale(slot.map())))
}

fn judge(footprints: &Footprints, request: &KindsQuery) -> Made {
    let KindsQuery { source: Source { radar, scene, floor, .. }, target, layout, .. } = request;
    let heard = layout.as_ref().map_or_else(|| Layout::two_ends(radar), |layout| Layout::of_numbers(radar, layout));
    let judged = |output: &Output| {
        let verdicts = footprints.judge_cells(target, &output.lambda, &output.judged.above(output.eta));
        let brightest = |cells: &[CellIndex]| {
            let lambda = |cell: &CellIndex| output.lambda.lambda[*cell];
            cells.iter().copied().max_by(|a, b| lambda(a).total_cmp(&lambda(b)))
        };
        let mark =
            |object, cells: &[CellIndex]| VerdictMark { object, cells: cells.len(), brightest: brightest(cells) };
        let objects = footprints.cells().iter().enumerate().map(|(index, cells)| mark(Some(index), cells));
        let ghosts = verdicts.ghosts.iter().map(|ghost| mark(None, &ghost.cells));
        let marks = objects.chain(ghosts).collect();
        let (scene, target) = (scene.clone(), target.clone());
        let bound_metres = median_bound_metres((radar, &heard), &scene, &verdicts, *floor);
        JudgedOutput { scene, marks, verdicts, eta: output.eta, bound_metres, output: output.lambda.clone(), target }
    };
    request.outputs.each_ref().map(|output| output.as_ref().map(judged))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::verdict::{Ghost, ObjectVerdict};
    use crate::maps::{LogMaps, Normalisation};
    use crate::radar::Radar;
    use crate::signal::{Floor, simulate};

    impl JudgedOutput {
        /// Verdicts on a scene's objects of 40 cells each, and ghosts of 12 cells, at a threshold of 0.8.
        pub fn made_up(scene: Scene, objects: &[ObjectVerdict], ghosts: &[CellIndex]) -> JudgedOutput {
            let object = |index: usize| VerdictMark { object: Some(index), cells: 40, brightest: None };
            let ghost = |at: &CellIndex| VerdictMark { object: None, cells: 12, brightest: Some(*at) };
            let nothing = || Shared::new(RangeAngleMap { lambda: ndarray::Array2::zeros((1, 1)) });
            let covered = |verdict: &ObjectVerdict| if *verdict == ObjectVerdict::Found { 1.0 } else { 0.0 };
            let verdicts = OutputVerdicts {
                objects: objects.to_vec(),
                covered: objects.iter().map(covered).collect(),
                ghosts: ghosts.iter().map(|at| Ghost { cells: vec![*at; 12] }).collect(),
            };
            let marks = (0..objects.len()).map(object).chain(ghosts.iter().map(ghost)).collect();
            let (scene, output, target) = (Shared::new(scene), nothing(), nothing());
            JudgedOutput { scene, verdicts, marks, eta: 0.8, bound_metres: None, output, target }
        }
    }

    /// The query of no output beside the target map of two points.
    fn query(radar: Radar) -> KindsQuery {
        let scene = Shared::new(Scene::of_points([(-4.0, 12.0), (5.0, 20.0)]));
        let full = LogMaps::of_signal(&radar, &simulate(&radar, &scene, Floor::Thesis, 1).unwrap()).full;
        let target = Shared::new(full.normalise(Normalisation::MinMax));
        let source = Source { radar, scene, recording: None, floor: Floor::Thesis };
        KindsQuery { source, target, layout: None, scale: full.scale(Normalisation::MinMax), outputs: [None, None] }
    }

    #[test]
    fn verdicts_are_those_of_the_evaluation() {
        let mut request = query(Radar::default());
        let mut output = RangeAngleMap::clone(&request.target);
        output.lambda.slice_mut(ndarray::s![.., 512..]).fill(0.0);
        output.lambda.slice_mut(ndarray::s![400..404, 200..210]).fill(0.95);
        output.lambda[[402, 205]] = 1.0;
        let judged = Shared::new(output.clone());
        request.outputs[0] = Some(Output { lambda: judged.clone(), judged, eta: 0.9 });
        let KindsQuery { source: Source { radar, scene, .. }, target, scale, .. } = &request;
        let footprints = Footprints::new(radar, scene, target, *scale);
        let [Some(judged), None] = judge(&footprints, &request) else { panic!("of the first alone") };
        let expected = footprints.judge(target, &output, 0.9);
        assert_eq!(judged.verdicts, expected);
        assert_eq!(judged.verdicts.objects, [ObjectVerdict::Found, ObjectVerdict::Missed]);
        let [_, _, ghost] = judged.marks.as_slice() else { panic!("{:?}", judged.marks) };
        assert_eq!((ghost.object, ghost.cells, ghost.brightest), (None, 40, Some([402, 205])));
    }

    #[test]
    fn footprints_are_made_once_a_target() {
        let (query, mut kept) = (query(Radar { elements: 64, ..Radar::default() }), JudgeMemory::default());
        assert_eq!(kept.footprints(&query).cells().len(), 2);
        let source = Source { scene: Shared::new(Scene::default()), ..query.source.clone() };
        let of_the_same_target = KindsQuery { source, ..query };
        assert_eq!(kept.footprints(&of_the_same_target).cells().len(), 2);
    }
}
