//! The scene that the window opens with: a post is dragged along its ring to a wall.

use crate::prelude::*;
use apertura::evaluate::dip_between;

const PARTS: f32 = 0.05;

/// Number of blobs of post and wall in either input and in the target, with the post on its ring at an angle from straight ahead.
fn blobs_at(degrees: f64) -> [usize; 3] {
    let radar = Radar::default();
    let mut scene = presets::default_scene().scene;
    let post = scene.objects.iter_mut().find_map(|object| match object {
        Object::Point(point) if point.y_metres < 20.0 => Some(point),
        _ => None,
    });
    let post = post.expect("the street has a post");
    let (range, (sin, cos)) = (post.x_metres.hypot(post.y_metres), degrees.to_radians().sin_cos());
    let place = [range * sin, range * cos];
    [post.x_metres, post.y_metres] = place;
    // The wall stands at x = 9 m.
    let wall = [9.0, (range * range - 81.0).sqrt()];
    let maps = LogMaps::of_signal(&radar, &simulate(&radar, &scene, Floor::Thesis, 0).unwrap());
    [&maps.first, &maps.last, &maps.full].map(|map| {
        let dip = dip_between(&radar, &map.normalise(Normalisation::MinMax), [place, wall]);
        if dip >= PARTS { 2 } else { 1 }
    })
}

#[test]
fn a_drag_along_the_ring_merges_post_and_wall_in_inputs() {
    assert_eq!(blobs_at(5.4), [2, 2, 2], "as the scene opens");
    for degrees in [26.0, 28.0] {
        assert_eq!(blobs_at(degrees), [1, 1, 2], "the post at {degrees}°");
    }
    assert_eq!(blobs_at(31.0), [1, 1, 1], "24 columns before the wall");
}
