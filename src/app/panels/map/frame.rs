//! A map on screen: the places of its cells, and their values.

use crate::app::state::{Cursor, MapView, Projection};
use crate::app::widgets::{difference, level, signed};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::{Polar, Radar};
use crate::scene::Reflector;
use crate::theory::MapPlace;
use eframe::egui::{Align2, Pos2, Rect, Vec2, pos2, vec2};

/// Distance from the top within which the pointer would be under a text in the right corner, points.
const CORNER_TEXT_HEIGHT_POINTS: f32 = 40.0;

/// Size of the button in a map's corner, points.
pub const BUTTON_SIZE_POINTS: Vec2 = vec2(24.0, 20.0);

/// Rectangle, visible part and projection of a map on screen.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    pub rect: Rect,
    pub view: MapView,
    pub radar: &'a Radar,
    pub projection: Projection,
    /// Middle of the map's elements, metres along the array.
    pub centre_x_metres: f64,
}

impl<'a> Frame<'a> {
    pub fn of(rect: Rect, view: MapView, radar: &'a Radar, projection: Projection, centre_x_metres: f64) -> Self {
        Frame { rect, view, radar, projection, centre_x_metres }
    }

    /// Height of a range bin on screen, points; in a Cartesian map that of a bin straight ahead.
    pub fn cell_height(&self) -> f32 {
        self.rect.height() / (self.view.high.y - self.view.low.y) / self.radar.samples as f32
    }

    /// Place on screen of a reflector's blob.
    pub fn blob(&self, reflector: &Reflector) -> Pos2 {
        self.at(self.radar.blob_of(self.centre_x_metres, reflector.x_metres, reflector.y_metres))
    }

    /// Place on screen of a reflector without the beam's squint.
    pub fn true_direction(&self, reflector: &Reflector) -> Pos2 {
        self.at(self.radar.polar_of(reflector.x_metres - self.centre_x_metres, reflector.y_metres))
    }

    /// Place on screen of a fractional cell.
    pub fn cell(&self, cell: MapPlace) -> Pos2 {
        let range_metres = self.radar.range_of_bin_metres(cell.bin.rem_euclid(self.radar.samples as f64));
        self.at(Polar { range_metres, cos_theta: self.radar.cos_of_column(cell.column) })
    }

    pub fn cursor(&self, cursor: &Cursor) -> Pos2 {
        let cos_theta = cursor.cos_theta * self.radar.squint();
        self.at(Polar { range_metres: cursor.range_metres, cos_theta })
    }

    /// The range and the direction of the map at a place on screen.
    pub fn polar(&self, pos: Pos2) -> Polar {
        polar_of(self.radar, self.projection, self.view.at(self.rect, pos))
    }

    /// Place on screen of a range and a direction of the map; ranges wrap around as in the map.
    fn at(&self, blob: Polar) -> Pos2 {
        self.view.to_screen(self.rect, fraction(self.radar, self.projection, blob))
    }

    /// Place on screen of a place of the range-angle map, given as a fraction of it: a fraction computed again would wrap around at the map's far edges.
    pub fn at_fraction(&self, range_angle: Pos2) -> Pos2 {
        let of_map = match self.projection {
            Projection::RangeAngle => range_angle,
            Projection::Cartesian => {
                let polar = polar_of(self.radar, Projection::RangeAngle, range_angle);
                fraction(self.radar, self.projection, Polar { range_metres: polar.range_metres.max(0.0), ..polar })
            }
        };
        self.view.to_screen(self.rect, of_map)
    }

    /// Place of a text in the upper left corner, `below` points beneath the map's top and beside the button that a Cartesian map has there.
    pub fn upper_left(&self, below: f32) -> Pos2 {
        let beside = if self.projection == Projection::Cartesian { BUTTON_SIZE_POINTS.x + 8.0 } else { 0.0 };
        self.rect.left_top() + vec2(10.0 + beside, below)
    }

    /// The upper corner away from a place, `below` points beneath the map's top, and the alignment of a text there.
    pub fn far_corner(&self, at: Pos2, below: f32) -> (Pos2, Align2) {
        match at.y < self.rect.top() + CORNER_TEXT_HEIGHT_POINTS && at.x > self.rect.center().x {
            true => (self.upper_left(below), Align2::LEFT_TOP),
            false => (self.rect.right_top() + vec2(-10.0, below), Align2::RIGHT_TOP),
        }
    }
}

/// The range and the direction at fractions of the width and height of a map in a projection.
fn polar_of(radar: &Radar, projection: Projection, fraction: Pos2) -> Polar {
    let (fx, fy) = (f64::from(fraction.x), f64::from(fraction.y));
    match projection {
        Projection::RangeAngle => Polar {
            range_metres: radar.range_of_bin_metres(fy * radar.samples as f64 - 0.5),
            cos_theta: radar.cos_of_column(radar.column_across(fx)),
        },
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            radar.polar_of((2.0 * fx - 1.0) * extent, fy * extent)
        }
    }
}

