//! Doubts about a frame: zeros of lost packets, saturation, constant parts, real samples stored as complex.

use super::plan::Plan;
use crate::recording::layout::{Layout, Parts};
use ndarray::{Array4, Axis};
use num_complex::Complex64;

/// Number of zero bytes in a row that are taken for a lost packet.
const ZERO_RUN: usize = 128;
/// Least part of the numbers at the ends of their type that is called saturation.
const SATURATED: f64 = 1e-4;
/// Power of a constant part over the rest above which it is noted, decibels.
const CONSTANT_DB: f64 = 0.0;

#[derive(Debug, Clone)]
pub(in crate::recording) struct Quality {
    /// Whether each chirp has runs of zeros.
    zeros: Vec<bool>,
    numbers: u64,
    at_ends: u64,
    imaginary: bool,
    complex: bool,
    /// Power of the constant part over that of the rest, decibels.
    pub constant_db: f64,
}

impl Quality {
    pub fn new(chirps: usize) -> Self {
        let zeros = vec![false; chirps];
        Quality { zeros, numbers: 0, at_ends: 0, imaginary: false, complex: false, constant_db: f64::NEG_INFINITY }
    }

    /// Looks at the bytes of chirp `n` of the frame.
    pub fn look_at_bytes(&mut self, n: usize, bytes: &[u8], layout: Layout) {
        self.zeros[n] = bytes.chunks_exact(ZERO_RUN).any(|part| part.iter().all(|b| *b == 0));
        let most = layout.words.most();
        let at_end = |b: &&[u8]| {
            let value = layout.words.number([b[0], b[1]]);
            value == most || value == -most - 1
        };
        self.numbers += bytes.len() as u64 / 2;
        self.at_ends += bytes.chunks_exact(2).filter(at_end).count() as u64;
        self.complex = layout.parts != Parts::Real;
    }

    /// Looks at all samples, before any part is taken out.
    pub fn look_at_samples(&mut self, all: &Array4<Complex64>) {
        self.imaginary = all.iter().any(|v| v.im != 0.0);
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

    /// Whether chirp `n` of the frame has a run of zeros.
    pub fn has_zeros(&self, n: usize) -> bool {
        self.zeros.get(n).copied().unwrap_or(false)
    }

    /// Whether the constant part has more power than the rest.
    pub fn tells_constant(&self) -> bool {
        self.constant_db > CONSTANT_DB
    }

    /// Whether every imaginary part is zero where samples are to be complex.
    pub fn is_real(&self) -> bool {
        self.complex && !self.imaginary
    }

    /// Doubts about the frame, a sentence each.
    pub fn sentences(&self, plan: &Plan, is_out: bool) -> Vec<String> {
        let spoilt: Vec<usize> = (0..self.zeros.len()).filter(|n| self.zeros[*n]).collect();
        let lost = spoilt.first().zip(spoilt.last()).map(|(first, last)| {
            let (chirps, many) = (self.zeros.len(), spoilt.len());
            format!(
                "Runs of zeros, as lost packets leave them, spoil {many} of the frame's {chirps} chirps, from chirp {first} to {last}: where \
                 loops are joined, their loops count nothing."
            )
        });
        let part = self.at_ends as f64 / self.numbers.max(1) as f64;
        let saturated = (part > SATURATED).then(|| {
            let (percent, most) = (100.0 * part, plan.layout.words.most());
            format!(
                "The receivers are saturated: {percent:.1} % of the numbers are {most} or {}, the ends of their type. Harmonics of strong echoes \
                 appear at multiples of their range.",
                -i32::from(most) - 1
            )
        });
        let stored = "Every imaginary part is zero: these are real samples, stored as complex ones. An echo's mirror image would stand in the \
                      far half of the range axis, so the near half alone is kept (the analytic signal).";
        let real = "Samples are real: the positive half of their spectrum is taken (the analytic signal).";
        let constant = (self.tells_constant() && !is_out).then(|| {
            format!(
                "A constant part (leakage or offset) stands {:.0} dB over all else: recording.capture.constant = \"out\" takes it out.",
                self.constant_db
            )
        });
        let stored = self.is_real().then(|| stored.to_owned());
        let real = (plan.layout.parts == Parts::Real).then(|| real.to_owned());
        [lost, saturated, stored, real, constant].into_iter().flatten().collect()
    }
}
