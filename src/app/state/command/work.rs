//! Commands that start long work, or stop it.

use super::{EvaluationChoice, ThresholdChoice};
use crate::app::state::CardPlan;
use std::path::PathBuf;

/// Commands that start long work, or stop it.
#[derive(Debug, Clone, PartialEq)]
pub enum WorkCommand {
    /// Run every method once on the scene on screen, to know how long each takes on this machine.
    MeasureMethodTimes,
    /// Stop that; times measured before stay.
    CancelMethodTimes,
    /// Stop the reconstruction that runs.
    CancelMethod,
    /// Stop the second method's reconstruction.
    CancelSecond,
    /// Evaluate methods on test sets.
    Evaluate(EvaluationChoice),
    /// Stop the evaluation.
    CancelEvaluation,
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
    /// Ask for the log of a training and watch it.
    OpenLog,
    /// Watch this log of a training.
    WatchLog(PathBuf),
    /// Start a training by the recipe of this name, and watch it.
    Train(&'static str),
    /// Stop the training that was started here.
    CancelTraining,
    /// Ask for the `.cfg` of a capture card and listen to it on this UDP port.
    ChooseCard(u16),
    /// Listen to a capture card, and show its newest frame.
    Listen(CardPlan),
    /// Stop listening.
    StopListening,
}
