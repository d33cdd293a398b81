//! Projection of a range-angle map onto the scene's Cartesian coordinates (thesis figure 2-12).

use super::RangeAngleMap;
use crate::radar::Radar;
use ndarray::Array2;
use rayon::prelude::*;

/// A map over x (columns, from -max range to +max range) and y (rows, from 0 to max range).
#[derive(Debug, Clone, PartialEq)]
pub struct CartesianMap {
    /// Lambda, `[rows, columns]`; NaN beyond the maximum range, where the radar sees nothing.
    pub lambda: Array2<f32>,
    /// Half the width, and the height, in metres.
    pub extent_metres: f64,
}

/// The bilinear interpolation of a pixel: the first of four cells, and the weights of the next bin and the next column.
#[derive(Debug, Clone, Copy)]
struct Tap {
    bin: u32,
    column: u32,
    bin_part: f32,
    column_part: f32,
}

/// A projection prepared for many maps of one radar.
#[derive(Debug, Clone)]
pub struct Projector {
    radar: Radar,
    rows: usize,
    /// `None` beyond the maximum range.
    taps: Vec<Option<Tap>>,
}

impl Projector {
    /// A projection onto `rows` by `2 * rows` pixels.
    pub fn new(radar: &Radar, rows: usize) -> Self {
        let extent = radar.max_range_metres();
        let pixel = extent / rows.max(1) as f64;
        let tap = |i: usize, j: usize| {
            let (x, y) = ((j as f64 + 0.5) * pixel - extent, (i as f64 + 0.5) * pixel);
            let polar = radar.polar_of(x, y);
            let bin = radar.bin_of_range(polar.range_metres);
            let column = radar.column_of_cos(polar.cos_theta);
            let [bin_part, column_part] = [bin, column].map(|at| at.fract() as f32);
            let tap = Tap { bin: bin as u32, column: column as u32, bin_part, column_part };
            (bin <= radar.samples as f64 - 1.0).then_some(tap)
        };
        let taps = (0..rows).flat_map(|i| (0..2 * rows).map(move |j| (i, j))).map(|(i, j)| tap(i, j)).collect();
        Projector { radar: radar.clone(), rows, taps }
    }

    pub fn fits(&self, radar: &Radar, rows: usize) -> bool {
        self.rows == rows && self.radar == *radar
    }

    /// Projects `map`, `[samples, elements]` of the radar, bilinear in range and cos(theta).
    pub fn project(&self, map: &RangeAngleMap) -> CartesianMap {
        let (bins, columns) = map.lambda.dim();
        let cells = &map.lambda;
        let value = |tap: &Option<Tap>| {
            let Some(tap) = tap else { return f32::NAN };
            let (b, c) = ((tap.bin as usize).min(bins - 1), tap.column as usize % columns);
            let (next_b, next_c) = ((b + 1).min(bins - 1), if c + 1 == columns { 0 } else { c + 1 });
            let near = cells[[b, c]] * (1.0 - tap.column_part) + cells[[b, next_c]] * tap.column_part;
            let far = cells[[next_b, c]] * (1.0 - tap.column_part) + cells[[next_b, next_c]] * tap.column_part;
            near * (1.0 - tap.bin_part) + far * tap.bin_part
        };
        let pixels: Vec<f32> = self.taps.par_iter().map(value).collect();
        let lambda = Array2::from_shape_vec((self.rows, 2 * self.rows), pixels).unwrap_or_default();
        CartesianMap { lambda, extent_metres: self.radar.max_range_metres() }
    }
}

/// Projects one `map` onto `rows` by `2 * rows` pixels, bilinear in range and cos(theta).
pub fn project(radar: &Radar, map: &RangeAngleMap, rows: usize) -> CartesianMap {
    Projector::new(radar, rows).project(map)
}

/// The range-angle map `[samples, elements]` of `radar` from a Cartesian picture `[rows, 2 * rows]`: every cell has the value of the pixel at its place.
pub fn to_polar(radar: &Radar, cartesian: &Array2<f32>) -> Array2<f32> {
    let (rows, columns) = cartesian.dim();
    let pixel_metres = radar.max_range_metres() / rows.max(1) as f64;
    Array2::from_shape_fn((radar.samples, radar.elements), |(bin, column)| {
        let range = radar.range_of_bin_metres(bin as f64);
        let cos = radar.cos_of_column(column as f64).clamp(-1.0, 1.0);
        let (x, y) = (range * cos, range * (1.0 - cos * cos).sqrt());
        let row = ((y / pixel_metres) as usize).min(rows.saturating_sub(1));
        let across = ((x + radar.max_range_metres()) / pixel_metres).max(0.0) as usize;
        cartesian.get((row, across.min(columns.saturating_sub(1)))).copied().unwrap_or(f32::NAN)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_projected_map_comes_back_from_its_picture() {
        let radar = Radar { samples: 64, elements: 32, end_elements: 4, ..Radar::default() };
        let lambda = Array2::from_shape_fn((64, 32), |(bin, column)| (bin as f32 + column as f32) / 96.0);
        let back = to_polar(&radar, &project(&radar, &RangeAngleMap { lambda: lambda.clone() }, 512).lambda);
        for ((bin, column), expected) in lambda.indexed_iter() {
            // The last row and the end-fire columns lie at the edge of the picture.
            if (1..63).contains(&bin) && (2..31).contains(&column) {
                let found = back[[bin, column]];
                assert!((found - expected).abs() < 0.03, "bin {bin}, column {column}: {found} for {expected}");
            }
        }
        assert!(to_polar(&radar, &Array2::zeros((0, 0))).iter().all(|v| v.is_nan()));
    }

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
