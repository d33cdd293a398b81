//! Times of the stages of an update, and the reasons for skipped ones.

use std::fmt;
use std::time::Duration;

/// A stage of an update, in the order of their runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EngineStage {
    /// Reflectors to range profiles.
    Signal,
    Noise,
    Ends,
    /// Range profiles to the first end's log-magnitude.
    FirstMap,
    LastMap,
    FullMap,
    /// Log-magnitudes to Lambda.
    Normalise,
}

impl EngineStage {
    /// The stages of the three maps, in the order of every triple of maps.
    pub const MAPS: [EngineStage; 3] = [EngineStage::FirstMap, EngineStage::LastMap, EngineStage::FullMap];
}

impl fmt::Display for EngineStage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            EngineStage::Signal => "signal",
            EngineStage::Noise => "floor",
            EngineStage::Ends => "samples of the ends",
            EngineStage::FirstMap => "map of input 0",
            EngineStage::LastMap => "map of input 1",
            EngineStage::FullMap => "map of the target",
            EngineStage::Normalise => "normalise",
        })
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StageOutcome {
    Computed(String),
    Skipped(&'static str),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StageReport {
    pub stage: EngineStage,
    /// Duration of the stage; zero when skipped.
    pub took: Duration,
    pub outcome: StageOutcome,
}

/// All stages of an update.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct EngineReport {
    pub stages: Vec<StageReport>,
    /// Time from the call to the finished frame.
    pub total: Duration,
}

impl EngineReport {
    pub(super) fn computed(&mut self, stage: EngineStage, took: Duration, what: impl Into<String>) {
        self.stages.push(StageReport { stage, took, outcome: StageOutcome::Computed(what.into()) });
    }

    pub(super) fn skipped(&mut self, stage: EngineStage, why: &'static str) {
        self.stages.push(StageReport { stage, took: Duration::ZERO, outcome: StageOutcome::Skipped(why) });
    }

    pub(super) fn remark(&mut self, stage: EngineStage, remark: &str) {
        for s in self.stages.iter_mut().filter(|s| s.stage == stage) {
            if let StageOutcome::Computed(what) = &mut s.outcome {
                what.push_str("; ");
                what.push_str(remark);
            }
        }
    }

    /// Whether a stage ran.
    pub fn ran(&self, stage: EngineStage) -> bool {
        self.stages.iter().any(|s| s.stage == stage && matches!(s.outcome, StageOutcome::Computed(_)))
    }
}
