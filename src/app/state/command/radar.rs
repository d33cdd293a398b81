//! Commands that change the radar before the scene, its elements, and what else disturbs it.

use crate::radar::{BuiltArray, Carrier, Radar, WindowFunction};
use crate::scene::{Interferer, Mirror};
use std::sync::Arc;

/// Commands that change the radar before the scene, its elements, and what else disturbs it.
#[derive(Debug, Clone, PartialEq)]
pub enum RadarCommand {
    /// This radar before the scene.
    Set(Box<Radar>),
    /// A radar of the list of presets.
    Preset(usize),
    /// How the carrier's phase is read.
    SetCarrier(Carrier),
    /// Which window both transforms use.
    SetWindow(WindowFunction),
    /// Elements as they are built.
    SetElements(Arc<BuiltArray>),
    /// Another radar that sends at the same time, or none.
    SetInterferer(Option<Interferer>),
    /// A wall that mirrors, or none.
    SetMirror(Option<Mirror>),
}
