//! The cells of the whole array's polar grid: every range bin by every direction of the radar.

use crate::radar::Radar;
use crate::reconstruct::polar::{Direction, directions, row_ranges_metres};
use crate::scene::{Reflector, touched_element};
use crate::signal::{ArrayEcho, TwoEnds};
use ndarray::Array2;

pub(super) struct GridCells<'a> {
    radar: &'a Radar,
    is_measured: Vec<bool>,
    pub range_metres: Vec<f64>,
    /// Directions; several may share a column of the map.
    pub directions: Vec<Direction>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct GridCell {
    pub bin: usize,
    pub direction: usize,
}

impl<'a> GridCells<'a> {
    /// The cells of `radar`'s map, with echoes at all its elements.
    pub fn new(radar: &'a Radar) -> Self {
        let is_measured = vec![true; 2 * radar.end_elements];
        GridCells { radar, is_measured, range_metres: row_ranges_metres(radar), directions: directions(radar) }
    }

    /// The cells of `radar`'s map, with echoes at the elements of `ends` that have samples.
    pub fn with_measured_elements(radar: &'a Radar, ends: &TwoEnds) -> Self {
        GridCells { is_measured: ends.measured_elements(), ..GridCells::new(radar) }
    }

    pub fn radar(&self) -> &'a Radar {
        self.radar
    }

    /// Shape of the grid, `[range bins, directions]`.
    pub fn dim(&self) -> (usize, usize) {
        (self.range_metres.len(), self.directions.len())
    }

    /// The reflector in `cell`, where it is in the grid and a reflector can stand there: not at the array's centre, nor on an element.
    fn reflector(&self, cell: GridCell) -> Option<Reflector> {
        let (range, cos) = (*self.range_metres.get(cell.bin)?, self.directions.get(cell.direction)?.cos_theta);
        let place = Reflector::at([range * cos, range * (1.0 - cos * cos).max(0.0).sqrt()], 1.0);
        (range > 0.0 && touched_element(self.radar, &place).is_none()).then_some(place)
    }

    /// Whether a reflector can stand in `cell`.
    pub fn may_hold(&self, cell: GridCell) -> bool {
        self.reflector(cell).is_some()
    }

    /// The echo of a unit reflector in `cell`; `None` outside the grid, at the centre of the array and on an element.
    pub fn echo(&self, cell: GridCell) -> Option<ArrayEcho> {
        self.reflector(cell)?;
        self.echo_at(self.range_metres[cell.bin], self.directions[cell.direction].cos_theta)
    }

    /// The echo of a unit reflector at a place of the centre's polar grid, where it has one.
    pub fn echo_at(&self, range_metres: f64, cos_theta: f64) -> Option<ArrayEcho> {
        if range_metres <= 0.0 || cos_theta.abs() > 1.0 {
            return None;
        }
        let echo = ArrayEcho::at(self.radar, range_metres, cos_theta).masked(&self.is_measured);
        (echo.norm().is_finite() && echo.norm() > 0.0).then_some(echo)
    }

    /// The map, `[range bins, columns]`, of a power on the grid: directions of the same column are added.
    pub fn folded(&self, power: &Array2<f64>) -> Array2<f64> {
        let mut out = Array2::zeros((self.radar.samples, self.radar.elements));
        for (mut out, power) in out.outer_iter_mut().zip(power.outer_iter()) {
            for (direction, power) in self.directions.iter().zip(power) {
                out[direction.column] += power;
            }
        }
        out
    }
}
