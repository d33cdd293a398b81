//! Rows read from CSV, with faults that name the line and the column.

use super::super::echoes::EchoTally;
use super::lines::{LongLine, MAX_LINE_BYTES, ShortLines};
use super::origin::Origin;
use super::part::Part;
use super::{CfarRates, Column, MAX_ROWS, Row};
use std::io::{self, Read};
use std::sync::Arc;

/// Why a file's rows can't be used.
#[derive(Debug, thiserror::Error)]
pub enum RowError {
    /// It can't be read.
    #[error("{0}")]
    Io(io::Error),
    /// Names are missing in its first line.
    #[error("line 1: there is no column \"{missing}\"; expected {}", Column::ALL.map(Column::name).join(","))]
    Header {
        /// The first column that is missing.
        missing: &'static str,
    },
    /// A cell holds something else than it should.
    #[error("line {line}, column {column}: \"{found}\"; expected {expected}")]
    Cell {
        /// Line, from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// Rows are of a later format.
    #[error("line {line}: the row is of format {found}; this program reads up to format {}", super::FORMAT)]
    Later {
        /// Line, from 1.
        line: u64,
        /// The format.
        found: String,
    },
    /// A line is no row.
    #[error("line {line}: {message}")]
    Line {
        /// Line, from 1.
        line: u64,
        /// What is wrong, and what was expected.
        message: String,
    },
    /// There are too many.
    #[error("there are more than {MAX_ROWS} rows; split the file")]
    TooMany,
}

/// Rows as a file has them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// The rows of whole lines.
    pub rows: Vec<Row>,
    /// Whether the file ends within a line: its writer was stopped, or the file was cut.
    pub is_cut: bool,
    /// How many bytes the whole lines have.
    pub whole_bytes: u64,
}

/// Reads what [`write_rows`](super::write_rows) wrote. Columns may stand in any order, and others beside them; those that are
/// [optional](Column::is_optional), and those that say what made a row, may be missing.
///
/// # Errors
/// [`RowError`] names the line and the column.
pub fn read_rows(input: impl Read) -> Result<Vec<Row>, RowError> {
    read(ShortLines::new(input, false)).map(|table| table.rows)
}

/// [`read_rows`] without a last line that has no end, which may hold half a row.
///
/// # Errors
/// As [`read_rows`].
pub fn read_table(input: impl Read) -> Result<Table, RowError> {
    read(ShortLines::new(input, true))
}

fn read(mut lines: ShortLines<impl Read>) -> Result<Table, RowError> {
    let mut reader = csv::Reader::from_reader(&mut lines);
    let header = reader.headers().map_err(of_csv)?;
    let place = |name: &str| header.iter().position(|found| found.trim() == name);
    let places = Column::ALL.map(|column| place(column.name()));
    let parts = Part::ALL.map(|part| place(part.name()));
    if let Some(column) = Column::ALL.into_iter().find(|c| places[*c as usize].is_none() && !c.is_optional()) {
        return Err(RowError::Header { missing: column.name() });
    }
    let mut rows: Vec<Row> = Vec::new();
    let mut record = csv::StringRecord::new();
    let mut last: Option<Arc<Origin>> = None;
    while reader.read_record(&mut record).map_err(of_csv)? {
        if rows.len() == MAX_ROWS {
            return Err(RowError::TooMany);
        }
        let line = record.position().map_or(0, csv::Position::line);
        let cells = Cells { record: &record, places: &places, parts: &parts, line };
        // Rows beneath each other are mostly of one run: they share what made them.
        let origin = cells.origin()?.map(|origin| match &last {
            Some(last) if **last == origin => last.clone(),
            _ => Arc::new(origin),
        });
        last = origin.clone().or(last);
        rows.push(Row { origin, ..cells.row()? });
    }
    drop(reader);
    Ok(Table { rows, is_cut: lines.is_cut, whole_bytes: lines.whole_bytes })
}

/// One line, and where its columns stand.
struct Cells<'a> {
    record: &'a csv::StringRecord,
    places: &'a [Option<usize>; Column::ALL.len()],
    parts: &'a [Option<usize>; Part::ALL.len()],
    line: u64,
}

