//! Scenes of points, lines, clusters and bodies. [`Scene::reflectors`] turns an [`Object`] made of points into [`Reflector`]s; echoes of a
//! [`body`] are computed in [`crate::scattering`].

pub mod body;
mod common;
mod disturbances;
pub mod file;
pub mod generate;
mod motion;
pub mod npz;
mod object;
mod object_check;
pub mod presets;
pub mod shape;
mod turn;

pub(crate) use common::is_default;

pub use body::{Block, Body, Polygon, Post, Wall};
pub use disturbances::{Disturbances, Interferer, Mirror};
pub use motion::MAX_SPEED_METRES_PER_SECOND;
pub use object::{GaussianCluster, Line, MAX_NAME_CHARACTERS, Object, Point};
pub use shape::Shape;

use crate::radar::{Radar, RadarError};
use serde::{Deserialize, Serialize};

/// One ideal point reflector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reflector {
    /// Position along the array's axis, metres.
    pub x_metres: f64,
    /// Position ahead of the array, metres. A line array cannot tell y from -y.
    pub y_metres: f64,
    /// Reflectivity sigma; the thesis uses 1.
    pub reflectivity: f64,
}

impl Reflector {
    /// A reflector at (x, y), metres.
    pub fn at([x_metres, y_metres]: [f64; 2], reflectivity: f64) -> Self {
        Reflector { x_metres, y_metres, reflectivity }
    }
}

/// Objects before the radar, in the order they were added.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// The scene's name; empty for none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Notes on the purpose of the scene.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub notes: String,
    /// Picks the noise of the floor beneath the scene, where there is noise. TOML holds it up to 2^63.
    #[serde(default, skip_serializing_if = "is_default")]
    pub noise_seed: u64,
    /// Whether bodies hide what stands behind them.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub shadows: bool,
    #[serde(default, skip_serializing_if = "Disturbances::is_none")]
    pub disturbances: Disturbances,
    /// The objects, in the order they were added.
    #[serde(default, rename = "object", skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<Object>,
}

impl Default for Scene {
    fn default() -> Self {
        let (name, notes) = (String::new(), String::new());
        Scene { name, notes, noise_seed: 0, shadows: true, disturbances: Disturbances::default(), objects: Vec::new() }
    }
}

