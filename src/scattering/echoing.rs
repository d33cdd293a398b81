//! All that echoes in a scene: points by themselves, and scatterers.

use super::{Antennas, PathEcho, Scatterer};
use crate::radar::{Pair, Radar};
use crate::scene::{Object, Reflector, Scene};

/// An object, and the bodies that may hide a part of it from an element. Two that are equal have the same echoes.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The object.
    pub object: Object,
    /// Bodies that stand between it and the array, or nearly so; none for most objects.
    pub hidden_by: Vec<Object>,
}

impl From<Object> for Seen {
    /// An object that nothing hides.
    fn from(object: Object) -> Self {
        Seen { object, hidden_by: Vec::new() }
    }
}

/// Bodies with the circles around them.
struct Bodies<'a> {
    bodies: Vec<(usize, &'a Object, [f64; 2], f64)>,
    /// The ends of the array, metres.
    array: [f64; 2],
    /// How far beside a way something stands that has no effect on it, metres, for each square root of a metre of the way and beyond.
    ripple: [f64; 2],
}

impl<'a> Bodies<'a> {
    fn of(radar: &Radar, scene: &'a Scene) -> Self {
        let bodies = scene.objects.iter().enumerate().filter_map(|(index, object)| {
            let (centre, radius) = object.body()?.shape().around();
            Some((index, object, centre, radius))
        });
        let bodies = if scene.shadows { bodies.collect() } else { Vec::new() };
        // Elements may stand a few millimetres off their places.
        let half = radar.aperture_metres() / 2.0 + 0.05;
        let per_radian = 36.0 / super::Wave::of(radar).radians_per_metre;
        Bodies { bodies, array: [-half, half], ripple: [per_radian, per_radian] }
    }

    /// Those that may hide a part of object `index`, which lies within a circle. With a mirror, all.
    fn hiding(&self, index: usize, centre: [f64; 2], radius: f64, all: bool) -> Vec<Object> {
        let [left, right] = self.array;
        let farthest = centre[0].hypot(centre[1]) + right + radius;
        // A glint's way goes on behind the face, as long as it came.
        let margin = (self.ripple[0] * (2.0 * farthest + self.ripple[1])).sqrt();
        let between =
            |c: &[f64; 2], r: f64| from_triangle(*c, [[left, 0.0], [right, 0.0], centre]) <= r + radius + margin;
        self.bodies
            .iter()
            .filter(|(other, _, c, r)| *other != index && (all || between(c, *r)))
            .map(|(_, object, ..)| (*object).clone())
            .collect()
    }
}

/// Distance of a place from a triangle, metres; 0 inside.
fn from_triangle(place: [f64; 2], corners: [[f64; 2]; 3]) -> f64 {
    let edges = [0, 1, 2].map(|i| [corners[i], corners[(i + 1) % 3]]);
    let side = |[a, b]: [[f64; 2]; 2]| (b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0]);
    let sides = edges.map(side);
    if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
        return 0.0;
    }
    edges.into_iter().map(|edge| crate::scene::shape::from_stretch(place, edge)).fold(f64::INFINITY, f64::min)
}

/// The smallest circle's worth around an object: a middle, and how far it reaches from there, metres.
fn around(object: &Object) -> ([f64; 2], f64) {
    if let Some(body) = object.body() {
        return body.shape().around();
    }
    let centre = object.centre_metres();
    let far = |r: &Reflector| (r.x_metres - centre[0]).hypot(r.y_metres - centre[1]);
    (centre, object.reflectors().iter().map(far).fold(0.0, f64::max))
}

impl Seen {
    /// Every object of a scene, with what may hide it from `radar`.
    pub fn all(radar: &Radar, scene: &Scene) -> Vec<Seen> {
        let bodies = Bodies::of(radar, scene);
        let is_mirrored = scene.disturbances.mirror.is_some();
        let seen = |(index, object): (usize, &Object)| {
            if bodies.bodies.is_empty() {
                return Seen::from(object.clone());
            }
            let (centre, radius) = around(object);
            let all = is_mirrored && object.body().is_some();
            Seen { object: object.clone(), hidden_by: bodies.hiding(index, centre, radius, all) }
        };
        scene.objects.iter().enumerate().map(seen).collect()
    }

