//! The sums that the engine keeps in one precision: range profiles of the objects at rest and of those being edited.

use super::change::SceneChange;
use super::{EngineReport, EngineStage, MapRequest};
use crate::maps::fast::{FastLogMap, MapMaker, MapNoise, MapSources, silence_decades};
use crate::platform::Instant;
use crate::radar::{Radar, counted};
use crate::scattering::{EchoSources, ObjectWithOccluders};
use crate::scene::Scene;
use crate::signal::simd::{Lanes, Real, Simd};
use crate::signal::synthesis::{BlockProfiles, Synthesis, unit_noise_profiles};
use crate::signal::{Algorithm, Floor, Rows, SynthesisPlan, floor, plan};
use crate::task::{Cancelled, Task};
use num_complex::Complex64;

pub(super) struct BankUpdate<'a> {
    pub task: &'a Task,
    pub radar: &'a Radar,
    pub scene: &'a Scene,
    /// Objects of the scene, each with those that hide it.
    pub seen: &'a [ObjectWithOccluders],
    pub wanted: &'a MapRequest,
    pub plan: SynthesisPlan,
    pub forced: Option<Algorithm>,
    pub amplitude: f64,
    pub missing: [bool; 3],
}

impl BankUpdate<'_> {
    fn counted(&self, count: usize) -> String {
        let [one, many] = if self.scene.has_bodies() { ["echo", "echoes"] } else { ["reflector", "reflectors"] };
        counted(count, one, many)
    }

    /// Ten standard deviations of a floor with a level of its own, 0 for the others. Only over such a floor can all echoes lie far below the noise.
    fn noise_amplitude(&self) -> f64 {
        self.wanted.floor.level_variance(self.radar).map_or(0.0, |variance| 10.0 * variance.sqrt())
    }

    /// Half the mean amplitude of the scene's echoes. The error of each echo may be the tolerance times this amplitude, even if the echo is
    /// weaker. The error of the sum grows by half at most. [`Group::quiet`] may be twice as large.
    fn quiet(&self) -> f64 {
        let half = 0.5 * self.amplitude / self.scene.echo_count().max(1) as f64;
        if half.is_finite() { half } else { 0.0 }
    }

    /// Two bounds of the amplitudes of objects that leave the sum. The first is of their echoes. The second counts every echo as at least three quarters of
    /// [`BankUpdate::quiet`], since the error of a weak echo does not shrink with it. Its error is a quarter of the tolerance times twice `quiet` from the
    /// addition, and times `quiet` from the subtraction.
    fn leaving(&self, objects: &[ObjectWithOccluders]) -> [f64; 2] {
        let bounds = plan::amplitude_bounds(self.radar, objects.iter());
        let counted = objects.iter().zip(&bounds).map(|(one, bound)| {
            let (count, least) = (one.echo_count() as f64, 0.75 * self.quiet());
            // At least one of the echoes has the mean amplitude.
            bound + least * if *bound >= least * count { (count - 1.0).max(0.0) } else { count }
        });
        [bounds.iter().sum(), counted.sum()]
    }

    fn made(&self, rows: &Rows, over_noise: bool) -> String {
        let all = self.radar.samples;
        match rows.count() {
            made if made == all && over_noise => match self.wanted.floor {
                floor if floor.has_level() => format!("{all} rows: noise lies in each"),
                _ => format!("{all} rows: the floor's level follows the scene"),
            },
            made if made == all => format!("{all} rows"),
            some => {
                format!("{some} of {all} rows, the others changed by less than {:.0e} of the peak", self.plan.tolerance)
            }
        }
    }
}

pub(super) struct KeptDecades {
    pub decades: FastLogMap,
    /// Rows that differ from the sums.
    pub stale: Rows,
    over_noise: bool,
    /// Decades of silent cells.
    silence: f32,
}

impl KeptDecades {
    fn silence(radar: &Radar) -> Self {
        let (decades, stale) = (FastLogMap::silence(radar), Rows::all(radar.samples));
        KeptDecades { decades, stale, over_noise: false, silence: f32::NAN }
    }
}

