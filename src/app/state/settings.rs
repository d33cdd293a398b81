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
    /// As the system has it.
    #[default]
    System,
    /// Light.
    Light,
    /// Dark.
    Dark,
}

/// The user's settings of view, panels and window.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// View of the scenes; kept beside the other settings.
    #[serde(skip)]
    pub view: View,
    /// Grid that dragged objects snap to.
    pub snap: Snap,
    /// Coordinates in which places are shown and entered.
    pub coordinates: Coordinates,
    /// Theme of the window.
    pub theme: Brightness,
    /// Settings of the bounds.
    pub bounds: BoundsSettings,
    /// Settings of the phasors.
    pub phasors: PhasorSettings,
    /// Settings of the chirp.
    pub chirp: ChirpSettings,
    /// Settings of several maps.
    pub several: Several,
    /// Settings of the comparison of two methods.
    pub compare: Compare,
    /// Whether menus list the panels for developers.
    pub developer: bool,
    /// The user's own folder of scenes, where it isn't the usual one.
    pub own_scenes: Option<PathBuf>,
    /// Seed of the next random scene.
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
