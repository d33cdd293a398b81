//! Display settings: units of axes and scales, colours, and snapping of dragged objects.

use crate::app::state::{Command, Directions, EditCommand, Settings, Units, ViewCommand};
use crate::app::widgets::{choices, row_of, tick};
use crate::interact::Snap;
use crate::picture::ColourMap;
use eframe::egui::Ui;

/// Draws the group's rows.
pub(super) fn show(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Directions", "Unit of the axis of directions, in every map", |ui| {
        let of = [(Directions::Cosine, "cos θ", ""), (Directions::Degrees, "degrees", "From straight ahead")];
        choices(ui, settings.directions, of, ViewCommand::SetDirections, asked);
        let tip =
            "Draw maps of few elements on 256 columns: values between are interpolated, and nothing more is resolved";
        tick(ui, settings.fine_columns, "256 columns", tip, |_| ViewCommand::ToggleFineColumns, asked);
    });
    row_of(ui, "Scale", "Unit of colour bars, cuts, readouts and thresholds (D)", |ui| {
        let of = [(Units::Lambda, "Λ", ""), (Units::Decibels, "dB", "Decibels relative to the map's peak")];
        choices(ui, settings.units, of, ViewCommand::SetUnits, asked);
        let tip = "Inputs, target and output on the scale of the strongest: what is weaker looks weaker";
        tick(ui, settings.one_scale, "one for all", tip, |_| ViewCommand::ToggleOneScale, asked);
    });
    row_of(ui, "Colours", "Colours of Λ", |ui| {
        let of = ColourMap::ALL.map(|colours| (colours, colours.name(), ""));
        choices(ui, settings.colours, of, ViewCommand::Colours, asked);
    });
    row_of(ui, "Snap", "Where dragged objects come to rest", |ui| {
        let of = [
            (Snap::Off, "Off", ""),
            (Snap::Metres(0.5), "0.5 m", ""),
            (Snap::Cells, "Cells", "Whole range bins and columns"),
        ];
        choices(ui, settings.snap, of, EditCommand::SetSnap, asked);
    });
}
