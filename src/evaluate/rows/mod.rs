//! Rows of an evaluation, one a scene and method, kept as CSV so that they can be sorted, sliced, merged and reproduced.
//!
//! [`Row`] is the one definition of the columns: the file's first line, writing, reading, [`Column`], and the module's dicts come from it.

mod cell;
mod columns;
mod file;
mod lines;
mod merge;
mod missing_rows;
mod order;
mod row_file;
mod whole;

pub use cell::{CellKind, Text, Value};
pub use file::{RowTable, header, read_rows, read_table, row_writer, write_rows};
pub use lines::MAX_ROWS;
pub use merge::merge;
pub use missing_rows::{MissingRows, missing_rows};
pub use order::{Histogram, estimate, sorted_by};
pub use row_file::{RowFile, RowFileError, RowIdentity, RunRows, row_identity, write_merged};
pub use whole::WholeRun;

use super::echoes::{EchoCounts, EchoTally};
use super::shard::Shard;
use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::radar::Carrier;
use crate::scene::generate::{self, Purpose, Reading};
use crate::signal::Floor;
use cell::{CellValue, by_text, unless_file};
use columns::columns;

/// Number of the format of rows, which stands in each. Before format 2 the floor "thesis" had another level ([`WHY_NO_OTHER_FORMAT`]). Tables
/// from before the formats were counted have no such column, and record no origin.
pub const FORMAT: u32 = 2;

/// The reason why rows of two formats are not merged.
pub const WHY_NO_OTHER_FORMAT: &str = "the floor \"thesis\" is 1.8 dB quieter from format 2 on, so that figures of older rows don't compare with newer ones";

columns! {
    figures {
        /// The scenes: a test set's number, a kind's name or a folder.
        set: Text = Set,
        /// Number of the scene in its set.
        index: u32 = Index,
        /// Seed of the set's scenes; 0 for a folder's.
        seed: u64 = Seed,
        /// Name of the method.
        method: Text = Method,
        /// Threshold of the method.
        eta: f32 = Eta,
        /// SE.
        squared_error: f64 = SquaredError,
        /// P_D at `eta`; `None` where the target has no cells.
        detection: Option<f64> = Detection,
        /// P_FA at `eta`.
        false_alarm: f64 = FalseAlarm,
        /// P_D at the smallest threshold that holds this scene's P_FA to the set's printed one.
        detection_at_printed: Option<f64> = DetectionAtPrinted,
        /// Time of the map, milliseconds.
        milliseconds: f64 = Milliseconds,
        /// Objects of the scene.
        objects: usize = Objects,
        /// Reflectors of the objects.
        reflectors: usize = Reflectors,
        /// Objects that the method misses.
        missed: usize = Missed,
        /// Ghosts: blobs of the method's output where the scene has nothing.
        ghosts: usize = Ghosts,
        /// Columns between the nearest two reflectors of different objects; `None` for fewer than two objects.
        nearest_pair_columns: Option<f64> = NearestPairColumns,
        /// Range bins between the same two reflectors.
        nearest_pair_bins: Option<f64> = NearestPairBins,
        /// Range of the nearest reflector, metres; `None` for an empty scene.
        min_range_metres: Option<f64> = MinRangeMetres,
        /// The strongest echo over the weakest, dB of amplitude; `None` for an empty scene.
        strongest_over_weakest_db: Option<f64> = StrongestOverWeakestDb,
        /// Objects found, with nothing wrong; `None` in tables from before the kinds of failure were counted.
        found: Option<usize> = Found,
        /// Objects that share a blob with a neighbour.
        merged: Option<usize> = Merged,
        /// Objects on the wrong tooth of the comb.
        wrong_tooth: Option<usize> = WrongTooth,
        /// Echoes that stand out in the target, by their strength; `None` for scenes without bodies, and in tables from before they were counted.
        #[serde(with = "by_text")]
        echoes: Option<EchoCounts> = Echoes,
        /// Echoes among them that the method shows.
        #[serde(with = "by_text")]
        echoes_found: Option<EchoCounts> = EchoesFound,
        /// SE if every cell were off by its doubt ([`squared_doubt`](super::squared_doubt)); `None` without doubt, as in older tables.
        doubt: Option<f64> = Doubt,
        /// Part of the cells whose error is at most their doubt ([`part_within`](super::part_within)); `None` as for `doubt`.
        within_doubt: Option<f64> = WithinDoubt,
        /// P_D by the detector `cfar`; `None` where none was tried, and where the target has no cells.
        cfar_detection: Option<f64> = CfarDetection,
        /// P_FA by the detector `cfar`; `None` where none was tried.
        cfar_false_alarm: Option<f64> = CfarFalseAlarm,
    }
    origin {
        /// The format of the row, [`FORMAT`] or an older one; `None` in tables without an origin.
        version: Option<u32> = Version,
        /// Version of the program.
        program: Text = Program,
        /// Noise of the scenes.
        #[serde(with = "by_text")]
        floor: Option<Floor> = Floor,
        /// Normalisation of maps.
        #[serde(with = "by_text")]
        normalisation: Option<Normalisation> = Normalisation,
        /// Purpose of generated scenes; `None` for a folder's.
        #[serde(deserialize_with = "unless_file")]
        purpose: Option<Purpose> = Purpose,
        /// Description after which scenes were generated; `None` for a folder's.
        #[serde(deserialize_with = "unless_file")]
        reading: Option<Reading> = Reading,
        /// Reading of the carrier's phase for generated scenes; `None` for a folder's, which have their own.
        #[serde(deserialize_with = "unless_file")]
        carrier: Option<Carrier> = Carrier,
        /// Each constant of the radar that differs from table 3.1, without the carrier's reading.
        radar: Text = Radar,
        /// The fingerprint of a folder's files.
        scenes: Text = Scenes,
        /// The fingerprint of the method's weights for the campaign's radar; empty for a method that learns nothing.
        weights: Text = Weights,
        /// The optimisers that trained the weights.
        optimiser: Text = Optimiser,
        /// The shard of the scenes that this run tried.
        #[serde(with = "by_text")]
        shard: Option<Shard> = Shard,
        /// The sets of the whole run with their numbers of scenes, as [`WholeRun`] writes them.
        whole: Text = Whole,
        /// The methods of the whole run.
        methods: Text = Methods,
        /// The detector of constant false-alarm rate that was tried on every output; empty where none was.
        cfar: Text = Cfar,
        /// The elements that measured the scenes in place of the scenes' own; empty where those did.
        elements: Text = Elements,
        /// The map that outputs were held against ([`Target`](super::Target)); empty in older tables, where it is the measured one.
        target: Text = Target,
        /// Numbers of the elements whose samples methods got; empty where methods got the two ends.
        layout: Text = Layout,
    }
}