pub(crate) fn yes() -> bool {
    true
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_true(value: &bool) -> bool {
    *value
}

/// Smallest distance of a reflector from an element, metres. Nearer, the 1/R^2 law is unbounded.
pub const MIN_ELEMENT_DISTANCE_METRES: f64 = 1e-6;

/// Most reflectors, and most objects, that a scene may hold.
pub const MAX_REFLECTORS: usize = 200_000;

/// A reason for which a scene can't be simulated. Messages count objects from 1, as the app does.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    #[error("object {} ({kind}): {field} is {value}; expected {expected}", object + 1)]
    Value { object: usize, kind: &'static str, field: &'static str, value: f64, expected: &'static str },
    #[error(
        "object {} ({kind}): its reflector at x = {x_metres} m, y = {y_metres} m lies on element {element} of the array; move it at least {MIN_ELEMENT_DISTANCE_METRES} m away",
        object + 1
    )]
    OnElement { object: usize, kind: &'static str, x_metres: f64, y_metres: f64, element: usize },
    #[error("object {} ({kind}): {fault}", object + 1)]
    Outline { object: usize, kind: &'static str, fault: String },
    #[error("object {} ({kind}): element {element} of the array lies inside it or on it; move it away from the array", object + 1)]
    Covers { object: usize, kind: &'static str, element: usize },
    #[error("the scene has {count} {what}; at most {MAX_REFLECTORS} can be simulated")]
    TooMany { count: usize, what: &'static str },
    #[error("disturbances.elements: {0}")]
    Elements(String),
    #[error("{what}: {field} is {value}; expected a number from {low} to {high}")]
    Disturbance { what: &'static str, field: &'static str, value: f64, low: f64, high: f64 },
    #[error(transparent)]
    Radar(#[from] RadarError),
}

impl Scene {
    /// A scene of points of reflectivity 1.
    pub fn of_points(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let objects =
            points.into_iter().map(|(x_metres, y_metres)| Object::Point(Point::new(x_metres, y_metres))).collect();
        Scene { objects, ..Scene::default() }
    }

    /// Every reflector of every object, in order.
    pub fn reflectors(&self) -> Vec<Reflector> {
        self.objects.iter().flat_map(Object::reflectors).collect()
    }

    /// Whether no object reflects, so that the samples are noise alone, or zero.
    pub fn is_silent(&self) -> bool {
        self.objects.iter().all(|object| object.reflectivity() == 0.0 || object.echo_count() == 0)
    }

    /// Every reflector and its ghosts in a mirror, without bodies.
    pub fn echoing(&self, radar: &Radar) -> Vec<Reflector> {
        let mut all = self.reflectors();
        if let Some(mirror) = &self.disturbances.mirror {
            let ghosts: Vec<Reflector> = all.iter().flat_map(|r| mirror.ghosts(radar, r)).collect();
            all.extend(ghosts.into_iter().filter(|ghost| touched_element(radar, ghost).is_none()));
        }
        all
    }

    /// Number of reflectors, without making them.
    pub fn reflector_count(&self) -> usize {
        self.objects.iter().fold(0, |n, o| n.saturating_add(o.reflector_count()))
    }

    /// Most echoes of the scene at one element, without making them.
    pub fn echo_count(&self) -> usize {
        self.objects.iter().fold(0, |n, o| n.saturating_add(o.echo_count()))
    }

    /// Whether there is a body among the objects.
    pub fn has_bodies(&self) -> bool {
        self.objects.iter().any(|o| o.body().is_some())
    }

    /// Checks that the scene has at most [`MAX_REFLECTORS`] reflectors and objects.
    /// # Errors
    /// [`SceneError::TooMany`] says how many there are.
    pub fn check_count(&self) -> Result<(), SceneError> {
        self.check_room(&[])
    }

    /// Checks that `more` objects have room beside those of the scene.
    /// # Errors
    /// [`SceneError::TooMany`] says how many there would be.
    pub fn check_room(&self, more: &[Object]) -> Result<(), SceneError> {
        let count = |of: fn(&Object) -> usize| {
            self.objects.iter().chain(more).fold(0usize, |n, object| n.saturating_add(of(object)))
        };
        within_limit(self.objects.len() + more.len(), "objects")?;
        within_limit(count(Object::reflector_count), "reflectors")?;
        within_limit(count(Object::echo_count), "echoes")
    }

    /// Checks that the radar is valid, every number finite and in range, and no reflector on an element. Reflectors behind the array (y < 0),
    /// beyond the maximum range (they wrap) and very far away are allowed.
    /// # Errors
    /// [`SceneError`] names the object or the radar's field, and what was expected.
    pub fn validate(&self, radar: &Radar) -> Result<(), SceneError> {
        radar.validate()?;
        self.check_count()?;
        self.disturbances.validate(radar)?;
        if self.disturbances.mirror.is_some() {
            within_limit(self.reflector_count().saturating_mul(4), "reflectors and ghosts")?;
        }
        for (index, object) in self.objects.iter().enumerate() {
            object.validate(index)?;
            if let Some(element) = object.body().and_then(|body| body.covered_element(radar)) {
                return Err(SceneError::Covers { object: index, kind: object.kind(), element });
            }
            for r in object.reflectors() {
                if let Some(element) = touched_element(radar, &r) {
                    let (kind, Reflector { x_metres, y_metres, .. }) = (object.kind(), r);
                    return Err(SceneError::OnElement { object: index, kind, x_metres, y_metres, element });
                }
            }
        }
        Ok(())
    }
}

fn within_limit(count: usize, what: &'static str) -> Result<(), SceneError> {
    if count > MAX_REFLECTORS { Err(SceneError::TooMany { count, what }) } else { Ok(()) }
}

/// The element that a reflector comes too close to, if any.
pub(crate) fn touched_element(radar: &Radar, r: &Reflector) -> Option<usize> {
    let [hind, fore] = radar.antenna_depth_metres();
    if (r.y_metres - r.y_metres.clamp(hind, fore)).abs() >= MIN_ELEMENT_DISTANCE_METRES {
        return None;
    }
    if !radar.is_monostatic() {
        let touches = |[x, y]: [f64; 2]| (r.x_metres - x).hypot(r.y_metres - y) < MIN_ELEMENT_DISTANCE_METRES;
        let of_pair = |n: &usize| radar.pair(*n).places_metres().into_iter().any(touches);
        return (0..radar.elements).find(of_pair);
    }
    let middle = (radar.elements as f64 - 1.0) / 2.0;
    let nearest = (r.x_metres / radar.element_spacing_metres + middle).round();
    let nearest = nearest.clamp(0.0, radar.elements as f64 - 1.0) as usize;
    let distance = (r.x_metres - radar.element_x_metres(nearest)).hypot(r.y_metres);
    (distance < MIN_ELEMENT_DISTANCE_METRES).then_some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reflector_on_an_element_is_named() {
        let radar = Radar::default();
        let on = Scene::of_points([(0.0, 5.0), (radar.element_x_metres(7), 0.0)]);
        let message = on.validate(&radar).unwrap_err().to_string();
        assert!(message.contains("object 2") && message.contains("element 7"), "{message}");
        assert!(Scene::of_points([(0.0, 0.0)]).validate(&radar).is_ok(), "x = 0 lies between two elements");
    }

    #[test]
    fn crowds_are_refused_before_they_are_made() {
        let line = |count| Object::Line(Line::vertical(1.0, 1.0, 0.1, count));
        let of = |objects| Scene { objects, ..Scene::default() }.validate(&Radar::default()).map_err(|e| e.to_string());
        assert_eq!(of(vec![line(MAX_REFLECTORS)]), Ok(()));
        assert!(of(vec![line(MAX_REFLECTORS), line(1)]).unwrap_err().contains("200001 reflectors"));
        assert!(of(vec![line(usize::MAX), line(usize::MAX)]).unwrap_err().contains("reflectors"));
        assert!(of(vec![line(0); MAX_REFLECTORS + 1]).unwrap_err().contains("200001 objects"));
        let large = Radar { elements: 65536, samples: 65536, ..Radar::default() };
        assert!(Scene::default().validate(&large).unwrap_err().to_string().contains("TiB"));
    }
}
