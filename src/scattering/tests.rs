//! The formulas against vectors, quadrature and series, and what must hold of them whatever the scene.

use super::face::Face;
use super::*;
use crate::radar::{Carrier, Radar};
use crate::scene::{Block, Object, Point, Polygon, Post, Scene, Wall};
use serde::Deserialize;

/// Samples over the chirp at which echoes are compared.
const SAMPLES: [usize; 5] = [0, 100, 255, 400, 511];

#[derive(Deserialize)]
struct Vectors {
    scenes: Vec<VectorScene>,
}

#[derive(Deserialize)]
struct VectorScene {
    name: String,
    objects: Vec<VectorObject>,
    refined: bool,
    transmitters: Vec<[f64; 2]>,
    receivers: Vec<[f64; 2]>,
    echoes: Vec<VectorEcho>,
    error: Option<f64>,
    error_tilt: Option<f64>,
    only_first: bool,
}

#[derive(Deserialize)]
struct VectorObject {
    kind: String,
    corners: Vec<[f64; 2]>,
    #[serde(default)]
    radius: f64,
    r: f64,
}

#[derive(Deserialize)]
struct VectorEcho {
    range: Vec<f64>,
    re: Vec<f64>,
    im: Vec<f64>,
    tilt_re: Option<Vec<f64>>,
    tilt_im: Option<Vec<f64>>,
}

fn vectors() -> Vec<VectorScene> {
    serde_json::from_str::<Vectors>(include_str!("vectors.json")).unwrap().scenes
}