impl Column {
    /// Every column, in the file's order.
    pub fn all() -> impl Iterator<Item = Column> {
        Column::FIGURES.iter().chain(Column::ORIGIN).copied()
    }

    /// The column of figures called `name`.
    pub fn by_name(name: &str) -> Option<Column> {
        Column::FIGURES.iter().copied().find(|column| column.name() == name)
    }

    /// Whether a table may lack the column, as older tables do: an empty row has no figure there.
    pub fn is_optional(self) -> bool {
        !matches!(self, Column::Set | Column::Method) && self.cell(&Row::default()) == Value::Missing
    }

    /// The cell of `row` in this column as text, for messages; empty where the figure is missing.
    pub fn text(self, row: &Row) -> String {
        match self {
            Column::Seed => row.seed.to_string(),
            _ => self.cell(row).to_string(),
        }
    }

    /// The cell of `row` in this column. A set named by a number is a number. Echoes of all classes are added up.
    pub fn of(self, row: &Row) -> Value<'_> {
        match self.cell(row) {
            Value::Text(text) if self == Column::Set => text.parse().map_or(Value::Text(text), Value::Number),
            value => value,
        }
    }
}

impl Row {
    /// Whether the row's set has a floor of its own, not the run's, as scenes of noise alone do.
    pub fn has_own_floor(&self) -> bool {
        self.set == "noise"
    }

    /// Whether the row's scene was generated.
    pub fn is_generated(&self) -> bool {
        match self.version {
            Some(_) => self.carrier.is_some(),
            None => self.set.parse::<generate::Kind>().is_ok(),
        }
    }