/// Place of a range and a direction, as fractions of the width and height of a map in a projection.
fn fraction(radar: &Radar, projection: Projection, polar: Polar) -> Pos2 {
    let Polar { range_metres, cos_theta } = polar;
    match projection {
        Projection::RangeAngle => {
            let bin = radar.bin_of_range(range_metres).rem_euclid(radar.samples as f64);
            let across = radar.across_of_column(radar.column_of_cos(cos_theta));
            pos2(across as f32, ((bin + 0.5) / radar.samples as f64) as f32)
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
            let (x, y) = (range_metres * cos_theta, range_metres * sin_theta);
            pos2(((x / extent + 1.0) / 2.0) as f32, (y / extent) as f32)
        }
    }
}

pub struct Cells<'a> {
    /// Lambda, `[range bins, columns]`.
    pub map: &'a RangeAngleMap,
    /// Lambda of the map that is subtracted, for a difference.
    pub minus: Option<&'a RangeAngleMap>,
    /// Scale from Lambda to decades of amplitude.
    pub scale: Option<LambdaScale>,
}

impl Cells<'_> {
    /// Texts of a cell, with a sign for a difference: Lambda, and decibels relative to the peak where the scale is known. `None` outside the map.
    pub fn texts(&self, bin: usize, column: usize) -> Option<(String, Option<String>)> {
        let lambda = *self.map.lambda.get((bin, column))?;
        let range_db = self.scale.map(|s| s.decibels());
        let Some(minus) = self.minus else {
            let lambda = f64::from(lambda);
            return Some((format!("{lambda:.3}"), range_db.map(|range| level(range * (lambda - 1.0), range))));
        };
        let delta = f64::from(lambda - minus.lambda.get((bin, column))?);
        Some((signed(delta, 3), range_db.map(|range| difference(range * delta))))
    }
}

/// The reflectors of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct Marked {
    pub reflectors: Vec<Reflector>,
    /// Whether the reflectors stand in a line, which one outline marks where their rings would run together.
    pub is_line: bool,
}

/// The cursor at a place of the map, given as fractions of its width and height. `None` outside the radar's view.
pub fn cursor_at(radar: &Radar, projection: Projection, fraction: Pos2) -> Option<Cursor> {
    match projection {
        Projection::RangeAngle => {
            let bin = f64::from(fraction.y) * radar.samples as f64 - 0.5;
            Some(Cursor::at_cell(radar, bin, radar.column_across(f64::from(fraction.x))))
        }
        Projection::Cartesian => {
            let cursor = Cursor::at_blob(radar, polar_of(radar, projection, fraction));
            cursor.cell(radar).map(|_| cursor)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::Place;
    use crate::radar::End;

    #[test]
    fn a_ring_is_drawn_where_the_map_has_the_blob() {
        let radar = Radar::default();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(1024.0, 512.0));
        let reflector = Reflector { x_metres: -0.832 * 20.0, y_metres: 0.5548 * 20.0, reflectivity: 1.0 };
        let frame = |projection, centre_x| Frame::of(rect, MapView::default(), &radar, projection, centre_x);
        let target = frame(Projection::RangeAngle, 0.0);
        let cos = |at: Pos2| radar.cos_of_column(f64::from(at.x) - 0.5);
        assert!((cos(target.blob(&reflector)) + 0.81).abs() < 2e-3, "the blob");
        assert!((cos(target.true_direction(&reflector)) + 0.832).abs() < 2e-3, "the direction");
        let input = frame(Projection::RangeAngle, radar.end_centre_metres(End::First));
        assert!(cos(input.blob(&reflector)) > cos(target.blob(&reflector)), "less far to the left of the left end");
        for projection in [Projection::RangeAngle, Projection::Cartesian] {
            let frame = frame(projection, 0.0);
            let cursor = Cursor::at_place(&radar, Place::new(reflector.x_metres, reflector.y_metres));
            let blob = frame.blob(&reflector);
            assert!((frame.cursor(&cursor) - blob).length() < 1e-2, "a pointer over it in the scene is over its blob");
            let polar = radar.blob_of(0.0, reflector.x_metres, reflector.y_metres);
            let of_cell = frame.at_fraction(fraction(&radar, Projection::RangeAngle, polar));
            assert!((of_cell - blob).length() < 1e-2, "{of_cell:?}, not {blob:?}");
            let back = cursor_at(&radar, projection, pos2(blob.x / 1024.0, 1.0 - blob.y / 512.0)).unwrap();
            assert!(back.place.distance_metres(cursor.place) < 1e-2, "and back: {back:?}");
        }
    }
}
