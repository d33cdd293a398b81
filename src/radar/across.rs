//! The horizontal place of a column in a drawn map: left in the scene is left in every picture, in any convention.
//!
//! Arrays and archives have columns in the order of the transform: cos(theta) rises with the column for the one-way carrier and falls for
//! the two-way carrier. Drawing reverses the second order.

use super::Radar;
use ndarray::{Array2, ArrayView2, Axis};

impl Radar {
    /// Whether cos(theta) falls from column to column: column 0 is then the rightmost one of a drawn map.
    pub fn columns_fall(&self) -> bool {
        self.carrier.turns_per_wavelength() > 0.0
    }

    /// Horizontal place of the middle of column `k2` (fractional), as a fraction of the map's width from its left edge.
    pub fn across_of_column(&self, k2: f64) -> f64 {
        let from_first = (k2 + 0.5) / self.elements as f64;
        if self.columns_fall() { 1.0 - from_first } else { from_first }
    }

    /// The column (fractional) at a fraction of the map's width from its left edge: the inverse of [`Radar::across_of_column`].
    pub fn column_across(&self, across: f64) -> f64 {
        let from_first = if self.columns_fall() { 1.0 - across } else { across };
        from_first * self.elements as f64 - 0.5
    }

    /// Cells of a map, `[range bins, columns]`, with cos(theta) rising from column to column.
    pub fn left_to_right<'a, T>(&self, cells: &'a Array2<T>) -> ArrayView2<'a, T> {
        let mut drawn = cells.view();
        if self.columns_fall() {
            drawn.invert_axis(Axis(1));
        }
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Convention;

    #[test]
    fn directions_are_drawn_from_left_to_right() {
        for convention in Convention::ALL {
            let radar = Radar { elements: 64, ..Radar::default() }.in_convention(convention);
            let cos = |across: f64| radar.cos_of_column(radar.column_across(across));
            assert!(cos(0.0) < -0.9 && cos(0.25) < cos(0.75) && cos(1.0) > 0.9, "{convention:?}");
            assert!((radar.column_across(radar.across_of_column(12.3)) - 12.3).abs() < 1e-9);
            let columns = Array2::from_shape_fn((1, 64), |(_, column)| column);
            for (at, column) in radar.left_to_right(&columns).iter().enumerate() {
                let across = (at as f64 + 0.5) / 64.0;
                assert!((radar.column_across(across) - *column as f64).abs() < 1e-9, "{convention:?}, column {column}");
            }
        }
    }
}
