use super::*;
use crate::maps::{Aperture, LogMaps};
use crate::radar::Decibels;
use crate::scene::{Line, Point};
use crate::signal;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};

fn small() -> Radar {
    Radar { elements: 64, samples: 32, end_elements: 4, ..Radar::default() }
}

fn lambda(f: &Frame) -> Arc<RangeAngleMap> {
    f.full.as_ref().expect("the whole array's map was wanted").lambda.clone()
}

#[test]
fn unchanged_results_are_the_same_arc() {
    let mut engine = Engine::new(small());
    let scene = Scene::of_points([(0.3, 1.0)]);
    let a = engine.update(&scene, &Wanted::default()).unwrap();
    let b = engine.update(&scene, &Wanted::default()).unwrap();
    assert!(Arc::ptr_eq(&lambda(&a), &lambda(&b)));
    assert!(a.report.ran(Stage::Signal) && !b.report.ran(Stage::Signal));
    let other = Wanted { normalisation: Normalisation::DynamicRange(Decibels(60.0)), ..Wanted::default() };
    let c = engine.update(&scene, &other).unwrap();
    assert!(!c.report.ran(Stage::FullMap) && c.report.ran(Stage::Normalise));
    assert!(!Arc::ptr_eq(&lambda(&a), &lambda(&c)));
}

#[test]
fn hidden_maps_are_not_computed() {
    let mut engine = Engine::new(small());
    let wanted = Wanted { first: false, full: false, ends: false, ..Wanted::default() };
    let frame = engine.update(&Scene::of_points([(0.3, 1.0)]), &wanted).unwrap();
    assert!(frame.first.is_none() && frame.full.is_none() && frame.ends.is_none() && frame.last.is_some());
    assert!(!frame.report.ran(Stage::FullMap));
}

#[test]
fn a_bad_scene_is_refused_and_the_engine_lives_on() {
    let mut engine = Engine::new(small());
    assert!(engine.update(&Scene::of_points([(f64::NAN, 1.0)]), &Wanted::default()).is_err());
    assert!(engine.update(&Scene::default(), &Wanted::default()).is_ok());
}

/// Frames agree with the plain path from samples to maps, floor included.
#[test]
fn frames_agree_with_the_plain_path() {
    let radar = Radar::default();
    let scene = Scene::of_points([(1.0, 6.0), (-2.0, 9.5), (8.0, 3.3)]);
    for floor in [Floor::Thesis, Floor::Snr(Decibels(20.0))] {
        let wanted = Wanted { floor, seed: 5, ..Wanted::default() };
        let frame = Engine::new(radar.clone()).update(&scene, &wanted).unwrap();
        let signal = signal::simulate(&radar, &scene, floor, 5).unwrap();
        let maps = LogMaps::of_signal(&radar, &signal);
        for (aperture, log) in [
            (Aperture::End(End::First), &maps.first),
            (Aperture::End(End::Last), &maps.last),
            (Aperture::Full, &maps.full),
        ] {
            let expected = log.normalise(Normalisation::MinMax).lambda;
            let got = &frame.map(aperture).unwrap().lambda.lambda;
            let worst = expected.iter().zip(got).fold(0.0f32, |m, (a, b)| m.max((a - b).abs()));
            let square = expected.iter().zip(got).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
            let rms = (square / expected.len() as f64).sqrt();
            // In the deepest nulls of the noise even the last bits of f64 show.
            assert!(rms < 1e-3 && worst < 2e-2, "{floor} {aperture:?}: rms {rms:e}, worst {worst}");
        }
        let ends = signal.two_ends(&radar);
        for end in End::BOTH {
            let off =
                (ends.end(end) - frame.ends.as_ref().unwrap().end(end)).iter().fold(0.0f64, |m, v| m.max(v.norm()));
            assert!(off < 1e-13 * signal.peak(), "{off:e}");
        }
    }
}

