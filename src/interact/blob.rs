//! Blobs of a map as handles: the blob under the pointer, and the place of a reflector after its blob is moved.

use super::{Grip, Place, hit::Hit};
use crate::radar::{Polar, Radar};
use crate::scene::{Reflector, Scene};

/// Radius around the middle of a blob within which it can be grabbed, in points of the view: blobs are wider than points of the scene.
pub const BLOB_RADIUS_POINTS: f64 = 12.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlobHit {
    pub object: usize,
    /// Place of the object's reflector that makes the blob.
    pub place: Place,
}

impl BlobHit {
    pub fn as_hit(&self, scene: &Scene) -> Option<Hit> {
        let place = scene.objects.get(self.object)?.centre_metres().into();
        Some(Hit { object: self.object, grip: Grip::Body, place })
    }
}

/// The reflector whose blob is nearest to the pointer; `distance_points` gives the distance of a reflector's blob, points of the view.
pub fn nearest(scene: &Scene, distance_points: impl Fn(&Reflector) -> f64) -> Option<BlobHit> {
    let mut best: Option<(f64, BlobHit)> = None;
    for (object, o) in scene.objects.iter().enumerate() {
        for reflector in o.marks() {
            let distance = distance_points(&reflector);
            if distance <= best.map_or(BLOB_RADIUS_POINTS, |(d, _)| d) {
                let place = Place::new(reflector.x_metres, reflector.y_metres);
                best = Some((distance, BlobHit { object, place }));
            }
        }
    }
    best.map(|(_, hit)| hit)
}

/// The place of a reflector at `place` after its blob was dragged from `from` to `to`, on the map of the elements around (`centre_x_metres`, 0).
///
/// Ranges that wrapped around and directions that were folded stay so, and reflectors behind the array stay behind it: the blob alone doesn't tell.
pub fn moved(radar: &Radar, centre_x_metres: f64, place: Place, from: Polar, to: Polar) -> Place {
    let blob = radar.blob_of(centre_x_metres, place.x_metres, place.y_metres);
    let range = (blob.range_metres + to.range_metres - from.range_metres).max(0.0);
    let cos = radar.cos_of_blob(blob.cos_theta + to.cos_theta - from.cos_theta);
    let ahead = (range * (1.0 - cos * cos).max(0.0).sqrt()).copysign(place.y_metres);
    Place::new(centre_x_metres + range * cos, ahead)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::{Editor, SelectionMode, Snap};
    use crate::radar::End;
    use crate::scene::{Line, Object};

    #[test]
    fn the_reflector_goes_where_its_blob_is_taken() {
        let radar = Radar::default();
        for (centre, y) in [(0.0, 12.0), (radar.end_centre_metres(End::First), 12.0), (0.0, -12.0), (0.0, 60.0)] {
            let place = Place::new(-7.0, y);
            let from = radar.blob_of(centre, place.x_metres, place.y_metres);
            let to = Polar { range_metres: from.range_metres + 3.0, cos_theta: from.cos_theta + 0.4 };
            let after = moved(&radar, centre, place, from, to);
            let blob = radar.blob_of(centre, after.x_metres, after.y_metres);
            assert!((blob.range_metres - to.range_metres).abs() < 1e-9, "{after:?}");
            assert!((blob.cos_theta - to.cos_theta).abs() < 1e-9 && after.y_metres * y > 0.0, "{after:?}");
        }
        let endfire = Polar { range_metres: 5.0, cos_theta: 3.0 };
        let at = moved(&radar, 0.0, Place::new(0.0, 5.0), radar.blob_of(0.0, 0.0, 5.0), endfire);
        let holds = (at.x_metres - 5.0).abs() < 1e-12 && at.y_metres.abs() < 1e-12;
        assert!(holds, "no farther than along the array: {at:?}");
    }

    #[test]
    fn a_hit_blob_moves_its_whole_object() {
        let radar = Radar::default();
        let mut scene = Scene::of_points([(-3.0, 10.0), (3.0, 10.0)]);
        scene.objects.push(Object::Line(Line::vertical(0.0, 20.0, 0.5, 5)));
        let pointer = radar.blob_of(0.0, 0.0, 22.02);
        let points = |r: &Reflector| {
            let blob = radar.blob_of(0.0, r.x_metres, r.y_metres);
            (blob.range_metres - pointer.range_metres).hypot(40.0 * (blob.cos_theta - pointer.cos_theta)) / 0.1
        };
        let hit = nearest(&scene, points).unwrap();
        assert_eq!(hit, BlobHit { object: 2, place: Place::new(0.0, 22.0) });
        assert_eq!(nearest(&scene, |r| points(r) + 20.0), None, "nothing is near enough");

        let mut editor = Editor::new(scene);
        editor.select([0], SelectionMode::Replace);
        editor.grab(hit);
        let to = Polar { range_metres: pointer.range_metres + 1.5, ..pointer };
        editor.drag_to(moved(&radar, 0.0, hit.place, pointer, to), Snap::Metres(0.5));
        editor.end_drag();
        assert_eq!(editor.selection().single(), Some(2));
        let [x, y] = editor.scene().objects[2].anchor_metres();
        assert!(x.abs() < 1e-9 && (y - 21.5).abs() < 1e-9, "its middle snapped to whole halves: {x}, {y}");
        assert!(editor.undo() && editor.scene().objects[2].anchor_metres() == [0.0, 20.0]);
        assert_eq!(editor.history().depth(), 0, "one step");
    }
}
