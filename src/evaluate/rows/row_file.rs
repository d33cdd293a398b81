//! The file of rows that a run appends to and resumes from.

use super::{Column, Row, RowTable, Text, WHY_NO_OTHER_FORMAT, header, merge, read_table, row_writer, write_rows};
use crate::files::{ends_in, write_atomically};
use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// The reason why a file of rows can't be read or isn't written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum RowFileError {
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: io::Error },
    /// The file has content that would be lost. The caller adds how to overwrite it.
    #[error("{}: {why}", path.display())]
    Other { path: PathBuf, why: String },
    #[error("{}: another run writes it; wait for that run, or name another file", _0.display())]
    Busy(PathBuf),
    #[error("{0}")]
    Merge(String),
}

fn on_file(path: &Path) -> impl FnOnce(io::Error) -> RowFileError {
    move |source| RowFileError::File { path: path.to_owned(), source }
}

/// Set, number of the scene, and method of a row.
pub type RowIdentity = (Text, u32, Text);

/// Set, scene and method of a row, which no other row of its run has together.
pub fn row_identity(row: &Row) -> RowIdentity {
    (row.set.clone(), row.index, row.method.clone())
}

/// The rows that belong to a run.
pub struct RunRows {
    empty: HashMap<(Text, Text), Row>,
}

impl RunRows {
    /// The rows of a run, from its [`Campaign::empty_rows`](crate::evaluate::campaign::Campaign::empty_rows).
    pub fn new(empty: &[Vec<Row>]) -> RunRows {
        let named = |row: &Row| ((row.set.clone(), row.method.clone()), row.clone());
        RunRows { empty: empty.iter().flatten().map(named).collect() }
    }

    fn foreign(&self, row: &Row) -> Option<String> {
        if row.version.is_none() {
            return Some("its rows don't say what made them: an older program wrote them".to_owned());
        }
        let Some(own) = self.empty.get(&(row.set.clone(), row.method.clone())) else {
            return Some(format!("it holds rows of set {} by {}, which this run doesn't make", row.set, row.method));
        };
        let mut columns = Column::ORIGIN.iter().chain([&Column::Seed]);
        if let Some(column) = columns.find(|column| !column.is_same(row, own)) {
            let [there, here] = [row, own].map(|row| column.text(row)).map(|text| match text.is_empty() {
                true => "nothing".to_owned(),
                false => text,
            });
            let why = if *column == Column::Version { format!(": {WHY_NO_OTHER_FORMAT}") } else { String::new() };
            let name = column.name();
            return Some(format!("it holds rows of another run: {name} is {there} there and {here} here{why}"));
        }
        let count = own.whole_run().and_then(|whole| whole.sets.into_iter().find(|(set, _)| row.set == set.as_str()));
        let is_own = count.is_some_and(|(_, count)| row.index < count)
            && own.shard.is_some_and(|shard| shard.contains(row.index));
        (!is_own).then(|| format!("it holds scene {} of set {}, which this run doesn't have", row.index, row.set))
    }
}

/// A file that rows are appended to, each a whole line as soon as it is found.
pub struct RowFile {
    path: PathBuf,
    out: csv::Writer<File>,
    /// The rows that were there already.
    pub present: Vec<Row>,
    appended: Vec<Row>,
    failed: Option<io::Error>,
}

