//! Rows that are missing from a whole run.

use super::{Row, Text, WholeRun};
use crate::evaluate::shard::Shard;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

const MAX_NAMED_SCENES: usize = 8;
const MAX_SHARDS: u32 = 1000;

/// Scenes of a set without a row by a method.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct MissingRows {
    /// Name of the set.
    pub set: String,
    /// Name of the method.
    pub method: String,
    /// Number of scenes without a row.
    pub missing: u32,
    /// Number of scenes in the whole run.
    pub of: u32,
    first: Vec<u32>,
    shard: Option<String>,
}

impl fmt::Display for MissingRows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let MissingRows { set, method, missing, of, first, shard } = self;
        write!(f, "set {set}, {method}: {missing} of {of} scenes")?;
        match shard {
            Some(shard) => write!(f, " (shard {shard})"),
            None if missing == of => Ok(()),
            None => {
                let numbers: Vec<String> = first.iter().map(u32::to_string).collect();
                let more = if first.len() < *missing as usize { ", \u{2026}" } else { "" };
                write!(f, " (number {}{more})", numbers.join(", "))
            }
        }
    }
}

/// Scenes that `rows` lack, by the whole run that rows record, or else by the gaps below their highest scene number.
pub fn missing_rows(rows: &[Row]) -> Vec<MissingRows> {
    let mut present: BTreeMap<(&str, &str), BTreeSet<u32>> = BTreeMap::new();
    let mut runs: Vec<(&Text, &Text)> = Vec::new();
    let mut wholes: Vec<WholeRun> = Vec::new();
    let mut shards: Vec<Shard> = Vec::new();
    let mut guessed: BTreeMap<&Text, (u32, BTreeSet<&Text>)> = BTreeMap::new();
    for row in rows {
        present.entry((&*row.set, &*row.method)).or_default().insert(row.index);
        let (run, Some(shard)) = ((&row.whole, &row.methods), row.shard) else {
            let (count, methods) = guessed.entry(&row.set).or_default();
            *count = (*count).max(row.index.saturating_add(1));
            methods.insert(&row.method);
            continue;
        };
        if !runs.contains(&run) {
            runs.push(run);
            wholes.extend(row.whole_run());
        }
        if !shards.contains(&shard) {
            shards.push(shard);
        }
    }
    let mut wanted: Vec<(&str, &str, u32)> = Vec::new();
    for whole in &wholes {
        for (set, count) in &whole.sets {
            wanted.extend(whole.methods.iter().map(|method| (set.as_str(), method.as_str(), *count)));
        }
    }
    for (set, (count, methods)) in guessed {
        wanted.extend(methods.into_iter().map(|method| (&**set, &**method, count)));
    }
    let empty = BTreeSet::new();
    let mut found: Vec<MissingRows> = Vec::new();
    for (set, method, of) in wanted {
        let there = present.get(&(set, method)).unwrap_or(&empty);
        let lack = MissingRows::of(set, method, of, there, &shards);
        found.extend(lack.filter(|lack| !found.contains(lack)));
    }
    found
}

impl MissingRows {
    fn of(set: &str, method: &str, of: u32, there: &BTreeSet<u32>, shards: &[Shard]) -> Option<MissingRows> {
        let missing = of - there.range(..of).count() as u32;
        if missing == 0 {
            return None;
        }
        let is_whole = |shard: &Shard| {
            missing < of && missing == shard.size(of) && !there.range(..of).any(|index| shard.contains(*index))
        };
        let shard = shards.iter().filter(|s| s.of() <= MAX_SHARDS).flat_map(|shard| shard.all()).find(is_whole);
        let first = (0..of).filter(|index| !there.contains(index)).take(MAX_NAMED_SCENES).collect();
        let shard = shard.map(|shard| shard.to_string());
        Some(MissingRows { set: set.to_owned(), method: method.to_owned(), missing, of, first, shard })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{made, row};
    use super::*;

    fn rows(shard: &str) -> Vec<Row> {
        let shard: Shard = shard.parse().unwrap();
        let of = |set: &str, index, method: &str| Row {
            shard: Some(shard),
            whole: "1 x 10; 2 x 10".into(),
            methods: "live; nomp".into(),
            ..made(set, index, method)
        };
        let numbers: Vec<u32> = (0..10).filter(|n| shard.contains(*n)).collect();
        ["1", "2"]
            .iter()
            .flat_map(|set| numbers.iter().flat_map(|n| ["live", "nomp"].map(|method| of(set, *n, method))))
            .collect()
    }

    fn told(rows: &[Row]) -> Vec<String> {
        missing_rows(rows).iter().map(MissingRows::to_string).collect()
    }

    #[test]
    fn what_lacks_is_told_a_set_and_a_method_at_a_time() {
        let whole = rows("0/1");
        let only = |is: &dyn Fn(&Row) -> bool| whole.iter().filter(|row| is(row)).cloned().collect::<Vec<_>>();
        let shards = |which: [&str; 2]| which.map(rows).concat();
        let many = "set 1, live: 9 of 10 scenes (number 1, 2, 3, 4, 5, 6, 7, 8, \u{2026})";
        for (what, found, expected) in [
            ("whole", whole.clone(), &[][..]),
            ("both shards", shards(["1/2", "0/2"]), &[]),
            ("nothing", Vec::new(), &[]),
            ("a shard", shards(["0/3", "2/3"]), &["set 1, live: 3 of 10 scenes (shard 1/3)"]),
            (
                "a cut end",
                whole[..37].to_vec(),
                &["set 2, live: 1 of 10 scenes (number 9)", "set 2, nomp: 2 of 10 scenes (number 8, 9)"],
            ),
            (
                "a method",
                only(&|row| row.method == "live"),
                &["set 1, nomp: 10 of 10 scenes", "set 2, nomp: 10 of 10 scenes"],
            ),
            ("many", only(&|row| row.index == 0 && row.set == "1"), &[many]),
            ("older rows", [0, 2, 3].map(|n| row("1", n, "live")).to_vec(), &["set 1, live: 1 of 4 scenes (number 1)"]),
        ] {
            let told = told(&found);
            let holds = told.starts_with(&expected.iter().map(|line| (*line).to_owned()).collect::<Vec<_>>());
            assert!(holds, "{what}: {told:?}");
            assert_eq!(told.is_empty(), expected.is_empty(), "{what}: {told:?}");
        }
    }
}
