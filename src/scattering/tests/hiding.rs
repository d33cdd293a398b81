//! Echoes of bodies that others hide.

use super::*;
use crate::scene::{Block, Point, Polygon, Post, Wall};
use proptest::prelude::*;

#[test]
fn an_obstacle_that_comes_from_the_side_begins_with_no_effect() {
    let radar = Radar::default();
    let kappa = Wave::of(&radar).radians_per_metre;
    let antennas = AntennaPlaces::at([0.0, 0.0]);
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

/// Sum of the echoes of `kinds` of a body behind a post, at an antenna at `x` metres, freed of the phase of the way to `apex_metres`.
fn behind_a_post(body: &Object, post: Post, kinds: &[EchoKind], apex_metres: [f64; 2], x: f64) -> Vec<Complex64> {
    let radar = Radar::default();
    let mut echoes = heard(&radar, &[body.clone(), Object::Post(post)], &AntennaPlaces::at([x, 0.0]));
    echoes.retain(|e| kinds.contains(&e.kind));
    at_range(&echoes, Wave::of(&radar).radians_per_metre, (x - apex_metres[0]).hypot(apex_metres[1]))
}

#[test]
fn nothing_jumps_where_a_shadowed_glint_leaves_its_face() {
    let wall = Object::Wall(Wall::new(-1.0, 20.0, 2.0, 0.0));
    let kinds = [EchoKind::Glint, EchoKind::Edge];
    for post in [0.1, 0.35, 0.5].map(|x| Post::new(x, 10.0, 0.2)) {
        let [before, after] = [-1e-7, 1e-7].map(|x| behind_a_post(&wall, post.clone(), &kinds, [0.0, 20.0], x)[0]);
        let step = (after - before).norm() / before.norm();
        assert!(step < 1e-4, "{post:?}: {step}");
    }
}

#[test]
fn a_right_inner_corner_behind_a_post_does_not_flicker() {
    let post = Post::new(0.0, 7.0, 0.2);
    for arm in [1.0, 3.0] {
        let (out, near, far) = (arm + 0.2, 14.0 - arm, 14.2 - arm);
        let corners = [[-arm, near], [0.0, 14.0], [arm, near], [out, far], [0.0, 14.4], [-out, far]];
        let corner = Object::Polygon(Polygon::new(corners.to_vec()));
        let at = |x| behind_a_post(&corner, post.clone(), &[EchoKind::DoubleBounce], [0.0, 14.0], x);
        let step = largest_step(at, -1.0, 20_000);
        assert!(step < 0.004, "arms of {arm} m: {step}");
    }
}

#[test]
fn what_a_body_hides_is_seen_again_without_shadows() {
    let radar = Radar::default();
    let objects = vec![Object::Point(Point::new(0.0, 20.0)), Object::Box(Block::new([0.0, 10.0], [6.0, 1.0], 0.0))];
    let scene = Scene { objects, ..Scene::default() };
    let amplitude = |scene: &Scene| {
        let echoing = EchoSources::of(&radar, scene);
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
        ObjectWithOccluders::all(&radar, &Scene { objects, ..Scene::default() })
    };
    let (before, after) = (seen(0.0), seen(0.3));
    assert!(before[1] != after[1] && before[2] == after[2] && before[2].hidden_by.is_empty());
    assert_eq!(seen(-8.0)[1], seen(-9.0)[1], "out of the way");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// In a crowd the echoes are, bit for bit, those of objects each of which asks all bodies.
    #[test]
    fn bodies_that_a_crowd_leaves_out_change_no_bit(
        places in prop::collection::vec((0u8..4, -20.0..20.0f64, 3.0..30.0f64, 0.0..180.0f64, 0.1..2.0f64), 2..60),
    ) {
        let radar = Radar::default();
        let objects: Vec<Object> = places.iter().map(|(kind, x, y, angle, size)| match kind {
            0 => Object::Wall(Wall::new(*x, *y, 2.0 * size, *angle)),
            1 => Object::Box(Block::new([*x, *y], [*size, 0.5 * size], *angle)),
            2 => Object::Post(Post::new(*x, *y, 0.2 * size)),
            _ => Object::Point(Point::new(*x, *y)),
        }).collect();
        let scene = Scene { objects: objects.clone(), ..Scene::default() };
        let seen = ObjectWithOccluders::all(&radar, &scene);
        for n in [0, 300, 511, 1023] {
            let antennas = AntennaPlaces::from(radar.pair(n));
            for (at, one) in seen.iter().enumerate() {
                let others = objects.iter().enumerate().filter(|(other, _)| *other != at).map(|(_, object)| object);
                let (mut few, mut all) = (Vec::new(), Vec::new());
                one.scatterer(&radar).echoes(&antennas, &mut few);
                Scatterer::new(&radar, &one.object, others).echoes(&antennas, &mut all);
                prop_assert_eq!(few, all);
            }
        }
    }
}
