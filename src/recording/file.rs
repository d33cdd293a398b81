//! The TOML of a recording.
//!
//! ```toml
//! format = 2                          # of this text; without it, signs and carrier are those of the thesis' formula
//! name = "A post and a wall"
//! notes = "Where it was measured, and what to look for."
//!
//! [radar]                             # all of these are needed; a recording borrows none of table 3.1
//! carrier_hz = 77e9                   # at the sample that carrier_at says
//! carrier = "two-way"                 # or "one-way", if nothing is said
//! bandwidth_hz = 3.07e9               # over the samples; not needed for a snapshot (samples = 1)
//! element_spacing_metres = 0.001947
//! elements = 8
//! end_elements = 3
//! samples = 128
//! # transmitter_x_metres and receiver_x_metres, lists in the file's order, in place of spacing and elements: pairs of antennas;
//! # transmitter_y_metres and receiver_y_metres where they stand off the line
//!
//! [recording]
//! file = "post.npz"                   # .npz, .npy, .mat or .bin, beside this file
//! array = "samples"                   # its name in an .npz or .mat; or first and last, where the two ends have arrays of their own
//! axes = ["chirp", "element", "sample"] # or "transmitter" and "receiver"; "iq" where real and imaginary part have an axis
//! chirp = 0                           # or "mean"
//! elements = "all"                    # or "ends": first the elements of the first end, then those of the last
//! missing = [17]                      # elements of the whole array that measured nothing
//! range_metres = 15.0                 # of a snapshot
//! carrier_at = "first-sample"         # or "middle": where on the chirp carrier_hz lies
//! beat_sign = "+"                     # echoes stand at positive frequencies, or "-"
//! sweep = "up"                        # or "down"
//! reverse_elements = false            # mirrors the array: the file's first element is its last; places of antennas change their sign
//!
//! [recording.calibration]             # taken off the elements of the file
//! gain_db = []
//! phase_degrees = []
//!
//! [recording.capture]                 # for a .bin: a raw capture and the .cfg that set the radar up
//! config = "profile.cfg"              # says carrier_hz, bandwidth_hz, samples and chirp_seconds of [radar]
//! lanes = 2                           # or 4
//! receivers = "one-after-another"     # or "interleaved"
//! chirps = [0, 2]                     # the chirps of a loop that form the line of elements
//! frame = 0
//! loop = 0
//! ```

use super::axes::arrange;
use super::doubts::doubts;
use super::numbers::Numbers;
use super::numpy::{read_npy, read_npz};
use super::said_radar::said_radar;
use super::signs::{BeatSign, CarrierAt, FORMAT, Said, Signs, Sweep};
use super::{AxisKind, Calibration, Capture, Chirp, Fault, RadarProfile, Recorded, Recording, RecordingError, matlab};
use crate::platform::fs::File;
use crate::radar::{End, Radar};
use crate::scene::file::SceneTextError;
use crate::signal::{BeatSignal, TwoEnds};
use ndarray::{Array2, Axis, concatenate};
use num_complex::Complex64;
use serde::Deserialize;
use std::collections::HashSet;
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

/// Longest text that is read, bytes.
const MAX_TEXT_BYTES: u64 = 1 << 20;

/// Something to read a data file from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// Opens a data file by the name that the TOML gives it.
pub(super) type Open<'a> = &'a dyn Fn(&str) -> io::Result<Box<dyn Source>>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default = "oldest")]
    format: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    notes: String,
    radar: toml::Table,
    recording: Table,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    file: String,
    array: Option<String>,
    first: Option<String>,
    last: Option<String>,
    axes: Option<Vec<AxisKind>>,
    chirp: Option<Chirp>,
    #[serde(default)]
    elements: Covers,
    #[serde(default)]
    missing: Vec<usize>,
    range_metres: Option<f64>,
    conjugate: Option<bool>,
    carrier_at: Option<CarrierAt>,
    beat_sign: Option<BeatSign>,
    sweep: Option<Sweep>,
    #[serde(default)]
    reverse_elements: bool,
    #[serde(default)]
    calibration: Calibration,
    capture: Option<Capture>,
    /// Whether the text says places of antennas.
    #[serde(skip)]
    has_places: bool,
}

/// The format of a text that names none.
fn oldest() -> u32 {
    1
}

/// Whose samples a file holds.
#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Covers {
    #[default]
    All,
    Ends,
}

/// Whether a TOML is that of a recording: whether it has a table `[recording]`.
pub fn is_recording(text: &str) -> bool {
    toml::de::DeTable::parse(text).is_ok_and(|table| table.get_ref().contains_key("recording"))
}

/// Whether the file `path` is the TOML of a recording; not where it can't be read or ends otherwise.
pub fn is_recording_at(path: &Path) -> bool {
    let is_toml = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    is_toml && open_file(path).is_ok_and(|file| read_text(file).is_ok_and(|text| is_recording(&text)))
}

