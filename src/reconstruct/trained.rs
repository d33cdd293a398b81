//! Over which noise a network was trained.

use crate::radar::Decibels;

/// The noise beneath the scenes that a method was trained on: the rounding of the thesis' program ([`crate::signal::Floor::Thesis`]), and thermal noise where
/// some scenes had it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrainedNoise {
    /// Rounding alone.
    Rounding,
    /// Rounding, and thermal noise at signal-to-noise ratios from the first to the second, per sample over the whole array.
    RoundingAndSnr(Decibels, Decibels),
}
