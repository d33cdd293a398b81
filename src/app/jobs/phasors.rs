//! The contributions of all elements to the cell under the cursor, computed off the UI thread.

use super::Pipeline;
use super::recorded::seen_by;
use crate::app::state::{PhasorSettings, State};
use crate::interact::Place;
use crate::radar::Radar;
use crate::recording::Recording;
use crate::scene::{Object, Point, Reflector, Scene};
use crate::signal::{self, BeatSignal, Floor};
use crate::task::{Reply, Task, Worker};
use crate::theory::Phasors as Chain;
use std::sync::Arc;

/// Where the samples come from.
#[derive(Clone)]
pub(super) struct Source {
    /// The radar.
    pub radar: Radar,
    scene: Arc<Scene>,
    recording: Option<Arc<Recording>>,
    floor: Floor,
}

impl Source {
    /// Those on screen.
    pub fn of(state: &State) -> Source {
        Source {
            radar: state.radar().clone(),
            scene: state.scene().clone(),
            recording: state.editor.document().recording().cloned(),
            floor: state.settings.floor,
        }
    }

    /// Whether both are the same samples.
    pub fn same(&self, other: &Source) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.recording.as_ref().map(Arc::as_ptr) == other.recording.as_ref().map(Arc::as_ptr)
            && (&self.radar, self.floor) == (&other.radar, other.floor)
    }

    /// The scene and the floor beneath it, where they are simulated.
    ///
    /// # Errors
    /// A sentence for a recording.
    pub fn simulated(&self) -> Result<(&Scene, Floor), String> {
        match self.recording {
            None => Ok((&self.scene, self.floor)),
            Some(_) => Err("A recording has one chirp, which tells no velocity.".to_owned()),
        }
    }

    /// The samples of every element.
    pub fn signal(&self) -> Result<BeatSignal, String> {
        let Source { radar, scene, recording, floor } = self;
        match recording {
            None => signal::simulate(radar, scene, *floor, scene.noise_seed).map_err(|e| e.to_string()),
            Some(recording) => match seen_by(recording, radar, &scene.disturbances.elements).signal() {
                Some(signal) => Ok(signal.clone()),
                None => Err("The recording has the two ends alone; every element is needed here.".to_owned()),
            },
        }
    }
}

#[derive(Clone)]
struct Request {
    source: Source,
    cell: [usize; 2],
    /// Where a point would have its blob in that cell.
    place: Place,
    settings: PhasorSettings,
    found: Vec<Reflector>,
}

impl Request {
    fn same(&self, other: &Request) -> bool {
        self.source.same(&other.source)
            && (self.cell, self.settings) == (other.cell, other.settings)
            && self.found == other.found
    }
}

/// The chains of one cell.
pub struct PhasorsResult {
    /// Range bin and column.
    pub cell: [usize; 2],
    /// What the elements contribute.
    pub measured: Chain,
    /// The same without the curvature of the wave from the cell's place.
    pub focused: Option<Chain>,
    /// What the echoes alone contribute.
    pub echoes: Option<Chain>,
    /// What the reflectors that the method found leave.
    pub residual: Option<Chain>,
}

/// The samples of the last scene: the cursor moves over one scene for long.
#[derive(Default)]
struct Kept {
    signal: Option<(Source, BeatSignal)>,
}

impl Kept {
    fn work(&mut self, request: &Request) -> Result<PhasorsResult, String> {
        let Request { source, cell, place, settings, found } = request;
        let radar = &source.radar;
        let signal = match self.signal.take() {
            Some((of, signal)) if of.same(source) => signal,
            _ => source.signal()?,
        };
        let chain = |signal: &BeatSignal| {
            Chain::of(radar, signal.samples.view(), settings.map.aperture(), *cell, settings.windowed)
        };
        let exact = |scene: &Scene| {
            signal::simulate(radar, scene, Floor::Exact, 0).map_err(|e| e.to_string()).map(|signal| chain(&signal))
        };
        let measured = chain(&signal);
        let focused = match settings.focused {
            true => Some(measured.focused(&exact(&Scene::of_points([(place.x_metres, place.y_metres)]))?)),
            false => None,
        };
        let echoes = if settings.echoes && source.recording.is_none() { Some(exact(&source.scene)?) } else { None };
        let residual = match settings.residual {
            true => Some(less(&measured, &exact(&scene_of(found))?)),
            false => None,
        };
        self.signal = Some((source.clone(), signal));
        Ok(PhasorsResult { cell: *cell, measured, focused, echoes, residual })
    }
}