impl Cells<'_> {
    fn text(&self, column: Column) -> &str {
        self.places[column as usize].and_then(|place| self.record.get(place)).unwrap_or_default().trim()
    }

    fn parse<T: std::str::FromStr>(&self, column: Column, expected: &'static str) -> Result<T, RowError> {
        self.text(column).parse().map_err(|_| self.unexpected(column, expected))
    }

    fn unexpected(&self, column: Column, expected: &'static str) -> RowError {
        let found = self.text(column).chars().take(40).collect();
        RowError::Cell { line: self.line, column: column.name(), found, expected }
    }

    fn number(&self, column: Column) -> Result<f64, RowError> {
        const EXPECTED: &str = "a finite number";
        let value: f64 = self.parse(column, EXPECTED)?;
        if value.is_finite() { Ok(value) } else { Err(self.unexpected(column, EXPECTED)) }
    }

    fn maybe(&self, column: Column) -> Result<Option<f64>, RowError> {
        if self.text(column).is_empty() { Ok(None) } else { self.number(column).map(Some) }
    }

    fn count(&self, column: Column) -> Result<usize, RowError> {
        self.parse(column, "a whole number from 0")
    }

    fn maybe_count(&self, column: Column) -> Result<Option<usize>, RowError> {
        if self.text(column).is_empty() { Ok(None) } else { self.count(column).map(Some) }
    }

    fn echoes(&self) -> Result<Option<EchoTally>, RowError> {
        const EXPECTED: &str = "six whole numbers from 0, none larger in echoes_found than in echoes";
        let texts = [Column::Echoes, Column::EchoesFound].map(|column| self.text(column));
        if texts == ["", ""] {
            return Ok(None);
        }
        EchoTally::read(texts).map(Some).ok_or_else(|| self.unexpected(Column::EchoesFound, EXPECTED))
    }

    fn cfar(&self) -> Result<Option<CfarRates>, RowError> {
        match self.maybe(Column::CfarFalseAlarm)? {
            Some(false_alarm) => Ok(Some(CfarRates { detection: self.maybe(Column::CfarDetection)?, false_alarm })),
            None if self.text(Column::CfarDetection).is_empty() => Ok(None),
            None => Err(self.unexpected(Column::CfarFalseAlarm, "a rate beside cfar_detection")),
        }
    }

    fn name(&self, column: Column) -> Result<String, RowError> {
        match self.text(column) {
            "" => Err(self.unexpected(column, "a name")),
            name => Ok(name.to_owned()),
        }
    }

    fn part(&self, part: Part) -> &str {
        self.parts[part as usize].and_then(|place| self.record.get(place)).unwrap_or_default().trim()
    }

    fn origin(&self) -> Result<Option<Origin>, RowError> {
        Origin::read(|part| self.part(part)).map_err(|(part, expected)| {
            let found: String = self.part(part).chars().take(40).collect();
            match part {
                Part::Version if found.parse::<u32>().is_ok_and(|v| v > super::FORMAT) => {
                    RowError::Later { line: self.line, found }
                }
                _ => RowError::Cell { line: self.line, column: part.name(), found, expected },
            }
        })
    }

    fn row(&self) -> Result<Row, RowError> {
        Ok(Row {
            set: self.name(Column::Set)?,
            index: self.parse(Column::Index, "a whole number from 0")?,
            seed: self.parse(Column::Seed, "a whole number from 0")?,
            method: self.name(Column::Method)?,
            // Shortest digits of an f32 are not those of the f64 beside it.
            eta: self.number(Column::Eta).and_then(|_| self.parse(Column::Eta, "a finite number"))?,
            squared_error: self.number(Column::SquaredError)?,
            detection: self.maybe(Column::Detection)?,
            false_alarm: self.number(Column::FalseAlarm)?,
            detection_at_printed: self.maybe(Column::DetectionAtPrinted)?,
            milliseconds: self.number(Column::Milliseconds)?,
            objects: self.count(Column::Objects)?,
            reflectors: self.count(Column::Reflectors)?,
            missed: self.count(Column::Missed)?,
            ghosts: self.count(Column::Ghosts)?,
            nearest_pair_columns: self.maybe(Column::NearestPairColumns)?,
            nearest_pair_bins: self.maybe(Column::NearestPairBins)?,
            min_range_metres: self.maybe(Column::MinRangeMetres)?,
            strongest_over_weakest_db: self.maybe(Column::StrongestOverWeakestDb)?,
            found: self.maybe_count(Column::Found)?,
            merged: self.maybe_count(Column::Merged)?,
            wrong_tooth: self.maybe_count(Column::WrongTooth)?,
            echoes: self.echoes()?,
            doubt: self.maybe(Column::Doubt)?,
            within_doubt: self.maybe(Column::WithinDoubt)?,
            cfar: self.cfar()?,
            origin: None,
        })
    }
}

fn of_csv(error: csv::Error) -> RowError {
    let line = error.position().map_or(1, csv::Position::line);
    match error.into_kind() {
        csv::ErrorKind::Io(error) => match error.downcast::<LongLine>() {
            Ok(LongLine { line }) => {
                RowError::Line { line, message: format!("is longer than {MAX_LINE_BYTES} bytes; expected a row") }
            }
            Err(error) => RowError::Io(error),
        },
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            RowError::Line { line, message: format!("has {len} cells; expected {expected_len}, as in the first line") }
        }
        csv::ErrorKind::Utf8 { .. } => RowError::Line { line, message: "is not text; expected CSV in UTF-8".into() },
        other => RowError::Line { line, message: format!("{other:?}") },
    }
}
