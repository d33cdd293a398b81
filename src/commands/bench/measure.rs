//! The measurements behind `apertura bench`.

use crate::live::{Engine, Forced, Frame, Wanted};
use crate::maps::{Aperture, LogMaps, Normalisation, RangeAngleMap};
use crate::radar::{Decibels, End, Radar};
use crate::scene::{Reflector, Scene, SceneError};
use crate::signal::plan::{self, Algorithm, Precision, Recipe};
use crate::signal::{BeatSignal, Floor, exact, floor, judge};
use num_complex::Complex32;
use rustfft::FftPlanner;
use std::time::Instant;

/// Tolerances measured, relative to the peak.
const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
/// Elements whose samples are compared with the judge.
const JUDGED: [usize; 4] = [0, 341, 700, 1023];
/// Apertures in the order of every triple of maps.
const APERTURES: [Aperture; 3] = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];

/// One measurement.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Row {
    /// "scratch": nothing known before; "drag": one of the reflectors moved. Until three Lambda maps are ready.
    pub task: &'static str,
    /// Reflectors in the scene.
    pub reflectors: usize,
    /// Name of the algorithm, "plan" for what the planner chose.
    pub algorithm: &'static str,
    /// What the planner chose, or the algorithm again.
    pub chosen: &'static str,
    /// "f32" or "f64".
    pub precision: &'static str,
    /// Error asked for, relative to the peak.
    pub tolerance: f64,
    /// Floor and normalisation of the maps.
    pub maps: String,
    /// Median over the repeats.
    pub median_ms: f64,
    /// From the first to the third quartile of the repeats.
    pub spread_ms: f64,
    /// Largest error of a sample against the judge (at a few elements), relative to the peak.
    pub signal_error: f64,
    /// Largest error of Lambda against the exact path over the same floor.
    pub lambda_error: f64,
    /// Root of the mean squared error of Lambda.
    pub lambda_rms_error: f64,
    /// Largest resident size of the process while it ran, where the system tells.
    pub peak_bytes: Option<u64>,
}

/// Measures on one radar.
pub struct Bench {
    radar: Radar,
    repeats: usize,
    /// Median of the bare transform, milliseconds.
    pub bare_fft_ms: f64,
}

/// What errors are measured against.
struct Reference {
    reflectors: Vec<Reflector>,
    judged: Vec<Vec<num_complex::Complex64>>,
    peak: f64,
    /// Maps for loose tolerances (no floor, fixed range) and for tight ones (the thesis').
    loose: [RangeAngleMap; 3],
    tight: [RangeAngleMap; 3],
}

impl Bench {
    /// Measures the bare transform.
    pub fn new(repeats: usize) -> Self {
        Bench { radar: Radar::default(), repeats, bare_fft_ms: bare_fft_ms(repeats.max(9)) }
    }

    /// Every row for one number of reflectors.
    pub fn rows(&self, count: usize) -> Result<Vec<Row>, SceneError> {
        let scene = scattered(count);
        let reference = self.reference(&scene);
        let mut rows = Vec::new();
        for tolerance in TOLERANCES {
            for algorithm in [None, Some(Algorithm::Split), Some(Algorithm::Gridded)] {
                let planned = Recipe::plan(count, plan::amplitude_bound(&self.radar, &reference.reflectors), tolerance);
                let precisions: &[Precision] = match (algorithm, planned.precision) {
                    (Some(_), Precision::F32) => &[Precision::F32, Precision::F64],
                    (_, Precision::F32) => &[Precision::F32],
                    _ => &[Precision::F64],
                };
                for precision in precisions {
                    let recipe =
                        Recipe { algorithm: algorithm.unwrap_or(planned.algorithm), precision: *precision, ..planned };
                    for task in ["scratch", "drag"] {
                        rows.push(self.live_row(task, &scene, &reference, recipe, algorithm.is_none())?);
                    }
                }
            }
        }
        for algorithm in [Algorithm::Direct, Algorithm::Exact] {
            rows.push(self.plain_row(&reference, algorithm));
        }
        Ok(rows)
    }

    fn reference(&self, scene: &Scene) -> Reference {
        let reflectors = scene.reflectors();
        let judged: Vec<_> = JUDGED.iter().map(|n| judge::element_signal(&self.radar, &reflectors, *n)).collect();
        let mut signal = exact::beat_signal(&self.radar, &reflectors);
        let peak = signal.peak();
        let loose = lambda_maps(&self.radar, &signal, wanted(1e-3).normalisation);
        let variance = floor::thesis_noise_variance(&self.radar, &reflectors);
        floor::add_noise(&mut signal, &variance, wanted(1e-12).seed);
        let tight = lambda_maps(&self.radar, &signal, wanted(1e-12).normalisation);
        Reference { reflectors, judged, peak, loose, tight }
    }