/// Objects that are summed together, and their range profiles.
pub(super) struct Group<T, const W: usize> {
    objects: Vec<ObjectWithOccluders>,
    pub(super) profiles: BlockProfiles<T, W>,
    /// Largest [`BankUpdate::quiet`] that any of the objects was summed with, where quiet echoes have few rows.
    quiet: f64,
    variance: Option<Vec<f64>>,
}

impl<T: Real, const W: usize> Group<T, W> {
    fn empty(radar: &Radar) -> Self {
        Group { objects: Vec::new(), profiles: BlockProfiles::silence(radar), quiet: 0.0, variance: None }
    }

    fn fill(&mut self, synthesis: &Synthesis<T, W>, objects: &[ObjectWithOccluders], job: &BankUpdate<'_>) {
        let echoing = EchoSources::of_objects(job.radar, objects);
        synthesis.range_profiles_beside(&echoing, job.quiet(), &mut self.profiles, job.task);
        // The other algorithms treat quiet echoes as all others.
        let has_few_rows = synthesis.plan().algorithm == Algorithm::ClosedForm;
        self.quiet = if has_few_rows { job.quiet() } else { 0.0 };
        self.variance = None;
        self.objects = objects.to_vec();
    }

    fn variance(&mut self, radar: &Radar) -> &[f64] {
        let objects = &self.objects;
        self.variance
            .get_or_insert_with(|| floor::thesis_noise_variance(radar, &EchoSources::of_objects(radar, objects)))
    }

    fn clear(&mut self) {
        self.objects.clear();
        self.profiles.clear();
        self.quiet = 0.0;
        self.variance = None;
    }

    fn add(&mut self, other: &Self, sign: f64) {
        self.profiles.add(&other.profiles, sign);
        self.quiet = self.quiet.max(other.quiet);
        match (&mut self.variance, &other.variance) {
            (Some(own), Some(other)) => own.iter_mut().zip(other).for_each(|(a, b)| *a = (*a + sign * b).max(0.0)),
            (own, _) => *own = None,
        }
    }
}

pub(super) struct Bank<T: Real, const W: usize> {
    maker: MapMaker<T, W>,
    syntheses: Vec<Synthesis<T, W>>,
    pub(super) rest: Group<T, W>,
    pub(super) active: Group<T, W>,
    leaving: Group<T, W>,
    built: Option<Built>,
    noise: Option<(u64, BlockProfiles<T, W>)>,
}

struct Built {
    tolerance: f64,
    forced: Option<Algorithm>,
    /// Bound of the rounding left by additions and subtractions, in units of amplitude.
    rounding: f64,
}

impl<T: Real, const W: usize> Bank<T, W> {
    pub fn new(radar: &Radar) -> Self {
        let [rest, active, leaving] = [(); 3].map(|()| Group::empty(radar));
        let (maker, syntheses) = (MapMaker::new(radar, Simd::chosen()), Vec::new());
        Bank { maker, syntheses, rest, active, leaving, built: None, noise: None }
    }

    pub fn forget(&mut self) {
        self.built = None;
    }

    pub fn profile(&self, element: usize) -> Option<Vec<Complex64>> {
        let (rest, active) = (self.rest.profiles.profile(element)?, self.active.profiles.profile(element)?);
        Some(rest.into_iter().zip(active).map(|(a, b)| a + b).collect())
    }

    pub fn bytes(&self) -> usize {
        let one = size_of_val(self.rest.profiles.cells.as_slice());
        one * (3 + usize::from(self.noise.is_some()))
    }

