//! Files of rows: a CSV, and beside it a file of their conditions where these are not the usual ones.

use crate::app::jobs::background::Background;
use crate::app::state::Conditions;
use crate::evaluate::rows::{Column, Row, WHY_NO_OTHER_FORMAT, read_rows, write_rows};
use crate::files::{read_bounded, write_atomically, write_bytes};
use crate::platform::fs::{self, File};
use crate::radar::Radar;
use crate::scene::generate::{Purpose, Reading};
use std::fmt::Display;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Largest size of a file of conditions, bytes.
const MAX_CONDITIONS_BYTES: u64 = 64 << 10;

/// Rows and their conditions: floor, normalisation and radar.
pub type KeptRows = (Vec<Row>, Conditions);

/// The file of conditions beside the file `rows`.
fn beside(rows: &Path) -> PathBuf {
    rows.with_extension("conditions.toml")
}

/// Writes rows as CSV, and beside it their conditions where they are not those of `apertura evaluate`.
///
/// # Errors
/// The file that could not be written, and the reason.
pub fn write(path: &Path, rows: &[Row], conditions: &Conditions) -> Result<(), String> {
    let other = beside(path);
    if *conditions == Conditions::default() {
        if let Err(error) = fs::remove_file(&other)
            && error.kind() != io::ErrorKind::NotFound
        {
            return Err(told(&other)(error));
        }
    } else {
        let text = toml::to_string_pretty(conditions).map_err(told(&other))?;
        write_bytes(&other, text.as_bytes()).map_err(told(&other))?;
    }
    write_atomically(path, |out| write_rows(out, rows)).map_err(told(path))
}

/// An error with the file that it is about.
fn told<E: Display>(path: &Path) -> impl Fn(E) -> String {
    move |error| format!("{}: {error}", path.display())
}

/// Reads a file of rows written by [`write`] or `apertura evaluate --rows`.
///
/// # Errors
/// The file, the line and the text expected there.
pub fn read(path: &Path) -> Result<KeptRows, String> {
    let rows = read_rows(File::open(path).map_err(told(path))?).map_err(told(path))?;
    if rows.array_windows().any(|[a, b]| a.version != b.version) {
        return Err(told(path)(format!("these rows are of several formats; {WHY_NO_OTHER_FORMAT}")));
    }
    let other = beside(path);
    let conditions = match read_bounded(&other, MAX_CONDITIONS_BYTES) {
        Ok(bytes) => read_conditions(&bytes).map_err(told(&other))?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => conditions_of(&rows).map_err(told(path))?,
        Err(error) => return Err(told(&other)(error)),
    };
    Ok((rows, conditions))
}

/// The conditions named in the rows' own columns; the default where there are none.
fn conditions_of(rows: &[Row]) -> Result<Conditions, String> {
    let mut found: Option<Conditions> = None;
    let mut radar = Radar::default();
    let (own_floor, usual): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(|row| row.has_own_floor());
    for row in usual.into_iter().chain(own_floor) {
        let (Some(floor), Some(normalisation)) = (row.floor, row.normalisation) else { continue };
        if let Some(carrier) = row.carrier {
            if (row.purpose, row.reading) != (Some(Purpose::Test), Some(Reading::Program)) {
                let expected = "expected rows without --thesis-text";
                return Err(format!("these rows are not of the test scenes that the app makes; {expected}"));
            }
            if !row.radar.is_empty() {
                let expected = "expected its .conditions.toml beside them";
                return Err(format!("these rows are of another radar ({}); {expected}", row.radar));
            }
            radar.carrier = carrier;
        }
        let floor = match &found {
            // A set with its own floor doesn't depend on the others' floor.
            Some(found) if row.has_own_floor() => found.floor,
            _ => floor,
        };
        let own = Conditions { floor, normalisation, radar: radar.clone() };
        if found.as_ref().is_some_and(|found| (found.floor, found.normalisation) != (own.floor, own.normalisation)) {
            let expected = "expected rows that were made alike";
            return Err(format!("these rows were made over several floors or normalisations; {expected}"));
        }
        found = Some(own);
    }
    Ok(found.unwrap_or_default())
}

/// Whether the first line of a file names the columns of rows; false for a file that can't be read.
pub fn is_table_of_rows(path: &Path) -> bool {
    let mut line = String::new();
    let first = File::open(path).map(|file| BufReader::new(file.take(MAX_CONDITIONS_BYTES)).read_line(&mut line));
    let names: Vec<&str> = line.trim().split(',').collect();
    matches!(first, Ok(Ok(_))) && [Column::Method, Column::SquaredError].iter().all(|c| names.contains(&c.name()))
}

