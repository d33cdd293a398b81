//! The horizontal place of a column in a drawn map: left in the scene is left in every picture, in any convention.
//!
//! Arrays and archives have columns in the order of the transform: cos(theta) rises with the column for the one-way carrier and falls for
//! the two-way carrier. Drawing reverses the second order. Of N elements, N even, the columns are `-N/2` to `N/2 - 1`: a map of few is drawn with
//! half of column 0 at either edge, since both edges are one direction. So its axis is even about straight ahead.

use super::Radar;
use ndarray::{Array2, ArrayView2, Axis};

/// Number of columns from which a map is fine enough for the eye, and half a column is neglected.
pub const MIN_FINE_COLUMNS: usize = 128;

impl Radar {
    /// Distance of the middle of column 0 from the map's edge, columns.
    fn middle_of_first_column(&self) -> f64 {
        let is_halved = self.elements < MIN_FINE_COLUMNS && self.elements.is_multiple_of(2);
        if is_halved { 0.0 } else { 0.5 }
    }

    /// Whether cos(theta) falls from column to column: column 0 is then the rightmost one of a drawn map.
    pub fn columns_fall(&self) -> bool {
        self.carrier.turns_per_wavelength() > 0.0
    }

    /// Place of the middle of column `k2` (fractional) as a fraction of the map's width from its left edge; columns wrap around.
    pub fn across_of_column(&self, k2: f64) -> f64 {
        let from_first = (k2 + self.middle_of_first_column()) / self.elements as f64;
        (if self.columns_fall() { 1.0 - from_first } else { from_first }).rem_euclid(1.0)
    }

    /// The column (fractional) at a fraction of the map's width from its left edge: the inverse of [`Radar::across_of_column`].
    pub fn column_across(&self, across: f64) -> f64 {
        let from_first = if self.columns_fall() { 1.0 - across } else { across };
        from_first * self.elements as f64 - self.middle_of_first_column()
    }

    /// [`Radar::column_across`] among the columns of [`Radar::left_to_right`].
    pub fn drawn_column_across(&self, across: f64) -> f64 {
        let column = self.column_across(across);
        if self.columns_fall() { self.elements as f64 - 1.0 - column } else { column }
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
            let radar = Radar { elements: 256, ..Radar::default() }.in_convention(convention);
            let cos = |across: f64| radar.cos_of_column(radar.column_across(across));
            assert!(cos(0.0) < -0.9 && cos(0.25) < cos(0.75) && cos(1.0) > 0.9, "{convention:?}");
            assert!((radar.column_across(radar.across_of_column(12.3)) - 12.3).abs() < 1e-9);
            let columns = Array2::from_shape_fn((1, 256), |(_, column)| column);
            for (at, column) in radar.left_to_right(&columns).iter().enumerate() {
                let across = (at as f64 + 0.5) / 256.0;
                assert!((radar.column_across(across) - *column as f64).abs() < 1e-9, "{convention:?}, column {column}");
            }
        }
    }

    #[test]
    fn the_axis_of_few_columns_is_even_about_straight_ahead() {
        for (convention, elements) in Convention::ALL.into_iter().flat_map(|c| [2, 4, 5, 8, 127].map(|n| (c, n))) {
            let radar = Radar { elements, ..Radar::default() }.in_convention(convention);
            let cos = |across: f64| radar.cos_of_column(radar.column_across(across));
            let half = radar.cos_of_column(0.0).abs() / (elements / 2) as f64 * elements as f64 / 2.0;
            assert!((cos(0.0) + half).abs() < 1e-9 && (cos(1.0) - half).abs() < 1e-9, "{convention:?}: {elements}");
            assert!(radar.across_of_column(elements as f64 - 0.1) < 1.0);
        }
    }
}
