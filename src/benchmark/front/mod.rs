//! The front of run time against error: how long three Lambda maps take, and how far they are from the truth, by algorithm,
//! precision, tolerance and number of reflectors.
//!
//! [`measure`] does the work for `apertura bench` and for the window, which draws the front while it grows: it calls back with every row and
//! stops when asked to. [`FrontRequest::short`] takes a second or two, [`FrontRequest::full`] about a minute.
//!
//! The floor's noise is made beforehand, for the plain algorithms as for the fast ones; it is scaled to the scene's level inside the time.
//! Times are for three Lambda maps ready, on all threads; [`Front::bare_fft_ms`] is one bare two-dimensional transform on one thread,
//! measured in the same run.

mod measurement;
pub(super) mod reference;

pub use measurement::{measure, scattered};

use crate::maps::Normalisation;
use crate::signal::simd::Simd;
use crate::signal::{Algorithm, Floor, Precision};
use serde::{Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// What is measured. Every combination gives a row, but for [`Algorithm::Direct`] and [`Algorithm::Exact`]: they know neither
/// tolerance nor single precision nor dragging, and give one row for each number of reflectors up to 1000.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontRequest {
    pub reflectors: Vec<usize>,
    /// Errors allowed, relative to the peak.
    pub tolerances: Vec<f64>,
    pub entrants: Vec<Entrant>,
    pub tasks: Vec<FrontTask>,
    /// Timed repeats of every measurement; 0 counts as 1.
    pub repeats: usize,
}

impl FrontRequest {
    pub fn full(reflectors: Vec<usize>, repeats: usize) -> Self {
        FrontRequest {
            reflectors,
            tolerances: vec![1e-3, 1e-6, 1e-9, 1e-12],
            entrants: std::iter::once(Entrant::Planned).chain(Algorithm::ALL.map(Entrant::Forced)).collect(),
            tasks: vec![FrontTask::Scratch, FrontTask::Drag],
            repeats,
        }
    }

    /// A second or two: few reflectors, few repeats, the fast algorithms alone, from scratch.
    pub fn short() -> Self {
        FrontRequest {
            entrants: [Entrant::Planned]
                .into_iter()
                .chain(Algorithm::ALL.into_iter().filter(|a| a.is_fast()).map(Entrant::Forced))
                .collect(),
            tasks: vec![FrontTask::Scratch],
            ..FrontRequest::full(vec![1, 10, 75], 3)
        }
    }
}

/// Who is measured: the planner, or an algorithm forced upon it. Written and read as "plan" or the algorithm's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(into = "String")]
pub enum Entrant {
    Planned,
    Forced(Algorithm),
}

impl Entrant {
    pub fn name(self) -> &'static str {
        match self {
            Entrant::Planned => "plan",
            Entrant::Forced(algorithm) => algorithm.name(),
        }
    }
}

impl fmt::Display for Entrant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Entrant {
    type Err = crate::signal::UnknownAlgorithm;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        if s == "plan" { Ok(Entrant::Planned) } else { s.parse().map(Entrant::Forced) }
    }
}

impl From<Entrant> for String {
    fn from(entrant: Entrant) -> String {
        entrant.name().to_owned()
    }
}

/// What is timed, until three Lambda maps are ready.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FrontTask {
    /// Nothing of the scene is known before.
    Scratch,
    Drag,
}

impl FrontTask {
    pub fn name(self) -> &'static str {
        match self {
            FrontTask::Scratch => "scratch",
            FrontTask::Drag => "drag",
        }
    }
}

/// What lies beneath the reflectors, and how decades become Lambda: no error of Lambda means anything without both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MapConvention {
    #[serde(serialize_with = "as_text")]
    pub floor: Floor,
    #[serde(serialize_with = "as_text")]
    pub normalisation: Normalisation,
}

impl MapConvention {
    /// The thesis': its rounding floor, normalised from the smallest to the largest cell.
    pub const THESIS: MapConvention = MapConvention { floor: Floor::Thesis, normalisation: Normalisation::MinMax };
    /// Stable in any precision: no floor, 100 dB below the peak.
    pub const FIXED_RANGE: MapConvention = MapConvention {
        floor: Floor::Exact,
        normalisation: Normalisation::DynamicRange(crate::radar::Decibels(100.0)),
    };
    /// No floor, normalised by the smallest cell: the picture's floor is the last bits of the algorithm.
    pub const NO_FLOOR: MapConvention = MapConvention { floor: Floor::Exact, normalisation: Normalisation::MinMax };
    pub const BOTH: [MapConvention; 2] = [MapConvention::FIXED_RANGE, MapConvention::THESIS];

    /// The convention that maps of this tolerance are good for, and timed with.
    pub fn for_tolerance(tolerance: f64) -> MapConvention {
        if tolerance >= 1e-6 { MapConvention::FIXED_RANGE } else { MapConvention::THESIS }
    }
}

impl fmt::Display for MapConvention {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.floor, self.normalisation)
    }
}

/// A floor or a normalisation as the command line writes it.
fn as_text<S: Serializer>(value: &impl fmt::Display, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(value)
}

/// How far three maps are from the exact path's, over one floor and normalisation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LambdaError {
    #[serde(flatten)]
    pub convention: MapConvention,
    pub max: f64,
    pub rms: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrontRow {
    pub task: FrontTask,
    pub reflectors: usize,
    pub algorithm: Entrant,
    /// What the planner chose for the whole scene, or the algorithm again.
    pub chosen: Algorithm,
    /// Precision of everything after the phase.
    pub precision: Precision,
    /// Error asked for, relative to the peak.
    pub tolerance: f64,
    #[serde(flatten)]
    pub convention: MapConvention,
    pub median_ms: f64,
    /// From the first to the third quartile of the repeats.
    pub spread_ms: f64,
    pub fastest_ms: f64,
    pub repeats: usize,
    /// Largest error of a range cell against the judge (every range bin of a few elements), relative to the largest.
    pub signal_error: f64,
    /// Errors of Lambda in every convention of [`MapConvention::BOTH`].
    pub lambda: Vec<LambdaError>,
}

/// A measured front, as it stands in `bench.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Front {
    /// Median time of a bare 512 x 1024 single-precision transform on one thread, in the same run.
    pub bare_fft_ms: f64,
    pub threads: usize,
    pub simd: Simd,
    pub rows: Vec<FrontRow>,
}
