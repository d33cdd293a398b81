use super::super::StageOutcome;
use super::*;
use crate::maps::{Aperture, LogMaps, Normalisation, RangeAngleMap};
use crate::radar::{DecibelMilliwatts, Decibels, End};
use crate::scene::{Object, Point};
use crate::signal::{self, Floor};

mod bodies;

fn small() -> Radar {
    Radar { elements: 64, samples: 32, end_elements: 4, ..Radar::default() }
}

fn lambda(f: &EngineFrame) -> Arc<RangeAngleMap> {
    f.full.as_ref().expect("the whole array's map was wanted").lambda.clone()
}

fn said(frame: &EngineFrame, stage: EngineStage) -> String {
    match &frame.report.stages.iter().find(|s| s.stage == stage).unwrap().outcome {
        StageOutcome::Computed(what) => what.clone(),
        StageOutcome::Skipped(why) => (*why).to_owned(),
    }
}

/// Largest difference between the range profiles of two engines, relative to the other's largest cell.
fn profile_difference(engine: &Engine, other: &Engine) -> f64 {
    let (mut worst, mut peak) = (0.0f64, 0.0f64);
    for element in 0..engine.radar().elements {
        let [own, others] = [engine, other].map(|of| of.range_profile(element).unwrap());
        for (a, b) in own.iter().zip(others) {
            worst = worst.max((a - b).norm());
            peak = peak.max(b.norm());
        }
    }
    if worst == 0.0 { 0.0 } else { worst / peak }
}

#[test]
fn unchanged_results_are_the_same_arc() {
    let mut engine = Engine::new(small());
    let scene = Scene::of_points([(0.3, 1.0)]);
    let a = engine.update(&scene, &MapRequest::default()).unwrap();
    let b = engine.update(&scene, &MapRequest::default()).unwrap();
    assert!(Arc::ptr_eq(&lambda(&a), &lambda(&b)));
    assert!(a.report.ran(EngineStage::Signal) && !b.report.ran(EngineStage::Signal));
    let other = MapRequest { normalisation: Normalisation::DynamicRange(Decibels(60.0)), ..MapRequest::default() };
    let c = engine.update(&scene, &other).unwrap();
    assert!(!c.report.ran(EngineStage::FullMap) && c.report.ran(EngineStage::Normalise));
    assert!(!Arc::ptr_eq(&lambda(&a), &lambda(&c)));
}

#[test]
fn what_is_forgotten_vouches_for_no_precision() {
    let scene = Scene::of_points([(0.3, 1.0), (-0.4, 1.7)]);
    let precise = MapRequest::default();
    let coarse = MapRequest { normalisation: Normalisation::DynamicRange(Decibels(60.0)), ..precise };
    let mut engine = Engine::new(small());
    let first = engine.update(&scene, &precise).unwrap();
    engine.forget();
    engine.update(&scene, &coarse).unwrap();
    let again = engine.update(&scene, &precise).unwrap();
    assert!(again.report.ran(EngineStage::Signal), "the coarse maps are not good enough");
    assert_eq!(lambda(&first), lambda(&again));
}

#[test]
fn a_disturbed_scene_is_computed_as_commands_do() {
    let mut engine = Engine::new(small());
    let plain = Scene::of_points([(0.3, 1.0)]);
    let before = lambda(&engine.update(&plain, &MapRequest::default()).unwrap());
    let mut scene = plain.clone();
    scene.disturbances.interferer = Some(crate::scene::Interferer::default());
    let disturbed = engine.update(&scene, &MapRequest::default()).unwrap();
    let signal = signal::simulate(&small(), &scene, Floor::Thesis, 0).unwrap();
    assert_eq!(*lambda(&disturbed), LogMaps::of_signal(&small(), &signal).full.normalise(Normalisation::MinMax));
    assert!(disturbed.settled && *lambda(&disturbed) != *before);
    assert_eq!(*disturbed.ends.unwrap(), signal.two_ends(&small()));
    let after = engine.update(&plain, &MapRequest::default()).unwrap();
    assert!(!after.settled && lambda(&after) == before);
}

#[test]
fn frames_agree_with_the_plain_path() {
    let radar = Radar::default();
    let points = Scene::of_points([(1.0, 6.0), (-2.0, 9.5), (8.0, 3.3)]);
    let mut weak = points.clone();
    weak.objects.iter_mut().for_each(|o| o.set_reflectivity(1e-9));
    let level = Floor::Level(DecibelMilliwatts(40.0));
    for (floor, scene) in [
        (Floor::Thesis, &points),
        (Floor::Snr(Decibels(20.0)), &points),
        (level, &points),
        (level, &weak),
        (Floor::Thesis, &weak),
        (level, &Scene::default()),
    ] {
        let wanted = MapRequest { floor, seed: 5, ..MapRequest::default() };
        let frame = Engine::new(radar.clone()).update(scene, &wanted).unwrap();
        let signal = signal::simulate(&radar, scene, floor, 5).unwrap();
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
        assert_eq!(*frame.ends.unwrap(), signal.two_ends(&radar), "not a bit off");
    }
}

