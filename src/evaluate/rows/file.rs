//! Rows written and read as CSV, with faults that name the line and the column.

use super::lines::{LongLine, MAX_LINE_BYTES, MAX_ROWS, ShortLines};
use super::{CellKind, Column, FORMAT, Row};
use csv::StringRecord;
use std::collections::HashSet;
use std::io::{self, Read, Write};

/// The file's first line.
pub fn header() -> String {
    Column::all().map(Column::name).collect::<Vec<_>>().join(",") + "\n"
}

/// A writer whose [`csv::Writer::serialize`] writes a row as a line; `begins` writes the names of the columns first. [`csv::Writer::flush`]
/// after a row hands on whole lines, so that a run that is stopped keeps its rows.
/// # Errors
/// [`io::Error`] of `out`.
pub fn row_writer<W: Write>(mut out: W, begins: bool) -> io::Result<csv::Writer<W>> {
    if begins {
        out.write_all(header().as_bytes())?;
    }
    Ok(csv::WriterBuilder::new().has_headers(false).from_writer(out))
}

/// Writes a whole table.
/// # Errors
/// [`io::Error`] of `out`.
pub fn write_rows<'a>(out: impl Write, rows: impl IntoIterator<Item = &'a Row>) -> io::Result<()> {
    let mut writer = row_writer(out, true)?;
    rows.into_iter().try_for_each(|row| writer.serialize(row))?;
    writer.flush()
}

/// The rows of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RowTable {
    /// The rows of whole lines.
    pub rows: Vec<Row>,
    /// Whether the file ends within a line, since its writer was stopped or the file was cut.
    pub is_cut: bool,
    /// Number of bytes of the whole lines.
    pub whole_bytes: u64,
}

/// Reads a table of [`write_rows`], also in format 1 and before. Columns may stand in any order, and others beside them; those that are
/// [optional](Column::is_optional) may be missing.
/// # Errors
/// The message names the line and the column.
pub fn read_rows(input: impl Read) -> Result<Vec<Row>, String> {
    read(ShortLines::new(input, false)).map(|table| table.rows)
}

/// [`read_rows`] without a last line that has no end, which may hold half a row.
/// # Errors
/// As [`read_rows`].
pub fn read_table(input: impl Read) -> Result<RowTable, String> {
    read(ShortLines::new(input, true))
}

fn read(mut lines: ShortLines<impl Read>) -> Result<RowTable, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(&mut lines);
    let header = reader.headers().map_err(of_csv)?.clone();
    if let Some(missing) = Column::all().find(|column| !column.is_optional() && place(&header, *column).is_none()) {
        let (missing, expected) = (missing.name(), self::header());
        return Err(format!("line 1: there is no column \"{missing}\"; expected {}", expected.trim_end()));
    }
    let (mut rows, mut record, mut texts) = (Vec::new(), StringRecord::new(), HashSet::new());
    while reader.read_record(&mut record).map_err(of_csv)? {
        if rows.len() == MAX_ROWS {
            return Err(format!("there are more than {MAX_ROWS} rows; split the file"));
        }
        let mut row: Row = record.deserialize(Some(&header)).map_err(|error| of_cells(&header, &record, error))?;
        if let Some(found) = row.version.filter(|version| *version > FORMAT) {
            let told = format!("the row is of format {found}; this program reads up to format {FORMAT}");
            return Err(format!("line {}: {told}", line(&record)));
        }
        row.check().map_err(|(column, expected)| of_cell(&header, &record, column, expected))?;
        row.share(&mut texts);
        rows.push(row);
    }
    drop(reader);
    Ok(RowTable { rows, is_cut: lines.is_cut, whole_bytes: lines.whole_bytes })
}

fn place(header: &StringRecord, column: Column) -> Option<usize> {
    header.iter().position(|name| name == column.name())
}

