//! Arrays of training scenes: exact ones, or with errors of the elements.

use crate::radar::{BuiltArray, Decibels, ElementError, Radar, Tolerances};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The arrays of the training scenes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrays {
    /// Part of the scenes with errors of the elements, 0 to 1.
    pub share: f64,
    /// Largest tolerances. Each scene has a part of each, uniform from 0 to 1.
    pub tolerances: Tolerances,
}

/// Number of the random stream of arrays: not that of floors, which have the same seed.
const ARRAY_STREAM: u64 = 1;

impl Arrays {
    /// Exact arrays.
    pub const IDEAL: Arrays = Arrays {
        share: 0.0,
        tolerances: Tolerances { gain: Decibels(0.0), phase_degrees: 0.0, position_millimetres: 0.0 },
    };

    /// The array of the scene with this seed of noise. Without `is_whole`, only elements of the two ends have errors.
    pub fn of(&self, noise_seed: u64, radar: &Radar, is_whole: bool) -> BuiltArray {
        let mut rng = ChaCha8Rng::seed_from_u64(noise_seed);
        rng.set_stream(ARRAY_STREAM);
        if rng.random::<f64>() >= self.share {
            return BuiltArray::default();
        }
        let Tolerances { gain, phase_degrees, position_millimetres } = self.tolerances;
        let [gain_part, phase_part, position_part]: [f64; 3] = rng.random();
        let tolerances = Tolerances {
            gain: Decibels(gain_part * gain.0),
            phase_degrees: phase_part * phase_degrees,
            position_millimetres: position_part * position_millimetres,
        };
        let mut array = tolerances.build(radar, rng.random());
        if !is_whole {
            let middle_elements =
                array.elements.iter_mut().take(radar.elements - radar.end_elements).skip(radar.end_elements);
            middle_elements.for_each(|element| *element = ElementError::default());
        }
        array
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn element_errors_have_their_tolerances() {
        let radar = Radar::default();
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 20.0, position_millimetres: 0.1 };
        let arrays = Arrays { share: 0.3, tolerances };
        let drawn: Vec<BuiltArray> =
            (0..400).map(|seed| arrays.of(seed, &radar, false)).filter(|a| !a.is_ideal()).collect();
        assert!((90..150).contains(&drawn.len()), "{}", drawn.len());
        for array in &drawn {
            let off = |n: usize| array.element(n) != ElementError::default();
            assert!(off(0) && off(11) && off(1012) && off(1023) && !(12..1012).any(off));
        }
        let degrees = drawn.iter().map(|a| a.element(3).phase_degrees.abs()).fold(0.0, f64::max);
        assert!((20.0..80.0).contains(&degrees), "{degrees}");
        assert!((0..50).all(|seed| Arrays::IDEAL.of(seed, &radar, false).is_ideal()));
    }
}
