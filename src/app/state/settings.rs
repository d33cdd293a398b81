//! The user's settings, kept between starts. The radar belongs to the scene's file instead.

use super::panel::MapKind;
use super::several::Several;
use crate::interact::{Coordinates, Snap};
use crate::maps::Aperture;
use crate::radar::{Decibels, End, Layout as ElementLayout, Radar};
use crate::view::View;
use eframe::egui::ThemePreference;
use serde::{Deserialize, Serialize};
use std::ops::{Deref, DerefMut};
use std::path::PathBuf;

/// The user's settings of the panel Chirp.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct ChirpSettings {
    /// Number of the drawn element from 0; the last one where the array has fewer.
    pub element: usize,
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
    pub theme: ThemePreference,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Elements {
    /// Both ends of the array.
    #[default]
    TwoEnds,
    OneEnd,
    /// This many elements at random places of the aperture.
    Random(usize),
    /// The 12 virtual elements of 3 transmitters and 4 receivers.
    Mimo,
    All,
}

impl Elements {
    pub fn name(self) -> &'static str {
        match self {
            Elements::TwoEnds => "the two ends",
            Elements::OneEnd => "the first end alone",
            Elements::Random(_) => "random elements",
            Elements::Mimo => "3 × 4 MIMO",
            Elements::All => "the whole array",
        }
    }

    /// Positions of the elements.
    ///
    /// # Errors
    /// The fault, for more random elements than the array has.
    pub fn layout(self, radar: &Radar, seed: u64) -> Result<ElementLayout, String> {
        Ok(match self {
            Elements::TwoEnds => ElementLayout::two_ends(radar),
            Elements::OneEnd => ElementLayout::one_end(radar, End::First),
            Elements::Random(count) => return ElementLayout::random(radar, count, seed),
            Elements::Mimo => ElementLayout::mimo(radar, 3, 4),
            Elements::All => ElementLayout::uniform(radar),
        })
    }
}

/// The user's settings of the panel Bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BoundsSettings {
    pub elements: Elements,
    pub seed: u64,
    pub snr: Decibels,
    /// Columns to each side of the reflector in the picture.
    pub columns: f64,
    /// Range bins to each side of the reflector in the picture.
    pub bins: f64,
}

impl Default for BoundsSettings {
    fn default() -> Self {
        BoundsSettings { elements: Elements::TwoEnds, seed: 0, snr: Decibels(20.0), columns: 12.0, bins: 4.0 }
    }
}

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

named! {
    /// Layout of the compared maps.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum Layout {
        /// Both outputs above, their differences from the target below.
        #[default]
        Beside = "Side by side",
        /// One of two maps at a time, in the same place.
        #[serde(alias = "Swipe")]
        Flip = "In one place",
    }
}

/// Settings of the panel Compare.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Compare {
    /// Name of the second method; where empty, one other than the first is chosen.
    pub second: String,
    pub layout: Layout,
    pub maps: [MapKind; 2],
    /// Index of the flipped map on screen, 0 or 1.
    pub front: usize,
}

impl Default for Compare {
    fn default() -> Self {
        Compare { second: String::new(), layout: Layout::default(), maps: [MapKind::Output, MapKind::Second], front: 0 }
    }
}

impl Compare {
    pub const OFFERED_MAPS: [MapKind; 9] = {
        use MapKind::*;
        [Input0, Input1, Target, Output, Second, OutputAbove, SecondAbove, Difference, SecondDifference]
    };

    /// The maps to be made. They include both flipped ones, so that the other is there at once.
    pub fn maps(&self) -> Vec<MapKind> {
        use MapKind::*;
        match self.layout {
            Layout::Beside => vec![Output, Second, Difference, SecondDifference],
            Layout::Flip => self.maps.to_vec(),
        }
    }

    /// Shows the other flipped map; shows the first where the maps were side by side.
    pub fn flip(&mut self) {
        self.front = if self.layout == Layout::Flip { (self.front + 1) % 2 } else { 0 };
        self.layout = Layout::Flip;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flipping_changes_only_the_map_in_front() {
        let mut compare = Compare::default();
        compare.flip();
        let first = compare.clone();
        assert_eq!((first.layout, first.front), (Layout::Flip, 0));
        compare.flip();
        assert_eq!(compare, Compare { front: 1, ..first.clone() });
        compare.flip();
        assert_eq!(compare, first);
        assert_eq!(compare.maps(), [MapKind::Output, MapKind::Second], "both are made, whichever is in front");
    }
}