#[test]
fn an_empty_scene_without_noise_is_dark() {
    let radar = Radar::default();
    let point = Scene::of_points([(1.0, 6.0)]);
    for floor in [Floor::Thesis, Floor::Exact] {
        for normalisation in [Normalisation::MinMax, Normalisation::DynamicRange(Decibels(100.0))] {
            let wanted = MapRequest { floor, normalisation, ..MapRequest::default() };
            let mut engine = Engine::new(radar.clone());
            engine.update(&point, &wanted).unwrap();
            let moving = engine.update(&Scene::default(), &wanted).unwrap();
            let settled = engine.settle(&Scene::default(), &wanted).unwrap();
            for (frame, how) in [(moving, "in motion"), (settled, "at rest")] {
                for map in [&frame.first, &frame.last, &frame.full] {
                    let brightest = map.as_ref().unwrap().lambda.lambda.iter().copied().fold(0.0, f32::max);
                    assert_eq!(brightest, 0.0, "{floor} {normalisation} {how}");
                }
            }
        }
    }
}

/// Ends, and Lambda of the first end, the last end and the whole array, as a command computes them.
fn by_command(radar: &Radar, scene: &Scene, wanted: &MapRequest) -> (signal::TwoEnds, [RangeAngleMap; 3]) {
    let signal = signal::simulate(radar, scene, wanted.floor, wanted.seed).unwrap();
    let maps = LogMaps::of_signal(radar, &signal);
    let maps = [&maps.first, &maps.last, &maps.full].map(|log| log.normalise(wanted.normalisation));
    (signal.two_ends(radar), maps)
}

/// After any scene, a scene at rest has the bits of the commands, and so have the samples of its ends at any time.
#[test]
fn a_scene_at_rest_does_not_depend_on_what_came_before() {
    let radar = small();
    let scene = Scene::of_points((0..9).map(|i| (0.1 * f64::from(i) - 0.4, 0.8 + 0.11 * f64::from(i))));
    let mut moved = scene.clone();
    moved.objects[4].translate(0.05, 0.02);
    let other = Scene::of_points([(0.3, 1.0)]);
    let thesis = MapRequest { seed: 2, ..MapRequest::default() };
    let fixed = MapRequest { normalisation: Normalisation::DynamicRange(Decibels(60.0)), ..thesis };
    let noisy = MapRequest { floor: Floor::Snr(Decibels(10.0)), ..thesis };
    let histories: [&[(&Scene, MapRequest, bool)]; 5] = [
        &[],
        &[(&other, thesis, true)],
        &[(&moved, thesis, false), (&scene, thesis, false), (&moved, thesis, false)],
        &[(&scene, fixed, true), (&scene, noisy, false), (&scene, thesis, false)],
        &[(&other, noisy, false), (&moved, fixed, true), (&scene, fixed, true), (&scene, fixed, false)],
    ];
    for wanted in [thesis, fixed, noisy, MapRequest { floor: Floor::Exact, ..thesis }] {
        let (ends, maps) = by_command(&radar, &scene, &wanted);
        for (i, history) in histories.iter().enumerate() {
            let mut engine = Engine::new(radar.clone());
            for (scene, wanted, rests) in *history {
                engine.update(scene, wanted).unwrap();
                if *rests {
                    engine.settle(scene, wanted).unwrap();
                }
            }
            let moving = engine.update(&scene, &wanted).unwrap();
            assert_eq!(*moving.ends.unwrap(), ends, "history {i}, {wanted:?}");
            let rests = engine.settle(&scene, &wanted).unwrap();
            let found = [&rests.first, &rests.last, &rests.full].map(|m| (*m.as_ref().unwrap().lambda).clone());
            assert!(rests.settled && found == maps, "history {i}, {wanted:?}");
            assert_eq!(*rests.ends.clone().unwrap(), ends);
            // The settled maps stay until the scene changes.
            let still = engine.update(&scene, &wanted).unwrap();
            assert!(still.settled && Arc::ptr_eq(&lambda(&still), &lambda(&rests)));
            assert!(!engine.update(&moved, &wanted).unwrap().settled);
        }
    }
}

