//! Raw captures and arrays without a TOML: the layout by evidence, the antennas of a board, and the TOML with both.
//!
//! To open a capture, its TOML is written in memory and read as that of any recording.
//!
//! | file | content |
//! |---|---|
//! | [`boards`] | places of antennas by a board's name |
//! | `imported` | the ways to read a file |
//! | `line` | the line of elements that antennas of a capture form |
//! | `beside` | files beside a capture: its `.cfg`, its other files |
//! | `first_frame` | figures on the first frame: the constant part, the order of a cascade's chips |
//! | `text` | the TOML |
//! | `array` | arrays |
//! | `axes` | the kinds of an array's axes by evidence |

mod array;
mod axes;
mod beside;
pub mod boards;
mod first_frame;
mod imported;
mod line;
#[cfg(test)]
pub(super) mod tests;
mod text;

pub use imported::Imported;

use super::axes::{ChirpChoice, Join};
use super::capture::{Capture, Treatment};
use super::chain::{Source, open_joined};
use super::layout::stream::CaptureStream;
use super::layout::{Candidate, EvidenceKind, Found, config_claims, find};
use super::profile::RadarProfile;
use super::recording_text::{open_file, read_config_text};
use super::{Fault, Origin, ReadingOption, Recording, RecordingError};
use crate::files::ends_in;
use crate::files::kind::text_kind_at;
use crate::radar::counted;
use boards::Board;
use first_frame::FirstFrame;
use std::io::{self, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

const MAX_OFFERS: usize = 4;

/// Whether `path` has the ending of a raw capture, of an array, or of a `.cfg`. For an `.npz` the arrays decide: [`is_raw_at`].
pub fn is_raw(path: &Path) -> bool {
    ends_in(path, &["bin", "dat", "raw", "cfg"]) || ends_in(path, &array::ENDINGS) && !ends_in(path, &["npz"])
}

/// As [`is_raw`], and true for an `.npz` with an array of two axes or more, but none of a scene or of maps.
pub fn is_raw_at(path: &Path) -> bool {
    is_raw(path) || ends_in(path, &["npz"]) && array::has_samples(path)
}

/// Reads a raw capture or an array by its most likely layout and antennas. `config` is its `.cfg`; else that of its name beside it, or the only one.
/// # Errors
/// [`RecordingError`] names the file and the expected content.
pub fn open(path: &Path, config: Option<&Path>) -> Result<Recording, RecordingError> {
    import(path, config, None)?.origin.recording()
}

/// Finds the ways to read a raw capture or an array. `config` is as for [`open`], and `board` has the antennas; for `None` the most usual board is used.
/// # Errors
/// [`RecordingError`] names the file and the expected content.
pub fn import(path: &Path, config: Option<&Path>, board: Option<&'static Board>) -> Result<Imported, RecordingError> {
    let data = beside::data_of(path)?;
    let own = (data != path).then(|| path.to_owned());
    let config = config.map(Path::to_owned).or(own).or_else(|| beside::config_of(&data));
    let profile = config.as_deref().map(read_config).transpose()?;
    if ends_in(&data, &array::ENDINGS) {
        return array::import(&data, config, profile.as_ref(), board);
    }
    if let Some(kind) = text_kind_at(&data) {
        let expected = "a capture of 16-bit samples, an array, or the .cfg beside it";
        return Err(Fault::key("the file", format!("is {kind}"), expected).of(&data));
    }
    let (chips, _) = beside::chips(&data);
    let files = match <[PathBuf; 4]>::try_from(chips) {
        Ok([data, chips @ ..]) => Files { data, more: Vec::new(), chips: chips.to_vec(), config },
        Err(_) => Files { more: beside::more_files(&data), data, chips: Vec::new(), config },
    };
    let stream = files.open().and_then(CaptureStream::new).map_err(|e| Fault::from(e).of(&files.data))?;
    let profile = profile.map(|profile| profile.on_chips(1 + files.chips.len()));
    import_stream(stream, files, profile.as_ref(), board)
}

/// Finds the ways to read one frame's bytes from a capture card; `config` is the radar's `.cfg`.
/// # Errors
/// [`RecordingError`] names the `.cfg`, or the fault of the bytes.
pub fn of_frame(bytes: Vec<u8>, config: &Path, board: Option<&'static Board>) -> Result<Imported, RecordingError> {
    let profile = read_config(config)?;
    let data = frame_path(config);
    let stream = CaptureStream::plain(Cursor::new(bytes)).map_err(|e| Fault::from(e).of(&data))?;
    import_stream(
        stream,
        Files { data, more: Vec::new(), chips: Vec::new(), config: Some(config.to_owned()) },
        Some(&profile),
        board,
    )
}

/// Path for the data of a frame in memory, beside its `.cfg`; there is no such file.
pub fn frame_path(config: &Path) -> PathBuf {
    config.with_file_name("frame.bin")
}

/// Bytes of a frame by the `.cfg` at `path`, at most 1 GiB.
/// # Errors
/// [`RecordingError`] names the file and the fault.
pub fn frame_bytes(path: &Path) -> Result<usize, RecordingError> {
    let profile = read_config(path)?;
    profile.frame_bytes().ok_or_else(|| {
        Fault::key("the frame", "is larger than 1 GiB", "chirps and samples that fit in memory").of(path)
    })
}

/// The files of a capture: the first, those that continue it, those of a cascade's other chips, and the `.cfg`.
struct Files {
    data: PathBuf,
    more: Vec<PathBuf>,
    chips: Vec<PathBuf>,
    config: Option<PathBuf>,
}

impl Files {
    fn open(&self) -> io::Result<Box<dyn Source>> {
        open_joined(&self.data, &self.more, &self.chips, |path| Ok(Box::new(BufReader::new(open_file(path)?))))
    }

    /// A note on files that are read as one, or on chips without a file.
    fn note(&self) -> Option<String> {
        let (_, missing) = beside::chips(&self.data);
        if !self.chips.is_empty() {
            return Some("The files of the four chips of a cascade are read as one.".to_owned());
        }
        if !self.more.is_empty() {
            return Some(format!("The capture goes on in {} more files, read as one.", self.more.len()));
        }
        (!missing.is_empty()).then(|| {
            format!(
                "The file holds the receivers of one chip of a cascade. Beside it are missing {}: it is read alone.",
                missing.join(", ")
            )
        })
    }
}

/// The ways to read a capture, with their TOML.
fn import_stream<R: Read + io::Seek>(
    mut stream: CaptureStream<R>,
    files: Files,
    profile: Option<&RadarProfile>,
    board: Option<&'static Board>,
) -> Result<Imported, RecordingError> {
    let found = find(&mut stream, profile).map_err(|fault| fault.of(&files.data))?;
    let best = found.best();
    let frame = FirstFrame::read(&mut stream, &capture(best, &files, profile), profile);
    let is_cascade = !files.chips.is_empty() && board.is_none_or(|board| board.name == boards::BY_CHIP.name);
    let board = if is_cascade { Some(frame.cascade()) } else { board };
    let line = line::element_line(best.counts, profile, board);
    if line.transmitter_x_metres.len() * line.receiver_x_metres.len() < 2 {
        let found = "has one transmitter and one receiver, which tell ranges and no directions";
        return Err(Fault::key("the capture", found, "two elements or more").of(&files.data));
    }
    let mut doubts = doubts_of(&found, profile);
    doubts.extend(line.doubts.iter().cloned());
    doubts.extend(files.note());
    doubts.extend(frame.constant_db.map(|db| {
        format!(
            "A constant part (leakage or offset) stands {db:.0} dB over all else and is taken out: recording.capture.constant = \"keep\" keeps it."
        )
    }));
    let mut sentences = found.sentences();
    sentences.extend(profile.iter().flat_map(|p| config_sentences(p)));
    let offer = |candidate: &Candidate| {
        let line = line::element_line(candidate.counts, profile, board);
        let capture = Capture {
            chirps: Some(line.chirps.clone()),
            receivers_taken: line.receivers.clone(),
            constant: if frame.constant_db.is_some() { Treatment::Out } else { Treatment::Keep },
            ..capture(candidate, &files, profile)
        };
        let about = text::Subject { data: &files.data, profile, line: &line, sentences: &sentences };
        let (description, power) = (candidate.description(), candidate.power.clone());
        let toml = text::of_capture(&capture, candidate.counts.samples, &about);
        ReadingOption { description, log_odds: candidate.log_odds(), power, toml }
    };
    let offers = found.candidates.iter().take(MAX_OFFERS).map(offer).collect();
    let (board, frames) = (line.board, frame.frames);
    let Files { data, config, .. } = files;
    let origin = Origin { data, config, offers, sentences, doubts, board, frames, ..Origin::default() };
    Ok(Imported { origin, found: Some(found) })
}

pub(super) fn read_config(path: &Path) -> Result<RadarProfile, RecordingError> {
    let read = || -> Result<RadarProfile, Fault> {
        let file = open_file(path)?;
        RadarProfile::parse(&read_config_text(file)?)
    };
    read().map_err(|fault| fault.of(path))
}

fn doubts_of(found: &Found, profile: Option<&RadarProfile>) -> Vec<String> {
    let mut doubts = found.notes.clone();
    let rivals: Vec<String> = found.rivals().into_iter().map(Candidate::description).collect();
    if let Some([how, or]) = found.certainty().doubt().filter(|_| !rivals.is_empty()) {
        doubts.push(format!("The layout is {how}: {}. {or}: {}.", found.best().description(), rivals.join("; or: ")));
    }
    let best = found.best();
    let Some(profile) = profile else { return doubts };
    let contradicted: Vec<_> =
        config_claims(&best.layout, profile).into_iter().filter(|s| s.config != s.layout).collect();
    doubts.extend(contradicted.iter().map(|s| {
        format!("The .cfg says {}, but the samples look like {}: the layout follows the samples.", s.config, s.layout)
    }));
    if contradicted.is_empty() && best.of_kind(EvidenceKind::Half) < 0.0 {
        doubts.push(
            "The .cfg decides between I first and Q first; the samples alone would have it the other way.".to_owned(),
        );
    }
    doubts
}

fn config_sentences(profile: &RadarProfile) -> Vec<String> {
    let RadarProfile { samples, receivers, loops, frames, .. } = *profile;
    let count = |number: usize, noun: &str| counted(number, noun, &format!("{noun}s"));
    let frames = if frames == 0 { "frames until stopped".to_owned() } else { count(frames, "frame") };
    let [samples, receivers] = [count(samples, "sample"), count(receivers, "receiver")];
    let [chirps, loops] = [count(profile.chirp_transmitters.len(), "chirp"), count(loops, "loop")];
    let mut sentences = vec![format!(
        "The .cfg says: carrier {:.3} GHz in the middle of the samples, bandwidth {:.1} MHz, {samples}, {receivers}, {chirps} \
         in each of {loops}, {frames}.",
        1e-9 * profile.carrier_hz(),
        1e-6 * profile.bandwidth_hz()
    )];
    sentences.extend((!profile.rises()).then(|| "The chirp falls.".to_owned()));
    let bias = profile.range_bias_metres;
    sentences.extend((bias != 0.0).then(|| format!("Ranges are {bias} m too long by the .cfg: that is taken off.")));
    sentences.extend(profile.notes.iter().cloned());
    sentences
}

/// The table `[recording.capture]` of a candidate, with counts where there is no `.cfg`.
fn capture(best: &Candidate, files: &Files, profile: Option<&RadarProfile>) -> Capture {
    let Candidate { layout, counts, .. } = best;
    let count = |value: usize| profile.is_none().then_some(value);
    let named = |path: &PathBuf| text::beside(path, &files.data);
    Capture {
        config: files.config.as_ref().map(named),
        more_files: files.more.iter().map(named).collect(),
        chips: files.chips.iter().map(named).collect(),
        encoding: layout.encoding,
        part_order: Some(layout.part_order),
        q_first: layout.q_first,
        receivers: layout.receivers,
        header_bytes: layout.header_bytes,
        samples: count(counts.samples),
        receiver_count: count(counts.receivers),
        loop_chirps: count(counts.chirps),
        loops: count(counts.loops),
        loop_choice: ChirpChoice::Joined(Join::Strongest),
        ..Capture::default()
    }
}
