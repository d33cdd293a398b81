//! The noise of a network's training scenes.

use crate::radar::Decibels;

/// The noise beneath the scenes of a method's training: the rounding of [`crate::signal::Floor::Thesis`], and thermal noise in some of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrainedNoise {
    Rounding,
    /// Rounding, and thermal noise at signal-to-noise ratios from the first to the second, per sample over the whole array.
    RoundingAndSnr(Decibels, Decibels),
}