#[test]
fn a_scene_at_rest_is_computed_where_it_is_looked_at() {
    let (radar, scene) = (small(), Scene::of_points([(0.3, 1.0)]));
    let mut engine = Engine::new(radar);
    let target = MapRequest { first: false, last: false, ends: false, ..MapRequest::default() };
    let frame = engine.settle(&scene, &target).unwrap();
    assert!(frame.first.is_none() && frame.last.is_none() && frame.ends.is_none() && frame.full.is_some());
    assert!(!frame.report.ran(EngineStage::FirstMap) && frame.report.ran(EngineStage::FullMap));
    assert!(!engine.update(&scene, &MapRequest::default()).unwrap().settled, "the other maps are not at hand");
    assert!(engine.settle(&Scene::of_points([(f64::NAN, 1.0)]), &target).is_err());
    let held = engine.cache_bytes();
    engine.settle(&scene, &MapRequest::default()).unwrap();
    assert!(engine.cache_bytes() > held);
    engine.forget();
    assert!(!engine.update(&scene, &MapRequest::default()).unwrap().settled);
}

#[test]
fn taking_away_a_giant_leaves_nothing_of_it() {
    let mut engine = Engine::new(small());
    let small_one = Object::Point(Point { reflectivity: 1e-20, ..Point::new(0.2, 1.0) });
    let giant = Object::Point(Point { reflectivity: 1e30, ..Point::new(0.1, 1.2) });
    let other = Object::Point(Point { reflectivity: 1e-20, ..Point::new(-0.4, 0.9) });
    let wanted = MapRequest::default();
    let with = Scene { objects: vec![small_one.clone(), giant, other.clone()], ..Scene::default() };
    engine.update(&with, &wanted).unwrap();
    let without = Scene { objects: vec![small_one, other], ..Scene::default() };
    engine.update(&without, &wanted).unwrap();
    let mut fresh = Engine::new(small());
    fresh.update(&without, &wanted).unwrap();
    let off = profile_difference(&engine, &fresh);
    assert!(off < 1e-12, "{off:e}");
}

/// Also without a floor, where quiet echoes have few rows.
#[test]
fn dragging_one_of_three_leaves_two_as_they_were() {
    let normalisation = Normalisation::DynamicRange(Decibels(100.0));
    let wanted = MapRequest { floor: Floor::Exact, normalisation, ends: false, ..MapRequest::default() };
    let mut engine = Engine::new(Radar { elements: 64, end_elements: 4, ..Radar::default() });
    let mut scene = Scene::of_points([(-30.0, 2.4), (7.0, 22.4), (-17.0, 9.4)]);
    engine.update(&scene, &wanted).unwrap();
    for step in 0..4 {
        scene.objects[0].translate(0.01, 0.0);
        let frame = engine.update(&scene, &wanted).unwrap();
        let what = said(&frame, EngineStage::Signal);
        assert!(what.contains(" of 3 reflectors"), "step {step}: {what}");
    }
}

/// Largest difference of Lambda between two frames, over all three maps.
fn worst_lambda(a: &EngineFrame, b: &EngineFrame) -> f32 {
    let apertures = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
    let maps = |f: &EngineFrame| apertures.map(|aperture| f.map(aperture).unwrap().lambda.clone());
    let pairs = maps(a).into_iter().zip(maps(b));
    pairs
        .flat_map(|(a, b)| a.lambda.iter().zip(&b.lambda).map(|(a, b)| (a - b).abs()).collect::<Vec<_>>())
        .fold(0.0, f32::max)
}

#[test]
fn what_is_cancelled_leaves_nothing_half_made() {
    let (before, after) = (Scene::of_points([(0.3, 1.0), (-0.4, 1.7)]), Scene::of_points([(0.3, 1.0), (0.1, 1.2)]));
    let cancelled = Task::default();
    cancelled.cancel();
    let is_cancelled =
        |frame: Result<EngineFrame, SimulationError>| matches!(frame, Err(SimulationError::Cancelled(_)));
    // Without the samples of the ends the cancellation happens among the range profiles.
    for ends in [true, false] {
        let wanted = MapRequest { ends, ..MapRequest::default() };
        let mut engine = Engine::new(small());
        let kept = engine.update(&before, &wanted).unwrap();
        assert!(is_cancelled(engine.settle_for(&cancelled, &before, &wanted)));
        let still = engine.update(&before, &wanted).unwrap();
        assert!(Arc::ptr_eq(&lambda(&kept), &lambda(&still)), "what was there before stays");
        assert!(is_cancelled(engine.update_for(&cancelled, &after, &wanted)));
        let (then, fresh) = (engine.update(&after, &wanted), Engine::new(small()).update(&after, &wanted));
        let worst = worst_lambda(&then.unwrap(), &fresh.unwrap());
        assert!(worst < 1e-3, "{worst}");
    }
    let mut built = before;
    built.disturbances.elements.elements =
        vec![crate::radar::ElementError { position_millimetres: 0.5, ..Default::default() }; 64];
    assert!(is_cancelled(Engine::new(small()).update_for(&cancelled, &built, &MapRequest::default())));
}

