//! Input of the elements panel.

use crate::app::jobs::Calibrated;
use crate::radar::{BuiltArray, LayoutKind, Radar};

/// The array, the layout of its elements and their calibration.
pub struct Input<'a> {
    pub radar: &'a Radar,
    pub elements: &'a BuiltArray,
    /// The layout of elements that methods use; `None` for the two ends.
    pub layout: Option<&'a LayoutKind>,
    /// Whether a recording has the samples of the two ends alone, so that no other layout can be used.
    pub has_ends_alone: bool,
    /// Calibration on the selected reflector, or the reason why there is none; `None` where no reflector is selected.
    pub calibration: Option<Result<&'a Calibrated, &'a str>>,
}
