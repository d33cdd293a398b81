//! One map for several values, off the UI thread. The latest request wins, and each map is shown as soon as it is finished.

use super::derived::MAX_OUTDATED_WORK_TIME;
use super::painter::Painter;
use super::subject::{Paint, Subject};
use crate::app::shared::Shared;
use crate::app::state::{MapKind, Panel, Projection, State, Variant};
use crate::maps::focus::{layout_map, map_of};
use crate::maps::{Aperture, Normalisation, RangeAngleMap};
use crate::picture::ColourMap;
use crate::radar::{End, LayoutKind};
use crate::reconstruct::Request as MethodRequest;
use crate::scene::Scene;
use crate::signal;
use crate::task::{Reply, Task, Worker};
use eframe::egui::ColorImage;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

#[derive(Clone, PartialEq)]
struct Request {
    scene: Shared<Scene>,
    variants: Vec<Variant>,
    map: MapKind,
    /// The elements that methods use in place of the two ends.
    layout: Option<LayoutKind>,
    normalisation: Normalisation,
    colours: ColourMap,
    projection: Projection,
}

/// A map's picture, or the reason why there is none.
type Made = Result<Arc<ColorImage>, String>;

/// A finished map, with the number of its request and its value in words.
type Arrival = (u64, String, Made);

#[derive(Clone)]
pub struct Small {
    pub variant: Variant,
    /// The latest picture, or the reason why there is none.
    pub made: Option<Made>,
    pub is_current: bool,
}

/// The worker of small maps, and those on screen.
pub struct SeveralMaps {
    worker: Worker<(u64, Request), ()>,
    arriving: Receiver<Arrival>,
    asked: Option<Request>,
    pub shown: Vec<Small>,
    requests: u64,
}

impl SeveralMaps {
    /// Starts the worker, idle at first; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> SeveralMaps {
        let (done, arriving) = channel();
        let each = wake.clone();
        let work = move |_: &mut (), (number, request): (u64, Request), task: &Task| {
            make(number, &request, task, &done, &each)
        };
        let worker = Worker::spawn("several maps", || (), work, wake);
        SeveralMaps { worker, arriving, asked: None, shown: Vec::new(), requests: 0 }
    }

    /// Asks for the panel's maps, if they changed and the panel is in sight.
    pub fn ask(&mut self, state: &State) {
        if !state.arrangement.shown().contains(&Panel::Several) {
            return;
        }
        let settings = &state.settings;
        let variants = settings.several.variants(state.radar(), settings.floor, state.method(), &state.methods.all);
        let request = Request {
            scene: state.scene().into(),
            variants,
            map: settings.several.map,
            layout: settings.layout.clone(),
            normalisation: settings.normalisation,
            colours: settings.colours,
            projection: settings.projection,
        };
        if self.asked.as_ref() == Some(&request) {
            return;
        }
        self.requests += 1;
        if state.editor.dragged().is_none() {
            self.worker.cancel_older_than(MAX_OUTDATED_WORK_TIME);
        }
        self.keep_pictures(&request.variants);
        self.worker.request((self.requests, request.clone()));
        self.asked = Some(request);
    }

    /// Sets the shown maps to `variants`. Each keeps its picture until the next one is there, where a map of the same value has one.
    fn keep_pictures(&mut self, variants: &[Variant]) {
        let old = std::mem::take(&mut self.shown);
        let made =
            |variant: &Variant| old.iter().find(|s| s.variant.label == variant.label).and_then(|s| s.made.clone());
        self.shown = variants
            .iter()
            .map(|variant| Small { made: made(variant), variant: variant.clone(), is_current: false })
            .collect();
    }

    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Takes in finished maps. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        for (request, label, made) in self.arriving.try_iter() {
            let latest = self.requests == request;
            // During a drag, maps of the request before the last still show the movement.
            let of_value = |small: &&mut Small| small.variant.label == label && (latest || !small.is_current);
            if let Some(small) = self.shown.iter_mut().find(of_value) {
                small.made = Some(made);
                small.is_current = latest;
            }
        }
        let panicked = self.worker.replies().into_iter().find_map(|reply| match reply {
            Reply::Panicked { message, .. } => Some(message),
            Reply::Done { .. } => None,
        })?;
        Some(format!("Computing several maps failed ({panicked}). Change the scene or the values to try again."))
    }
}

