//! The visible parts of maps and scene, and the pointer's place in all of them.

use crate::interact::Place;
use crate::radar::{Polar, Radar};
use crate::view::Projection;
use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};

/// The visible part of a map, as fractions of its width and height; y counts upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapView {
    pub low: Pos2,
    pub high: Pos2,
}

impl Default for MapView {
    fn default() -> Self {
        MapView { low: pos2(0.0, 0.0), high: pos2(1.0, 1.0) }
    }
}

impl MapView {
    /// The part `half` to either side of `middle`, within the map; at most all of it.
    pub fn around(middle: Pos2, half: Vec2) -> MapView {
        let half = half.min(Vec2::splat(0.5));
        let low = (middle - half).clamp(Pos2::ZERO, pos2(1.0, 1.0) - 2.0 * half);
        MapView { low, high: low + 2.0 * half }
    }

    fn size(&self) -> Vec2 {
        self.high - self.low
    }

    /// The fraction of the map at the place `pos` in `rect`.
    pub fn at(&self, rect: Rect, pos: Pos2) -> Pos2 {
        let part = vec2((pos.x - rect.left()) / rect.width(), (rect.bottom() - pos.y) / rect.height());
        self.low + part * self.size()
    }

    /// The place in `rect` of a fraction of the map.
    pub fn to_screen(self, rect: Rect, fraction: Pos2) -> Pos2 {
        let part = (fraction - self.low) / self.size();
        pos2(rect.left() + part.x * rect.width(), rect.bottom() - part.y * rect.height())
    }

    /// Zooms by `factor` around the fraction `fixed`.
    pub fn zoom(&mut self, factor: f32, fixed: Pos2) {
        let size = (self.size() / factor).clamp(Vec2::splat(0.01), Vec2::splat(1.0));
        let part = (fixed - self.low) / self.size();
        self.low = fixed - part * size;
        self.high = self.low + size;
        self.keep_inside();
    }

    /// Moves by a fraction of the whole map.
    pub fn pan(&mut self, by: Vec2) {
        self.low += by;
        self.high += by;
        self.keep_inside();
    }

    fn keep_inside(&mut self) {
        let size = self.size();
        self.low = self.low.clamp(Pos2::ZERO, pos2(1.0, 1.0) - size);
        self.high = self.low + size;
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneView {
    pub centre: Place,
    /// Scale: metres per point on screen.
    pub metres_per_point: f64,
    /// Whether to fit the scene to the panel in the next frame.
    pub fit: bool,
    /// Size on screen that the scene was fitted to, until the user zooms or pans. Another size fits it again.
    pub fitted: Option<Vec2>,
    /// First corner of a selection box, while one is drawn.
    pub box_start: Option<Place>,
    /// Place where the pointer last released an object. No tooltip of the object appears until the pointer leaves the place.
    pub dropped: Option<Pos2>,
}

impl Default for SceneView {
    fn default() -> Self {
        SceneView {
            centre: Place::new(0.0, 18.0),
            metres_per_point: 0.1,
            fit: true,
            fitted: None,
            box_start: None,
            dropped: None,
        }
    }
}

impl SceneView {
    /// The place on screen of a place of the scene; y points up.
    pub fn to_screen(self, rect: Rect, place: Place) -> Pos2 {
        let dx = (place.x_metres - self.centre.x_metres) / self.metres_per_point;
        let dy = (place.y_metres - self.centre.y_metres) / self.metres_per_point;
        rect.center() + vec2(dx as f32, -dy as f32)
    }

    pub fn to_scene(self, rect: Rect, pos: Pos2) -> Place {
        let d = pos - rect.center();
        Place::new(
            self.centre.x_metres + f64::from(d.x) * self.metres_per_point,
            self.centre.y_metres - f64::from(d.y) * self.metres_per_point,
        )
    }

    /// Whether the pointer is still where it released an object.
    pub fn was_just_dropped(&self, ctx: &eframe::egui::Context) -> bool {
        self.dropped.zip(ctx.pointer_latest_pos()).is_some_and(|(dropped, now)| dropped.distance(now) < 12.0)
    }

    /// Fits the rectangle between two corners into `rect`, with a little room around it.
    pub fn show(&mut self, rect: Rect, low: Place, high: Place) {
        let width = (high.x_metres - low.x_metres).max(1.0);
        let height = (high.y_metres - low.y_metres).max(1.0);
        self.metres_per_point =
            (width / f64::from(rect.width().max(1.0))).max(height / f64::from(rect.height().max(1.0))).clamp(1e-4, 1e3);
        self.centre = Place::new((low.x_metres + high.x_metres) / 2.0, (low.y_metres + high.y_metres) / 2.0);
    }

    pub fn zoom(&mut self, factor: f64, rect: Rect, pos: Pos2) {
        let fixed = self.to_scene(rect, pos);
        self.metres_per_point = (self.metres_per_point / factor).clamp(1e-4, 1.0);
        let now = self.to_scene(rect, pos);
        self.centre.x_metres += fixed.x_metres - now.x_metres;
        self.centre.y_metres += fixed.y_metres - now.y_metres;
    }
}

/// The pointer's place, in the coordinates of all panels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cursor {
    pub place: Place,
    /// Range from the middle of the array.
    pub range_metres: f64,
    /// Cosine of the true angle to the array's axis, not that of the column.
    pub cos_theta: f64,
    /// Range bin, fractional; beyond the last one for a place out of range.
    pub bin: f64,
    pub column: f64,
}

/// The visible part of the maps, in either kind of coordinates.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MapViews {
    /// Maps over cos(theta) and range.
    pub range_angle: MapView,
    pub cartesian: MapView,
}

