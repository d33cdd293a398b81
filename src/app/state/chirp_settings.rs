//! Which element's chirp is drawn, and how long it is taken to last.

use serde::{Deserialize, Serialize};

/// Shortest and longest chirp that is drawn, seconds.
pub const CHIRP_SECONDS: [f64; 2] = [1e-6, 1e-2];

/// What the user chose to look at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ChirpSettings {
    /// The element; the last one where the array has fewer.
    pub element: usize,
    /// How long the chirp is taken to last, seconds. No sample depends on it.
    pub seconds: f64,
}

impl Default for ChirpSettings {
    /// 512 samples at 20 MHz.
    fn default() -> Self {
        ChirpSettings { element: 0, seconds: 25.6e-6 }
    }
}
