//! Laws of the echoes of any scene: reciprocity, continuity, closed forms, energy.

use super::super::face::Face;
use super::*;
use crate::scene::{Block, Point, Polygon, Post, Wall};

fn all_kinds() -> Vec<Object> {
    let ell = [[4.0, 14.0], [5.0, 14.0], [5.0, 15.5], [7.0, 15.5], [7.0, 16.5], [4.0, 16.5]];
    vec![
        Object::Wall(Wall { roughness_millimetres: 0.5, ..Wall::new(-4.0, 18.0, 6.0, 20.0) }),
        Object::Box(Block::new([2.0, 9.0], [4.5, 1.8], 70.0)),
        Object::Post(Post::new(-1.5, 7.0, 0.3)),
        Object::Polygon(Polygon::new(ell.to_vec())),
        Object::Point(Point::new(3.0, 20.0)),
    ]
}

#[test]
fn swapping_transmitter_and_receiver_changes_nothing() {
    let radar = Radar::default();
    for (t, r) in [([-0.6, 0.0], [0.9, 0.1]), ([0.2, 0.0], [0.25, 0.0])] {
        let of = |t, r| heard(&radar, &all_kinds(), &AntennaPlaces { transmitter_metres: t, receiver_metres: r });
        let (there, back) = (of(t, r), of(r, t));
        let strongest = there.iter().map(|e| e.amplitude.norm()).fold(0.0, f64::max);
        assert_eq!(there.len(), back.len());
        for echo in &there {
            let apart = |e: &PathEcho| {
                (e.range_metres - echo.range_metres).abs() + (e.amplitude - echo.amplitude).norm() / strongest
            };
            let off = back.iter().map(apart).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-12, "{off:e}: {echo:?}");
        }
    }
}

#[test]
fn a_post_of_one_metre_is_a_point_from_afar() {
    let radar = Radar::default();
    let post = heard(&radar, &[Object::Post(Post::new(0.0, 1000.0, 1.0))], &AntennaPlaces::at([0.0, 0.0]))[0];
    assert!((post.amplitude.norm() * post.range_metres.powi(2) / 100.0 - 1.0).abs() < 1e-3);
    let flat = heard(&radar, &[Object::Post(Post::new(0.0, 10.0 + 9e3, 9e3))], &AntennaPlaces::at([0.0, 0.0]))[0];
    assert!((flat.amplitude.norm() / (100.0 / 10f64.powf(1.5)) - 1.0).abs() < 1e-3, "a huge post is a wall");
}

#[test]
fn nothing_jumps_where_the_foot_runs_off_a_face() {
    let radar = Radar::default();
    let kappa = Wave::of(&radar).radians_per_metre;
    for (object, range) in [
        (Object::Wall(Wall::new(-1.0, 20.0, 2.0, 0.0)), 20.0),
        (Object::Box(Block::new([-2.0, 8.0], [4.0, 2.0], 0.0)), 7.0),
    ] {
        let at = |x| heard(&radar, std::slice::from_ref(&object), &AntennaPlaces::at([x, 0.0]));
        let step = largest_step(|x| at_range(&at(x), kappa, range), -0.05, 1000);
        assert!(step < 0.002, "{object:?}: {step}");
    }
}

#[test]
fn a_face_that_is_cut_in_two_gives_the_same_samples() {
    let radar = Radar::default();
    let wave = Wave::of(&radar);
    // A part of a slanted face has its foot elsewhere by the last bit: 2e-15 m are 3e-12 of a radian.
    for (slant, bound) in [(0.0, 1e-12), (0.3, 1e-10)] {
        for cut in [-1.9, -0.3, 0.2, 1.234] {
            for antennas in [
                AntennaPlaces::at([0.2, 0.0]),
                AntennaPlaces { transmitter_metres: [-0.4, 0.0], receiver_metres: [0.8, 0.1] },
            ] {
                let of = |from, to| {
                    let ends = [from, to].map(|x| [x, 8.0 + slant * x]);
                    Face::new(ends, true, 1.0).echoes(&wave, &antennas)
                };
                let whole = samples(&radar, &of(-2.0, 2.0));
                let both = [of(-2.0, cut), of(cut, 2.0)].concat();
                let off = worst(&samples(&radar, &both), &whole);
                assert!(off < bound, "slant {slant}, cut at {cut}: {off:e}");
            }
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
                let antennas = AntennaPlaces { transmitter_metres: t, receiver_metres: r };
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
    let antennas = AntennaPlaces::at([0.0, 0.0]);
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
fn a_right_inner_corner_is_one_echo_at_its_apex() {
    let radar = Radar::default();
    let ell = vec![[-1.0, 7.0], [0.0, 8.0], [1.0, 7.0], [1.5, 7.5], [0.0, 9.0], [-1.5, 7.5]];
    for x in [-0.9, 0.0, 0.5] {
        let found = heard(&radar, &[Object::Polygon(Polygon::new(ell.clone()))], &AntennaPlaces::at([x, 0.0]));
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
