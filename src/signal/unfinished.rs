//! Why a simulation gave nothing.

use crate::scene::SceneError;
use crate::task::Cancelled;

/// Why there are no samples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // Names and messages say it.
pub enum Unfinished {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Unfinished {
    /// What is wrong with the scene, for work on a task without another owner.
    pub(crate) fn of_scene(self) -> SceneError {
        match self {
            Unfinished::Scene(error) => error,
            Unfinished::Cancelled(_) => unreachable!("the task has no other owner"),
        }
    }
}
