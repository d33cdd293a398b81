//! The numbers that the lessons on bodies teach, computed again: each must stand in its lesson's text as it comes out here.

use crate::prelude::*;
use crate::taught::{lesson, physical, taught};
use apertura::scattering::roughness::coherent;
use apertura::scattering::{EchoKind, Wave, array_centre_echoes};

fn scene(id: &str, step: usize) -> Scene {
    lesson(id).steps[step - 1].scene()
}

fn maps(scene: &Scene) -> LogMaps {
    LogMaps::of_signal(&physical(), &simulate(&physical(), scene, Floor::Exact, 0).unwrap())
}

fn brightest(map: &LogMap) -> f64 {
    20.0 * map.max()
}

/// Decibels of the brightest cell near a place, as a map of elements around `centre` metres shows it.
fn near(radar: &Radar, map: &LogMap, centre: f64, [x, y]: [f64; 2], [bins, columns]: [usize; 2]) -> f64 {
    let blob = radar.blob_of(centre, x, y);
    let (bin, column) =
        (radar.bin_of_range(blob.range_metres).round() as usize, radar.column_of_cos(blob.cos_theta).round() as usize);
    let cells = (bin - bins..=bin + bins).flat_map(|b| (column - columns..=column + columns).map(move |c| (b, c)));
    cells.map(|(b, c)| 20.0 * map.decades()[[b, c]]).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn a_wall_that_looks_away_is_as_weak_as_its_lesson_says() {
    let id = "where-a-wall-shines";
    // The same wall at the same distance, faced squarely.
    let facing = Scene { objects: vec![Object::Wall(Wall::new(0.0, 15.0, 8.0, 0.0))], ..Scene::default() };
    let weaker = brightest(&maps(&facing).full) - brightest(&maps(&scene(id, 3)).full);
    taught(id, &format!("{weaker:.0} dB weaker than the glint"));
}

/// Amplitude of the glint of a flat vertical strip (metres), by Kirchhoff's integral over its height; along the strip that gives `1 / R^1.5`.
fn kirchhoff(height: f64, range: f64) -> f64 {
    let (strips, wave_number) = (2500, 2.0 * std::f64::consts::TAU / physical().wavelength_metres());
    let step = height / f64::from(strips);
    let turned =
        |i: i32| Complex64::cis(-wave_number * ((-height / 2.0 + step * (f64::from(i) + 0.5)).hypot(range) - range));
    (0..strips).map(turned).sum::<Complex64>().norm() * step / range.powf(1.5)
}

/// Decibels by which such a glint falls from a distance to twice that: the mean from 8 to 12 m, over which the ripple of the strip's edges evens out.
fn fall_of_a_glint(height: f64) -> f64 {
    let fall = |i: i32| {
        let range = 8.0 + f64::from(i) / 50.0;
        20.0 * (kirchhoff(height, range) / kirchhoff(height, 2.0 * range)).log10()
    };
    (0..=200).map(fall).sum::<f64>() / 201.0
}

#[test]
fn a_high_wall_loses_6_db_and_a_low_strip_9() {
    for (height, expected, tolerance) in [(0.05, 9.03, 0.01), (0.1, 8.98, 0.03), (2.5, 6.02, 0.1), (5.0, 6.02, 0.05)] {
        let fall = fall_of_a_glint(height);
        println!("{height} m high: {fall:.2} dB at twice the distance");
        assert!((fall - expected).abs() < tolerance, "{height} m: {fall}");
    }
    taught("where-a-wall-shines", "1 / R, 6 dB");
    // The glint falls as that of a strip of the height that the lesson asks for.
    let (fall, rail) = (glint(10.0, 0.0) - glint(20.0, 0.0), fall_of_a_glint(0.05));
    taught("where-a-wall-shines", &format!("1 / R^1.5: {fall:.0} dB"));
    assert!((fall - rail).abs() < 0.02, "{fall}, {rail}");
    let zone = (physical().wavelength_metres() * 10.0 / 2.0).sqrt();
    taught("where-a-wall-shines", &format!("the Fresnel zone there, {:.0} cm", 100.0 * zone));
}

/// Decibels that a post takes from a point 20 m ahead: in the map of all elements, and in the one of an end from which it takes less.
fn hidden_by_a_post(radar: &Radar, y_metres: f64, diameter_metres: f64) -> [f64; 2] {
    let point = Object::Point(Point::new(0.0, 20.0));
    let levels = |objects: Vec<Object>| {
        let scene = Scene { objects, ..Scene::default() };
        let shown = LogMaps::of_signal(radar, &simulate(radar, &scene, Floor::Exact, 0).unwrap());
        let ends = [(&shown.first, End::First), (&shown.last, End::Last)];
        let [a, b] = ends.map(|(map, end)| near(radar, map, radar.end_centre_metres(end), [0.0, 20.0], [6, 30]));
        [near(radar, &shown.full, 0.0, [0.0, 20.0], [6, 30]), a, b]
    };
    let free = levels(vec![point.clone()]);
    let hidden = levels(vec![point, Object::Post(Post::new(0.0, y_metres, diameter_metres / 2.0))]);
    let [whole, a, b] = [0, 1, 2].map(|i| free[i] - hidden[i]);
    [whole, a.min(b)]
}

/// An obstacle of width w at a distance r casts a shadow w R / (R - r) wide on the array, from a point at R.
#[test]
fn a_shadow_is_full_where_it_is_wider_than_the_array() {
    let page = include_str!("../../docs/things.md");
    let width = |y: f64, diameter: f64| diameter * 20.0 / (20.0 - y);
    for (radar, name) in [(Radar::default(), "the thesis' radar"), (physical(), "the physical one at 77 GHz")] {
        assert!(width(18.5, 0.4) > radar.aperture_metres() && width(10.0, 0.3) < radar.aperture_metres());
        let [whole, end] = hidden_by_a_post(&radar, 18.5, 0.4);
        let said = format!("{whole:.0} dB in the map of all elements and by {end:.0} dB in those of the ends");
        assert!(page.contains(&said), "{name}: things.md does not say \"{said}\"");
        let [whole, end] = hidden_by_a_post(&radar, 10.0, 0.3);
        assert!(whole > 5.0 && end < 2.0, "{name}: {whole} {end}");
    }
    for said in [format!("{:.1} m wide", width(18.5, 0.4)), format!("{:.1} m wide", width(10.0, 0.3))] {
        assert!(page.contains(&said), "{said}");
    }
}

#[test]
fn things_md_says_what_roughness_takes_at_77_ghz() {
    let page = include_str!("../../docs/things.md");
    let taken = |radar: &Radar, millimetres: f64| -20.0 * coherent(&Wave::of(radar), 1e-3 * millimetres, 1.0).log10();
    let narrow = Radar { bandwidth_hz: 1.0, ..physical() };
    let [a, b, c] = [0.5, 1.0, 2.0].map(|millimetres| taken(&narrow, millimetres));
    let [d, e, f] = [0.5, 1.0, 2.0].map(|millimetres| taken(&physical(), millimetres));
    let [g, h, i] = [0.5, 1.0, 2.0].map(|millimetres| taken(&Radar::default(), millimetres));
    for row in [
        format!("| 77 GHz | {a:.1} dB | {b:.0} dB | {c:.0} dB |"),
        format!("| 78 GHz, the middle of a chirp from 77 to 79 GHz | {d:.1} dB | {e:.0} dB | {f:.0} dB |"),
        format!("| 37.5 GHz, the middle of the thesis' chirp | {g:.1} dB | {h:.1} dB | {i:.0} dB |"),
    ] {
        assert!(page.contains(&row), "things.md has no row \"{row}\"");
    }
}

#[test]
fn the_right_end_sees_less_by_as_much_as_its_lesson_says() {
    let (id, radar) = ("what-one-end-sees", physical());
    let glint = maps(&scene(id, 2));
    taught(id, &format!("{:.0} dB weaker", brightest(&glint.first) - brightest(&glint.last)));
    let hidden = maps(&scene(id, 3));
    let [first, last] = [(&hidden.first, End::First), (&hidden.last, End::Last)]
        .map(|(map, end)| near(&radar, map, radar.end_centre_metres(end), [4.6, 28.0], [6, 30]));
    taught(id, &format!("{:.0} dB weaker", first - last));
}

fn glint(y_metres: f64, roughness_millimetres: f64) -> f64 {
    let wall = Wall { roughness_millimetres, ..Wall::new(0.0, y_metres, 8.0, 0.0) };
    let heard = array_centre_echoes(&physical(), &Scene { objects: vec![Object::Wall(wall)], ..Scene::default() });
    20.0 * heard.into_iter().find(|(_, e)| e.kind == EchoKind::Glint).unwrap().1.amplitude.norm().log10()
}

#[test]
fn roughness_takes_and_gives_as_much_as_its_lesson_says() {
    let (id, lost) = ("smooth-and-rough", |roughness| glint(15.0, 0.0) - glint(15.0, roughness));
    taught(id, &format!("{:.1} dB. 0.25 mm take {:.1} dB, 1 mm takes {:.0} dB", lost(0.5), lost(0.25), lost(1.0)));
    let mut turned = scene(id, 3);
    let smooth = brightest(&maps(&turned).full);
    let Object::Wall(wall) = &mut turned.objects[0] else { panic!() };
    wall.roughness_millimetres = 0.5;
    taught(id, &format!("{:.0} dB brighter", brightest(&maps(&turned).full) - smooth));
}

#[test]
fn a_cars_corners_are_as_weak_as_its_lesson_says() {
    let id = "which-points-a-car-is";
    let (turned, facing) = (scene(id, 1), scene(id, 3));
    let corners = |scene: &Scene| {
        let Object::Box(car) = &scene.objects[0] else { panic!() };
        let mut corners = car.corners_metres();
        corners.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
        corners
    };
    let map = maps(&turned).full;
    let levels = corners(&turned).map(|c| near(&physical(), &map, 0.0, c, [5, 25]) - brightest(&map));
    assert!(levels[..3].iter().all(|l| *l > -20.0), "{levels:?}");
    taught(id, &format!("{:.0} dB weaker than the nearest", -levels[3]));
    let ranges = corners(&turned).map(|[x, y]| x.hypot(y));
    taught(id, &format!("{:.1} m, {:.1} m, {:.1} m and {:.1} m", ranges[0], ranges[1], ranges[2], ranges[3]));
    let map = maps(&facing).full;
    let side = corners(&facing).map(|c| near(&physical(), &map, 0.0, c, [4, 20]) - brightest(&map));
    taught(id, &format!("{:.0} dB weaker", -(side[0] + side[1]) / 2.0));
}
