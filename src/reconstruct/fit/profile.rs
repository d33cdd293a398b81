//! Energy of a residual over range at each end.

use super::groups::BinSpans;
use crate::radar::{End, Radar};
use crate::reconstruct::noise_model::range_energy;
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Energy of all elements of an end in each range bin, for both ends.
#[derive(Debug, Clone)]
pub struct Profile {
    energy: [Vec<f64>; 2],
}

/// Range bins beside an atom's own that are counted as its own: the main lobe of its echo.
const MARGIN_BINS: f64 = 2.0;

impl Profile {
    /// The profile of samples channel by channel, `[channels * samples]`, without a window.
    pub fn new(radar: &Radar, flat: &[Complex64]) -> Self {
        let ends = TwoEnds::of_flat(radar, flat);
        Profile { energy: End::BOTH.map(|end| range_energy(radar, ends.end(end).view())) }
    }

    /// The largest energy of a range bin of `spans` and its margins.
    pub fn peak_energy(&self, spans: &BinSpans) -> f64 {
        spans.iter().zip(&self.energy).flat_map(|(span, energy)| near(energy, span)).fold(0.0, f64::max)
    }

    /// Energy in the range bins of `spans` and its margins.
    pub fn energy(&self, spans: &BinSpans) -> f64 {
        spans.iter().zip(&self.energy).map(|(span, energy)| near(energy, span).sum::<f64>()).sum()
    }

    /// [`Self::energy`] without noise of `noise_energy` in each range bin; at least 0.
    pub fn energy_over_noise(&self, spans: &BinSpans, noise_energy: f64) -> f64 {
        let bins: usize = spans.iter().zip(&self.energy).map(|(span, energy)| near(energy, span).count()).sum();
        (self.energy(spans) - noise_energy * bins as f64).max(0.0)
    }
}

/// Energy of each range bin from `low` to `high` and of the margins, none twice.
fn near(energy: &[f64], (low, high): &(f64, f64)) -> impl Iterator<Item = f64> {
    let (low, high) = ((low - MARGIN_BINS).round() as i64, (high + MARGIN_BINS).round() as i64);
    let len = energy.len() as i64;
    (low..=high.min(low + len - 1)).map(move |bin| energy[bin.rem_euclid(len) as usize])
}

/// The smallest spans that contain all of `spans`; `None` without any.
pub fn union_of(spans: impl Iterator<Item = BinSpans>) -> Option<BinSpans> {
    spans.reduce(|a, b| [0, 1].map(|end| (a[end].0.min(b[end].0), a[end].1.max(b[end].1))))
}
