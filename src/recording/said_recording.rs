//! The table `[recording]` of a recording's TOML.

use super::{AxisKind, Calibration, Capture, Chirp, Fault};
use crate::radar::{End, Radar};
use serde::Deserialize;
use std::path::Path;

/// The keys of the table; `check` holds them to the radar.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Table {
    pub file: String,
    pub array: Option<String>,
    pub first: Option<String>,
    pub last: Option<String>,
    pub axes: Option<Vec<AxisKind>>,
    pub chirp: Option<Chirp>,
    pub frame: Option<usize>,
    /// Number of transmitters that send in turn along the axis of chirps.
    pub transmitters_in_turn: Option<usize>,
    /// Transmitters and receivers that form the line of elements; all where nothing is said.
    pub transmitters_taken: Option<Vec<usize>>,
    pub receivers_taken: Option<Vec<usize>>,
    #[serde(default)]
    elements: Covers,
    #[serde(default)]
    pub missing: Vec<usize>,
    pub range_metres: Option<f64>,
    /// Whether the samples are conjugated: format 1 alone.
    pub conjugate: Option<bool>,
    pub carrier_at: Option<CarrierAt>,
    pub beat_sign: Option<BeatSign>,
    pub sweep: Option<Sweep>,
    #[serde(default)]
    pub reverse_elements: bool,
    #[serde(default)]
    pub calibration: Calibration,
    pub capture: Option<Capture>,
    /// Whether the text gives places of antennas.
    #[serde(skip)]
    pub has_places: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Covers {
    #[default]
    All,
    Ends,
}

/// Place of the frequency `radar.carrier_hz` on the chirp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum CarrierAt {
    FirstSample,
    Middle,
}

/// The sign of the beat's phase as samples go on, for an echo that is farther than the radar itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub(super) enum BeatSign {
    /// Echoes stand at positive frequencies.
    #[serde(rename = "+")]
    Positive,
    /// Echoes stand at negative frequencies.
    #[serde(rename = "-")]
    Negative,
}

/// Direction of the frequency from sample to sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Sweep {
    #[default]
    Up,
    Down,
}

impl Table {
    /// Checks that the keys of the TOML agree with each other and with `radar`.
    pub fn check(&self, radar: &Radar) -> Result<(), Fault> {
        let unfit = match (radar.samples, self.range_metres) {
            (1, None) => {
                Some(("is missing".to_owned(), "the range of the snapshot in metres: one sample cannot tell it"))
            }
            (1, Some(range)) if !(range.is_finite() && range > 0.0) => {
                Some((format!("is {range}"), "a number above 0"))
            }
            (2.., Some(_)) => {
                Some(("is there".to_owned(), "it only where radar.samples is 1: several samples tell ranges"))
            }
            _ => None,
        };
        if let Some((found, expected)) = unfit {
            return Err(Fault::key("recording.range_metres", found, expected));
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

    /// Chooses another frame than the text's.
    pub fn look_at(&mut self, frame: Option<u64>) {
        match (&mut self.capture, frame) {
            (_, None) => {}
            (Some(capture), Some(frame)) => capture.frame = frame as usize,
            (None, Some(frame)) => {
                let counts_frames = self.axes.iter().flatten().any(|kind| *kind == AxisKind::Frame);
                self.frame = counts_frames.then_some(frame as usize);
            }
        }
    }

    /// Whether the phase of an echo rises from sample to sample of the file.
    pub fn beat_rises(&self) -> bool {
        self.beat_sign != Some(BeatSign::Negative)
    }

    /// Elements of the whole array that the file should hold, in its order.
    pub fn covered(&self, radar: &Radar) -> Vec<usize> {
        match self.covers() {
            Covers::All => (0..radar.elements).collect(),
            Covers::Ends => End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).collect(),
        }
    }

    /// The elements whose samples the file holds.
    pub fn covers(&self) -> Covers {
        if self.first.is_some() { Covers::Ends } else { self.elements }
    }

    /// Whether the file counts transmitters and receivers whose places the text gives: the places then give each element's pair.
    pub fn counts_pairs(&self) -> bool {
        let has_both = |axes: &Vec<AxisKind>| axes.contains(&AxisKind::Transmitter);
        let in_turn = self.transmitters_in_turn.is_some();
        self.has_places && (self.capture.is_some() || in_turn || self.axes.as_ref().is_some_and(has_both))
    }

    /// Ending of the data file's name, in small letters, without the dot.
    pub fn extension(&self) -> String {
        Path::new(&self.file).extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase()
    }
}