fn make(number: u64, request: &Request, task: &Task, done: &Sender<Arrival>, wake: &impl Fn()) {
    for variant in &request.variants {
        if task.is_cancelled() {
            return;
        }
        let made = map(request, variant, task).map(|map| picture(request, variant, map));
        if task.is_cancelled() {
            return;
        }
        // The window may be gone by now.
        let _closed = done.send((number, variant.label.clone(), made));
        wake();
    }
}

fn map(request: &Request, variant: &Variant, task: &Task) -> Result<RangeAngleMap, String> {
    let Variant { radar, floor, method, .. } = variant;
    let signal =
        signal::simulate(radar, &request.scene, *floor, request.scene.noise_seed).map_err(|e| e.to_string())?;
    let normalisation = request.normalisation;
    let elements = &request.scene.disturbances.elements;
    let numbers = request.layout.as_ref().map(|layout| layout.numbers(radar)).transpose()?;
    let layout_samples = numbers.map(|numbers| Arc::new(signal.of_layout(&numbers)));
    let aperture = match request.map {
        MapKind::Input0 if let Some(layout_samples) = &layout_samples => {
            return Ok(layout_map(radar, elements, layout_samples).log_magnitude().normalise(normalisation));
        }
        MapKind::Input0 => Aperture::End(End::First),
        MapKind::Input1 => Aperture::End(End::Last),
        MapKind::Output => {
            let method = method.as_ref().ok_or("there is no method")?;
            let (noise, task) = ((*floor).into(), task.clone());
            let wanted = MethodRequest { noise, normalisation, layout_samples, task, ..MethodRequest::default() };
            let made = method.reconstruct(radar, &signal.two_ends(radar), &wanted);
            return made.map(|made| made.lambda).map_err(|e| e.to_string());
        }
        _ => Aperture::Full,
    };
    let map = map_of(radar, elements, &signal, aperture);
    Ok(map.log_magnitude().normalise(normalisation))
}

fn picture(request: &Request, variant: &Variant, map: RangeAngleMap) -> Arc<ColorImage> {
    let paint = Paint::Lambda(request.colours);
    let subject = Subject { map: Shared::new(map), minus: None, paint, projection: request.projection, is_fine: false };
    Painter::default().paint(&variant.radar, request.map, &subject).image
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{Parameter, Several};
    use crate::radar::Radar;
    use crate::signal::Floor;

    fn request(parameter: Parameter) -> Request {
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let several = Several::default().with(parameter, &radar);
        Request {
            scene: Shared::new(Scene::of_points([(0.3, 1.2)])),
            variants: several.variants(&radar, Floor::Exact, None, &[]),
            map: several.map,
            layout: None,
            normalisation: Normalisation::DynamicRange(crate::radar::Decibels(60.0)),
            colours: ColourMap::Grey,
            projection: Projection::RangeAngle,
        }
    }

    #[test]
    fn every_value_has_a_picture_of_its_own() {
        for parameter in
            [Parameter::Window, Parameter::Bandwidth, Parameter::Spacing, Parameter::Snr, Parameter::EndElements]
        {
            let (done, arriving) = channel();
            let request = request(parameter);
            make(1, &request, &Task::default(), &done, &|| ());
            let images: Vec<Arc<ColorImage>> = arriving.try_iter().map(|(_, _, made)| made.unwrap()).collect();
            assert_eq!(images.len(), request.variants.len());
            assert!(images.windows(2).all(|pair| pair[0].pixels != pair[1].pixels), "{parameter:?}");
        }
    }

    #[test]
    fn a_cancelled_request_makes_nothing_more() {
        let (done, arriving) = channel();
        let task = Task::default();
        task.cancel();
        make(1, &request(Parameter::Window), &task, &done, &|| ());
        assert_eq!(arriving.try_iter().count(), 0);
    }
}
