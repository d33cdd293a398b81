//! Element errors: gain, phase and place of each element, and dead elements.

use super::{Decibels, Radar};
use num_complex::Complex64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_SQRT_2;

/// Deviation of one element from its nominal gain, phase and place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ElementError {
    /// Gain error.
    pub gain: Decibels,
    /// Phase error, degrees.
    pub phase_degrees: f64,
    /// Offset from its nominal place along +x, millimetres.
    pub position_millimetres: f64,
    /// Offset from the array's line towards the scene, millimetres.
    pub forward_millimetres: f64,
    /// Whether the element is dead: it receives nothing.
    pub dead: bool,
}

impl ElementError {
    /// Factor of the element's samples: gain and phase, 0 for a dead element.
    pub fn response(&self) -> Complex64 {
        if self.dead {
            return Complex64::default();
        }
        Complex64::from_polar(10f64.powf(self.gain.amplitude_decades()), self.phase_degrees.to_radians())
    }
}

/// Standard deviations of normally distributed element errors.
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
    /// All tolerances `factor` times as large.
    pub fn times(&self, factor: f64) -> Self {
        Tolerances {
            gain: Decibels(factor * self.gain.0),
            phase_degrees: factor * self.phase_degrees,
            position_millimetres: factor * self.position_millimetres,
        }
    }

    /// An array built with these tolerances. The same seed builds the same array, and twice the tolerances give twice the errors. Of pairs, the
    /// antennas have the errors: two pairs share the error of their common antenna, and each pair has the standard deviations that are asked for.
    pub fn build(&self, radar: &Radar, seed: u64) -> BuiltArray {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut drawn = |count: usize| -> Vec<[f64; 3]> {
            (0..count).map(|_| [(); 3].map(|()| StandardNormal.sample(&mut rng))).collect()
        };
        let element = |[gain, phase, position]: [f64; 3]| ElementError {
            gain: Decibels(gain * self.gain.0),
            phase_degrees: phase * self.phase_degrees,
            position_millimetres: position * self.position_millimetres,
            ..ElementError::default()
        };
        let Some(antennas) = &radar.antennas else {
            return BuiltArray { elements: drawn(radar.elements).into_iter().map(element).collect() };
        };
        let (transmitters, receivers) =
            (drawn(antennas.transmitter_x_metres().len()), drawn(antennas.receiver_x_metres().len()));
        let of_pair = |pair: &Option<[usize; 2]>| {
            let both = pair.map(|[t, r]| std::array::from_fn(|i| transmitters[t][i] + receivers[r][i]));
            both.map_or_else(ElementError::default, |sum: [f64; 3]| element(sum.map(|v| v * FRAC_1_SQRT_2)))
        };
        BuiltArray { elements: antennas.pairs().iter().map(of_pair).collect() }
    }
}

/// Errors of every element of an array; an empty list is an ideal array. In files: `count`, `gain_db`, `phase_degrees`,
/// `position_millimetres`, `forward_millimetres` (one number an element each, or none at all) and `dead`, the elements that receive nothing.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Lists", into = "Lists")]
pub struct BuiltArray {
    /// The errors of each element of the radar, in the radar's order.
    pub elements: Vec<ElementError>,
}

#[derive(Clone, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Lists {
    count: usize,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    gain_db: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    phase_degrees: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    position_millimetres: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    forward_millimetres: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    dead: Vec<usize>,
}

impl From<BuiltArray> for Lists {
    fn from(BuiltArray { elements }: BuiltArray) -> Self {
        let list = |of: fn(&ElementError) -> f64| -> Vec<f64> {
            let differs = elements.iter().any(|e| of(e) != 0.0);
            if differs { elements.iter().map(of).collect() } else { Vec::new() }
        };
        Lists {
            count: elements.len(),
            gain_db: list(|e| e.gain.0),
            phase_degrees: list(|e| e.phase_degrees),
            position_millimetres: list(|e| e.position_millimetres),
            forward_millimetres: list(|e| e.forward_millimetres),
            dead: (0..elements.len()).filter(|n| elements[*n].dead).collect(),
        }
    }
}

impl TryFrom<Lists> for BuiltArray {
    type Error = String;

