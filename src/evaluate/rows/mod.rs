//! One row a scene and method: what an evaluation found, kept as CSV so that it can be sorted, sliced, merged and reproduced.

mod file;
mod lacks;
mod lines;
mod order;
mod origin;
mod part;
mod read;
mod whole;

pub use file::{RowWriter, header, write_rows};
pub use lacks::{Lack, lacks};
pub use order::{Histogram, MergeError, estimate, merge, sorted_by};
pub use origin::{FORMAT, Origin, Scenes, radar_text};
pub use part::Part;
pub use read::{RowError, Table, read_rows, read_table};
pub use whole::{GivenTwice, Whole};

use super::echoes::EchoTally;
use crate::scene::generate::Kind;
use std::sync::Arc;

/// Most rows that a file may have: they take some 600 MB.
pub const MAX_ROWS: usize = 2_000_000;

/// What one method made of one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The scenes: a test set's number, a kind's name or a folder.
    pub set: String,
    /// Number of the scene in its set.
    pub index: u32,
    /// Seed of the set's scenes; 0 for a folder's.
    pub seed: u64,
    /// Name of the method.
    pub method: String,
    /// Threshold of the method.
    pub eta: f32,
    /// SE.
    pub squared_error: f64,
    /// P_D at `eta`; `None` where the target has no cells.
    pub detection: Option<f64>,
    /// P_FA at `eta`.
    pub false_alarm: f64,
    /// P_D at the smallest threshold that holds this scene's P_FA to the set's printed one.
    pub detection_at_printed: Option<f64>,
    /// Time of the map, milliseconds.
    pub milliseconds: f64,
    /// Objects of the scene.
    pub objects: usize,
    /// Their reflectors.
    pub reflectors: usize,
    /// Objects that the method misses.
    pub missed: usize,
    /// Blobs of its output where nothing is.
    pub ghosts: usize,
    /// How far the nearest two reflectors of different objects lie apart along the columns; `None` for fewer than two objects.
    pub nearest_pair_columns: Option<f64>,
    /// The same along range, in range bins.
    pub nearest_pair_bins: Option<f64>,
    /// Range of the nearest reflector, metres; `None` for an empty scene.
    pub min_range_metres: Option<f64>,
    /// The strongest echo over the weakest, dB of amplitude; `None` for an empty scene.
    pub strongest_over_weakest_db: Option<f64>,
    /// Objects found, with nothing wrong; `None` in tables that were written before the kinds of failure were counted.
    pub found: Option<usize>,
    /// Objects that share a blob with a neighbour.
    pub merged: Option<usize>,
    /// Objects on the wrong tooth of the comb.
    pub wrong_tooth: Option<usize>,
    /// Echoes that stand out in the target by their strength, and how many of them the method shows; `None` for scenes without bodies, and
    /// in tables that were written before echoes were counted.
    pub echoes: Option<EchoTally>,
    /// SE if every cell were off by its doubt ([`squared_doubt`](super::squared_doubt)); `None` for methods that say no doubt, and in tables
    /// that were written before it was kept.
    pub doubt: Option<f64>,
    /// Part of the cells whose error is at most their doubt ([`part_within`](super::part_within)); `None` as for `doubt`.
    pub within_doubt: Option<f64>,
    /// P_D and P_FA by the detector of its origin; `None` where none was asked for.
    pub cfar: Option<CfarRates>,
    /// What made the row; `None` in tables that were written before this was kept.
    pub origin: Option<Arc<Origin>>,
}

/// What a detector with a constant false-alarm rate makes of an output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CfarRates {
    /// P_D: part of the target cells that it detects; `None` where the target has none.
    pub detection: Option<f64>,
    /// P_FA: part of the other cells that it detects.
    pub false_alarm: f64,
}

impl Row {
    /// Whether its set lies over a floor of its own, whatever floor the others of a run have: scenes of noise alone do.
    pub fn has_own_floor(&self) -> bool {
        self.set == "noise"
    }

    /// Whether a generator made its scene.
    pub fn is_generated(&self) -> bool {
        match &self.origin {
            Some(origin) => matches!(origin.scenes, Scenes::Generated { .. }),
            None => self.set.parse::<Kind>().is_ok(),
        }
    }
}

/// A column of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the fields of `Row` say what they are")]
pub enum Column {
    Set,
    Index,
    Seed,
    Method,
    Eta,
    SquaredError,
    Detection,
    FalseAlarm,
    DetectionAtPrinted,
    Milliseconds,
    Objects,
    Reflectors,
    Missed,
    Ghosts,
    NearestPairColumns,
    NearestPairBins,
    MinRangeMetres,
    StrongestOverWeakestDb,
    Found,
    Merged,
    WrongTooth,
    Echoes,
    EchoesFound,
    Doubt,
    WithinDoubt,
    CfarDetection,
    CfarFalseAlarm,
}

/// What stands in a cell of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<'a> {
    /// A number.
    Number(f64),
    /// A name.
    Text(&'a str),
    /// Nothing: the figure doesn't exist for this scene.
    Missing,
}

impl Column {
    /// Every column, in the file's order.
    pub const ALL: [Column; 27] = [
        Column::Set,
        Column::Index,
        Column::Seed,
        Column::Method,
        Column::Eta,
        Column::SquaredError,
        Column::Detection,
        Column::FalseAlarm,
        Column::DetectionAtPrinted,
        Column::Milliseconds,
        Column::Objects,
        Column::Reflectors,
        Column::Missed,
        Column::Ghosts,
        Column::NearestPairColumns,
        Column::NearestPairBins,
        Column::MinRangeMetres,
        Column::StrongestOverWeakestDb,
        Column::Found,
        Column::Merged,
        Column::WrongTooth,
        Column::Echoes,
        Column::EchoesFound,
        Column::Doubt,
        Column::WithinDoubt,
        Column::CfarDetection,
        Column::CfarFalseAlarm,
    ];

