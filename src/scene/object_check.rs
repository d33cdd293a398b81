//! Checks the numbers of objects.

use super::body::{MAX_CORNERS, MAX_ROUGHNESS_MILLIMETRES, MAX_SIZE_METRES, MIN_RADIUS_METRES, MIN_SIZE_METRES};
use super::shape::{doubled_area, extent, out_of_reach, touch};
use super::{Object, SceneError};

struct Check {
    object: usize,
    kind: &'static str,
}

impl Check {
    fn value(&self, field: &'static str, value: f64, usable: bool, expected: &'static str) -> Result<(), SceneError> {
        let Check { object, kind } = *self;
        if usable { Ok(()) } else { Err(SceneError::Value { object, kind, field, value, expected }) }
    }

    fn finite(&self, field: &'static str, value: f64) -> Result<(), SceneError> {
        self.value(field, value, value.is_finite(), "a finite number")
    }

    fn place<const N: usize>(&self, fields: [(&'static str, f64); N]) -> Result<(), SceneError> {
        fields.into_iter().try_for_each(|(field, value)| {
            self.finite(field, value)?;
            self.value(field, value, !out_of_reach(value), "a distance of at most 1e12 m")
        })
    }

    fn spread(&self, field: &'static str, value: f64) -> Result<(), SceneError> {
        self.finite(field, value)?;
        self.value(field, value, (0.0..=1e12).contains(&value), "0 to 1e12 m")
    }

    fn size(&self, field: &'static str, value: f64) -> Result<(), SceneError> {
        let usable = (MIN_SIZE_METRES..=MAX_SIZE_METRES).contains(&value);
        self.value(field, value, usable, "0.001 to 10000 m")
    }

    fn reflectivity(&self, value: f64) -> Result<(), SceneError> {
        self.finite("reflectivity", value)?;
        self.value("reflectivity", value, value.abs() <= 1e100, "a magnitude of at most 1e100")
    }

    fn outline(&self, corners: &[[f64; 2]]) -> Result<(), SceneError> {
        let Check { object, kind } = *self;
        let wrong = |fault: String| Err(SceneError::Outline { object, kind, fault });
        if !(3..=MAX_CORNERS).contains(&corners.len()) {
            return wrong(format!("it has {} corners; expected 3 to {MAX_CORNERS}", corners.len()));
        }
        for (i, corner) in corners.iter().enumerate() {
            if corner.iter().any(|v| !v.is_finite() || out_of_reach(*v)) {
                let [x, y] = corner;
                return wrong(format!("corner {} is ({x}, {y}); expected finite numbers of at most 1e12 m", i + 1));
            }
        }
        let (low, high) = extent(corners);
        if (high[0] - low[0]).max(high[1] - low[1]) > MAX_SIZE_METRES {
            return wrong("it is larger than 10000 m".to_owned());
        }
        let count = corners.len();
        let face = |i: usize| [corners[i], corners[(i + 1) % count]];
        for i in 0..count {
            let [a, b] = face(i);
            if (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-3 {
                return wrong(format!("corners {} and {} are less than 1 mm apart", i + 1, (i + 1) % count + 1));
            }
            for j in i + 1..count {
                let is_next = j == i + 1 || (i == 0 && j == count - 1);
                if !is_next && touch(face(i), face(j)) {
                    return wrong(format!("the edges from corner {} and from corner {} cross", i + 1, j + 1));
                }
            }
        }
        if doubled_area(corners).abs() < 2e-6 {
            return wrong("it encloses no area".to_owned());
        }
        Ok(())
    }
}

impl Object {
    /// Checks the numbers of object number `object` of a scene, counted from 0.
    pub(super) fn validate(&self, object: usize) -> Result<(), SceneError> {
        self.check_velocity(object)?;
        let check = Check { object, kind: self.kind() };
        match self {
            Object::Point(p) => check.place([("x_metres", p.x_metres), ("y_metres", p.y_metres)])?,
            Object::Line(l) => {
                let spacing = ("spacing_metres", l.spacing_metres);
                check.place([("x_metres", l.x_metres), ("y_start_metres", l.y_start_metres), spacing])?;
                check.finite("direction_degrees", l.direction_degrees)?;
            }
            Object::Gaussian(g) => {
                check.place([("x_metres", g.x_metres), ("y_metres", g.y_metres)])?;
                check.spread("x_std_metres", g.x_std_metres)?;
                check.spread("y_std_metres", g.y_std_metres)?;
            }
            Object::Wall(w) => {
                check.place([("x_metres", w.x_metres), ("y_metres", w.y_metres)])?;
                check.size("length_metres", w.length_metres)?;
                check.finite("angle_degrees", w.angle_degrees)?;
            }
            Object::Box(b) => {
                check.place([("x_metres", b.x_metres), ("y_metres", b.y_metres)])?;
                check.size("length_metres", b.length_metres)?;
                check.size("width_metres", b.width_metres)?;
                check.finite("angle_degrees", b.angle_degrees)?;
            }
            Object::Post(p) => {
                check.place([("x_metres", p.x_metres), ("y_metres", p.y_metres)])?;
                let radius = p.radius_metres;
                let usable = (MIN_RADIUS_METRES..=MAX_SIZE_METRES).contains(&radius);
                check.value("radius_metres", radius, usable, "0.01 to 10000 m; a thinner post is a point")?;
            }
            Object::Polygon(p) => check.outline(&p.corners_metres)?,
        }
        check.reflectivity(self.reflectivity())?;
        let rough = self.body().map_or(0.0, |body| body.roughness_millimetres);
        check.value("roughness_millimetres", rough, (0.0..=MAX_ROUGHNESS_MILLIMETRES).contains(&rough), "0 to 100 mm")
    }
}

#[cfg(test)]
mod tests {
    use crate::radar::Radar;
    use crate::scene::{Block, Object, Polygon, Post, Scene, Wall};

    fn told(object: Object) -> String {
        let scene = Scene { objects: vec![object], ..Scene::default() };
        scene.validate(&Radar::default()).unwrap_err().to_string()
    }

    #[test]
    fn bodies_without_sense_are_named() {
        let square = |corners: &[[f64; 2]]| Object::Polygon(Polygon::new(corners.to_vec()));
        for (object, parts) in [
            (Object::Wall(Wall::new(0.0, 5.0, 0.0, 0.0)), ["object 1 (wall)", "length_metres"]),
            (Object::Wall(Wall::new(f64::NAN, 5.0, 1.0, 0.0)), ["object 1 (wall)", "x_metres is NaN"]),
            (Object::Box(Block::new([0.0, 5.0], [4.0, 0.0], 0.0)), ["object 1 (box)", "width_metres is 0"]),
            (Object::Box(Block::new([0.0, 0.5], [4.0, 3.0], 0.0)), ["object 1 (box)", "element 0 of the array"]),
            (Object::Wall(Wall::new(0.0, 0.0, 4.0, 0.0)), ["object 1 (wall)", "element 0 of the array"]),
            (Object::Post(Post::new(0.0, 5.0, 0.001)), ["object 1 (post)", "radius_metres is 0.001"]),
            (Object::Post(Post::new(0.9, 0.0, 0.2)), ["object 1 (post)", "of the array lies inside"]),
            (square(&[[0.0, 5.0], [1.0, 5.0]]), ["object 1 (polygon)", "2 corners"]),
            (square(&[[0.0, 5.0]; 10_000]), ["object 1 (polygon)", "10000 corners"]),
            (square(&[[0.0, 5.0], [1.0, 6.0], [1.0, 5.0], [0.0, 6.0]]), ["corner 1", "corner 3 cross"]),
            (square(&[[0.0, 5.0], [1.0, 5.0], [2.0, 5.0]]), ["object 1 (polygon)", "area"]),
            (square(&[[0.0, 5.0], [0.0, 5.0], [2.0, 6.0]]), ["corners 1 and 2", "apart"]),
            (square(&[[0.0, 5.0], [f64::INFINITY, 5.0], [2.0, 6.0]]), ["corner 2", "finite"]),
        ] {
            let message = told(object);
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
        let rough = Wall { roughness_millimetres: -1.0, ..Wall::new(0.0, 5.0, 1.0, 0.0) };
        assert!(told(Object::Wall(rough)).contains("roughness_millimetres is -1; expected 0 to 100 mm"));
    }
}
