//! What the panel of the elements shows.

use crate::app::jobs::Calibrated;
use crate::radar::{BuiltArray, LayoutKind, Radar};

/// What is shown.
pub struct Input<'a> {
    pub radar: &'a Radar,
    pub elements: &'a BuiltArray,
    /// The layout that methods hear; the two ends where there is none.
    pub layout: Option<&'a LayoutKind>,
    /// Whether a recording has the samples of the two ends alone, so that nothing else can be heard.
    pub has_ends_alone: bool,
    /// What the selected reflector tells of them; `None` where none is selected.
    pub calibration: Option<Result<&'a Calibrated, &'a str>>,
}
