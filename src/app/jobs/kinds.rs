//! What kind of failure: what became of every object in the outputs on screen, and what isn't there; off the UI thread.

use super::pipeline::Pipeline;
use super::scene_maps::Truth;
use crate::app::state::{MethodSlot, Panel, State};
use crate::evaluate::failure::{Cell, Failures, Footprints};
#[cfg(test)]
use crate::evaluate::failure::{Fate, Ghost};
use crate::maps::RangeAngleMap;
use crate::scene::Scene;
use crate::task::{Reply, Task, Worker};
use std::sync::Arc;

/// An output, and the threshold that says what of it is detected.
#[derive(Clone)]
struct Output {
    lambda: Arc<RangeAngleMap>,
    /// The map that is compared with the threshold: the output itself, or what a detector made of it.
    judged: Arc<RangeAngleMap>,
    eta: f32,
}

impl Output {
    fn same(&self, other: &Output) -> bool {
        Arc::ptr_eq(&self.lambda, &other.lambda) && Arc::ptr_eq(&self.judged, &other.judged) && self.eta == other.eta
    }
}

/// What is to be judged.
#[derive(Clone)]
struct Request {
    truth: Truth,
    outputs: [Option<Output>; 2],
}

impl Request {
    fn same(&self, other: &Request) -> bool {
        let outputs = self.outputs.iter().zip(&other.outputs).all(|pair| match pair {
            (Some(a), Some(b)) => a.same(b),
            (None, None) => true,
            _ => false,
        });
        outputs && Arc::ptr_eq(&self.truth.target.lambda, &other.truth.target.lambda)
    }
}

/// What became of one object, or a blob where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Index of the object in the scene; `None` for a ghost.
    pub object: Option<usize>,
    /// Cells of its footprint, or of the ghost.
    pub cells: usize,
    /// The brightest of them in the output.
    pub brightest: Option<Cell>,
}

/// What became of everything in one output.
#[derive(Debug, Clone)]
pub struct Fates {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What is right and what is not.
    pub failures: Failures,
    /// Every object of the scene, in its order, then every ghost.
    pub verdicts: Vec<Verdict>,
    /// The threshold that was judged at.
    pub eta: f32,
    output: Arc<RangeAngleMap>,
    target: Arc<RangeAngleMap>,
}

type Made = [Option<Fates>; 2];

/// The worker, and what it found last of either method's output.
pub struct Kinds {
    worker: Worker<Request, Made>,
    asked: Option<Request>,
    shown: Made,
}

/// Footprints of the last target: several outputs and thresholds are judged by the same.
#[derive(Default)]
struct Kept {
    last: Option<(Arc<RangeAngleMap>, Footprints)>,
}

impl Kept {
    fn footprints(&mut self, truth: &Truth) -> &Footprints {
        let Truth { radar, scene, target } = truth;
        let fresh = || (target.lambda.clone(), Footprints::new(radar, scene, &target.lambda, target.scale));
        let last = self.last.take().filter(|(of, _)| Arc::ptr_eq(of, &target.lambda));
        &self.last.insert(last.unwrap_or_else(fresh)).1
    }
}

impl Kinds {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Kinds> {
        let work = |kept: &mut Kept, request: Request, _: &Task| judge(kept.footprints(&request.truth), &request);
        let worker = Worker::spawn("kinds of failure", Kept::default, work, wake)?;
        Ok(Kinds { worker, asked: None, shown: [None, None] })
    }

    /// Asks for verdicts on the outputs on screen, where they are to be marked and belong to the maps.
    pub fn ask(&mut self, state: &State, pipeline: &Pipeline) {
        let told = state.arrangement.shown().contains(&Panel::Failures) && state.row_on_screen().is_some();
        // The headline of an output is made once the scene rests: a drag costs nothing for it.
        if !(state.settings.show_kinds || told || pipeline.is_settled()) || !pipeline.wants_output() {
            return;
        }
        let Some(truth) = pipeline.truth() else { return };
        let output = |slot| {
            let pair = pipeline.method(slot).output().map(|o| &o.pair)?;
            let of_it = pair.target.as_ref().is_some_and(|target| Arc::ptr_eq(target, &truth.target.lambda));
            let (judged, eta) = pipeline.judged(state, slot).filter(|_| of_it)?;
            Some(Output { lambda: pair.output.clone(), judged: judged.clone(), eta })
        };
        let request = Request { outputs: MethodSlot::BOTH.map(output), truth };
        let is_new = !self.asked.as_ref().is_some_and(|asked| asked.same(&request));
        if is_new && request.outputs.iter().any(Option::is_some) {
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// What became of everything in a method's output, and whether that is the one on screen.
    pub fn of(&self, slot: MethodSlot, pipeline: &Pipeline) -> Option<(&Fates, bool)> {
        let fates = self.shown[slot as usize].as_ref()?;
        let pair = &pipeline.method(slot).output()?.pair;
        let of_target = pair.target.as_ref().is_some_and(|target| Arc::ptr_eq(target, &fates.target));
        Some((fates, of_target && Arc::ptr_eq(&pair.output, &fates.output)))
    }

    /// Whether it judges.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Takes in what was found. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result, .. } => {
                    for (shown, made) in self.shown.iter_mut().zip(result) {
                        *shown = made.or(shown.take());
                    }
                }
                Reply::Panicked { message: said, .. } => {
                    message =
                        Some(format!("Telling kinds of failure apart failed ({said}). Change the scene to try again."));
                }
            }
        }
        message
    }
}

