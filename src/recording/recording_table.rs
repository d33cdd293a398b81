//! The table `[recording]` of a recording's TOML.

use super::{AxisKind, Calibration, Capture, ChirpChoice, Fault};
use crate::radar::{End, Radar};
use serde::Deserialize;
use std::path::Path;

/// The keys of the table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordingTable {
    pub file: String,
    pub array: Option<String>,
    pub first: Option<String>,
    pub last: Option<String>,
    pub axes: Option<Vec<AxisKind>>,
    pub chirp: Option<ChirpChoice>,
    pub frame: Option<usize>,
    /// Number of transmitters that send in turn along the axis of chirps.
    pub transmitters_in_turn: Option<usize>,
    /// Indices of the transmitters and receivers that form the line of elements; all where the key is missing.
    pub transmitters_taken: Option<Vec<usize>>,
    pub receivers_taken: Option<Vec<usize>>,
    #[serde(default)]
    elements: CoveredElements,
    #[serde(default)]
    pub missing: Vec<usize>,
    pub range_metres: Option<f64>,
    /// Whether the samples are conjugated; only in format 1.
    pub conjugate: Option<bool>,
    pub carrier_at: Option<CarrierAt>,
    pub beat_sign: Option<BeatSign>,
    pub sweep: Option<Sweep>,
    #[serde(default)]
    pub reverse_elements: bool,
    #[serde(default)]
    pub calibration: Calibration,
    pub capture: Option<Capture>,
    /// Whether the table `[radar]` has places of antennas.
    #[serde(skip)]
    pub has_antenna_places: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum CoveredElements {
    #[default]
    All,
    Ends,
}

/// The sample at which the chirp has the frequency `radar.carrier_hz`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum CarrierAt {
    FirstSample,
    Middle,
}

/// Sign of the beat frequencies of echoes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub(super) enum BeatSign {
    #[serde(rename = "+")]
    Positive,
    #[serde(rename = "-")]
    Negative,
}

/// Direction in which the chirp's frequency changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Sweep {
    #[default]
    Up,
    Down,
}

impl RecordingTable {
    /// Checks `range_metres` and `missing` against `radar`.
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
        self.covered_elements(radar).into_iter().for_each(|n| may_miss[n] = true);
        for element in &self.missing {
            if !may_miss.get_mut(*element).is_some_and(std::mem::take) {
                let expected = format!("elements that the file is to hold, each once, below {}", radar.elements);
                return Err(Fault::key("recording.missing", format!("names element {element}"), expected));
            }
        }
        Ok(())
    }

    /// Replaces the frame of the text by `frame`; `None` keeps it.
    pub fn select_frame(&mut self, frame: Option<u64>) {
        match (&mut self.capture, frame) {
            (_, None) => {}
            (Some(capture), Some(frame)) => capture.frame = frame as usize,
            (None, Some(frame)) => {
                let counts_frames = self.axes.iter().flatten().any(|kind| *kind == AxisKind::Frame);
                self.frame = counts_frames.then_some(frame as usize);
            }
        }
    }

    /// Whether an echo's phase rises from sample to sample of the file.
    pub fn beat_rises(&self) -> bool {
        self.beat_sign != Some(BeatSign::Negative)
    }

    /// Elements of the whole array whose samples the file should hold, in its order.
    pub fn covered_elements(&self, radar: &Radar) -> Vec<usize> {
        match self.covers() {
            CoveredElements::All => (0..radar.elements).collect(),
            CoveredElements::Ends => End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).collect(),
        }
    }

    /// Whether the file should hold all elements or the two ends.
    pub fn covers(&self) -> CoveredElements {
        if self.first.is_some() { CoveredElements::Ends } else { self.elements }
    }

    /// Whether the rows of the file are pairs of transmitters and receivers whose places the text has.
    pub fn counts_pairs(&self) -> bool {
        let has_pairs = |axes: &Vec<AxisKind>| axes.contains(&AxisKind::Transmitter);
        let in_turn = self.transmitters_in_turn.is_some();
        self.has_antenna_places && (self.capture.is_some() || in_turn || self.axes.as_ref().is_some_and(has_pairs))
    }

    /// Extension of the data file in lower case, without the dot.
    pub fn extension(&self) -> String {
        Path::new(&self.file).extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase()
    }
}
