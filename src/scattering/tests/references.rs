//! The formulas against vectors, the quadrature of a face and the exact series of a post.

use super::super::face::Face;
use super::*;
use crate::radar::Carrier;
use crate::scene::{Point, Polygon, Post, Wall};
use serde::Deserialize;

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
}

fn vectors() -> Vec<VectorScene> {
    serde_json::from_str::<Vectors>(include_str!("../vectors.json")).unwrap().scenes
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

fn echoes(radar: &Radar, of: &VectorScene, antennas: &AntennaPlaces) -> Vec<PathEcho> {
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
        let seen = ObjectWithOccluders::all(radar, &scene);
        for one in seen.iter().take(if of.only_first { 1 } else { seen.len() }) {
            let scatterer = one.scatterer(radar);
            let scatterer = if of.refined { scatterer } else { scatterer.unrefined() };
            scatterer.echoes(antennas, &mut out);
        }
    }
    out.retain(PathEcho::is_heard);
    out
}

fn pairs(of: &VectorScene) -> Vec<AntennaPlaces> {
    let both = of.transmitters.iter().zip(&of.receivers);
    both.map(|(t, r)| AntennaPlaces { transmitter_metres: *t, receiver_metres: *r }).collect()
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
            }
        }
    }
}

#[test]
fn faces_are_their_quadrature() {
    let radar = Radar::default();
    let mut checked = 0;
    for scene in vectors() {
        let Some(error) = scene.error else { continue };
        let (Object::Wall(_) | Object::Polygon(_)) = object(&scene.objects[0]) else { continue };
        let outline = &scene.objects[0].corners;
        let count = if scene.objects[0].kind == "face" { 1 } else { outline.len() };
        let (mut plain, mut expected) = (Vec::new(), Vec::new());
        for antennas in pairs(&scene) {
            let found = echoes(&radar, &scene, &antennas);
            plain.extend(samples(&radar, &found));
            let mut sums = vec![Complex64::default(); SAMPLES.len()];
            for i in 0..count {
                let ends = [outline[i], outline[(i + 1) % outline.len()]];
                let is_outside = |p: [f64; 2]| {
                    let ([ax, ay], [bx, by]) = (ends[0], ends[1]);
                    (p[0] - ax) * (by - ay) - (p[1] - ay) * (bx - ax) > 0.0
                };
                if count == 1 || is_outside(antennas.transmitter_metres) && is_outside(antennas.receiver_metres) {
                    let of_face = reference::face(&radar, ends, scene.objects[0].r, &antennas, &SAMPLES, 4.0);
                    sums.iter_mut().zip(of_face).for_each(|(s, v)| *s += v);
                }
            }
            expected.extend(sums);
        }
        let plain = worst(&plain, &expected);
        assert!(plain < 1.1 * error, "{}: {plain:e}, expected {error:e}", scene.name);
        checked += 1;
    }
    assert!(checked > 10);
}

#[test]
fn the_two_way_carrier_is_held_to_quadrature() {
    let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
    for (ends, bound) in [([[-2.0, 10.0], [2.0, 10.0]], 1e-3), ([[3.0, 5.0], [9.0, 5.0]], 2e-2)] {
        let antennas = AntennaPlaces::at([0.3, 0.0]);
        let found = heard(&radar, &[Object::Wall(wall(ends, 1.0))], &antennas);
        let expected = reference::face(&radar, ends, 1.0, &antennas, &SAMPLES, 4.0);
        let off = worst(&samples(&radar, &found), &expected);
        assert!(off < bound, "{ends:?}: {off:e}");
    }
}

#[test]
fn posts_are_their_exact_series() {
    let radar = Radar::default();
    for (centre, radius, bound) in
        [([1.0, 5.0], 0.05, 5e-4), ([-3.0, 20.0], 0.5, 5e-5), ([0.2, 2.0], 0.02, 1.5e-3), ([0.0, 10.0], 1.0, 1e-4)]
    {
        for x in [-0.9, 0.0, 0.4] {
            let antennas = AntennaPlaces::at([x, 0.0]);
            let found = heard(&radar, &[Object::Post(Post::new(centre[0], centre[1], radius))], &antennas);
            let expected: Vec<_> =
                SAMPLES.iter().map(|n| reference::post(&radar, centre, radius, [x, 0.0], *n)).collect();
            let off = worst(&samples(&radar, &found), &expected);
            assert!(off < bound, "radius {radius} at {x}: {off:e}");
        }
    }
}
