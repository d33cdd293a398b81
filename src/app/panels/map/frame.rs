//! A map on screen: the places of its cells, and their values.

use crate::app::state::{Cursor, MapView, Projection};
use crate::app::widgets::{levels, signed};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::{Polar, Radar};
use crate::scene::Reflector;
use crate::theory::MapPlace;
use eframe::egui::{Pos2, Rect, pos2};

/// Rectangle, visible part and projection of a map on screen.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// Rectangle on screen.
    pub rect: Rect,
    /// The visible part of the map.
    pub view: MapView,
    pub radar: &'a Radar,
    /// Projection of the map.
    pub projection: Projection,
    /// Middle of the map's elements, metres along the array.
    pub centre_x_metres: f64,
    /// The start of the animation, while the map changes from another projection.
    pub morph: Option<Morph>,
}

/// Start of the animation from another projection.
#[derive(Clone, Copy)]
pub struct Morph {
    /// Rectangle of the map in that projection.
    pub rect: Rect,
    /// Visible part of the map in that projection.
    pub view: MapView,
    /// The projection that the map comes from.
    pub projection: Projection,
    /// Remaining part of the animation, 1 to 0.
    pub left: f32,
}

/// The place between `to` and `from`, with the part `left` of the way remaining.
pub fn between(to: Pos2, from: Pos2, left: f32) -> Pos2 {
    to + left * (from - to)
}

impl<'a> Frame<'a> {
    /// Frame of a part of a map, at rest.
    pub fn of(rect: Rect, view: MapView, radar: &'a Radar, projection: Projection, centre_x_metres: f64) -> Self {
        Frame { rect, view, radar, projection, centre_x_metres, morph: None }
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

    /// Place on screen of a cursor.
    pub fn cursor(&self, cursor: &Cursor) -> Pos2 {
        let cos_theta = cursor.cos_theta * self.radar.squint();
        self.at(Polar { range_metres: cursor.range_metres, cos_theta })
    }

    /// The range and the direction of the map at a place on screen.
    pub fn polar(&self, pos: Pos2) -> Polar {
        let (radar, fraction) = (self.radar, self.view.at(self.rect, pos));
        let (fx, fy) = (f64::from(fraction.x), f64::from(fraction.y));
        match self.projection {
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

    /// Place on screen of a range and a direction of the map; ranges wrap around as in the map.
    fn at(&self, blob: Polar) -> Pos2 {
        self.on_screen(|projection| fraction(self.radar, projection, blob))
    }

    /// Place on screen of a place whose fraction of a map in either projection is `fraction`.
    fn on_screen(&self, fraction: impl Fn(Projection) -> Pos2) -> Pos2 {
        let to = self.view.to_screen(self.rect, fraction(self.projection));
        match &self.morph {
            Some(from) => between(to, from.view.to_screen(from.rect, fraction(from.projection)), from.left),
            None => to,
        }
    }

    /// The range and the direction of a place of the range-angle map, given as a fraction of it.
    pub fn polar_of_cell(&self, fraction: Pos2) -> Polar {
        let (radar, fx, fy) = (self.radar, f64::from(fraction.x), f64::from(fraction.y));
        Polar {
            range_metres: radar.range_of_bin_metres(fy * radar.samples as f64 - 0.5).max(0.0),
            cos_theta: radar.cos_of_column(radar.column_across(fx)),
        }
    }

    /// The fraction of a map in `projection` at a place whose fraction of the range-angle map is known: a fraction computed again would wrap
    /// around at the map's far edges.
    pub fn fraction_in(&self, projection: Projection, polar: Polar, range_angle: Pos2) -> Pos2 {
        match projection {
            Projection::RangeAngle => range_angle,
            Projection::Cartesian => fraction(self.radar, projection, polar),
        }
    }

    /// Place on screen of a place whose fraction of the range-angle map is known.
    pub fn at_fraction(&self, polar: Polar, range_angle: Pos2) -> Pos2 {
        self.on_screen(|projection| self.fraction_in(projection, polar, range_angle))
    }

    /// Rectangle on screen that the map takes, during the animation too.
    pub fn shown(&self) -> Rect {
        let Some(from) = &self.morph else { return self.rect };
        let corner = |to: Pos2, of: Pos2| between(to, of, from.left);
        Rect::from_min_max(corner(self.rect.min, from.rect.min), corner(self.rect.max, from.rect.max))
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

/// Values of a map's cells.
pub struct Cells<'a> {
    /// Lambda, `[range bins, columns]`.
    pub map: &'a RangeAngleMap,
    /// Lambda of the map that is subtracted, for a difference.
    pub minus: Option<&'a RangeAngleMap>,
    /// Scale from Lambda to decades of amplitude.
    pub scale: Option<LambdaScale>,
}

/// Value of a cell of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value {
    /// Lambda, or a difference of it.
    pub lambda: f64,
    /// Decibels relative to the peak, or a difference of them, where the scale is known.
    pub decibels: Option<f64>,
    /// Decibels that Lambda spans, where the scale is known.
    pub range_db: Option<f64>,
}

impl Cells<'_> {
    /// Value of a cell; `None` outside the map.
    pub fn value(&self, bin: usize, column: usize) -> Option<Value> {
        let lambda = *self.map.lambda.get((bin, column))?;
        let range_db = self.scale.map(|s| s.decibels());
        Some(match self.minus {
            Some(minus) => {
                let difference = f64::from(lambda - minus.lambda.get((bin, column))?);
                Value { lambda: difference, decibels: range_db.map(|range| range * difference), range_db }
            }
            None => {
                let lambda = f64::from(lambda);
                Value { lambda, decibels: range_db.map(|range| range * (lambda - 1.0)), range_db }
            }
        })
    }
}

impl Value {
    /// Text of the decibels, without the unit.
    pub fn decibels_text(&self, is_difference: bool) -> Option<String> {
        let (db, range_db) = self.decibels.zip(self.range_db)?;
        Some(if is_difference { levels::difference(db) } else { levels::level(db, range_db) })
    }

    /// Text of Lambda, with its sign where it is a difference.
    pub fn lambda_text(&self, is_difference: bool) -> String {
        if is_difference { signed(self.lambda, 3) } else { format!("{:.3}", self.lambda) }
    }
}

/// The reflectors of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct Marked {
    pub reflectors: Vec<Reflector>,
    /// Whether the reflectors stand in a line, which one outline marks where their rings would run together.
    pub is_line: bool,
}

/// Reflectors drawn over a map.
pub struct Marks<'a> {
    /// True reflectors, object by object: as rings, or as the outline of a line.
    pub objects: &'a [Marked],
    /// Reflectors that the method found, as crosses.
    pub found: &'a [Reflector],
}

