//! The ways to read a file without a TOML.

use crate::recording::Origin;
use crate::recording::layout::{Certainty, Found};

/// The ways to read a file, each with its TOML.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The file, and the ways to read it.
    pub origin: Origin,
    /// The layouts of a raw capture; `None` for an array.
    pub found: Option<Found>,
}

impl Imported {
    /// Certainty of the choice.
    pub fn certainty(&self) -> Certainty {
        self.found.as_ref().map_or_else(|| Certainty::of(self.margin()), Found::certainty)
    }

    /// Log-odds of the best way above those of the next; `None` where there is no next.
    pub fn margin(&self) -> Option<f64> {
        let offers = &self.origin.offers;
        Some(offers.first()?.log_odds - offers.get(1)?.log_odds)
    }
}
