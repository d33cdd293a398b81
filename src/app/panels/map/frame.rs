//! A map on screen: where its places are, and the numbers behind them.

use crate::app::state::{Cursor, MapView, Projection};
use crate::interact::Place;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Radar;
use crate::scene::Reflector;
use eframe::egui::{Pos2, Rect, pos2};

/// Where on screen a map is, and which part of it.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// On screen.
    pub rect: Rect,
    /// The visible part.
    pub view: MapView,
    /// The radar.
    pub radar: &'a Radar,
    /// Over which coordinates.
    pub projection: Projection,
}

impl Frame<'_> {
    /// Where a place of the scene appears.
    pub fn at(&self, cursor: &Cursor) -> Pos2 {
        self.view.to_screen(self.rect, fraction_of(self.radar, self.projection, cursor))
    }
}

/// The numbers behind a picture.
pub struct Cells<'a> {
    /// Lambda, `[range bins, columns]`.
    pub map: &'a RangeAngleMap,
    /// What is subtracted from it.
    pub minus: Option<&'a RangeAngleMap>,
    /// From Lambda to decades of amplitude.
    pub scale: Option<LambdaScale>,
}

/// Reflectors drawn over a map.
pub struct Marks<'a> {
    /// True ones, as rings.
    pub reflectors: &'a [Reflector],
    /// Those the method found, as crosses.
    pub found: &'a [Reflector],
}

/// A place of the map as fractions of its width and height, to a cursor. `None` outside the radar's view.
pub fn cursor_at(radar: &Radar, projection: Projection, fraction: Pos2) -> Option<Cursor> {
    let (fx, fy) = (f64::from(fraction.x), f64::from(fraction.y));
    match projection {
        Projection::RangeAngle => {
            Some(Cursor::at_cell(radar, fy * radar.samples as f64 - 0.5, fx * radar.elements as f64 - 0.5))
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            let cursor = Cursor::at_place(radar, Place::new((2.0 * fx - 1.0) * extent, fy * extent));
            cursor.cell(radar).map(|_| cursor)
        }
    }
}

/// Where a place of the scene appears in the map, as fractions.
fn fraction_of(radar: &Radar, projection: Projection, cursor: &Cursor) -> Pos2 {
    match projection {
        Projection::RangeAngle => {
            let bin = cursor.bin.rem_euclid(radar.samples as f64);
            pos2(((cursor.column + 0.5) / radar.elements as f64) as f32, ((bin + 0.5) / radar.samples as f64) as f32)
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            // A line array sees y and -y alike.
            let (x, y) = (cursor.place.x_metres, cursor.place.y_metres.abs());
            pos2(((x / extent + 1.0) / 2.0) as f32, (y / extent) as f32)
        }
    }
}
