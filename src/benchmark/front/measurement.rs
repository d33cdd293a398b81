//! Measurement of a front, row by row.

use super::super::times::{bare_ms, quantile};
use super::reference::{Reference, SEED, maps_of, profile};
use super::{Entrant, Front, FrontRequest, FrontRow, FrontTask, LambdaError, MapConvention};
use crate::engine::{Engine, MapRequest, PlanOverrides};
use crate::maps::tolerance;
use crate::platform::Instant;
use crate::radar::Radar;
use crate::scene::{Scene, SceneError};
use crate::signal::Floor;
use crate::signal::plan::{self, BEST_TOLERANCE};
use crate::signal::simd::Simd;
use crate::signal::{Precision, SynthesisPlan, beat_signal};

/// Updates before the timed ones: the first two moves of a drag let the dragged reflector leave the sum at rest.
const WARM_UP_UPDATES: usize = 3;
/// Most repeats of the slow algorithms: for small scenes, for large ones.
const SLOW_REPEATS: [usize; 2] = [3, 1];

/// Most reflectors for the slow algorithms: more take them minutes.
const MAX_PLAIN_REFLECTORS: usize = 1000;

#[derive(Clone, Copy)]
struct Job {
    task: FrontTask,
    entrant: Entrant,
    plan: SynthesisPlan,
}

/// Measures every combination of `request` on `radar`, with reflectors scattered before the array.
///
/// `on_row` is called with the part that is done (0 to 1) and each new row, in order. Once `cancelled` is true, the rows so far are returned.
/// Everything runs on the calling thread and rayon's.
/// # Errors
/// [`SceneError`] when the radar can't see the scenes.
pub fn measure(
    radar: &Radar,
    request: &FrontRequest,
    mut on_row: impl FnMut(f32, &FrontRow),
    cancelled: impl Fn() -> bool,
) -> Result<Front, SceneError> {
    let repeats = request.repeats.max(1);
    let mut front = Front {
        bare_fft_ms: bare_ms(repeats.max(9)),
        threads: rayon::current_num_threads(),
        simd: Simd::chosen(),
        rows: Vec::new(),
    };
    for (i, count) in request.reflectors.iter().enumerate() {
        if cancelled() {
            break;
        }
        let scene = scattered(*count);
        scene.validate(radar)?;
        let reference = Reference::new(radar, scene.reflectors());
        let jobs = jobs(radar, request, &reference);
        for (j, job) in jobs.iter().enumerate() {
            if cancelled() {
                return Ok(front);
            }
            let row = match job.plan.algorithm.is_fast() {
                true => fast_row(radar, &scene, &reference, job, repeats)?,
                false => plain_row(radar, &reference, job, repeats),
            };
            let scenes_done = i as f32 + (j + 1) as f32 / jobs.len() as f32;
            on_row(scenes_done / request.reflectors.len() as f32, &row);
            front.rows.push(row);
        }
    }
    Ok(front)
}

/// `count` reflectors on a lattice in front of the array; from the 2013th on reflectors coincide with earlier ones.
pub fn scattered(count: usize) -> Scene {
    let lattice = |i: usize, step: usize, span: usize| (i * step % span) as f64;
    Scene::of_points((0..count).map(|i| (lattice(i, 37, 61) - 30.0, 2.37 + lattice(i, 53, 33))))
}

