//! Energy of a residual over range at each end, which shows the unexplained parts of the scene.

use super::groups::BinSpans;
use crate::radar::{End, Radar};
use crate::reconstruct::hearing::range_energy;
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Energy in every range bin at each end.
#[derive(Debug, Clone)]
pub struct Profile {
    energy: [Vec<f64>; 2],
}

/// Bins beside an atom's own that count as its own too.
const MARGIN_BINS: f64 = 2.0;

impl Profile {
    /// The profile of samples laid out channel by channel, not windowed.
    pub fn new(radar: &Radar, flat: &[Complex64]) -> Self {
        let ends = TwoEnds::of_flat(radar, flat);
        Profile { energy: End::BOTH.map(|end| range_energy(radar, ends.end(end).view())) }
    }

    /// The largest energy of a bin at or beside these spans.
    pub fn peak_energy(&self, spans: &BinSpans) -> f64 {
        spans
            .iter()
            .zip(&self.energy)
            .map(|(spans, energy)| near(energy, spans).fold(0.0, f64::max))
            .fold(0.0, f64::max)
    }

    /// Energy at and beside these spans.
    pub fn energy(&self, spans: &BinSpans) -> f64 {
        spans.iter().zip(&self.energy).map(|(spans, energy)| near(energy, spans).sum::<f64>()).sum()
    }

    /// Energy at and beside these spans less noise of this energy a bin; at least 0.
    pub fn energy_over_noise(&self, spans: &BinSpans, noise_a_bin: f64) -> f64 {
        let bins: usize = spans.iter().zip(&self.energy).map(|(spans, energy)| near(energy, spans).count()).sum();
        (self.energy(spans) - noise_a_bin * bins as f64).max(0.0)
    }
}

/// Energy of each bin at and beside these spans of one end, none twice.
fn near(energy: &[f64], (low, high): &(f64, f64)) -> impl Iterator<Item = f64> {
    let (low, high) = ((low - MARGIN_BINS).round() as i64, (high + MARGIN_BINS).round() as i64);
    let len = energy.len() as i64;
    (low..=high.min(low + len - 1)).map(move |bin| energy[bin.rem_euclid(len) as usize])
}

/// BinSpans that hold all of several atoms' spans.
pub fn union_of(spans: impl Iterator<Item = BinSpans>) -> Option<BinSpans> {
    spans.reduce(|a, b| [0, 1].map(|end| (a[end].0.min(b[end].0), a[end].1.max(b[end].1))))
}