impl RowFile {
    /// Opens the file, or creates it. Rows of the same run stay and half a last line is cut; `overwrite` replaces any content.
    /// # Errors
    /// [`RowFileError`] for a file that holds anything else, and for one that another process writes.
    pub fn open(path: &Path, wanted: &RunRows, overwrite: bool) -> Result<RowFile, RowFileError> {
        if path.exists() && !path.is_file() {
            let source = io::Error::new(io::ErrorKind::InvalidInput, "is no file; expected the name of a file");
            return Err(on_file(path)(source));
        }
        if ends_in(path, &["parquet"]) {
            let why = "rows are appended to a CSV file; expected a name that ends in .csv";
            return Err(on_file(path)(io::Error::new(io::ErrorKind::InvalidInput, why)));
        }
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(on_file(path))?;
        // On a system without locks the file is written without one.
        if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(RowFileError::Busy(path.to_owned()));
        }
        let table = if overwrite { RowTable::default() } else { present(path, &file, wanted)? };
        file.set_len(table.whole_bytes).map_err(on_file(path))?;
        file.seek(SeekFrom::End(0)).map_err(on_file(path))?;
        let out = row_writer(file, table.whole_bytes == 0).map_err(on_file(path))?;
        Ok(RowFile { path: path.to_owned(), out, present: table.rows, appended: Vec::new(), failed: None })
    }

    /// Appends a row and tells whether that succeeded; the error is [`RowFile::failure`].
    pub fn append(&mut self, row: &Row) -> bool {
        let wrote = self.out.serialize(row).map_err(io::Error::from).and_then(|()| self.out.flush());
        self.appended.push(row.clone());
        self.failed = self.failed.take().or(wrote.err());
        self.failed.is_none()
    }

    /// The first error of appending; `None` where there was none.
    pub fn failure(&mut self) -> Option<RowFileError> {
        self.failed.take().map(on_file(&self.path))
    }

    /// All rows, in the order of a run that was never stopped, in which they are also written to the file.
    /// # Errors
    /// [`RowFileError`] for a file that can't be written.
    pub fn finish(self) -> Result<Vec<Row>, RowFileError> {
        let RowFile { path, out, present, appended, .. } = self;
        drop(out);
        let all: Vec<Row> = present.into_iter().chain(appended).collect();
        let sorted = merge(vec![(path.display().to_string(), all.clone())]).map_err(RowFileError::Merge)?;
        if sorted != all {
            write_atomically(&path, |out| write_rows(out, &sorted)).map_err(on_file(&path))?;
        }
        Ok(sorted)
    }
}

fn refused(path: &Path, why: &str) -> RowFileError {
    RowFileError::Other { path: path.to_owned(), why: why.to_owned() }
}

fn present(path: &Path, mut file: &File, wanted: &RunRows) -> Result<RowTable, RowFileError> {
    let header = header();
    let mut start = Vec::new();
    file.take(header.len() as u64).read_to_end(&mut start).map_err(on_file(path))?;
    file.rewind().map_err(on_file(path))?;
    if start.len() < header.len() && header.as_bytes().starts_with(&start) {
        return Ok(RowTable::default());
    }
    let table = read_table(file).map_err(|e| refused(path, &e.to_string()))?;
    let mut seen = HashSet::new();
    for row in &table.rows {
        let twice = || format!("it holds scene {} of set {} by {} twice", row.index, row.set, row.method);
        let wrong = wanted.foreign(row).or_else(|| (!seen.insert(row_identity(row))).then(twice));
        if let Some(why) = wrong {
            return Err(refused(path, &why));
        }
    }
    if start != header.as_bytes() {
        return Err(refused(path, "its columns are not those that rows would be appended under"));
    }
    Ok(table)
}

/// Writes merged rows, unless a file is there whose rows are not among them.
/// # Errors
/// [`RowFileError`] for a file that holds anything else, and for one that can't be written.
pub fn write_merged(path: &Path, rows: &[Row], overwrite: bool) -> Result<(), RowFileError> {
    if path.is_file() && !overwrite {
        let file = File::open(path).map_err(on_file(path))?;
        let table = read_table(file).map_err(|e| refused(path, &e.to_string()))?;
        let figures = |row: &Row| (row_identity(row), row.seed, row.squared_error.to_bits());
        let merged: HashSet<_> = rows.iter().map(figures).collect();
        if let Some(row) = table.rows.iter().find(|row| !merged.contains(&figures(row))) {
            let why = format!("it holds other rows, scene {} of set {} by {} first", row.index, row.set, row.method);
            return Err(refused(path, &why));
        }
    }
    write_atomically(path, |out| write_rows(out, rows)).map_err(on_file(path))
}
