//! The incremental engine, without threads of its own.
//!
//! The signal is a sum over objects. The engine keeps the range profiles of the objects at rest and, apart from them, of those being edited: a drag of one of
//! many objects evaluates that one only. Subtracting an object from the sum at rest leaves rounding errors. The engine keeps a bound of them and sums anew
//! before they could show in a map.

use super::amplitudes::Amplitudes;
use super::bank::{Bank, BankUpdate};
use super::settled::SettledMaps;
use super::shown::ShownMaps;
use super::{EngineFrame, EngineReport, EngineStage, MapRequest};
use crate::maps::tolerance;
use crate::platform::Instant;
use crate::radar::Radar;
use crate::scattering::ObjectWithOccluders;
use crate::scene::{Scene, SceneError};
use crate::signal::plan::SumSize;
use crate::signal::simd::{LANES_F32, LANES_F64};
use crate::signal::{Algorithm, Precision, Rows, SimulationError, SimulationResult, SynthesisPlan, simulate_ends_for};
use crate::task::{Cancelled, Task};
use num_complex::Complex64;
use std::sync::Arc;

/// The engine of one radar, which keeps its results and recomputes only those that a change affects.
pub struct Engine {
    radar: Radar,
    forced: PlanOverrides,
    single: Option<Bank<f32, LANES_F32>>,
    double: Option<Bank<f64, LANES_F64>>,
    last: Option<Precision>,
    shown: Option<ShownMaps>,
    settled: Option<SettledMaps>,
    amplitudes: Amplitudes,
}

/// Overrides of the planner's choices; `None` leaves a choice to the planner.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlanOverrides {
    /// Algorithm for every sum; [`Algorithm::Direct`] and [`Algorithm::Exact`] have no fast path and are evaluated by phasor split.
    pub algorithm: Option<Algorithm>,
    /// Precision. Double is used where the rounding of single precision would show in the maps, and the report says so ([`tolerance::refusal`]).
    pub precision: Option<Precision>,
    /// Error of a sample relative to the amplitudes.
    pub tolerance: Option<f64>,
}

impl Engine {
    /// An engine without results. The radar must be valid ([`Radar::validate`]).
    pub fn new(radar: Radar) -> Self {
        let (forced, amplitudes) = (PlanOverrides::default(), Amplitudes::default());
        Engine { radar, forced, single: None, double: None, last: None, shown: None, settled: None, amplitudes }
    }

    /// Overrides the planner's choices and drops every cache.
    pub fn force(&mut self, forced: PlanOverrides) {
        self.forced = forced;
        self.forget();
    }

    /// Drops all results of the last scene, but keeps their memory; the next update starts from scratch.
    pub fn forget(&mut self) {
        self.settled = None;
        self.amplitudes.forget();
        self.shown.iter_mut().for_each(|shown| shown.forget(&self.radar));
        self.single.iter_mut().for_each(Bank::forget);
        self.double.iter_mut().for_each(Bank::forget);
    }

    pub fn radar(&self) -> &Radar {
        &self.radar
    }

    /// Range profile of one element after the last update, `[range bins]`, without the floor; `None` if there is none.
    pub fn range_profile(&self, element: usize) -> Option<Vec<Complex64>> {
        match self.last? {
            Precision::F32 => self.single.as_ref()?.profile(element),
            Precision::F64 => self.double.as_ref()?.profile(element),
        }
    }

    pub fn cache_bytes(&self) -> usize {
        let banks = self.single.as_ref().map_or(0, Bank::bytes) + self.double.as_ref().map_or(0, Bank::bytes);
        let cells = self.radar.samples * self.radar.elements * size_of::<f32>();
        let kept = |s: &ShownMaps| s.decades.iter().flatten().count() + s.maps.iter().flatten().count() + s.spare.len();
        let shown = self.shown.as_ref().map_or(0, kept);
        // Decades in f64 and Lambda in f32.
        let settled = self.settled.as_ref().map_or(0, SettledMaps::maps) * 3;
        banks + (shown + settled) * cells
    }

    /// The wanted maps and samples of `scene`. Unchanged ones are the same `Arc` as in the last call. A settled scene stays settled. A scene with disturbances
    /// is always settled, since it isn't the sum of its objects, and so is one with focused maps.
    /// # Errors
    /// [`SceneError`] when the scene can't be simulated. The engine stays usable.
    pub fn update(&mut self, scene: &Scene, wanted: &MapRequest) -> Result<EngineFrame, SceneError> {
        self.update_for(&Task::default(), scene, wanted).map_err(SimulationError::of_scene)
    }

    /// [`Engine::update`] that `task` can cancel. After that, the next update starts from scratch.
    /// # Errors
    /// [`SimulationError`] when the scene can't be simulated, and soon after the task was cancelled. The engine stays usable.
    pub fn update_for(&mut self, task: &Task, scene: &Scene, wanted: &MapRequest) -> SimulationResult<EngineFrame> {
        let begin = Instant::now();
        let is_focused = self.radar.focus_off_line && !self.radar.is_on_line();
        if is_focused || !scene.disturbances.is_none_to(&self.radar) {
            return self.settle_for(task, scene, wanted);
        }
        scene.validate(&self.radar)?;
        self.settled = self.settled.take().filter(|settled| settled.has(scene, wanted));
        let mut frame = match &mut self.settled {
            Some(settled) => settled.frame(wanted, EngineReport::default()),
            None => self.follow(task, scene, wanted)?,
        };
        frame.report.total = begin.elapsed();
        Ok(frame)
    }

