//! Lambda, the normalised log-magnitude, with thresholds and masks.

use crate::radar::Decibels;
use ndarray::Array2;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A normalisation of decades to Lambda in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Normalisation {
    /// 0 at the map's smallest cell, 1 at its largest (the thesis). The smallest cell is rounding or noise, so Lambda depends on the floor.
    #[default]
    MinMax,
    /// 1 at the largest cell, 0 at this distance below it and lower. It does not depend on the floor.
    DynamicRange(Decibels),
}

impl FromStr for Normalisation {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        if s == "min-max" {
            return Ok(Normalisation::MinMax);
        }
        let range = s.strip_prefix("db=").and_then(|db| db.parse::<f64>().ok()).filter(|db| (1.0..=400.0).contains(db));
        let unknown =
            || format!("unknown normalisation \"{s}\"; expected min-max or db=RANGE with RANGE between 1 and 400");
        range.map(|db| Normalisation::DynamicRange(Decibels(db))).ok_or_else(unknown)
    }
}

impl fmt::Display for Normalisation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Normalisation::MinMax => f.write_str("min-max"),
            Normalisation::DynamicRange(db) => write!(f, "db={}", db.0),
        }
    }
}

/// The linear scale from decades to Lambda.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LambdaScale {
    /// Log10 magnitude (decades of amplitude) that maps to Lambda = 0.
    pub floor: f64,
    /// Log10 magnitude (decades of amplitude) that maps to Lambda = 1.
    pub peak: f64,
}

impl LambdaScale {
    /// The scale for a map whose cells lie between `min` and `max` decades. A flat map has no range, and no cell of it is a peak.
    pub fn new(min: f64, max: f64, normalisation: Normalisation) -> Self {
        let floor = match normalisation {
            Normalisation::MinMax => min,
            Normalisation::DynamicRange(_) if max <= min => max,
            Normalisation::DynamicRange(db) => max - db.amplitude_decades(),
        };
        LambdaScale { floor, peak: max }
    }

    /// Lambda in [0, 1]. A map that is flat (an empty scene) has Lambda 0 everywhere.
    #[inline]
    pub fn lambda(&self, decades: f64) -> f64 {
        let range = self.peak - self.floor;
        if range > 0.0 { ((decades - self.floor) / range).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Decibels from Lambda 0 to Lambda 1.
    pub fn decibels(&self) -> f64 {
        20.0 * (self.peak - self.floor)
    }
}

/// Lambda over range and angle, `[range bins, columns]`, every cell in [0, 1].
#[derive(Debug, Clone, PartialEq)]
pub struct RangeAngleMap {
    pub lambda: Array2<f32>,
}

/// Cells above a threshold, `[range bins, columns]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    pub cells: Array2<bool>,
}

impl RangeAngleMap {
    /// Stretches arbitrary finite values to [0, 1]; equal or non-finite values become 0.
    pub fn stretched(values: Array2<f32>) -> Self {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let (min, max) = finite.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let range = max - min;
        let lambda =
            values.mapv(|v| if range > 0.0 && v.is_finite() { ((v - min) / range).clamp(0.0, 1.0) } else { 0.0 });
        RangeAngleMap { lambda }
    }

    /// The cells with Lambda > `eta`.
    pub fn above(&self, eta: f32) -> Mask {
        Mask { cells: self.lambda.mapv(|v| v > eta) }
    }
}

impl Mask {
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|&&c| c).count()
    }

    /// Lambda 1 where the mask is set, and 0 elsewhere.
    pub fn as_map(&self) -> RangeAngleMap {
        RangeAngleMap { lambda: self.cells.mapv(|set| if set { 1.0 } else { 0.0 }) }
    }
}
