//! Echoes of bodies: for every pair of antennas a few, each with a range and a complex amplitude.
//!
//! | file | echo or effect |
//! |---|---|
//! | [`face`] | a straight face: its glint, where the angles in and out agree, and the diffraction of its two ends |
//! | [`post`] | a circle: the echo of its specular point |
//! | [`polygon`] | a closed outline: the sum of its lit faces |
//! | [`corner`] | an inner corner: the double reflection |
//! | [`roughness`] | loss of coherent echoes at a rough surface, and diffuse scattering |
//! | [`shadow`] | diffraction past an obstacle between antenna and scatterer |
//! | `sight` | bodies that may affect an object |
//! | `strips` | fast search of bodies near the ways to an object |
//! | [`transition`] | Fresnel's transition from light to shadow, for faces and shadows |
//! | [`parts`] | a polygon as convex parts, for shadows |
//!
//! [`Scatterer`] is one object, prepared for simulation; [`EchoSources`] is a whole scene. An echo of range `R` and amplitude `A` adds
//! `A exp(-j kappa_n R)` to sample `n`, where `kappa_n` is the phase of the whole way there and back for each metre of range ([`Wave`]).
//!
//! The formulas are physical optics in the plane: Balanis, *Advanced Engineering Electromagnetics*, chapter 7; Keller, J. Opt. Soc. Am. 52
//! (1962); Kouyoumjian and Pathak, Proc. IEEE 62 (1974). In the far field a perfect post of radius 1 m is a point of reflectivity 1, and a
//! perfect face at `R` metres a point of reflectivity `sqrt(R)`. A face's glint falls as `1/R^1.5`, as for a strip lower than the Fresnel
//! zone (`sqrt(lambda R / 2)`, 14 cm at 77 GHz and 10 m); a high wall's falls as `1/R`. Left out: height and ground, reflections between
//! bodies, creeping waves, and polarisation except the sign of a double bounce and the post's second term.

pub mod corner;
mod echo_sources;
pub mod face;
mod geometry;
pub mod parts;
pub mod polygon;
pub mod post;
pub mod roughness;
mod scatterer;
pub mod shadow;
mod sight;
mod strips;
pub mod transition;

pub use echo_sources::{EchoSources, ObjectWithOccluders, Sources, array_centre_echoes};
pub use scatterer::Scatterer;

use crate::radar::{Pair, Pattern, Radar};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// The length that makes a line density of reflectivity of a face's reflection coefficient, metres.
pub const REFERENCE_LENGTH_METRES: f64 = 1.0;

/// Places of transmitter and receiver, (x, y) in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AntennaPlaces {
    pub transmitter_metres: [f64; 2],
    pub receiver_metres: [f64; 2],
}

impl From<Pair> for AntennaPlaces {
    fn from(pair: Pair) -> Self {
        let [transmitter_metres, receiver_metres] = pair.places_metres();
        AntennaPlaces { transmitter_metres, receiver_metres }
    }
}

impl AntennaPlaces {
    pub fn at(place_metres: [f64; 2]) -> Self {
        AntennaPlaces { transmitter_metres: place_metres, receiver_metres: place_metres }
    }
}

/// The wave in the middle of the chirp, where amplitudes are evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    pub power_watts: f64,
    /// Phase of the whole way for each metre of range: twice the physical wave number.
    pub radians_per_metre: f64,
    /// Whether phases grow with the range: then every amplitude is the conjugate.
    pub is_conjugate: bool,
    /// Pattern of the elements; `None` where they are isotropic.
    pub pattern: Option<Pattern>,
}

impl Wave {
    pub fn of(radar: &Radar) -> Self {
        let turns = radar.middle_turns_per_metre();
        let (power_watts, pattern) = (radar.transmit_power_watts, radar.pattern());
        Wave { power_watts, radians_per_metre: TAU * turns.abs(), is_conjugate: turns > 0.0, pattern }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EchoKind {
    Point,
    /// The mirror reflection of a face.
    Glint,
    /// The end of a face, or a corner between two.
    Edge,
    /// The nearest part of a post.
    Post,
    /// Reflected by both arms of an inner corner.
    DoubleBounce,
    /// A place of a rough surface.
    Diffuse,
}

impl EchoKind {
    pub fn name(self) -> &'static str {
        match self {
            EchoKind::Point => "point",
            EchoKind::Glint => "glint",
            EchoKind::Edge => "edge",
            EchoKind::Post => "post",
            EchoKind::DoubleBounce => "double bounce",
            EchoKind::Diffuse => "rough surface",
        }
    }
}

/// One echo at one pair of antennas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathEcho {
    /// Half the way there and back, metres.
    pub range_metres: f64,
    /// Amplitude in the middle of the chirp; 0 where there is no such echo.
    pub amplitude: Complex64,
    /// Place of the reflection, (x, y) in metres.
    pub place_metres: [f64; 2],
    /// Cosine of the angle of incidence there.
    pub cos_incidence: f64,
    pub kind: EchoKind,
    /// Part that is reflected as by a mirror, so that its way goes on straight behind the face: 1 for a glint whose first Fresnel zone lies on
    /// the face, less the nearer it is to an end of the face, where its shadow is that of the edge; 0 for all other echoes.
    pub mirror_part: f64,
}

impl PathEcho {
    pub(crate) fn silent(place_metres: [f64; 2], kind: EchoKind) -> Self {
        let amplitude = Complex64::default();
        PathEcho { range_metres: 0.0, amplitude, place_metres, cos_incidence: 1.0, kind, mirror_part: 0.0 }
    }

    /// Whether there is such an echo.
    pub fn is_heard(&self) -> bool {
        self.amplitude != Complex64::default()
    }

    pub(crate) fn times(self, factor: Complex64) -> Self {
        PathEcho { amplitude: self.amplitude * factor, ..self }
    }
}

#[cfg(test)]
mod tests;
