//! Errors of a simulation: a fault of the scene, or a cancellation.

use crate::scene::SceneError;
use crate::task::Cancelled;

/// A reason for which there are no samples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unfinished {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A query with its value, or the reason why it has none.
pub type Made<T> = Result<T, Unfinished>;

impl Unfinished {
    /// The fault of the scene, for work on a task without another owner.
    pub(crate) fn of_scene(self) -> SceneError {
        match self {
            Unfinished::Scene(error) => error,
            Unfinished::Cancelled(_) => unreachable!("the task has no other owner"),
        }
    }
}
