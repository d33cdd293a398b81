//! Interpolation from the network's columns to those of an array of any number of elements.

use super::grid::COLUMNS;
use rayon::prelude::*;

/// The two columns of the network around each column of an array's map. cos(theta) rises with both.
#[derive(Debug)]
pub(super) struct ColumnTaps {
    taps: Vec<Tap>,
}

#[derive(Debug, Clone, Copy)]
struct Tap {
    pair: [usize; 2],
    /// Weight of the second of the pair, 0 to 1.
    part: f32,
}

impl ColumnTaps {
    /// The taps for an array of `elements`; `None` where it has the network's own columns.
    pub(super) fn new(elements: usize) -> Option<Self> {
        let tap = |column: usize| {
            let from_middle = column as f64 - (elements / 2) as f64;
            let place = from_middle * (COLUMNS as f64 / elements as f64) + (COLUMNS / 2) as f64;
            let low = place.floor();
            Tap { pair: [0, 1].map(|beside| (low as usize + beside) % COLUMNS), part: (place - low) as f32 }
        };
        (elements != COLUMNS).then(|| ColumnTaps { taps: (0..elements).map(tap).collect() })
    }

    /// Interpolates one row.
    pub(super) fn fill(&self, source: &[f32; COLUMNS], row: &mut [f32]) {
        for (to, Tap { pair: [low, high], part }) in row.iter_mut().zip(&self.taps) {
            *to = source[*low] * (1.0 - part) + source[*high] * part;
        }
    }

    /// Interpolates all rows, from `[rows, 1024]` to `[rows, elements]`.
    pub(super) fn rows_of(&self, source: &[f32]) -> Vec<f32> {
        let (source, elements) = (source.as_chunks::<COLUMNS>().0, self.taps.len());
        let mut rows = vec![0.0; source.len() * elements];
        rows.par_chunks_mut(elements).zip(source).for_each(|(row, source)| self.fill(source, row));
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_keep_their_direction_for_any_number_of_elements() {
        let cos = |column: usize, columns: usize| (column as f32 - (columns / 2) as f32) / (columns as f32 / 2.0);
        let source: Vec<f32> = (0..COLUMNS).map(|column| cos(column, COLUMNS)).collect();
        for elements in [2, 85, 86, 192, 1000, 1500] {
            let found = ColumnTaps::new(elements).unwrap().rows_of(&source);
            for (column, found) in found.iter().enumerate() {
                let expected = cos(column, elements);
                // Beyond the network's last column the directions wrap around.
                let is_inside = expected <= source[COLUMNS - 1];
                let holds = !is_inside || (found - expected).abs() < 1e-6;
                assert!(holds, "{column} of {elements}: {found} for {expected}");
            }
        }
        assert!(ColumnTaps::new(COLUMNS).is_none());
    }
}
