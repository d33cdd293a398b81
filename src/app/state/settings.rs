//! What the user chose: kept from one start to the next. What the radar is belongs to the scene's file instead.

use super::bounds_settings::BoundsSettings;
use super::chirp_settings::ChirpSettings;
use super::compare::Compare;
use super::phasor_settings::PhasorSettings;
use super::several::Several;
use crate::interact::{Coordinates, Snap};
use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::picture::ColourMap;
use crate::radar::{DecibelMilliwatts, Decibels};
use crate::signal::Floor;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Coordinates of the maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Projection {
    /// cos(theta) across, range up.
    #[default]
    RangeAngle,
    /// x across, y up, as in the scene.
    Cartesian,
}

impl Projection {
    /// The other one.
    pub fn other(self) -> Projection {
        match self {
            Projection::RangeAngle => Projection::Cartesian,
            Projection::Cartesian => Projection::RangeAngle,
        }
    }
}

/// What the scale of a map or a cut counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Units {
    /// Lambda, 0 to 1.
    #[default]
    Lambda,
    /// Decibels below the peak.
    Decibels,
}

impl Units {
    /// The other one.
    pub fn other(self) -> Units {
        match self {
            Units::Lambda => Units::Decibels,
            Units::Decibels => Units::Lambda,
        }
    }
}

/// What the axis of directions counts, in every map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Directions {
    /// cos θ, which the columns divide evenly.
    #[default]
    Cosine,
    /// Degrees from straight ahead.
    Degrees,
}

/// How the difference of output and target is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct DifferenceView {
    /// Its absolute value; output minus target where not.
    pub absolute: bool,
    /// On a scale that reaches 1 for any difference; one that just holds it where not.
    pub whole: bool,
}

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

/// Everything the user chose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// What lies beneath the reflectors.
    pub floor: Floor,
    /// How the maps are normalised.
    pub normalisation: Normalisation,
    /// The ratio last used with [`Floor::Snr`].
    pub snr: Decibels,
    /// The level last used with [`Floor::Level`].
    pub level: DecibelMilliwatts,
    /// Colours of the maps.
    pub colours: ColourMap,
    /// Coordinates of the maps.
    pub projection: Projection,
    /// What colour bars and cuts count.
    pub units: Units,
    /// What the axis of directions counts.
    pub directions: Directions,
    /// Whether inputs, target and output are drawn on one scale; each on its own where not.
    pub one_scale: bool,
    /// Whether range-Doppler maps of recordings leave out what stands still, the mean over the loops.
    pub static_clutter_out: bool,
    /// How the difference is drawn.
    pub difference: DifferenceView,
    /// eta', the threshold of the target.
    pub target_eta: f32,
    /// The detector in the place of these thresholds, if one is in use.
    pub cfar: Option<Cfar>,
    /// The detector that was used last.
    pub last_cfar: Cfar,
    /// eta for each method, where it differs from the method's own.
    pub method_eta: BTreeMap<String, f32>,
    /// Name of the reconstruction method.
    pub method: String,
    /// Whether true reflectors are drawn over the maps.
    pub show_reflectors: bool,
    /// Whether the reflectors that the method found are drawn.
    pub show_found: bool,
    /// Whether the ends' fields of view are drawn in the scene.
    pub show_fields_of_view: bool,
    /// Whether what the formulas say of the selected reflector is drawn over the maps.
    pub show_theory: bool,
    /// Whether every object is marked by what became of it in the output.
    pub show_kinds: bool,
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

impl Settings {
    /// Takes a detector into use, or thresholds where there is none; the detector's cells are kept for the next time.
    pub fn detect_by(&mut self, cfar: Option<Cfar>) {
        self.cfar = cfar;
        self.last_cfar = cfar.unwrap_or(self.last_cfar);
    }

    /// Puts another floor below scenes; the level of each kind is kept for the next time.
    pub fn set_floor(&mut self, floor: Floor) {
        self.floor = floor;
        match floor {
            Floor::Snr(snr) => self.snr = snr,
            Floor::Level(level) => self.level = level,
            Floor::Thesis | Floor::Exact | Floor::Thermal => {}
        }
    }

    /// Where the guide changed a setting from `before` to `after` and it was not changed since, puts back what it was.
    pub fn take_back(&mut self, before: &Settings, after: &Settings) {
        macro_rules! take_back {
            ($($field:ident),*) => {
                $(if self.$field == after.$field {
                    self.$field.clone_from(&before.$field);
                })*
            };
        }
        take_back!(floor, snr, level, target_eta, cfar, last_cfar, method_eta, normalisation, projection, method);
        take_back!(show_reflectors, show_kinds, one_scale);
    }
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
            snr: Decibels(20.0),
            level: DecibelMilliwatts(-20.0),
            colours: ColourMap::default(),
            projection: Projection::default(),
            units: Units::default(),
            directions: Directions::default(),
            one_scale: false,
            static_clutter_out: false,
            difference: DifferenceView::default(),
            target_eta: crate::evaluate::TARGET_ETA,
            cfar: None,
            last_cfar: Cfar::default(),
            method_eta: BTreeMap::new(),
            method: String::new(),
            show_reflectors: false,
            show_found: false,
            show_fields_of_view: false,
            show_theory: false,
            show_kinds: false,
            snap: Snap::Off,
            coordinates: Coordinates::default(),
            theme: Brightness::System,
            bounds: BoundsSettings::default(),
            phasors: PhasorSettings::default(),
            chirp: ChirpSettings::default(),
            several: Several::default(),
            compare: Compare::default(),
            developer: false,
            own_scenes: None,
            random_seed: 0,
            random_number: 0,
        }
    }
}
