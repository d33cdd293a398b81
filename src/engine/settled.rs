//! Maps of a scene at rest, computed as every command computes them.

use super::frame::{EngineFrame, MapRequest, Pictured, ReadyMap};
use super::report::{EngineReport, EngineStage};
use crate::maps::focus::map_of;
use crate::maps::{Aperture, LogMap, Normalisation, angle_transform, range_transform};
use crate::platform::Instant;
use crate::radar::{Radar, counted};
use crate::scene::Scene;
use crate::signal::{self, SimulationResult, TwoEnds};
use crate::task::Task;
use std::sync::Arc;

/// The maps of one scene by [`signal::simulate`] and the plain transforms in f64, independent of any other scene.
pub(super) struct SettledMaps {
    of: Pictured,
    ends: Arc<TwoEnds>,
    logs: [Option<LogMap>; 3],
    normalisation: Normalisation,
    maps: [Option<ReadyMap>; 3],
}

impl SettledMaps {
    /// Computes the wanted maps of `scene`, and adds the stages' times to `report`.
    pub fn of(
        task: &Task,
        radar: &Radar,
        scene: &Scene,
        wanted: &MapRequest,
        report: &mut EngineReport,
    ) -> SimulationResult<Self> {
        let start = Instant::now();
        let signal = signal::simulate_for(task, radar, scene, wanted.floor, wanted.seed)?;
        let ends = Arc::new(signal.two_ends(radar));
        // Plain maps share their range profiles; each focused map has its own.
        let profiles = (!radar.focus_off_line).then(|| range_transform(radar, &signal));
        report.computed(EngineStage::Signal, start.elapsed(), "from scratch in f64, as every command does");
        let mut logs = [None, None, None];
        for (i, log) in logs.iter_mut().enumerate().filter(|(i, _)| wanted.visible()[*i]) {
            task.check()?;
            let start = Instant::now();
            let map = match &profiles {
                Some(profiles) => angle_transform(radar, profiles, Aperture::ALL[i]),
                None => map_of(radar, &scene.disturbances.elements, &signal, Aperture::ALL[i]),
            };
            *log = Some(map.log_magnitude());
            report.computed(EngineStage::MAPS[i], start.elapsed(), "all rows in f64");
        }
        let (of, normalisation) = (Pictured::of(scene, wanted), wanted.normalisation);
        Ok(SettledMaps { of, ends, logs, normalisation, maps: [None, None, None] })
    }

    /// Whether the maps include all that `wanted` asks of `scene`.
    pub fn has(&self, scene: &Scene, wanted: &MapRequest) -> bool {
        let visible = wanted.visible();
        self.of.is(scene, wanted) && (0..3).all(|i| !visible[i] || self.logs[i].is_some())
    }

    pub fn maps(&self) -> usize {
        self.logs.iter().flatten().count()
    }

    /// The wanted maps and samples; maps returned before are the same `Arc`.
    pub fn frame(&mut self, wanted: &MapRequest, mut report: EngineReport) -> EngineFrame {
        let start = Instant::now();
        if self.normalisation != wanted.normalisation {
            self.normalisation = wanted.normalisation;
            self.maps = [None, None, None];
        }
        let visible = wanted.visible();
        let mut made = 0;
        for i in (0..3).filter(|i| visible[*i]) {
            if let (None, Some(log)) = (&self.maps[i], &self.logs[i]) {
                let scale = log.scale(wanted.normalisation);
                self.maps[i] = Some(ReadyMap { lambda: Arc::new(log.normalise(wanted.normalisation)), scale });
                made += 1;
            }
        }
        for stage in [EngineStage::Signal, EngineStage::Noise, EngineStage::Ends].into_iter().chain(EngineStage::MAPS) {
            if !report.ran(stage) {
                report.skipped(stage, "the scene rests");
            }
        }
        match made {
            0 => report.skipped(EngineStage::Normalise, "unchanged"),
            _ => report.computed(EngineStage::Normalise, start.elapsed(), counted(made, "map", "maps")),
        }
        let map = |i: usize| self.maps[i].clone().filter(|_| visible[i]);
        let ends = Some(self.ends.clone()).filter(|_| wanted.ends);
        EngineFrame { first: map(0), last: map(1), full: map(2), ends, settled: true, report }
    }
}
