//! Maps of the last frame.

use super::bank::KeptDecades;
use super::frame::{MapRequest, Pictured, ReadyMap};
use super::report::{EngineReport, EngineStage};
use crate::maps::fast::{FastLogMap, normalise_into};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::platform::Instant;
use crate::radar::{Radar, counted};
use crate::scene::Scene;
use crate::signal::{Rows, TwoEnds};
use ndarray::Array2;
use std::sync::Arc;

pub(super) struct ShownMaps {
    pub of: Pictured,
    pub tolerance: f64,
    pub normalisation: Normalisation,
    pub ends: Option<Arc<TwoEnds>>,
    pub decades: [Option<KeptDecades>; 3],
    /// Whether each of `decades` is of this scene.
    pub current: [bool; 3],
    pub maps: [Option<ReadyMap>; 3],
    /// Buffers of earlier maps, reused once no frame holds them.
    pub spare: Vec<Arc<RangeAngleMap>>,
}

impl ShownMaps {
    /// No maps yet of a new scene; buffers come from the maps `before`.
    pub fn of(scene: &Scene, wanted: &MapRequest, tolerance: f64, before: Option<ShownMaps>) -> Self {
        let (mut spare, mut decades) = (Vec::new(), [None, None, None]);
        if let Some(before) = before {
            (spare, decades) = (before.spare, before.decades);
            spare.extend(before.maps.into_iter().flatten().map(|m| m.lambda));
            // The previous frame holds three; three more are in the making.
            let excess = spare.len().saturating_sub(6);
            spare.drain(..excess);
        }
        let (of, normalisation, maps) = (Pictured::of(scene, wanted), wanted.normalisation, [None, None, None]);
        ShownMaps { of, tolerance, normalisation, ends: None, decades, current: [false; 3], maps, spare }
    }

    /// Drops the scene but keeps buffers: no request accepts the infinite tolerance.
    pub fn forget(&mut self, radar: &Radar) {
        self.tolerance = f64::INFINITY;
        self.decades.iter_mut().flatten().for_each(|kept| kept.stale = Rows::all(radar.samples));
    }

    /// Computes Lambda of every visible map that is new or has another normalisation than before.
    pub fn normalise(
        &mut self,
        visible: [bool; 3],
        missing: [bool; 3],
        normalisation: Normalisation,
        report: &mut EngineReport,
    ) {
        let start = Instant::now();
        if self.normalisation != normalisation {
            self.spare.extend(self.maps.iter_mut().filter_map(Option::take).map(|m| m.lambda));
            self.normalisation = normalisation;
        }
        let mut made: Vec<(usize, &FastLogMap, Arc<RangeAngleMap>)> = Vec::new();
        for i in 0..3 {
            let Some(KeptDecades { decades, .. }) = self.decades[i].as_ref().filter(|_| visible[i]) else { continue };
            if self.maps[i].is_some() && !missing[i] {
                continue;
            }
            let free = self.spare.iter_mut().position(|a| Arc::get_mut(a).is_some());
            let lambda = match free {
                Some(free) => self.spare.swap_remove(free),
                None => Arc::new(RangeAngleMap { lambda: Array2::zeros(decades.cells.raw_dim()) }),
            };
            made.push((i, decades, lambda));
        }
        let pairs = made.iter_mut().filter_map(|(_, decades, lambda)| Some((*decades, Arc::get_mut(lambda)?)));
        normalise_into(pairs.collect(), normalisation);
        let count = made.len();
        for (i, decades, lambda) in made {
            self.maps[i] = Some(ReadyMap { lambda, scale: decades.scale(normalisation) });
        }
        match count {
            0 => report.skipped(EngineStage::Normalise, "unchanged"),
            _ => report.computed(EngineStage::Normalise, start.elapsed(), counted(count, "map", "maps")),
        }
    }
}