impl MapViews {
    /// The visible part of maps over these coordinates.
    pub fn of(&mut self, projection: Projection) -> &mut MapView {
        match projection {
            Projection::RangeAngle => &mut self.range_angle,
            Projection::Cartesian => &mut self.cartesian,
        }
    }
}

/// The pointer's place in this frame and earlier ones.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pointer {
    /// Place in the last frame, which every panel draws.
    pub now: Option<Cursor>,
    /// Place set by a panel of this frame.
    next: Option<Cursor>,
    /// Last place within the maps, for panels that need one while the pointer is elsewhere.
    pub last: Option<Cursor>,
}

impl Pointer {
    /// Sets the pointer's place, from the panel under it.
    pub fn hover(&mut self, cursor: Cursor) {
        self.next = Some(cursor);
    }

    /// Ends a frame. True where the pointer moved, so that panels drawn before the one under it still show its old place.
    pub fn turn(&mut self, radar: &Radar) -> bool {
        let moved = self.next != self.now;
        self.now = self.next.take();
        self.last = self.now.filter(|c| c.cell(radar).is_some()).or(self.last);
        moved
    }
}

impl Cursor {
    /// The cursor at a place of the scene, in the cell of its blob in the whole array's map.
    pub fn at_place(radar: &Radar, place: Place) -> Self {
        let (polar, blob) =
            (radar.polar_of(place.x_metres, place.y_metres), radar.blob_of(0.0, place.x_metres, place.y_metres));
        Cursor {
            place,
            range_metres: polar.range_metres,
            cos_theta: polar.cos_theta,
            bin: radar.bin_of_range(polar.range_metres),
            column: radar.column_of_cos(blob.cos_theta),
        }
    }

    /// The cursor at a cell of a map, at the place of the reflector whose blob is there.
    pub fn at_cell(radar: &Radar, bin: f64, column: f64) -> Self {
        let blob = Polar { range_metres: radar.range_of_bin_metres(bin), cos_theta: radar.cos_of_column(column) };
        Cursor { column, ..Cursor::at_blob(radar, blob) }
    }

    /// The cursor at a range and direction of a map.
    pub fn at_blob(radar: &Radar, blob: Polar) -> Self {
        let Polar { range_metres, cos_theta } = blob;
        let column = radar.column_of_cos(cos_theta);
        let cos_theta = radar.cos_of_blob(cos_theta);
        let place = Place::new(range_metres * cos_theta, range_metres * (1.0 - cos_theta * cos_theta).sqrt());
        Cursor { place, range_metres, cos_theta, bin: radar.bin_of_range(range_metres), column }
    }

    /// Range bin and column of the cell, if the maps have it.
    pub fn cell(&self, radar: &Radar) -> Option<(usize, usize)> {
        let bin = self.bin.round();
        let inside = bin >= 0.0 && bin < radar.samples as f64;
        inside.then(|| (bin as usize, self.column.round() as usize % radar.elements))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn map_and_scene_zoom_around_a_fixed_place() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(200.0, 100.0));
        let mut w = MapView::default();
        let pointer = pos2(60.0, 45.0);
        let fixed = w.at(rect, pointer);
        w.zoom(3.0, fixed);
        assert!((w.to_screen(rect, fixed) - pointer).length() < 1e-3);
        let mut v = SceneView::default();
        let before = v.to_scene(rect, pos2(33.0, 44.0));
        v.zoom(2.0, rect, pos2(33.0, 44.0));
        assert!(before.distance_metres(v.to_scene(rect, pos2(33.0, 44.0))) < 1e-9);
    }

    #[test]
    fn a_zoomed_map_stays_within_its_edges() {
        let (mut w, fixed) = (MapView::default(), pos2(0.25, 0.75));
        w.zoom(3.0, fixed);
        w.pan(vec2(9.0, -9.0));
        assert!(w.low.x >= 0.0 && w.high.x <= 1.0 + 1e-6 && w.low.y >= 0.0);
        w.zoom(1e-6, fixed);
        assert_eq!(w, MapView::default());
    }

    #[test]
    fn cursors_agree_between_scene_and_map() {
        let radar = Radar::default();
        let a = Cursor::at_place(&radar, Place::new(3.0, 14.0));
        let b = Cursor::at_cell(&radar, a.bin, a.column);
        assert!(a.place.distance_metres(b.place) < 1e-9);
        assert_eq!(Cursor::at_place(&radar, Place::new(0.0, 99.0)).cell(&radar), None);
    }
}
