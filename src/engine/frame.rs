//! What is asked of the engine, and what it answers with.

use super::report::EngineReport;
use crate::maps::{Aperture, LambdaScale, Normalisation, RangeAngleMap};
use crate::radar::End;
use crate::signal::{Floor, TwoEnds};
use std::sync::Arc;

/// Which maps are looked at; no other is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapRequest {
    /// The floor beneath the reflectors.
    pub floor: Floor,
    /// Picks the noise of the floor.
    pub seed: u64,
    /// How the maps are normalised.
    pub normalisation: Normalisation,
    /// Whether the map of the first end is looked at.
    pub first: bool,
    /// Whether the map of the last end is looked at.
    pub last: bool,
    /// Whether the map of the whole array is looked at.
    pub full: bool,
    /// Whether the samples of the two ends are needed, for a reconstruction.
    pub ends: bool,
}

impl MapRequest {
    pub(super) fn visible(&self) -> [bool; 3] {
        [self.first, self.last, self.full]
    }
}

impl Default for MapRequest {
    fn default() -> Self {
        MapRequest {
            floor: Floor::Thesis,
            seed: 0,
            normalisation: Normalisation::MinMax,
            first: true,
            last: true,
            full: true,
            ends: true,
        }
    }
}

/// One map, ready to be drawn.
#[derive(Debug, Clone)]
pub struct ReadyMap {
    /// Lambda, `[range bins, columns]`.
    pub lambda: Arc<RangeAngleMap>,
    /// The straight line between decades of amplitude and Lambda.
    pub scale: LambdaScale,
}

/// Everything that was wanted of one scene.
#[derive(Debug, Clone)]
pub struct EngineFrame {
    /// Map of the first end, if wanted.
    pub first: Option<ReadyMap>,
    /// Map of the last end, if wanted.
    pub last: Option<ReadyMap>,
    /// Map of the whole array, if wanted.
    pub full: Option<ReadyMap>,
    /// Samples of both ends, if wanted.
    pub ends: Option<Arc<TwoEnds>>,
    /// Whether it was computed as every command computes it ([`super::Engine::settle`]): figures may be made of it.
    pub settled: bool,
    /// What each stage cost, and what was skipped and why.
    pub report: EngineReport,
}

impl EngineFrame {
    /// The map of one aperture, if it was wanted.
    pub fn map(&self, aperture: Aperture) -> Option<&ReadyMap> {
        match aperture {
            Aperture::Full => self.full.as_ref(),
            Aperture::End(End::First) => self.first.as_ref(),
            Aperture::End(End::Last) => self.last.as_ref(),
        }
    }
}
