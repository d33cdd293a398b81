//! The table of rows: one per scene and method, in the order of their arrival.

use crate::app::state::Conditions;
use crate::evaluate::rows::{FORMAT, MAX_ROWS, Row, Text};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// The identity of a row in its table.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct RowKey {
    set: Text,
    seed: u64,
    index: u32,
    method: Text,
}

impl RowKey {
    pub fn of(row: &Row) -> RowKey {
        RowKey { set: row.set.clone(), seed: row.seed, index: row.index, method: row.method.clone() }
    }
}

/// Rows with their conditions, and counters of changes.
#[derive(Debug, Default)]
pub struct RowTable {
    rows: Arc<Vec<Row>>,
    places: HashMap<RowKey, usize>,
    methods: BTreeSet<String>,
    conditions: Conditions,
    version: u64,
    generation: u64,
}

impl RowTable {
    pub fn rows(&self) -> &Arc<Vec<Row>> {
        &self.rows
    }

    pub fn methods(&self) -> &BTreeSet<String> {
        &self.methods
    }

    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// A number that rises with every change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// A number that rises when all rows are replaced, so that their indices lose their meaning.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Replaces all rows. Of several rows of one scene and method the last one stays.
    pub fn replace(&mut self, rows: Vec<Row>, conditions: Conditions) {
        let (version, generation) = (self.version + 1, self.generation + 1);
        *self = RowTable { conditions, version, generation, ..RowTable::default() };
        rows.into_iter().for_each(|row| _ = self.add(row));
    }

    /// Adds a row, or replaces the one of the same scene and method; false where the table is full.
    pub fn add(&mut self, row: Row) -> bool {
        let key = RowKey::of(&row);
        let place = self.places.get(&key).copied();
        if place.is_none() && self.rows.len() >= MAX_ROWS {
            return false;
        }
        self.version += 1;
        let rows = Arc::make_mut(&mut self.rows);
        match place {
            Some(place) => rows[place] = row,
            None => {
                if !self.methods.contains(&*row.method) {
                    self.methods.insert(row.method.to_string());
                }
                self.places.insert(key, rows.len());
                rows.push(row);
            }
        }
        true
    }

    /// Whether all rows have this program's format and the layout `layout`, so that new rows of it may stand beside them.
    pub fn is_alike(&self, layout: &str) -> bool {
        self.rows.iter().all(|row| row.version == Some(FORMAT) && &*row.layout == layout)
    }

    /// Whether the table has a row of the same scene and method.
    pub fn has(&self, row: &Row) -> bool {
        self.places.contains_key(&RowKey::of(row))
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::evaluate::campaign::Campaign;
    use crate::evaluate::sets::SceneSet;
    use crate::reconstruct::{Baseline, Reconstructor};
    use crate::scene::generate::Kind;

    pub fn some_row(index: u32, method: &str) -> Row {
        let methods: [&dyn Reconstructor; 1] = [&Baseline];
        let empty = Campaign::default().empty_rows(&[SceneSet::Generated(Kind::Set1)], &methods);
        Row {
            index,
            method: method.into(),
            eta: 0.8,
            squared_error: 100.0 + f64::from(index * 7919 % 1000),
            detection: (!index.is_multiple_of(5)).then_some(0.5),
            false_alarm: 0.01,
            milliseconds: 3.0,
            objects: 1 + index as usize % 6,
            reflectors: 3,
            missed: index as usize % 3,
            min_range_metres: Some(5.0),
            strongest_over_weakest_db: Some(0.0),
            found: Some(1),
            merged: Some(0),
            wrong_tooth: Some(0),
            doubt: (method == "live").then_some(90.0 + f64::from(index)),
            within_doubt: (method == "live").then_some(0.9),
            ..empty.expect("one set and one method")[0][0].clone()
        }
    }

    #[test]
    fn a_later_row_takes_the_place_of_an_earlier_one() {
        let mut table = RowTable::default();
        for index in [0, 1, 0] {
            assert!(table.add(some_row(index, "live")));
        }
        let better = Row { squared_error: 1.0, ..some_row(1, "live") };
        table.add(better.clone());
        assert!(table.has(&better) && !table.has(&some_row(1, "nomp")));
        assert_eq!(**table.rows(), [some_row(0, "live"), better]);
    }

    #[test]
    fn other_rows_are_another_generation() {
        let mut table = RowTable::default();
        table.add(some_row(0, "live"));
        let (version, generation) = (table.version(), table.generation());
        table.replace(vec![some_row(3, "nomp")], Conditions::default());
        assert!(table.version() > version && table.generation() > generation);
        assert_eq!((table.rows().len(), table.methods()), (1, &BTreeSet::from(["nomp".to_owned()])));
    }
}