    fn synthesis(&mut self, job: &BankUpdate<'_>, count: usize) -> usize {
        let mut plan = SynthesisPlan::cheapest(count, job.amplitude, job.plan.tolerance);
        if job.wanted.floor == Floor::Exact {
            plan = plan.on_few_rows(job.radar, count);
        }
        plan.precision = job.plan.precision;
        plan.algorithm = job.forced.unwrap_or(plan.algorithm);
        match self.syntheses.iter().position(|s| *s.plan() == plan) {
            Some(found) => found,
            None => {
                if self.syntheses.len() >= 4 {
                    self.syntheses.remove(0);
                }
                self.syntheses.push(Synthesis::new(job.radar, plan));
                self.syntheses.len() - 1
            }
        }
    }

    /// Updates the missing maps of the job to its scene, row by row where only few rows changed.
    /// # Errors
    /// [`Cancelled`]: the sums are dropped, and `maps` can't be used.
    pub fn run(
        &mut self,
        job: &BankUpdate<'_>,
        maps: &mut [Option<KeptDecades>; 3],
        report: &mut EngineReport,
    ) -> Result<(), Cancelled> {
        let start = Instant::now();
        let (what, changed) = self.follow(job);
        job.task.check().inspect_err(|_| self.forget())?;
        report.computed(EngineStage::Signal, start.elapsed(), what);

        let start = Instant::now();
        let deviation = self.deviation(job);
        match &deviation {
            Some(_) => report.computed(EngineStage::Noise, start.elapsed(), format!("{} floor", job.wanted.floor)),
            None => report.skipped(EngineStage::Noise, "there is no floor"),
        }

        let start = Instant::now();
        let noise = match (&self.noise, &deviation) {
            (Some((_, unit)), Some(deviation)) => Some(MapNoise { unit, deviation }),
            _ => None,
        };
        let gain = (job.radar.samples as f64 * job.radar.elements as f64).sqrt();
        let bound = gain * (job.amplitude + job.noise_amplitude());
        let silence = silence_decades(bound);
        let mut rows = Rows::none(job.radar.samples);
        for (kept, missing) in maps.iter_mut().zip(job.missing) {
            if missing {
                kept.get_or_insert_with(|| KeptDecades::silence(job.radar));
            }
            let Some(kept) = kept else { continue };
            kept.stale.extend(&changed);
            // The level of most noise follows the scene, so that every row changes.
            if noise.is_some() || kept.over_noise || kept.silence != silence {
                kept.stale = Rows::all(job.radar.samples);
            }
            if missing {
                (kept.over_noise, kept.silence) = (noise.is_some(), silence);
                rows.extend(&std::mem::replace(&mut kept.stale, Rows::none(job.radar.samples)));
            }
        }
        let profiles = [&self.rest.profiles, &self.active.profiles];
        let mut made = maps.each_mut().map(|kept| kept.as_mut().map(|k| &mut k.decades));
        for (made, missing) in made.iter_mut().zip(job.missing) {
            *made = made.take().filter(|_| missing);
        }
        self.maker.fill(MapSources { profiles: &profiles, noise, bound }, made, &rows);

        let took = start.elapsed();
        let count = job.missing.iter().filter(|m| **m).count() as u32;
        let what = job.made(&rows, noise.is_some());
        for (stage, _) in EngineStage::MAPS.into_iter().zip(job.missing).filter(|(_, missing)| *missing) {
            report.computed(stage, took / count, what.as_str());
        }
        Ok(())
    }

