//! Tests of scenes built to break numerics, by every algorithm in both precisions, and of many random edits: every value is finite, every
//! tolerance is kept, and incremental sums equal those of a fresh build.

use super::front::MapConvention;
use super::front::reference::{JudgedProfiles, SEED, UnitNoise, maps_of, profile};
use crate::engine::{Engine, MapRequest, PlanOverrides};
use crate::maps::tolerance::tolerance_for;
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{Decibels, Radar};
use crate::scene::{Line, MIN_ELEMENT_DISTANCE_METRES, Object, Point, Reflector, Scene};
use crate::signal::plan::{self, BEST_TOLERANCE, amplitude_bound};
use crate::signal::{Algorithm, Floor, Precision, SynthesisPlan, beat_signal};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};

/// The plain algorithms, and the judge, take minutes for more reflectors than this on the whole radar.
const MAX_PLAIN_REFLECTORS: usize = 1000;
const TOLERANCES: [(Precision, f64); 2] = [(Precision::F32, 1e-6), (Precision::F64, 1e-12)];
/// The two conventions of errors, and the one whose floor is rounding.
const CONVENTIONS: [MapConvention; 3] = [MapConvention::FIXED_RANGE, MapConvention::THESIS, MapConvention::NO_FLOOR];
const COMPARISONS: usize = 20;

fn small() -> Radar {
    Radar { elements: 48, samples: 32, end_elements: 6, ..Radar::default() }
}

/// Every scene for this radar; `many` points in those where many coincide.
fn scenes(radar: &Radar, many: usize) -> Vec<(&'static str, Vec<Reflector>)> {
    let point = |x_metres: f64, y_metres: f64, reflectivity: f64| Reflector { x_metres, y_metres, reflectivity };
    let element = radar.element_x_metres(radar.elements / 3);
    let max = radar.max_range_metres();
    let far = max / 2.0;
    let beside = MIN_ELEMENT_DISTANCE_METRES * 1.001;
    let cancelling = (0..8).flat_map(|i| [1.0, -1.0].map(|r| point(0.7, far * (0.3 + 0.1 * f64::from(i)), r)));
    let edge_on = [1e-300, 1e-9, 1e-3, 0.0].into_iter().flat_map(|y| [far, -far].map(|x| point(x, y, 1.0)));
    let wrapped = [1.0, 1.0 - 1e-9, 3.7, 1e3, 1e7, 1e10].map(|m| point(0.1, m * max, m * m));
    let decades = (-30..=30).map(|e| point(0.05 * f64::from(e), far * (1.0 + 0.01 * f64::from(e)), 10f64.powi(e)));
    vec![
        ("empty", vec![]),
        ("one point", vec![point(0.3, far, 1.0)]),
        ("a micrometre beside an element", vec![point(element, beside, 1.0), point(0.3, far, 1.0)]),
        ("in the line of the array", vec![point(element + radar.element_spacing_metres * 0.5, 0.0, 1.0)]),
        ("pairs that cancel", cancelling.collect()),
        ("coincident points", vec![point(-1.1, far, 1.0); many]),
        ("points 1e-12 m apart", (0..20).map(|i| point(2.0 + 1e-12 * f64::from(i), far, 1.0)).collect()),
        ("near cos = 1 and -1", edge_on.collect()),
        ("behind the array", vec![point(1.0, -far, 1.0), point(-2.0, -0.1, 1.0)]),
        ("ranges that wrap", wrapped.to_vec()),
        ("reflectivities from 1e-30 to 1e30", decades.collect()),
        ("reflectivities of 1e100 and -1e100", vec![point(0.1, far, 1e100), point(0.2, far, -1e100)]),
        ("reflectivity zero: all cells alike", vec![point(0.3, far, 0.0), point(0.4, far, -0.0)]),
        ("subnormal reflectivity: all cells alike", vec![point(0.3, far, 1e-310), point(0.4, far, 5e-324)]),
    ]
}

fn scene(reflectors: &[Reflector]) -> Scene {
    let object =
        |r: &Reflector| Object::Point(Point { reflectivity: r.reflectivity, ..Point::new(r.x_metres, r.y_metres) });
    Scene { objects: reflectors.iter().map(object).collect(), ..Scene::default() }
}

fn out_of_range(map: &RangeAngleMap) -> usize {
    map.lambda.iter().filter(|v| !(0.0..=1.0).contains(*v)).count()
}

struct Case<'a> {
    radar: &'a Radar,
    scene: Scene,
    judge: JudgedProfiles,
    /// Largest possible sum of the amplitudes in a range cell.
    scale: f64,
}

