//! The errors of a reconstruction.

use crate::task::Cancelled;

/// The reason why a reconstruction has no result.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReconstructError {
    #[error("cancelled")]
    Cancelled,
    #[error("{what} has shape {found:?}; expected {expected:?}")]
    Shape { what: &'static str, found: Vec<usize>, expected: Vec<usize> },
    #[error("sample {sample} of element {element} of the {end} end is not finite")]
    NotFinite { end: &'static str, element: usize, sample: usize },
    /// The method can't work on this radar or on these samples.
    #[error("{method}: {reason}")]
    Unusable { method: &'static str, reason: String },
}

pub(super) type Result<T, E = ReconstructError> = std::result::Result<T, E>;

impl ReconstructError {
    pub(super) fn check_shape(what: &'static str, found: &[usize], expected: [usize; 2]) -> Result<()> {
        match found == expected {
            true => Ok(()),
            false => Err(ReconstructError::Shape { what, found: found.to_vec(), expected: expected.to_vec() }),
        }
    }
}

impl From<Cancelled> for ReconstructError {
    fn from(_: Cancelled) -> Self {
        ReconstructError::Cancelled
    }
}
