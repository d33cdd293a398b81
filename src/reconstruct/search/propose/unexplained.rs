//! The residual of the samples, as sources of candidates use it.

use super::phased::PhasedBeams;
use super::runs::{LONG_RUN_BINS, longest_run_bins};
use crate::radar::Radar;
use crate::reconstruct::hearing::Hearing;
use crate::task::Task;
use num_complex::Complex64;
use std::cell::OnceCell;

/// The residual of the samples, and places where points may be.
pub struct Unexplained<'a> {
    /// The radar.
    pub radar: &'a Radar,
    /// The residual, channel by channel, not windowed.
    pub flat: &'a [Complex64],
    /// The noise in the residual.
    pub hearing: Hearing,
    /// Places (x, y), metres, where points may be: those first on which the ends agree best.
    pub points_metres: &'a [[f64; 2]],
    /// The task, which may be cancelled.
    pub task: &'a Task,
    beams: OnceCell<PhasedBeams>,
}

impl<'a> Unexplained<'a> {
    /// The residual `flat`, channel by channel.
    pub fn new(radar: &'a Radar, flat: &'a [Complex64], hearing: Hearing, task: &'a Task) -> Self {
        Unexplained { radar, flat, hearing, points_metres: &[], task, beams: OnceCell::new() }
    }

    /// The residual with places where points may be.
    pub fn with_points(self, points_metres: &'a [[f64; 2]]) -> Self {
        Unexplained { points_metres, ..self }
    }

    /// Each end's beams, with their phases.
    pub fn beams(&self) -> &PhasedBeams {
        self.beams.get_or_init(|| PhasedBeams::new(self.radar, self.flat))
    }

    /// Whether the residual has something longer than a few reflectors.
    pub fn is_long(&self) -> bool {
        let variance = self.hearing.noise_variance(self.radar, self.flat);
        longest_run_bins(self.radar, self.flat, variance) >= LONG_RUN_BINS
    }

    /// The first points within the maximum range, `most` of them.
    pub fn points_within_range(&self, most: usize) -> Vec<[f64; 2]> {
        let within = |p: &&[f64; 2]| p[0].hypot(p[1]) < self.radar.max_range_metres();
        self.points_metres.iter().filter(within).take(most).copied().collect()
    }
}
