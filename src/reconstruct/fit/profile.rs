//! Energy of a residual over range at each end, which shows the unexplained parts of the scene.

use super::groups::Rows;
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

    /// The largest energy of a bin at or beside these rows.
    pub fn strongest(&self, rows: &Rows) -> f64 {
        rows.iter().zip(&self.energy).map(|(rows, energy)| near(energy, rows).fold(0.0, f64::max)).fold(0.0, f64::max)
    }

    /// Energy at and beside these rows.
    pub fn at(&self, rows: &Rows) -> f64 {
        rows.iter().zip(&self.energy).map(|(rows, energy)| near(energy, rows).sum::<f64>()).sum()
    }

    /// Energy at and beside these rows less noise of this energy a bin; at least 0.
    pub fn over_noise(&self, rows: &Rows, noise_a_bin: f64) -> f64 {
        let bins: usize = rows.iter().zip(&self.energy).map(|(rows, energy)| near(energy, rows).count()).sum();
        (self.at(rows) - noise_a_bin * bins as f64).max(0.0)
    }
}

/// Energy of each bin at and beside these rows of one end, none twice.
fn near(energy: &[f64], (low, high): &(f64, f64)) -> impl Iterator<Item = f64> {
    let (low, high) = ((low - MARGIN_BINS).round() as i64, (high + MARGIN_BINS).round() as i64);
    let len = energy.len() as i64;
    (low..=high.min(low + len - 1)).map(move |bin| energy[bin.rem_euclid(len) as usize])
}

/// Rows that hold all of several atoms' rows.
pub fn union_of(rows: impl Iterator<Item = Rows>) -> Option<Rows> {
    rows.reduce(|a, b| [0, 1].map(|end| (a[end].0.min(b[end].0), a[end].1.max(b[end].1))))
}
