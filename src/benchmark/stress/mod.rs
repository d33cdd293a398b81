//! Numerical stress: scenes built to break numerics, by every algorithm in both precisions, and thousands of random edits.
//!
//! Behind `apertura stress` and `tests/library/stress.rs`. Nothing may be infinite or NaN, every algorithm must keep the error it promises, and
//! incremental sums must end where a fresh build does; [`StressReport::verdict`] says whether all of that holds.

mod edits;
mod scenes;

pub use edits::{EditReport, random_edits};
pub use scenes::{StressScene, all, moved_by_one_ulp};

use super::front::reference::{JudgedProfiles, SEED, UnitNoise, difference, maps_of, profile};
use super::front::{LambdaError, MapConvention};
use crate::engine::{Engine, Forced, MapRequest};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use crate::scene::{Reflector, Scene, SceneError};
use crate::signal::plan::{self, BEST_TOLERANCE};
use crate::signal::{Algorithm, Plan, Precision, beat_signal};
use serde::Serialize;

/// The plain algorithms, and the judge, take minutes for more reflectors than this on the whole radar.
const MOST_FOR_PLAIN: usize = 1000;
/// What the algorithms in single and in double precision are asked for.
const TOLERANCES: [(Precision, f64); 2] = [(Precision::F32, 1e-6), (Precision::F64, 1e-12)];
/// The process may grow by this much over the edits after the first twentieth: what allocators keep.
const MOST_GROWTH_BYTES: u64 = 16 << 20;
/// The conventions that maps are drawn in: the two that errors are given for, and the trap.
const CONVENTIONS: [MapConvention; 3] = [MapConvention::FIXED_RANGE, MapConvention::THESIS, MapConvention::NO_FLOOR];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StressRequest {
    /// Points of the scene in which many coincide.
    pub coincident: usize,
    pub edits: usize,
    pub seed: u64,
}

