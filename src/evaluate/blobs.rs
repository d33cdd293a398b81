//! Connected regions of a map above a threshold.

use crate::maps::{Mask, RangeAngleMap};
use crate::radar::Radar;
use ndarray::Array2;

/// Largest distance of a blob from the place it is searched at: range bins, and as a divisor of the number of columns.
const MAX_BLOB_DISTANCE_BINS: usize = 8;
const BLOB_DISTANCE_DIVISOR: usize = 48;

/// Regions of touching cells: 8 neighbours, columns wrap around as angles do.
#[derive(Debug, Clone, PartialEq)]
pub struct Blobs {
    /// Number of the blob of each cell, from 1; 0 outside all blobs. `[range bins, columns]`.
    pub labels: Array2<u32>,
    /// Cells (range bin, column) of every blob, blob 1 first.
    pub cells: Vec<Vec<[usize; 2]>>,
}

impl Blobs {
    /// The blobs of a mask.
    pub fn of(mask: &Mask) -> Blobs {
        let (rows, columns) = mask.cells.dim();
        let mut labels = Array2::zeros((rows, columns));
        let mut cells: Vec<Vec<[usize; 2]>> = Vec::new();
        for (start, _) in mask.cells.indexed_iter().filter(|(_, set)| **set) {
            if labels[start] != 0 {
                continue;
            }
            let label = cells.len() as u32 + 1;
            labels[start] = label;
            let mut blob = vec![[start.0, start.1]];
            let mut next = 0;
            while let Some(&[row, column]) = blob.get(next) {
                next += 1;
                for r in row.saturating_sub(1)..(row + 2).min(rows) {
                    for c in [(column + columns - 1) % columns, column, (column + 1) % columns] {
                        if mask.cells[[r, c]] && labels[[r, c]] == 0 {
                            labels[[r, c]] = label;
                            blob.push([r, c]);
                        }
                    }
                }
            }
            cells.push(blob);
        }
        Blobs { labels, cells }
    }

    /// The blob that covers most of `cells`; `None` where no blob covers any.
    pub fn most_of(&self, cells: &[[usize; 2]]) -> Option<u32> {
        let mut counts = std::collections::BTreeMap::new();
        for label in cells.iter().map(|&at| self.labels[at]).filter(|l| *l != 0) {
            *counts.entry(label).or_insert(0usize) += 1;
        }
        counts.into_iter().max_by_key(|(_, count)| *count).map(|(label, _)| label)
    }
}

/// The dip of Lambda between the blobs of two places in metres, below the weaker blob; 0 where the map shows one blob.
/// Each blob is the brightest cell near the place, on its own side of the middle between both.
pub fn dip_between(radar: &Radar, map: &RangeAngleMap, places_metres: [[f64; 2]; 2]) -> f32 {
    let (rows, columns) = map.lambda.dim();
    let [a, b] = places_metres.map(|[x_metres, y_metres]| {
        let blob = radar.blob_of(0.0, x_metres, y_metres);
        let bin = radar.bin_of_range(blob.range_metres).rem_euclid(rows as f64);
        [(bin.round() as usize).min(rows - 1), (radar.column_of_cos(blob.cos_theta).round() as usize).min(columns - 1)]
    });
    let reach = (a[1].abs_diff(b[1]).saturating_sub(1) / 2).min(columns / BLOB_DISTANCE_DIVISOR);
    let [a, b] = [a, b].map(|at| brightest_near(map, at, [MAX_BLOB_DISTANCE_BINS, reach]));
    let steps = a[0].abs_diff(b[0]).max(a[1].abs_diff(b[1])).max(1);
    let between = (0..=steps).map(|step| {
        let at = |axis: usize| {
            let (from, to) = (a[axis] as f64, b[axis] as f64);
            (from + (to - from) * step as f64 / steps as f64).round() as usize
        };
        map.lambda[[at(0), at(1)]]
    });
    map.lambda[a].min(map.lambda[b]) - between.fold(f32::INFINITY, f32::min)
}

fn brightest_near(map: &RangeAngleMap, [bin, column]: [usize; 2], reach: [usize; 2]) -> [usize; 2] {
    let (rows, columns) = map.lambda.dim();
    let bins = bin.saturating_sub(reach[0])..(bin + reach[0] + 1).min(rows);
    let across = column.saturating_sub(reach[1])..(column + reach[1] + 1).min(columns);
    let cells = bins.flat_map(|bin| across.clone().map(move |column| [bin, column]));
    cells.max_by(|a, b| map.lambda[*a].total_cmp(&map.lambda[*b])).unwrap_or([bin, column])
}

/// Number of blobs whose Lambda exceeds `eta`.
pub fn blobs(map: &RangeAngleMap, eta: f32) -> usize {
    Blobs::of(&map.above(eta)).cells.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn blobs_touch_around_the_edge() {
        let map = RangeAngleMap {
            lambda: array![[1.0f32, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 1.0, 0.0]],
        };
        assert_eq!((blobs(&map, 0.5), blobs(&map, 1.0)), (2, 0));
        let found = Blobs::of(&map.above(0.5));
        assert_eq!(found.labels[[0, 0]], found.labels[[1, 1]]);
        assert_eq!(found.most_of(&[[3, 1], [3, 2], [0, 0], [2, 2]]), Some(found.labels[[3, 1]]));
        assert_eq!(found.most_of(&[[2, 2]]), None);
    }
}
