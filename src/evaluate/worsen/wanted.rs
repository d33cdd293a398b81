//! The goal of a search, and its result.

use crate::evaluate::Metrics;
use crate::evaluate::verdict::{ObjectVerdict, OutputVerdicts};
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::scene::Scene;
use crate::signal::Floor;
use std::fmt;
use std::str::FromStr;

/// The measure by which a scene is worse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WorseningMeasure {
    /// A larger SE is worse.
    #[default]
    SquaredError,
    /// More missed objects are worse; among as many, a larger SE.
    Missed,
    /// More ghosts are worse; among as many, a larger SE.
    Ghosts,
}

impl WorseningMeasure {
    /// Every measure.
    pub const ALL: [WorseningMeasure; 3] =
        [WorseningMeasure::SquaredError, WorseningMeasure::Missed, WorseningMeasure::Ghosts];
}

impl fmt::Display for WorseningMeasure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            WorseningMeasure::SquaredError => "squared-error",
            WorseningMeasure::Missed => "missed",
            WorseningMeasure::Ghosts => "ghosts",
        })
    }
}

impl FromStr for WorseningMeasure {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        WorseningMeasure::ALL
            .into_iter()
            .find(|m| m.to_string() == s)
            .ok_or_else(|| format!("unknown measure \"{s}\"; expected squared-error, missed or ghosts"))
    }
}

/// The goal of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WorseningGoal {
    /// The worst scene.
    #[default]
    Worsen,
    /// The smallest move, of objects alone, after which nothing is missed, or no ghost is left, or a fifth of the SE is left.
    Repair,
}

/// The settings of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct WorseningSearch {
    /// The radar.
    pub radar: Radar,
    /// Noise of the scene.
    pub floor: Floor,
    /// Normalisation of maps.
    pub normalisation: Normalisation,
    /// Numbers of the elements whose samples the method gets in place of the two ends.
    pub layout: Option<Vec<usize>>,
    /// The goal.
    pub goal: WorseningGoal,
    /// The measure that the search compares scenes by.
    pub measure: WorseningMeasure,
    /// Largest distance that an object may move, metres.
    pub within_metres: f64,
    /// Scenes to try.
    pub tries: u32,
    /// Seed of the candidates.
    pub seed: u64,
}

impl Default for WorseningSearch {
    fn default() -> Self {
        WorseningSearch {
            radar: Radar::default(),
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
            layout: None,
            goal: WorseningGoal::default(),
            measure: WorseningMeasure::default(),
            within_metres: 2.0,
            tries: 256,
            seed: 0,
        }
    }
}

/// A scene that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The scene.
    pub scene: Scene,
    /// Figures of the method's answer.
    pub metrics: Metrics,
    /// Verdicts on the method's answer.
    pub verdicts: OutputVerdicts,
    /// Distance of the object that moved farthest, metres.
    pub moved_metres: f64,
    /// Number of tries until it was found; 0 for the start.
    pub tries: u32,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct WorseningOutcome {
    /// The start, and every scene that was better by the goal than all before it.
    pub path: Vec<Finding>,
    /// Scenes tried.
    pub tries: u32,
}

impl WorseningOutcome {
    /// The start, and the last of the path where there is one after it.
    pub fn ends(&self) -> Option<(&Finding, Option<&Finding>)> {
        let (start, rest) = self.path.split_first()?;
        Some((start, rest.last()))
    }
}

impl WorseningMeasure {
    /// The count and SE of a finding, compared in this order: a search maximises them, a repair minimises them.
    pub(super) fn of(self, finding: &Finding) -> (usize, f64) {
        let count = match self {
            WorseningMeasure::SquaredError => 0,
            WorseningMeasure::Missed => finding.verdicts.objects.iter().filter(|f| !f.is_right()).count(),
            WorseningMeasure::Ghosts => finding.verdicts.ghosts.len(),
        };
        (count, finding.metrics.squared_error)
    }
}

/// The number of objects of each verdict, in words: "2 found, 1 missed".
pub fn summary(verdicts: &OutputVerdicts) -> String {
    let count = |name: &str| verdicts.objects.iter().filter(|f| f.name() == name).count();
    let kinds = [
        ObjectVerdict::Found,
        ObjectVerdict::Missed,
        ObjectVerdict::Merged { with: 0 },
        ObjectVerdict::WrongTooth { columns: 0 },
        ObjectVerdict::Hidden,
    ];
    let objects = kinds.into_iter().map(|f| (count(f.name()), f.name().to_owned()));
    let alarms = if verdicts.ghosts.len() == 1 { "false alarm" } else { "false alarms" };
    let ghosts = (verdicts.ghosts.len(), alarms.to_owned());
    let parts = objects.chain([ghosts]).filter(|(n, _)| *n > 0).map(|(n, name)| format!("{n} {name}"));
    parts.collect::<Vec<_>>().join(", ")
}
