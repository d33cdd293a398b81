//! Floors of training scenes.

use crate::radar::Decibels;
use crate::signal::Floor;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt;

/// The floor of a training scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Floors {
    /// The same floor for all scenes.
    Fixed(Floor),
    /// Thermal noise beneath a part of the scenes, the thesis' floor beneath the others.
    Thermal {
        /// The part of scenes over thermal noise, 0 to 1.
        share: f64,
        /// Lowest ratio of signal to noise.
        from: Decibels,
        /// Highest ratio, above `from`; scenes are uniform in between.
        to: Decibels,
    },
}

impl fmt::Display for Floors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Floors::Fixed(floor) => floor.fmt(f),
            Floors::Thermal { share, from, to } => write!(f, "thermal={share},{},{}", from.0, to.0),
        }
    }
}

impl Floors {
    /// The floor of the scene with this seed of noise.
    pub fn of(&self, noise_seed: u64) -> Floor {
        match *self {
            Floors::Fixed(floor) => floor,
            Floors::Thermal { share, from, to } => {
                let mut rng = ChaCha8Rng::seed_from_u64(noise_seed);
                if rng.random::<f64>() < share {
                    Floor::Snr(Decibels(rng.random_range(from.0..to.0)))
                } else {
                    Floor::Thesis
                }
            }
        }
    }
}
