//! The thesis' baseline: one end's own map, thresholded.

use super::conditioning::unit_gain;
use super::rendering::silence;
use super::{ReconstructError, Reconstruction, Reconstructor, Request, check_ends};
use crate::maps::channels_map;
use crate::radar::Radar;
use crate::signal::TwoEnds;

/// Lambda of the first end, taken as it is (thesis section 4.3).
#[derive(Debug, Clone, Copy, Default)]
pub struct Baseline;

impl Reconstructor for Baseline {
    fn name(&self) -> &'static str {
        "baseline"
    }

    fn description(&self) -> &'static str {
        "the first end's own map, as the thesis compares with"
    }

    fn eta(&self) -> f32 {
        0.9
    }

    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        check_ends(radar, ends)?;
        let Some((ends, _)) = unit_gain(ends) else { return Ok(silence(radar)) };
        let log = channels_map(radar, ends.first.view()).log_magnitude();
        Ok(Reconstruction { lambda: log.normalise(request.normalisation), reflectors: Vec::new() })
    }
}
