//! The errors of a campaign, and the names of its sets in messages.

use crate::evaluate::sets::{FolderError, SceneSet};
use crate::reconstruct::ReconstructError;
use crate::scene::file::SceneFileError;
use crate::scene::generate::NoRoom;

#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum CampaignError {
    #[error(transparent)]
    File(#[from] SceneFileError),
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// A layout that the radar has not, a set or method that is given twice, or a scene on which something fails.
    #[error("{0}")]
    Refused(String),
    #[error("{method} on scene {index} of {set}: {source}")]
    Method { method: &'static str, set: String, index: u32, source: ReconstructError },
}

impl CampaignError {
    /// Whether the campaign was cancelled.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, CampaignError::Method { source: ReconstructError::Cancelled, .. })
    }
}

/// A method that failed on scenes of a set, so that they have no rows of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MethodFailure {
    /// Name of the method.
    pub method: &'static str,
    /// The set.
    pub set: String,
    /// Number of the set's scenes on which it failed.
    pub scenes: u32,
    /// The method's error on the first of them.
    pub reason: String,
}

impl MethodFailure {
    /// Adds a method's failure on a scene to `all`.
    /// # Errors
    /// Any other error, and a failure that is the cancellation of the campaign.
    pub(super) fn note(all: &mut Vec<MethodFailure>, error: CampaignError) -> Result<(), CampaignError> {
        match error {
            error if error.is_cancelled() => Err(error),
            CampaignError::Method { method, set, source, .. } => {
                match all.iter_mut().find(|unfit| unfit.method == method && unfit.set == set) {
                    Some(unfit) => unfit.scenes += 1,
                    None => all.push(MethodFailure { method, set, scenes: 1, reason: source.to_string() }),
                }
                Ok(())
            }
            error => Err(error),
        }
    }
}

pub(super) fn set_name(set: &SceneSet) -> String {
    match set {
        SceneSet::Generated(kind) if kind.test_set().is_some() => format!("set {kind}"),
        set => set.to_string(),
    }
}
