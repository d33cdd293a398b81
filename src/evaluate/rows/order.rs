//! Rows of several runs as those of one, in any order, and figures of their columns.

use super::{Column, Row, Value};
use crate::evaluate::Estimate;
use std::collections::BTreeMap;

/// Two rows of the same scene by the same method.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "scene {index} of set {set}, seed {seed}, by {method} stands in {first} and in {second}; expected each row once"
)]
pub struct Twice {
    set: String,
    index: u32,
    seed: u64,
    method: String,
    first: String,
    second: String,
}

/// Joins tables, each with its name, as if all had been made in one run: sorted by set, seed and scene, methods in the order they come.
///
/// # Errors
/// [`Twice`] when a row stands in two tables or twice in one.
pub fn merge(tables: Vec<(String, Vec<Row>)>) -> Result<Vec<Row>, Twice> {
    let mut orders = [BTreeMap::new(), BTreeMap::new()];
    let mut all: Vec<(usize, Row)> = Vec::new();
    let mut names = Vec::new();
    for (table, (name, rows)) in tables.into_iter().enumerate() {
        names.push(name);
        for row in rows {
            for (order, key) in orders.iter_mut().zip([&row.set, &row.method]) {
                let next = order.len();
                order.entry(key.clone()).or_insert(next);
            }
            all.push((table, row));
        }
    }
    let [sets, methods] = orders;
    let place = |set: &String| (set.parse::<u32>().unwrap_or(u32::MAX), sets[set]);
    all.sort_by_cached_key(|(_, r)| (place(&r.set), r.seed, r.index, methods[&r.method]));
    let key = |row: &Row| (row.set.clone(), row.seed, row.index, row.method.clone());
    if let Some([(first, row), (second, _)]) = all.array_windows().find(|[(_, a), (_, b)]| key(a) == key(b)) {
        let Row { set, index, seed, method, .. } = row.clone();
        let [first, second] = [first, second].map(|t| names[*t].clone());
        return Err(Twice { set, index, seed, method, first, second });
    }
    Ok(all.into_iter().map(|(_, row)| row).collect())
}

/// Indices of `rows`, sorted by a column; rows without a figure come last either way. Equal ones stay in order.
pub fn sorted_by(rows: &[Row], column: Column, descending: bool) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..rows.len()).collect();
    indices.sort_by(|&a, &b| {
        let order = match (column.of(&rows[a]), column.of(&rows[b])) {
            (Value::Number(a), Value::Number(b)) => a.total_cmp(&b),
            (Value::Text(a), Value::Text(b)) => a.cmp(b),
            (Value::Number(_), Value::Text(_)) => std::cmp::Ordering::Less,
            (Value::Text(_), Value::Number(_)) => std::cmp::Ordering::Greater,
            // Whatever the direction.
            (a, b) => return (a == Value::Missing).cmp(&(b == Value::Missing)),
        };
        if descending { order.reverse() } else { order }
    });
    indices
}

/// How often the figures of a column fall into each of `counts.len()` equal parts between the smallest and the largest.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Where the first part begins.
    pub low: f64,
    /// Where the last part ends.
    pub high: f64,
    /// Figures in each part.
    pub counts: Vec<usize>,
}

impl Histogram {
    /// The histogram of the numbers of a column over `rows`, in `parts` parts; `None` where there is no number.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>, column: Column, parts: usize) -> Option<Histogram> {
        let numbers: Vec<f64> = rows
            .into_iter()
            .filter_map(|row| match column.of(row) {
                Value::Number(v) => Some(v),
                _ => None,
            })
            .collect();
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
    let number = |row: &'a Row| match column.of(row) {
        Value::Number(v) => Some(v),
        _ => None,
    };
    Estimate::of(&rows.into_iter().filter_map(number).collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::super::tests::row;
    use super::*;

    #[test]
    fn tables_are_merged_in_the_order_of_one_run() {
        let all: Vec<Row> = ["1", "2", "walls"]
            .into_iter()
            .flat_map(|set| (0..4).flat_map(move |i| ["nomp", "live"].map(|m| row(set, i, m))))
            .collect();
        let shard = |n: u32| all.iter().filter(|r| r.index % 2 == n).cloned().collect::<Vec<_>>();
        let merged = merge(vec![("b".into(), shard(1)), ("a".into(), shard(0))]).unwrap();
        assert_eq!(merged, all);
        let twice = merge(vec![("a".into(), shard(0)), ("b".into(), shard(0))]).unwrap_err().to_string();
        assert!(twice.contains("scene 0 of set 1") && twice.contains("in a and in b"), "{twice}");
    }

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
