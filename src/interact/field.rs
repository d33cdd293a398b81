//! The numbers of an object that can be read and set, by name. A form shows those of one object, or those that several have in common.

use crate::radar::budget::{cross_section_dbsm, reflectivity_of};
use crate::scene::body::{MAX_ROUGHNESS_MILLIMETRES, MAX_SIZE_METRES, MIN_RADIUS_METRES, MIN_SIZE_METRES};
use crate::scene::{MAX_SPEED_METRES_PER_SECOND, Object};
use serde::{Deserialize, Serialize};

/// Coordinates in which places are shown and entered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinates {
    #[default]
    Cartesian,
    /// Range, and direction in degrees from straight ahead or as cos(theta).
    Polar,
}

/// A number of an object, in metres, degrees, metres a second, or millimetres for a roughness. The place is [`Object::anchor_metres`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    X,
    Y,
    /// Distance from the array's middle, metres.
    Range,
    /// Cosine of the angle between the array's axis and the direction from its middle.
    CosTheta,
    /// The direction in degrees: 0 straight ahead, positive to the right, beyond -90 and 90 behind.
    AngleDegrees,
    Spacing,
    /// Direction of a line, degrees: 0 straight ahead, 90 along the array to the right.
    Direction,
    /// Standard deviation of a cluster along x, metres.
    SpreadX,
    /// Standard deviation of a cluster along y, metres.
    SpreadY,
    Length,
    Width,
    /// Direction of the length of a wall or a box, degrees from +x, counter-clockwise.
    Angle,
    Radius,
    /// Height deviation of a body's surface, millimetres.
    Roughness,
    Count,
    Seed,
    Reflectivity,
    VelocityX,
    VelocityY,
    /// The reflectivity as radar cross section, dBsm ([`crate::radar::budget`]).
    CrossSection,
}

/// The cross section for a reflectivity of 0, dBsm.
const MIN_DBSM: f64 = -300.0;

/// A change of a field's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FieldChange {
    To(f64),
    By(f64),
}

impl FieldChange {
    /// The value after the change.
    pub fn of(self, value: f64) -> f64 {
        match self {
            FieldChange::To(new) => new,
            FieldChange::By(step) => value + step,
        }
    }
}

/// A field that several objects have, its value in the first of them, and whether it is the same in all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedField {
    pub field: Field,
    pub first: f64,
    pub is_same: bool,
}

const MOTION_FIELDS: &[Field] = &[Field::VelocityX, Field::VelocityY];