fn read_conditions(bytes: &[u8]) -> Result<Conditions, String> {
    let conditions: Conditions = toml::from_slice(bytes).map_err(|e| e.to_string())?;
    conditions.radar.validate().map_err(|e| e.to_string())?;
    Ok(conditions)
}

/// A finished read or write.
#[expect(clippy::large_enum_variant, reason = "one answer at a time is under way")]
pub enum Done {
    /// The rows of a file that was opened, or of the last session (`own`).
    Read {
        path: PathBuf,
        /// Whether it is the app's own.
        own: bool,
        kept: Result<KeptRows, String>,
    },
    /// The app's own file holds the rows of this version.
    Wrote(u64),
    /// The app's own file could not be written, for this reason.
    Unwritten(String),
}

/// Begins a read or write of rows on a thread of its own.
pub fn begin(files: &Background<Done>, work: impl FnOnce() -> Done + Send + 'static) {
    let failed = |why| Done::Unwritten(format!("failed: {why}"));
    if let Err(error) = files.begin("rows", work, failed) {
        tracing::error!("rows can't be read or written: {error}");
    }
}

#[cfg(test)]
mod tests {
    use super::super::some_row;
    use super::*;
    use crate::maps::Normalisation;
    use crate::radar::Decibels;
    use crate::signal::Floor;

    #[test]
    fn rows_come_back_with_how_they_were_made() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        let rows = vec![some_row(0, "live"), some_row(1, "live")];
        let radar = Radar { elements: 64, ..Radar::default() };
        let normalisation = Normalisation::DynamicRange(Decibels(60.0));
        let other = Conditions { floor: Floor::Snr(Decibels(20.0)), normalisation, radar };
        for conditions in [other, Conditions::default()] {
            write(&path, &rows, &conditions).unwrap();
            assert_eq!(read(&path).unwrap(), (rows.clone(), conditions.clone()));
            assert!(is_table_of_rows(&path));
            assert_eq!(beside(&path).exists(), conditions != Conditions::default(), "nothing stale stays");
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        assert!(read(&path).unwrap_err().contains("rows.csv"));
        std::fs::write(&path, "no,rows\n").unwrap();
        assert!(read(&path).unwrap_err().contains("no column \"set\""));
        assert!(!is_table_of_rows(&path) && !is_table_of_rows(folder.path()));
        write(&path, &[], &Conditions::default()).unwrap();
        std::fs::write(beside(&path), "[radar]\nelements = 0\n").unwrap();
        let wrong = read(&path).unwrap_err();
        assert!(wrong.contains("conditions.toml") && wrong.contains("elements"), "{wrong}");
        let two_formats = [some_row(0, "live"), Row { version: None, ..some_row(1, "live") }];
        write(&path, &two_formats, &Conditions::default()).unwrap();
        let refused = read(&path).unwrap_err();
        assert!(refused.contains("several formats; the floor \"thesis\" is 1.8 dB quieter"), "{refused}");
    }

    #[test]
    fn rows_of_the_command_say_themselves_how_they_were_made() {
        use crate::evaluate::campaign::Campaign;
        use crate::evaluate::sets::SceneSet;
        use crate::radar::Carrier;
        use crate::reconstruct::{Baseline, Reconstructor};
        use crate::scene::generate::Kind;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        let made = |campaign: &Campaign| {
            let baseline: [&dyn Reconstructor; 1] = [&Baseline];
            campaign.empty_rows(&[SceneSet::Generated(Kind::Set1)], &baseline).unwrap()[0][0].clone()
        };
        let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        let campaign = Campaign { floor: Floor::Exact, radar: radar.clone(), ..Campaign::default() };
        write_atomically(&path, |out| write_rows(out, &[made(&campaign)])).unwrap();
        let (rows, conditions) = read(&path).unwrap();
        assert_eq!(rows, [made(&campaign)]);
        assert_eq!(conditions, Conditions { floor: Floor::Exact, radar, ..Conditions::default() });
        let small = Campaign { radar: Radar { elements: 64, ..Radar::default() }, ..Campaign::default() };
        write_atomically(&path, |out| write_rows(out, &[made(&small)])).unwrap();
        assert!(read(&path).unwrap_err().contains("elements=64"));
        let older = Row { version: None, ..some_row(0, "live") };
        write_atomically(&path, |out| write_rows(out, &[older])).unwrap();
        assert_eq!(read(&path).unwrap().1, Conditions::default(), "older rows don't say it");
    }
}
