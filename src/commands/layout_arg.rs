//! `--layout NAME|NUMBERS`: the elements that are heard.

use super::CommandError;
use crate::radar::{LayoutKind, Radar};

/// Which elements are heard.
#[derive(Debug, Clone, clap::Args)]
pub struct LayoutArg {
    #[arg(long, value_name = "NAME|NUMBERS", help = format!("Elements that are heard in place of the two ends: {}", LayoutKind::NAMES))]
    layout: Option<LayoutKind>,
}

impl LayoutArg {
    /// The layout; `None` for the two ends.
    pub fn other(&self) -> Option<&LayoutKind> {
        self.layout.as_ref().filter(|layout| **layout != LayoutKind::TwoEnds)
    }

    /// Numbers of the elements; `None` for the two ends.
    pub fn numbers(&self, radar: &Radar) -> Result<Option<Vec<usize>>, CommandError> {
        let wrong = |error| CommandError(format!("--layout: {error}"));
        self.other().map(|layout| layout.numbers(radar).map_err(wrong)).transpose()
    }
}
