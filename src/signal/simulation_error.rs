//! Errors of a simulation: a fault of the scene, or a cancellation.

use crate::scene::SceneError;
use crate::task::Cancelled;

/// A reason for which a simulation has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The result of a simulation that may be cancelled.
pub type SimulationResult<T> = Result<T, SimulationError>;

impl SimulationError {
    /// The fault of the scene, for a task that can't be cancelled.
    pub(crate) fn of_scene(self) -> SceneError {
        match self {
            SimulationError::Scene(error) => error,
            SimulationError::Cancelled(_) => unreachable!("the task has no other owner"),
        }
    }
}
