//! The incremental engine, without threads: whoever owns it decides where it runs.
//!
//! The signal is a sum over objects. The engine keeps the range profiles of the objects at rest and, apart, of those being
//! edited: dragging one of many objects evaluates that one alone. Taking an object out of the sum at rest leaves rounding behind;
//! how much is bounded as it goes, and the sum is made afresh before it could show.

use super::bank::{Bank, Job, Kept};
use super::{Frame, LiveMap, Report, Stage, Wanted};
use crate::maps::fast::{Decades, normalise_into};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{End, Radar};
use crate::scene::{Object, Reflector, Scene, SceneError};
use crate::signal::plan::{self, Algorithm, Precision, Recipe};
use crate::signal::simd::{LANES_F32, LANES_F64};
use crate::signal::synthesis::Synthesis;
use crate::signal::{Floor, Rows, TwoEnds, floor};
use ndarray::Array2;
use num_complex::Complex64;
use std::sync::Arc;
use std::time::Instant;

/// The stages of the three maps, in the order of every triple of maps.
pub(super) const STAGES: [Stage; 3] = [Stage::FirstMap, Stage::LastMap, Stage::FullMap];

/// Keeps what it computed for one radar and recomputes only what a change touches.
pub struct Engine {
    radar: Radar,
    forced: Forced,
    single: Option<Bank<f32, LANES_F32>>,
    double: Option<Bank<f64, LANES_F64>>,
    /// The precision of the last maps.
    last: Option<Precision>,
    shown: Option<Shown>,
}

/// Choices taken from the planner; `None` leaves them to it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forced {
    /// Algorithm for every sum; [`Algorithm::Direct`] and [`Algorithm::Exact`] have no fast path and are evaluated by phasor split.
    pub algorithm: Option<Algorithm>,
    /// Precision; where single precision would show its rounding as the picture, double is used and the report says so ([`plan::refusal`]).
    pub precision: Option<Precision>,
    /// Error of a sample relative to the amplitudes.
    pub tolerance: Option<f64>,
}

/// What the last frame showed, and for which scene.
struct Shown {
    objects: Vec<Object>,
    floor: Floor,
    seed: u64,
    tolerance: f64,
    normalisation: Normalisation,
    ends: Option<Arc<TwoEnds>>,
    decades: [Option<Kept>; 3],
    /// Which of `decades` show these objects.
    current: [bool; 3],
    maps: [Option<LiveMap>; 3],
    /// Buffers of earlier maps, reused once nobody else holds them.
    spare: Vec<Arc<RangeAngleMap>>,
}

impl Engine {
    /// An engine that has computed nothing yet. The radar must be valid ([`Radar::validate`]).
    pub fn new(radar: Radar) -> Self {
        Engine { radar, forced: Forced::default(), single: None, double: None, last: None, shown: None }
    }

    /// Takes choices from the planner and drops every cache.
    pub fn force(&mut self, forced: Forced) {
        self.forced = forced;
        self.forget();
    }

    /// Forgets everything that was computed of the last scene, but keeps the memory it lay in: the next update starts from scratch.
    pub fn forget(&mut self) {
        if let Some(shown) = &mut self.shown {
            shown.forget(&self.radar);
        }
        if let Some(bank) = &mut self.single {
            bank.forget();
        }
        if let Some(bank) = &mut self.double {
            bank.forget();
        }
    }

    /// The radar it simulates.
    pub fn radar(&self) -> &Radar {
        &self.radar
    }

    /// Range profile of one element as the last update left it, `[range bins]`, without the floor; `None` if it computed none.
    pub fn range_profile(&self, element: usize) -> Option<Vec<Complex64>> {
        match self.last? {
            Precision::F32 => self.single.as_ref()?.profile(element),
            Precision::F64 => self.double.as_ref()?.profile(element),
        }
    }

    /// Largest difference between the range profiles that two engines hold, relative to the other's largest cell; `None` if either
    /// computed none.
    pub fn profile_difference(&self, other: &Engine) -> Option<f64> {
        let (mut worst, mut peak) = (0.0f64, 0.0f64);
        for element in 0..self.radar.elements {
            for (a, b) in self.range_profile(element)?.iter().zip(other.range_profile(element)?) {
                worst = worst.max((a - b).norm());
                peak = peak.max(b.norm());
            }
        }
        Some(if worst == 0.0 { 0.0 } else { worst / peak })
    }

