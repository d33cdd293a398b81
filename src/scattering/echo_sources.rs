//! All scatterers of a scene: free points, and bodies or shadowed points.

use super::sight::{Array, Screen};
use super::strips::Strips;
use super::{AntennaPlaces, PathEcho, Scatterer};
use crate::radar::Radar;
use crate::scene::{Object, Reflector, Scene};
use rayon::prelude::*;
use std::sync::Arc;

/// An object, and the bodies that may shadow it. Equal values have equal echoes.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectWithOccluders {
    pub object: Object,
    /// Bodies between it and the array, or nearly so; none for most objects.
    pub hidden_by: Arc<[Arc<Object>]>,
}

impl From<Object> for ObjectWithOccluders {
    /// An object that nothing hides.
    fn from(object: Object) -> Self {
        ObjectWithOccluders { object, hidden_by: Arc::default() }
    }
}

/// Bodies that may hide others, each with the index of its object.
struct Bodies {
    array: Array,
    screens: Vec<(usize, Arc<Object>, Screen)>,
    strips: Strips,
}

impl Bodies {
    fn of(radar: &Radar, scene: &Scene) -> Self {
        let array = Array::of(radar, &scene.disturbances.elements);
        let screen = |(index, object): (usize, &Object)| {
            let screen = array.screen(&object.body()?.shape);
            Some((index, Arc::new(object.clone()), screen))
        };
        let bodies = scene.objects.iter().enumerate().filter_map(screen);
        let screens: Vec<_> = if scene.shadows { bodies.collect() } else { Vec::new() };
        let strips = Strips::new(screens.iter().map(|(.., screen)| screen.disc()));
        Bodies { array, screens, strips }
    }

    /// Bodies that may hide a part of object `index`; with a mirror, all other bodies.
    fn hiding(&self, index: usize, object: &Object, all: bool) -> Arc<[Arc<Object>]> {
        let is_other = |(other, ..): &&(usize, Arc<Object>, Screen)| *other != index;
        if all {
            return self.screens.iter().filter(is_other).map(|(_, object, _)| object.clone()).collect();
        }
        let ways = self.array.ways_to(object);
        let may_pass = |(.., screen): &&(usize, Arc<Object>, Screen)| ways.may_pass(screen);
        let near = self.strips.near(ways.hull(), ways.widest());
        let near = near.into_iter().filter_map(|at| self.screens.get(at));
        let mut found: Vec<_> = near.filter(is_other).filter(may_pass).map(|(_, object, _)| object.clone()).collect();
        if found.is_empty() && object.body().is_none() {
            // A point that nothing can hide is summed by another algorithm, to other last bits, so `may_pass` alone decides.
            found.extend(self.screens.iter().find(may_pass).map(|(_, object, _)| object.clone()));
        }
        found.into()
    }
}

/// Number of objects from which on shadowing bodies are searched on several threads.
const MIN_PARALLEL_OBJECTS: usize = 32;

impl ObjectWithOccluders {
    /// Every object of a scene, with the bodies that may hide it from `radar`.
    pub fn all(radar: &Radar, scene: &Scene) -> Vec<ObjectWithOccluders> {
        let bodies = Bodies::of(radar, scene);
        let is_mirrored = scene.disturbances.mirror.is_some();
        let seen = |(index, object): (usize, &Object)| {
            if bodies.screens.is_empty() {
                return ObjectWithOccluders::from(object.clone());
            }
            let all = is_mirrored && object.body().is_some();
            ObjectWithOccluders { object: object.clone(), hidden_by: bodies.hiding(index, object, all) }
        };
        scene.objects.par_iter().enumerate().with_min_len(MIN_PARALLEL_OBJECTS).map(seen).collect()
    }

    /// The object's scatterer before `radar`.
    pub fn scatterer(&self, radar: &Radar) -> Scatterer {
        Scatterer::new(radar, &self.object, self.hidden_by.iter().map(Arc::as_ref))
    }

