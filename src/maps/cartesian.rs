//! Projection of a range-angle map onto the scene's Cartesian coordinates (thesis figure 2-12).

use super::RangeAngleMap;
use crate::radar::Radar;
use ndarray::Array2;

/// A map over x (columns, from -max range to +max range) and y (rows, from 0 to max range).
#[derive(Debug, Clone, PartialEq)]
pub struct CartesianMap {
    /// Lambda, `[rows, columns]`; NaN beyond the maximum range, where the radar sees nothing.
    pub lambda: Array2<f32>,
    /// Half the width, and the height, in metres.
    pub extent_metres: f64,
}

/// Projects `map` onto `rows` by `2 * rows` pixels, bilinear in range and cos(theta).
pub fn project(radar: &Radar, map: &RangeAngleMap, rows: usize) -> CartesianMap {
    let extent_metres = radar.max_range_metres();
    let pixel = extent_metres / rows.max(1) as f64;
    let (bins, columns) = map.lambda.dim();
    let lambda = Array2::from_shape_fn((rows, 2 * rows), |(i, j)| {
        let (x, y) = ((j as f64 + 0.5) * pixel - extent_metres, (i as f64 + 0.5) * pixel);
        let polar = radar.polar_of(x, y);
        let bin = radar.bin_of_range(polar.range_metres);
        if bin > bins as f64 - 1.0 {
            return f32::NAN;
        }
        let column = radar.column_of_cos(polar.cos_theta);
        let (b, c) = (bin.floor(), column.floor());
        let (fb, fc) = ((bin - b) as f32, (column - c) as f32);
        let at = |b: usize, c: usize| map.lambda[[b.min(bins - 1), c % columns]];
        let (b, c) = (b as usize, c as usize);
        let near = at(b, c) * (1.0 - fc) + at(b, c + 1) * fc;
        let far = at(b + 1, c) * (1.0 - fc) + at(b + 1, c + 1) * fc;
        near * (1.0 - fb) + far * fb
    });
    CartesianMap { lambda, extent_metres }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bright_cell_lands_at_its_place() {
        let radar = Radar::default();
        let mut lambda = Array2::zeros((512, 1024));
        lambda[[200, 768]] = 1.0f32;
        let c = project(&radar, &RangeAngleMap { lambda }, 512);
        let peak = c.lambda.indexed_iter().filter(|(_, v)| v.is_finite()).max_by(|a, b| a.1.total_cmp(b.1));
        let ((i, j), _) = peak.unwrap();
        let pixel = c.extent_metres / 512.0;
        let (x, y) = ((j as f64 + 0.5) * pixel - c.extent_metres, (i as f64 + 0.5) * pixel);
        let r = radar.range_of_bin_metres(200.0);
        assert!((x - 0.5 * r).abs() < 0.15 && (y - r * 0.75f64.sqrt()).abs() < 0.15, "{x} {y}");
        assert!(c.lambda[[511, 0]].is_nan(), "the corner is out of range");
    }
}