fn judge(footprints: &Footprints, request: &Request) -> Made {
    let Truth { scene, target, .. } = &request.truth;
    let fates = |output: &Output| {
        let failures = footprints.judge_cells(&target.lambda, &output.lambda, &output.judged.above(output.eta));
        let brightest = |cells: &[Cell]| {
            let lambda = |cell: &Cell| output.lambda.lambda[*cell];
            cells.iter().copied().max_by(|a, b| lambda(a).total_cmp(&lambda(b)))
        };
        let verdict = |object, cells: &[Cell]| Verdict { object, cells: cells.len(), brightest: brightest(cells) };
        let objects = footprints.cells().iter().enumerate().map(|(index, cells)| verdict(Some(index), cells));
        let ghosts = failures.ghosts.iter().map(|ghost| verdict(None, &ghost.cells));
        let verdicts = objects.chain(ghosts).collect();
        let (scene, target) = (scene.clone(), target.lambda.clone());
        Fates { scene, verdicts, failures, eta: output.eta, output: output.lambda.clone(), target }
    };
    request.outputs.each_ref().map(|output| output.as_ref().map(fates))
}

#[cfg(test)]
impl Fates {
    /// Fates of a scene's objects, each of 40 cells, and ghosts of 12 cells, at a threshold of 0.8.
    pub fn made_up(scene: Scene, fates: &[Fate], ghosts: &[Cell]) -> Fates {
        let object = |index: usize| Verdict { object: Some(index), cells: 40, brightest: None };
        let ghost = |at: &Cell| Verdict { object: None, cells: 12, brightest: Some(*at) };
        let nothing = || Arc::new(RangeAngleMap { lambda: ndarray::Array2::zeros((1, 1)) });
        let failures = Failures {
            objects: fates.to_vec(),
            covered: fates.iter().map(|fate| if *fate == Fate::Found { 1.0 } else { 0.0 }).collect(),
            ghosts: ghosts.iter().map(|at| Ghost { cells: vec![*at; 12] }).collect(),
        };
        let verdicts = (0..fates.len()).map(object).chain(ghosts.iter().map(ghost)).collect();
        Fates { scene: Arc::new(scene), failures, verdicts, eta: 0.8, output: nothing(), target: nothing() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::ReadyMap;
    use crate::maps::{LogMaps, Normalisation};
    use crate::radar::Radar;
    use crate::signal::{Floor, simulate};

    /// Two points, as a radar sees them.
    fn truth(radar: Radar) -> Truth {
        let scene = Arc::new(Scene::of_points([(-4.0, 12.0), (5.0, 20.0)]));
        let full = LogMaps::of_signal(&radar, &simulate(&radar, &scene, Floor::Thesis, 1).unwrap()).full;
        let lambda = Arc::new(full.normalise(Normalisation::MinMax));
        Truth { radar, scene, target: ReadyMap { lambda, scale: full.scale(Normalisation::MinMax) } }
    }

    #[test]
    fn verdicts_are_those_of_the_evaluation() {
        let truth = truth(Radar::default());
        let mut output = RangeAngleMap::clone(&truth.target.lambda);
        output.lambda.slice_mut(ndarray::s![.., 512..]).fill(0.0);
        output.lambda.slice_mut(ndarray::s![400..404, 200..210]).fill(0.95);
        output.lambda[[402, 205]] = 1.0;
        let judged = Arc::new(output.clone());
        let request = Request { truth, outputs: [Some(Output { lambda: judged.clone(), judged, eta: 0.9 }), None] };
        let Truth { radar, scene, target } = &request.truth;
        let footprints = Footprints::new(radar, scene, &target.lambda, target.scale);
        let [Some(fates), None] = judge(&footprints, &request) else { panic!("of the first alone") };
        let expected = footprints.judge(&target.lambda, &output, 0.9);
        assert_eq!(fates.failures, expected);
        assert_eq!(fates.failures.objects, [Fate::Found, Fate::Missed]);
        let [_, _, ghost] = fates.verdicts.as_slice() else { panic!("{:?}", fates.verdicts) };
        assert_eq!((ghost.object, ghost.cells, ghost.brightest), (None, 40, Some([402, 205])));
    }

    #[test]
    fn footprints_are_made_once_a_target() {
        let (truth, mut kept) = (truth(Radar { elements: 64, ..Radar::default() }), Kept::default());
        assert_eq!(kept.footprints(&truth).cells().len(), 2);
        let of_the_same_target = Truth { scene: Arc::default(), ..truth };
        assert_eq!(kept.footprints(&of_the_same_target).cells().len(), 2);
    }
}
