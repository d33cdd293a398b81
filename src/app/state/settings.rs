//! What the user chose: kept from one start to the next. What the radar is belongs to the scene's file instead.

use super::bounds_settings::BoundsSettings;
use super::chirp_settings::ChirpSettings;
use super::compare::Compare;
use super::phasor_settings::PhasorSettings;
use super::several::Several;
use crate::interact::{Coordinates, Snap};
use crate::view::View;
use serde::{Deserialize, Serialize};
use std::ops::{Deref, DerefMut};
use std::path::PathBuf;

/// Light or dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Brightness {
    /// As the system says.
    #[default]
    System,
    /// Light.
    Light,
    /// Dark.
    Dark,
}

/// Everything the user chose: how scenes are looked at, and what is the window's own.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// How scenes are looked at; kept beside the rest.
    #[serde(skip)]
    pub view: View,
    /// Where dragged objects come to rest.
    pub snap: Snap,
    /// In which numbers places are told and entered.
    pub coordinates: Coordinates,
    /// Light or dark.
    pub theme: Brightness,
    /// What the bounds are computed for.
    pub bounds: BoundsSettings,
    /// Which phasors are drawn.
    pub phasors: PhasorSettings,
    /// Which element's chirp is drawn.
    pub chirp: ChirpSettings,
    /// Which map is shown several times, and what differs.
    pub several: Several,
    /// Two methods side by side.
    pub compare: Compare,
    /// Whether menus list the panels for developers.
    pub developer: bool,
    /// Folder of one's own scenes, where another than the usual one was chosen.
    pub own_scenes: Option<PathBuf>,
    /// Seed of the next random scene.
    pub random_seed: u64,
    /// Its number among the scenes of that seed.
    pub random_number: u32,
}

impl Deref for Settings {
    type Target = View;

    fn deref(&self) -> &View {
        &self.view
    }
}

impl DerefMut for Settings {
    fn deref_mut(&mut self) -> &mut View {
        &mut self.view
    }
}