    fn try_from(lists: Lists) -> Result<Self, String> {
        let Lists { count, gain_db, phase_degrees, position_millimetres, forward_millimetres, dead } = lists;
        // A text may leave the count out: the lists have it.
        let longest = [&gain_db, &phase_degrees, &position_millimetres, &forward_millimetres].map(Vec::len);
        let count = if count == 0 { longest.into_iter().max().unwrap_or(0) } else { count };
        if count > MAX_ELEMENTS {
            return Err(format!("elements: count is {count}; at most {MAX_ELEMENTS} are read"));
        }
        for (name, list) in [
            ("gain_db", &gain_db),
            ("phase_degrees", &phase_degrees),
            ("position_millimetres", &position_millimetres),
            ("forward_millimetres", &forward_millimetres),
        ] {
            if !list.is_empty() && list.len() != count {
                return Err(format!(
                    "elements: {name} has {} numbers; expected none or {count}, the number of elements",
                    list.len()
                ));
            }
        }
        if let Some(n) = dead.iter().find(|n| **n >= count) {
            return Err(format!(
                "elements: element {n} is dead, of {count} (the key count says so); they are counted from 0"
            ));
        }
        let of = |list: &[f64], n: usize| list.get(n).copied().unwrap_or(0.0);
        let mut elements: Vec<ElementError> = (0..count)
            .map(|n| ElementError {
                gain: Decibels(of(&gain_db, n)),
                phase_degrees: of(&phase_degrees, n),
                position_millimetres: of(&position_millimetres, n),
                forward_millimetres: of(&forward_millimetres, n),
                dead: false,
            })
            .collect();
        dead.iter().for_each(|n| elements[*n].dead = true);
        Ok(BuiltArray { elements })
    }
}

const MAX_ELEMENTS: usize = 65536;

const MAX_GAIN_DB: f64 = 200.0;
const MAX_PHASE_DEGREES: f64 = 3600.0;
const MAX_POSITION_MILLIMETRES: f64 = 1000.0;

impl BuiltArray {
    /// Whether no element has an error.
    pub fn is_ideal(&self) -> bool {
        self.elements.iter().all(|e| *e == ElementError::default())
    }

    /// The errors for an array of `count` elements, the additional ones ideal.
    pub fn fitted(&self, count: usize) -> Self {
        let mut elements = self.elements.clone();
        if !elements.is_empty() {
            elements.resize(count, ElementError::default());
        }
        BuiltArray { elements }
    }

    /// Elements that receive nothing.
    pub fn dead(&self) -> usize {
        self.elements.iter().filter(|e| e.dead).count()
    }

    /// Root mean square errors of the elements that are not dead, gain and phase relative to their means.
    pub fn spread(&self) -> Tolerances {
        let living: Vec<&ElementError> = self.elements.iter().filter(|e| !e.dead).collect();
        let count = living.len().max(1) as f64;
        let gain_mean = living.iter().map(|e| e.gain.0).sum::<f64>() / count;
        let turned: Complex64 = living.iter().map(|e| Complex64::cis(e.phase_degrees.to_radians())).sum();
        let phase =
            |e: &ElementError| (Complex64::cis(e.phase_degrees.to_radians()) * turned.conj()).arg().to_degrees();
        let rms =
            |of: &dyn Fn(&ElementError) -> f64| (living.iter().map(|e| of(e).powi(2)).sum::<f64>() / count).sqrt();
        Tolerances {
            gain: Decibels(rms(&|e| e.gain.0 - gain_mean)),
            phase_degrees: rms(&phase),
            position_millimetres: rms(&|e| e.position_millimetres),
        }
    }

    /// Residual errors after correction by the gains and phases of `estimate`; elements that it takes for dead are not corrected.
    pub fn corrected(&self, estimate: &BuiltArray) -> Self {
        let count = self.elements.len().max(estimate.elements.len());
        let element = |n: usize| {
            let (own, found) = (self.element(n), estimate.element(n));
            if found.dead {
                return own;
            }
            let turned = (own.phase_degrees - found.phase_degrees + 180.0).rem_euclid(360.0) - 180.0;
            ElementError { gain: Decibels(own.gain.0 - found.gain.0), phase_degrees: turned, ..own }
        };
        BuiltArray { elements: (0..count).map(element).collect() }
    }

    /// The error of element `n`.
    pub fn element(&self, n: usize) -> ElementError {
        self.elements.get(n).copied().unwrap_or_default()
    }

    /// Whether element `n` is displaced.
    pub fn is_displaced(&self, n: usize) -> bool {
        let ElementError { position_millimetres, forward_millimetres, .. } = self.element(n);
        position_millimetres != 0.0 || forward_millimetres != 0.0
    }

    /// Offset of element `n` from the array's line towards the scene, metres.
    pub fn forward_metres(&self, n: usize) -> f64 {
        self.element(n).forward_millimetres * 1e-3
    }

    /// The largest distance of a living element from the array's line, millimetres.
    pub fn most_forward_millimetres(&self) -> f64 {
        self.elements.iter().filter(|e| !e.dead).map(|e| e.forward_millimetres.abs()).fold(0.0, f64::max)
    }

    /// The same array bent to a parabola, as on a bumper: the ends stand back by `back_millimetres`, the middle keeps its place.
    pub fn bent(&self, radar: &Radar, back_millimetres: f64) -> Self {
        let half = radar.aperture_metres() / 2.0;
        let mut elements = self.fitted(radar.elements).elements;
        elements.resize(radar.elements, ElementError::default());
        for (n, element) in elements.iter_mut().enumerate() {
            let part = radar.element_x_metres(n) / half;
            element.forward_millimetres = -back_millimetres * part * part;
        }
        BuiltArray { elements }
    }

