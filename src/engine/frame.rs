//! Requests to the engine and its results.

use super::report::EngineReport;
use crate::maps::{Aperture, LambdaScale, Normalisation, RangeAngleMap};
use crate::radar::End;
use crate::scene::{Disturbances, Object, Scene};
use crate::signal::{Floor, TwoEnds};
use std::sync::Arc;

/// A request for the maps of the first end, the last end and the whole array, and for the samples of the ends. The engine computes no others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapRequest {
    pub floor: Floor,
    pub seed: u64,
    pub normalisation: Normalisation,
    pub first: bool,
    pub last: bool,
    pub full: bool,
    pub ends: bool,
}

impl MapRequest {
    pub(super) fn visible(&self) -> [bool; 3] {
        [self.first, self.last, self.full]
    }
}

impl Default for MapRequest {
    fn default() -> Self {
        let (floor, normalisation) = (Floor::Thesis, Normalisation::MinMax);
        MapRequest { floor, seed: 0, normalisation, first: true, last: true, full: true, ends: true }
    }
}

pub(super) struct Pictured {
    objects: Vec<Object>,
    shadows: bool,
    disturbances: Disturbances,
    floor: (Floor, u64),
}

impl Pictured {
    pub fn of(scene: &Scene, wanted: &MapRequest) -> Self {
        let Scene { objects, shadows, disturbances, .. } = scene.clone();
        Pictured { objects, shadows, disturbances, floor: (wanted.floor, wanted.seed) }
    }

    pub fn is(&self, scene: &Scene, wanted: &MapRequest) -> bool {
        self.objects == scene.objects
            && self.shadows == scene.shadows
            && self.disturbances == scene.disturbances
            && self.floor == (wanted.floor, wanted.seed)
    }
}

#[derive(Debug, Clone)]
pub struct ReadyMap {
    /// Lambda, `[range bins, columns]`.
    pub lambda: Arc<RangeAngleMap>,
    /// Scale from decades of amplitude to Lambda.
    pub scale: LambdaScale,
}

/// The requested maps and samples of one scene.
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
    /// Whether the maps have the same bits as a command's ([`super::Engine::settle`]), so that figures may be made of them.
    pub settled: bool,
    pub report: EngineReport,
}

impl EngineFrame {
    /// The map of one aperture, if it was requested.
    pub fn map(&self, aperture: Aperture) -> Option<&ReadyMap> {
        match aperture {
            Aperture::Full => self.full.as_ref(),
            Aperture::End(End::First) => self.first.as_ref(),
            Aperture::End(End::Last) => self.last.as_ref(),
        }
    }
}
