//! Rows as CSV.

use super::super::echoes::EchoTally;
use super::lines::{LongLine, MAX_LINE_BYTES, ShortLines};
use super::origin::{Origin, Part};
use super::{CfarRates, Column, MAX_ROWS, Row};
use std::io::{self, Read, Write};
use std::sync::Arc;

impl Row {
    /// The cells as they are written: every figure with all its digits, so that it is read back as it was.
    fn cells(&self) -> [String; Column::ALL.len()] {
        fn maybe<V: std::fmt::Debug>(v: Option<V>) -> String {
            v.map(|v| format!("{v:?}")).unwrap_or_default()
        }
        let [echoes, echoes_found] = self.echoes.map(|echoes| echoes.texts()).unwrap_or_default();
        [
            self.set.clone(),
            self.index.to_string(),
            self.seed.to_string(),
            self.method.clone(),
            format!("{:?}", self.eta),
            format!("{:?}", self.squared_error),
            maybe(self.detection),
            format!("{:?}", self.false_alarm),
            maybe(self.detection_at_printed),
            format!("{:?}", self.milliseconds),
            self.objects.to_string(),
            self.reflectors.to_string(),
            self.missed.to_string(),
            self.ghosts.to_string(),
            maybe(self.nearest_pair_columns),
            maybe(self.nearest_pair_bins),
            maybe(self.min_range_metres),
            maybe(self.strongest_over_weakest_db),
            maybe(self.found),
            maybe(self.merged),
            maybe(self.wrong_tooth),
            echoes,
            echoes_found,
            maybe(self.doubt),
            maybe(self.cfar.and_then(|rates| rates.detection)),
            maybe(self.cfar.map(|rates| rates.false_alarm)),
        ]
    }

    /// Whether a detector of constant false-alarm rate was tried too.
    fn has_cfar(&self) -> bool {
        self.cfar.is_some() || self.origin.as_ref().is_some_and(|origin| origin.cfar.is_some())
    }
}

/// Which columns a file has: those of a detector of constant false-alarm rate only where there is one.
fn has_column(column: Column, has_cfar: bool) -> bool {
    has_cfar || !column.is_of_cfar()
}

fn has_part(part: Part, has_cfar: bool) -> bool {
    has_cfar || part != Part::Cfar
}

/// The names in a file's first line, with those of a detector of constant false-alarm rate or without.
pub fn header(has_cfar: bool) -> Vec<&'static str> {
    let columns = Column::ALL.into_iter().filter(|column| has_column(*column, has_cfar)).map(Column::name);
    columns.chain(Part::ALL.into_iter().filter(|part| has_part(*part, has_cfar)).map(Part::name)).collect()
}

/// Writes rows, a line each, under a line of names. [`RowWriter::flush`] after a row hands on whole lines, so that a run that is stopped
/// keeps what it has found.
pub struct RowWriter<W: Write> {
    out: csv::Writer<W>,
    has_cfar: bool,
}

impl<W: Write> RowWriter<W> {
    /// Begins with the names, [`header`] of `has_cfar`.
    ///
    /// # Errors
    /// What `out` says.
    pub fn new(out: W, has_cfar: bool) -> io::Result<Self> {
        let mut out = csv::Writer::from_writer(out);
        out.write_record(header(has_cfar))?;
        Ok(RowWriter { out, has_cfar })
    }

    /// Goes on beneath rows that [`RowWriter::new`] and [`RowWriter::add`] wrote.
    pub fn beneath(out: W, has_cfar: bool) -> Self {
        RowWriter { out: csv::Writer::from_writer(out), has_cfar }
    }

    /// Adds a row.
    ///
    /// # Errors
    /// What `out` says.
    pub fn add(&mut self, row: &Row) -> io::Result<()> {
        let origin = row.origin.as_deref();
        let text = |part| origin.map(|origin| origin.text(part)).unwrap_or_default();
        let parts = Part::ALL.into_iter().filter(|part| has_part(*part, self.has_cfar)).map(text);
        let cells = row.cells().into_iter().zip(Column::ALL);
        let cells = cells.filter(|(_, column)| has_column(*column, self.has_cfar)).map(|(cell, _)| cell);
        Ok(self.out.write_record(cells.chain(parts))?)
    }

