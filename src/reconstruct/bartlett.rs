//! Bartlett beamforming of each end.

use super::rows::reconstruct_rows;
use super::{ReconstructError, Reconstruction, Reconstructor, Request};
use crate::radar::Radar;
use crate::signal::TwoEnds;

/// Each end's beams without an angle window, laid over each other on the centre's grid.
///
/// M. S. Bartlett, "Smoothing periodograms from time-series with continuous spectra", Nature 161, 1948, brought to arrays.
#[derive(Debug, Clone, Copy, Default)]
pub struct Bartlett;

impl Reconstructor for Bartlett {
    fn name(&self) -> &'static str {
        "bartlett"
    }

    fn description(&self) -> &'static str {
        "both ends' plain beams, laid over each other where they see the same place"
    }

    fn eta(&self) -> f32 {
        0.952 // by tests/choose_eta.rs
    }

    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        reconstruct_rows(radar, ends, request, |row| Some(row.bartlett()))
    }
}