fn jobs(radar: &Radar, request: &FrontRequest, reference: &Reference) -> Vec<Job> {
    let count = reference.reflectors.len();
    let amplitude = plan::amplitude_bound(radar, &reference.reflectors);
    let mut jobs = Vec::new();
    for tolerance in &request.tolerances {
        let mut planned = SynthesisPlan::cheapest(count, amplitude, *tolerance);
        if MapConvention::for_tolerance(*tolerance).floor == Floor::Exact {
            planned = planned.on_few_rows(radar, count);
        }
        for entrant in &request.entrants {
            let (algorithm, precisions): (_, &[Precision]) = match (*entrant, planned.precision) {
                (Entrant::Planned, _) => (planned.algorithm, &[planned.precision]),
                (Entrant::Forced(algorithm), _) if !algorithm.is_fast() => continue,
                (Entrant::Forced(algorithm), Precision::F32) => (algorithm, &[Precision::F32, Precision::F64]),
                (Entrant::Forced(algorithm), Precision::F64) => (algorithm, &[Precision::F64]),
            };
            for precision in precisions {
                let sum = plan::SumSize { algorithm, reflectors: count, amplitude };
                let MapConvention { floor, normalisation } = MapConvention::for_tolerance(*tolerance);
                if tolerance::refusal(*precision, &sum, floor, normalisation).is_some() {
                    continue;
                }
                let plan = SynthesisPlan { algorithm, precision: *precision, ..planned };
                jobs.extend(request.tasks.iter().map(|task| Job { task: *task, entrant: *entrant, plan }));
            }
        }
    }
    for entrant in &request.entrants {
        if let Entrant::Forced(algorithm) = *entrant
            && !algorithm.is_fast()
            && count <= MAX_PLAIN_REFLECTORS
            && request.tasks.contains(&FrontTask::Scratch)
        {
            let best = SynthesisPlan::cheapest(count, amplitude, BEST_TOLERANCE);
            let plan = SynthesisPlan { tolerance: 1e-12, precision: Precision::F64, ..best };
            let plan = plan.with_algorithm(algorithm);
            jobs.push(Job { task: FrontTask::Scratch, entrant: *entrant, plan });
        }
    }
    jobs
}

fn wanted(convention: MapConvention) -> MapRequest {
    let MapConvention { floor, normalisation } = convention;
    MapRequest { floor, normalisation, seed: SEED, ends: false, ..MapRequest::default() }
}

fn fast_row(
    radar: &Radar,
    scene: &Scene,
    reference: &Reference,
    job: &Job,
    repeats: usize,
) -> Result<FrontRow, SceneError> {
    let convention = MapConvention::for_tolerance(job.plan.tolerance);
    let mut engine = Engine::new(radar.clone());
    engine.force(PlanOverrides {
        algorithm: match job.entrant {
            Entrant::Planned => None,
            Entrant::Forced(algorithm) => Some(algorithm),
        },
        precision: Some(job.plan.precision),
        tolerance: Some(job.plan.tolerance),
    });
    let mut moved = scene.clone();
    if let Some(object) = moved.objects.first_mut() {
        object.translate(0.01, 0.0);
    }
    let mut times = Vec::new();
    let mut frame = engine.update(scene, &wanted(convention))?;
    for left in (0..repeats + WARM_UP_UPDATES).rev() {
        let next = match job.task {
            // The last move returns to the scene of the reference.
            FrontTask::Drag if left % 2 == 1 => &moved,
            FrontTask::Drag => scene,
            FrontTask::Scratch => {
                engine.forget();
                scene
            }
        };
        let start = Instant::now();
        frame = engine.update(next, &wanted(convention))?;
        if left < repeats {
            times.push(1e3 * start.elapsed().as_secs_f64());
        }
    }
    let signal_error = reference.signal_error(radar, |element| engine.range_profile(element));
    let mut lambda = Vec::new();
    for other in MapConvention::BOTH {
        let drawn = if other == convention { frame.clone() } else { engine.update(scene, &wanted(other))? };
        lambda.extend(maps_of(&drawn).map(|maps| reference.lambda_error(other, maps)));
    }
    Ok(row(job, reference, times, signal_error, lambda))
}