    /// Hands on what was added.
    ///
    /// # Errors
    /// What `out` says.
    pub fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Writes a whole table.
///
/// # Errors
/// What `out` says.
pub fn write_rows<'a>(out: impl Write, rows: impl IntoIterator<Item = &'a Row>) -> io::Result<()> {
    let rows: Vec<&Row> = rows.into_iter().collect();
    let mut writer = RowWriter::new(out, rows.iter().any(|row| row.has_cfar()))?;
    rows.into_iter().try_for_each(|row| writer.add(row))?;
    writer.flush()
}

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

/// Reads what [`write_rows`] wrote. Columns may stand in any order, and others beside them; those that are
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

#[cfg(test)]
mod tests {
    use super::super::origin::tests::origin;
    use super::super::tests::row;
    use super::*;

    fn text(rows: &[Row]) -> String {
        let mut out = Vec::new();
        write_rows(&mut out, rows).unwrap();
        String::from_utf8(out).unwrap()
    }

    fn error(text: &str) -> String {
        read_rows(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn rows_are_read_as_they_were_written() {
        let origin = Some(Arc::new(origin()));
        let rows = vec![
            row("1", 0, "live"),
            Row { origin: origin.clone(), ..row("a \"folder\", with all", 1, "nomp") },
            Row { origin, ..row("1", 2, "live") },
        ];
        assert_eq!(read_rows(text(&rows).as_bytes()).unwrap(), rows);
        assert!(text(&rows).starts_with(
            "set,index,seed,method,eta,squared_error,detection,false_alarm,detection_at_printed,milliseconds,objects,\
             reflectors,missed,ghosts,nearest_pair_columns,nearest_pair_bins,min_range_metres,strongest_over_weakest_db,\
             found,merged,wrong_tooth,echoes,echoes_found,doubt,version,program,floor,normalisation,purpose,reading,carrier,radar,scenes,weights,optimiser,\
             shard,whole,methods\n"
        ));
    }

    #[test]
    fn columns_may_stand_in_any_order() {
        let table = text(&[row("1", 0, "live")]);
        let turned: String = table
            .lines()
            .map(|line| line.split(',').rev().chain(["note"]).collect::<Vec<_>>().join(",") + "\r\n")
            .collect();
        assert_eq!(read_rows(turned.as_bytes()).unwrap(), [row("1", 0, "live")]);
    }

    #[test]
    fn tables_from_before_echoes_were_counted_are_read() {
        let table = text(&[Row { origin: Some(Arc::new(origin())), ..row("1", 0, "live") }]);
        let old = table.replace("echoes,echoes_found,", "").replace("1 0 0 2 0 4,1 0 0 1 0 0,", "");
        assert_eq!(old.len(), table.len() - 44, "both columns are cut out");
        let read = read_rows(old.as_bytes()).unwrap();
        assert_eq!(read[0].echoes, None);
        assert_eq!(
            Row { echoes: row("1", 0, "live").echoes, ..read[0].clone() },
            read_rows(table.as_bytes()).unwrap()[0]
        );
    }

    #[test]
    fn tables_from_before_doubt_was_kept_are_read() {
        let of = |doubt| Row { origin: Some(Arc::new(origin())), doubt, ..row("1", 0, "live") };
        let table = text(&[of(Some(0.125)), of(None)]);
        let old = table.replace("doubt,", "").replace(",0.125,1,", ",1,").replace(",,1,0.1.0", ",1,0.1.0");
        assert_eq!(old.len(), table.len() - 13, "the column is cut out");
        assert_eq!(read_rows(old.as_bytes()).unwrap(), [of(None), of(None)]);
        assert_eq!(read_rows(table.as_bytes()).unwrap(), [of(Some(0.125)), of(None)]);
    }

    #[test]
    fn columns_of_a_detector_are_written_where_there_is_one() {
        let with = |cfar: &str| Some(Arc::new(Origin { cfar: Some(cfar.parse().unwrap()), ..origin() }));
        let rates = |detection| Some(CfarRates { detection, false_alarm: 1.0 / 3.0 });
        let rows = vec![
            Row { cfar: rates(Some(0.1)), origin: with("os:rate=0.01"), ..row("1", 0, "live") },
            Row { cfar: rates(None), origin: with("os:rate=0.01"), ..row("1", 1, "live") },
        ];
        assert_eq!(read_rows(text(&rows).as_bytes()).unwrap(), rows);
        let first = text(&rows).lines().next().unwrap().to_owned();
        assert!(
            first.contains(",cfar_detection,cfar_false_alarm,version,") && first.ends_with(",methods,cfar"),
            "{first}"
        );
        assert!(!text(&[row("1", 0, "live")]).contains("cfar"));
        let half = text(&rows).replace("0.1,0.3333333333333333", "0.1,");
        assert!(error(&half).contains("column cfar_false_alarm"), "{}", error(&half));
    }

    #[test]
    fn tables_from_before_the_kinds_were_counted_are_read() {
        let old = |line: &str| line.rsplitn(7 + Part::ALL.len() - 1, ',').last().unwrap().to_owned();
        let table = text(&[row("1", 0, "live")]);
        let table: String = table.lines().map(|line| old(line) + "\n").collect();
        assert!(table.lines().next().unwrap().ends_with("strongest_over_weakest_db"));
        let without = Row { found: None, merged: None, echoes: None, doubt: None, ..row("1", 0, "live") };
        assert_eq!(read_rows(table.as_bytes()).unwrap(), [without]);
    }

    #[test]
    fn a_last_line_without_an_end_is_left_out() {
        let whole = text(&[row("1", 0, "live"), row("1", 1, "live")]);
        let first = whole.lines().take(2).map(|line| line.len() + 1).sum::<usize>();
        for cut in first + 1..whole.len() {
            let table = read_table(&whole.as_bytes()[..cut]).unwrap();
            assert_eq!((table.rows.len(), table.is_cut, table.whole_bytes), (1, true, first as u64), "{cut}");
        }
        let table = read_table(whole.as_bytes()).unwrap();
        assert_eq!((table.rows.len(), table.is_cut, table.whole_bytes), (2, false, whole.len() as u64));
        assert_eq!(
            read_rows(&whole.as_bytes()[..whole.len() - 1]).unwrap().len(),
            2,
            "an editor may leave the end out"
        );
    }

    #[test]
    fn rows_of_a_later_format_are_refused() {
        let origin = Some(Arc::new(origin()));
        let table = text(&[Row { origin, ..row("1", 0, "live") }]);
        assert_eq!(
            error(&table.replace(",1,0.1.0,", ",2,0.1.0,")),
            "line 2: the row is of format 2; this program reads up to format 1"
        );
        assert!(error(&table.replace(",thesis,", ",rock,")).starts_with("line 2, column floor: \"rock\""));
    }

    #[test]
    fn faults_name_their_place() {
        let good = text(&[row("1", 0, "live"), row("1", 1, "live")]);
        assert_eq!(
            error(&good.replace("34.333333333333336", "inf")),
            "line 3, column squared_error: \"inf\"; expected a finite number"
        );
        assert!(error(&good.replacen(",7,", ",-7,", 1)).starts_with("line 2, column seed: \"-7\""));
        assert!(error(&good.replace("ghosts", "spirits")).contains("no column \"ghosts\""));
        assert!(error(&format!("{good}1,2,3\n")).starts_with("line 4: has 3 cells; expected 38"));
        assert!(error(&good.replacen("1 0 0 1 0 0", "1 0 0 3 0 0", 1)).starts_with("line 2, column echoes_found: "));
        assert!(error("").contains("no column \"set\""));
        let long = format!("{good}{}", "x".repeat(1 << 20));
        assert_eq!(error(&long), "line 4: is longer than 65536 bytes; expected a row");
        let binary = [good.as_bytes(), b"\xff\xfe,".repeat(34).as_slice()].concat();
        assert!(read_rows(binary.as_slice()).is_err());
    }
}
