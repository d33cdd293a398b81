//! Detection at a constant false-alarm rate: each cell against a threshold from the cells around it.
//!
//! A window around the cell under test has guard cells, which may contain the cell's echo, and training cells beyond them, by which the noise is
//! estimated. The cell is a detection where its power exceeds the noise times a factor. The factor follows from the wanted rate of false
//! alarms, for noise whose power is exponentially distributed and independent from cell to cell.
//!
//! * Cell averaging (H. M. Finn and R. S. Johnson, *Adaptive detection mode with threshold control as a function of spatially sampled
//!   clutter-level estimates*, RCA Review 29, 1968) uses the mean of the training cells.
//! * Ordered statistics (H. Rohling, *Radar CFAR thresholding in clutter and multiple target situations*, IEEE Transactions on Aerospace and
//!   Electronic Systems 19, 1983) uses the training cell of rank 3/4, which strong echoes among the training cells hardly raise.
//!
//! A window function or missing elements correlate neighbouring cells. The false-alarm rate then differs from the nominal one.

mod factor;
mod text;
mod window;

pub use factor::{averaging_factor, ordered_factor};

use super::lambda::{LambdaScale, Mask, RangeAngleMap};
use ndarray::{Array2, ArrayView2};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Most guard or training cells a side.
pub const MAX_CELLS: usize = 1000;

/// The threshold between the two values of a map of detected cells ([`Mask::as_map`]).
pub const DETECTION_THRESHOLD: f32 = 0.5;

const RANK_PART: f64 = 0.75;

/// The noise estimate from the training cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Statistic {
    CellAveraging,
    /// The cell of rank 3/4 among them.
    OrderedStatistics,
}

impl Statistic {
    pub const ALL: [Statistic; 2] = [Statistic::CellAveraging, Statistic::OrderedStatistics];

    pub fn name(self) -> &'static str {
        self.names()[0]
    }

    /// Name of a detector with this estimate, in captions.
    pub fn short_name(self) -> &'static str {
        self.names()[1]
    }

    /// Names in sentences, in captions and in a detector's text.
    fn names(self) -> [&'static str; 3] {
        match self {
            Statistic::CellAveraging => ["cell averaging", "CA-CFAR", "ca"],
            Statistic::OrderedStatistics => ["ordered statistics", "OS-CFAR", "os"],
        }
    }
}

/// A detector with a constant false-alarm rate. Its text is `ca:guard=4x0:training=16x0:rate=0.0001`, cells as range bins x columns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Cfar {
    pub statistic: Statistic,
    /// Guard cells a side, `[range bins, columns]`.
    pub guard: [usize; 2],
    /// Training cells a side beyond the guard cells, `[range bins, columns]`.
    pub training: [usize; 2],
    /// Wanted rate of false alarms, between 0 and 1.
    pub false_alarm: f64,
}

impl Default for Cfar {
    fn default() -> Self {
        Cfar { statistic: Statistic::CellAveraging, guard: [4, 0], training: [16, 0], false_alarm: 1e-4 }
    }
}

/// A reason for which a detector can't be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CfarError {
    #[error("the wanted false-alarm rate is {0}; expected a number between 0 and 1, without these")]
    Rate(f64),
    #[error("there are no training cells; expected at least one a side, in range or in angle")]
    NoTraining,
    #[error("{what} are {cells} cells a side; expected at most {MAX_CELLS}")]
    Large { what: &'static str, cells: usize },
    #[error("guard and training cells span {span} columns and the map has {columns}; expected fewer cells in angle")]
    Wide { span: usize, columns: usize },
    #[error(
        "the guard of {guard} range bins a side leaves no training cell around range bin {bin} of {bins}; expected \
         fewer guard cells or more training cells"
    )]
    Covered { guard: usize, bin: usize, bins: usize },
    #[error("\"{0}\" is no detector; expected ca or os, as in ca:guard=4x0:training=16x0:rate=0.0001")]
    Text(String),
}

/// Noise estimate and threshold of one cell, in the map's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    pub training: usize,
    pub noise: f64,
    /// The noise times the factor: the cell is a detection above it.
    pub threshold: f64,
    pub power: f64,
}

impl Level {
    pub fn is_detected(&self) -> bool {
        self.power > self.threshold
    }
}

/// Power of every cell relative to the map's peak, linear, from Lambda; at Lambda 0 an upper bound, where a dynamic range limits the map.
pub fn relative_power(map: &RangeAngleMap, scale: LambdaScale) -> Array2<f64> {
    let decades = 2.0 * (scale.peak - scale.floor).max(0.0);
    map.lambda.mapv(|lambda| 10f64.powf((f64::from(lambda) - 1.0) * decades))
}

