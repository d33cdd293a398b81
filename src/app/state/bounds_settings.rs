//! Settings of the bounds of a reflector.

use crate::radar::{Decibels, End, Layout, LayoutError, Mimo, Radar};
use serde::{Deserialize, Serialize};

/// The elements that listen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Elements {
    /// Both ends of the array.
    #[default]
    TwoEnds,
    OneEnd,
    /// This many elements at random places of the aperture.
    Random(usize),
    /// The 12 virtual elements of 3 transmitters and 4 receivers.
    Mimo,
    All,
}

impl Elements {
    /// Name of the choice.
    pub fn name(self) -> &'static str {
        match self {
            Elements::TwoEnds => "the two ends",
            Elements::OneEnd => "the first end alone",
            Elements::Random(_) => "random elements",
            Elements::Mimo => "3 × 4 MIMO",
            Elements::All => "the whole array",
        }
    }

    /// Positions of the elements.
    ///
    /// # Errors
    /// [`LayoutError`] for more random elements than the array has.
    pub fn layout(self, radar: &Radar, seed: u64) -> Result<Layout, LayoutError> {
        Ok(match self {
            Elements::TwoEnds => Layout::two_ends(radar),
            Elements::OneEnd => Layout::one_end(radar, End::First),
            Elements::Random(count) => return Layout::random(radar, count, seed),
            Elements::Mimo => Mimo::filled(radar, 3, 4).layout(),
            Elements::All => Layout::uniform(radar),
        })
    }
}

/// The user's settings of the panel Bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BoundsSettings {
    pub elements: Elements,
    pub seed: u64,
    pub snr: Decibels,
    /// Columns to each side of the reflector in the picture.
    pub columns: f64,
    /// Range bins to each side of the reflector in the picture.
    pub bins: f64,
}

impl Default for BoundsSettings {
    fn default() -> Self {
        BoundsSettings { elements: Elements::TwoEnds, seed: 0, snr: Decibels(20.0), columns: 12.0, bins: 4.0 }
    }
}
