//! Bounds of the echo amplitudes of each object of the last scene. Only changed objects are evaluated again.

use crate::radar::Radar;
use crate::scattering::ObjectWithOccluders;
use crate::signal::plan;

#[derive(Debug, Default)]
pub(super) struct Amplitudes {
    known: Vec<(ObjectWithOccluders, f64)>,
}

impl Amplitudes {
    /// Sum of the largest amplitudes of all echoes of these objects, by [`plan::amplitude_bounds`]. Keeps the bound of each object.
    pub fn bound(&mut self, radar: &Radar, seen: &[ObjectWithOccluders]) -> f64 {
        let is_known = |at: usize, one: &ObjectWithOccluders| self.known.get(at).is_some_and(|(known, _)| known == one);
        let missing: Vec<usize> =
            seen.iter().enumerate().filter(|(at, one)| !is_known(*at, one)).map(|(at, _)| at).collect();
        let bounds = plan::amplitude_bounds(radar, missing.iter().filter_map(|at| seen.get(*at)));
        self.known.truncate(seen.len());
        for (at, bound) in missing.into_iter().zip(bounds) {
            let Some(one) = seen.get(at) else { continue };
            match self.known.get_mut(at) {
                Some(known) => *known = (one.clone(), bound),
                None => self.known.push((one.clone(), bound)),
            }
        }
        self.known.iter().map(|(_, bound)| bound).sum()
    }

    pub fn forget(&mut self) {
        self.known.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Block, Object, Point, Post, Scene};

    #[test]
    fn the_bound_is_that_of_the_scene_alone() {
        let radar = Radar { elements: 64, end_elements: 4, ..Radar::default() };
        let mut scene = Scene {
            objects: vec![
                Object::Box(Block::new([1.0, 6.0], [2.0, 1.0], 30.0)),
                Object::Post(Post::new(1.5, 9.0, 0.2)),
                Object::Point(Point::new(-2.0, 5.0)),
            ],
            ..Scene::default()
        };
        let mut known = Amplitudes::default();
        let mut check = |scene: &Scene| {
            let seen = ObjectWithOccluders::all(&radar, scene);
            assert_eq!(known.bound(&radar, &seen), plan::amplitude_bounds(&radar, seen.iter()).iter().sum::<f64>());
            plan::amplitude_bounds(&radar, seen.iter())
        };
        let behind_the_box = check(&scene)[1];
        scene.objects[0].translate(8.0, 0.0);
        let free = check(&scene)[1];
        assert!(free > 2.0 * behind_the_box, "{behind_the_box:e}, {free:e}: the post was hidden");
        scene.objects.remove(0);
        check(&scene);
        scene.objects.insert(0, Object::Post(Post::new(0.0, 4.0, 0.1)));
        check(&scene);
        check(&Scene::default());
    }
}
