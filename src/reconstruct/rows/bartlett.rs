//! Bartlett beamforming of each end.

use super::method::{ASSUMPTIONS, Render, RowMethod};
use crate::reconstruct::reconstructor::About;

/// Each end's beams without an angle window, combined on the centre's grid.
///
/// M. S. Bartlett, "Smoothing periodograms from time-series with continuous spectra", Nature 161, 1948, applied to arrays.
pub const BARTLETT: RowMethod = RowMethod {
    about: About {
        name: "bartlett",
        description: "both ends' plain beams, laid over each other where they see the same place",
        told: ASSUMPTIONS,
        eta: 0.952, // by examples/choose_eta.rs
    },
    estimate: |row| Some(row.bartlett()),
    render: Render::Spectrum,
};
