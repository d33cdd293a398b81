//! Elements as they are built: each with a gain, a phase and a place of its own, and some that are dead.

use super::{Decibels, Radar};
use num_complex::Complex64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

/// What one element does otherwise than it should.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ElementError {
    /// What it amplifies by.
    pub gain: Decibels,
    /// What it turns the phase by, degrees.
    pub phase_degrees: f64,
    /// How far it stands from its place, towards +x, millimetres.
    pub position_millimetres: f64,
    /// Whether it hears nothing at all.
    pub dead: bool,
}

impl Default for ElementError {
    /// An element that is as it should be.
    fn default() -> Self {
        ElementError { gain: Decibels(0.0), phase_degrees: 0.0, position_millimetres: 0.0, dead: false }
    }
}

impl ElementError {
    /// What its samples are multiplied with: gain and phase, 0 for a dead element.
    pub fn response(&self) -> Complex64 {
        if self.dead {
            return Complex64::default();
        }
        Complex64::from_polar(10f64.powf(self.gain.amplitude_decades()), self.phase_degrees.to_radians())
    }
}

/// How far elements are off, as standard deviations of normal distributions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerances {
    /// Of the gain.
    pub gain: Decibels,
    /// Of the phase, degrees.
    pub phase_degrees: f64,
    /// Of the position along the array, millimetres.
    pub position_millimetres: f64,
}

impl Tolerances {
    /// All of them `factor` times as large.
    pub fn times(&self, factor: f64) -> Self {
        Tolerances {
            gain: Decibels(factor * self.gain.0),
            phase_degrees: factor * self.phase_degrees,
            position_millimetres: factor * self.position_millimetres,
        }
    }

    /// An array built with these tolerances; the same seed builds the same, and one of twice the tolerances is twice as far off.
    pub fn build(&self, radar: &Radar, seed: u64) -> BuiltArray {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut off = || -> f64 { StandardNormal.sample(&mut rng) };
        let element = |_| ElementError {
            gain: Decibels(off() * self.gain.0),
            phase_degrees: off() * self.phase_degrees,
            position_millimetres: off() * self.position_millimetres,
            dead: false,
        };
        BuiltArray { elements: (0..radar.elements).map(element).collect() }
    }
}

/// The elements of a built array; an empty list is an array that is as it should be.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct BuiltArray {
    /// One an element of the radar, in the radar's order.
    pub elements: Vec<ElementError>,
}

/// What no element can do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BuiltArrayError {
    /// Another number of elements.
    #[error("{found} elements are described; the radar has {expected}")]
    Count {
        /// Elements described.
        found: usize,
        /// Elements of the radar.
        expected: usize,
    },
    /// Not a usable number.
    #[error("element {element}: {field} is {value}; expected a number from -{most} to {most}")]
    Value {
        /// Which element.
        element: usize,
        /// Name of the quantity.
        field: &'static str,
        /// The number found.
        value: f64,
        /// Largest magnitude that is taken.
        most: f64,
    },
}

/// Largest gain error, decibels.
const MOST_GAIN: f64 = 200.0;
/// Largest phase error, degrees.
const MOST_PHASE: f64 = 3600.0;
/// Largest position error, millimetres.
const MOST_POSITION: f64 = 1000.0;

impl BuiltArray {
    /// The error of element `n`.
    pub fn element(&self, n: usize) -> ElementError {
        self.elements.get(n).copied().unwrap_or_default()
    }

    /// Where element `n` of `radar` really stands, metres.
    pub fn element_x_metres(&self, radar: &Radar, n: usize) -> f64 {
        radar.element_x_metres(n) + self.element(n).position_millimetres * 1e-3
    }

    /// Checks that the list fits `radar` and holds usable numbers.
    ///
    /// # Errors
    /// [`BuiltArrayError`] names the element and the quantity.
    pub fn validate(&self, radar: &Radar) -> Result<(), BuiltArrayError> {
        let (found, expected) = (self.elements.len(), radar.elements);
        if found != 0 && found != expected {
            return Err(BuiltArrayError::Count { found, expected });
        }
        for (element, e) in self.elements.iter().enumerate() {
            for (field, value, most) in [
                ("gain", e.gain.0, MOST_GAIN),
                ("phase_degrees", e.phase_degrees, MOST_PHASE),
                ("position_millimetres", e.position_millimetres, MOST_POSITION),
            ] {
                // Not finite is not within either.
                if value.is_nan() || value.abs() > most {
                    return Err(BuiltArrayError::Value { element, field, value, most });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_standard_deviations_and_scale() {
        let radar = Radar::default();
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 10.0, position_millimetres: 0.2 };
        let array = tolerances.build(&radar, 7);
        assert_eq!(array, tolerances.build(&radar, 7));
        assert_ne!(array, tolerances.build(&radar, 8));
        array.validate(&radar).unwrap();
        let spread = |of: fn(&ElementError) -> f64| {
            (array.elements.iter().map(|e| of(e).powi(2)).sum::<f64>() / radar.elements as f64).sqrt()
        };
        for (found, expected) in [
            (spread(|e| e.gain.0), 1.0),
            (spread(|e| e.phase_degrees), 10.0),
            (spread(|e| e.position_millimetres), 0.2),
        ] {
            assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
        }
        let twice = Tolerances { phase_degrees: 20.0, ..tolerances }.build(&radar, 7);
        assert_eq!(twice.elements[3].phase_degrees, 2.0 * array.elements[3].phase_degrees);
    }

    #[test]
    fn responses_and_places() {
        let radar = Radar::default();
        let off = ElementError { gain: Decibels(20.0), phase_degrees: 90.0, position_millimetres: 3.0, dead: false };
        assert!((off.response() - Complex64::new(0.0, 10.0)).norm() < 1e-12);
        assert_eq!(ElementError { dead: true, ..off }.response(), Complex64::default());
        assert_eq!(BuiltArray::default().element(5).response(), Complex64::from(1.0));
        let array = BuiltArray { elements: vec![off; 1024] };
        assert!((array.element_x_metres(&radar, 4) - radar.element_x_metres(4) - 3e-3).abs() < 1e-15);
    }

    #[test]
    fn unusable_lists_are_named() {
        let radar = Radar::default();
        let mut array = BuiltArray { elements: vec![ElementError::default(); 5] };
        assert!(
            array.validate(&radar).unwrap_err().to_string().contains("5 elements are described; the radar has 1024")
        );
        array.elements.resize(1024, ElementError::default());
        array.elements[9].phase_degrees = f64::NAN;
        assert!(array.validate(&radar).unwrap_err().to_string().contains("element 9: phase_degrees is NaN"));
    }
}