    /// Most echoes that it gives one element.
    pub fn echo_count(&self) -> usize {
        self.object.echo_count()
    }

    /// Whether its echoes are those of its reflectors, and nothing hides them.
    fn is_points(&self) -> bool {
        self.object.body().is_none() && self.hidden_by.is_empty()
    }
}

/// All that echoes: reflectors that nothing hides, and everything else.
#[derive(Debug, Clone, Default)]
pub struct Echoing {
    /// Reflectors that nothing hides.
    pub points: Vec<Reflector>,
    /// Bodies, and points that are partly hidden.
    pub scatterers: Vec<Scatterer>,
}

impl Echoing {
    /// All that echoes in `scene`, with what a mirror makes of it.
    pub fn of(radar: &Radar, scene: &Scene) -> Self {
        if !scene.has_bodies() {
            return Echoing { points: scene.echoing(radar), scatterers: Vec::new() };
        }
        let mut all = Echoing::seen(radar, &Seen::all(radar, scene));
        if let Some(mirror) = scene.disturbances.mirror {
            all.scatterers = all.scatterers.into_iter().map(|s| s.in_mirror(mirror)).collect();
            // Ghosts of points come after all reflectors.
            all.points.extend(scene.echoing(radar).drain(scene.reflector_count()..));
        }
        all
    }

    /// The echoes of these objects, without a mirror.
    pub fn seen(radar: &Radar, seen: &[Seen]) -> Self {
        let mut all = Echoing::default();
        for one in seen {
            if one.is_points() {
                all.points.extend(one.object.reflectors());
            } else {
                all.scatterers.push(Scatterer::new(radar, &one.object, &one.hidden_by));
            }
        }
        all
    }

    /// Most echoes that they give one element.
    pub fn len(&self) -> usize {
        Sources::from(self).len()
    }

    /// Whether nothing echoes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The echoes of every body as the middle of the array hears them, each with the index of its object.
pub fn heard_in_the_middle(radar: &Radar, scene: &Scene) -> Vec<(usize, PathEcho)> {
    let antennas = Antennas::at([0.0, 0.0]);
    let mut all = Vec::new();
    for (index, seen) in Seen::all(radar, scene).iter().enumerate().filter(|(_, s)| s.object.body().is_some()) {
        let mut echoes = Vec::new();
        Scatterer::new(radar, &seen.object, &seen.hidden_by).echoes(&antennas, &mut echoes);
        all.extend(echoes.into_iter().filter(PathEcho::is_heard).map(|echo| (index, echo)));
    }
    all
}

/// What echoes, as whatever evaluates samples takes it.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// Reflectors that nothing hides.
    pub points: &'a [Reflector],
    /// Everything else.
    pub scatterers: &'a [Scatterer],
}

impl<'a> From<&'a Echoing> for Sources<'a> {
    fn from(all: &'a Echoing) -> Self {
        Sources { points: &all.points, scatterers: &all.scatterers }
    }
}

impl<'a> From<&'a [Reflector]> for Sources<'a> {
    fn from(points: &'a [Reflector]) -> Self {
        Sources { points, scatterers: &[] }
    }
}

impl<'a> From<&'a Vec<Reflector>> for Sources<'a> {
    fn from(points: &'a Vec<Reflector>) -> Self {
        Sources { points, scatterers: &[] }
    }
}

impl<'a, const N: usize> From<&'a [Reflector; N]> for Sources<'a> {
    fn from(points: &'a [Reflector; N]) -> Self {
        Sources { points, scatterers: &[] }
    }
}

impl Sources<'_> {
    /// Most echoes that they give one element.
    pub fn len(&self) -> usize {
        self.points.len() + self.scatterers.iter().map(Scatterer::echo_count).sum::<usize>()
    }

    /// Whether nothing echoes.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.scatterers.is_empty()
    }

    /// Replaces `out` by the echoes of all scatterers at `pair`, those it doesn't hear included: their order is the same everywhere.
    pub fn scattered(&self, pair: Pair, out: &mut Vec<PathEcho>) {
        out.clear();
        let antennas = Antennas::from(pair);
        self.scatterers.iter().for_each(|s| s.echoes(&antennas, out));
    }
}
