//! Quantities whose unit a bare number would hide.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A power ratio in decibels.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Decibels(pub f64);

impl Decibels {
    /// The ratio of powers: `10^(dB/10)`.
    pub fn power_ratio(self) -> f64 {
        10f64.powf(self.0 / 10.0)
    }

    /// Decades of *amplitude*: dB / 20.
    pub fn amplitude_decades(self) -> f64 {
        self.0 / 20.0
    }
}

impl fmt::Display for Decibels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} dB", self.0)
    }
}