    /// Updates the two groups to the scene. Returns a description for the report, and the rows that may have changed.
    fn follow(&mut self, job: &BankUpdate<'_>) -> (String, Rows) {
        let scene = job.seen;
        let total = job.scene.echo_count();
        let limit = job.amplitude * (job.plan.tolerance / 2.0).max(4.0 * T::EPSILON);
        let usable = self.built.as_ref().filter(|b| b.tolerance <= job.plan.tolerance && b.forced == job.forced);
        // After a strong object has left, the others' errors of summation are too large.
        let usable = usable.filter(|_| self.rest.quiet <= 2.0 * job.quiet());
        let change = usable.map(|built| {
            let change = SceneChange::between(&self.rest.objects, &self.active.objects, scene);
            let more = if !change.settles {
                0.0
            } else {
                // The objects are subtracted by another algorithm than they were added by.
                let [leaving, counted] = job.leaving(&change.leaving);
                2.0 * T::EPSILON * (job.amplitude + leaving) + job.plan.tolerance * counted
            };
            let rounding = built.rounding + more;
            (change, rounding, rounding <= limit)
        });
        match change {
            Some((change, _, true)) if !change.settles && change.arriving == self.active.objects => {
                ("as before".to_owned(), Rows::none(job.radar.samples))
            }
            Some((change, rounding, true)) if change.cost() < total.max(1) => {
                let evaluated = change.cost();
                let mut changed = self.active.profiles.touched.clone();
                if change.settles {
                    self.rest.add(&self.active, 1.0);
                }
                if !change.leaving.is_empty() {
                    let count = change.leaving.iter().map(ObjectWithOccluders::echo_count).sum();
                    let synthesis = self.synthesis(job, count);
                    self.leaving.fill(&self.syntheses[synthesis], &change.leaving, job);
                    self.rest.add(&self.leaving, -1.0);
                    changed.extend(&self.leaving.profiles.touched);
                }
                let count = change.arriving.iter().map(ObjectWithOccluders::echo_count).sum();
                let synthesis = self.synthesis(job, count);
                self.active.fill(&self.syntheses[synthesis], &change.arriving, job);
                if let Some(built) = &mut self.built {
                    built.rounding = rounding;
                }
                self.rest.objects = change.staying;
                changed.extend(&self.active.profiles.touched);
                let plan = self.syntheses[synthesis].plan();
                let how = format!("{} in {}", plan.algorithm, T::NAME);
                (format!("{evaluated} of {}, {how}, the others as before", job.counted(total)), changed)
            }
            // Moved bodies and the objects they hide stay apart from the sum at rest. They may be most of the scene, and will move again.
            Some((change, ..)) if job.scene.has_bodies() => self.build_anew(job, &change.staying, &change.arriving),
            _ => self.build_anew(job, job.seen, &[]),
        }
    }

    /// Sums `staying` at rest and `moving` apart from it; together they are the whole scene.
    fn build_anew(
        &mut self,
        job: &BankUpdate<'_>,
        staying: &[ObjectWithOccluders],
        moving: &[ObjectWithOccluders],
    ) -> (String, Rows) {
        let total = job.scene.echo_count();
        let synthesis = self.synthesis(job, total);
        let mut changed = self.rest.profiles.touched.clone();
        changed.extend(&self.active.profiles.touched);
        self.active.clear();
        self.rest.fill(&self.syntheses[synthesis], staying, job);
        if !moving.is_empty() {
            self.active.fill(&self.syntheses[synthesis], moving, job);
            changed.extend(&self.active.profiles.touched);
        }
        changed.extend(&self.rest.profiles.touched);
        let (tolerance, forced) = (job.plan.tolerance, job.forced);
        self.built = Some(Built { tolerance, forced, rounding: 0.0 });
        let plan = self.syntheses[synthesis].plan();
        (format!("{} from scratch, {} in {}", job.counted(total), plan.algorithm, T::NAME), changed)
    }

    /// Standard deviation of the floor's noise at every element, in blocks of lanes; also makes the unit noise.
    fn deviation(&mut self, job: &BankUpdate<'_>) -> Option<Vec<Lanes<T, W>>> {
        let variance: Vec<f64> = match job.wanted.floor {
            Floor::Exact => return None,
            Floor::Thesis => {
                let (rest, active) = (self.rest.variance(job.radar), self.active.variance(job.radar));
                rest.iter().zip(active).map(|(a, b)| a + b).collect()
            }
            Floor::Snr(snr) => floor::snr_noise_variance(job.radar, &EchoSources::of_objects(job.radar, job.seen), snr),
            floor @ (Floor::Level(_) | Floor::Thermal) => vec![floor.level_variance(job.radar)?; job.radar.elements],
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
