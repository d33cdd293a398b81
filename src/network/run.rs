//! Training runs: folder, progress, record, and stopping rules.

use super::recipe::RecipeError;
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::scene::SceneError;
use burn::tensor::Device;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The settings of a run beside its recipe.
#[derive(Debug, Clone)]
pub struct TrainingRun {
    /// Folder of checkpoints, log and weights.
    pub folder: PathBuf,
    /// The device of the tensors.
    pub device: Device,
    /// The radar.
    pub radar: Radar,
    /// Number of steps in all after which the run stops with a checkpoint.
    pub max_steps: Option<u64>,
    /// Time after which the run stops with a checkpoint.
    pub max_time: Option<Duration>,
    /// Whether weights are written even where no step was taken.
    pub untrained: bool,
    /// Time between checkpoints.
    pub checkpoint_every: Duration,
    /// The origin of this part of the run, recorded when it started.
    pub origin: Origin,
}

/// The program that trains: recorded when it starts, and never later.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// The commit of the working folder.
    pub commit: String,
    /// SHA-256 of the running program, hexadecimal.
    pub program_sha256: String,
    /// Arguments of the program.
    pub arguments: Vec<String>,
}

/// One part of a run, from a start to the next stop.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RunPart {
    /// Time of the start, in seconds since 1970.
    pub started_unix_seconds: u64,
    /// The program that trained.
    pub origin: Origin,
    /// SHA-256 of the weights at its start; none where they were drawn from the recipe's seed.
    pub initial_weights_sha256: Option<String>,
    /// Maps of the whole run before this part.
    pub maps_before: u64,
    /// Maps seen in this part.
    pub maps_seen: u64,
    /// Minutes of wall clock of this part.
    pub minutes: f64,
}

impl RunPart {
    /// A part that starts now, after `maps_before` maps of the run.
    pub fn starting(run: &TrainingRun, initial_weights_sha256: Option<String>, maps_before: u64) -> RunPart {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let (started_unix_seconds, origin) = (since.as_secs(), run.origin.clone());
        RunPart { started_unix_seconds, origin, initial_weights_sha256, maps_before, maps_seen: 0, minutes: 0.0 }
    }
}

/// The progress of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunProgress {
    /// Whole epochs done.
    pub epoch: u32,
    /// Steps done in the current epoch.
    pub step_of_epoch: u64,
    /// Steps done in all.
    pub step: u64,
    /// Maps seen.
    pub maps: u64,
    /// Seconds of training.
    pub seconds: f64,
    /// Smoothed loss.
    pub loss: f64,
    /// Every part of the run, the current one last.
    #[serde(default)]
    pub parts: Vec<RunPart>,
}

impl RunProgress {
    /// Counts one step over `maps` maps; `seconds` are the training time so far, of all parts and of this one.
    pub(super) fn step(&mut self, maps: u64, loss: f64, [seconds, of_part]: [f64; 2]) {
        self.step += 1;
        self.step_of_epoch += 1;
        self.maps += maps;
        self.seconds = seconds;
        self.loss = if self.step == 1 { loss } else { 0.95 * self.loss + 0.05 * loss };
        if let Some(part) = self.parts.last_mut() {
            part.maps_seen += maps;
            part.minutes = of_part / 60.0;
        }
    }
}

/// The reason why training stopped early or could not start.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum TrainError {
    #[error("the loss is {loss} at step {step}; the last good checkpoint is kept in {}", folder.display())]
    NotFinite { step: u64, loss: f32, folder: PathBuf },
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    #[error("checkpoint {}: {reason}", path.display())]
    Checkpoint { path: PathBuf, reason: String },
    #[error(
        "no step was taken, so the weights would be random; give the run steps and minutes, or write them all the same with --untrained"
    )]
    Untrained,
    #[error("{} already holds a run; go on with it with --resume, or choose another folder", folder.display())]
    Occupied { folder: PathBuf },
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Input(#[from] ReconstructError),
}

pub(super) fn file(path: &Path) -> impl FnOnce(std::io::Error) -> TrainError {
    let path = path.to_owned();
    move |source| TrainError::File { path, source }
}
