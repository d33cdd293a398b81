//! Connected regions of a map above a threshold.

use crate::maps::{Mask, RangeAngleMap};
use ndarray::Array2;

/// Regions of touching cells: 8 neighbours, columns wrap around as angles do.
#[derive(Debug, Clone, PartialEq)]
pub struct Blobs {
    /// Which blob a cell belongs to, counted from 1; 0 outside all. `[range bins, columns]`.
    pub labels: Array2<u32>,
    /// Cells of every blob: blob 1 first.
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

    /// The blob that covers most of `cells`, if any does.
    pub fn most_of(&self, cells: &[[usize; 2]]) -> Option<u32> {
        let mut counts = std::collections::BTreeMap::new();
        for label in cells.iter().map(|&at| self.labels[at]).filter(|l| *l != 0) {
            *counts.entry(label).or_insert(0usize) += 1;
        }
        counts.into_iter().max_by_key(|(_, count)| *count).map(|(label, _)| label)
    }
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
        assert_eq!(blobs(&map, 0.5), 2);
        assert_eq!(blobs(&map, 1.0), 0);
        let found = Blobs::of(&map.above(0.5));
        assert_eq!(found.labels[[0, 0]], found.labels[[1, 1]]);
        assert_eq!(found.most_of(&[[3, 1], [3, 2], [0, 0], [2, 2]]), Some(found.labels[[3, 1]]));
        assert_eq!(found.most_of(&[[2, 2]]), None);
    }
}
