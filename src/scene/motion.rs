//! Objects with a constant velocity. The scene has their places at time 0.

use super::common::of_each;
use super::{Object, Scene, SceneError};

/// Largest speed along either axis, metres a second. Doppler shifts are those of speeds far below that of light.
pub const MAX_SPEED_METRES_PER_SECOND: f64 = 1e4;

impl Object {
    pub fn velocity_metres_per_second(&self) -> [f64; 2] {
        of_each!(self, one => [one.velocity_x_metres_per_second, one.velocity_y_metres_per_second])
    }

    /// The velocity along x and y, to be changed.
    pub fn velocity_mut(&mut self) -> [&mut f64; 2] {
        of_each!(self, one => [&mut one.velocity_x_metres_per_second, &mut one.velocity_y_metres_per_second])
    }

    /// Whether it moves.
    pub fn is_moving(&self) -> bool {
        self.velocity_metres_per_second() != [0.0, 0.0]
    }

    /// Radial velocity of its centre, metres a second, positive away from the array's middle.
    pub fn radial_velocity_metres_per_second(&self) -> f64 {
        let ([x, y], [vx, vy]) = (self.centre_metres(), self.velocity_metres_per_second());
        let range = x.hypot(y);
        if range > 0.0 { (x * vx + y * vy) / range } else { vx.hypot(vy) }
    }

    pub(super) fn check_velocity(&self, index: usize) -> Result<(), SceneError> {
        let names = ["velocity_x_metres_per_second", "velocity_y_metres_per_second"];
        for (field, value) in names.into_iter().zip(self.velocity_metres_per_second()) {
            if value.is_nan() || value.abs() > MAX_SPEED_METRES_PER_SECOND {
                let expected = "a number from -10000 to 10000 m/s";
                return Err(SceneError::Value { object: index, kind: self.kind(), field, value, expected });
            }
        }
        Ok(())
    }
}

impl Scene {
    /// Whether it moves.
    pub fn is_moving(&self) -> bool {
        self.objects.iter().any(Object::is_moving)
    }

    /// The scene at a time: every object moved by its velocity, all else as it is. At 0 it is the same, to the bit.
    pub fn at(&self, seconds: f64) -> Scene {
        let mut scene = self.clone();
        for object in scene.objects.iter_mut().filter(|o| o.is_moving()) {
            let [vx, vy] = object.velocity_metres_per_second();
            object.translate(vx * seconds, vy * seconds);
        }
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::scene::{Block, GaussianCluster, Line, Point, Polygon, Post, Wall};

    fn all() -> Vec<Object> {
        vec![
            Object::Point(Point::new(3.0, 4.0)),
            Object::Line(Line::vertical(3.0, 4.0, 0.5, 7)),
            Object::Gaussian(GaussianCluster::new([3.0, 14.0], [0.5, 0.5], 5)),
            Object::Wall(Wall::new(3.0, 4.0, 2.0, 30.0)),
            Object::Box(Block::new([3.0, 4.0], [2.0, 1.0], 30.0)),
            Object::Post(Post::new(3.0, 4.0, 0.5)),
            Object::Polygon(Polygon::new(vec![[3.0, 4.0], [4.0, 4.0], [3.0, 5.0]])),
        ]
    }

    #[test]
    fn every_kind_moves_by_its_velocity() {
        for mut object in all() {
            assert!(!object.is_moving());
            let [vx, vy] = object.velocity_mut();
            (*vx, *vy) = (-2.0, 6.0);
            let scene = Scene { objects: vec![object.clone()], ..Scene::default() };
            let ([x, y], [then_x, then_y]) = (object.centre_metres(), scene.at(0.5).objects[0].centre_metres());
            assert!((then_x - x + 1.0).abs() < 1e-12 && (then_y - y - 3.0).abs() < 1e-12, "{object:?}");
            assert_eq!(scene.at(0.0), scene);
        }
    }

    #[test]
    fn the_radial_velocity_is_that_of_the_range() {
        let mut object = Object::Point(Point::new(3.0, 4.0));
        let [vx, vy] = object.velocity_mut();
        (*vx, *vy) = (10.0, -5.0);
        let at = |seconds: f64| (3.0 + 10.0 * seconds).hypot(4.0 - 5.0 * seconds);
        let expected = (at(1e-6) - at(-1e-6)) / 2e-6;
        assert!((object.radial_velocity_metres_per_second() - expected).abs() < 1e-6);
    }

    #[test]
    fn velocities_without_sense_are_named() {
        for mut object in all() {
            for bad in [f64::NAN, f64::INFINITY, -10_001.0] {
                *object.velocity_mut()[1] = bad;
                let scene = Scene { objects: vec![object.clone()], ..Scene::default() };
                let told = scene.validate(&Radar::default()).unwrap_err().to_string();
                let holds = told.contains("velocity_y_metres_per_second") && told.contains("-10000 to 10000 m/s");
                assert!(holds, "{told}");
            }
        }
    }
}
