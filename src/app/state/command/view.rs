//! Commands that change the view of the scene: maps, method and marks.

use crate::app::state::{
    BoundsSettings, ChirpSettings, Compare, Cursor, Directions, PhasorSettings, Projection, Several, Units,
};
use crate::maps::Normalisation;
use crate::maps::cfar::{Cfar, Statistic};
use crate::picture::ColourMap;
use crate::radar::LayoutKind;
use crate::signal::Floor;

/// A command that changes the view of the scene: maps, method or marks.
#[derive(Debug, Clone, PartialEq)]
pub enum ViewCommand {
    /// Set the pointer's place, from any panel.
    Hover(Cursor),
    /// Show the whole scene.
    FitScene,
    /// Show whole maps.
    ResetMaps,
    /// Switch between range-angle and Cartesian maps.
    ToggleProjection,
    /// Set the coordinates of the maps.
    SetProjection(Projection),
    /// Switch between Lambda and decibels.
    ToggleUnits,
    /// Set Lambda or decibels on colour bars, cuts, readouts and thresholds.
    SetUnits(Units),
    /// Set cos θ or degrees along the axis of directions.
    SetDirections(Directions),
    /// Switch between a common scale for inputs, target and output, and one for each.
    ToggleOneScale,
    /// Switch maps of few elements between 256 columns and their own number.
    ToggleFineColumns,
    /// Switch between the signed and the absolute difference.
    ToggleAbsoluteDifference,
    /// Switch the difference's scale between the smallest that holds it and one up to 1.
    ToggleWholeDifference,
    /// Pin the cuts that are shown; they stay while the cursor moves.
    PinCuts,
    /// Unpin the cuts of this index.
    Unpin(usize),
    /// Unpin all cuts.
    UnpinAll,
    /// Set the maps' colours.
    Colours(ColourMap),
    /// Set the normalisation of maps.
    Normalise(Normalisation),
    /// Set the floor beneath the reflectors.
    SetFloor(Floor),
    /// Set eta', the threshold of the target.
    SetTargetEta(f32),
    /// Set the detector in place of the thresholds; `None` for thresholds.
    SetCfar(Option<Cfar>),
    /// Detect at a constant false-alarm rate by this statistic, with the last chosen cells, or by thresholds where `None`.
    Detect(Option<Statistic>),
    /// Set eta of the method of this name; its own where `None`.
    SetMethodEta(&'static str, Option<f32>),
    /// Set the settings of the bounds.
    SetBounds(BoundsSettings),
    /// Set the settings of the phasors.
    SetPhasors(PhasorSettings),
    /// Set the time of the scene, seconds.
    SetTime(f64),
    /// Play or stop the scene's motion or the recording's frames.
    TogglePlay,
    /// Set whether range-Doppler maps of recordings leave out static clutter.
    TakeOutStaticClutter(bool),
    /// Set the settings of the chirp.
    SetChirp(ChirpSettings),
    /// Switch whether menus list the panels for developers.
    ToggleDeveloper,
    /// Show the true reflectors on the maps.
    MarkReflectors,
    /// Switch the true reflectors on the maps.
    ToggleReflectors,
    /// Switch the method's reflectors on the maps.
    ToggleFound,
    /// Switch the ends' fields of view.
    ToggleFieldsOfView,
    /// Switch the theory of the selected reflector on the maps.
    ToggleTheory,
    /// Show the fate of every object in the output.
    MarkKinds,
    /// Switch the fate of every object in the output.
    ToggleKinds,
    /// Set the settings of several maps.
    SetSeveral(Box<Several>),
    /// Set the settings of the comparison.
    SetCompare(Box<Compare>),
    /// Show the other one of two compared maps.
    Flip,
    /// Set the method by its name.
    Method(&'static str),
    /// Set the elements that methods use; the two ends where `None`.
    Hear(Option<LayoutKind>),
    /// Select the next method.
    NextMethod,
}

impl ViewCommand {
    /// The switches of marks drawn over maps.
    pub const OVERLAYS: [ViewCommand; 4] =
        [ViewCommand::ToggleReflectors, ViewCommand::ToggleFound, ViewCommand::ToggleTheory, ViewCommand::ToggleKinds];
}
