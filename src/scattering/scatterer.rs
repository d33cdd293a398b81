//! The echoes of one object at a pair of antennas.

use super::face::Face;
use super::parts::convex_parts;
use super::polygon::Outline;
use super::post::Circle;
use super::roughness::{RoughFace, coherent};
use super::shadow::{Obstacle, behind};
use super::{AntennaPlaces, EchoKind, PathEcho, Wave};
use crate::radar::Radar;
use crate::scene::body::{DIFFUSE_SPACING_METRES, MAX_DIFFUSE, diffuse_points};
use crate::scene::{Body, Mirror, Object, Reflector, Shape};
use num_complex::Complex64;

/// An object and its obstacles. Every pair of antennas gets the same echoes in the same order, those hidden from it with amplitude 0.
#[derive(Debug, Clone)]
pub struct Scatterer {
    wave: Wave,
    source: Source,
    deviation_metres: f64,
    rough: Vec<RoughFace>,
    obstacles: Vec<Obstacle>,
    mirror: Option<Mirror>,
    is_refined: bool,
}

#[derive(Debug, Clone)]
enum Source {
    Points(Vec<Reflector>),
    Wall(Face),
    Outline(Outline),
    Post(Circle),
}

impl Scatterer {
    /// `object` before `radar`, hidden by the bodies among `hidden_by`.
    pub fn new<'a>(radar: &Radar, object: &Object, hidden_by: impl IntoIterator<Item = &'a Object>) -> Self {
        let obstacles = hidden_by.into_iter().filter_map(Object::body).flat_map(obstacles).collect();
        let wave = Wave::of(radar);
        let Some(body) = object.body() else {
            let source = Source::Points(object.reflectors());
            let (rough, mirror) = (Vec::new(), None);
            return Scatterer { wave, source, deviation_metres: 0.0, rough, obstacles, mirror, is_refined: true };
        };
        let source = match body.shape {
            Shape::Wall(ends) => Source::Wall(Face::new(ends, true, body.reflectivity)),
            Shape::Outline(corners) => Source::Outline(Outline::new(&corners, body.reflectivity)),
            Shape::Circle { centre_metres, radius_metres } => {
                Source::Post(Circle::new(centre_metres, radius_metres, body.reflectivity))
            }
        };
        let deviation_metres = body.roughness_millimetres * 1e-3;
        let faces: &[Face] = match &source {
            Source::Wall(face) => std::slice::from_ref(face),
            Source::Outline(outline) => outline.faces(),
            Source::Post(_) | Source::Points(_) => &[],
        };
        let faces = if deviation_metres > 0.0 { faces } else { &[] };
        let length: f64 = faces.iter().map(|f| f.length_metres).sum();
        let spacing = (length / MAX_DIFFUSE as f64).max(DIFFUSE_SPACING_METRES);
        let rough = faces.iter().zip(0..).map(|(face, number)| {
            RoughFace::new(*face, deviation_metres, diffuse_points(face.length_metres, spacing), body.seed, number)
        });
        let rough = rough.collect();
        Scatterer { wave, source, deviation_metres, rough, obstacles, mirror: None, is_refined: true }
    }

    /// The scatterer of the same body seen also in a plane mirror. Points have ghosts of their own.
    pub fn in_mirror(self, mirror: Mirror) -> Self {
        let is_body = !matches!(self.source, Source::Points(_));
        Scatterer { mirror: is_body.then_some(mirror), ..self }
    }

    /// The scatterer without the second term of a post's series.
    #[cfg(test)]
    pub(super) fn unrefined(self) -> Self {
        Scatterer { is_refined: false, ..self }
    }

    /// Echoes that every pair of antennas gets.
    pub fn echo_count(&self) -> usize {
        let own = match &self.source {
            Source::Points(points) => points.len(),
            Source::Wall(_) => 3,
            Source::Outline(outline) => outline.echo_count(),
            Source::Post(_) => 1,
        };
        let own = own + self.rough.iter().map(RoughFace::echo_count).sum::<usize>();
        if self.mirror.is_some() { 3 * own } else { own }
    }

    /// Adds its echoes at a pair of antennas.
    pub fn echoes(&self, antennas: &AntennaPlaces, out: &mut Vec<PathEcho>) {
        let begin = out.len();
        self.direct(antennas, out);
        self.through_pattern(antennas, |place| [place, place], &mut out[begin..]);
        if let Some(mirror) = &self.mirror {
            self.ghosts(mirror, antennas, out);
        }
        if self.wave.is_conjugate {
            for echo in &mut out[begin..] {
                echo.amplitude = echo.amplitude.conj();
            }
        }
    }

    /// Echoes without a mirror.
    fn direct(&self, antennas: &AntennaPlaces, out: &mut Vec<PathEcho>) {
        let begin = out.len();
        let wave = &self.wave;
        match &self.source {
            Source::Points(points) => out.extend(points.iter().map(|p| point(wave, antennas, p))),
            Source::Wall(face) => out.extend(face.echoes(wave, antennas)),
            Source::Outline(outline) => outline.echoes(wave, antennas, out),
            Source::Post(circle) => out.push(circle.echo(wave, antennas, self.is_refined)),
        }
        if self.deviation_metres > 0.0 {
            for echo in &mut out[begin..] {
                let left = coherent(wave, self.deviation_metres, echo.cos_incidence);
                *echo = echo.times(left.into());
            }
        }
        let smooth = out.len();
        for face in &self.rough {
            face.echoes(wave, antennas, out);
        }
        if let Source::Outline(outline) = &self.source {
            outline.silence_hidden(antennas, &mut out[smooth..]);
        }
        for echo in out[begin..].iter_mut().filter(|e| e.is_heard()) {
            *echo = behind(&self.obstacles, wave, antennas, *echo);
        }
    }

    /// Applies the element pattern; `towards` is the place to which a wave leaves and from which it returns.
    fn through_pattern(
        &self,
        antennas: &AntennaPlaces,
        towards: impl Fn([f64; 2]) -> [[f64; 2]; 2],
        echoes: &mut [PathEcho],
    ) {
        let Some(pattern) = self.wave.pattern else { return };
        for echo in echoes.iter_mut().filter(|e| e.is_heard()) {
            let [there, back] = towards(echo.place_metres);
            let left = pattern.amplitude_between(antennas.transmitter_metres, there)
                * pattern.amplitude_between(antennas.receiver_metres, back);
            *echo = echo.times(left.into());
        }
    }

    /// Ghosts of the body: both ways by the mirror, and one way each. The two orders of the latter are one echo of twice the amplitude.
    fn ghosts(&self, mirror: &Mirror, antennas: &AntennaPlaces, out: &mut Vec<PathEcho>) {
        let count = self.echo_count() / 3;
        let image = |[x, y]: [f64; 2]| mirror.image_metres(x, y);
        let there = AntennaPlaces { transmitter_metres: image(antennas.transmitter_metres), ..*antennas };
        let both = AntennaPlaces { receiver_metres: image(antennas.receiver_metres), ..there };
        let begin = out.len();
        for (seen, factor, back_by_mirror) in
            [(both, mirror.reflection.powi(2), true), (there, 2.0 * mirror.reflection, false)]
        {
            let start = out.len();
            self.direct(&seen, out);
            out[start..].iter_mut().for_each(|echo| *echo = echo.times(factor.into()));
            let towards = |place: [f64; 2]| [image(place), if back_by_mirror { image(place) } else { place }];
            self.through_pattern(antennas, towards, &mut out[start..]);
        }
        for echo in &mut out[begin..begin + 2 * count] {
            let [x, y] = echo.place_metres;
            if !mirror.is_before(x, y) {
                echo.amplitude = Complex64::default();
            }
        }
    }
}

fn point(wave: &Wave, antennas: &AntennaPlaces, point: &Reflector) -> PathEcho {
    let place = [point.x_metres, point.y_metres];
    let leg = |antenna: [f64; 2]| (antenna[0] - place[0]).hypot(antenna[1] - place[1]);
    let (there, back) = (leg(antennas.transmitter_metres), leg(antennas.receiver_metres));
    PathEcho {
        range_metres: (there + back) / 2.0,
        amplitude: (wave.power_watts * point.reflectivity / (there * back)).into(),
        ..PathEcho::silent(place, EchoKind::Point)
    }
}

fn obstacles(body: Body) -> Vec<Obstacle> {
    match body.shape {
        Shape::Wall(ends) => vec![Obstacle::corners(&ends)],
        Shape::Circle { centre_metres, radius_metres } => vec![Obstacle::circle(centre_metres, radius_metres)],
        Shape::Outline(corners) => convex_parts(&corners).iter().map(|part| Obstacle::corners(part)).collect(),
    }
}