struct Outcome {
    algorithm: Algorithm,
    /// Largest error of a range cell over [`Case::scale`].
    signal_error: f64,
}

impl<'a> Case<'a> {
    fn new(radar: &'a Radar, reflectors: &[Reflector]) -> Self {
        // Windowed and transformed, a reflector's profile peaks at (N - 1) / 2 / sqrt(N) times its amplitude.
        let gain = (radar.samples as f64 - 1.0) / 2.0 / (radar.samples as f64).sqrt();
        // Errors of cells far below the logarithm's guard don't count.
        let scale = gain * plan::amplitude_bound(radar, reflectors).max(crate::maps::LOG_GUARD);
        Case { radar, scene: scene(reflectors), judge: JudgedProfiles::new(radar, reflectors), scale }
    }

    fn holds(&self, name: &str) -> Vec<Outcome> {
        let mut outcomes = Vec::new();
        for algorithm in Algorithm::ALL {
            if algorithm.is_fast() {
                outcomes.extend(TOLERANCES.map(|(precision, t)| self.fast(name, algorithm, precision, t)));
            } else if self.scene.objects.len() <= MAX_PLAIN_REFLECTORS {
                outcomes.push(self.plain(name, algorithm));
            }
        }
        outcomes
    }

    fn fast(&self, name: &str, algorithm: Algorithm, precision: Precision, tolerance: f64) -> Outcome {
        let mut engine = Engine::new(self.radar.clone());
        let forced =
            PlanOverrides { algorithm: Some(algorithm), precision: Some(precision), tolerance: Some(tolerance) };
        engine.force(forced);
        let mut outcome = Outcome { algorithm, signal_error: 0.0 };
        for convention in CONVENTIONS {
            let MapConvention { floor, normalisation } = convention;
            let wanted = MapRequest { floor, normalisation, seed: SEED, ends: false, ..MapRequest::default() };
            let frame = engine.update(&self.scene, &wanted).unwrap();
            // A scene without reflectors has no profiles.
            let profile = |n| engine.range_profile(n).or_else(|| Some(vec![Default::default(); self.radar.samples]));
            outcome.signal_error = self.judge.error(self.radar, profile, self.scale).max(outcome.signal_error);
            let finite = |n: usize| profile(n).into_iter().flatten().all(|v| v.is_finite());
            assert!((0..self.radar.elements).all(finite), "{name}, {algorithm} in {precision}: not finite");
            let Some(maps) = maps_of(&frame) else { continue };
            assert_eq!(maps.map(out_of_range), [0; 3], "{name}, {algorithm} in {precision}");
        }
        assert!(outcome.signal_error <= tolerance, "{name}, {algorithm} in {precision}: {:e}", outcome.signal_error);
        outcome
    }

    fn plain(&self, name: &str, algorithm: Algorithm) -> Outcome {
        let plan = SynthesisPlan::cheapest(0, 0.0, BEST_TOLERANCE).with_algorithm(algorithm);
        let noise = UnitNoise::new(self.radar);
        let reflectors = self.scene.reflectors();
        let signal = beat_signal(self.radar, &reflectors, &plan);
        let maps = CONVENTIONS.map(|c| noise.plain_maps(self.radar, &reflectors, &signal, c));
        assert!(signal.samples.iter().all(|v| v.is_finite()), "{name}, {algorithm}: not finite");
        assert_eq!(maps.iter().flatten().map(out_of_range).sum::<usize>(), 0, "{name}, {algorithm}");
        let found = |n| profile(self.radar, signal.samples.view(), n);
        let signal_error = self.judge.error(self.radar, found, self.scale);
        // The direct formula has the rounding of the thesis, and no tolerance.
        let most = if algorithm == Algorithm::Exact { 1e-12 } else { f64::MAX };
        assert!(signal_error <= most, "{name}, {algorithm}: {signal_error:e}");
        Outcome { algorithm, signal_error }
    }
}

fn every_scene_holds(radar: &Radar, coincident: usize) {
    let mut outcomes = Vec::new();
    for (name, reflectors) in scenes(radar, coincident) {
        scene(&reflectors).validate(radar).unwrap();
        outcomes.extend(Case::new(radar, &reflectors).holds(name));
    }
    assert!(outcomes.len() > 100, "{} cases", outcomes.len());
    // A run without any visible error proves nothing: the plain formula's rounding and f32's must show.
    assert!(outcomes.iter().any(|o| o.algorithm == Algorithm::Direct && o.signal_error > 1e-14));
}

#[test]
fn every_scene_holds_on_a_small_radar() {
    every_scene_holds(&small(), 300);
}