impl Field {
    fn of_place(coordinates: Coordinates) -> &'static [Field] {
        match coordinates {
            Coordinates::Cartesian => &[Field::X, Field::Y],
            Coordinates::Polar => &[Field::Range, Field::AngleDegrees, Field::CosTheta],
        }
    }

    fn of_kind(object: &Object) -> &'static [Field] {
        match object {
            Object::Point(_) => &[Field::Reflectivity, Field::CrossSection],
            Object::Line(_) => {
                &[Field::Spacing, Field::Direction, Field::Count, Field::Reflectivity, Field::CrossSection]
            }
            Object::Gaussian(_) => {
                &[Field::SpreadX, Field::SpreadY, Field::Count, Field::Seed, Field::Reflectivity, Field::CrossSection]
            }
            Object::Wall(_) => &[Field::Length, Field::Angle, Field::Reflectivity, Field::Roughness, Field::Seed],
            Object::Box(_) => {
                &[Field::Length, Field::Width, Field::Angle, Field::Reflectivity, Field::Roughness, Field::Seed]
            }
            Object::Post(_) => &[Field::Radius, Field::Reflectivity, Field::Roughness],
            Object::Polygon(_) => &[Field::Reflectivity, Field::Roughness, Field::Seed],
        }
    }

    /// The field's value in `object`; `None` where the object has no such number.
    pub fn get(self, object: &Object) -> Option<f64> {
        let [x, y] = object.anchor_metres();
        let range = x.hypot(y);
        Some(match (self, object) {
            (Field::X, _) => x,
            (Field::Y, _) => y,
            (Field::Range, _) => range,
            (Field::CosTheta, _) if range > 0.0 => x / range,
            (Field::CosTheta, _) => 0.0,
            (Field::AngleDegrees, _) => x.atan2(y).to_degrees(),
            (Field::Reflectivity, _) => object.reflectivity(),
            (Field::VelocityX, _) => object.velocity_metres_per_second()[0],
            (Field::VelocityY, _) => object.velocity_metres_per_second()[1],
            (Field::CrossSection, points) if points.body().is_none() => {
                cross_section_dbsm(object.reflectivity()).max(MIN_DBSM)
            }
            (Field::Spacing, Object::Line(l)) => l.spacing_metres,
            (Field::Direction, Object::Line(l)) => 90.0 - l.direction_degrees,
            (Field::Count, Object::Line(l)) => l.count as f64,
            (Field::Count, Object::Gaussian(g)) => g.count as f64,
            (Field::SpreadX, Object::Gaussian(g)) => g.x_std_metres,
            (Field::SpreadY, Object::Gaussian(g)) => g.y_std_metres,
            (Field::Seed, Object::Gaussian(g)) => g.seed as f64,
            (Field::Length, Object::Wall(w)) => w.length_metres,
            (Field::Length, Object::Box(b)) => b.length_metres,
            (Field::Width, Object::Box(b)) => b.width_metres,
            (Field::Angle, Object::Wall(w)) => w.angle_degrees,
            (Field::Angle, Object::Box(b)) => b.angle_degrees,
            (Field::Radius, Object::Post(p)) => p.radius_metres,
            (Field::Roughness, body) => body.body()?.roughness_millimetres,
            (Field::Seed, body) => body.body()?.seed as f64,
            _ => return None,
        })
    }

    /// Sets the field to the nearest valid value (counts are whole, cosines at most 1); no effect where the object has no such number.
    pub fn set(self, object: &mut Object, value: f64) {
        match (self, &mut *object) {
            (Field::X, _) => object.set_anchor([value, object.anchor_metres()[1]]),
            (Field::Y, _) => object.set_anchor([object.anchor_metres()[0], value]),
            (Field::Range | Field::CosTheta | Field::AngleDegrees, _) => self.set_polar(object, value),
            (Field::Reflectivity, _) => object.set_reflectivity(value),
            (Field::VelocityX, _) => *object.velocity_mut()[0] = speed(value),
            (Field::VelocityY, _) => *object.velocity_mut()[1] = speed(value),
            (Field::CrossSection, points) if points.body().is_none() => {
                object.set_reflectivity(reflectivity_of(value).copysign(object.reflectivity()));
            }
            (Field::Spacing, Object::Line(l)) => l.spacing_metres = value,
            (Field::Direction, Object::Line(l)) => l.direction_degrees = 90.0 - value,
            (Field::Count, Object::Line(l)) => l.count = value.round().max(1.0) as usize,
            (Field::Count, Object::Gaussian(g)) => g.count = value.round().max(1.0) as usize,
            (Field::SpreadX, Object::Gaussian(g)) => g.x_std_metres = value.max(0.0),
            (Field::SpreadY, Object::Gaussian(g)) => g.y_std_metres = value.max(0.0),
            (Field::Seed, Object::Gaussian(g)) => g.seed = value.round().max(0.0) as u64,
            (Field::Length, Object::Wall(w)) => w.length_metres = size(value),
            (Field::Length, Object::Box(b)) => b.length_metres = size(value),
            (Field::Width, Object::Box(b)) => b.width_metres = size(value),
            (Field::Angle, Object::Wall(w)) => w.angle_degrees = value,
            (Field::Angle, Object::Box(b)) => b.angle_degrees = value,
            (Field::Radius, Object::Post(p)) => p.radius_metres = value.clamp(MIN_RADIUS_METRES, MAX_SIZE_METRES),
            (Field::Roughness | Field::Seed, body) => {
                if let Some((roughness, seed)) = body.roughness_mut() {
                    match self {
                        Field::Roughness => *roughness = value.clamp(0.0, MAX_ROUGHNESS_MILLIMETRES),
                        _ => *seed = value.round().max(0.0) as u64,
                    }
                }
            }
            _ => {}
        }
    }

    /// Range and direction: either stays when the other is set. cos(theta) doesn't tell ahead from behind, so that stays, too.
    fn set_polar(self, object: &mut Object, value: f64) {
        let [x, y] = object.anchor_metres();
        let range = x.hypot(y);
        object.set_anchor(match self {
            Field::Range if range > 0.0 => [x * value.max(0.0) / range, y * value.max(0.0) / range],
            Field::Range => [0.0, value.max(0.0)],
            Field::CosTheta => {
                let cos = value.clamp(-1.0, 1.0);
                [range * cos, (range * (1.0 - cos * cos).sqrt()).copysign(y)]
            }
            _ => {
                let (sin, cos) = value.to_radians().sin_cos();
                [range * sin, range * cos]
            }
        });
    }
}

fn speed(value: f64) -> f64 {
    value.clamp(-MAX_SPEED_METRES_PER_SECOND, MAX_SPEED_METRES_PER_SECOND)
}

fn size(metres: f64) -> f64 {
    metres.clamp(MIN_SIZE_METRES, MAX_SIZE_METRES)
}

