//! Rows written as CSV. `read` reads them.

use super::part::Part;
use super::{Column, Row};
use std::io::{self, Write};

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
            maybe(self.within_doubt),
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

#[cfg(test)]
mod tests {
    use super::super::origin::Origin;
    use super::super::origin::tests::origin;
    use super::super::part::Part;
    use super::super::read::{read_rows, read_table};
    use super::super::tests::row;
    use super::super::{CfarRates, Row};
    use super::write_rows;
    use std::sync::Arc;

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
             found,merged,wrong_tooth,echoes,echoes_found,doubt,within_doubt,version,program,floor,normalisation,purpose,reading,carrier,radar,scenes,weights,optimiser,\
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
        let of = |doubt| Row {
            origin: Some(Arc::new(origin())),
            doubt,
            within_doubt: doubt.map(|v| v / 2.0),
            ..row("1", 0, "live")
        };
        let table = text(&[of(Some(0.125)), of(None)]);
        let old = table
            .replace("doubt,within_doubt,", "")
            .replace(",0.125,0.0625,1,", ",1,")
            .replace(",,,1,0.1.0", ",1,0.1.0");
        assert_eq!(old.len(), table.len() - 34, "both columns are cut out");
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
        let old = |line: &str| line.rsplitn(8 + Part::ALL.len() - 1, ',').last().unwrap().to_owned();
        let table = text(&[row("1", 0, "live")]);
        let table: String = table.lines().map(|line| old(line) + "\n").collect();
        assert!(table.lines().next().unwrap().ends_with("strongest_over_weakest_db"));
        let without =
            Row { found: None, merged: None, echoes: None, doubt: None, within_doubt: None, ..row("1", 0, "live") };
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
        assert!(error(&format!("{good}1,2,3\n")).starts_with("line 4: has 3 cells; expected 39"));
        assert!(error(&good.replacen("1 0 0 1 0 0", "1 0 0 3 0 0", 1)).starts_with("line 2, column echoes_found: "));
        assert!(error("").contains("no column \"set\""));
        let long = format!("{good}{}", "x".repeat(1 << 20));
        assert_eq!(error(&long), "line 4: is longer than 65536 bytes; expected a row");
        let binary = [good.as_bytes(), b"\xff\xfe,".repeat(34).as_slice()].concat();
        assert!(read_rows(binary.as_slice()).is_err());
    }
}