    /// Bytes held in caches.
    pub fn cache_bytes(&self) -> usize {
        let banks = self.single.as_ref().map_or(0, Bank::bytes) + self.double.as_ref().map_or(0, Bank::bytes);
        let cells = self.radar.samples * self.radar.elements * size_of::<f32>();
        let shown = self
            .shown
            .as_ref()
            .map_or(0, |s| s.decades.iter().flatten().count() + s.maps.iter().flatten().count() + s.spare.len());
        banks + shown * cells
    }

    /// Computes what is wanted of `scene`; what did not change since the last call is the same `Arc` as then.
    ///
    /// # Errors
    /// [`SceneError`] when the scene can't be simulated. The engine stays usable.
    pub fn update(&mut self, scene: &Scene, wanted: &Wanted) -> Result<Frame, SceneError> {
        let begin = Instant::now();
        let mut report = Report::default();
        scene.validate(&self.radar)?;
        let visible = [wanted.first, wanted.last, wanted.full];
        let tolerance =
            self.forced.tolerance.unwrap_or_else(|| plan::tolerance_for(wanted.floor, wanted.normalisation));

        // Maps that are fine at a fixed range may be a trap when normalised by their minimum.
        let nothing = plan::Sum { algorithm: Algorithm::Split, reflectors: 0, amplitude: 0.0 };
        let trap = self.last == Some(Precision::F32)
            && plan::refusal(Precision::F32, &nothing, wanted.floor, wanted.normalisation).is_some();
        let same = |s: &Shown| {
            s.objects == scene.objects
                && s.floor == wanted.floor
                && s.seed == wanted.seed
                && s.tolerance <= tolerance
                && !trap
        };
        let mut shown = match self.shown.take() {
            Some(shown) if same(&shown) => shown,
            other => Shown::of(scene, wanted, tolerance, other),
        };
        if wanted.ends && shown.ends.is_none() {
            let start = Instant::now();
            shown.ends = Some(Arc::new(ends(&self.radar, &scene.reflectors(), wanted)));
            report.computed(Stage::Ends, start.elapsed(), "summed at the two ends");
        } else {
            report.skipped(Stage::Ends, if wanted.ends { "the scene did not change" } else { "not looked at" });
        }

        let missing = [0, 1, 2].map(|i| visible[i] && !shown.current[i]);
        if missing.contains(&true) {
            let amplitude = scene_amplitude(&self.radar, scene);
            let mut recipe = Recipe::plan(scene.reflector_count(), amplitude, tolerance);
            let refusal = self.forced.precision.and_then(|forced| {
                let algorithm = self.forced.algorithm.unwrap_or(recipe.algorithm);
                let sum = plan::Sum { algorithm, reflectors: scene.reflector_count(), amplitude };
                let refusal = plan::refusal(forced, &sum, wanted.floor, wanted.normalisation);
                recipe.precision = if refusal.is_some() { Precision::F64 } else { forced };
                refusal
            });
            let job =
                Job { radar: &self.radar, scene, wanted, recipe, forced: self.forced.algorithm, amplitude, missing };
            if self.last.replace(recipe.precision) != Some(recipe.precision) {
                // What the maps show was summed by the other bank.
                shown.decades.iter_mut().flatten().for_each(|kept| kept.stale = Rows::all(self.radar.samples));
            }
            let (maps, report) = (&mut shown.decades, &mut report);
            match recipe.precision {
                Precision::F32 => self.single.get_or_insert_with(|| Bank::new(&self.radar)).run(&job, maps, report),
                Precision::F64 => self.double.get_or_insert_with(|| Bank::new(&self.radar)).run(&job, maps, report),
            }
            if let Some(why) = refusal {
                report.remark(Stage::Signal, why);
            }
            shown.current = [0, 1, 2].map(|i| shown.current[i] || missing[i]);
        } else {
            report.skipped(Stage::Signal, "the scene did not change");
            report.skipped(Stage::Noise, "the scene did not change");
        }
        for i in 0..3 {
            if !missing[i] {
                report.skipped(STAGES[i], if visible[i] { "the scene did not change" } else { "not looked at" });
            }
        }
        shown.normalise(visible, missing, wanted.normalisation, &mut report);

        let map = |i: usize| shown.maps[i].clone().filter(|_| visible[i]);
        let (first, last, full) = (map(0), map(1), map(2));
        let ends = shown.ends.clone().filter(|_| wanted.ends);
        self.shown = Some(shown);
        report.total = begin.elapsed();
        Ok(Frame { first, last, full, ends, report })
    }
}

