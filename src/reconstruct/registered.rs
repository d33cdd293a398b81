//! Laying what one end sees onto the polar grid of the array's centre.
//!
//! The ends stand a metre to the left and right of the centre: they see one reflector at ranges up to 27 bins apart.

use crate::radar::Radar;
use ndarray::{Array2, Axis};
use rayon::prelude::*;

/// Where a cell of the centre's grid lies in the polar grid of a point of the array's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    /// Distance in metres.
    pub range_metres: f64,
    /// Cosine of the angle to the array's axis.
    pub cos_theta: f64,
}

/// How a point of the array's axis at `from_x_metres` sees the reflector at (`range_metres`, `cos_theta`) of the centre.
///
/// Columns whose cosine is beyond 1, which exist for element spacings below half a wavelength, count as the axis itself.
pub(super) fn seen_from(from_x_metres: f64, range_metres: f64, cos_theta: f64) -> Seen {
    let x = range_metres * cos_theta.clamp(-1.0, 1.0);
    let square = range_metres * range_metres - 2.0 * x * from_x_metres + from_x_metres * from_x_metres;
    let range = square.max(1e-12).sqrt();
    Seen { range_metres: range, cos_theta: ((x - from_x_metres) / range).clamp(-1.0, 1.0) }
}

/// `map` of an end whose centre is at `centre_x_metres`, `[range bins, columns]` on its own grid, on the grid of the array's
/// centre; bilinear, wrapping as both axes do.
pub(super) fn register(radar: &Radar, centre_x_metres: f64, map: &Array2<f64>) -> Array2<f64> {
    let (bins, columns) = map.dim();
    let mut out = Array2::zeros((bins, columns));
    out.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each(|(bin, mut row)| {
        let range = radar.range_of_bin_metres(bin as f64);
        for (column, cell) in row.iter_mut().enumerate() {
            let seen = seen_from(centre_x_metres, range, radar.cos_of_column(column as f64));
            *cell = bilinear(map, radar.bin_of_range(seen.range_metres), radar.column_of_cos(seen.cos_theta));
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
    fn the_centre_sees_itself_and_the_ends_see_what_geometry_says() {
        let s = seen_from(0.0, 20.0, 0.3);
        assert!((s.range_metres - 20.0).abs() < 1e-12 && (s.cos_theta - 0.3).abs() < 1e-12);
        // From 3 m to the left, a reflector 4 m ahead of the centre is 5 m away.
        let s = seen_from(-3.0, 4.0, 0.0);
        assert!((s.range_metres - 5.0).abs() < 1e-12 && (s.cos_theta - 0.6).abs() < 1e-12);
    }

    #[test]
    fn a_peak_moves_to_where_the_centre_sees_it() {
        let radar = Radar::default();
        let (bin, column) = (200usize, 700usize);
        let centre = 0.98;
        let seen = seen_from(centre, radar.range_of_bin_metres(bin as f64), radar.cos_of_column(column as f64));
        let (row, col) = (radar.bin_of_range(seen.range_metres), radar.column_of_cos(seen.cos_theta));
        let map = Array2::from_shape_fn((512, 1024), |(r, c)| {
            (-((r as f64 - row) / 3.0).powi(2) - ((c as f64 - col) / 3.0).powi(2)).exp()
        });
        let out = register(&radar, centre, &map);
        let (at, _) = out.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        assert!(at.0.abs_diff(bin) <= 1 && at.1.abs_diff(column) <= 1, "{at:?}");
    }
}