/// The plain formulas: signal, transforms and maps without any of the fast paths.
fn plain_row(radar: &Radar, reference: &Reference, job: &Job, repeats: usize) -> FrontRow {
    let repeats = repeats.min(SLOW_REPEATS[usize::from(reference.reflectors.len() > 50)]);
    let convention = MapConvention::for_tolerance(job.plan.tolerance);
    let once = || {
        let start = Instant::now();
        let signal = beat_signal(radar, &reference.reflectors, &job.plan);
        let maps = reference.noise.plain_maps(radar, &reference.reflectors, &signal, convention);
        (1e3 * start.elapsed().as_secs_f64(), signal, maps)
    };
    let (first, signal, maps) = once();
    let times = std::iter::once(first).chain((1..repeats).map(|_| once().0)).collect();
    let signal_error = reference.signal_error(radar, |element| profile(radar, signal.samples.view(), element));
    let lambda = MapConvention::BOTH.map(|other| {
        let drawn;
        let maps = if other == convention {
            &maps
        } else {
            drawn = reference.noise.plain_maps(radar, &reference.reflectors, &signal, other);
            &drawn
        };
        reference.lambda_error(other, maps.each_ref())
    });
    row(job, reference, times, signal_error, lambda.to_vec())
}

fn row(job: &Job, reference: &Reference, mut times: Vec<f64>, signal_error: f64, lambda: Vec<LambdaError>) -> FrontRow {
    let convention = MapConvention::for_tolerance(job.plan.tolerance);
    FrontRow {
        task: job.task,
        reflectors: reference.reflectors.len(),
        algorithm: job.entrant,
        chosen: job.plan.algorithm,
        precision: job.plan.precision,
        tolerance: job.plan.tolerance,
        convention,
        median_ms: quantile(&mut times, 0.5),
        spread_ms: quantile(&mut times, 0.75) - quantile(&mut times, 0.25),
        fastest_ms: quantile(&mut times, 0.0),
        repeats: times.len(),
        signal_error,
        lambda,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::Algorithm;
    use std::cell::Cell;

    fn small() -> Radar {
        Radar { elements: 64, samples: 32, end_elements: 4, ..Radar::default() }
    }

    fn request() -> FrontRequest {
        FrontRequest { reflectors: vec![1, 5], repeats: 2, ..FrontRequest::full(Vec::new(), 1) }
    }

    #[test]
    fn every_row_meets_the_tolerance_it_was_asked_for() {
        let mut parts = Vec::new();
        let start = Instant::now();
        let front = measure(&small(), &request(), |part, _| parts.push(part), || false).unwrap();
        let milliseconds = 1e3 * start.elapsed().as_secs_f64();
        assert_eq!(front.rows.len(), parts.len());
        assert!(parts.is_sorted() && parts.last() == Some(&1.0), "{parts:?}");
        for r in &front.rows {
            let floor = if r.algorithm == Entrant::Forced(Algorithm::Direct) { 1e-10 } else { 0.0 };
            assert!(r.signal_error <= r.tolerance.max(floor), "{r:?}");
            assert!(r.fastest_ms <= r.median_ms && r.median_ms <= milliseconds, "{r:?}");
            assert_eq!(r.lambda.len(), 2);
        }
        // The timed part is most of the elapsed time, and not a thousandth of it, as seconds taken for milliseconds would be.
        let timed: f64 = front.rows.iter().map(|r| r.fastest_ms * r.repeats as f64).sum();
        assert!((milliseconds / 1e3..milliseconds).contains(&timed), "{timed} of {milliseconds} ms");
        let coarse = front.rows.iter().find(|r| r.tolerance == 1e-3 && r.chosen == Algorithm::Gridded).unwrap();
        assert!(coarse.signal_error > 1e-9, "an error that is never seen can't be believed: {coarse:?}");
        let json = serde_json::to_value(&front).unwrap();
        let said = ["algorithm", "floor", "normalisation"].map(|key| json["rows"][0][key].as_str().unwrap().to_owned());
        assert_eq!(said, ["plan", "exact", "db=100"]);
    }

    #[test]
    fn a_cancelled_measurement_returns_what_it_has() {
        let seen = Cell::new(0);
        let front = measure(&small(), &request(), |_, _| seen.set(seen.get() + 1), || seen.get() == 3).unwrap();
        assert_eq!(front.rows.len(), 3);
    }
}
