//! Why a simulation gave nothing.

use crate::scene::SceneError;
use crate::task::Cancelled;

/// Why there are no samples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unfinished {
    /// The scene can't be simulated.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Somebody cancelled the task.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Unfinished {
    /// What is wrong with the scene, for work on a task that nobody else holds.
    pub(crate) fn of_scene(self) -> SceneError {
        match self {
            Unfinished::Scene(error) => error,
            Unfinished::Cancelled(_) => unreachable!("nobody else can cancel it"),
        }
    }
}