/// Without a floor, a drag recomputes only rows with an echo of the dragged reflector, and the maps are those of a fresh build.
#[test]
fn only_rows_that_changed_are_recomputed() {
    let radar = Radar { elements: 128, samples: 512, end_elements: 12, ..Radar::default() };
    let fixed = Normalisation::DynamicRange(Decibels(100.0));
    let wanted = MapRequest { floor: Floor::Exact, normalisation: fixed, ends: false, ..MapRequest::default() };
    let mut engine = Engine::new(radar.clone());
    let mut scene = Scene::of_points((0..40).map(|i| (f64::from(i % 7) - 3.0, 4.0 + 0.7 * f64::from(i))));
    engine.update(&scene, &wanted).unwrap();
    for step in 0..7 {
        scene.objects[20].translate(0.03, 0.05);
        let frame = match step {
            // A hidden map misses a move, and is updated when shown again.
            2 => {
                engine.update(&scene, &MapRequest { full: false, ..wanted }).unwrap();
                scene.objects[20].translate(0.3, 0.0);
                engine.update(&scene, &wanted).unwrap()
            }
            // Another floor, and back.
            4 => {
                engine.update(&scene, &MapRequest { floor: Floor::Thesis, ..wanted }).unwrap();
                engine.update(&scene, &wanted).unwrap()
            }
            _ => engine.update(&scene, &wanted).unwrap(),
        };
        let rows = said(&frame, EngineStage::FullMap);
        match step {
            // A move over noise changes every row, and so does the return to no floor.
            4 | 5 => assert_eq!(rows, "512 rows"),
            _ => assert!(rows.contains("of 512 rows"), "step {step}: {rows}"),
        }
        let fresh = Engine::new(radar.clone()).update(&scene, &wanted).unwrap();
        let worst = worst_lambda(&frame, &fresh);
        assert!(worst < 0.01, "step {step}: {worst}");
    }
    let frame = engine.update(&scene, &MapRequest { floor: Floor::Thesis, ..wanted }).unwrap();
    let rows = said(&frame, EngineStage::FullMap);
    assert!(rows.contains("floor"), "{rows}");
}

/// f32 with min-max and no floor would show the rounding of f32, so it is refused even where it is forced.
#[test]
fn single_precision_is_refused_below_its_rounding() {
    let scene = Scene::of_points([(0.3, 1.0), (-0.2, 1.4)]);
    let forced = PlanOverrides { precision: Some(Precision::F32), tolerance: Some(1e-6), ..PlanOverrides::default() };
    let signal = |engine: &mut Engine, scene: &Scene, floor, normalisation| {
        let frame = engine.update(scene, &MapRequest { floor, normalisation, ..MapRequest::default() }).unwrap();
        said(&frame, EngineStage::Signal)
    };
    let fixed = Normalisation::DynamicRange(Decibels(60.0));
    let mut engine = Engine::new(small());
    let planned = signal(&mut engine, &scene, Floor::Exact, Normalisation::MinMax);
    assert!(planned.contains("in f64") && engine.single.is_none(), "{planned}");
    engine.force(forced);
    let refused = signal(&mut engine, &scene, Floor::Exact, Normalisation::MinMax);
    assert!(refused.contains("in f64") && refused.contains("although f32"), "{refused}");
    assert!(engine.single.is_none());
    engine.forget();
    let fine = signal(&mut engine, &scene, Floor::Exact, fixed);
    assert!(fine.contains("in f32") && !fine.contains("although"), "{fine}");
    let same_scene = signal(&mut engine, &scene, Floor::Exact, Normalisation::MinMax);
    assert!(same_scene.contains("in f64"), "maps at hand are no way around it: {same_scene}");
    let giant = Scene {
        objects: vec![Object::Point(Point { reflectivity: 1e30, ..Point::new(0.3, 1.0) })],
        ..Scene::default()
    };
    let refused = signal(&mut engine, &giant, Floor::Exact, fixed);
    assert!(refused.contains("in f64") && refused.contains("amplitudes"), "{refused}");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let scene = Scene::of_points((0..50).map(|i| (f64::from(i) * 0.05 - 0.7, 1.0)));
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lambda(&Engine::new(small()).update(&scene, &MapRequest::default()).unwrap()))
    };
    assert_eq!(with(1).lambda, with(3).lambda);
}
