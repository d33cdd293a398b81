//! Rows of several runs as those of one, in any order, and figures of their columns.

use super::origin::Origin;
use super::part::Part;
use super::{Column, Row, Value};
use crate::evaluate::Estimate;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Why rows are no table of one run.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    /// Two rows of the same scene by the same method.
    #[error("{row} stands in {first} and in {second}; expected each row once")]
    Twice {
        /// Which row.
        row: String,
        /// The one table.
        first: String,
        /// The other.
        second: String,
    },
    /// Two rows that were made otherwise.
    #[error(
        "{what} is {} in {first} ({first_row}) and {} in {second} ({second_row}); expected rows that were made alike",
        shown(first_value),
        shown(second_value)
    )]
    Unlike {
        /// What differs: the name of a column.
        what: &'static str,
        /// The one table.
        first: Box<str>,
        /// Its row.
        first_row: Box<str>,
        /// What it has.
        first_value: Box<str>,
        /// The other table.
        second: Box<str>,
        /// Its row.
        second_row: Box<str>,
        /// What that has.
        second_value: Box<str>,
    },
}

fn shown(value: &str) -> &str {
    if value.is_empty() { "not recorded" } else { value }
}

/// A row as messages name it.
fn named(row: &Row) -> String {
    format!("scene {} of set {}, seed {}, by {}", row.index, row.set, row.seed, row.method)
}

/// Joins tables, each with its name, as if all had been made in one run: sorted by set, seed and scene, methods as their runs name them,
/// or else in the order they come.
///
/// # Errors
/// [`MergeError`] when a row stands in two tables or twice in one, and when two rows were not made alike.
pub fn merge(tables: Vec<(String, Vec<Row>)>) -> Result<Vec<Row>, MergeError> {
    let names: Vec<String> = tables.iter().map(|(name, _)| name.clone()).collect();
    let mut all: Vec<(usize, Row)> = Vec::new();
    for (table, (_, rows)) in tables.into_iter().enumerate() {
        all.extend(rows.into_iter().map(|row| (table, row)));
    }
    check_alike(&names, &all)?;
    let [sets, methods] = orders(&all);
    let place = |set: &String| (set.parse::<u32>().unwrap_or(u32::MAX), sets[set]);
    all.sort_by_cached_key(|(_, r)| (place(&r.set), r.seed, r.index, methods[&r.method]));
    let key = |row: &Row| (row.set.clone(), row.seed, row.index, row.method.clone());
    if let Some([(first, row), (second, _)]) = all.array_windows().find(|[(_, a), (_, b)]| key(a) == key(b)) {
        let [first, second] = [first, second].map(|t| names[*t].clone());
        return Err(MergeError::Twice { row: named(row), first, second });
    }
    Ok(all.into_iter().map(|(_, row)| row).collect())
}

/// Places of sets and of methods: first as the runs name them, then as rows come.
fn orders(rows: &[(usize, Row)]) -> [BTreeMap<String, usize>; 2] {
    let mut orders = [BTreeMap::new(), BTreeMap::new()];
    let add = |order: &mut BTreeMap<String, usize>, name: &String| {
        let next = order.len();
        order.entry(name.clone()).or_insert(next);
    };
    let mut last = None;
    for (_, row) in rows {
        if let Some(origin) = row.origin.as_ref().filter(|o| !last.is_some_and(|last| Arc::ptr_eq(last, o))) {
            last = Some(origin);
            origin.whole.sets.iter().for_each(|(set, _)| add(&mut orders[0], set));
            origin.whole.methods.iter().for_each(|method| add(&mut orders[1], method));
        }
        add(&mut orders[0], &row.set);
        add(&mut orders[1], &row.method);
    }
    orders
}

