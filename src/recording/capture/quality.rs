//! Doubts about a frame: zeros of lost packets, saturation, constant parts, real samples stored as complex.

use super::plan::CapturePlan;
use crate::recording::layout::{Layout, PartOrder};
use ndarray::{Array4, Axis};
use num_complex::Complex64;

/// Least number of zero bytes in a row that count as a lost packet.
const MIN_ZERO_RUN_BYTES: usize = 128;
/// Least part of the numbers at the limits of their type that counts as saturation.
const MIN_SATURATED_PART: f64 = 1e-4;

/// Figures on the quality of a frame.
#[derive(Debug, Clone, Default)]
pub(in crate::recording) struct Quality {
    /// Whether each chirp has runs of zeros.
    zeros: Vec<bool>,
    /// Number of 16-bit numbers in the frame, and of those at the limits of their type.
    numbers: u64,
    saturated_count: u64,
    has_imaginary: bool,
    is_complex: bool,
    /// Power of the constant part over that of the rest, decibels.
    pub constant_db: f64,
}

impl Quality {
    pub fn new(chirps: usize) -> Self {
        Quality { zeros: vec![false; chirps], constant_db: f64::NEG_INFINITY, ..Quality::default() }
    }

    /// Counts zeros and saturated numbers in the bytes of chirp `n` of the frame.
    pub fn add_chirp(&mut self, n: usize, bytes: &[u8], layout: Layout) {
        self.zeros[n] = bytes.chunks_exact(MIN_ZERO_RUN_BYTES).any(|part| part.iter().all(|b| *b == 0));
        let max = layout.encoding.max_value();
        let at_end = |b: &&[u8]| {
            let value = layout.encoding.number([b[0], b[1]]);
            value == max || value == -max - 1
        };
        self.numbers += bytes.len() as u64 / 2;
        self.saturated_count += bytes.chunks_exact(2).filter(at_end).count() as u64;
        self.is_complex = layout.part_order != PartOrder::Real;
    }

    /// Measures the constant part of all samples, `[loops, chirps, receivers, samples]`, before any part is subtracted.
    pub fn measure_samples(&mut self, all: &Array4<Complex64>) {
        self.has_imaginary = all.iter().any(|v| v.im != 0.0);
        let (mut constant, mut rest) = (0.0, 0.0);
        for row in all.lanes(Axis(3)) {
            let len = row.len().max(1) as f64;
            let mean = row.sum() / len;
            constant += mean.norm_sqr() * len;
            rest += row.iter().map(|v| (v - mean).norm_sqr()).sum::<f64>();
        }
        if constant > 0.0 {
            self.constant_db = 10.0 * (constant / rest.max(f64::MIN_POSITIVE)).log10();
        }
    }

    pub fn has_zeros(&self, n: usize) -> bool {
        self.zeros.get(n).copied().unwrap_or(false)
    }

    /// Whether the constant part has more power than the rest.
    pub fn has_strong_constant(&self) -> bool {
        self.constant_db > 0.0
    }

    /// Whether samples are stored as complex, but all imaginary parts are zero.
    pub fn is_real(&self) -> bool {
        self.is_complex && !self.has_imaginary
    }

    /// Doubts about the frame, a sentence each; `is_out` where the constant part was subtracted.
    pub fn sentences(&self, plan: &CapturePlan, is_out: bool) -> Vec<String> {
        let chirps_with_zeros: Vec<usize> = (0..self.zeros.len()).filter(|n| self.zeros[*n]).collect();
        let lost = chirps_with_zeros.first().zip(chirps_with_zeros.last()).map(|(first, last)| {
            let (chirps, many) = (self.zeros.len(), chirps_with_zeros.len());
            format!(
                "Runs of zeros, as lost packets leave them, spoil {many} of the frame's {chirps} chirps, from chirp {first} to {last}: where \
                 loops are joined, their loops count nothing."
            )
        });
        let part = self.saturated_count as f64 / self.numbers.max(1) as f64;
        let saturated = (part > MIN_SATURATED_PART).then(|| {
            let (percent, max) = (100.0 * part, plan.layout.encoding.max_value());
            format!(
                "The receivers are saturated: {percent:.1} % of the numbers are {max} or {}, the ends of their type. Harmonics of strong echoes \
                 appear at multiples of their range.",
                -i32::from(max) - 1
            )
        });
        let stored = "Every imaginary part is zero: these are real samples, stored as complex ones. An echo's mirror image would stand in the \
                      far half of the range axis, so the near half alone is kept (the analytic signal).";
        let real = "Samples are real: the positive half of their spectrum is taken (the analytic signal).";
        let constant = (self.has_strong_constant() && !is_out).then(|| {
            format!(
                "A constant part (leakage or offset) stands {:.0} dB over all else: recording.capture.constant = \"out\" takes it out.",
                self.constant_db
            )
        });
        let stored = self.is_real().then(|| stored.to_owned());
        let real = (plan.layout.part_order == PartOrder::Real).then(|| real.to_owned());
        [lost, saturated, stored, real, constant].into_iter().flatten().collect()
    }
}
