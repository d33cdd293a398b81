//! Merging of the rows of several runs, in any order, into those of one run.

use super::{Column, Row, Text, WHY_NO_OTHER_FORMAT};
use std::collections::BTreeMap;

fn named(row: &Row) -> String {
    format!("scene {} of set {}, seed {}, by {}", row.index, row.set, row.seed, row.method)
}

/// Joins tables, each with its name, into that of one run. Rows are sorted by set, seed and scene; methods stand in the order of their runs, or
/// else in the order in which they come.
/// # Errors
/// The fault, when a row stands in two tables or twice in one, and when two rows have different origins.
pub fn merge(tables: Vec<(String, Vec<Row>)>) -> Result<Vec<Row>, String> {
    let names: Vec<String> = tables.iter().map(|(name, _)| name.clone()).collect();
    let mut all: Vec<(usize, Row)> = Vec::new();
    for (table, (_, rows)) in tables.into_iter().enumerate() {
        all.extend(rows.into_iter().map(|row| (table, row)));
    }
    check_alike(&names, &all)?;
    let [sets, methods] = orders(&all);
    let place = |set: &Text| (set.parse::<u32>().unwrap_or(u32::MAX), sets[set]);
    all.sort_by_cached_key(|(_, r)| (place(&r.set), r.seed, r.index, methods[&r.method]));
    let key = |row: &Row| (row.set.clone(), row.seed, row.index, row.method.clone());
    if let Some([(first, row), (second, _)]) = all.array_windows().find(|[(_, a), (_, b)]| key(a) == key(b)) {
        let (row, first, second) = (named(row), &names[*first], &names[*second]);
        return Err(format!("{row} stands in {first} and in {second}; expected each row once"));
    }
    Ok(all.into_iter().map(|(_, row)| row).collect())
}

/// Ranks of sets and of methods: first in the order of the runs, then in that of the rows.
fn orders(rows: &[(usize, Row)]) -> [BTreeMap<Text, usize>; 2] {
    let mut orders = [BTreeMap::new(), BTreeMap::new()];
    let add = |order: &mut BTreeMap<Text, usize>, name: &Text| {
        let next = order.len();
        order.entry(name.clone()).or_insert(next);
    };
    let mut last = None;
    for (_, row) in rows {
        let run = (&row.whole, &row.methods);
        if last != Some(run) {
            last = Some(run);
            let whole = row.whole_run().unwrap_or_default();
            whole.sets.into_iter().for_each(|(set, _)| add(&mut orders[0], &set.into()));
            whole.methods.into_iter().for_each(|method| add(&mut orders[1], &method.into()));
        }
        add(&mut orders[0], &row.set);
        add(&mut orders[1], &row.method);
    }
    orders
}

/// Checks that rows have one origin: each is compared with the first row, the first generated one, the first of its method, and the first of its set.
fn check_alike(names: &[String], rows: &[(usize, Row)]) -> Result<(), String> {
    let mut generated = None;
    let (mut methods, mut sets) = (BTreeMap::new(), BTreeMap::new());
    let Some(first) = rows.first() else { return Ok(()) };
    for row in rows {
        let of_method = *methods.entry(&row.1.method).or_insert(row);
        let of_set = *sets.entry(&row.1.set).or_insert(row);
        let of_generated = if row.1.is_generated() { *generated.get_or_insert(row) } else { row };
        for other in [first, of_generated, of_method, of_set] {
            if let Some(column) = difference(&other.1, &row.1) {
                let [first, second] = [other, row].map(|(table, row)| {
                    let value = Some(column.text(row)).filter(|value| !value.is_empty());
                    format!("{} in {} ({})", value.as_deref().unwrap_or("not recorded"), names[*table], named(row))
                });
                let why =
                    if column == Column::Version { WHY_NO_OTHER_FORMAT } else { "expected rows that were made alike" };
                return Err(format!("{} is {first} and {second}; {why}", column.name()));
            }
        }
    }
    Ok(())
}