impl Cfar {
    /// Checks the detector's rate and cells.
    /// # Errors
    /// [`CfarError`] names the fault and the values allowed.
    pub fn check(&self) -> Result<(), CfarError> {
        if !(self.false_alarm > 0.0 && self.false_alarm < 1.0) {
            return Err(CfarError::Rate(self.false_alarm));
        }
        if self.training == [0, 0] {
            return Err(CfarError::NoTraining);
        }
        for (what, sides) in [("the guard cells", self.guard), ("the training cells", self.training)] {
            if let Some(&cells) = sides.iter().find(|cells| **cells > MAX_CELLS) {
                return Err(CfarError::Large { what, cells });
            }
        }
        Ok(())
    }

    /// Checks that the detector can work on a map of `[range bins, columns]`.
    /// # Errors
    /// [`CfarError`] names the fault and the values allowed.
    pub fn check_map(&self, [bins, columns]: [usize; 2]) -> Result<(), CfarError> {
        self.check()?;
        let span = 2 * (self.guard[1] + self.training[1]) + 1;
        if span > columns {
            return Err(CfarError::Wide { span, columns });
        }
        match (0..bins).find(|bin| self.training_cells(*bin, bins) == 0) {
            Some(bin) => Err(CfarError::Covered { guard: self.guard[0], bin, bins }),
            None => Ok(()),
        }
    }

    /// Training cells around a cell of range bin `bin` of `bins`: fewer where the map ends. Columns wrap around, as angles do.
    pub fn training_cells(&self, bin: usize, bins: usize) -> usize {
        window::Window::new(self.guard, self.training).cells(bin, bins)
    }

    fn factor(&self, training: usize) -> f64 {
        match self.statistic {
            Statistic::CellAveraging => averaging_factor(training, self.false_alarm),
            Statistic::OrderedStatistics => ordered_factor(training, rank(training), self.false_alarm),
        }
    }

    /// The detections. `power` is linear, `[range bins, columns]`, in any unit.
    ///
    /// The time is proportional to the map's cells, and to the window's sides for cell averaging, or to the training cells for ordered statistics.
    /// # Errors
    /// [`Cfar::check_map`].
    pub fn detect(&self, power: ArrayView2<'_, f64>) -> Result<Mask, CfarError> {
        let (bins, columns) = power.dim();
        self.check_map([bins, columns])?;
        let window = window::Window::new(self.guard, self.training);
        let mut factors = BTreeMap::new();
        let with_factor = |n: usize| (n, *factors.entry(n).or_insert_with(|| self.factor(n)));
        let by_bin: Vec<(usize, f64)> = (0..bins).map(|bin| window.cells(bin, bins)).map(with_factor).collect();
        let cells = match self.statistic {
            Statistic::CellAveraging => window.above_sum(power, |bin| by_bin[bin].1 / by_bin[bin].0 as f64),
            Statistic::OrderedStatistics => window.above_rank(power, |bin| (rank(by_bin[bin].0), by_bin[bin].1)),
        };
        Ok(Mask { cells })
    }

    /// As [`Cfar::detect`], of a map of Lambda by `scale`.
    /// # Errors
    /// [`Cfar::check_map`].
    pub fn detect_lambda(&self, map: &RangeAngleMap, scale: LambdaScale) -> Result<Mask, CfarError> {
        self.detect(relative_power(map, scale).view())
    }

    /// Noise estimate and threshold of one cell `[bin, column]`, for the power `of` each cell of a map of `[range bins, columns]`.
    /// # Errors
    /// As [`Cfar::check_map`].
    /// # Panics
    /// Where the map has no such cell.
    pub fn level(&self, of: impl Fn([usize; 2]) -> f64, map: [usize; 2], cell: [usize; 2]) -> Result<Level, CfarError> {
        self.check_map(map)?;
        let mut training: Vec<f64> =
            window::Window::new(self.guard, self.training).around(cell, map).map(&of).collect();
        let n = training.len();
        let noise = match self.statistic {
            Statistic::CellAveraging => training.iter().sum::<f64>() / n as f64,
            Statistic::OrderedStatistics => *training.select_nth_unstable_by(rank(n) - 1, f64::total_cmp).1,
        };
        Ok(Level { training: n, noise, threshold: self.factor(n) * noise, power: of(cell) })
    }
}

fn rank(training: usize) -> usize {
    ((RANK_PART * training as f64).round() as usize).clamp(1, training.max(1))
}

#[cfg(test)]
mod tests;
