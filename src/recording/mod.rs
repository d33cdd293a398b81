//! Recordings: samples that a radar measured, with the radar that measured them.
//!
//! A recording is a data file and a TOML beside it that says what the data are. Of a raw capture without one the layout is found by evidence.
//!
//! | file | content |
//! |---|---|
//! | [`file`], `described`, `said_radar`, `said_recording` | the TOML: `[radar]` and `[recording]` |
//! | `samples` | samples of the data files, in the order of the elements |
//! | `chain` | files that go on from one to the next |
//! | `numpy` | `.npy` and `.npz` |
//! | `matlab` | `.mat`, versions 5 and 7 |
//! | `hdf5` | `.h5`, and `.mat` of version 7.3 |
//! | `capture`, `profile` | samples of a capture card, and the `.cfg` that set the radar up |
//! | [`layout`] | layouts of a raw capture's bytes, by evidence |
//! | [`raw`] | raw captures and arrays as they are: the text that describes them is made |
//! | `origin` | the file of a recording, its frames and other ways to read it |
//! | [`packets`], [`card`] | packets that a capture card sends, to frames; listening to them |
//! | `axes`, `analytic` | an array of any shape, of real samples too, to `[elements, samples]` |
//! | `calibration` | gains and phases that are taken off each element |
//! | `signs` | the sign of the phases, and the place of the carrier on the chirp |
//! | `doubts` | warnings that the samples can't settle |
//!
//! [`presets`] come with the program. [`explain`] fits reflectors to a recording and returns the residual.

mod analytic;
mod axes;
mod calibration;
mod capture;
pub mod card;
mod chain;
mod described;
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
pub mod raw;
mod said_radar;
mod said_recording;
mod samples;
mod signs;

pub use described::FrameLoops;
pub use error::{Fault, RecordingError};
pub use origin::{Offer, Origin};
pub use profile::RadarProfile;
pub use profile::lines::text_of as config_text;

use crate::radar::Radar;
use crate::signal::{BeatSignal, TwoEnds};
use axes::{AxisKind, Chirp};
use calibration::Calibration;
use capture::Capture;
use std::sync::Arc;

/// Samples of a radar's elements, and the radar.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The recording's name; empty for none.
    pub name: String,
    /// The recording's source, and hints on its echoes.
    pub notes: String,
    /// The radar that measured it. Its carrier is the one that the maps' formula needs for these samples, which is not always the
    /// one that the text says.
    pub radar: Radar,
    /// The measured samples.
    pub samples: Recorded,
    /// Elements of the whole array that measured nothing, in rising order; their samples are silence.
    pub missing: Vec<usize>,
    /// Range of all echoes of a snapshot (`radar.samples` = 1), metres: its one sample cannot tell.
    pub range_metres: Option<f64>,
    /// Doubts that the samples can't settle, a sentence each.
    pub doubts: Vec<String>,
    /// The file, and other ways to read it, where no text of the user's describes it.
    pub origin: Option<Arc<Origin>>,
}

/// The elements whose samples a recording holds, with the samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Recorded {
    /// Samples of every element: the whole array's map is known.
    All(BeatSignal),
    /// Samples of the two ends alone.
    Ends(TwoEnds),
}

impl Recording {
    /// The samples of the two ends: what a reconstruction may look at.
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

    /// Whether it can be shown with `radar`: the constants that it was recorded with must be the same. Others may differ: the window, focusing,
    /// the duration of a chirp, the link budget, and, where every element was recorded, which elements are the ends.
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