    fn signal_error(&self, reference: &Reference, signal: &BeatSignal) -> f64 {
        let pairs =
            JUDGED.iter().zip(&reference.judged).flat_map(|(n, j)| signal.samples.row(*n).to_vec().into_iter().zip(j));
        pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / reference.peak
    }

    fn live_row(
        &self,
        task: &'static str,
        scene: &Scene,
        reference: &Reference,
        recipe: Recipe,
        planned: bool,
    ) -> Result<Row, SceneError> {
        let wanted = wanted(recipe.tolerance);
        let mut engine = Engine::new(self.radar.clone());
        engine.force(Forced {
            algorithm: (!planned).then_some(recipe.algorithm),
            precision: Some(recipe.precision),
            tolerance: Some(recipe.tolerance),
        });
        reset_peak();
        let mut scene = scene.clone();
        let mut times = Vec::new();
        let mut frame = engine.update(&scene, &wanted)?;
        // Two moves let the dragged reflector leave the sum at rest; what follows is what a drag costs.
        for i in 0..self.repeats + 3 {
            if task == "drag" {
                scene.objects[0].translate(if i % 2 == 0 { 0.01 } else { -0.01 }, 0.0);
            } else {
                engine.forget();
            }
            let start = Instant::now();
            frame = engine.update(&scene, &wanted)?;
            if i >= 3 {
                times.push(1e3 * start.elapsed().as_secs_f64());
            }
        }
        let peak_bytes = peak_bytes();
        if task == "drag" && self.repeats.is_multiple_of(2) {
            scene.objects[0].translate(-0.01, 0.0);
            frame = engine.update(&scene, &wanted)?;
        }
        let expected = if recipe.tolerance >= 1e-6 { &reference.loose } else { &reference.tight };
        let moved = scene.reflectors() != reference.reflectors;
        let (max, rms) = if moved {
            let other = self.reference_maps(&scene, recipe.tolerance);
            lambda_error(&maps_of(&frame), &other)
        } else {
            lambda_error(&maps_of(&frame), expected)
        };
        let signal = plan::beat_signal(&self.radar, &reference.reflectors, &recipe);
        Ok(Row {
            task,
            reflectors: reference.reflectors.len(),
            algorithm: if planned { "plan" } else { recipe.algorithm.name() },
            chosen: recipe.algorithm.name(),
            precision: name(recipe.precision),
            tolerance: recipe.tolerance,
            maps: format!("{} {}", wanted.floor, wanted.normalisation),
            median_ms: quantile(&mut times, 0.5),
            spread_ms: quantile(&mut times, 0.75) - quantile(&mut times, 0.25),
            signal_error: self.signal_error(reference, &signal),
            lambda_error: max,
            lambda_rms_error: rms,
            peak_bytes,
        })
    }

    fn reference_maps(&self, scene: &Scene, tolerance: f64) -> [RangeAngleMap; 3] {
        let wanted = wanted(tolerance);
        let reflectors = scene.reflectors();
        let recipe = Recipe::plan(reflectors.len(), 1.0, plan::BEST_TOLERANCE);
        let mut signal = plan::beat_signal(&self.radar, &reflectors, &recipe);
        if wanted.floor == Floor::Thesis {
            floor::add_noise(&mut signal, &floor::thesis_noise_variance(&self.radar, &reflectors), wanted.seed);
        }
        lambda_maps(&self.radar, &signal, wanted.normalisation)
    }

    /// The plain formulas: signal, transforms and maps without any of the fast paths.
    fn plain_row(&self, reference: &Reference, algorithm: Algorithm) -> Row {
        let recipe = Recipe::plan(1, 1.0, plan::BEST_TOLERANCE).with_algorithm(algorithm);
        let wanted = wanted(1e-12);
        reset_peak();
        let mut times = Vec::new();
        let repeats = if reference.reflectors.len() > 50 { 1 } else { 3 };
        let mut last = None;
        for _ in 0..repeats {
            let start = Instant::now();
            let signal = plan::beat_signal(&self.radar, &reference.reflectors, &recipe);
            let maps = lambda_maps(&self.radar, &signal, wanted.normalisation);
            times.push(1e3 * start.elapsed().as_secs_f64());
            last = Some((signal, maps));
        }
        let (signal_error, (max, rms)) = last
            .map(|(signal, maps)| {
                (self.signal_error(reference, &signal), lambda_error(&maps.each_ref(), &reference.tight))
            })
            .unwrap_or((f64::NAN, (f64::NAN, f64::NAN)));
        Row {
            task: "scratch",
            reflectors: reference.reflectors.len(),
            algorithm: algorithm.name(),
            chosen: algorithm.name(),
            precision: "f64",
            tolerance: 1e-12,
            maps: format!("{} {}", wanted.floor, wanted.normalisation),
            median_ms: quantile(&mut times, 0.5),
            spread_ms: quantile(&mut times, 0.75) - quantile(&mut times, 0.25),
            signal_error,
            lambda_error: max,
            lambda_rms_error: rms,
            peak_bytes: peak_bytes(),
        }
    }
}

