//! Texts of the table's cells and titles, and widths of its columns.

use crate::evaluate::eta_text;
use crate::evaluate::rows::{Column, Row, Value};
use crate::radar::capitalised;

pub fn text(row: &Row, column: Column) -> String {
    match column.of(row) {
        Value::Missing => "–".to_owned(),
        Value::Text(text) => last_part(&text).to_owned(),
        Value::Number(value) => number(column, value),
    }
}

/// Text of a column's number, with a number of digits that suits the column.
pub fn number(column: Column, value: f64) -> String {
    let digits = match column {
        Column::Eta => return eta_text(value as f32),
        Column::Detection | Column::FalseAlarm | Column::DetectionAtPrinted | Column::WithinDoubt => 4,
        Column::SquaredError | Column::Doubt | Column::Milliseconds | Column::StrongestOverWeakestDb => 1,
        Column::NearestPairColumns | Column::NearestPairBins => 1,
        Column::MinRangeMetres => 2,
        _ => 0,
    };
    format!("{value:.digits$}").replace('-', "−")
}

/// The last part of a folder's path, which fits into a cell.
fn last_part(text: &str) -> &str {
    text.rsplit(['/', '\\']).find(|part| !part.is_empty()).unwrap_or(text)
}

/// A column's heading in two lines of words; the column's name in the file where it has no other.
pub fn title(column: Column) -> String {
    let title = match column {
        Column::Index => "Scene",
        Column::Eta => "η",
        Column::Detection => "P_D",
        Column::FalseAlarm => "P_FA",
        Column::DetectionAtPrinted => "P_D at the\nprinted η",
        Column::Milliseconds => "Time\nms",
        Column::MinRangeMetres => "Least range\nm",
        Column::StrongestOverWeakestDb => "Strongest over\nweakest, dB",
        Column::Echoes => "Echoes of\nbodies",
        Column::Doubt => "Doubt\nas SE",
        Column::WithinDoubt => "Cells within\ndoubt",
        Column::CfarDetection => "P_D\nby CFAR",
        Column::CfarFalseAlarm => "P_FA\nby CFAR",
        _ => {
            let words = capitalised(&column.name().replace('_', " "));
            return words.rsplit_once(' ').map_or(words.clone(), |(above, below)| format!("{above}\n{below}"));
        }
    };
    title.to_owned()
}

/// A column's heading as one text.
pub fn heading(column: Column) -> String {
    title(column).replace('\n', " ")
}

/// Width of a column, points.
pub fn width(column: Column) -> f32 {
    match column {
        Column::Set => 74.0,
        Column::Method => 130.0,
        Column::Index | Column::Seed => 52.0,
        Column::StrongestOverWeakestDb => 110.0,
        Column::NearestPairColumns | Column::NearestPairBins | Column::Doubt | Column::WithinDoubt => 90.0,
        _ => 78.0,
    }
}

/// Whether the cells are aligned to the right.
pub fn is_number(column: Column) -> bool {
    !matches!(column, Column::Set | Column::Method)
}

/// Name of a row: set, scene and method.
pub fn name(row: &Row) -> String {
    format!("set {}, scene {}, {}", last_part(&row.set), row.index, row.method)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::jobs::some_row;

    #[test]
    fn every_column_has_a_title_and_a_text() {
        let row = Row { set: "/home/me/scenes/".into(), ..some_row(3, "live") };
        for &column in Column::FIGURES {
            let heading = heading(column);
            assert!(!heading.is_empty() && heading != column.name(), "words, and no name of a file's column");
            assert!(!text(&row, column).is_empty());
        }
        assert_eq!(heading(Column::SquaredError), "Squared error");
        assert_eq!(title(Column::NearestPairBins), "Nearest pair\nbins");
        let columns = [Column::Set, Column::DetectionAtPrinted, Column::Found, Column::Doubt];
        assert_eq!(columns.map(|c| text(&row, c)), ["scenes", "–", "1", "93.0"]);
        assert_eq!(name(&row), "set scenes, scene 3, live");
    }
}
