//! Columns between those of a map of few elements, for the eye.

use crate::radar::{MIN_FINE_COLUMNS, Radar};
use ndarray::{Array2, ArrayView2};

const MIN_DRAWN_COLUMNS: usize = 256;

/// `map`, `[range bins, columns]` as [`Radar::left_to_right`] has it, on 256 columns or more, over the directions of the drawn axis. Values between
/// follow the cubic through the four columns around (Catmull and Rom, 1974), not below the least of the map; the last column is followed by the
/// first, as the transform has it. Nothing more is resolved than before. `None` where the map has [`MIN_FINE_COLUMNS`] already, or one.
pub fn finer(radar: &Radar, map: ArrayView2<'_, f32>) -> Option<Array2<f32>> {
    let (rows, columns) = map.dim();
    if !is_few(radar, columns) {
        return None;
    }
    let drawn = columns * MIN_DRAWN_COLUMNS.div_ceil(columns);
    let low = map.iter().copied().fold(f32::INFINITY, f32::min);
    let cell = |(row, column): (usize, usize)| {
        let place = radar.drawn_column_across((column as f64 + 0.5) / drawn as f64);
        let (before, t) = (place.floor(), (place - place.floor()) as f32);
        let at = |by: usize| map[[row, (before as isize + by as isize - 1).rem_euclid(columns as isize) as usize]];
        let [a, b, c, d] = [0, 1, 2, 3].map(at);
        let cubic = b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
        cubic.max(low)
    };
    Some(Array2::from_shape_fn((rows, drawn), cell))
}

/// Cells as they are, from left to right, where the axis has their directions: of few on two columns each, so that the outermost one stands
/// half at either edge. `None` where the map has [`MIN_FINE_COLUMNS`] already, or one.
pub fn in_place<T: Copy>(radar: &Radar, cells: ArrayView2<'_, T>) -> Option<Array2<T>> {
    let (rows, columns) = cells.dim();
    if !is_few(radar, columns) {
        return None;
    }
    let of = |half: usize| radar.drawn_column_across((half as f64 + 0.5) / (2 * columns) as f64).round() as isize;
    let cell = |(row, half): (usize, usize)| cells[[row, of(half).rem_euclid(columns as isize) as usize]];
    Some(Array2::from_shape_fn((rows, 2 * columns), cell))
}

/// Whether a map is the radar's, and of few columns.
fn is_few(radar: &Radar, columns: usize) -> bool {
    columns == radar.elements && (2..MIN_FINE_COLUMNS).contains(&columns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Convention;
    use std::f32::consts::TAU;

    fn radar(elements: usize) -> Radar {
        Radar { elements, end_elements: 1, ..Radar::default() }
    }

    #[test]
    fn a_maximum_between_two_columns_stands_there() {
        let lobe = |place: f32| 0.5 + 0.5 * (TAU * (place - 2.4) / 8.0).cos();
        let (radar, map) = (radar(8), Array2::from_shape_fn((3, 8), |(_, column)| lobe(column as f32)));
        let fine = finer(&radar, map.view()).unwrap();
        assert_eq!(fine.dim(), (3, 256));
        let best = (0..256).max_by(|a, b| fine[[1, *a]].total_cmp(&fine[[1, *b]])).unwrap();
        assert!(((best as f32 + 0.5) / 32.0 - 2.4).abs() < 0.3, "{best}");
        let worst = (0..256).map(|n| (fine[[0, n]] - lobe((n as f32 + 0.5) / 32.0)).abs()).fold(0.0, f32::max);
        assert!(worst < 0.05, "{worst}");
    }

    #[test]
    fn columns_enough_or_one_stay_as_they_are() {
        let of = |elements: usize| finer(&radar(elements), Array2::zeros((4, elements)).view());
        assert_eq!((of(128), of(1)), (None, None));
        assert_eq!(of(127).unwrap().dim(), (4, 381));
    }

    #[test]
    fn an_echo_far_to_a_side_is_drawn_at_its_cosine() {
        for (convention, elements) in Convention::ALL.into_iter().flat_map(|c| [4, 5, 8].map(|n| (c, n))) {
            let radar = radar(elements).in_convention(convention);
            for cos in [-0.9, 0.9, 0.1] {
                let off = |column: usize| (radar.column_of_cos(cos) - column as f64) * TAU as f64 / elements as f64;
                let map = Array2::from_shape_fn((1, elements), |(_, column)| 0.5 + 0.5 * off(column).cos() as f32);
                let drawn = radar.left_to_right(&map);
                let peak = |cells: Array2<f32>| {
                    let best = cells.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
                    let across = (best as f64 + 0.5) / cells.len() as f64;
                    radar.cos_of_column(radar.column_across(across)) - cos
                };
                let (fine, coarse) = (peak(finer(&radar, drawn).unwrap()), peak(in_place(&radar, drawn).unwrap()));
                assert!(fine.abs() < 0.06, "{convention:?}, {elements} elements, {cos}: {fine}");
                // The cell at end-fire is one half on either edge.
                let coarse = coarse.abs().min((coarse.abs() - 2.0).abs());
                assert!(coarse <= 1.0 / elements as f64 + 0.1, "cells of {elements} elements, {cos}: {coarse}");
            }
        }
    }
}
