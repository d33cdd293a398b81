//! Settings of the drawn chirp.

use serde::{Deserialize, Serialize};

/// The user's settings of the panel Chirp.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ChirpSettings {
    /// Number of the drawn element from 0; the last one where the array has fewer.
    pub element: usize,
}
