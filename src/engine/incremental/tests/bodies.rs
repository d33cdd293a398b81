//! Scenes of bodies: a moved body is computed again with the objects that it hides or reveals.

use super::*;
use crate::scene::{Block, Post, Wall};

fn street(x: f64) -> Scene {
    let objects = vec![
        Object::Box(Block::new([x, 0.8], [0.3, 0.15], 20.0)),
        Object::Wall(Wall::new(0.0, 1.5, 1.0, 5.0)),
        Object::Post(Post::new(1.2, 0.5, 0.05)),
        Object::Point(Point::new(-1.3, 0.7)),
    ];
    Scene { objects, ..Scene::default() }
}

#[test]
fn a_body_that_moves_leaves_what_a_fresh_start_computes() {
    for normalisation in [Normalisation::DynamicRange(Decibels(60.0)), Normalisation::MinMax] {
        for floor in [Floor::Exact, Floor::Thesis] {
            let wanted = MapRequest { normalisation, floor, ..MapRequest::default() };
            let mut engine = Engine::new(small());
            for step in 0..8 {
                let scene = street(-0.4 + 0.1 * f64::from(step));
                let dragged = engine.update(&scene, &wanted).unwrap();
                let fresh = Engine::new(small()).update(&scene, &wanted).unwrap();
                let (dragged, fresh) = (lambda(&dragged), lambda(&fresh));
                let off = (&dragged.lambda - &fresh.lambda).iter().fold(0.0f32, |m, v| m.max(v.abs()));
                assert!(off < 2e-3, "{floor}, {normalisation:?}, step {step}: {off}");
            }
        }
    }
}

#[test]
fn a_moved_body_is_computed_again_with_what_it_hides() {
    let wanted = MapRequest {
        floor: Floor::Exact,
        normalisation: Normalisation::DynamicRange(Decibels(60.0)),
        ..MapRequest::default()
    };
    let mut engine = Engine::new(Radar { elements: 64, end_elements: 4, ..Radar::default() });
    let scene = |x: f64, post: f64| {
        let objects = vec![
            Object::Box(Block::new([x, 10.0], [2.0, 1.0], 0.0)),
            Object::Wall(Wall::new(0.0, 20.0, 2.0, 0.0)),
            Object::Wall(Wall::new(-20.0, 8.0, 2.0, 60.0)),
            Object::Post(Post::new(post, 3.0, 0.1)),
        ];
        Scene { objects, ..Scene::default() }
    };
    let said =
        |engine: &mut Engine, scene: &Scene| super::said(&engine.update(scene, &wanted).unwrap(), EngineStage::Signal);
    assert!(said(&mut engine, &scene(0.0, 15.0)).starts_with("15 echoes from scratch"));
    let what = said(&mut engine, &scene(0.0, 15.1));
    assert!(what.starts_with("1 of 15 echoes") || what.starts_with("2 of 15 echoes"), "the post alone: {what}");
    said(&mut engine, &scene(0.1, 15.1));
    let what = said(&mut engine, &scene(0.2, 15.1));
    assert!(what.starts_with("11 of 15 echoes"), "the box and the wall behind it: {what}");
    let off = engine.update(&Scene { shadows: false, ..scene(0.2, 15.1) }, &wanted).unwrap();
    assert!(off.report.ran(EngineStage::Signal), "without shadows the wall is another");
}

#[test]
fn what_a_loud_body_drowned_is_there_when_it_is_gone() {
    let normalisation = Normalisation::DynamicRange(Decibels(100.0));
    let wanted = MapRequest { floor: Floor::Exact, normalisation, ends: false, ..MapRequest::default() };
    let radar = Radar { elements: 64, end_elements: 4, ..Radar::default() };
    let quiet = |i: u32| {
        Object::Point(Point { reflectivity: 1e-3, ..Point::new(f64::from(i) - 3.0, 12.0 + 3.0 * f64::from(i)) })
    };
    let mut scene = Scene { objects: (0..6).map(quiet).collect(), ..Scene::default() };
    let mut loud = Post::new(-6.0, 4.0, 0.2);
    loud.reflectivity = 1e3;
    scene.objects.push(Object::Post(loud));
    let mut engine = Engine::new(radar.clone());
    for _ in 0..3 {
        engine.update(&scene, &wanted).unwrap();
        scene.objects[6].translate(-0.1, 0.0);
    }
    let beside = said(&engine.update(&scene, &wanted).unwrap(), EngineStage::FullMap);
    scene.objects.pop();
    engine.update(&scene, &wanted).unwrap();
    let mut fresh = Engine::new(radar);
    let alone = said(&fresh.update(&scene, &wanted).unwrap(), EngineStage::FullMap);
    assert!(beside != alone, "{beside}");
    let off = profile_difference(&engine, &fresh);
    assert!(off < 1e-6, "{off:e}");
}