    /// Checks that the list fits `radar` and holds usable numbers.
    /// # Errors
    /// The message names the element and the quantity.
    pub fn validate(&self, radar: &Radar) -> Result<(), String> {
        let (found, expected) = (self.elements.len(), radar.elements);
        if found != 0 && found != expected {
            return Err(format!("{found} elements are described; the radar has {expected}"));
        }
        for (element, e) in self.elements.iter().enumerate() {
            for (field, value, most) in [
                ("gain_db", e.gain.0, MAX_GAIN_DB),
                ("phase_degrees", e.phase_degrees, MAX_PHASE_DEGREES),
                ("position_millimetres", e.position_millimetres, MAX_POSITION_MILLIMETRES),
                ("forward_millimetres", e.forward_millimetres, MAX_POSITION_MILLIMETRES),
            ] {
                if value.is_nan() || value.abs() > most {
                    return Err(format!(
                        "element {element}: {field} is {value}; expected a number from -{most} to {most}"
                    ));
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
    fn tolerances_are_standard_deviations() {
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
    fn pairs_share_the_errors_of_their_antennas() {
        let radar = Radar::default().of_pairs(3, 4).unwrap();
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 10.0, position_millimetres: 0.1 };
        let array = tolerances.build(&radar, 7);
        array.validate(&radar).unwrap();
        let of = |transmitter: usize, receiver: usize| {
            let pairs = radar.antennas.as_ref().unwrap().pairs();
            let element = pairs.iter().position(|pair| *pair == Some([transmitter, receiver])).unwrap();
            array.elements[element].phase_degrees
        };
        for (t, r) in [(1, 1), (2, 3)] {
            let gap = (of(t, r) - of(t, 0)) - (of(0, r) - of(0, 0));
            assert!(gap.abs() < 1e-9, "receiver {r} is off alike beside transmitter {t}: {gap}");
        }
        let squares = |seed| tolerances.build(&radar, seed).elements.iter().map(|e| e.gain.0.powi(2)).sum::<f64>();
        let mean = (0..400).map(squares).sum::<f64>() / (400.0 * 12.0);
        assert!((mean - 1.0).abs() < 0.12, "the variance of a pair: {mean}");
    }

    #[test]
    fn the_ends_of_a_bent_array_stand_back() {
        let radar = Radar::default();
        let bent = BuiltArray::default().bent(&radar, 8.0);
        bent.validate(&radar).unwrap();
        for end in [0, 1023] {
            assert!((bent.element(end).forward_millimetres + 8.0).abs() < 1e-9, "{:?}", bent.element(end));
        }
        assert!(bent.element(512).forward_millimetres.abs() < 1e-4 && bent.is_displaced(0));
        assert!((bent.most_forward_millimetres() - 8.0).abs() < 1e-9);
        let text = toml::to_string(&bent).unwrap();
        assert_eq!(toml::from_str::<BuiltArray>(&text).unwrap(), bent);
    }

    #[test]
    fn what_was_estimated_is_taken_off() {
        let radar = Radar { elements: 16, ..Radar::default() };
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 100.0, position_millimetres: 0.0 };
        let mut array = tolerances.build(&radar, 3);
        array.elements[4].dead = true;
        let left = array.corrected(&array);
        assert!(left.elements[4].dead && left.spread().gain.0 < 1e-12 && left.spread().phase_degrees < 1e-9);
        assert!(!left.is_ideal() && left.dead() == 1, "a dead element stays dead");
        let text = toml::to_string(&array).unwrap();
        assert!(!text.contains("position") && text.contains("dead = [4]"), "{text}");
        assert_eq!(toml::from_str::<BuiltArray>(&text).unwrap(), array);
        for (text, told) in [
            ("count = 3\ngain_db = [1.0]", "gain_db has 1 numbers; expected none or 3"),
            ("count = 3\ndead = [3]", "element 3 is dead, of 3"),
            ("count = 99999999", "at most 65536"),
        ] {
            let error = toml::from_str::<BuiltArray>(text).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
        let uncounted: BuiltArray = toml::from_str("forward_millimetres = [0.5, -0.5]\ndead = [1]").unwrap();
        assert_eq!((uncounted.elements.len(), uncounted.dead()), (2, 1));
        assert_eq!(array.fitted(20).elements.len(), 20);
        assert!(BuiltArray::default().fitted(20).elements.is_empty() && BuiltArray::default().is_ideal());
    }

    #[test]
    fn unusable_lists_are_named() {
        let radar = Radar::default();
        let mut array = BuiltArray { elements: vec![ElementError::default(); 5] };
        let told = |array: &BuiltArray| array.validate(&radar).unwrap_err();
        assert!(told(&array).contains("5 elements are described; the radar has 1024"));
        array.elements.resize(1024, ElementError::default());
        array.elements[9].phase_degrees = f64::NAN;
        assert!(told(&array).contains("element 9: phase_degrees is NaN"));
    }
}
