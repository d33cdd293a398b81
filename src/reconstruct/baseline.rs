//! The thesis' baseline: one end's own map, thresholded.

use super::error::Result;
use super::{MethodInfo, Reconstruction, Reconstructor, Request};
use crate::maps::channels_map;
use crate::radar::Radar;
use crate::signal::TwoEnds;

/// Lambda of the first end, unchanged (thesis section 4.3).
#[derive(Debug, Clone, Copy, Default)]
pub struct Baseline;

impl Reconstructor for Baseline {
    fn info(&self) -> MethodInfo {
        MethodInfo {
            name: "baseline",
            description: "the first end's own map, as the thesis compares with",
            prior_knowledge: "nothing; its threshold is the thesis' own",
            eta: 0.9,
        }
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn fewest_end_elements(&self) -> usize {
        2
    }

    fn finds_reflectors(&self) -> bool {
        false
    }

    fn check_hearing(&self, _: &TwoEnds) -> Result<()> {
        Ok(())
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        let log = channels_map(radar, ends.first.view()).log_magnitude();
        Ok(Reconstruction::of_map(log.normalise(request.normalisation)))
    }
}