impl Default for StressRequest {
    fn default() -> Self {
        StressRequest { coincident: 10_000, edits: 10_000, seed: 2 }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StressCase {
    /// What is hard about the scene.
    pub scene: &'static str,
    pub reflectors: usize,
    pub algorithm: Algorithm,
    pub precision: Precision,
    /// Largest error of a range cell against the judge (every range bin of a few elements), relative to what the amplitudes could add up to.
    pub signal_error: f64,
    /// The error promised; none for [`Algorithm::Direct`], whose rounding is the thesis' own.
    pub tolerance: Option<f64>,
    /// Values that are infinite or NaN, in profiles and maps, and cells of Lambda outside [0, 1]; must be 0.
    pub not_finite: usize,
    /// How far Lambda changes when every reflector moves by the last bit of its x, in each convention.
    pub ulp_change: Vec<LambdaError>,
}

impl StressCase {
    pub fn holds(&self) -> bool {
        self.not_finite == 0 && self.tolerance.is_none_or(|t| self.signal_error <= t)
    }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StressReport {
    pub cases: Vec<StressCase>,
    /// Scenes that were refused with an error, as they must be, and what the error says.
    pub refused: Vec<(&'static str, String)>,
    pub edits: EditReport,
}

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum StressFailure {
    #[error("{scene}, {algorithm} in {precision}: {count} values are not finite; expected none")]
    NotFinite { scene: &'static str, algorithm: Algorithm, precision: Precision, count: usize },
    #[error("{scene}, {algorithm} in {precision}: error {error:.1e}; expected at most {tolerance:.0e}")]
    Inaccurate { scene: &'static str, algorithm: Algorithm, precision: Precision, error: f64, tolerance: f64 },
    #[error("{edits} edits end {difference:.1e} from a fresh build; expected at most {most:.1e}")]
    Drift { edits: usize, difference: f64, most: f64 },
    /// Memory grows: the engine's caches at all, or the process by more than allocators keep.
    #[error("{what} grew from {early} to {late} bytes over {edits} edits; expected no growth")]
    Memory { what: &'static str, early: u64, late: u64, edits: usize },
    /// A scene that should have been refused was not, or the other way round.
    #[error("{scene}: {what}")]
    Refusal { scene: &'static str, what: String },
}

impl StressReport {
    /// Whether everything held; the first thing that did not otherwise.
    ///
    /// Memory is that of the whole process: where it does other things meanwhile, [`StressReport::numbers`] is all that can be said.
    /// # Errors
    /// [`StressFailure`].
    pub fn verdict(&self) -> Result<(), StressFailure> {
        self.numbers()?;
        let EditReport { edits, resident_bytes_early, resident_bytes, .. } = self.edits;
        match resident_bytes_early.zip(resident_bytes) {
            Some((early, late)) if late > early + MOST_GROWTH_BYTES => {
                Err(StressFailure::Memory { what: "the process", early, late, edits })
            }
            _ => Ok(()),
        }
    }

    /// Whether every number is right, and the engine's caches don't grow.
    /// # Errors
    /// [`StressFailure`].
    pub fn numbers(&self) -> Result<(), StressFailure> {
        if let Some(c) = self.cases.iter().find(|c| !c.holds()) {
            let (scene, algorithm, precision) = (c.scene, c.algorithm, c.precision);
            return Err(match c.tolerance {
                Some(tolerance) if c.not_finite == 0 => {
                    StressFailure::Inaccurate { scene, algorithm, precision, error: c.signal_error, tolerance }
                }
                _ => StressFailure::NotFinite { scene, algorithm, precision, count: c.not_finite },
            });
        }
        let e = &self.edits;
        if e.worst_difference.is_nan() || e.worst_difference > e.most_difference {
            let (difference, most) = (e.worst_difference, e.most_difference);
            return Err(StressFailure::Drift { edits: e.edits, difference, most });
        }
        if e.cache_bytes > e.cache_bytes_early {
            let (early, late) = (e.cache_bytes_early as u64, e.cache_bytes as u64);
            return Err(StressFailure::Memory { what: "caches", early, late, edits: e.edits });
        }
        Ok(())
    }
}

/// Runs every scene by every algorithm on `radar`, and random edits on `small`. `progress` is called with the part that is done, 0 to 1.
///
/// Above a thousand reflectors the plain algorithms are left out: they take minutes.
/// # Errors
/// [`StressFailure::Refusal`] when a scene is refused that should not be, or the other way round.
pub fn run(
    radar: &Radar,
    small: &Radar,
    request: &StressRequest,
    mut progress: impl FnMut(f32),
) -> Result<StressReport, StressFailure> {
    let (mut cases, mut refused) = (Vec::new(), Vec::new());
    let scenes = all(radar, request.coincident);
    let steps = scenes.len() as f32 + 4.0;
    for (i, s) in scenes.iter().enumerate() {
        progress(i as f32 / steps);
        match (s.scene.validate(radar), s.refused) {
            (Ok(()), false) => {}
            (Err(error), true) => {
                refused.push((s.name, error.to_string()));
                continue;
            }
            (Ok(()), true) => {
                return Err(StressFailure::Refusal { scene: s.name, what: "was simulated; expected an error".into() });
            }
            (Err(error), false) => return Err(StressFailure::Refusal { scene: s.name, what: error.to_string() }),
        }
        for algorithm in Algorithm::ALL {
            if algorithm.is_fast() || s.scene.reflector_count() <= MOST_FOR_PLAIN {
                let case = scene_cases(radar, s, algorithm);
                cases.extend(case.map_err(|e| StressFailure::Refusal { scene: s.name, what: e.to_string() })?);
            }
        }
    }
    progress(scenes.len() as f32 / steps);
    let wanted = MapRequest { ends: false, ..MapRequest::default() };
    let edits = random_edits(small, &wanted, request.edits, request.seed)
        .map_err(|e| StressFailure::Refusal { scene: "random edits", what: e.to_string() })?;
    progress(1.0);
    Ok(StressReport { cases, refused, edits })
}

/// One scene by one algorithm, in every precision it has.
/// # Errors
/// [`SceneError`] when the radar can't see the scene.
pub fn scene_cases(radar: &Radar, scene: &StressScene, algorithm: Algorithm) -> Result<Vec<StressCase>, SceneError> {
    let judge = Judged::new(radar, &scene.scene);
    if !algorithm.is_fast() {
        return Ok(vec![plain_case(radar, scene, &judge, algorithm)]);
    }
    let case = |(precision, tolerance)| fast_case(radar, scene, &judge, algorithm, precision, tolerance);
    TOLERANCES.into_iter().map(case).collect()
}

struct Judged {
    reflectors: Vec<Reflector>,
    moved: Scene,
    profiles: JudgedProfiles,
    scale: f64,
}

impl Judged {
    fn new(radar: &Radar, scene: &Scene) -> Self {
        let reflectors = scene.reflectors();
        // Windowed and transformed, a reflector's profile peaks at (N - 1) / 2 / sqrt(N) times its amplitude.
        let gain = (radar.samples as f64 - 1.0) / 2.0 / (radar.samples as f64).sqrt();
        // Cells far below the logarithm's guard are beyond being wrong.
        let scale = gain * plan::amplitude_bound(radar, &reflectors).max(crate::maps::LOG_GUARD);
        let moved = moved_by_one_ulp(&reflectors);
        Judged { profiles: JudgedProfiles::new(radar, &reflectors), reflectors, moved, scale }
    }
}

fn fast_case(
    radar: &Radar,
    scene: &StressScene,
    judged: &Judged,
    algorithm: Algorithm,
    precision: Precision,
    tolerance: f64,
) -> Result<StressCase, SceneError> {
    let mut engine = Engine::new(radar.clone());
    engine.force(Forced { algorithm: Some(algorithm), precision: Some(precision), tolerance: Some(tolerance) });
    let (mut not_finite, mut ulp_change) = (0, Vec::new());
    // The last bit may carry a reflector onto an element.
    let moved = judged.moved.validate(radar).is_ok().then_some(&judged.moved);
    let mut signal_error = 0.0;
    for convention in CONVENTIONS {
        let (floor, normalisation) = (convention.floor, convention.normalisation);
        let wanted = MapRequest { floor, normalisation, seed: SEED, ends: false, ..MapRequest::default() };
        let frame = engine.update(&scene.scene, &wanted)?;
        let profile = |element| {
            // A scene without reflectors has no profiles to speak of.
            engine.range_profile(element).or_else(|| Some(vec![Default::default(); radar.samples]))
        };
        signal_error = judged.profiles.error(radar, profile, judged.scale).max(signal_error);
        let bad =
            |n: usize| profile(n).into_iter().flatten().filter(|v| !(v.re.is_finite() && v.im.is_finite())).count();
        not_finite += (0..radar.elements).map(bad).sum::<usize>();
        let Some(maps) = maps_of(&frame) else { continue };
        not_finite += maps.iter().map(|m| out_of_range(m)).sum::<usize>();
        if let Some(moved) = moved {
            let after = engine.update(moved, &wanted)?;
            ulp_change.extend(maps_of(&after).map(|after| difference(convention, maps, after)));
        }
    }
    Ok(case(scene, algorithm, precision, Some(tolerance), signal_error, not_finite, ulp_change))
}

fn plain_case(radar: &Radar, scene: &StressScene, judged: &Judged, algorithm: Algorithm) -> StressCase {
    let plan = Plan::cheapest(0, 0.0, BEST_TOLERANCE).with_algorithm(algorithm);
    let noise = UnitNoise::new(radar);
    let signal = beat_signal(radar, &judged.reflectors, &plan);
    let moved = judged.moved.reflectors();
    let after = judged.moved.validate(radar).is_ok().then(|| beat_signal(radar, &moved, &plan));
    let signal_error =
        judged.profiles.error(radar, |element| profile(radar, signal.samples.view(), element), judged.scale);
    let mut not_finite = signal.samples.iter().filter(|v| !(v.re.is_finite() && v.im.is_finite())).count();
    let mut ulp_change = Vec::new();
    for convention in CONVENTIONS {
        let maps = noise.plain_maps(radar, &judged.reflectors, &signal, convention);
        not_finite += maps.iter().map(out_of_range).sum::<usize>();
        if let Some(after) = &after {
            let after = noise.plain_maps(radar, &moved, after, convention);
            ulp_change.push(difference(convention, maps.each_ref(), after.each_ref()));
        }
    }
    let tolerance = (algorithm == Algorithm::Exact).then_some(1e-12);
    case(scene, algorithm, Precision::F64, tolerance, signal_error, not_finite, ulp_change)
}

fn case(
    scene: &StressScene,
    algorithm: Algorithm,
    precision: Precision,
    tolerance: Option<f64>,
    signal_error: f64,
    not_finite: usize,
    ulp_change: Vec<LambdaError>,
) -> StressCase {
    let not_finite = not_finite + usize::from(!signal_error.is_finite());
    let reflectors = scene.scene.reflector_count();
    StressCase { scene: scene.name, reflectors, algorithm, precision, signal_error, tolerance, not_finite, ulp_change }
}

fn out_of_range(map: &RangeAngleMap) -> usize {
    map.lambda.iter().filter(|v| !(0.0..=1.0).contains(*v)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_that_grows_is_found_out() {
        let mut edits = EditReport {
            edits: 100,
            worst_difference: 1e-15,
            most_difference: 1e-13,
            cache_bytes_early: 1000,
            cache_bytes: 1000,
            resident_bytes_early: Some(50 << 20),
            resident_bytes: Some(60 << 20),
        };
        let verdict = |edits: &EditReport| {
            StressReport { cases: Vec::new(), refused: Vec::new(), edits: edits.clone() }.verdict()
        };
        assert_eq!(verdict(&edits), Ok(()));
        edits.resident_bytes = Some(80 << 20);
        assert!(verdict(&edits).unwrap_err().to_string().starts_with("the process grew from"));
        edits.cache_bytes = 1001;
        assert!(verdict(&edits).unwrap_err().to_string().starts_with("caches grew"));
        edits.worst_difference = 1e-12;
        assert!(matches!(verdict(&edits), Err(StressFailure::Drift { .. })));
    }
}