/// The file that holds the samples of the recording whose TOML is `path`; `None` where that is no such TOML.
pub fn data_path(path: &Path) -> Option<PathBuf> {
    let text = read_text(open_file(path).ok()?).ok()?;
    let table: toml::Table = text.parse().ok()?;
    let name = table.get("recording")?.get("file")?.as_str()?;
    Some(path.parent().unwrap_or(Path::new("")).join(name))
}

/// Reads a recording: the TOML `path`, and what it names beside it.
///
/// # Errors
/// [`RecordingError`] names the file, the key or the array, and what was expected of it.
pub fn load(path: &Path) -> Result<Recording, RecordingError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let text = read_text(open_file(path).map_err(|e| Fault::from(e).of(path))?).map_err(|e| e.of(path))?;
    from_parts(&text, path, &|name| Ok(Box::new(BufReader::new(open_file(&folder.join(name))?))))
}

fn open_file(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    if file.metadata()?.is_file() {
        Ok(file)
    } else {
        Err(io::Error::new(io::ErrorKind::InvalidInput, "is a folder, device or pipe; expected a file"))
    }
}

fn read_text(file: impl Read) -> Result<String, Fault> {
    let mut text = Vec::new();
    file.take(MAX_TEXT_BYTES + 1).read_to_end(&mut text)?;
    if text.len() as u64 > MAX_TEXT_BYTES {
        return Err(Fault::key(
            "the text",
            "is longer than 1 MiB",
            "a description; samples stand in a file of their own",
        ));
    }
    String::from_utf8(text).map_err(|_| Fault::key("the text", "is not UTF-8", "text in UTF-8"))
}

/// Refuses a text of a later format before its unknown keys are.
fn check_format(text: &str) -> Result<(), Fault> {
    #[derive(Deserialize)]
    struct Said {
        #[serde(default = "oldest")]
        format: u32,
    }
    match toml::from_str(text) {
        Ok(Said { format: later }) if later > FORMAT => {
            Err(Fault::key("format", format!("is {later}, of a later version of apertura"), "1 or 2"))
        }
        _ => Ok(()),
    }
}

/// Reads a recording from the text of its TOML, which stands at `path`, and what `open` opens.
pub(super) fn from_parts(text: &str, path: &Path, open: Open<'_>) -> Result<Recording, RecordingError> {
    check_format(text).map_err(|fault| fault.of(path))?;
    let document: Document = toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        Fault::Text(SceneTextError::at(text, start, error.message().lines().collect::<Vec<_>>().join(", "))).of(path)
    })?;
    let mut table = document.recording;
    let folder = path.parent().unwrap_or(Path::new(""));
    let profile = match &table.capture {
        None => None,
        Some(capture) => {
            let beside = folder.join(&capture.config);
            let read =
                || -> Result<RadarProfile, Fault> { Ok(RadarProfile::parse(&read_text(open(&capture.config)?)?)?) };
            Some(read().map_err(|fault| fault.of(&beside))?)
        }
    };
    let mut radar = said_radar(document.radar, profile.as_ref()).map_err(|fault| fault.of(path))?;
    table.has_places = !radar.is_monostatic();
    if table.reverse_elements {
        radar.antennas = radar.antennas.map(|antennas| antennas.mirrored());
    }
    table.check(&radar).map_err(|fault| fault.of(path))?;
    let signs = table.signs(document.format, &radar, profile.is_some()).map_err(|fault| fault.of(path))?;
    radar.carrier_hz = signs.carrier_hz;
    radar.validate().map_err(|e| Fault::from(e).of(path))?;
    let data = folder.join(&table.file);
    // Keys stand in the TOML, whatever file they are about.
    let place = |fault: Fault| match fault {
        Fault::Key { .. } | Fault::Calibration(_) => fault.of(path),
        fault => fault.of(&data),
    };
    let rows = table.read(open, profile.as_ref(), signs).map_err(place)?;
    let rows = table.in_element_order(&radar, rows).map_err(place)?;
    let samples = table.sorted(&radar, rows).map_err(place)?;
    let Table { mut missing, range_metres, .. } = table;
    missing.extend((0..radar.elements).filter(|n| radar.is_gap(*n)));
    missing.sort_unstable();
    missing.dedup();
    let doubts = doubts(&radar, &samples, document.format > oldest());
    Ok(Recording { name: document.name, notes: document.notes, radar, samples, missing, range_metres, doubts })
}

