//! Points and bars of the charts, computed when the rows changed.

use crate::app::jobs::RowTable;
use crate::evaluate::rows::{Column, Histogram, Row};
use crate::evaluate::statistics::Paired;
use std::collections::{BTreeSet, HashMap};

const MAX_BARS: usize = 40;

/// Columns and methods that a chart shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Subject {
    /// Distribution of a column's figures.
    Histogram(Column),
    /// Two columns of every row.
    Columns(Column, Column),
    /// One column for two methods on the same scene.
    Methods(Column, String, String),
}

/// Columns whose text may decide a row's colour.
pub const GROUP_COLUMNS: [Column; 2] = [Column::Method, Column::Set];

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dot {
    pub at: [f64; 2],
    /// Index of the dot's group in [`Points::groups`].
    pub group: usize,
    /// Indices of the row to open and of the second method's row; both the same where there is one row.
    pub rows: [usize; 2],
}

#[derive(Debug, Clone, Default, PartialEq)]
pub struct Points {
    /// The dots of a scatter plot; for a histogram, one dot on the axis for each row.
    pub dots: Vec<Dot>,
    pub bars: Option<Histogram>,
    pub groups: Vec<String>,
    /// Limits of both axes, [low, high] each.
    pub spans: [[f64; 2]; 2],
    /// Sentence that compares the two methods by statistics.
    pub told: Option<String>,
}

fn number(row: &Row, column: Column) -> Option<f64> {
    column.of(row).number()
}

impl Points {
    /// Content of the chart of the rows whose indices are in `filtered`.
    pub fn of(table: &RowTable, filtered: &[usize], subject: &Subject, grouping: Column) -> Points {
        let rows = table.rows();
        let of_row = |index: &usize| rows.get(*index).map(|row| (*index, row));
        let listed = || filtered.iter().filter_map(of_row);
        let names: BTreeSet<String> = listed().map(|(_, row)| grouping.of(row).to_string()).collect();
        let groups: Vec<String> = names.into_iter().collect();
        let group = |row: &Row| groups.iter().position(|name| *name == grouping.of(row).to_string()).unwrap_or(0);
        let dot = |(index, row): (usize, &Row), at| Some(Dot { at, group: group(row), rows: [index; 2] });
        match subject {
            Subject::Histogram(column) => {
                let at = |row: &Row| Some([number(row, *column)?, 0.0]);
                let dots = listed().filter_map(|listed| dot(listed, at(listed.1)?)).collect();
                let bars = Histogram::of(listed().map(|(_, row)| row), *column, MAX_BARS);
                let most = bars.as_ref().and_then(|b| b.counts.iter().max()).map_or(1, |most| *most);
                let x = bars.as_ref().map_or([0.0, 1.0], |b| padded(b.low, b.high, 0.0));
                Points { dots, bars, groups, spans: [x, [0.0, 1.05 * most as f64]], told: None }
            }
            Subject::Columns(x, y) => {
                let at = |row: &Row| Some([number(row, *x)?, number(row, *y)?]);
                let dots = listed().filter_map(|listed| dot(listed, at(listed.1)?)).collect();
                Points { groups, ..Points::scattered(dots) }
            }
            Subject::Methods(column, a, b) => {
                let scene = |row: &Row| (row.set.clone(), row.seed, row.index);
                let of_b: HashMap<_, usize> =
                    listed().filter(|(_, row)| *row.method == **b).map(|(index, row)| (scene(row), index)).collect();
                let dot = |(index, row): (usize, &Row)| {
                    let other = *of_b.get(&scene(row))?;
                    let at = [number(row, *column)?, number(&rows[other], *column)?];
                    Some(Dot { at, group: group(row), rows: [index, other] })
                };
                let dots = listed().filter(|(_, row)| *row.method == **a).filter_map(dot).collect();
                let paired = Paired::of(listed().map(|(_, row)| row), a, b).filter(|_| a != b);
                Points { told: paired.map(|paired| paired.sentence(a, b)), groups, ..Points::scattered(dots) }
            }
        }
    }

    fn scattered(dots: Vec<Dot>) -> Points {
        let span = |axis: usize| {
            let ends = dots.iter().map(|dot| dot.at[axis]);
            let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
            if low <= high { padded(low, high, 0.03) } else { [0.0, 1.0] }
        };
        Points { spans: [span(0), span(1)], dots, ..Points::default() }
    }
}

/// `low` and `high` with a margin; they always differ.
fn padded(low: f64, high: f64, part: f64) -> [f64; 2] {
    let size = high - low;
    let room = if size > 0.0 { part * size } else { 0.5 * low.abs().max(1.0) };
    [low - room, high + room]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::jobs::some_row;
    use crate::app::state::Conditions;

    fn table() -> RowTable {
        let mut table = RowTable::default();
        let of =
            |method: &'static str| (0..6).map(move |i| Row { found: (i != 2).then_some(4), ..some_row(i, method) });
        table.replace(of("live").chain(of("nomp").skip(1)).collect(), Conditions::default());
        table
    }

    #[test]
    fn rows_are_grouped_by_method_or_meet_on_their_common_scenes() {
        let table = table();
        let all: Vec<usize> = (0..table.rows().len()).collect();
        let by_columns = Subject::Columns(Column::Index, Column::SquaredError);
        let points = Points::of(&table, &all, &by_columns, Column::Method);
        assert_eq!(points.groups, ["live", "nomp"]);
        assert_eq!([0, 1].map(|group| points.dots.iter().filter(|dot| dot.group == group).count()), [6, 5]);
        let subject = Subject::Methods(Column::SquaredError, "live".into(), "nomp".into());
        let points = Points::of(&table, &all, &subject, Column::Method);
        assert_eq!(points.dots.len(), 5, "the first scene was tried by one only");
        assert!(points.dots.iter().all(|dot| dot.at[0] == dot.at[1] && dot.rows[1] == dot.rows[0] + 5));
        let [low, high] = points.spans[0];
        assert!(points.dots.iter().all(|dot| low < dot.at[0] && dot.at[0] < high));
    }

    #[test]
    fn rows_without_a_figure_have_no_dot() {
        let table = table();
        let points = Points::of(&table, &[0, 2, 3], &Subject::Columns(Column::Index, Column::Found), Column::Method);
        assert_eq!(points.dots.iter().map(|dot| dot.rows[0]).collect::<Vec<_>>(), [0, 3]);
        assert!(points.spans[1][0] < 4.0 && points.spans[1][1] > 4.0, "a span is never empty");
        let none = Points::of(&table, &[0, 2], &Subject::Histogram(Column::Method), Column::Method);
        assert!(none.bars.is_none() && none.dots.is_empty());
    }

    #[test]
    fn the_bars_of_a_histogram_count_the_filtered_rows() {
        let table = table();
        let points = Points::of(&table, &[0, 1, 5], &Subject::Histogram(Column::Index), Column::Method);
        assert_eq!(points.bars.map(|b| b.counts.iter().sum::<usize>()), Some(3));
        assert_eq!(points.spans[0], [0.0, 5.0]);
    }
}
