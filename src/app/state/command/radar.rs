//! Commands that change the radar, its elements, and other disturbances of the scene.

use crate::radar::{BuiltArray, Carrier, Radar, WindowFunction};
use crate::scene::{Interferer, Mirror};
use std::sync::Arc;

/// A command that changes the radar, its elements, or other disturbances of the scene.
#[derive(Debug, Clone, PartialEq)]
pub enum RadarCommand {
    /// Set the radar.
    Set(Box<Radar>),
    /// Set the radar preset of this index.
    Preset(usize),
    /// Set the convention of the carrier's phase.
    SetCarrier(Carrier),
    /// Set the window of both transforms.
    SetWindow(WindowFunction),
    /// Set the errors of the elements.
    SetElements(Arc<BuiltArray>),
    /// Set or remove an unsynchronised radar.
    SetInterferer(Option<Interferer>),
    /// Set or remove a wall that mirrors.
    SetMirror(Option<Mirror>),
}