impl Table {
    /// What the TOML says must make sense by itself.
    fn check(&self, radar: &Radar) -> Result<(), Fault> {
        match (radar.samples, self.range_metres) {
            (1, Some(range)) if range.is_finite() && range > 0.0 => {}
            (1, Some(range)) => {
                return Err(Fault::key("recording.range_metres", format!("is {range}"), "a number above 0"));
            }
            (1, None) => {
                let why = "the range of the snapshot in metres: one sample cannot tell it";
                return Err(Fault::key("recording.range_metres", "is missing", why));
            }
            (_, None) => {}
            (_, Some(_)) => {
                let why = "it only where radar.samples is 1: several samples tell ranges";
                return Err(Fault::key("recording.range_metres", "is there", why));
            }
        }
        let mut may_miss = vec![false; radar.elements];
        self.covered(radar).into_iter().for_each(|n| may_miss[n] = true);
        for element in &self.missing {
            if !may_miss.get_mut(*element).is_some_and(std::mem::take) {
                let expected = format!("elements that the file is to hold, each once, below {}", radar.elements);
                return Err(Fault::key("recording.missing", format!("names element {element}"), expected));
            }
        }
        Ok(())
    }

    /// What is done about signs and the carrier; the carrier of a `.cfg` is that in the middle of the samples.
    fn signs(&self, format: u32, radar: &Radar, has_profile: bool) -> Result<Signs, Fault> {
        let Table { carrier_at, beat_sign, sweep, conjugate, .. } = *self;
        let carrier_at = match carrier_at {
            Some(CarrierAt::FirstSample) if has_profile => {
                let expected = "\"middle\", as the .cfg says, or no such key";
                return Err(Fault::key("recording.carrier_at", "is \"first-sample\"", expected));
            }
            None if has_profile && format > oldest() && radar.samples > 1 => Some(CarrierAt::Middle),
            said => said,
        };
        Said { format, carrier_at, beat_sign, sweep, conjugate }.signs(radar)
    }

