//! Settings of the drawn phasors.

use crate::maps::Aperture;
use crate::radar::End;
use serde::{Deserialize, Serialize};

named! {
    /// The map whose cell is split into phasors.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum PhasorMap {
        Input0 = "Input 0",
        Input1 = "Input 1",
        #[default]
        Target = "Target",
    }
}

impl PhasorMap {
    /// The elements of the map.
    pub fn aperture(self) -> Aperture {
        match self {
            PhasorMap::Target => Aperture::Full,
            PhasorMap::Input0 => Aperture::End(End::First),
            PhasorMap::Input1 => Aperture::End(End::Last),
        }
    }
}

/// The user's settings of the panel Phasors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct PhasorSettings {
    pub map: PhasorMap,
    /// Whether the window over the elements is applied, as in the map.
    pub windowed: bool,
    /// Whether a chain without the curvature of the wave from the cell's place is drawn beside it.
    pub focused: bool,
    /// Whether the chain of the echoes alone, without noise, is drawn beside it.
    pub echoes: bool,
    /// Whether the chain left after subtracting the method's reflectors is drawn beside it.
    pub residual: bool,
}

impl Default for PhasorSettings {
    fn default() -> Self {
        PhasorSettings { map: PhasorMap::Target, windowed: true, focused: false, echoes: false, residual: false }
    }
}
