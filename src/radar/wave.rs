//! Growth of an echo's phase with its range.
//!
//! Equation 3.1 turns the carrier's phase `s q / lambda` a metre of range, and the beat's phase `n1 / (N dR)` a metre at sample `n1` of
//! `N`, where `dR` is the range resolution. Both together are the echo's wave number, in turns: [`Radar::turns_per_metre`].

use super::Radar;
use std::f64::consts::TAU;

impl Radar {
    /// Turns of the carrier's phase for each metre of range, signed.
    pub fn carrier_turns_per_metre(&self) -> f64 {
        self.carrier.turns_per_wavelength() / self.wavelength_metres()
    }

    /// Radians of the carrier's phase for each metre of range, signed.
    pub fn carrier_radians_per_metre(&self) -> f64 {
        TAU * self.carrier.turns_per_wavelength() / self.wavelength_metres()
    }

    /// Turns of the beat's phase from sample 0 to `sample`, for each metre of range.
    pub fn beat_turns_per_metre(&self, sample: f64) -> f64 {
        sample / self.max_range_metres()
    }

    /// Turns of an echo's phase at `sample` for each metre of range, signed.
    pub fn turns_per_metre(&self, sample: f64) -> f64 {
        self.carrier_turns_per_metre() + self.beat_turns_per_metre(sample)
    }

    /// The middle of the chirp, where windows weigh most. Samples are counted from 0: it is half a sample before half of them.
    pub fn middle_sample(&self) -> f64 {
        (self.samples as f64 - 1.0) / 2.0
    }

    /// Turns of an echo's phase in the middle of the chirp for each metre of range, signed: they decide the column of a blob.
    pub fn middle_turns_per_metre(&self) -> f64 {
        self.turns_per_metre(self.middle_sample())
    }

    /// Difference of cos(theta) after which directions share a column again: one turn of phase from element to element. 2 would be all
    /// directions; table 3.1 has 2.05, spacing of one wavelength half of it (its grating lobes).
    pub fn fold_period_cos(&self) -> f64 {
        1.0 / (self.middle_turns_per_metre().abs() * self.element_spacing_metres)
    }

    /// Distance beyond which waves are plane over elements on `span_metres` that send and hear by themselves: `2 |s q| D^2 / lambda`, metres.
    /// `|s q|` is 2 where a radar counts the way there and back, so that its far field begins at `4 D^2 / lambda`.
    pub fn plane_beyond_metres(&self, span_metres: f64) -> f64 {
        2.0 * self.carrier_turns_per_metre().abs() * span_metres.powi(2)
    }

    /// Width in cos(theta) of the beam of elements over `span_metres`: one turn of the carrier from one side to the other.
    pub fn beam_cos(&self, span_metres: f64) -> f64 {
        self.wavelength_metres() / (span_metres * self.carrier.turns_per_wavelength().abs())
    }
}