    /// Name in the file's first line and in filters.
    pub fn name(self) -> &'static str {
        match self {
            Column::Set => "set",
            Column::Index => "index",
            Column::Seed => "seed",
            Column::Method => "method",
            Column::Eta => "eta",
            Column::SquaredError => "squared_error",
            Column::Detection => "detection",
            Column::FalseAlarm => "false_alarm",
            Column::DetectionAtPrinted => "detection_at_printed",
            Column::Milliseconds => "milliseconds",
            Column::Objects => "objects",
            Column::Reflectors => "reflectors",
            Column::Missed => "missed",
            Column::Ghosts => "ghosts",
            Column::NearestPairColumns => "nearest_pair_columns",
            Column::NearestPairBins => "nearest_pair_bins",
            Column::MinRangeMetres => "min_range_metres",
            Column::StrongestOverWeakestDb => "strongest_over_weakest_db",
            Column::Found => "found",
            Column::Merged => "merged",
            Column::WrongTooth => "wrong_tooth",
            Column::Echoes => "echoes",
            Column::EchoesFound => "echoes_found",
            Column::Doubt => "doubt",
            Column::WithinDoubt => "within_doubt",
            Column::CfarDetection => "cfar_detection",
            Column::CfarFalseAlarm => "cfar_false_alarm",
        }
    }

    /// Whether a table may lack it: older ones do.
    pub fn is_optional(self) -> bool {
        use Column::{Doubt, Echoes, EchoesFound, Found, Merged, WithinDoubt, WrongTooth};
        matches!(self, Found | Merged | WrongTooth | Echoes | EchoesFound | Doubt | WithinDoubt) || self.is_of_cfar()
    }

    /// Whether only rows with a detector of constant false-alarm rate have it.
    pub fn is_of_cfar(self) -> bool {
        matches!(self, Column::CfarDetection | Column::CfarFalseAlarm)
    }

    /// The column called `name`.
    pub fn by_name(name: &str) -> Option<Column> {
        Column::ALL.into_iter().find(|c| c.name() == name)
    }

    /// What stands in this column of `row`. A set that is a number is one. Echoes of all classes are added up.
    pub fn of(self, row: &Row) -> Value<'_> {
        let maybe = |v: Option<f64>| v.map_or(Value::Missing, Value::Number);
        let count = |v: Option<usize>| maybe(v.map(|v| v as f64));
        match self {
            Column::Set => row.set.parse().map_or(Value::Text(&row.set), Value::Number),
            Column::Index => Value::Number(f64::from(row.index)),
            Column::Seed => Value::Number(row.seed as f64),
            Column::Method => Value::Text(&row.method),
            Column::Eta => Value::Number(f64::from(row.eta)),
            Column::SquaredError => Value::Number(row.squared_error),
            Column::Detection => maybe(row.detection),
            Column::FalseAlarm => Value::Number(row.false_alarm),
            Column::DetectionAtPrinted => maybe(row.detection_at_printed),
            Column::Milliseconds => Value::Number(row.milliseconds),
            Column::Objects => Value::Number(row.objects as f64),
            Column::Reflectors => Value::Number(row.reflectors as f64),
            Column::Missed => Value::Number(row.missed as f64),
            Column::Ghosts => Value::Number(row.ghosts as f64),
            Column::NearestPairColumns => maybe(row.nearest_pair_columns),
            Column::NearestPairBins => maybe(row.nearest_pair_bins),
            Column::MinRangeMetres => maybe(row.min_range_metres),
            Column::StrongestOverWeakestDb => maybe(row.strongest_over_weakest_db),
            Column::Found => count(row.found),
            Column::Merged => count(row.merged),
            Column::WrongTooth => count(row.wrong_tooth),
            Column::Echoes => count(row.echoes.map(|echoes| echoes.there.iter().sum())),
            Column::EchoesFound => count(row.echoes.map(|echoes| echoes.found.iter().sum())),
            Column::Doubt => maybe(row.doubt),
            Column::WithinDoubt => maybe(row.within_doubt),
            Column::CfarDetection => maybe(row.cfar.and_then(|rates| rates.detection)),
            Column::CfarFalseAlarm => maybe(row.cfar.map(|rates| rates.false_alarm)),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A row in whose figures every digit counts.
    pub(in crate::evaluate) fn row(set: &str, index: u32, method: &str) -> Row {
        Row {
            set: set.into(),
            index,
            seed: 7,
            method: method.into(),
            eta: 0.845,
            squared_error: 100.0 / 3.0 + f64::from(index),
            detection: Some(0.1 + 0.2),
            false_alarm: 1e-300,
            detection_at_printed: None,
            milliseconds: 12.5,
            objects: 3,
            reflectors: 150,
            missed: 1,
            ghosts: 0,
            nearest_pair_columns: Some(f64::MIN_POSITIVE),
            nearest_pair_bins: None,
            min_range_metres: Some(5.0),
            strongest_over_weakest_db: Some(0.0),
            found: Some(1),
            merged: Some(0),
            wrong_tooth: None,
            echoes: Some(EchoTally { there: [1, 0, 0, 2, 0, 4], found: [1, 0, 0, 1, 0, 0] }),
            doubt: Some(200.0 / 7.0),
            within_doubt: Some(8.0 / 9.0),
            cfar: None,
            origin: None,
        }
    }
}
