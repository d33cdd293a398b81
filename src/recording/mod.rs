//! Recordings: samples that a radar measured, with the radar that measured them.
//!
//! A recording is a data file and a TOML beside it that describes it. The layout of a raw capture without a TOML is found by evidence.
//!
//! | file | content |
//! |---|---|
//! | [`file`], `recording_text`, `radar_table`, `recording_table` | the TOML: `[radar]` and `[recording]` |
//! | `samples` | samples of the data files, in the order of the elements |
//! | `chain` | several files that are read as one |
//! | `numpy` | `.npy` and `.npz` |
//! | `matlab` | `.mat`, versions 5 and 7 |
//! | `hdf5` | `.h5`, and `.mat` of version 7.3 |
//! | `capture`, `profile` | samples of a capture card, and the `.cfg` that set the radar up |
//! | [`layout`] | layouts of a raw capture's bytes, by evidence |
//! | [`raw`] | raw captures and arrays without a TOML, for which one is written |
//! | `origin` | the file of a recording, its frames and other ways to read it |
//! | [`packets`], [`card`] | frames from the packets of a capture card; their reception |
//! | `axes`, `analytic` | an array of any shape, of real samples too, to `[elements, samples]` |
//! | `calibration` | gain and phase of each element |
//! | `signs` | the sign of the phases, and the place of the carrier on the chirp |
//! | `doubts` | warnings about a recording that looks wrong but may be right |
//!
//! [`presets`] come with the program. [`explain`] fits reflectors to a recording and returns the residual.

mod analytic;
mod axes;
mod calibration;
mod capture;
pub mod card;
mod chain;
mod doubts;
mod error;
pub mod explain;
pub mod file;
mod hdf5;
pub mod layout;
mod matlab;
mod numbers;
mod numpy;
mod origin;
pub mod packets;
pub mod presets;
mod profile;
mod radar_table;
pub mod raw;
mod recording_table;
mod recording_text;
mod samples;
mod signs;

pub use error::{Fault, RecordingError};
pub use origin::{Origin, ReadingOption};
pub use profile::RadarProfile;
pub use profile::lines::config_text;
pub use recording_text::FrameLoops;

use crate::radar::Radar;
use crate::signal::{BeatSignal, TwoEnds};
use axes::{AxisKind, ChirpChoice};
use calibration::Calibration;
use capture::Capture;
use std::sync::Arc;

/// Samples of a radar's elements, and the radar.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Its name; empty for none.
    pub name: String,
    /// The recording's source, and hints on its echoes.
    pub notes: String,
    /// The radar that measured it. Its carrier is the one that the maps' formula needs for these samples (`signs`), which may differ from the text's.
    pub radar: Radar,
    /// The measured samples.
    pub samples: Recorded,
    /// Elements of the whole array that were not recorded, in rising order. Their samples are zeros.
    pub missing: Vec<usize>,
    /// Range of all echoes of a snapshot (`radar.samples` = 1), metres: one sample has no range.
    pub range_metres: Option<f64>,
    /// Doubts that the samples can't settle, a sentence each.
    pub doubts: Vec<String>,
    /// The file and other ways to read it. `None` where only one frame and one way exist.
    pub origin: Option<Arc<Origin>>,
}

/// The elements whose samples a recording holds, with the samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Recorded {
    /// Samples of every element.
    All(BeatSignal),
    /// Samples of the two ends alone.
    Ends(TwoEnds),
}

impl Recording {
    /// The samples of the two ends: the input of a reconstruction.
    pub fn two_ends(&self) -> TwoEnds {
        match &self.samples {
            Recorded::All(signal) => signal.two_ends(&self.radar),
            Recorded::Ends(ends) => ends.clone(),
        }
    }

    /// The samples of all elements, `[elements, samples]`, where they were recorded.
    pub fn signal(&self) -> Option<&BeatSignal> {
        match &self.samples {
            Recorded::All(signal) => Some(signal),
            Recorded::Ends(_) => None,
        }
    }

    /// Whether it is one snapshot of the array at one range: a single sample an element.
    pub fn is_snapshot(&self) -> bool {
        self.radar.samples == 1
    }

    /// Whether it can be shown with `radar`, which may differ in window, focusing, chirp duration, budget, and, with every element recorded, ends.
    pub fn fits(&self, radar: &Radar) -> bool {
        let end_elements = if self.signal().is_some() { radar.end_elements } else { self.radar.end_elements };
        let Radar { window, chirp_seconds, budget, focus_off_line, .. } = *radar;
        Radar { window, chirp_seconds, budget, focus_off_line, end_elements, ..self.radar.clone() } == *radar
    }

    /// A recording of `signal`, as if `radar` had measured it.
    pub fn of_signal(radar: Radar, signal: BeatSignal) -> Self {
        Recording {
            name: String::new(),
            notes: String::new(),
            radar,
            samples: Recorded::All(signal),
            missing: Vec::new(),
            range_metres: None,
            doubts: Vec::new(),
            origin: None,
        }
    }
}
