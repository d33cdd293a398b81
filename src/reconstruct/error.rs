//! Why a reconstruction gave nothing.

use crate::task::Cancelled;

/// Why a reconstruction gave nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReconstructError {
    /// Somebody asked it to stop.
    #[error("cancelled")]
    Cancelled,
    /// The samples have another shape than the radar's ends.
    #[error("{what} has shape {found:?}; expected {expected:?}")]
    Shape {
        /// Which input.
        what: &'static str,
        /// Its shape.
        found: Vec<usize>,
        /// The shape it must have.
        expected: Vec<usize>,
    },
    /// A sample is NaN or infinite.
    #[error("sample {sample} of element {element} of the {end} end is not finite")]
    NotFinite {
        /// "first" or "last".
        end: &'static str,
        /// Element within the end.
        element: usize,
        /// Sample within the chirp.
        sample: usize,
    },
    /// The method can't work on this radar or on these samples.
    #[error("{method}: {reason}")]
    Unusable {
        /// Name of the method.
        method: &'static str,
        /// Why, and what would help.
        reason: String,
    },
}

impl From<Cancelled> for ReconstructError {
    fn from(_: Cancelled) -> Self {
        ReconstructError::Cancelled
    }
}
