//! Place of an object in a range-Doppler map.

use crate::radar::Radar;
use crate::scene::{Object, Scene};

/// Place of an object's middle in a range-Doppler map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DopplerBlob {
    pub velocity_metres_per_second: f64,
    /// The velocity that the map shows, metres a second.
    pub apparent_velocity_metres_per_second: f64,
    /// The range that the map shows, metres: the frame's middle, moved by the velocity ([`Radar::doppler_range_shift_metres`]) and wrapped.
    pub apparent_range_metres: f64,
}

impl DopplerBlob {
    /// The place of `object`, as the middle of the array hears it in the middle of the frame.
    pub fn of(radar: &Radar, object: &Object) -> DopplerBlob {
        let frame = (radar.chirps as f64 - 1.0) * radar.chirp_interval_seconds + radar.chirp_seconds;
        let mut then = object.clone();
        let [vx, vy] = object.velocity_metres_per_second();
        then.translate(vx * frame / 2.0, vy * frame / 2.0);
        let [x, y] = then.centre_metres();
        let velocity = then.radial_velocity_metres_per_second();
        DopplerBlob {
            velocity_metres_per_second: velocity,
            apparent_velocity_metres_per_second: radar.apparent_velocity_metres_per_second(velocity),
            apparent_range_metres: (x.hypot(y) + radar.doppler_range_shift_metres(velocity))
                .rem_euclid(radar.max_range_metres()),
        }
    }

    /// Whether the map shows another velocity than the object's.
    pub fn is_folded(&self) -> bool {
        (self.velocity_metres_per_second - self.apparent_velocity_metres_per_second).abs()
            > 1e-9 * self.velocity_metres_per_second.abs()
    }
}

/// A sentence on objects beyond the unambiguous velocity; `None` without such objects.
pub fn folded(radar: &Radar, scene: &Scene) -> Option<String> {
    let mut blobs = scene.objects.iter().enumerate().map(|(i, o)| (i, o, DopplerBlob::of(radar, o)));
    let (index, object, blob) = blobs.find(|(.., blob)| blob.is_folded())?;
    Some(format!(
        "{} moves at {:.1} m/s, beyond the unambiguous {:.1} m/s: the map shows it at {:.1} m/s. A shorter interval tells it apart.",
        object.called(index),
        blob.velocity_metres_per_second,
        radar.unambiguous_velocity_metres_per_second(),
        blob.apparent_velocity_metres_per_second
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::doppler::range_doppler;
    use crate::scene::Point;
    use crate::signal::Floor;

    fn moving(place: [f64; 2], [vx, vy]: [f64; 2]) -> Object {
        Object::Point(Point {
            velocity_x_metres_per_second: vx,
            velocity_y_metres_per_second: vy,
            ..Point::new(place[0], place[1])
        })
    }

    #[test]
    fn the_map_has_objects_where_it_is_said() {
        let radar =
            Radar { elements: 64, chirps: 64, chirp_interval_seconds: 60e-6, chirp_seconds: 45e-6, ..Radar::default() };
        for (place, velocity) in [([3.0, 12.0], [0.0, -9.0]), ([-6.0, 20.0], [15.0, 2.0]), ([0.0, 9.0], [0.0, 60.0])] {
            let object = moving(place, velocity);
            let blob = DopplerBlob::of(&radar, &object);
            let scene = Scene { objects: vec![object], ..Scene::default() };
            let map = range_doppler(&radar, &scene, Floor::Exact, 0).unwrap();
            let (bin, column) = map.peak();
            let range_off = radar.range_of_bin_metres(bin as f64) - blob.apparent_range_metres;
            assert!(range_off.abs() < 0.75 * radar.range_resolution_metres(), "{place:?}: {range_off}");
            let read = radar.velocity_of_column_metres_per_second(column as f64);
            let off = (read - blob.apparent_velocity_metres_per_second) / radar.velocity_resolution_metres_per_second();
            assert!(off.abs() < 0.6, "{place:?}: {off}");
        }
    }
}
