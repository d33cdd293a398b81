//! Which element's chirp is drawn.

use serde::{Deserialize, Serialize};

/// What the user chose to look at.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ChirpSettings {
    /// The element; the last one where the array has fewer.
    pub element: usize,
}