impl Shown {
    /// Nothing yet of a new scene; buffers come from what was shown before.
    fn of(scene: &Scene, wanted: &Wanted, tolerance: f64, before: Option<Shown>) -> Self {
        let (mut spare, mut decades) = (Vec::new(), [None, None, None]);
        if let Some(before) = before {
            (spare, decades) = (before.spare, before.decades);
            spare.extend(before.maps.into_iter().flatten().map(|m| m.lambda));
            // Whoever looks at the previous frame holds three; three more are in the making.
            let excess = spare.len().saturating_sub(6);
            spare.drain(..excess);
        }
        Shown {
            objects: scene.objects.clone(),
            floor: wanted.floor,
            seed: wanted.seed,
            tolerance,
            normalisation: wanted.normalisation,
            ends: None,
            decades,
            current: [false; 3],
            maps: [None, None, None],
            spare,
        }
    }

    /// Holds nothing of any scene any more but buffers: no update is content with this tolerance.
    fn forget(&mut self, radar: &Radar) {
        self.tolerance = f64::INFINITY;
        self.decades.iter_mut().flatten().for_each(|kept| kept.stale = Rows::all(radar.samples));
    }

    /// Lambda of every visible map that is new or normalised another way than before.
    fn normalise(&mut self, visible: [bool; 3], missing: [bool; 3], normalisation: Normalisation, report: &mut Report) {
        let start = Instant::now();
        if self.normalisation != normalisation {
            self.spare.extend(self.maps.iter_mut().filter_map(Option::take).map(|m| m.lambda));
            self.normalisation = normalisation;
        }
        let mut made: Vec<(usize, &Decades, Arc<RangeAngleMap>)> = Vec::new();
        for i in 0..3 {
            let Some(Kept { decades, .. }) = self.decades[i].as_ref().filter(|_| visible[i]) else { continue };
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
            self.maps[i] = Some(LiveMap { lambda, scale: decades.scale(normalisation) });
        }
        match count {
            0 => report.skipped(Stage::Normalise, "unchanged"),
            _ => report.computed(Stage::Normalise, start.elapsed(), format!("{count} maps")),
        }
    }
}

/// Samples of both ends over their floor, summed there alone.
fn ends(radar: &Radar, reflectors: &[Reflector], wanted: &Wanted) -> TwoEnds {
    let amplitude = plan::amplitude_bound(radar, reflectors);
    let recipe = Recipe::plan(reflectors.len(), amplitude, plan::BEST_TOLERANCE);
    let synthesis = Synthesis::<f64, LANES_F64>::new(radar, recipe);
    let variance = match wanted.floor {
        Floor::Thesis => Some(floor::thesis_noise_variance(radar, reflectors)),
        Floor::Exact => None,
        Floor::Snr(snr) => Some(floor::snr_noise_variance(radar, reflectors, snr)),
    };
    let [first, last] = End::BOTH.map(|end| {
        let elements = radar.end_range(end);
        let mut samples = synthesis.samples(reflectors, elements.clone());
        if let Some(variance) = &variance {
            floor::add_noise_from(&mut samples, elements.start, &variance[elements], wanted.seed);
        }
        samples
    });
    TwoEnds { first, last }
}

fn scene_amplitude(radar: &Radar, scene: &Scene) -> f64 {
    scene.objects.iter().map(|o| plan::amplitude_bound(radar, &o.reflectors())).sum()
}

#[cfg(test)]
mod tests;