fn wall([a, b]: [[f64; 2]; 2], reflectivity: f64) -> Wall {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let wall = Wall::new((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, dx.hypot(dy), dy.atan2(dx).to_degrees());
    Wall { reflectivity, ..wall }
}

fn object(of: &VectorObject) -> Object {
    match (of.kind.as_str(), of.corners.as_slice()) {
        ("face", &[a, b]) => Object::Wall(wall([a, b], of.r)),
        ("post", &[[x, y]]) => Object::Post(Post { reflectivity: of.r, ..Post::new(x, y, of.radius) }),
        ("point", &[[x, y]]) => Object::Point(Point { reflectivity: of.r, ..Point::new(x, y) }),
        ("polygon", corners) => Object::Polygon(Polygon { reflectivity: of.r, ..Polygon::new(corners.to_vec()) }),
        (kind, _) => panic!("{kind}"),
    }
}

/// Echoes of a scene at a pair that it hears.
fn echoes(radar: &Radar, of: &VectorScene, antennas: &Antennas) -> Vec<PathEcho> {
    let mut out = Vec::new();
    if let [VectorObject { kind, corners, r, .. }] = of.objects.as_slice()
        && kind == "corner"
    {
        let wave = Wave::of(radar);
        let [first, second] = [[corners[0], corners[1]], [corners[1], corners[2]]].map(|f| Face::new(f, false, *r));
        out.push(first.echoes(&wave, antennas)[1]);
        out.push(second.echoes(&wave, antennas)[2]);
        out.extend(corner::echoes(&wave, antennas, &first, &second));
    } else {
        let scene = Scene { objects: of.objects.iter().map(object).collect(), ..Scene::default() };
        let seen = Seen::all(radar, &scene);
        for one in seen.iter().take(if of.only_first { 1 } else { seen.len() }) {
            let scatterer = Scatterer::new(radar, &one.object, &one.hidden_by);
            let scatterer = if of.refined { scatterer } else { scatterer.unrefined() };
            scatterer.echoes(antennas, &mut out);
        }
    }
    out.retain(PathEcho::is_heard);
    out
}

fn pairs(of: &VectorScene) -> Vec<Antennas> {
    let both = of.transmitters.iter().zip(&of.receivers);
    both.map(|(t, r)| Antennas { transmitter_metres: *t, receiver_metres: *r }).collect()
}

#[test]
fn every_vector_is_met() {
    let radar = Radar::default();
    let scenes = vectors();
    assert!(scenes.len() > 20);
    for scene in &scenes {
        for (i, antennas) in pairs(scene).iter().enumerate() {
            let found = echoes(&radar, scene, antennas);
            let expected: Vec<_> = scene.echoes.iter().filter(|e| e.re[i] != 0.0 || e.im[i] != 0.0).collect();
            // Amplitudes that are written as zero may be anything far below the others.
            let strongest = expected.iter().map(|e| e.re[i].hypot(e.im[i])).fold(0.0, f64::max);
            let heard = found.iter().filter(|e| e.amplitude.norm() > 1e-9 * strongest).count();
            assert!(heard <= expected.len(), "{}: {found:#?}", scene.name);
            for echo in expected {
                let amplitude = Complex64::new(echo.re[i], echo.im[i]);
                let apart = |e: &PathEcho| (e.range_metres - echo.range[i]).abs() + (e.amplitude - amplitude).norm();
                let nearest = found.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
                let nearest = nearest.unwrap_or_else(|| panic!("{}, pair {i}: no echo", scene.name));
                let off = (nearest.amplitude - amplitude).norm() / amplitude.norm();
                let range_off = (nearest.range_metres - echo.range[i]).abs();
                assert!(range_off < 1e-9, "{}, pair {i}: {range_off:e}", scene.name);
                assert!(off < 1e-7, "{}, pair {i}: {off:e}", scene.name);
                if let (Some(re), Some(im)) = (&echo.tilt_re, &echo.tilt_im) {
                    let tilt = Complex64::new(re[i], im[i]);
                    assert!(
                        (nearest.tilt - tilt).norm() <= 1e-6 * tilt.norm() + 1e-12,
                        "{}: {}",
                        scene.name,
                        nearest.tilt
                    );
                }
            }
        }
    }
}

/// Samples of echoes, with or without their tilt.
fn samples(radar: &Radar, echoes: &[PathEcho], with_tilt: bool) -> Vec<Complex64> {
    let middle = Wave::of(radar).radians_per_metre;
    let sample = |n: &usize| {
        let kappa = reference::radians_per_metre(radar, *n);
        let more = if with_tilt { kappa.abs() - middle } else { 0.0 };
        let add = |e: &PathEcho| (e.amplitude + e.tilt * more) * Complex64::cis(-kappa * e.range_metres);
        echoes.iter().map(add).sum()
    };
    SAMPLES.iter().map(sample).collect()
}

/// Largest difference over the largest reference.
fn worst(found: &[Complex64], expected: &[Complex64]) -> f64 {
    let peak = expected.iter().map(|v| v.norm()).fold(0.0, f64::max);
    found.iter().zip(expected).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / peak
}

#[test]
fn faces_are_their_quadrature() {
    let radar = Radar::default();
    let mut checked = 0;
    for scene in vectors() {
        let (Some(error), Some(error_tilt)) = (scene.error, scene.error_tilt) else { continue };
        let (Object::Wall(_) | Object::Polygon(_)) = object(&scene.objects[0]) else { continue };
        let outline = &scene.objects[0].corners;
        let count = if scene.objects[0].kind == "face" { 1 } else { outline.len() };
        let (mut plain, mut tilted, mut expected) = (Vec::new(), Vec::new(), Vec::new());
        for antennas in pairs(&scene) {
            let found = echoes(&radar, &scene, &antennas);
            plain.extend(samples(&radar, &found, false));
            tilted.extend(samples(&radar, &found, true));
            let mut sums = vec![Complex64::default(); SAMPLES.len()];
            for i in 0..count {
                let ends = [outline[i], outline[(i + 1) % outline.len()]];
                let is_outside = |p: [f64; 2]| {
                    let ([ax, ay], [bx, by]) = (ends[0], ends[1]);
                    (p[0] - ax) * (by - ay) - (p[1] - ay) * (bx - ax) > 0.0
                };
                if count == 1 || is_outside(antennas.transmitter_metres) && is_outside(antennas.receiver_metres) {
                    let of_face = reference::face(&radar, ends, scene.objects[0].r, &antennas, &SAMPLES);
                    sums.iter_mut().zip(of_face).for_each(|(s, v)| *s += v);
                }
            }
            expected.extend(sums);
        }
        let (plain, tilted) = (worst(&plain, &expected), worst(&tilted, &expected));
        assert!(plain < 1.1 * error, "{}: {plain:e}, expected {error:e}", scene.name);
        assert!(tilted < 1.1 * error_tilt, "{} with tilt: {tilted:e}, expected {error_tilt:e}", scene.name);
        checked += 1;
    }
    assert!(checked > 10);
}

#[test]
fn the_two_way_carrier_is_held_to_quadrature() {
    let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
    for ends in [[[-2.0, 10.0], [2.0, 10.0]], [[3.0, 5.0], [9.0, 5.0]]] {
        let antennas = Antennas::at([0.3, 0.0]);
        let mut found = Vec::new();
        Scatterer::new(&radar, &Object::Wall(wall(ends, 1.0)), &[]).echoes(&antennas, &mut found);
        let expected = reference::face(&radar, ends, 1.0, &antennas, &SAMPLES);
        let off = worst(&samples(&radar, &found, true), &expected);
        assert!(off < 1e-3, "{ends:?}: {off:e}");
    }
}

#[test]
fn posts_are_their_exact_series() {
    let radar = Radar::default();
    for (centre, radius, bound) in
        [([1.0, 5.0], 0.05, 5e-4), ([-3.0, 20.0], 0.5, 5e-5), ([0.2, 2.0], 0.02, 1.5e-3), ([0.0, 10.0], 1.0, 1e-4)]
    {
        for x in [-0.9, 0.0, 0.4] {
            let antennas = Antennas::at([x, 0.0]);
            let mut found = Vec::new();
            let post = Object::Post(Post::new(centre[0], centre[1], radius));
            Scatterer::new(&radar, &post, &[]).echoes(&antennas, &mut found);
            let expected: Vec<_> =
                SAMPLES.iter().map(|n| reference::post(&radar, centre, radius, [x, 0.0], *n)).collect();
            let off = worst(&samples(&radar, &found, false), &expected);
            assert!(off < bound, "radius {radius} at {x}: {off:e}");
        }
    }
}

/// A scene of every kind, rough and smooth, some hidden.
fn all_kinds() -> Vec<Object> {
    vec![
        Object::Wall(Wall { roughness_millimetres: 0.5, ..Wall::new(-4.0, 18.0, 6.0, 20.0) }),
        Object::Box(Block::new([2.0, 9.0], [4.5, 1.8], 70.0)),
        Object::Post(Post::new(-1.5, 7.0, 0.3)),
        Object::Polygon(Polygon::new(vec![
            [4.0, 14.0],
            [5.0, 14.0],
            [5.0, 15.5],
            [7.0, 15.5],
            [7.0, 16.5],
            [4.0, 16.5],
        ])),
        Object::Point(Point::new(3.0, 20.0)),
    ]
}

fn heard(radar: &Radar, objects: &[Object], antennas: &Antennas) -> Vec<PathEcho> {
    let scene = Scene { objects: objects.to_vec(), ..Scene::default() };
    let mut out = Vec::new();
    for one in Seen::all(radar, &scene) {
        Scatterer::new(radar, &one.object, &one.hidden_by).echoes(antennas, &mut out);
    }
    out
}

#[test]
fn swapping_transmitter_and_receiver_changes_nothing() {
    let radar = Radar::default();
    for (t, r) in [([-0.6, 0.0], [0.9, 0.1]), ([0.2, 0.0], [0.25, 0.0])] {
        let there = Antennas { transmitter_metres: t, receiver_metres: r };
        let back = Antennas { transmitter_metres: r, receiver_metres: t };
        let [there, back] =
            [there, back].map(|antennas| samples(&radar, &heard(&radar, &all_kinds(), &antennas), false));
        let off = worst(&there, &back);
        assert!(off < 1e-9, "{off:e}");
    }
}

#[test]
fn antennas_at_one_place_have_the_monostatic_closed_forms() {
    let radar = Radar::default();
    let at = |object: Object| heard(&radar, &[object], &Antennas::at([0.0, 0.0]));
    let glint = at(Object::Wall(Wall::new(0.0, 9.0, 200.0, 0.0)))[0];
    assert!((glint.range_metres - 9.0).abs() < 1e-12 && (glint.amplitude - 100.0 / 27.0).norm() < 1e-12);
    let post = at(Object::Post(Post::new(0.0, 9.0, 0.5)))[0];
    let expected = 100.0 / 8.5f64.powi(2) * (0.5 * 8.5 / 9.0f64).sqrt();
    assert!((post.range_metres - 8.5).abs() < 1e-12 && (post.amplitude.re - expected).abs() < 1e-9);
}

#[test]
fn a_post_of_one_metre_is_a_point_from_afar() {
    let radar = Radar::default();
    let post = heard(&radar, &[Object::Post(Post::new(0.0, 1000.0, 1.0))], &Antennas::at([0.0, 0.0]))[0];
    assert!((post.amplitude.norm() * post.range_metres.powi(2) / 100.0 - 1.0).abs() < 1e-3);
    let flat = heard(&radar, &[Object::Post(Post::new(0.0, 10.0 + 9e3, 9e3))], &Antennas::at([0.0, 0.0]))[0];
    assert!((flat.amplitude.norm() / (100.0 / 10f64.powf(1.5)) - 1.0).abs() < 1e-3, "a huge post is a wall");
}

/// Largest step of a sample over its largest value, as something moves in steps of 0.1 mm.
fn largest_step(of: impl Fn(f64) -> Vec<Complex64>, from: f64, steps: u32) -> f64 {
    let (mut worst, mut peak) = (0.0f64, 0.0f64);
    let mut before: Option<Vec<Complex64>> = None;
    for i in 0..steps {
        let now = of(from + 1e-4 * f64::from(i));
        peak = now.iter().map(|v| v.norm()).fold(peak, f64::max);
        if let Some(before) = before {
            worst = before.iter().zip(&now).map(|(a, b)| (a - b).norm()).fold(worst, f64::max);
        }
        before = Some(now);
    }
    worst / peak
}

/// Echoes at the middle of the chirp, each freed of the phase of a way that many share.
fn at_range(echoes: &[PathEcho], kappa: f64, range: f64) -> Vec<Complex64> {
    vec![echoes.iter().map(|e| e.amplitude * Complex64::cis(-kappa * (e.range_metres - range))).sum()]
}

#[test]
fn nothing_jumps_where_the_foot_runs_off_a_face() {
    let radar = Radar::default();
    let kappa = Wave::of(&radar).radians_per_metre;
    let wall = Object::Wall(Wall::new(-1.0, 20.0, 2.0, 0.0));
    let step = largest_step(
        |x| at_range(&heard(&radar, std::slice::from_ref(&wall), &Antennas::at([x, 0.0])), kappa, 20.0),
        -0.05,
        1000,
    );
    assert!(step < 0.002, "{step}");
    let car = Object::Box(Block::new([-2.0, 8.0], [4.0, 2.0], 0.0));
    let step = largest_step(
        |x| at_range(&heard(&radar, std::slice::from_ref(&car), &Antennas::at([x, 0.0])), kappa, 7.0),
        -0.05,
        1000,
    );
    assert!(step < 0.002, "{step}");
}

#[test]
fn an_obstacle_that_comes_from_the_side_begins_with_no_effect() {
    let radar = Radar::default();
    let kappa = Wave::of(&radar).radians_per_metre;
    let antennas = Antennas::at([0.0, 0.0]);
    let wall = Object::Wall(Wall::new(0.0, 20.0, 30.0, 0.0));
    let at = |x: f64| {
        let scene = [wall.clone(), Object::Box(Block::new([x, 10.0], [1.0, 0.2], 0.0))];
        let mut echoes = heard(&radar, &scene, &antennas);
        echoes.truncate(1);
        echoes[0]
    };
    let free = heard(&radar, std::slice::from_ref(&wall), &antennas)[0];
    assert_eq!(at(-4.0), free, "far beside the way");
    let mut last = 1.0;
    for i in 0..=40 {
        last = at(-2.0 + 0.05 * f64::from(i)).amplitude.norm() / free.amplitude.norm();
        assert!(last < 1.4, "{last}");
    }
    assert!(last < 0.1, "behind the middle of the box: {last}");
    let step = largest_step(|x| at_range(&[at(x)], kappa, free.range_metres), -1.6, 16_000);
    assert!(step < 0.002, "{step}");
}

#[test]
fn a_face_that_is_cut_in_two_gives_the_same_samples() {
    let radar = Radar::default();
    let wave = Wave::of(&radar);
    for cut in [-1.9, -0.3, 0.2, 1.234] {
        for antennas in
            [Antennas::at([0.2, 0.0]), Antennas { transmitter_metres: [-0.4, 0.0], receiver_metres: [0.8, 0.1] }]
        {
            let of = |from, to| {
                Face::new([[from, 8.0 + 0.3 * from], [to, 8.0 + 0.3 * to]], true, 1.0).echoes(&wave, &antennas)
            };
            let whole = samples(&radar, &of(-2.0, 2.0), true);
            let both = [of(-2.0, cut), of(cut, 2.0)].concat();
            assert!(worst(&samples(&radar, &both, true), &whole) < 1e-9, "{cut}");
        }
    }
}

#[test]
fn no_place_of_an_antenna_gives_a_number_that_is_none() {
    let radar = Radar::default();
    let corners = vec![[-1.0, 2.0], [1.0, 2.0], [1.0, 4.0], [0.0, 3.0], [-1.0, 4.0]];
    let objects = [
        Object::Wall(Wall::new(0.0, 2.0, 2.0, 0.0)),
        Object::Wall(Wall { roughness_millimetres: 1.0, ..Wall::new(0.0, 2.0, 0.0, 0.0) }),
        Object::Post(Post::new(0.0, 2.0, 1.0)),
        Object::Post(Post::new(0.0, 2.0, 0.0)),
        Object::Polygon(Polygon { roughness_millimetres: 1.0, ..Polygon::new(corners) }),
    ];
    let places = [[0.0, 2.0], [5.0, 2.0], [1.0, 2.0], [-1.0, 2.0], [0.2, 2.1], [0.0, 3.0], [0.0, 0.0]];
    for object in &objects {
        for t in places {
            for r in places {
                let antennas = Antennas { transmitter_metres: t, receiver_metres: r };
                let mut found = Vec::new();
                let screen = Object::Wall(Wall::new(0.0, 1.0, 2.0, 0.0));
                Scatterer::new(&radar, object, &[screen]).echoes(&antennas, &mut found);
                for echo in found.iter().filter(|e| e.is_heard()) {
                    // An antenna on a grain of a rough surface hears it infinitely loud, as one on a point does.
                    let is_on = echo.kind == EchoKind::Diffuse && echo.range_metres < 1e-9;
                    let usable = echo.amplitude.is_finite() && echo.range_metres.is_finite();
                    assert!(usable || is_on, "{object:?} {antennas:?}: {echo:?}");
                }
            }
        }
    }
}

#[test]
fn a_rough_wall_scatters_what_its_glint_loses() {
    let radar = Radar::default();
    let antennas = Antennas::at([0.0, 0.0]);
    let wave = Wave::of(&radar);
    let seeds = 200;
    let power = |seed: u64| -> f64 {
        let wall = Wall { roughness_millimetres: 1.0, seed, ..Wall::new(0.0, 4.0, 6.0, 0.0) };
        let found = heard(&radar, &[Object::Wall(wall)], &antennas);
        // Points of random phases: their sum's power.
        let diffuse = found.iter().filter(|e| e.kind == EchoKind::Diffuse);
        let sum: Complex64 =
            diffuse.map(|e| e.amplitude * Complex64::cis(-wave.radians_per_metre * e.range_metres)).sum();
        sum.norm_sqr()
    };
    let powers: Vec<f64> = (0..seeds).map(power).collect();
    let mean = powers.iter().sum::<f64>() / seeds as f64;
    let variance = powers.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / (seeds - 1) as f64;
    // The formula's integral: P^2 r^2 (1 - C^2) cos^2 / R^4 over the wall, for unit length.
    let steps = 60_000;
    let expected: f64 = (0..steps)
        .map(|i| {
            let u = 6.0 * ((f64::from(i) + 0.5) / f64::from(steps) - 0.5);
            let cos = 4.0 / u.hypot(4.0);
            let lost = 1.0 - roughness::coherent(&wave, 1e-3, cos).powi(2);
            1e4 * lost * cos * cos / u.hypot(4.0).powi(4) * 6.0 / f64::from(steps)
        })
        .sum();
    let error = (variance / seeds as f64).sqrt();
    assert!((mean - expected).abs() < 3.0 * error, "{mean} {expected} {error}");
    let smooth = heard(&radar, &[Object::Wall(Wall::new(0.0, 4.0, 6.0, 0.0))], &antennas)[0].amplitude.norm_sqr();
    let lost = smooth * (1.0 - roughness::coherent(&wave, 1e-3, 1.0).powi(2));
    let decibels = 10.0 * (mean / lost).log10();
    assert!(decibels.abs() < 1.5, "{decibels} dB of what the glint lost");
}

#[test]
fn roughness_takes_from_a_glint_what_rayleighs_factor_says() {
    let radar = Radar::default();
    let glint = |roughness_millimetres| {
        let wall = Wall { roughness_millimetres, ..Wall::new(0.0, 10.0, 4.0, 0.0) };
        heard(&radar, &[Object::Wall(wall)], &Antennas::at([0.0, 0.0]))[0].amplitude.norm()
    };
    for (roughness, decibels) in [(0.5, -2.7), (1.0, -10.7), (2.0, -43.0)] {
        let found = 20.0 * (glint(roughness) / glint(0.0)).log10();
        assert!((found - decibels).abs() < 0.1, "{roughness} mm: {found}");
    }
}

#[test]
fn a_right_inner_corner_is_one_echo_at_its_apex() {
    let radar = Radar::default();
    // An L whose inner corner faces the array.
    let ell = vec![[-1.0, 7.0], [0.0, 8.0], [1.0, 7.0], [1.5, 7.5], [0.0, 9.0], [-1.5, 7.5]];
    for x in [-0.9, 0.0, 0.5] {
        let found = heard(&radar, &[Object::Polygon(Polygon::new(ell.clone()))], &Antennas::at([x, 0.0]));
        let range = x.hypot(8.0);
        let at_apex: Complex64 = found
            .iter()
            .filter(|e| e.kind == EchoKind::DoubleBounce && (e.range_metres - range).abs() < 1e-9)
            .map(|e| e.amplitude)
            .sum();
        let glint = 100.0 * range.powf(-1.5);
        assert!((at_apex.norm() / glint - 1.0).abs() < 0.05, "{x}: {}", at_apex.norm() / glint);
    }
}

#[test]
fn what_a_body_hides_is_seen_again_without_shadows() {
    let radar = Radar::default();
    let objects = vec![Object::Point(Point::new(0.0, 20.0)), Object::Box(Block::new([0.0, 10.0], [6.0, 1.0], 0.0))];
    let scene = Scene { objects, ..Scene::default() };
    let amplitude = |scene: &Scene| {
        let echoing = Echoing::of(&radar, scene);
        let mut found = Vec::new();
        Sources::from(&echoing).scattered(radar.pair(500), &mut found);
        let hidden = found.iter().find(|e| e.kind == EchoKind::Point).map(|e| e.amplitude.norm());
        (echoing.points.len(), hidden)
    };
    let (points, hidden) = amplitude(&scene);
    assert!(points == 0 && hidden.unwrap() < 1e-3 * 0.25, "{hidden:?}");
    assert_eq!(amplitude(&Scene { shadows: false, ..scene }), (1, None));
}

#[test]
fn only_what_a_body_may_hide_depends_on_it() {
    let radar = Radar::default();
    let seen = |x: f64| {
        let objects = vec![
            Object::Post(Post::new(x, 5.0, 0.2)),
            Object::Wall(Wall::new(0.0, 20.0, 3.0, 0.0)),
            Object::Point(Point::new(15.0, 10.0)),
        ];
        Seen::all(&radar, &Scene { objects, ..Scene::default() })
    };
    let (before, after) = (seen(0.0), seen(0.3));
    assert!(before[1] != after[1] && before[2] == after[2] && before[2].hidden_by.is_empty());
    assert_eq!(seen(-8.0)[1], seen(-9.0)[1], "out of the way");
}