fn difference(a: &Row, b: &Row) -> Option<Column> {
    use Column::{
        Carrier, Cfar, Floor, Layout, Normalisation, Program, Purpose, Radar, Reading, Scenes, Seed, Version, Weights,
    };
    let of_scenes: &[Column] = match [a, b].map(Row::is_generated) {
        [true, true] => &[Seed, Purpose, Reading, Carrier, Radar],
        _ if a.set == b.set => &[Carrier, Scenes],
        _ => &[],
    };
    let of_method: &[Column] = if a.method == b.method { &[Program, Weights, Layout] } else { &[] };
    // Scenes of noise alone may lie over another floor than the rest.
    let of_floor: &[Column] = if a.has_own_floor() == b.has_own_floor() { &[Floor] } else { &[] };
    let columns = [&[Version], of_floor, &[Normalisation, Cfar], of_scenes, of_method].into_iter().flatten();
    columns.copied().find(|column| !column.is_same(a, b))
}

#[cfg(test)]
mod tests {
    use super::super::tests::made;
    use super::*;
    use crate::radar::Carrier;
    use crate::scene::generate::Reading;
    use crate::signal::Floor;

    fn refused(a: Row, b: Row) -> String {
        merge(vec![("a.csv".into(), vec![a]), ("b.csv".into(), vec![b])]).unwrap_err().to_string()
    }

    #[test]
    fn unlike_rows_are_refused_by_name() {
        let first = || made("1", 0, "live");
        let exact = Row { floor: Some(Floor::Exact), ..made("1", 1, "nomp") };
        assert_eq!(
            refused(first(), exact.clone()),
            "floor is thesis in a.csv (scene 0 of set 1, seed 7, by live) and exact in b.csv (scene 1 of set 1, seed 7, by nomp); \
             expected rows that were made alike"
        );
        for (other, told) in [
            (Row { seed: 8, ..first() }, "seed is 7 in a.csv"),
            (Row { carrier: Some(Carrier::TwoWay), ..first() }, "carrier is one-way in a.csv"),
            (Row { reading: Some(Reading::Text), ..first() }, "reading is program in a.csv"),
        ] {
            assert!(refused(first(), Row { index: 1, ..other }).starts_with(told), "{told}");
        }
        let heard = Row { layout: "0-3 9".into(), index: 1, ..first() };
        assert!(refused(first(), heard.clone()).contains("0-3 9 in b.csv"));
        let holds = merge(vec![("a.csv".into(), vec![first(), Row { method: "iaa".into(), ..heard }])]).is_ok();
        assert!(holds, "two methods");
        let weighted = |weights: &str, method: &str| Row { weights: weights.into(), ..made("1", 0, method) };
        let weights = refused(weighted("aa", "live"), weighted("bb", "live"));
        assert!(weights.starts_with("weights is aa in a.csv") && weights.contains("bb in b.csv"), "{weights}");
        let folder = |scenes: &str, set: &str| Row { carrier: None, scenes: scenes.into(), ..made(set, 0, "live") };
        assert!(refused(folder("aa", "own"), folder("bb", "own")).starts_with("scenes is aa in a.csv"));
        let merged = |rows: Vec<Row>| merge(vec![("a.csv".into(), rows)]);
        assert!(merged(vec![folder("aa", "own"), folder("bb", "other")]).is_ok(), "two folders");
        let noise = Row { set: "noise".into(), method: "live".into(), ..exact };
        assert!(merged(vec![first(), noise]).is_ok(), "noise alone has a floor of its own");
        assert!(merged(vec![weighted("aa", "live"), weighted("bb", "thesis")]).is_ok(), "two networks");
        let shard = Row { shard: "1/2".parse().ok(), ..made("1", 1, "live") };
        assert!(merged(vec![first(), shard]).is_ok(), "shards of one run");
    }
}
