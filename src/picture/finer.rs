//! Columns between those of a map of few elements, for the eye.

use ndarray::{Array2, ArrayView2};

/// A map of so many columns is fine enough for the eye; one of fewer is drawn on 256 at least.
pub const FEW_COLUMNS: usize = 128;
const MIN_DRAWN_COLUMNS: usize = 256;

/// `map`, `[range bins, columns]`, on 256 columns or more: each column stands for as many, which take its place evenly. Values between
/// follow the cubic through the four columns around (Catmull and Rom, 1974), not below the least of the map; the last column is followed by the
/// first, as the transform has it. Nothing more is resolved than before. `None` where the map has [`FEW_COLUMNS`] already, or one.
pub fn finer(map: ArrayView2<'_, f32>) -> Option<Array2<f32>> {
    let (rows, columns) = map.dim();
    let times = MIN_DRAWN_COLUMNS.div_ceil(columns.max(1));
    if !(2..FEW_COLUMNS).contains(&columns) {
        return None;
    }
    let low = map.iter().copied().fold(f32::INFINITY, f32::min);
    let cell = |(row, column): (usize, usize)| {
        let place = (column as f32 + 0.5) / times as f32 - 0.5;
        let (before, t) = (place.floor(), place - place.floor());
        let at = |by: usize| map[[row, (before as isize + by as isize - 1).rem_euclid(columns as isize) as usize]];
        let [a, b, c, d] = [0, 1, 2, 3].map(at);
        let cubic = b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
        cubic.max(low)
    };
    Some(Array2::from_shape_fn((rows, columns * times), cell))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::TAU;

    #[test]
    fn a_maximum_between_two_columns_stands_there() {
        let lobe = |place: f32| 0.5 + 0.5 * (TAU * (place - 2.4) / 8.0).cos();
        let map = Array2::from_shape_fn((3, 8), |(_, column)| lobe(column as f32));
        let fine = finer(map.view()).unwrap();
        assert_eq!(fine.dim(), (3, 256));
        let best = (0..256).max_by(|a, b| fine[[1, *a]].total_cmp(&fine[[1, *b]])).unwrap();
        assert!(((best as f32 + 0.5) / 32.0 - 0.5 - 2.4).abs() < 0.3, "{best}");
        let worst = (0..256).map(|n| (fine[[0, n]] - lobe((n as f32 + 0.5) / 32.0 - 0.5)).abs()).fold(0.0, f32::max);
        assert!(worst < 0.05, "{worst}");
    }

    #[test]
    fn columns_enough_or_one_stay_as_they_are() {
        assert_eq!(finer(Array2::zeros((4, 128)).view()), None);
        assert_eq!(finer(Array2::zeros((4, 1)).view()), None);
        assert_eq!(finer(Array2::zeros((4, 127)).view()).unwrap().dim(), (4, 381));
    }
}
