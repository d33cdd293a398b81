//! What the selected reflector tells of the elements, worked out off the UI thread.

use super::recorded::seen_by;
use crate::app::state::State;
use crate::radar::{BuiltArray, Radar};
use crate::recording::Recording;
use crate::scene::{Object, Reflector, Scene};
use crate::signal::{self, Calibration as Found, Floor, calibrate};
use crate::task::{Reply, Task, Worker};
use std::sync::Arc;

/// What a reflector told of the elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    /// What the reflector is called.
    pub name: String,
    /// Gain and phase of each element.
    pub calibration: Found,
    /// What is wrong with the elements once those are taken off.
    pub left: BuiltArray,
}

#[derive(Clone)]
struct Request {
    radar: Radar,
    scene: Arc<Scene>,
    recording: Option<Arc<Recording>>,
    name: String,
    reflector: Reflector,
    floor: Floor,
}

impl Request {
    /// On the selected point, if one is.
    fn of(state: &State) -> Option<Self> {
        let index = state.editor.selection().single()?;
        let scene = state.editor.scene();
        let Object::Point(point) = scene.objects.get(index)? else { return None };
        let (x_metres, y_metres, reflectivity) = (point.x_metres, point.y_metres, point.reflectivity);
        Some(Request {
            radar: state.radar().clone(),
            scene: scene.clone(),
            recording: state.editor.document().recording().cloned(),
            name: format!("point {}", index + 1),
            reflector: Reflector { x_metres, y_metres, reflectivity },
            floor: state.settings.floor,
        })
    }

    fn same(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.recording.as_ref().map(Arc::as_ptr) == other.recording.as_ref().map(Arc::as_ptr)
            && (&self.radar, &self.name, self.floor) == (&other.radar, &other.name, other.floor)
    }
}

fn work(request: Request) -> Result<Calibrated, String> {
    let Request { radar, scene, recording, name, reflector, floor } = request;
    let elements = &scene.disturbances.elements;
    let signal = match recording {
        None => signal::simulate(&radar, &scene, floor, scene.noise_seed).map_err(|e| e.to_string())?,
        Some(recording) => match seen_by(&recording, &radar, elements).signal() {
            Some(signal) => signal.clone(),
            None => return Err("The recording has the two ends alone; calibration looks at every element.".to_owned()),
        },
    };
    let calibration = calibrate(&radar, &signal, &reflector)
        .ok_or_else(|| format!("No element hears {name}, so that it calibrates nothing."))?;
    let left = elements.corrected(&calibration.array);
    Ok(Calibrated { name, calibration, left })
}

/// The worker, what it was asked last, and what it found last.
pub struct Calibration {
    worker: Worker<Request, Result<Calibrated, String>>,
    asked: Option<Request>,
    result: Option<Result<Calibrated, String>>,
}

impl Calibration {
    /// Starts the worker, which waits; `wake` is called from its thread.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let work = |_: &mut (), request: Request, _: &Task| work(request);
        Ok(Calibration { worker: Worker::spawn("calibration", || (), work, wake)?, asked: None, result: None })
    }

    /// Asks for what the selected reflector tells, unless that was asked for last.
    pub fn ask(&mut self, state: &State) {
        let request = Request::of(state);
        let same = match (&request, &self.asked) {
            (Some(a), Some(b)) => a.same(b),
            (None, None) => true,
            _ => false,
        };
        if same {
            return;
        }
        match &request {
            Some(request) => _ = self.worker.request(request.clone()),
            None => self.result = None,
        }
        self.asked = request;
    }

    /// Takes in what was found since the last frame. Returns messages for the user.
    pub fn poll(&mut self) -> Vec<String> {
        let mut messages = Vec::new();
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result, .. } => self.result = self.asked.is_some().then_some(result),
                Reply::Panicked { message, .. } => messages.push(format!("The calibration failed ({message}).")),
            }
        }
        messages
    }

    /// What the selected reflector told, or why it tells nothing; `None` where none is selected.
    pub fn result(&self) -> Option<Result<&Calibrated, &str>> {
        self.result.as_ref().map(|r| r.as_ref().map_err(String::as_str))
    }

    /// Whether the worker has something to do.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }
}
