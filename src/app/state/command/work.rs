//! Commands that start long work, or stop it.

use super::ThresholdChoice;
use crate::app::state::CardPlan;
use std::path::PathBuf;

/// Commands that start long work, or stop it.
#[derive(Debug, Clone, PartialEq)]
pub enum WorkCommand {
    /// Stop the reconstruction that runs.
    CancelMethod,
    /// Stop the second method's reconstruction.
    CancelSecond,
    /// Look for the threshold at which the method in use keeps a rate of false alarms, and set it.
    FindThreshold(ThresholdChoice),
    /// Stop that; the threshold stays as it is.
    CancelThreshold,
    /// Measure run time against error.
    Measure {
        /// Every algorithm and more reflectors, for about a minute.
        thorough: bool,
    },
    /// Stop measuring.
    CancelMeasurement,
    /// Watch this log of a training.
    WatchLog(PathBuf),
    /// Listen to a capture card, and show its newest frame.
    Listen(CardPlan),
    /// Stop listening.
    StopListening,
}
