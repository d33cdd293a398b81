//! The incremental engine, without threads: whoever owns it decides where it runs.
//!
//! The signal is a sum over objects. The engine keeps the range profiles of the objects at rest and, apart, of those being
//! edited: dragging one of many objects evaluates that one alone. Taking an object out of the sum at rest leaves rounding behind;
//! how much is bounded as it goes, and the sum is made afresh before it could show.

use super::{Frame, LiveMap, Report, Stage, Wanted};
use crate::maps::fast::{Decades, MapMaker, Noise, Sources};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{End, Radar};
use crate::scene::{Object, Reflector, Scene, SceneError};
use crate::signal::plan::{self, Algorithm, Precision, Recipe};
use crate::signal::simd::{LANES_F32, LANES_F64, Lanes, Real, Simd};
use crate::signal::synthesis::{BlockProfiles, Synthesis, unit_noise_profiles};
use crate::signal::{Floor, TwoEnds, floor};
use ndarray::Array2;
use num_complex::Complex64;
use std::sync::Arc;
use std::time::Instant;

const STAGES: [Stage; 3] = [Stage::FirstMap, Stage::LastMap, Stage::FullMap];

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
    /// Precision.
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
    decades: [Option<Decades>; 3],
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

    /// Drops everything that was computed of the last scene: the next update starts from scratch.
    pub fn forget(&mut self) {
        self.shown = None;
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

        let same = |s: &Shown| {
            s.objects == scene.objects && s.floor == wanted.floor && s.seed == wanted.seed && s.tolerance <= tolerance
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

        let missing = [0, 1, 2].map(|i| visible[i] && shown.decades[i].is_none());
        if missing.contains(&true) {
            let amplitude = scene_amplitude(&self.radar, scene);
            let mut recipe = Recipe::plan(scene.reflector_count(), amplitude, tolerance);
            recipe.precision = self.forced.precision.unwrap_or(recipe.precision);
            let job =
                Job { radar: &self.radar, scene, wanted, recipe, forced: self.forced.algorithm, amplitude, missing };
            self.last = Some(recipe.precision);
            match recipe.precision {
                Precision::F32 => {
                    self.single.get_or_insert_with(|| Bank::new(&self.radar)).run(
                        &job,
                        &mut shown.decades,
                        &mut report,
                    );
                }
                Precision::F64 => {
                    self.double.get_or_insert_with(|| Bank::new(&self.radar)).run(
                        &job,
                        &mut shown.decades,
                        &mut report,
                    );
                }
            }
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
        let mut spare = Vec::new();
        if let Some(before) = before {
            spare = before.spare;
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
            decades: [None, None, None],
            maps: [None, None, None],
            spare,
        }
    }

    /// Lambda of every visible map that is new or normalised another way than before.
    fn normalise(&mut self, visible: [bool; 3], missing: [bool; 3], normalisation: Normalisation, report: &mut Report) {
        let start = Instant::now();
        if self.normalisation != normalisation {
            self.spare.extend(self.maps.iter_mut().filter_map(Option::take).map(|m| m.lambda));
            self.normalisation = normalisation;
        }
        let mut count = 0;
        for i in 0..3 {
            let Some(decades) = self.decades[i].as_ref().filter(|_| visible[i]) else { continue };
            if self.maps[i].is_some() && !missing[i] {
                continue;
            }
            let free = self.spare.iter_mut().position(|a| Arc::get_mut(a).is_some());
            let mut lambda = match free {
                Some(free) => self.spare.swap_remove(free),
                None => Arc::new(RangeAngleMap { lambda: Array2::zeros(decades.cells.raw_dim()) }),
            };
            if let Some(lambda) = Arc::get_mut(&mut lambda) {
                decades.normalise_into(normalisation, lambda);
            }
            self.maps[i] = Some(LiveMap { lambda, scale: decades.scale(normalisation) });
            count += 1;
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

/// One update, as the caches see it.
struct Job<'a> {
    radar: &'a Radar,
    scene: &'a Scene,
    wanted: &'a Wanted,
    recipe: Recipe,
    forced: Option<Algorithm>,
    amplitude: f64,
    missing: [bool; 3],
}

/// Profiles of some objects, with the variance of their part of the thesis' floor.
struct Group<T, const W: usize> {
    objects: Vec<Object>,
    profiles: BlockProfiles<T, W>,
    variance: Vec<f64>,
}

impl<T: Real, const W: usize> Group<T, W> {
    fn empty(radar: &Radar) -> Self {
        Group { objects: Vec::new(), profiles: BlockProfiles::silence(radar), variance: vec![0.0; radar.elements] }
    }

    fn fill(&mut self, synthesis: &Synthesis<T, W>, radar: &Radar, objects: &[Object]) {
        let reflectors: Vec<Reflector> = objects.iter().flat_map(Object::reflectors).collect();
        synthesis.range_profiles(&reflectors, &mut self.profiles);
        self.variance = floor::thesis_noise_variance(radar, &reflectors);
        self.objects = objects.to_vec();
    }

    /// Adds (`sign` = 1) or takes away (-1) what another group holds, but for the list of objects.
    fn add(&mut self, other: &Self, sign: f64) {
        self.profiles.add(&other.profiles, sign);
        self.variance.iter_mut().zip(&other.variance).for_each(|(a, b)| *a = (*a + sign * b).max(0.0));
    }
}

/// Caches in one precision.
struct Bank<T: Real, const W: usize> {
    makers: MapMaker<T, W>,
    syntheses: Vec<Synthesis<T, W>>,
    /// Objects at rest.
    rest: Group<T, W>,
    /// Objects being edited.
    active: Group<T, W>,
    /// Where objects that leave the sum at rest are evaluated.
    leaving: Group<T, W>,
    built: Option<Built>,
    noise: Option<(u64, BlockProfiles<T, W>)>,
}

/// How the sum at rest was made.
struct Built {
    tolerance: f64,
    forced: Option<Algorithm>,
    /// Bound of the rounding that additions and subtractions have left, in units of amplitude.
    rounding: f64,
}

impl<T: Real, const W: usize> Bank<T, W> {
    fn new(radar: &Radar) -> Self {
        Bank {
            makers: MapMaker::new(radar, Simd::best()),
            syntheses: Vec::new(),
            rest: Group::empty(radar),
            active: Group::empty(radar),
            leaving: Group::empty(radar),
            built: None,
            noise: None,
        }
    }

    fn forget(&mut self) {
        self.built = None;
    }

    fn profile(&self, element: usize) -> Option<Vec<Complex64>> {
        let (rest, active) = (self.rest.profiles.profile(element)?, self.active.profiles.profile(element)?);
        Some(rest.into_iter().zip(active).map(|(a, b)| a + b).collect())
    }

    fn bytes(&self) -> usize {
        let one = size_of_val(self.rest.profiles.cells.as_slice());
        one * (3 + usize::from(self.noise.is_some()))
    }

    fn synthesis(&mut self, job: &Job<'_>, count: usize) -> usize {
        let mut recipe = Recipe::plan(count, job.amplitude, job.recipe.tolerance);
        recipe.precision = job.recipe.precision;
        recipe.algorithm = job.forced.unwrap_or(recipe.algorithm);
        match self.syntheses.iter().position(|s| *s.recipe() == recipe) {
            Some(found) => found,
            None => {
                if self.syntheses.len() >= 4 {
                    self.syntheses.remove(0);
                }
                self.syntheses.push(Synthesis::new(job.radar, recipe));
                self.syntheses.len() - 1
            }
        }
    }

    fn run(&mut self, job: &Job<'_>, decades: &mut [Option<Decades>; 3], report: &mut Report) {
        let start = Instant::now();
        let what = self.follow(job);
        report.computed(Stage::Signal, start.elapsed(), what);

        let start = Instant::now();
        let deviation = self.deviation(job);
        match &deviation {
            Some(_) => report.computed(Stage::Noise, start.elapsed(), format!("{} floor", job.wanted.floor)),
            None => report.skipped(Stage::Noise, "there is no floor"),
        }

        let start = Instant::now();
        let mut made = job.missing.map(|m| m.then(|| Decades::silence(job.radar)));
        let noise = match (&self.noise, &deviation) {
            (Some((_, unit)), Some(deviation)) => Some(Noise { unit, deviation }),
            _ => None,
        };
        let gain = (job.radar.samples as f64 * job.radar.elements as f64).sqrt();
        let profiles = [&self.rest.profiles, &self.active.profiles];
        let used: &[_] = match (self.rest.objects.is_empty(), self.active.objects.is_empty()) {
            (true, _) => &profiles[1..],
            (_, true) => &profiles[..1],
            _ => &profiles,
        };
        let silent = job.scene.reflector_count() == 0;
        if !silent {
            self.makers.fill(
                Sources { profiles: used, noise, bound: job.amplitude * gain },
                made.each_mut().map(Option::as_mut),
            );
        }
        let took = start.elapsed();
        let count = job.missing.iter().filter(|m| **m).count() as u32;
        for (i, made) in made.into_iter().enumerate() {
            if let Some(made) = made {
                decades[i] = Some(made);
                let what = if silent { "an empty scene".into() } else { format!("{} rows", job.radar.samples) };
                report.computed(STAGES[i], took / count, what);
            }
        }
    }

    /// Makes the two groups hold the scene; says how.
    fn follow(&mut self, job: &Job<'_>) -> String {
        let scene = &job.scene.objects;
        let total = job.scene.reflector_count();
        let limit = job.amplitude * (job.recipe.tolerance / 8.0).max(4.0 * T::EPSILON);
        let usable = self.built.as_ref().filter(|b| b.tolerance <= job.recipe.tolerance && b.forced == job.forced);
        let change = usable.and_then(|built| {
            let change = Change::between(&self.rest.objects, &self.active.objects, scene);
            let more = if change.leaving.is_empty() {
                0.0
            } else {
                2.0 * T::EPSILON * (job.amplitude + amplitude(job.radar, &change.leaving))
            };
            (built.rounding + more <= limit).then_some((change, built.rounding + more))
        });
        match change {
            Some((change, _)) if change.leaving.is_empty() && change.arriving == self.active.objects => {
                "as before".to_owned()
            }
            Some((change, rounding)) if change.cost() < total.max(1) => {
                let evaluated = change.cost();
                if !change.leaving.is_empty() {
                    // Everything comes to rest, then what changed is taken out.
                    self.rest.add(&self.active, 1.0);
                    let count = change.leaving.iter().map(Object::reflector_count).sum();
                    let synthesis = self.synthesis(job, count);
                    self.leaving.fill(&self.syntheses[synthesis], job.radar, &change.leaving);
                    self.rest.add(&self.leaving, -1.0);
                }
                let count = change.arriving.iter().map(Object::reflector_count).sum();
                let synthesis = self.synthesis(job, count);
                self.active.fill(&self.syntheses[synthesis], job.radar, &change.arriving);
                if let Some(built) = &mut self.built {
                    built.rounding = rounding;
                }
                self.rest.objects = change.staying;
                format!("{evaluated} of {total} reflectors, the others as before")
            }
            _ => {
                let synthesis = self.synthesis(job, total);
                self.rest.fill(&self.syntheses[synthesis], job.radar, scene);
                self.active.objects.clear();
                self.active.profiles.cells.fill(crate::signal::simd::ComplexLanes::zero());
                self.active.variance.fill(0.0);
                let (tolerance, forced) = (job.recipe.tolerance, job.forced);
                self.built = Some(Built { tolerance, forced, rounding: 0.0 });
                let recipe = self.syntheses[synthesis].recipe();
                format!("{total} reflectors from scratch, {} in {}", recipe.algorithm, T::NAME)
            }
        }
    }

    /// Standard deviation of the floor's noise at every element, in blocks; the unit noise is made ready too.
    fn deviation(&mut self, job: &Job<'_>) -> Option<Vec<Lanes<T, W>>> {
        let variance: Vec<f64> = match job.wanted.floor {
            Floor::Exact => return None,
            Floor::Thesis => self.rest.variance.iter().zip(&self.active.variance).map(|(a, b)| a + b).collect(),
            Floor::Snr(snr) => floor::snr_noise_variance(job.radar, &job.scene.reflectors(), snr),
        };
        let seed = job.wanted.seed;
        if self.noise.as_ref().is_none_or(|(s, _)| *s != seed) {
            self.noise = Some((seed, unit_noise_profiles(job.radar, seed)));
        }
        let of = |n: usize| T::of(variance.get(n).copied().unwrap_or(0.0).sqrt());
        let blocks = job.radar.elements.div_ceil(W);
        Some((0..blocks).map(|b| Lanes(std::array::from_fn(|i| of(b * W + i)))).collect())
    }
}

fn amplitude(radar: &Radar, objects: &[Object]) -> f64 {
    objects.iter().map(|o| plan::amplitude_bound(radar, &o.reflectors())).sum()
}

/// What has to be done so that two groups of objects become a scene.
struct Change {
    /// Stay in the sum at rest.
    staying: Vec<Object>,
    /// Are evaluated and taken out of the sum at rest, after the active ones were added to it. Empty if the active ones alone changed.
    leaving: Vec<Object>,
    /// Are evaluated and become the active ones.
    arriving: Vec<Object>,
}

impl Change {
    fn between(rest: &[Object], active: &[Object], scene: &[Object]) -> Change {
        // Both sums are unordered: compare the objects as multisets. Edits touch few of them, so that what is left to
        // search for after walking both lists in step is short.
        let mut unmatched: Vec<&Object> = Vec::new();
        let mut staying = Vec::with_capacity(rest.len());
        let mut arriving: Vec<Object> = Vec::new();
        let mut old = rest.iter().peekable();
        for object in scene {
            if old.peek().is_some_and(|o| *o == object) {
                old.next();
                staying.push(object.clone());
            } else if let Some(at) = unmatched.iter().position(|o| *o == object) {
                staying.push(unmatched.remove(at).clone());
            } else {
                // Skip ahead in the old list if the object is there.
                let ahead = old.clone().position(|o| o == object);
                match ahead {
                    Some(ahead) => {
                        unmatched.extend(old.by_ref().take(ahead));
                        old.next();
                        staying.push(object.clone());
                    }
                    None => arriving.push(object.clone()),
                }
            }
        }
        unmatched.extend(old);
        if unmatched.is_empty() {
            return Change { staying, leaving: Vec::new(), arriving };
        }
        // Something at rest changed: the active ones come to rest first, and those of them that are gone or changed leave too.
        let mut leaving: Vec<Object> = unmatched.into_iter().cloned().collect();
        for object in active {
            match arriving.iter().position(|o| o == object) {
                Some(at) => staying.push(arriving.remove(at)),
                None => leaving.push(object.clone()),
            }
        }
        Change { staying, leaving, arriving }
    }

    /// Reflectors to evaluate.
    fn cost(&self) -> usize {
        self.leaving.iter().chain(&self.arriving).map(Object::reflector_count).sum()
    }
}

#[cfg(test)]
mod tests;