/// Loose tolerances are for maps of fixed range without a floor; tight ones are what the thesis' own maps need.
fn wanted(tolerance: f64) -> Wanted {
    let (floor, normalisation) = if tolerance >= 1e-6 {
        (Floor::Exact, Normalisation::DynamicRange(Decibels(100.0)))
    } else {
        (Floor::Thesis, Normalisation::MinMax)
    };
    Wanted { floor, normalisation, ends: false, ..Wanted::default() }
}

fn name(precision: Precision) -> &'static str {
    match precision {
        Precision::F32 => "f32",
        Precision::F64 => "f64",
    }
}

/// Reflectors on a lattice in front of the array, the same as in `benches/numpy_maps.py`.
fn scattered(count: usize) -> Scene {
    let lattice = |i: usize, step: usize, span: usize| (i * step % span) as f64;
    Scene::of_points((0..count).map(|i| (lattice(i, 37, 61) - 30.0, 2.37 + lattice(i, 53, 33))))
}

fn lambda_maps(radar: &Radar, signal: &BeatSignal, normalisation: Normalisation) -> [RangeAngleMap; 3] {
    let maps = LogMaps::of_signal(radar, signal);
    [&maps.first, &maps.last, &maps.full].map(|m| m.normalise(normalisation))
}

fn maps_of(frame: &Frame) -> [&RangeAngleMap; 3] {
    let empty = || unreachable!("the benchmark asks for all three maps");
    APERTURES.map(|a| frame.map(a).map_or_else(empty, |m| m.lambda.as_ref()))
}

/// (largest, root mean square) difference over three maps.
fn lambda_error(got: &[&RangeAngleMap; 3], expected: &[RangeAngleMap; 3]) -> (f64, f64) {
    let differences =
        got.iter().zip(expected).flat_map(|(a, b)| a.lambda.iter().zip(&b.lambda).map(|(a, b)| f64::from(a - b).abs()));
    let (max, sum, count) = differences.fold((0.0f64, 0.0, 0u32), |(m, s, n), d| (m.max(d), s + d * d, n + 1));
    (max, (sum / f64::from(count.max(1))).sqrt())
}

fn quantile(times: &mut [f64], part: f64) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(((times.len() - 1) as f64 * part).round() as usize).copied().unwrap_or(f64::NAN)
}

/// Median time of a 512 x 1024 c64 two-dimensional transform on one thread: rows, blocked transpose, columns. Milliseconds.
fn bare_fft_ms(repeats: usize) -> f64 {
    const ROWS: usize = 512;
    const COLUMNS: usize = 1024;
    const TILE: usize = 16;
    let mut planner = FftPlanner::new();
    let (over_rows, over_columns) = (planner.plan_fft_forward(COLUMNS), planner.plan_fft_forward(ROWS));
    let scratch_len = over_rows.get_inplace_scratch_len().max(over_columns.get_inplace_scratch_len());
    let mut scratch = vec![Complex32::default(); scratch_len];
    let mut data: Vec<_> = (0..ROWS * COLUMNS).map(|i| Complex32::new((i as f32).sin(), 0.5)).collect();
    let mut turned = vec![Complex32::default(); ROWS * COLUMNS];
    let mut times = Vec::new();
    for _ in 0..repeats + 2 {
        let start = Instant::now();
        over_rows.process_with_scratch(&mut data, &mut scratch);
        for row in (0..ROWS).step_by(TILE) {
            for column in (0..COLUMNS).step_by(TILE) {
                for r in row..row + TILE {
                    for c in column..column + TILE {
                        turned[c * ROWS + r] = data[r * COLUMNS + c];
                    }
                }
            }
        }
        over_columns.process_with_scratch(&mut turned, &mut scratch);
        times.push(1e3 * start.elapsed().as_secs_f64());
        // Keep the numbers from growing without bound.
        data.iter_mut().zip(&turned).for_each(|(d, t)| *d = t * 1e-3);
    }
    quantile(&mut times[2..], 0.5)
}

/// Starts a new measurement of the largest resident size.
fn reset_peak() {
    // Linux only; elsewhere peak sizes are not reported.
    let _not_linux = std::fs::write("/proc/self/clear_refs", "5");
}

fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}