/// The cursor at a place of the map, given as fractions of its width and height. `None` outside the radar's view.
pub fn cursor_at(radar: &Radar, projection: Projection, fraction: Pos2) -> Option<Cursor> {
    let (fx, fy) = (f64::from(fraction.x), f64::from(fraction.y));
    match projection {
        Projection::RangeAngle => {
            Some(Cursor::at_cell(radar, fy * radar.samples as f64 - 0.5, radar.column_across(fx)))
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            let cursor = Cursor::at_blob(radar, radar.polar_of((2.0 * fx - 1.0) * extent, fy * extent));
            cursor.cell(radar).map(|_| cursor)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interact::Place;
    use crate::radar::End;
    use eframe::egui::vec2;

    #[test]
    fn a_ring_is_drawn_where_the_map_has_the_blob() {
        let radar = Radar::default();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(1024.0, 512.0));
        let reflector = Reflector { x_metres: -0.832 * 20.0, y_metres: 0.5548 * 20.0, reflectivity: 1.0 };
        let frame =
            |projection, centre_x_metres| Frame::of(rect, MapView::default(), &radar, projection, centre_x_metres);
        let target = frame(Projection::RangeAngle, 0.0);
        let cos = |at: Pos2| radar.cos_of_column(f64::from(at.x) - 0.5);
        assert!((cos(target.blob(&reflector)) + 0.81).abs() < 2e-3, "the blob");
        assert!((cos(target.true_direction(&reflector)) + 0.832).abs() < 2e-3, "the direction");
        let input = frame(Projection::RangeAngle, radar.end_centre_metres(End::First));
        assert!(
            cos(input.blob(&reflector)) > cos(target.blob(&reflector)),
            "the left end sees it less far to the left"
        );
        for projection in [Projection::RangeAngle, Projection::Cartesian] {
            let frame = frame(projection, 0.0);
            let cursor = Cursor::at_place(&radar, Place::new(reflector.x_metres, reflector.y_metres));
            let blob = frame.blob(&reflector);
            assert!(
                (frame.cursor(&cursor) - blob).length() < 1e-2,
                "the pointer over it in the scene is over its blob"
            );
            let back = cursor_at(&radar, projection, pos2(blob.x / 1024.0, 1.0 - blob.y / 512.0)).unwrap();
            assert!(back.place.distance_metres(cursor.place) < 1e-2, "and back: {back:?}");
        }
    }
}
