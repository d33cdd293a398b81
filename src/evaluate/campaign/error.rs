//! The errors of a campaign, and the names of its sets in messages.

use crate::evaluate::rows::GivenTwice;
use crate::evaluate::sets::{FolderError, SceneSet};
use crate::maps::cfar::CfarError;
use crate::reconstruct::ReconstructError;
use crate::scene::SceneError;
use crate::scene::file::SceneFileError;
use crate::scene::generate::NoRoom;

/// The error that stopped a campaign.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum CampaignError {
    /// A scene can't be simulated.
    #[error("scene {index} of {set}: {source}")]
    Scene { set: String, index: u32, source: SceneError },
    /// A scene can't be read.
    #[error(transparent)]
    File(#[from] SceneFileError),
    /// A folder's scenes can't be read.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The objects of a kind of scenes find no room before the radar.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// A radar that has not the elements of the layout.
    #[error("{0}")]
    Layout(String),
    /// A set or a method would count twice.
    #[error(transparent)]
    GivenTwice(#[from] GivenTwice),
    #[error("the detector on scene {index} of {set}: {source}")]
    Detector { set: String, index: u32, source: CfarError },
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
pub struct Unfit {
    /// Name of the method.
    pub method: &'static str,
    /// The set.
    pub set: String,
    /// Number of the set's scenes on which it failed.
    pub scenes: u32,
    /// The method's error on the first of them.
    pub reason: String,
}

impl Unfit {
    /// Adds a method's failure on a scene to `all`.
    /// # Errors
    /// Any other error, and a failure that is the cancellation of the campaign.
    pub(super) fn note(all: &mut Vec<Unfit>, error: CampaignError) -> Result<(), CampaignError> {
        match error {
            error if error.is_cancelled() => Err(error),
            CampaignError::Method { method, set, source, .. } => {
                match all.iter_mut().find(|unfit| unfit.method == method && unfit.set == set) {
                    Some(unfit) => unfit.scenes += 1,
                    None => all.push(Unfit { method, set, scenes: 1, reason: source.to_string() }),
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