/// Checks that rows were made alike: each is held against the first row, the first generated one, the first of its method, and the first of
/// its set.
fn check_alike(names: &[String], rows: &[(usize, Row)]) -> Result<(), MergeError> {
    let mut generated = None;
    let (mut methods, mut sets) = (BTreeMap::new(), BTreeMap::new());
    let Some(first) = rows.first() else { return Ok(()) };
    for row in rows {
        let of_method = *methods.entry(row.1.method.as_str()).or_insert(row);
        let of_set = *sets.entry(row.1.set.as_str()).or_insert(row);
        let of_generated = if row.1.is_generated() { *generated.get_or_insert(row) } else { row };
        for other in [first, of_generated, of_method, of_set] {
            if let Some((what, [first_value, second_value])) = difference(&other.1, &row.1) {
                let [first, second] = [other, row].map(|(table, _)| names[*table].clone());
                let [first_row, second_row] = [other, row].map(|(_, row)| named(row));
                return Err(MergeError::Unlike {
                    what,
                    first: first.into(),
                    first_row: first_row.into(),
                    first_value: first_value.into(),
                    second: second.into(),
                    second_row: second_row.into(),
                    second_value: second_value.into(),
                });
            }
        }
    }
    Ok(())
}

/// What differs between two rows though it must not, and both values.
fn difference(a: &Row, b: &Row) -> Option<(&'static str, [String; 2])> {
    if a.is_generated() && b.is_generated() && a.seed != b.seed {
        return Some(("seed", [a.seed.to_string(), b.seed.to_string()]));
    }
    match (&a.origin, &b.origin) {
        (None, None) => None,
        (Some(of_a), Some(of_b)) if Arc::ptr_eq(of_a, of_b) => None,
        (Some(of_a), Some(of_b)) => {
            let part = of_a.unlike(of_b, a.method == b.method, a.set == b.set)?;
            // Scenes of noise alone may lie over another floor than the rest; what else differs counts.
            if part == Part::Floor && a.has_own_floor() != b.has_own_floor() {
                let of_a = Origin { floor: of_b.floor, ..Origin::clone(of_a) };
                let part = of_a.unlike(of_b, a.method == b.method, a.set == b.set)?;
                return Some((part.name(), [of_a.text(part), of_b.text(part)]));
            }
            Some((part.name(), [of_a.text(part), of_b.text(part)]))
        }
        (of_a, of_b) => {
            let version =
                |origin: &Option<Arc<Origin>>| origin.as_ref().map(|o| o.text(Part::Version)).unwrap_or_default();
            Some((Part::Version.name(), [version(of_a), version(of_b)]))
        }
    }
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
    use super::super::origin::tests::origin;
    use super::super::tests::row;
    use super::*;
    use crate::reconstruct::Weights;
    use crate::signal::Floor;

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

    fn merged(a: Row, b: Row) -> String {
        merge(vec![("a.csv".into(), vec![a]), ("b.csv".into(), vec![b])]).unwrap_err().to_string()
    }

    #[test]
    fn unlike_rows_are_refused_by_name() {
        let of =
            |index, method: &str, origin: Origin| Row { origin: Some(Arc::new(origin)), ..row("1", index, method) };
        let exact = Origin { floor: Floor::Exact, ..origin() };
        assert_eq!(
            merged(of(0, "live", origin()), of(1, "nomp", exact)),
            "floor is thesis in a.csv (scene 0 of set 1, seed 7, by live) and exact in b.csv (scene 1 of set 1, seed 7, by nomp); \
             expected rows that were made alike"
        );
        let older = merged(of(0, "live", origin()), row("1", 1, "live"));
        assert!(older.starts_with("version is 1 in a.csv") && older.contains("not recorded in b.csv"), "{older}");
        let other_seed = Row { seed: 8, ..of(1, "live", origin()) };
        assert!(merged(of(0, "live", origin()), other_seed).starts_with("seed is 7 in a.csv"));
        let weighted =
            |w: &str| Origin { weights: Some(Weights { sha256: w.into(), optimiser: "SGD".into() }), ..origin() };
        let weights = merged(of(0, "live", weighted("aa")), of(1, "live", weighted("bb")));
        assert!(weights.starts_with("weights is aa in a.csv") && weights.contains("bb in b.csv"), "{weights}");
        let noise = Row { set: "noise".into(), ..of(0, "live", Origin { floor: Floor::Exact, ..origin() }) };
        let beside = vec![of(0, "live", origin()), noise];
        assert!(merge(vec![("a.csv".into(), beside)]).is_ok(), "noise alone has a floor of its own");
        let two = vec![of(0, "live", weighted("aa")), of(0, "thesis", weighted("bb"))];
        assert!(merge(vec![("a.csv".into(), two)]).is_ok(), "two networks have weights of their own");
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
