//! Combination of the ends' maps on the polar grid of the array's centre.

use crate::radar::{End, Radar};
use crate::reconstruct::polar::{Direction, directions, polar_from, row_ranges_metres};
use ndarray::{Array2, Axis};
use rayon::prelude::*;

/// The geometric mean of both ends' maps on the grid of the array's centre. `maps` are `[range bins, columns]`, each on its end's own grid, and
/// are looked up (bilinear, both axes wrapping) at each cell's place for the end.
///
/// A column of several directions gets the sum over them: the ranges of a reflector at the ends distinguish its direction from the others, so
/// that only one of them has power at both ends.
pub(super) fn joined(radar: &Radar, maps: &[Array2<f64>; 2]) -> Array2<f64> {
    let directions = directions(radar);
    let ranges = row_ranges_metres(radar);
    let centres = End::BOTH.map(|end| radar.end_centre_metres(end));
    let mut out = Array2::zeros((radar.samples, radar.elements));
    out.axis_iter_mut(Axis(0)).into_par_iter().zip(&ranges).for_each(|(mut row, range)| {
        for Direction { cos_theta, column } in &directions {
            let [first, last] = [0, 1].map(|end| {
                let seen = polar_from(centres[end], *range, *cos_theta);
                let place = (radar.bin_of_range(seen.range_metres), radar.column_of_cos(seen.cos_theta));
                bilinear(&maps[end], place.0, place.1)
            });
            row[*column] += (first * last).sqrt();
        }
    });
    out
}

fn bilinear(map: &Array2<f64>, row: f64, column: f64) -> f64 {
    let (rows, columns) = map.dim();
    let (r, c) = (row.floor(), column.floor());
    let (fr, fc) = (row - r, column - c);
    let (r, c) = (r as usize % rows, c as usize % columns);
    let (next_r, next_c) = ((r + 1) % rows, (c + 1) % columns);
    let near = map[[r, c]] * (1.0 - fc) + map[[r, next_c]] * fc;
    let far = map[[next_r, c]] * (1.0 - fc) + map[[next_r, next_c]] * fc;
    near * (1.0 - fr) + far * fr
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_moves_to_where_the_centre_sees_it() {
        let radar = Radar::default();
        let (bin, column) = (200usize, 700usize);
        let maps = End::BOTH.map(|end| {
            let (range, cos) = (radar.range_of_bin_metres(bin as f64), radar.cos_of_column(column as f64));
            let seen = polar_from(radar.end_centre_metres(end), range, cos);
            let (row, col) = (radar.bin_of_range(seen.range_metres), radar.column_of_cos(seen.cos_theta));
            assert!((row - bin as f64).abs() > 3.0, "the ends see it elsewhere");
            Array2::from_shape_fn((512, 1024), |(r, c)| {
                (-((r as f64 - row) / 3.0).powi(2) - ((c as f64 - col) / 3.0).powi(2)).exp()
            })
        });
        let out = joined(&radar, &maps);
        let (at, _) = out.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert!(at.0.abs_diff(bin) <= 1 && at.1.abs_diff(column) <= 1, "{at:?}");
    }
}
