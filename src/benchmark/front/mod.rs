//! The front of run time against error: the time of three Lambda maps and their error, by algorithm, precision, tolerance and number of reflectors.
//!
//! [`measure`] serves `apertura bench` and the window, which draws the front while it grows: it calls back with every row and can be stopped.
//! [`FrontRequest::short`] takes a second or two, [`FrontRequest::full`] about a minute.
//!
//! The floor's noise is made beforehand, for the plain algorithms as for the fast ones; its scaling to the scene's level is timed.
//! Times end when three Lambda maps are ready, on all threads; [`Front::bare_fft_ms`] is one bare two-dimensional transform on one thread,
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

/// The combinations to measure. Each gives a row, except for [`Algorithm::Direct`] and [`Algorithm::Exact`], which have neither tolerance nor
/// single precision nor dragging: they give one row for each number of reflectors up to 1000.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontRequest {
    pub reflectors: Vec<usize>,
    /// Tolerances, relative to the peak.
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

    /// A request of a second or two: few reflectors, few repeats, the fast algorithms alone, from scratch.
    pub fn short() -> Self {
        let mut short = FrontRequest::full(vec![1, 10, 75], 3);
        short.entrants.retain(|entrant| !matches!(entrant, Entrant::Forced(algorithm) if !algorithm.is_fast()));
        short.tasks.truncate(1);
        short
    }
}

/// The measured choice of algorithm: the planner's, or a forced one. Written and read as "plan" or the algorithm's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
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
    type Err = String;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        if s == "plan" { Ok(Entrant::Planned) } else { s.parse().map(Entrant::Forced) }
    }
}

/// The timed task, until three Lambda maps are ready.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FrontTask {
    /// The scene is new to the engine.
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

/// Floor beneath the reflectors, and normalisation from decades to Lambda: an error of Lambda has a meaning only with both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MapConvention {
    #[serde(serialize_with = "as_text")]
    pub floor: Floor,
    #[serde(serialize_with = "as_text")]
    pub normalisation: Normalisation,
}

impl MapConvention {
    /// The thesis' convention: its rounding floor, normalised from the smallest to the largest cell.
    pub const THESIS: MapConvention = MapConvention { floor: Floor::Thesis, normalisation: Normalisation::MinMax };
    /// A convention that is stable in any precision: no floor, normalised from 100 dB below the peak.
    pub const FIXED_RANGE: MapConvention = MapConvention {
        floor: Floor::Exact,
        normalisation: Normalisation::DynamicRange(crate::radar::Decibels(100.0)),
    };
    /// No floor, normalised by the smallest cell: the picture's floor is the last bits of the algorithm.
    pub const NO_FLOOR: MapConvention = MapConvention { floor: Floor::Exact, normalisation: Normalisation::MinMax };
    pub const BOTH: [MapConvention; 2] = [MapConvention::FIXED_RANGE, MapConvention::THESIS];

    /// The convention in which maps of this tolerance are accurate, and in which they are timed.
    pub fn for_tolerance(tolerance: f64) -> MapConvention {
        if tolerance >= 1e-6 { MapConvention::FIXED_RANGE } else { MapConvention::THESIS }
    }
}

impl fmt::Display for MapConvention {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.floor, self.normalisation)
    }
}

/// Serialises a floor, a normalisation or an entrant as the command line writes it.
fn as_text<S: Serializer>(value: &impl fmt::Display, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(value)
}

/// Error of three maps against the exact path's, over one floor and normalisation.
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
    #[serde(serialize_with = "as_text")]
    pub algorithm: Entrant,
    /// The planner's choice for the whole scene, or the forced algorithm.
    pub chosen: Algorithm,
    /// Precision of everything after the phase.
    pub precision: Precision,
    /// Tolerance, relative to the peak.
    pub tolerance: f64,
    #[serde(flatten)]
    pub convention: MapConvention,
    pub median_ms: f64,
    /// Distance between the first and the third quartile of the repeats, milliseconds.
    pub spread_ms: f64,
    pub fastest_ms: f64,
    pub repeats: usize,
    /// Largest error of a range cell against the judge (every range bin of a few elements), relative to the largest.
    pub signal_error: f64,
    /// Errors of Lambda in every convention of [`MapConvention::BOTH`].
    pub lambda: Vec<LambdaError>,
}

/// A measured front, as `bench.json` has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Front<R = FrontRow> {
    /// Median time of a bare 512 x 1024 single-precision transform on one thread, in the same run.
    pub bare_fft_ms: f64,
    pub threads: usize,
    pub simd: Simd,
    pub rows: Vec<R>,
}
