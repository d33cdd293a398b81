//! Raw captures and arrays without a text: the layout found by evidence, the antennas of a board, and the TOML with both.
//!
//! A capture that is opened goes the way of every recording: the text that describes it is made, and read.
//!
//! | file | content |
//! |---|---|
//! | [`boards`] | places of antennas by a board's name |
//! | `imported` | the ways to read a file |
//! | `line` | the antennas of a `.cfg` that form one line |
//! | `beside` | the `.cfg` beside a capture, and the files that go on from it |
//! | `first_frame` | figures on the first frame: a constant part, the order of a cascade's chips |
//! | `text` | the TOML |
//! | `array` | arrays without a text |
//! | `axes` | the quantities that the axes of an array count, by evidence |

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

use super::axes::{Chirp, Join};
use super::capture::{Capture, Part};
use super::chain::{Source, opened};
use super::described::{config_text, open_file};
use super::layout::stream::Stream;
use super::layout::{Candidate, Certainty, Found, Kind, find, said as said_of};
use super::profile::RadarProfile;
use super::{Fault, Offer, Origin, Recording, RecordingError};
use crate::files::ends_in;
use boards::Board;
use first_frame::FirstFrame;
use std::io::{self, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

const OFFERED: usize = 4;

/// Whether `path` names a raw capture, an array without a text, or the `.cfg` of one, by its ending. An `.npz` is one only by its arrays:
/// [`is_raw_at`].
pub fn is_raw(path: &Path) -> bool {
    ends_in(path, &["bin", "dat", "raw", "cfg"]) || ends_in(path, &array::ENDINGS) && !ends_in(path, &["npz"])
}

/// [`is_raw`], and whether an `.npz` holds samples: an array of two axes or more, and no reflectors of a scene.
pub fn is_raw_at(path: &Path) -> bool {
    is_raw(path) || ends_in(path, &["npz"]) && array::has_samples(path)
}

/// Opens a raw capture or an array as it is: the best layout, the antennas that its `.cfg` makes likely. `config` is its `.cfg`; where none
/// is said, the one of the same name beside it, or the only one there.
///
/// # Errors
/// [`RecordingError`] names the file and what would help.
pub fn open(path: &Path, config: Option<&Path>) -> Result<Recording, RecordingError> {
    import(path, config, None)?.origin.recording()
}

/// Finds out what a raw capture or an array holds, by the antennas of `board` or of those that its `.cfg` makes likely.
///
/// # Errors
/// [`RecordingError`] names the file and what would help.
pub fn import(path: &Path, config: Option<&Path>, board: Option<&'static Board>) -> Result<Imported, RecordingError> {
    let data = beside::data_of(path)?;
    let own = (data != path).then(|| path.to_owned());
    let config = config.map(Path::to_owned).or(own).or_else(|| beside::config_of(&data));
    let profile = config.as_deref().map(read_config).transpose()?;
    if ends_in(&data, &array::ENDINGS) {
        return array::import(&data, config, profile.as_ref(), board);
    }
    let (chips, _) = beside::chips(&data);
    let files = match <[PathBuf; 4]>::try_from(chips) {
        Ok([data, chips @ ..]) => Files { data, more: Vec::new(), chips: chips.to_vec(), config },
        Err(_) => Files { more: beside::more_files(&data), data, chips: Vec::new(), config },
    };
    let stream = files.open().and_then(Stream::new).map_err(|e| Fault::from(e).of(&files.data))?;
    let profile = profile.map(|profile| profile.on_chips(1 + files.chips.len()));
    described(stream, files, profile.as_ref(), board)
}

/// Finds the layout of one frame's bytes, as a capture card sends them; `config` is the `.cfg` that set the radar up.
///
/// # Errors
/// [`RecordingError`] names the `.cfg`, or the fault of the bytes.
pub fn of_frame(bytes: Vec<u8>, config: &Path, board: Option<&'static Board>) -> Result<Imported, RecordingError> {
    let profile = read_config(config)?;
    let data = frame_path(config);
    let stream = Stream::plain(Cursor::new(bytes)).map_err(|e| Fault::from(e).of(&data))?;
    described(
        stream,
        Files { data, more: Vec::new(), chips: Vec::new(), config: Some(config.to_owned()) },
        Some(&profile),
        board,
    )
}

/// Path that the data of a frame in memory would have; there is no such file.
pub fn frame_path(config: &Path) -> PathBuf {
    config.with_file_name("frame.bin")
}

/// Bytes of a frame by the `.cfg` at `path`.
///
/// # Errors
/// [`RecordingError`] names the file and the fault.
pub fn frame_bytes(path: &Path) -> Result<usize, RecordingError> {
    let profile = read_config(path)?;
    profile.frame_bytes().ok_or_else(|| {
        Fault::key("the frame", "is larger than 1 GiB", "chirps and samples that fit in memory").of(path)
    })
}

struct Files {
    data: PathBuf,
    more: Vec<PathBuf>,
    chips: Vec<PathBuf>,
    config: Option<PathBuf>,
}

impl Files {
    fn open(&self) -> io::Result<Box<dyn Source>> {
        opened(&self.data, &self.more, &self.chips, |path| Ok(Box::new(BufReader::new(open_file(path)?))))
    }

    /// A note on files that are read as one, or on chips whose files are missing.
    fn told(&self) -> Option<String> {
        let (_, lacking) = beside::chips(&self.data);
        if !self.chips.is_empty() {
            return Some("The files of the four chips of a cascade are read as one.".to_owned());
        }
        if !self.more.is_empty() {
            return Some(format!("The capture goes on in {} more files, read as one.", self.more.len()));
        }
        (!lacking.is_empty()).then(|| {
            format!(
                "The file holds the receivers of one chip of a cascade. Beside it are missing {}: it is read alone.",
                lacking.join(", ")
            )
        })
    }
}

/// The layouts of a capture, and the texts that describe it.
fn described<R: Read + io::Seek>(
    mut stream: Stream<R>,
    files: Files,
    profile: Option<&RadarProfile>,
    board: Option<&'static Board>,
) -> Result<Imported, RecordingError> {
    let found = find(&mut stream, profile).map_err(|fault| fault.of(&files.data))?;
    let best = found.best();
    let frame = FirstFrame::read(&mut stream, &capture(best, &files, profile), profile);
    let is_cascade = !files.chips.is_empty() && board.is_none_or(|board| board.name == boards::BY_CHIP.name);
    let board = if is_cascade { Some(frame.cascade()) } else { board };
    let line = line::line(best.counts, profile, board);
    if line.transmitter_x_metres.len() * line.receiver_x_metres.len() < 2 {
        let found = "has one transmitter and one receiver, which tell ranges and no directions";
        return Err(Fault::key("the capture", found, "two elements or more").of(&files.data));
    }
    let mut doubts = doubts_of(&found, profile);
    doubts.extend(line.doubts.iter().cloned());
    doubts.extend(files.told());
    doubts.extend(frame.constant_db.map(|db| {
        format!(
            "A constant part (leakage or offset) stands {db:.0} dB over all else and is taken out: recording.capture.constant = \"keep\" keeps it."
        )
    }));
    let mut sentences = found.sentences();
    sentences.extend(profile.iter().flat_map(|p| said(p)));
    let offer = |candidate: &Candidate| {
        let line = line::line(candidate.counts, profile, board);
        let capture = Capture {
            chirps: Some(line.chirps.clone()),
            receivers_taken: line.receivers.clone(),
            constant: if frame.constant_db.is_some() { Part::Out } else { Part::Keep },
            ..capture(candidate, &files, profile)
        };
        let about = text::About { data: &files.data, profile, line: &line, sentences: &sentences };
        let (described, power) = (candidate.described(), candidate.power.clone());
        let toml = text::of_capture(&capture, candidate.counts.samples, &about);
        Offer { described, log_odds: candidate.log_odds(), power, toml }
    };
    let offers = found.candidates.iter().take(OFFERED).map(offer).collect();
    let (board, frames) = (line.board, frame.frames);
    let Files { data, config, .. } = files;
    let origin = Origin { data, config, offers, sentences, doubts, board, frames, ..Origin::default() };
    Ok(Imported { origin, found: Some(found) })
}

pub(super) fn read_config(path: &Path) -> Result<RadarProfile, RecordingError> {
    let read = || -> Result<RadarProfile, Fault> {
        let file = open_file(path)?;
        RadarProfile::parse(&config_text(file)?)
    };
    read().map_err(|fault| fault.of(path))
}

fn doubts_of(found: &Found, profile: Option<&RadarProfile>) -> Vec<String> {
    let mut doubts = found.notes.clone();
    let rivals: Vec<String> = found.rivals().into_iter().map(Candidate::described).collect();
    if found.certainty() != Certainty::Sure && !rivals.is_empty() {
        let (how, or) = match found.certainty() {
            Certainty::Open => ("open", "As likely is"),
            _ => ("likely, not sure", "It may also be"),
        };
        doubts.push(format!("The layout is {how}: {}. {or}: {}.", found.best().described(), rivals.join("; or: ")));
    }
    let best = found.best();
    let Some(profile) = profile else { return doubts };
    let against: Vec<_> = said_of(&best.layout, profile).into_iter().filter(|s| s.said != s.is).collect();
    doubts.extend(against.iter().map(|s| {
        format!("The .cfg says {}, but the samples look like {}: the layout follows the samples.", s.said, s.is)
    }));
    if against.is_empty() && best.of_kind(Kind::Half) < 0.0 {
        doubts.push(
            "The .cfg decides between I first and Q first; the samples alone would have it the other way.".to_owned(),
        );
    }
    doubts
}

/// The radar and the counts of the `.cfg`, a sentence each.
fn said(profile: &RadarProfile) -> Vec<String> {
    let RadarProfile { samples, receivers, loops, frames, .. } = *profile;
    let frames = if frames == 0 { "frames until stopped".to_owned() } else { format!("{frames} frames") };
    let mut said = vec![format!(
        "The .cfg says: carrier {:.3} GHz in the middle of the samples, bandwidth {:.1} MHz, {samples} samples, {receivers} receivers, {} chirps \
         in each of {loops} loops, {frames}.",
        1e-9 * profile.carrier_hz(),
        1e-6 * profile.bandwidth_hz(),
        profile.chirp_transmitters.len()
    )];
    said.extend((!profile.rises()).then(|| "The chirp falls.".to_owned()));
    let bias = profile.range_bias_metres;
    said.extend((bias != 0.0).then(|| format!("Ranges are {bias} m too long by the .cfg: that is taken off.")));
    said.extend(profile.notes.iter().cloned());
    said
}

/// A candidate's layout as it stands in a text.
fn capture(best: &Candidate, files: &Files, profile: Option<&RadarProfile>) -> Capture {
    let Candidate { layout, counts, .. } = best;
    let said = |value: usize| profile.is_none().then_some(value);
    let named = |path: &PathBuf| text::beside(path, &files.data);
    Capture {
        config: files.config.as_ref().map(named),
        more_files: files.more.iter().map(named).collect(),
        chips: files.chips.iter().map(named).collect(),
        words: layout.words,
        parts: Some(layout.parts),
        q_first: layout.q_first,
        receivers: layout.receivers,
        header_bytes: layout.header_bytes,
        samples: said(counts.samples),
        receiver_count: said(counts.receivers),
        loop_chirps: said(counts.chirps),
        loops: said(counts.loops),
        turn: Chirp::Joined(Join::Strongest),
        ..Capture::default()
    }
}