/// Greatest difference of the profiles that two engines hold for the same scene, relative to the peak.
fn difference(a: &Engine, b: &Engine) -> f64 {
    let total = |e: &Engine| {
        let bank = e.double.as_ref().expect("f64 is what these tests ask for");
        let mut sum = bank.rest.profiles.clone();
        sum.add(&bank.active.profiles, 1.0);
        sum
    };
    let (a, b) = (total(a), total(b));
    let parts = |p: &BlockProfiles<f64, LANES_F64>| -> Vec<f64> {
        p.cells.iter().flat_map(|c| c.re.0.into_iter().chain(c.im.0)).collect()
    };
    let (a, b) = (parts(&a), parts(&b));
    let peak = b.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let off = a.iter().zip(&b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    if off == 0.0 { 0.0 } else { off / peak }
}

fn random_object(rng: &mut impl RngExt) -> Object {
    let mut at = |span: f64| (rng.random::<f64>() - 0.5) * span;
    let (x_metres, y_metres) = (at(4.0), 1.5 + at(2.0));
    let reflectivity = 10f64.powf(at(8.0));
    if at(1.0) < 0.35 {
        Object::Point(Point { x_metres, y_metres, reflectivity })
    } else {
        Object::Line(Line { x_metres, y_start_metres: y_metres, spacing_metres: 0.1, count: 5, reflectivity })
    }
}

/// Makes random edits, and compares with an engine that starts afresh now and then. Returns the worst difference.
fn edit(seed: u64, edits: usize, compare_every: usize) -> f64 {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut engine = Engine::new(small());
    let mut scene = Scene { objects: (0..12).map(|_| random_object(&mut rng)).collect(), ..Scene::default() };
    let wanted = Wanted { ends: false, ..Wanted::default() };
    let (mut worst, mut bytes) = (0.0f64, None);
    for i in 0..edits {
        let at = rng.random_range(0..scene.objects.len());
        match rng.random_range(0..10) {
            0 if scene.objects.len() < 30 => scene.objects.push(random_object(&mut rng)),
            1 if scene.objects.len() > 3 => drop(scene.objects.remove(at)),
            2 => scene.objects.swap(0, at),
            3 => scene.objects[at] = random_object(&mut rng),
            _ => scene.objects[at].translate(rng.random::<f64>() * 0.1 - 0.05, rng.random::<f64>() * 0.1 - 0.05),
        }
        engine.update(&scene, &wanted).unwrap();
        if i % compare_every == compare_every - 1 {
            let mut fresh = Engine::new(small());
            fresh.update(&scene, &wanted).unwrap();
            worst = worst.max(difference(&engine, &fresh));
            // The first frames still fill the pool of buffers.
            assert_eq!(*bytes.get_or_insert(engine.cache_bytes()), engine.cache_bytes(), "memory after {i} edits");
        }
    }
    worst
}

#[test]
fn edits_end_where_a_fresh_build_does() {
    let worst = edit(1, 300, 20);
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
#[ignore = "takes a minute"]
fn ten_thousand_edits_end_where_a_fresh_build_does() {
    let worst = edit(2, 10_000, 100);
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn taking_away_a_giant_leaves_nothing_of_it() {
    let mut engine = Engine::new(small());
    let small_one = Object::Point(Point { x_metres: 0.2, y_metres: 1.0, reflectivity: 1e-20 });
    let giant = Object::Point(Point { x_metres: 0.1, y_metres: 1.2, reflectivity: 1e30 });
    let other = Object::Point(Point { x_metres: -0.4, y_metres: 0.9, reflectivity: 1e-20 });
    let wanted = Wanted::default();
    let with = Scene { objects: vec![small_one.clone(), giant, other.clone()], ..Scene::default() };
    engine.update(&with, &wanted).unwrap();
    let without = Scene { objects: vec![small_one, other], ..Scene::default() };
    engine.update(&without, &wanted).unwrap();
    let mut fresh = Engine::new(small());
    fresh.update(&without, &wanted).unwrap();
    assert!(difference(&engine, &fresh) < 1e-12);
}

#[test]
fn dragging_evaluates_the_dragged_object_alone() {
    let mut engine = Engine::new(small());
    let mut scene = Scene::of_points((0..30).map(|i| (f64::from(i) * 0.05 - 0.7, 1.0)));
    let wanted = Wanted::default();
    engine.update(&scene, &wanted).unwrap();
    for step in 0..3 {
        scene.objects[7].translate(0.01, 0.0);
        let frame = engine.update(&scene, &wanted).unwrap();
        let signal = frame.report.stages.iter().find(|s| s.stage == Stage::Signal).unwrap();
        let Outcome::Computed(what) = &signal.outcome else { panic!("the signal was not computed") };
        let expected = if step == 0 { "2 of 30" } else { "1 of 30" };
        assert!(what.starts_with(expected), "step {step}: {what}");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let scene = Scene::of_points((0..50).map(|i| (f64::from(i) * 0.05 - 0.7, 1.0)));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lambda(&Engine::new(small()).update(&scene, &Wanted::default()).unwrap()))
    };
    assert_eq!(with(1).lambda, with(3).lambda);
}

use super::super::Outcome;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever the scene, cells are in [0, 1] and none is NaN.
    #[test]
    fn cells_are_always_in_range(
        points in prop::collection::vec((-50.0..50.0f64, -50.0..50.0f64, -30.0..30.0f64), 0..8),
        snr in 0.0..200.0f64,
        which in 0..4,
    ) {
        let objects = points
            .into_iter()
            .map(|(x_metres, y_metres, decades)| Object::Point(Point { x_metres, y_metres, reflectivity: 10f64.powf(decades) }))
            .collect();
        let scene = Scene { objects, ..Scene::default() };
        let floor = [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(snr)), Floor::Thesis][which as usize];
        let normalisation = if which == 3 { Normalisation::DynamicRange(Decibels(80.0)) } else { Normalisation::MinMax };
        let frame = Engine::new(small()).update(&scene, &Wanted { floor, normalisation, ..Wanted::default() }).unwrap();
        for aperture in [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full] {
            prop_assert!(frame.map(aperture).unwrap().lambda.lambda.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }
}