    /// Echoes that stand out in the target, and those that the method shows; `None` where the row has no counts.
    pub fn echo_tally(&self) -> Option<EchoTally> {
        Some(EchoTally { there: self.echoes?.0, found: self.echoes_found?.0 })
    }

    /// The run of the row; `None` where the row doesn't record it.
    pub fn whole_run(&self) -> Option<WholeRun> {
        self.version.and_then(|_| WholeRun::read(&self.whole, &self.methods))
    }

    fn check(&self) -> Result<(), (Column, &'static str)> {
        let is_finite = |column: &Column| column.cell(self).number().is_none_or(f64::is_finite);
        let endless = Column::FIGURES.iter().find(|column| !is_finite(column));
        let (found, there) = (self.echoes_found.unwrap_or_default().0, self.echoes.unwrap_or_default().0);
        let are_fewer =
            self.echoes.is_some() == self.echoes_found.is_some() && found.iter().zip(&there).all(|(f, t)| f <= t);
        let expected = |is_so: bool, column: Column, expected| if is_so { Ok(()) } else { Err((column, expected)) };
        endless.map_or(Ok(()), |column| Err((*column, "a finite number")))?;
        expected(!self.set.is_empty(), Column::Set, "a name")?;
        expected(!self.method.is_empty(), Column::Method, "a name")?;
        expected(
            are_fewer,
            Column::EchoesFound,
            "six whole numbers from 0, none larger in echoes_found than in echoes",
        )?;
        let has_rate = self.cfar_false_alarm.is_some() || self.cfar_detection.is_none();
        expected(has_rate, Column::CfarFalseAlarm, "a rate beside cfar_detection")?;
        if self.version.is_none() {
            return Ok(());
        }
        expected(self.version != Some(0), Column::Version, "1 or 2, the formats of rows that this program reads")?;
        expected(self.floor.is_some(), Column::Floor, "a floor as --floor takes it")?;
        expected(self.normalisation.is_some(), Column::Normalisation, "min-max or db=RANGE")?;
        let is_generated = self.carrier.is_some();
        expected(
            self.purpose.is_some() == is_generated,
            Column::Purpose,
            "training, validation or test, beside a carrier",
        )?;
        expected(self.reading.is_some() == is_generated, Column::Reading, "program or text, beside a carrier")?;
        expected(self.shard.is_some(), Column::Shard, "I/N with I from 0 to N - 1")?;
        let is_whole = WholeRun::read(&self.whole, &self.methods).is_some();
        expected(
            is_whole,
            Column::Whole,
            "the sets and methods of the whole run, as in 1 x 100; 2 x 100 and live; nomp",
        )?;
        let has_detector = self.cfar.is_empty() || self.cfar.parse::<Cfar>().is_ok();
        expected(has_detector, Column::Cfar, "a detector as --cfar takes it, or nothing")
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A row in whose figures every digit counts, of a table without an origin.
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
            milliseconds: 12.5,
            objects: 3,
            reflectors: 150,
            missed: 1,
            nearest_pair_columns: Some(f64::MIN_POSITIVE),
            min_range_metres: Some(5.0),
            strongest_over_weakest_db: Some(0.0),
            found: Some(1),
            merged: Some(0),
            echoes: Some(EchoCounts([1, 0, 0, 2, 0, 4])),
            echoes_found: Some(EchoCounts([1, 0, 0, 1, 0, 0])),
            doubt: Some(200.0 / 7.0),
            within_doubt: Some(8.0 / 9.0),
            ..Row::default()
        }
    }

    pub(in crate::evaluate) fn made(set: &str, index: u32, method: &str) -> Row {
        Row {
            version: Some(FORMAT),
            program: "0.2.0".into(),
            floor: Some(Floor::Thesis),
            normalisation: Some(Normalisation::MinMax),
            purpose: Some(Purpose::Test),
            reading: Some(Reading::Program),
            carrier: Some(Carrier::OneWay),
            shard: Some(Shard::default()),
            whole: "1 x 4".into(),
            methods: "live".into(),
            ..row(set, index, method)
        }
    }

    #[test]
    fn two_million_rows_take_about_a_gigabyte() {
        let bytes = size_of::<Row>();
        assert!(bytes <= 560, "{bytes} bytes a row");
    }
}
