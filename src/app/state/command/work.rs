//! Commands that start or stop long work.

use super::ThresholdChoice;
use crate::app::state::CardPlan;
use std::path::PathBuf;

/// A command that starts or stops long work.
#[derive(Debug, Clone, PartialEq)]
pub enum WorkCommand {
    /// Cancel the reconstruction under way.
    CancelMethod,
    /// Cancel the second method's reconstruction.
    CancelSecond,
    /// Search for the threshold at which the method in use has a given rate of false alarms, and set it.
    FindThreshold(ThresholdChoice),
    /// Cancel the search; the threshold stays.
    CancelThreshold,
    /// Measure run time against error.
    Measure {
        /// Whether to measure every algorithm with more reflectors, for about a minute.
        thorough: bool,
    },
    /// Cancel the measurement.
    CancelMeasurement,
    /// Follow this log of a training.
    WatchLog(PathBuf),
    /// Listen to a capture card, and show its newest frame.
    Listen(CardPlan),
    /// Stop listening.
    StopListening,
}