#[test]
#[ignore = "takes minutes: the whole radar, ten thousand points in one place, ten thousand edits"]
fn every_scene_holds_on_the_whole_radar() {
    every_scene_holds(&Radar::default(), 10_000);
    edits_end_at_a_fresh_build(&small(), &MapRequest { ends: false, ..MapRequest::default() }, 10_000, 2);
}

fn random_object(rng: &mut impl RngExt) -> Object {
    let mut at = |span: f64| (rng.random::<f64>() - 0.5) * span;
    let (x_metres, y_metres) = (at(4.0), 1.5 + at(2.0));
    let reflectivity = 10f64.powf(at(8.0));
    if at(1.0) < 0.35 {
        Object::Point(Point { reflectivity, ..Point::new(x_metres, y_metres) })
    } else {
        Object::Line(Line { reflectivity, ..Line::vertical(x_metres, y_metres, 0.1, 5) })
    }
}

/// Edits objects at random (`seed`), and compares the engine's state with a fresh build; its caches must not grow.
fn edits_end_at_a_fresh_build(radar: &Radar, wanted: &MapRequest, edits: usize, seed: u64) {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut engine = Engine::new(radar.clone());
    let mut scene = Scene { objects: (0..12).map(|_| random_object(&mut rng)).collect(), ..Scene::default() };
    // The errors of both engines, and half a tolerance that the edited one may gather before it recomputes the sum.
    let most = 2.5 * tolerance_for(wanted.floor, wanted.normalisation);
    let (mut worst, mut early_bytes) = (0.0f64, None);
    for edit in 1..=edits {
        let at = rng.random_range(0..scene.objects.len());
        match rng.random_range(0..10) {
            0 if scene.objects.len() < 30 => scene.objects.push(random_object(&mut rng)),
            1 if scene.objects.len() > 3 => drop(scene.objects.remove(at)),
            2 => scene.objects.swap(0, at),
            3 => scene.objects[at] = random_object(&mut rng),
            _ => scene.objects[at].translate(rng.random::<f64>() * 0.1 - 0.05, rng.random::<f64>() * 0.1 - 0.05),
        }
        engine.update(&scene, wanted).unwrap();
        if edit % (edits / COMPARISONS) == 0 {
            let mut fresh = Engine::new(radar.clone());
            fresh.update(&scene, wanted).unwrap();
            worst = worst.max(apart(radar, &engine, &fresh, &scene));
            early_bytes.get_or_insert(engine.cache_bytes());
        }
    }
    assert!(worst > 0.0 && worst <= most, "{worst:e} of {most:e}");
    assert!(engine.cache_bytes() <= early_bytes.unwrap(), "the caches grow");
}

/// Largest difference of range cells, relative to a cell in which all echoes of the scene are in phase, as tolerances are.
fn apart(radar: &Radar, engine: &Engine, fresh: &Engine, scene: &Scene) -> f64 {
    let weights: f64 = radar.window.weights(radar.samples).iter().sum();
    let together = amplitude_bound(radar, &scene.reflectors()) * weights / (radar.samples as f64).sqrt();
    let cells =
        |engine: &Engine| (0..radar.elements).flat_map(|n| engine.range_profile(n).unwrap()).collect::<Vec<_>>();
    let pairs = cells(engine).into_iter().zip(cells(fresh));
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / together
}

#[test]
fn edits_over_the_thesis_floor_end_at_a_fresh_build() {
    let radar = Radar { elements: 64, samples: 64, end_elements: 8, ..Radar::default() };
    edits_end_at_a_fresh_build(&radar, &MapRequest { ends: false, ..MapRequest::default() }, 1500, 2);
}

/// Edits where only the rows that changed are computed again.
#[test]
fn edits_over_no_floor_end_at_a_fresh_build() {
    let normalisation = Normalisation::DynamicRange(Decibels(100.0));
    let wanted = MapRequest { floor: Floor::Exact, normalisation, ends: false, ..MapRequest::default() };
    edits_end_at_a_fresh_build(&Radar { samples: 256, ..small() }, &wanted, 200, 3);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn any_points_are_summed_as_promised(
        points in prop::collection::vec((-60.0..60.0f64, -60.0..60.0f64, -32.0..32.0f64, any::<bool>()), 0..7),
    ) {
        let reflector = |(x_metres, y_metres, decades, negative): (f64, f64, f64, bool)| {
            Reflector { x_metres, y_metres, reflectivity: 10f64.powf(decades) * if negative { -1.0 } else { 1.0 } }
        };
        let points: Vec<_> = points.into_iter().map(reflector).collect();
        Case::new(&small(), &points).holds("random points");
    }
}
