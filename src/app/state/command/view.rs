//! Commands that change how the scene is looked at: which maps, by which method, and what is drawn over them.

use crate::app::state::{
    BoundsSettings, ChirpSettings, Compare, Cursor, Directions, PhasorSettings, Projection, Several, Units,
};
use crate::maps::Normalisation;
use crate::maps::cfar::{Cfar, Statistic};
use crate::picture::ColourMap;
use crate::radar::LayoutKind;
use crate::signal::Floor;

/// Commands that change how the scene is looked at: which maps, by which method, and what is drawn over them.
#[derive(Debug, Clone, PartialEq)]
pub enum ViewCommand {
    /// The pointer is here, in whichever panel.
    Hover(Cursor),
    /// Show the whole scene.
    FitScene,
    /// Show whole maps.
    ResetMaps,
    /// Range-angle or Cartesian maps, the other way round.
    ToggleProjection,
    /// Range-angle or Cartesian maps.
    SetProjection(Projection),
    /// Lambda or decibels, the other way round.
    ToggleUnits,
    /// Lambda or decibels on colour bars, cuts, readouts and thresholds.
    SetUnits(Units),
    /// cos θ or degrees along the axis of directions.
    SetDirections(Directions),
    /// Inputs, target and output on one scale or each on its own, the other way round.
    ToggleOneScale,
    /// Maps of few elements on 256 columns or on as many as they have, the other way round.
    ToggleFineColumns,
    /// The difference with its sign or without, the other way round.
    ToggleAbsoluteDifference,
    /// The difference on a scale that just holds it or on one up to 1, the other way round.
    ToggleWholeDifference,
    /// Keep the cuts that are shown while the cursor moves.
    PinCuts,
    /// Let the pinned cuts of this number go.
    Unpin(usize),
    /// Let all pinned cuts go.
    UnpinAll,
    /// Colours of the maps.
    Colours(ColourMap),
    /// How maps are normalised.
    Normalise(Normalisation),
    /// What lies beneath the reflectors.
    SetFloor(Floor),
    /// eta', the threshold of the target.
    SetTargetEta(f32),
    /// The detector in the place of the thresholds; the thresholds where `None`.
    SetCfar(Option<Cfar>),
    /// Detect by a constant false-alarm rate after this statistic, or by thresholds, with the cells that were chosen last.
    Detect(Option<Statistic>),
    /// eta of the method of this name; its own where `None`.
    SetMethodEta(&'static str, Option<f32>),
    /// What bounds are computed for.
    SetBounds(BoundsSettings),
    /// Which phasors are drawn.
    SetPhasors(PhasorSettings),
    /// Look at the scene at this time, seconds.
    SetTime(f64),
    /// Let time go on by itself, or stop it.
    TogglePlay,
    /// Whether range-Doppler maps of recordings leave out what stands still.
    TakeOutStaticClutter(bool),
    /// Which element's chirp is drawn, and how long it lasts.
    SetChirp(ChirpSettings),
    /// List the panels for developers in menus, or not.
    ToggleDeveloper,
    /// Draw true reflectors over the maps.
    MarkReflectors,
    /// Draw true reflectors over the maps or not.
    ToggleReflectors,
    /// Draw the reflectors that the method found or not.
    ToggleFound,
    /// Draw the ends' fields of view or not.
    ToggleFieldsOfView,
    /// Draw over the maps what the formulas say of the selected reflector, or not.
    ToggleTheory,
    /// Mark every object by what became of it in the output.
    MarkKinds,
    /// Mark every object by what became of it in the output, or not.
    ToggleKinds,
    /// Which map is shown several times, and what differs.
    SetSeveral(Box<Several>),
    /// Which two methods and maps are compared, and how.
    SetCompare(Box<Compare>),
    /// Put the other of two compared maps in the place of the one on screen.
    Flip,
    /// Reconstruct with the method of this name.
    Method(&'static str),
    /// Let methods hear these elements; the two ends where `None`.
    Hear(Option<LayoutKind>),
    /// The next reconstruction method.
    NextMethod,
}

impl ViewCommand {
    /// What switches each of the things that are drawn over maps.
    pub const OVERLAYS: [ViewCommand; 4] =
        [ViewCommand::ToggleReflectors, ViewCommand::ToggleFound, ViewCommand::ToggleTheory, ViewCommand::ToggleKinds];
}
