//! A closed outline: the sum of its lit faces. Where two of them meet, their diffractions have one range and are one echo.

use super::corner;
use super::face::Face;
use super::geometry::{V, crosses};
use super::{AntennaPlaces, EchoKind, PathEcho, Wave};
use crate::scene::shape::inner_corners;
use num_complex::Complex64;

/// An echo nearer than this to an arm lies on it, metres.
const ON_METRES: f64 = 1e-6;

/// An outline, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    faces: Vec<Face>,
    /// Corners that point inwards.
    inner: Vec<usize>,
}

impl Outline {
    /// The outline with these corners, counter-clockwise with y up, (x, y) in metres.
    pub fn new(corners_metres: &[[f64; 2]], reflectivity: f64) -> Self {
        let next = corners_metres.iter().cycle().skip(1);
        Outline {
            faces: corners_metres.iter().zip(next).map(|(a, b)| Face::new([*a, *b], false, reflectivity)).collect(),
            inner: inner_corners(corners_metres),
        }
    }

    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Echoes that [`Outline::echoes`] adds.
    pub fn echo_count(&self) -> usize {
        2 * self.faces.len() + 6 * self.inner.len()
    }

    /// Adds a glint for each face, an edge for each corner, and six double reflections for each inner corner.
    pub fn echoes(&self, wave: &Wave, antennas: &AntennaPlaces, out: &mut Vec<PathEcho>) {
        let count = self.faces.len();
        let begin = out.len();
        out.resize(begin + 2 * count, PathEcho::silent([0.0, 0.0], EchoKind::Edge));
        for (i, face) in self.faces.iter().enumerate() {
            let [glint, a, b] = face.echoes(wave, antennas);
            out[begin + i] = glint;
            for (corner, edge) in [(i, a), ((i + 1) % count, b)] {
                let rim = &mut out[begin + count + corner];
                let amplitude = rim.amplitude + edge.amplitude;
                if edge.is_heard() {
                    // The coherent part of a rough corner is that of the face that is met more squarely.
                    let cos_incidence =
                        if rim.is_heard() { rim.cos_incidence.max(edge.cos_incidence) } else { edge.cos_incidence };
                    *rim = PathEcho { amplitude, cos_incidence, ..edge };
                } else if !rim.is_heard() {
                    rim.place_metres = edge.place_metres;
                }
            }
        }
        for corner in &self.inner {
            // The two orders of a right inner corner are its whole echo: its apex has none of its own.
            out[begin + count + corner].amplitude = Complex64::default();
            let (first, second) = (&self.faces[(corner + count - 1) % count], &self.faces[*corner]);
            out.extend(corner::echoes(wave, antennas, first, second));
        }
        self.silence_hidden(antennas, &mut out[begin..]);
    }

    /// Silences those of `echoes` that a face hides from an antenna. None does where no corner points inwards.
    pub(super) fn silence_hidden(&self, antennas: &AntennaPlaces, echoes: &mut [PathEcho]) {
        let heard = echoes.iter_mut().filter(|e| !self.inner.is_empty() && e.is_heard());
        for echo in heard.filter(|e| self.hides(e.place_metres.into(), antennas)) {
            echo.amplitude = Complex64::default();
        }
    }

    fn hides(&self, place: V, antennas: &AntennaPlaces) -> bool {
        let [t, r] = [antennas.transmitter_metres, antennas.receiver_metres].map(V::from);
        self.faces.iter().any(|face| {
            let (a, b) = (face.from, face.place(face.length_metres));
            let along = (place - a).dot(face.along).clamp(0.0, face.length_metres);
            let is_apart = (place - face.place(along)).norm() > ON_METRES;
            is_apart && (crosses(t, place, a, b) || crosses(r, place, a, b))
        })
    }
}