    /// The wanted maps and samples of `scene` by [`crate::signal::simulate`] and the plain transforms in f64, as a command computes them: the same bits after
    /// any earlier scene. It takes several times longer than an update. For scenes at rest, and for figures.
    /// # Errors
    /// [`SceneError`] when the scene can't be simulated. The engine stays usable.
    pub fn settle(&mut self, scene: &Scene, wanted: &MapRequest) -> Result<EngineFrame, SceneError> {
        self.settle_for(&Task::default(), scene, wanted).map_err(SimulationError::of_scene)
    }

    /// [`Engine::settle`] that `task` can cancel. Later updates are not affected.
    /// # Errors
    /// [`SimulationError`] when the scene can't be simulated, and soon after the task was cancelled. The engine stays usable.
    pub fn settle_for(&mut self, task: &Task, scene: &Scene, wanted: &MapRequest) -> SimulationResult<EngineFrame> {
        let begin = Instant::now();
        let mut report = EngineReport::default();
        let settled = match self.settled.take().filter(|settled| settled.has(scene, wanted)) {
            Some(settled) => settled,
            None => SettledMaps::of(task, &self.radar, scene, wanted, &mut report)?,
        };
        let mut frame = self.settled.insert(settled).frame(wanted, report);
        frame.report.total = begin.elapsed();
        Ok(frame)
    }

    fn follow(&mut self, task: &Task, scene: &Scene, wanted: &MapRequest) -> SimulationResult<EngineFrame> {
        let mut report = EngineReport::default();
        let visible = wanted.visible();
        let mut shown = self.recall(scene, wanted);
        if wanted.ends && shown.ends.is_none() {
            let start = Instant::now();
            shown.ends = Some(Arc::new(simulate_ends_for(task, &self.radar, scene, wanted.floor, wanted.seed)?));
            report.computed(EngineStage::Ends, start.elapsed(), "summed at the two ends");
        } else {
            report.skipped(EngineStage::Ends, if wanted.ends { "the scene did not change" } else { "not looked at" });
        }
        let missing = [0, 1, 2].map(|i| visible[i] && !shown.current[i]);
        if missing.contains(&true) {
            self.compute(task, scene, wanted, missing, &mut shown, &mut report)?;
        } else {
            report.skipped(EngineStage::Signal, "the scene did not change");
            report.skipped(EngineStage::Noise, "the scene did not change");
        }
        for i in (0..3).filter(|i| !missing[*i]) {
            report.skipped(EngineStage::MAPS[i], if visible[i] { "the scene did not change" } else { "not looked at" });
        }
        shown.normalise(visible, missing, wanted.normalisation, &mut report);

        let map = |i: usize| shown.maps[i].clone().filter(|_| visible[i]);
        let (first, last, full) = (map(0), map(1), map(2));
        let ends = shown.ends.clone().filter(|_| wanted.ends);
        self.shown = Some(shown);
        Ok(EngineFrame { first, last, full, ends, settled: false, report })
    }

    fn tolerance(&self, wanted: &MapRequest) -> f64 {
        self.forced.tolerance.unwrap_or_else(|| tolerance::tolerance_for(wanted.floor, wanted.normalisation))
    }

    /// The maps of the last frame, if they are accurate enough for `wanted`; otherwise only their buffers.
    fn recall(&mut self, scene: &Scene, wanted: &MapRequest) -> ShownMaps {
        let tolerance = self.tolerance(wanted);
        // Maps accurate enough for a fixed range may show rounding when normalised by their minimum.
        let nothing = SumSize { algorithm: Algorithm::Split, reflectors: 0, amplitude: 0.0 };
        let trap = self.last == Some(Precision::F32)
            && tolerance::refusal(Precision::F32, &nothing, wanted.floor, wanted.normalisation).is_some();
        let same = |s: &ShownMaps| !trap && s.tolerance <= tolerance && s.of.is(scene, wanted);
        match self.shown.take() {
            Some(shown) if same(&shown) => shown,
            other => ShownMaps::of(scene, wanted, tolerance, other),
        }
    }

    fn compute(
        &mut self,
        task: &Task,
        scene: &Scene,
        wanted: &MapRequest,
        missing: [bool; 3],
        shown: &mut ShownMaps,
        report: &mut EngineReport,
    ) -> Result<(), Cancelled> {
        let seen = ObjectWithOccluders::all(&self.radar, scene);
        let amplitude = self.amplitudes.bound(&self.radar, &seen);
        let mut chosen = SynthesisPlan::cheapest(scene.echo_count(), amplitude, self.tolerance(wanted));
        let refusal = self.forced.precision.and_then(|forced| {
            let algorithm = self.forced.algorithm.unwrap_or(chosen.algorithm);
            let sum = SumSize { algorithm, reflectors: scene.echo_count(), amplitude };
            let refusal = tolerance::refusal(forced, &sum, wanted.floor, wanted.normalisation);
            chosen.precision = if refusal.is_some() { Precision::F64 } else { forced };
            refusal
        });
        let (radar, forced) = (&self.radar, self.forced.algorithm);
        let job = BankUpdate { task, radar, scene, seen: &seen, wanted, plan: chosen, forced, amplitude, missing };
        if self.last.replace(chosen.precision) != Some(chosen.precision) {
            // The shown maps were summed by the other bank.
            shown.decades.iter_mut().flatten().for_each(|kept| kept.stale = Rows::all(radar.samples));
        }
        let maps = &mut shown.decades;
        match chosen.precision {
            Precision::F32 => self.single.get_or_insert_with(|| Bank::new(radar)).run(&job, maps, report)?,
            Precision::F64 => self.double.get_or_insert_with(|| Bank::new(radar)).run(&job, maps, report)?,
        }
        if let Some(why) = refusal {
            report.remark(EngineStage::Signal, why);
        }
        shown.current = [0, 1, 2].map(|i| shown.current[i] || missing[i]);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
