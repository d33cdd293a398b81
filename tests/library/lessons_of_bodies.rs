//! The numbers that the lessons on bodies teach, computed again: each must stand in its lesson's text as it comes out here.

use apertura::lesson::{Lesson, shipped};
use apertura::maps::{LogMap, LogMaps};
use apertura::radar::{End, Radar};
use apertura::scattering::{EchoKind, heard_in_the_middle};
use apertura::scene::{Object, Scene, Wall};
use apertura::signal::{Floor, simulate};

fn text(id: &str) -> &'static str {
    shipped::ALL.iter().find(|s| s.id == id).unwrap_or_else(|| panic!("no lesson {id}")).toml
}

/// Holds a lesson to a number as its text has it.
fn taught(id: &str, number: &str) {
    assert!(text(id).contains(number), "{id} does not say \"{number}\"");
}

/// The scene of a lesson's step, counted from 1.
fn scene(id: &str, step: usize) -> Scene {
    Lesson::from_toml(text(id)).unwrap().steps[step - 1].scene()
}

fn maps(scene: &Scene) -> LogMaps {
    let radar = Radar::default();
    LogMaps::of_signal(&radar, &simulate(&radar, scene, Floor::Exact, 0).unwrap())
}

/// Decibels of a map's brightest cell.
fn brightest(map: &LogMap) -> f64 {
    20.0 * map.max()
}

/// Decibels of the brightest cell near a place, as a map of elements around `centre` metres shows it.
fn near(map: &LogMap, centre: f64, [x, y]: [f64; 2], [bins, columns]: [usize; 2]) -> f64 {
    let radar = Radar::default();
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

#[test]
fn a_glint_falls_with_the_range_as_its_lesson_says() {
    let glint = |y: f64| {
        let wall = Scene { objects: vec![Object::Wall(Wall::new(0.0, y, 8.0, 0.0))], ..Scene::default() };
        let heard = heard_in_the_middle(&Radar::default(), &wall);
        heard.into_iter().find(|(_, e)| e.kind == EchoKind::Glint).unwrap().1.amplitude.norm()
    };
    taught("where-a-wall-shines", &format!("1 / R^1.5: {:.0} dB", 20.0 * (glint(10.0) / glint(20.0)).log10()));
}

#[test]
fn the_right_end_misses_a_glint_by_as_much_as_its_lesson_says() {
    let id = "what-one-end-sees";
    let seen = maps(&scene(id, 2));
    taught(id, &format!("{:.0} dB weaker", brightest(&seen.first) - brightest(&seen.last)));
}

#[test]
fn the_right_end_sees_a_hidden_point_as_weakly_as_its_lesson_says() {
    let id = "what-one-end-sees";
    let (radar, seen) = (Radar::default(), maps(&scene(id, 3)));
    let [first, last] = [(&seen.first, End::First), (&seen.last, End::Last)]
        .map(|(map, end)| near(map, radar.end_centre_metres(end), [4.6, 28.0], [6, 30]));
    taught(id, &format!("{:.0} dB weaker", first - last));
}

const ON_ROUGHNESS: &str = "smooth-and-rough";

#[test]
fn roughness_weakens_a_glint_by_as_much_as_its_lesson_says() {
    let glint = |roughness_millimetres| {
        let wall = Wall { roughness_millimetres, ..Wall::new(0.0, 15.0, 8.0, 0.0) };
        let scene = Scene { objects: vec![Object::Wall(wall)], ..Scene::default() };
        let heard = heard_in_the_middle(&Radar::default(), &scene);
        20.0 * heard.into_iter().find(|(_, e)| e.kind == EchoKind::Glint).unwrap().1.amplitude.norm().log10()
    };
    let lost = |roughness| glint(0.0) - glint(roughness);
    let said = format!("{:.1} dB. 0.5 mm take {:.1} dB, 2 mm take {:.0} dB", lost(1.0), lost(0.5), lost(2.0));
    taught(ON_ROUGHNESS, &said);
}

#[test]
fn roughness_brightens_a_wall_that_looks_away_as_its_lesson_says() {
    let mut turned = scene(ON_ROUGHNESS, 3);
    let smooth = brightest(&maps(&turned).full);
    let Object::Wall(wall) = &mut turned.objects[0] else { panic!() };
    wall.roughness_millimetres = 0.5;
    taught(ON_ROUGHNESS, &format!("{:.0} dB brighter", brightest(&maps(&turned).full) - smooth));
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
    let levels = corners(&turned).map(|c| near(&map, 0.0, c, [5, 25]) - brightest(&map));
    assert!(levels[..3].iter().all(|l| *l > -20.0), "{levels:?}");
    taught(id, &format!("{:.0} dB weaker than the nearest", -levels[3]));
    let ranges = corners(&turned).map(|[x, y]| x.hypot(y));
    taught(id, &format!("{:.1} m, {:.1} m, {:.1} m and {:.1} m", ranges[0], ranges[1], ranges[2], ranges[3]));
    let map = maps(&facing).full;
    let side = corners(&facing).map(|c| near(&map, 0.0, c, [4, 20]) - brightest(&map));
    taught(id, &format!("{:.0} dB weaker", -(side[0] + side[1]) / 2.0));
}
