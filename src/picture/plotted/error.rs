//! The error of a picture that can't be composed.

use super::PictureError;
use crate::maps::cfar::CfarError;
use crate::reconstruct::ReconstructError;

pub(super) type Composed = Result<Vec<u8>, ComposeError>;

/// The reason why a picture could not be composed.
#[derive(Debug, thiserror::Error)]
pub enum ComposeError {
    #[error(transparent)]
    Reconstruct(#[from] ReconstructError),
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error(transparent)]
    Detector(#[from] CfarError),
    #[error("{0}")]
    Layout(String),
    #[error("the recording has the samples of the two ends alone; {0} needs those of every element")]
    EndsAlone(String),
    #[error("the detector needs the power of every cell, which an output has only beside a target")]
    DetectorAlone,
}
