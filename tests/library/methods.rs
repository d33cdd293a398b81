//! Properties of every reconstruction method, of any kind; new methods are held to them by being in the list.

use crate::prelude::*;
use apertura::evaluate::detection_rates;
use apertura::reconstruct::Reconstruction;

/// Longest any method may take for one map, even on a busy machine in an unoptimised build.
const MAX_RUN_TIME: Duration = Duration::from_secs(120);

const MIN_SEPARATION: f64 = 0.1;

fn radar() -> Radar {
    Radar::default()
}

fn ends_of(scene: &Scene, floor: Floor) -> TwoEnds {
    simulate(&radar(), scene, floor, 1).unwrap().two_ends(&radar())
}

fn two_points() -> Scene {
    Scene::of_points([(3.0, 14.0), (-8.0, 16.0)])
}

fn times(ends: &TwoEnds, gain: f64) -> TwoEnds {
    TwoEnds { first: ends.first.mapv(|v| v * gain), last: ends.last.mapv(|v| v * gain) }
}

fn run(method: &dyn Reconstructor, ends: &TwoEnds, what: &str) -> Reconstruction {
    let start = Instant::now();
    let name = method.name();
    let answer = method
        .reconstruct(&radar(), ends, &Request::default())
        .unwrap_or_else(|error| panic!("{name} on {what}: {error}"));
    assert!(start.elapsed() < MAX_RUN_TIME, "{name} on {what} took {:?}", start.elapsed());
    assert_eq!(answer.lambda.lambda.dim(), (512, 1024), "{name} on {what}");
    for ((row, column), v) in answer.lambda.lambda.indexed_iter() {
        assert!((0.0..=1.0).contains(v), "{name} on {what}: {v} at row {row}, column {column}");
    }
    for r in &answer.reflectors {
        let is_finite = [r.x_metres, r.y_metres, r.reflectivity].iter().all(|v| v.is_finite());
        assert!(is_finite, "{name} on {what}: {r:?}");
    }
    answer
}

fn largest_difference(a: &Reconstruction, b: &Reconstruction) -> f32 {
    a.lambda.lambda.iter().zip(&b.lambda.lambda).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

#[test]
fn the_scale_of_the_samples_does_not_change_the_answer() {
    let ends = ends_of(&two_points(), Floor::Thesis);
    for method in methods::all() {
        let name = method.name();
        let plain = run(&*method, &ends, "two points");
        // The U-Net is there to show the collapse of the thesis' first attempt.
        assert!(name == "unet" || plain.lambda.lambda.iter().any(|v| *v > 0.9), "{name} sees nothing");
        assert_eq!(plain, run(&*method, &ends, "two points again"), "{name} does not repeat");
        // Powers of two keep every bit of the samples, so that the rounding floor beneath them stays the same too.
        for gain in [2f64.powi(-66), 2f64.powi(66)] {
            let scaled = run(&*method, &times(&ends, gain), "scaled samples");
            let difference = largest_difference(&plain, &scaled);
            assert!(difference < 2e-3, "{name}: gain {gain:e} changes Lambda by {difference}");
        }
        for gain in [1e-20, 1e20] {
            run(&*method, &times(&ends, gain), "samples scaled by a power of ten");
        }
    }
}

#[test]
fn silence_is_answered_with_nothing() {
    let silence = BeatSignal::silence(&radar()).two_ends(&radar());
    for method in methods::all() {
        let answer = run(&*method, &silence, "silence");
        let first = answer.lambda.lambda[[0, 0]];
        assert!(answer.lambda.lambda.iter().all(|v| *v == first), "{}: silence is flat", method.name());
        assert!(first < method.eta_of(&answer), "{}: silence is no detection", method.name());
        assert!(answer.reflectors.is_empty(), "{} finds reflectors in silence", method.name());
    }
}

#[test]
fn a_single_sample_has_an_answer() {
    let mut single = BeatSignal::silence(&radar()).two_ends(&radar());
    single.first[[3, 100]] = Complex64::new(0.0, 1.0);
    // An end that heard nothing at all is refused.
    single.last[[3, 100]] = Complex64::new(0.0, 1e-9);
    for method in methods::all() {
        // A single sample is alike at all ranges: its map is undefined.
        run(&*method, &single, "a single sample");
    }
}

#[test]
fn noise_is_no_detection() {
    let mut noise = BeatSignal::silence(&radar());
    apertura::signal::floor::add_noise(&mut noise, &vec![1.0; 1024], 9);
    let noise = noise.two_ends(&radar());
    let drowned = ends_of(&two_points(), Floor::Snr(Decibels(-30.0)));
    for method in methods::all() {
        for (ends, what) in [(&noise, "noise"), (&drowned, "two points under noise")] {
            let answer = run(&*method, ends, what);
            let eta = method.eta_of(&answer);
            let above = answer.lambda.lambda.iter().filter(|v| **v > eta).count();
            assert_eq!(above, 0, "{} on {what}: cells above {eta}", method.name());
            assert!(answer.reflectors.len() < 60, "{} on {what}: {} echoes", method.name(), answer.reflectors.len());
        }
    }
}

#[test]
fn a_crowded_scene_is_told_from_its_surroundings_in_time() {
    let crowded = Generator::new(&radar(), Reading::Program, Purpose::Validation, 4).scene(Kind::Set3, 0);
    let signal = simulate(&radar(), &crowded, Floor::Thesis, 1).unwrap();
    let target = LogMaps::of_signal(&radar(), &signal).full.normalise(Normalisation::MinMax);
    let ends = signal.two_ends(&radar());
    for method in methods::all().into_iter().filter(|method| method.name() != "unet") {
        let answer = run(&*method, &ends, "a crowded scene");
        let (detection, false_alarm) = detection_rates(&target, &answer.lambda, method.eta_of(&answer));
        // A map that is the same everywhere has both rates alike.
        let apart = detection.unwrap() - false_alarm;
        assert!(apart > MIN_SEPARATION, "{}: P_D {detection:?}, P_FA {false_alarm}", method.name());
    }
}

#[test]
fn a_cancelled_method_stops() {
    let ends = ends_of(&two_points(), Floor::Thesis);
    let request = Request::default();
    request.task.cancel();
    // The baseline is done before a cancellation could reach it.
    for method in methods::all().into_iter().filter(|m| m.name() != "baseline") {
        let answer = method.reconstruct(&radar(), &ends, &request);
        assert_eq!(answer, Err(ReconstructError::Cancelled), "{}", method.name());
    }
}

#[test]
fn bad_samples_are_named() {
    let mut ends = ends_of(&two_points(), Floor::Exact);
    ends.last[[4, 70]].re = f64::NAN;
    let short = TwoEnds { first: ends.first.clone(), last: ends.last.slice(ndarray::s![..5, ..]).to_owned() };
    for method in methods::all() {
        let error = method.reconstruct(&radar(), &ends, &Request::default()).unwrap_err().to_string();
        assert!(error.contains("sample 70 of element 4 of the last end"), "{}: {error}", method.name());
        let error = method.reconstruct(&radar(), &short, &Request::default()).unwrap_err().to_string();
        assert!(error.contains("last end has shape [5, 512]"), "{}: {error}", method.name());
    }
}
