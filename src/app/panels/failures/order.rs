//! Filter and order of the rows, computed when something changed and not in every frame.

use crate::app::jobs::RowTable;
use crate::app::shared::Shared;
use crate::evaluate::filter::Filter;
use crate::evaluate::rows::{Column, sorted_by};
use crate::platform::Instant;
use std::collections::HashSet;
use std::time::Duration;

/// Interval at which rows are sorted while new ones arrive.
const ORDER_INTERVAL: Duration = Duration::from_millis(250);

/// The column by which rows are sorted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sort {
    pub column: Column,
    /// Whether the largest figure comes first.
    pub descending: bool,
}

impl Sort {
    /// The sorting after a click on the title of `column`: the largest first, then the smallest, then the order in which rows came.
    pub fn clicked(now: Option<Sort>, column: Column) -> Option<Sort> {
        match now {
            Some(sort) if sort.column == column => sort.descending.then_some(Sort { column, descending: false }),
            _ => Some(Sort { column, descending: true }),
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Boxed {
    /// Generation of the table that they belong to.
    pub generation: u64,
    pub rows: Shared<HashSet<usize>>,
}

#[derive(Debug, Clone, PartialEq)]
struct Key {
    version: u64,
    generation: u64,
    filter: Option<Filter>,
    sort: Option<Sort>,
    boxed: Option<Boxed>,
}

/// The latest filtered and sorted rows.
#[derive(Default)]
pub struct Order {
    of: Option<Key>,
    when: Option<Instant>,
    /// Indices of the rows that pass the filter, in the order in which they came.
    pub filtered: Vec<usize>,
    /// Indices of the filtered rows in the box, sorted.
    pub shown: Vec<usize>,
    /// Rises with every computation.
    pub stamp: u64,
}

impl Order {
    /// Filters and sorts again if something changed; unsorted rows stay in the order in which they came. Returns the time until waiting new rows are due.
    pub fn update(
        &mut self,
        table: &RowTable,
        filter: Option<&Filter>,
        sort: Option<Sort>,
        boxed: Option<&Boxed>,
    ) -> Option<Duration> {
        let (version, generation) = (table.version(), table.generation());
        let key = Key { version, generation, filter: filter.cloned(), sort, boxed: boxed.cloned() };
        if self.of.as_ref() == Some(&key) {
            return None;
        }
        let only_rows = self.of.as_ref().is_some_and(|of| Key { version: key.version, ..of.clone() } == key);
        if let Some(wait) = self.when.filter(|_| only_rows).and_then(|when| ORDER_INTERVAL.checked_sub(when.elapsed()))
        {
            return Some(wait);
        }
        let rows = table.rows();
        self.filtered = match filter {
            Some(filter) => filter.matching(rows),
            None => (0..rows.len()).collect(),
        };
        let mut is_shown = vec![false; rows.len()];
        for &index in self.filtered.iter().filter(|index| boxed.is_none_or(|b| b.rows.contains(index))) {
            is_shown[index] = true;
        }
        self.shown = match sort {
            Some(Sort { column, descending }) => sorted_by(rows, column, descending),
            None => (0..rows.len()).collect(),
        };
        self.shown.retain(|index| is_shown[*index]);
        self.of = Some(key);
        self.when = Some(Instant::now());
        self.stamp += 1;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::jobs::some_row;
    use crate::app::state::Conditions;

    fn table(count: u32) -> RowTable {
        let mut table = RowTable::default();
        table.replace((0..count).map(|i| some_row(i, "live")).collect(), Conditions::default());
        table
    }

    /// Six rows, a filter and a box.
    struct Asked {
        table: RowTable,
        filter: Filter,
        boxed: Option<Boxed>,
    }

    impl Asked {
        fn update(&self, order: &mut Order) -> Option<Duration> {
            let sort = Some(Sort { column: Column::Index, descending: true });
            order.update(&self.table, Some(&self.filter), sort, self.boxed.as_ref())
        }
    }

    fn asked() -> (Asked, Order) {
        let table = table(6);
        let filter = Filter::parse("index >= 2", &["live"]).unwrap();
        let boxed = Some(Boxed { generation: table.generation(), rows: Shared::new(HashSet::from([1, 3, 5])) });
        let (asked, mut order) = (Asked { table, filter, boxed }, Order::default());
        asked.update(&mut order);
        (asked, order)
    }

    #[test]
    fn only_filtered_rows_in_the_box_are_put_in_order_once() {
        let (mut asked, mut order) = asked();
        assert_eq!((&order.filtered[..], &order.shown[..]), (&[2, 3, 4, 5][..], &[5, 3][..]));
        let stamp = order.stamp;
        asked.update(&mut order);
        assert_eq!(order.stamp, stamp);
        asked.table.replace(Vec::new(), Conditions::default());
        asked.update(&mut order);
        assert!(order.shown.is_empty(), "rows of another table do not stay");
    }

    #[test]
    fn rows_that_come_are_taken_in_now_or_a_moment_later() {
        let (mut asked, mut order) = asked();
        asked.table.add(some_row(6, "live"));
        assert!(asked.update(&mut order).is_some(), "a moment later");
        asked.boxed = None;
        asked.update(&mut order);
        assert_eq!(order.shown, [6, 5, 4, 3, 2], "at once when something else changed");
    }

    #[test]
    fn the_third_click_on_a_title_sorts_no_more() {
        let first = Sort::clicked(None, Column::Missed);
        assert_eq!(first, Some(Sort { column: Column::Missed, descending: true }));
        let second = Sort::clicked(first, Column::Missed);
        assert_eq!(second.map(|s| s.descending), Some(false));
        assert_eq!(Sort::clicked(second, Column::Missed), None);
        assert_eq!(Sort::clicked(second, Column::Ghosts).map(|s| s.column), Some(Column::Ghosts));
    }
}
