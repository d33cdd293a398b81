//! Bartlett beamforming of each end.

use super::rows::RowMethod;

/// Each end's beams without an angle window, laid over each other on the centre's grid.
///
/// M. S. Bartlett, "Smoothing periodograms from time-series with continuous spectra", Nature 161, 1948, brought to arrays.
pub const BARTLETT: RowMethod = RowMethod {
    name: "bartlett",
    description: "both ends' plain beams, laid over each other where they see the same place",
    eta: 0.952, // by tests/choose_eta.rs
    estimate: |row| Some(row.bartlett()),
};