    /// Most echoes of the object at one element.
    pub fn echo_count(&self) -> usize {
        self.object.echo_count()
    }

    fn is_points(&self) -> bool {
        self.object.body().is_none() && self.hidden_by.is_empty()
    }
}

/// All echoing objects of a scene: reflectors that nothing hides, and the other objects.
#[derive(Debug, Clone, Default)]
pub struct EchoSources {
    /// Reflectors that nothing hides.
    pub points: Vec<Reflector>,
    /// Bodies, and points that are partly hidden.
    pub scatterers: Vec<Scatterer>,
}

impl EchoSources {
    /// All echoing objects of `scene`, with their images in a mirror.
    pub fn of(radar: &Radar, scene: &Scene) -> Self {
        if !scene.has_bodies() {
            return EchoSources { points: scene.echoing(radar), scatterers: Vec::new() };
        }
        let mut all = EchoSources::of_objects(radar, &ObjectWithOccluders::all(radar, scene));
        if let Some(mirror) = scene.disturbances.mirror {
            all.scatterers = all.scatterers.into_iter().map(|s| s.in_mirror(mirror)).collect();
            // Ghosts of points come after all reflectors.
            all.points.extend(scene.echoing(radar).drain(scene.reflector_count()..));
        }
        all
    }

    /// The echoes of these objects, without a mirror.
    pub fn of_objects(radar: &Radar, objects: &[ObjectWithOccluders]) -> Self {
        let mut all = EchoSources::default();
        for one in objects {
            if one.is_points() {
                all.points.extend(one.object.reflectors());
            } else {
                all.scatterers.push(one.scatterer(radar));
            }
        }
        all
    }

    /// Most echoes of all at one element.
    pub fn len(&self) -> usize {
        Sources::from(self).len()
    }

    /// Whether nothing echoes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The echoes of every body at the centre of the array, each with the index of its object.
pub fn array_centre_echoes(radar: &Radar, scene: &Scene) -> Vec<(usize, PathEcho)> {
    let antennas = AntennaPlaces::at([0.0, 0.0]);
    let mut all = Vec::new();
    for (index, seen) in
        ObjectWithOccluders::all(radar, scene).iter().enumerate().filter(|(_, s)| s.object.body().is_some())
    {
        let mut echoes = Vec::new();
        seen.scatterer(radar).echoes(&antennas, &mut echoes);
        all.extend(echoes.into_iter().filter(PathEcho::is_heard).map(|echo| (index, echo)));
    }
    all
}

/// Echoing objects, as the algorithms for samples take them.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// Reflectors that nothing hides.
    pub points: &'a [Reflector],
    /// Bodies, and points that are partly hidden.
    pub scatterers: &'a [Scatterer],
}

impl<'a> From<&'a EchoSources> for Sources<'a> {
    fn from(all: &'a EchoSources) -> Self {
        Sources { points: &all.points, scatterers: &all.scatterers }
    }
}

impl<'a, T: AsRef<[Reflector]> + ?Sized> From<&'a T> for Sources<'a> {
    fn from(points: &'a T) -> Self {
        Sources { points: points.as_ref(), scatterers: &[] }
    }
}

impl Sources<'_> {
    /// Most echoes of all at one element.
    pub fn len(&self) -> usize {
        self.points.len() + self.scatterers.iter().map(Scatterer::echo_count).sum::<usize>()
    }

    /// Whether nothing echoes.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.scatterers.is_empty()
    }

    /// Replaces `out` by the echoes of all scatterers at `pair`, those it doesn't hear included: their order is the same everywhere.
    pub fn scattered(&self, antennas: impl Into<AntennaPlaces>, out: &mut Vec<PathEcho>) {
        out.clear();
        let antennas = antennas.into();
        self.scatterers.iter().for_each(|s| s.echoes(&antennas, out));
    }
}
