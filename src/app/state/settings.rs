//! The user's settings, kept between starts. The radar belongs to the scene's file instead.

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

/// Theme of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Brightness {
    #[default]
    System,
    Light,
    Dark,
}

/// The user's settings of view, panels and window.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// View of the scenes; kept beside the other settings.
    #[serde(skip)]
    pub view: View,
    pub snap: Snap,
    /// Coordinates in which places are shown and entered.
    pub coordinates: Coordinates,
    pub theme: Brightness,
    pub bounds: BoundsSettings,
    pub phasors: PhasorSettings,
    pub chirp: ChirpSettings,
    pub several: Several,
    pub compare: Compare,
    /// Whether menus list the panels for developers.
    pub developer: bool,
    /// The user's own folder of scenes, where it isn't the usual one.
    pub own_scenes: Option<PathBuf>,
    pub random_seed: u64,
    /// Number of the next random scene in the stream of that seed.
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