/// The fields that all `objects` have, in the order of a form.
pub fn shared<'a>(objects: impl Iterator<Item = &'a Object> + Clone, coordinates: Coordinates) -> Vec<SharedField> {
    let Some(first) = objects.clone().next() else { return Vec::new() };
    let fields = Field::of_place(coordinates).iter().chain(Field::of_kind(first)).chain(MOTION_FIELDS);
    let shared = |field: &Field| {
        let value = field.get(first)?;
        let mut is_same = true;
        for object in objects.clone() {
            is_same &= field.get(object)? == value;
        }
        Some(SharedField { field: *field, first: value, is_same })
    };
    fields.filter_map(shared).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Block, GaussianCluster, Line, Point, Polygon, Post, Wall};

    fn cluster() -> Object {
        Object::Gaussian(GaussianCluster { seed: 3, ..GaussianCluster::new([3.0, 4.0], [1.0, 2.0], 5) })
    }

    #[test]
    fn every_field_of_every_kind_is_set_to_what_it_then_reads() {
        for object in [
            Object::Point(Point::new(3.0, 4.0)),
            Object::Line(Line::vertical(3.0, 4.0, 0.5, 7)),
            cluster(),
            Object::Wall(Wall::new(3.0, 4.0, 2.0, 30.0)),
            Object::Box(Block::new([3.0, 4.0], [2.0, 1.0], 30.0)),
            Object::Post(Post::new(3.0, 4.0, 0.5)),
            Object::Polygon(Polygon::new(vec![[3.0, 4.0], [4.0, 4.0], [3.0, 5.0]])),
        ] {
            for coordinates in [Coordinates::Cartesian, Coordinates::Polar] {
                let fields = shared([&object].into_iter(), coordinates);
                assert!(fields.len() >= 3 && fields.iter().all(|f| f.is_same), "{fields:?}");
                for SharedField { field, first, .. } in fields {
                    let mut changed = object.clone();
                    let wanted = if field == Field::CosTheta { -0.25 } else { first + 2.0 };
                    field.set(&mut changed, wanted);
                    let read = field.get(&changed).unwrap();
                    assert!((read - wanted).abs() < 1e-12, "{field:?} of a {}: {read}", object.kind());
                }
            }
        }
    }

    #[test]
    fn editing_the_range_keeps_the_direction() {
        let mut p = Object::Point(Point::new(3.0, -4.0));
        Field::Range.set(&mut p, 10.0);
        assert_eq!(p.anchor_metres(), [6.0, -8.0]);
        Field::CosTheta.set(&mut p, 0.8);
        let [x, y] = p.anchor_metres();
        assert!((x - 8.0).abs() < 1e-12 && (y + 6.0).abs() < 1e-12, "behind stays behind: {x}, {y}");
        Field::AngleDegrees.set(&mut p, 0.0);
        assert_eq!(p.anchor_metres()[0], 0.0, "straight ahead is exact");
        Field::CosTheta.set(&mut p, 7.0);
        assert_eq!(p.anchor_metres()[1], 0.0, "no cosine is larger than 1");
        let mut origin = Object::Point(Point::new(0.0, 0.0));
        Field::Range.set(&mut origin, 5.0);
        assert_eq!(origin.anchor_metres(), [0.0, 5.0]);
    }

    #[test]
    fn angles_are_counted_from_straight_ahead_to_the_right() {
        let mut p = Object::Point(Point::new(3.0, 3.0));
        assert!((Field::AngleDegrees.get(&p).unwrap() - 45.0).abs() < 1e-12);
        Field::AngleDegrees.set(&mut p, -90.0);
        assert!(p.anchor_metres()[0] < -4.2, "{p:?}");
        let mut wall = Object::Line(Line::vertical(3.0, 4.0, 0.5, 5));
        assert_eq!(Field::Direction.get(&wall), Some(0.0));
        Field::Direction.set(&mut wall, 90.0);
        let Object::Line(line) = &wall else { panic!() };
        assert!((line.end_metres()[0] - 5.0).abs() < 1e-12, "it leads to the right: {line:?}");
    }

    #[test]
    fn several_objects_share_what_all_of_them_have() {
        let (point, line) = (Object::Point(Point::new(3.0, 1.0)), Object::Line(Line::vertical(3.0, 4.0, 0.5, 5)));
        let of = |objects: &[&Object]| shared(objects.iter().copied(), Coordinates::Cartesian);
        let fields = of(&[&line, &cluster()]);
        let named: Vec<_> = fields.iter().map(|f| (f.field, f.is_same)).collect();
        use Field::{Count, CrossSection, Reflectivity, VelocityX, VelocityY, X, Y};
        let expected = [X, Y, Count, Reflectivity, CrossSection, VelocityX, VelocityY];
        assert_eq!(named, expected.map(|field| (field, true)));
        let fields = of(&[&point, &line]);
        assert_eq!(fields[1], SharedField { field: Field::Y, first: 1.0, is_same: false });
        assert!(of(&[]).is_empty());
    }
}
