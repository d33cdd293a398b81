//! Sorting of rows by a column, and figures of a column.

use super::{Column, Row, Value};
use crate::evaluate::Estimate;

/// Indices of `rows`, sorted by a column; rows without a figure come last in both directions. Equal rows stay in order.
pub fn sorted_by(rows: &[Row], column: Column, descending: bool) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..rows.len()).collect();
    indices.sort_by(|&a, &b| {
        let order = match (column.of(&rows[a]), column.of(&rows[b])) {
            (Value::Number(a), Value::Number(b)) => a.total_cmp(&b),
            (Value::Text(a), Value::Text(b)) => a.cmp(&b),
            (Value::Number(_), Value::Text(_)) => std::cmp::Ordering::Less,
            (Value::Text(_), Value::Number(_)) => std::cmp::Ordering::Greater,
            (a, b) => return (a == Value::Missing).cmp(&(b == Value::Missing)),
        };
        if descending { order.reverse() } else { order }
    });
    indices
}

/// Numbers of figures of a column in each of `counts.len()` equal parts between the smallest and the largest.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Lower limit of the first part.
    pub low: f64,
    /// Upper limit of the last part.
    pub high: f64,
    /// Figures in each part.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// The histogram of the numbers of a column over `rows`, in `parts` parts; `None` where there is no number.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>, column: Column, parts: usize) -> Option<Histogram> {
        let numbers: Vec<f64> = rows.into_iter().filter_map(|row| column.of(row).number()).collect();
        let (low, high) = numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        if numbers.is_empty() || parts == 0 {
            return None;
        }
        let mut counts = vec![0; parts];
        for v in numbers {
            let part = if high > low { (v - low) / (high - low) * parts as f64 } else { 0.0 };
            counts[(part as usize).min(parts - 1)] += 1;
        }
        Some(Histogram { low, high, counts })
    }
}

/// Mean and standard error of a column over the rows that have a number there; NaN for none.
pub fn estimate<'a>(rows: impl IntoIterator<Item = &'a Row>, column: Column) -> Estimate {
    Estimate::of(&rows.into_iter().filter_map(|row| column.of(row).number()).collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::super::tests::row;
    use super::*;

    #[test]
    fn rows_are_sorted_with_missing_figures_last() {
        let mut rows = vec![row("1", 2, "a"), row("1", 0, "b"), row("1", 1, "c")];
        rows[0].detection = None;
        rows[1].detection = Some(0.5);
        rows[2].detection = Some(0.7);
        assert_eq!(sorted_by(&rows, Column::Detection, false), [1, 2, 0]);
        assert_eq!(sorted_by(&rows, Column::Detection, true), [2, 1, 0]);
        assert_eq!(sorted_by(&rows, Column::Method, true), [2, 1, 0]);
        assert_eq!(estimate(&rows, Column::Detection).mean, 0.6);
    }

    #[test]
    fn a_histogram_counts_every_number_once() {
        let rows: Vec<Row> = (0..11).map(|i| row("1", i, "live")).collect();
        let histogram = Histogram::of(&rows, Column::Index, 5).unwrap();
        assert_eq!((histogram.low, histogram.high, histogram.counts), (0.0, 10.0, vec![2, 2, 2, 2, 3]));
        assert_eq!(Histogram::of(&rows[..1], Column::Index, 3).unwrap().counts, [1, 0, 0]);
        assert_eq!(Histogram::of(&rows, Column::Method, 3), None);
    }
}