/// What is left of `chain` without `other`.
fn less(chain: &Chain, other: &Chain) -> Chain {
    let contributions = chain.contributions.iter().zip(&other.contributions).map(|(a, b)| a - b).collect();
    Chain { first_element: chain.first_element, contributions }
}

fn scene_of(reflectors: &[Reflector]) -> Scene {
    let point =
        |r: &Reflector| Object::Point(Point { reflectivity: r.reflectivity, ..Point::new(r.x_metres, r.y_metres) });
    Scene { objects: reflectors.iter().map(point).collect(), ..Scene::default() }
}

/// The worker, what it was asked last, and what it found last.
pub struct Phasors {
    worker: Worker<Request, Result<PhasorsResult, String>>,
    asked: Option<Request>,
    result: Option<Result<PhasorsResult, String>>,
    requests: u64,
}

impl Phasors {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Phasors> {
        let work = |kept: &mut Kept, request: Request, _: &Task| kept.work(&request);
        Ok(Phasors {
            worker: Worker::spawn("phasors", Kept::default, work, wake)?,
            asked: None,
            result: None,
            requests: 0,
        })
    }

    /// Asks for the chains of the cell under the cursor, unless they were asked for last.
    pub fn ask(&mut self, state: &State, pipeline: &Pipeline) {
        let (radar, cursor) = (state.radar(), state.cut_cursor());
        let Some((bin, column)) = cursor.cell(radar) else { return };
        let settings = state.settings.phasors;
        let found = pipeline.output_of(state).filter(|_| settings.residual).map(|output| output.reflectors.clone());
        let request = Request {
            source: Source::of(state),
            cell: [bin, column],
            place: cursor.place,
            settings,
            found: found.unwrap_or_default(),
        };
        if self.asked.as_ref().is_none_or(|asked| !asked.same(&request)) {
            self.requests += 1;
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// What was found last, or why nothing was.
    pub fn result(&self) -> Option<Result<&PhasorsResult, &str>> {
        self.result.as_ref().map(|r| r.as_ref().map_err(String::as_str))
    }

    /// Requests so far: a test asks that a hidden panel makes none.
    pub fn requests(&self) -> u64 {
        self.requests
    }

    /// Whether it computes.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Takes in what was found. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result, .. } => self.result = Some(result),
                Reply::Panicked { message: said, .. } => {
                    message = Some(format!("Computing the phasors failed ({said}). Move the pointer to try again."));
                }
            }
        }
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(settings: PhasorSettings, found: Vec<Reflector>) -> Request {
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let scene = Scene::of_points([(0.2, 0.9)]);
        let source = Source { radar, scene: Arc::new(scene), recording: None, floor: Floor::Thesis };
        Request { source, cell: [12, 40], place: Place::new(0.2, 0.9), settings, found }
    }

    #[test]
    fn nothing_is_left_where_the_method_found_the_reflector() {
        let settings = PhasorSettings { residual: true, echoes: true, focused: true, ..PhasorSettings::default() };
        let found = vec![Reflector { x_metres: 0.2, y_metres: 0.9, reflectivity: 1.0 }];
        let result = Kept::default().work(&request(settings, found)).unwrap();
        let measured = result.measured.sum().norm();
        assert!(result.residual.unwrap().sum().norm() < 1e-9 * measured);
        assert!((result.echoes.unwrap().sum().norm() - measured).abs() < 1e-9 * measured);
        assert!(result.focused.unwrap().sum().norm() >= measured * (1.0 - 1e-9), "a straight chain reaches farther");
    }

    #[test]
    fn the_samples_are_kept_while_the_cursor_moves() {
        let (mut kept, first) = (Kept::default(), request(PhasorSettings::default(), Vec::new()));
        kept.work(&first).unwrap();
        let samples = |kept: &Kept| kept.signal.as_ref().map(|(_, s)| s.samples.as_ptr());
        let before = samples(&kept);
        kept.work(&Request { cell: [13, 41], ..first }).unwrap();
        assert_eq!(samples(&kept), before);
    }
}