    /// Elements of the whole array that the file is to hold, in its order.
    fn covered(&self, radar: &Radar) -> Vec<usize> {
        match self.covers() {
            Covers::All => (0..radar.elements).collect(),
            Covers::Ends => End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).collect(),
        }
    }

    fn covers(&self) -> Covers {
        if self.first.is_some() { Covers::Ends } else { self.elements }
    }

    /// The file's samples as `[elements, samples]`, with all that was said of them done.
    fn read(&self, open: Open<'_>, profile: Option<&RadarProfile>, signs: Signs) -> Result<Array2<Complex64>, Fault> {
        let mut rows = match profile.zip(self.capture.as_ref()) {
            Some((profile, capture)) => self.read_capture(open, capture, profile)?,
            None => self.read_arrays(open)?,
        };
        if let Some(((element, sample), _)) = rows.indexed_iter().find(|(_, v)| !v.is_finite()) {
            return Err(Fault::NotFinite { element, sample });
        }
        self.calibration.take_off(&mut rows)?;
        if signs.conjugates {
            rows.mapv_inplace(|v| v.conj());
        }
        if signs.reverses_samples {
            rows.invert_axis(Axis(1));
        }
        if self.reverse_elements && !self.counts_pairs() {
            rows.invert_axis(Axis(0));
        }
        Ok(rows)
    }

    /// Whether the file counts transmitters and receivers whose places the text says: then those say which element is which.
    fn counts_pairs(&self) -> bool {
        let has_both = |axes: &Vec<AxisKind>| axes.contains(&AxisKind::Transmitter);
        self.has_places && (self.capture.is_some() || self.axes.as_ref().is_some_and(has_both))
    }

    /// `rows` in the order of elements from the left, where the file counts transmitters and receivers and the text says where they stand;
    /// zeros at gaps.
    fn in_element_order(&self, radar: &Radar, rows: Array2<Complex64>) -> Result<Array2<Complex64>, Fault> {
        let Some(antennas) = radar.antennas.as_ref().filter(|_| self.counts_pairs()) else { return Ok(rows) };
        let (transmitters, receivers) = (antennas.transmitter_x_metres().len(), antennas.receiver_x_metres().len());
        if rows.nrows() != transmitters * receivers {
            let expected = format!("{transmitters} by {receivers}, as many as radar says places of antennas");
            let (found, shape) = (rows.nrows(), rows.dim());
            return Err(Fault::Count { what: "pairs of antennas", found, expected, shape });
        }
        let mut ordered = Array2::zeros((radar.elements, rows.ncols()));
        for (mut element, pair) in ordered.outer_iter_mut().zip(antennas.pairs()) {
            if let Some([t, r]) = pair {
                element.assign(&rows.row(t * receivers + r));
            }
        }
        Ok(ordered)
    }

    fn read_capture(
        &self,
        open: Open<'_>,
        capture: &Capture,
        profile: &RadarProfile,
    ) -> Result<Array2<Complex64>, Fault> {
        if self.extension() != "bin" {
            return Err(Fault::key("[recording.capture]", "is there", "it only beside a .bin file"));
        }
        let arrays = [("array", self.array.is_some()), ("first", self.first.is_some()), ("last", self.last.is_some())];
        let others = [("axes", self.axes.is_some()), ("chirp", self.chirp.is_some())];
        if let Some((key, _)) = arrays.iter().chain(&others).find(|(_, said)| *said) {
            return Err(Fault::key(
                &format!("recording.{key}"),
                "is there",
                "it not beside a .bin file: [recording.capture] says it all",
            ));
        }
        let loops = capture.read(open(&self.file)?, profile)?;
        let kinds = [AxisKind::Transmitter, AxisKind::Receiver, AxisKind::Sample];
        Ok(arrange(Numbers::Complex(loops.into_dyn()), &kinds, None)?)
    }

    fn read_arrays(&self, open: Open<'_>) -> Result<Array2<Complex64>, Fault> {
        let Some(axes) = &self.axes else {
            let kinds = "a list of \"element\", \"sample\", \"chirp\" and so on, one for each axis of the array";
            return Err(Fault::key("recording.axes", "is missing", kinds));
        };
        let array = |key: Option<&str>| Ok::<_, Fault>(arrange(self.numbers(open, key)?, axes, self.chirp)?);
        match (&self.array, &self.first, &self.last) {
            (array_key, None, None) => array(array_key.as_deref()),
            (None, Some(first), Some(last)) => {
                let (first, last) = (array(Some(first))?, array(Some(last))?);
                if first.dim() != last.dim() {
                    let expected = format!("as many as \"first\" has, {} by {}", first.nrows(), first.ncols());
                    let (found, shape) = (last.len(), last.dim());
                    return Err(Fault::Count { what: "numbers in \"last\"", found, expected, shape });
                }
                // Equal shapes join.
                concatenate(Axis(0), &[first.view(), last.view()])
                    .map_err(|e| Fault::key("recording.last", format!("does not join ({e})"), "the shape of \"first\""))
            }
            _ => {
                Err(Fault::key("recording.array", "stands beside half a pair", "either array, or both first and last"))
            }
        }
    }

    fn numbers(&self, open: Open<'_>, key: Option<&str>) -> Result<Numbers, Fault> {
        let extension = self.extension();
        let named = || key.ok_or_else(|| Fault::key("recording.array", "is missing", "the array's name in the file"));
        match extension.as_str() {
            "npz" => Ok(read_npz(open(&self.file)?, named()?)?),
            "mat" => Ok(matlab::read_mat(open(&self.file)?, named()?)?),
            "npy" if key.is_some() => {
                Err(Fault::key("recording.array", "is there", "it not beside an .npy file, which holds one array"))
            }
            "npy" => Ok(read_npy(open(&self.file)?)?),
            "bin" => Err(Fault::key("[recording.capture]", "is missing", "it beside a .bin file")),
            _ => Err(Fault::key(
                "recording.file",
                format!("is \"{}\"", self.file),
                "a name ending in .npz, .npy, .mat or .bin",
            )),
        }
    }

    fn extension(&self) -> String {
        Path::new(&self.file).extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase()
    }

    /// The rows of the file in their places of the array.
    fn sorted(&self, radar: &Radar, rows: Array2<Complex64>) -> Result<Recorded, Fault> {
        if rows.ncols() != radar.samples {
            let expected = format!("{} as radar.samples says", radar.samples);
            return Err(Fault::Count { what: "samples", found: rows.ncols(), expected, shape: rows.dim() });
        }
        let covered = self.covered(radar);
        let missing: HashSet<usize> = self.missing.iter().copied().collect();
        let present: Vec<usize> = covered.iter().copied().filter(|n| !missing.contains(n)).collect();
        let places = [&covered, &present].into_iter().find(|places| places.len() == rows.nrows()).ok_or_else(|| {
            let without = if present.len() < covered.len() {
                format!(", or {} without the missing ones", present.len())
            } else {
                String::new()
            };
            let whose = if self.covers() == Covers::All {
                "radar.elements says"
            } else {
                "radar.end_elements says for two ends"
            };
            Fault::Count {
                what: "elements",
                found: rows.nrows(),
                expected: format!("{} as {whose}{without}", covered.len()),
                shape: rows.dim(),
            }
        })?;
        let mut samples = Array2::zeros((radar.elements, radar.samples));
        for (element, row) in places.iter().zip(rows.outer_iter()).filter(|(element, _)| !missing.contains(element)) {
            samples.row_mut(*element).assign(&row);
        }
        let signal = BeatSignal { samples };
        Ok(match self.covers() {
            Covers::All => Recorded::All(signal),
            Covers::Ends => {
                let TwoEnds { first, last } = signal.two_ends(radar);
                Recorded::Ends(TwoEnds { first, last })
            }
        })
    }
}

#[cfg(test)]
mod tests;