fn line(record: &StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

fn of_cell(header: &StringRecord, record: &StringRecord, column: Column, expected: &str) -> String {
    let found = place(header, column).and_then(|place| record.get(place)).unwrap_or_default();
    let found: String = found.chars().take(40).collect();
    format!("line {}, column {}: \"{found}\"; expected {expected}", line(record), column.name())
}

fn of_cells(header: &StringRecord, record: &StringRecord, error: csv::Error) -> String {
    for column in Column::all() {
        let Some(cell) = place(header, column).and_then(|place| record.get(place)) else { continue };
        let [name, alone] = [column.name(), cell].map(|text| StringRecord::from(vec![text]));
        let Err(error) = alone.deserialize::<Row>(Some(&name)) else { continue };
        let said = match error.kind() {
            csv::ErrorKind::Deserialize { err, .. } => err.kind().to_string(),
            _ => error.to_string(),
        };
        let expected = match column.kind() {
            CellKind::Whole => "a whole number from 0",
            CellKind::Real => "a finite number",
            CellKind::Text => said.rsplit_once("expected ").map_or(said.as_str(), |(_, expected)| expected),
        };
        return of_cell(header, record, column, expected);
    }
    format!("line {}: {error}", line(record))
}

fn of_csv(error: csv::Error) -> String {
    let line = error.position().map_or(1, csv::Position::line);
    match error.into_kind() {
        csv::ErrorKind::Io(error) => match error.downcast::<LongLine>() {
            Ok(LongLine { line }) => format!("line {line}: is longer than {MAX_LINE_BYTES} bytes; expected a row"),
            Err(error) => error.to_string(),
        },
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("line {line}: has {len} cells; expected {expected_len}, as in the first line")
        }
        csv::ErrorKind::Utf8 { .. } => format!("line {line}: is not text; expected CSV in UTF-8"),
        other => format!("line {line}: {other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{made, row};
    use super::super::{EchoCounts, Text};
    use super::*;
    use crate::maps::cfar::Cfar;
    use crate::radar::{Carrier, Decibels};
    use crate::signal::Floor;
    use proptest::prelude::*;

    fn text(rows: &[Row]) -> String {
        let mut out = Vec::new();
        write_rows(&mut out, rows).unwrap();
        String::from_utf8(out).unwrap()
    }

    fn error(text: &str) -> String {
        read_rows(text.as_bytes()).unwrap_err().to_string()
    }

    fn with_columns(table: &str, names: &[&str]) -> String {
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let header = reader.headers().unwrap().clone();
        let places: Vec<usize> = names.iter().filter_map(|name| header.iter().position(|n| n == *name)).collect();
        let mut out = csv::Writer::from_writer(Vec::new());
        for record in std::iter::once(header).chain(reader.records().map(Result::unwrap)) {
            out.write_record(places.iter().map(|place| &record[*place])).unwrap();
        }
        String::from_utf8(out.into_inner().unwrap()).unwrap()
    }

    fn names() -> Vec<&'static str> {
        Column::all().map(Column::name).collect()
    }

    fn some_text() -> impl Strategy<Value = Text> {
        // Quotes, separators and ends of lines; blanks around a cell are not kept.
        "[a-z%;,\"\u{e9}][ -~\n]{0,12}[a-z\",;]".prop_map(Text::from)
    }

    fn figure() -> impl Strategy<Value = f64> {
        any::<f64>().prop_filter("finite", |v| v.is_finite())
    }

    prop_compose! {
        fn rows()(
            [set, method, program, radar, weights] in prop::array::uniform5(some_text()),
            (index, seed, objects) in any::<(u32, u64, usize)>(),
            eta in any::<f32>().prop_filter("finite", |v| v.is_finite()),
            [squared_error, milliseconds, false_alarm] in prop::array::uniform3(figure()),
            [detection, doubt, nearest] in prop::array::uniform3(prop::option::of(figure())),
            echoes in prop::option::of(prop::array::uniform6(0usize..9)),
            is_of_folder in any::<bool>(),
            (snr, part) in (-100.0..300.0f64, 0u32..9),
        ) -> Row {
            let generated = Row {
                floor: Some(Floor::Snr(Decibels(snr))),
                shard: format!("{part}/9").parse().ok(),
                cfar: Text::from(Cfar::default()),
                cfar_detection: detection,
                cfar_false_alarm: Some(false_alarm),
                ..made("1", 0, "live")
            };
            let files = Row { purpose: None, reading: None, carrier: None, scenes: "ab".into(), ..made("own", 0, "live") };
            Row {
                set, method, program, radar, weights, index, seed, objects, eta,
                squared_error, milliseconds, false_alarm, detection, doubt,
                nearest_pair_bins: nearest,
                wrong_tooth: nearest.map(|_| objects),
                echoes: echoes.map(EchoCounts),
                echoes_found: echoes.map(|echoes| EchoCounts(echoes.map(|count| count / 2))),
                ..if is_of_folder { files } else { generated }
            }
        }
    }

    proptest! {
        #[test]
        fn rows_are_read_as_they_were_written(
            rows in prop::collection::vec(rows(), 0..5),
            order in Just(names()).prop_shuffle(),
        ) {
            let table = text(&rows);
            prop_assert_eq!(read_rows(table.as_bytes()).unwrap(), rows.clone());
            prop_assert_eq!(read_rows(with_columns(&table, &order).as_bytes()).unwrap(), rows, "columns in any order");
        }
    }

    #[test]
    fn cells_stand_below_the_names_that_serde_gives_them() {
        let mut out = csv::Writer::from_writer(Vec::new());
        out.serialize(made("1", 0, "live")).unwrap();
        assert_eq!(out.into_inner().unwrap(), text(&[made("1", 0, "live")]).into_bytes());
        assert_eq!(text(&[]), header());
    }

    #[test]
    fn a_lacking_column_is_named_unless_it_is_optional() {
        let rows = [row("1", 0, "live")];
        for column in Column::all() {
            let others: Vec<&str> = names().into_iter().filter(|name| *name != column.name()).collect();
            match read_rows(with_columns(&text(&rows), &others).as_bytes()) {
                Ok(read) => {
                    let lacks = Column::all().find(|c| !c.is_same(&read[0], &rows[0]));
                    assert!(column.is_optional() && lacks.is_none_or(|c| c == column), "{column:?} {lacks:?}");
                }
                Err(error) => {
                    let named = error.to_string().contains(&format!("\"{}\"", column.name()));
                    // Echoes are counted in pairs.
                    assert!(named || matches!(column, Column::Echoes | Column::EchoesFound), "{error}");
                }
            }
        }
        let made = text(&[made("1", 0, "live")]);
        let without: Vec<&str> = names().into_iter().filter(|name| *name != "floor").collect();
        let expected = "line 2, column floor: \"\"; expected a floor as --floor takes it";
        assert_eq!(error(&with_columns(&made, &without)), expected);
        assert!(error("").contains("no column \"set\""));
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
        // An editor may leave the end out.
        assert_eq!(read_rows(&whole.as_bytes()[..whole.len() - 1]).unwrap().len(), 2);
    }

    #[test]
    fn what_made_a_row_is_checked_cell_by_cell() {
        let good = made("1", 0, "live");
        let table = |column: Column, cell: &str| {
            let table = text(std::slice::from_ref(&good));
            let mut reader = csv::Reader::from_reader(table.as_bytes());
            let cells: Vec<String> = reader.records().next().unwrap().unwrap().iter().map(str::to_owned).collect();
            let cells = Column::all().zip(cells).map(|(c, own)| if c == column { cell.to_owned() } else { own });
            format!("{}{}\n", header(), cells.collect::<Vec<_>>().join(","))
        };
        assert_eq!(read_rows(table(Column::Program, "0.3.0").as_bytes()).unwrap()[0].program, "0.3.0");
        for (column, cell) in [
            (Column::Floor, "rock"),
            (Column::Normalisation, ""),
            (Column::Carrier, "three-way"),
            (Column::Purpose, "file"),
            (Column::Reading, "loud"),
            (Column::Shard, "4/4"),
            (Column::Whole, "1 times 4"),
            (Column::Cfar, "ca:rate=1"),
            (Column::Version, "new"),
            (Column::Version, "0"),
        ] {
            let told = error(&table(column, cell));
            assert!(told.starts_with(&format!("line 2, column {}: \"{cell}\"; expected ", column.name())), "{told}");
        }
        assert!(error(&table(Column::Floor, "rock")).contains("expected thesis, exact"));
        let wanted = "line 2: the row is of format 3; this program reads up to format 2";
        assert_eq!(error(&table(Column::Version, "3")), wanted);
        let files = table(Column::Carrier, "file").replace(",test,program,file,", ",file,file,file,");
        let files = read_rows(files.as_bytes()).unwrap();
        assert_eq!((files[0].carrier, files[0].is_generated(), good.carrier), (None, false, Some(Carrier::OneWay)));
    }

    #[test]
    fn faults_name_their_place() {
        let good = text(&[row("1", 0, "live"), row("1", 1, "live")]);
        let wanted = "line 3, column squared_error: \"inf\"; expected a finite number";
        assert_eq!(error(&good.replace("34.333333333333336", "inf")), wanted);
        assert!(error(&good.replacen(",7,", ",-7,", 1)).starts_with("line 2, column seed: \"-7\"; expected a whole"));
        assert!(error(&format!("{good}1,2,3\n")).starts_with("line 4: has 3 cells; expected 45"));
        assert!(error(&good.replacen("1 0 0 1 0 0", "1 0 0 3 0 0", 1)).starts_with("line 2, column echoes_found: "));
        assert!(error(&good.replacen("1 0 0 2 0 4", "1 0 0", 1)).starts_with("line 2, column echoes: \"1 0 0\""));
        let half = Row { cfar_detection: Some(0.5), ..row("1", 0, "live") };
        assert!(error(&text(&[half])).starts_with("line 2, column cfar_false_alarm: \"\"; expected a rate"));
        let twice = good.replacen("set,", "set,set,", 1).replace("\n1,", "\n1,1,");
        assert!(error(&twice).starts_with("line 2: ") && error(&twice).contains("duplicate"), "{}", error(&twice));
        let long = format!("{good}{}", "x".repeat(1 << 20));
        assert_eq!(error(&long), "line 4: is longer than 65536 bytes; expected a row");
        let binary = [good.as_bytes(), b"\xff\xfe,".repeat(44).as_slice(), b"\n"].concat();
        assert!(read_rows(binary.as_slice()).unwrap_err().to_string().contains("is not text"));
    }
}
