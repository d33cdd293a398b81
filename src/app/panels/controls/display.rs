//! How maps and the scene are drawn: coordinates, scale, colours, marks, snapping, difference and failures.

use super::choices::choices;
use crate::app::state::{Command, DifferenceView, Directions, EditCommand, Projection, Settings, Units, ViewCommand};
use crate::app::widgets::entry::tick;
use crate::app::widgets::setting_row::{rarely, row_of};
use crate::interact::Snap;
use crate::lesson::Uses;
use crate::picture::ColourMap;
use eframe::egui::Ui;

/// Draws the group's rows; of what a lesson does not use, none.
pub(super) fn show(ui: &mut Ui, settings: &Settings, uses: Uses, asked: &mut Vec<Command>) {
    row_of(ui, "Coordinates", "Draw maps over cos θ and range, or over x and y", |ui| {
        let of = [(Projection::RangeAngle, "Range–angle", ""), (Projection::Cartesian, "Cartesian", "")];
        choices(ui, settings.projection, of, ViewCommand::SetProjection, asked);
    });
    row_of(ui, "Directions", "What the axis of directions counts, in every map", |ui| {
        let of = [(Directions::Cosine, "cos θ", ""), (Directions::Degrees, "degrees", "From straight ahead")];
        choices(ui, settings.directions, of, ViewCommand::SetDirections, asked);
        let tip =
            "Draw maps of few elements on 256 columns: values between are interpolated, and nothing more is resolved";
        tick(ui, settings.fine_columns, "256 columns", tip, |_| ViewCommand::ToggleFineColumns, asked);
    });
    row_of(ui, "Scale", "What colour bars, cuts, readouts and thresholds are told in (D)", |ui| {
        let of = [(Units::Lambda, "Λ", ""), (Units::Decibels, "dB", "Decibels relative to the map's peak")];
        choices(ui, settings.units, of, ViewCommand::SetUnits, asked);
        let tip = "Inputs, target and output on the scale of the strongest: what is weaker looks weaker";
        tick(ui, settings.one_scale, "one for all", tip, |_| ViewCommand::ToggleOneScale, asked);
    });
    row_of(ui, "Colours", "Colours of Λ", |ui| {
        let of = ColourMap::ALL.map(|colours| (colours, colours.name(), ""));
        choices(ui, settings.colours, of, ViewCommand::Colours, asked);
    });
    marks(ui, settings, uses, asked);
    rarely(ui, if uses.output { "Snap, difference and failures" } else { "Snap to" }, |ui| {
        snap(ui, settings, asked);
        if uses.output {
            difference(ui, settings, asked);
            failures(ui, settings, asked);
        }
    });
}

fn snap(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Snap", "Where dragged objects come to rest", |ui| {
        let of = [
            (Snap::Off, "Off", ""),
            (Snap::Metres(0.5), "0.5 m", ""),
            (Snap::Cells, "Cells", "Whole range bins and columns"),
        ];
        choices(ui, settings.snap, of, EditCommand::SetSnap, asked);
    });
}

fn difference(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Difference", "How the panel Difference is drawn", |ui| {
        let DifferenceView { absolute, whole } = settings.difference;
        let tip = "Its absolute value, or output minus target";
        tick(ui, absolute, "absolute", tip, |_| ViewCommand::ToggleAbsoluteDifference, asked);
        let tip = "On a scale that just holds it, or on one up to 1";
        tick(ui, !whole, "automatic scale", tip, |_| ViewCommand::ToggleWholeDifference, asked);
    });
}

/// What is drawn over maps and scene.
fn marks(ui: &mut Ui, settings: &Settings, uses: Uses, asked: &mut Vec<Command>) {
    row_of(ui, "Mark", "What is drawn over maps and scene", |ui| {
        let mut mark = |ui: &mut Ui, on, name: &str, tooltip: &str, command: ViewCommand| {
            tick(ui, on, name, tooltip, |_| command, asked);
        };
        let tooltip = "The scene's own reflectors, over every map (R)";
        mark(ui, settings.show_reflectors, "reflectors", tooltip, ViewCommand::ToggleReflectors);
        if uses.output {
            mark(ui, settings.show_found, "found", "Reflectors that the method found", ViewCommand::ToggleFound);
        }
        let tooltip = "What each end can see, in the scene (V)";
        mark(ui, settings.show_fields_of_view, "views", tooltip, ViewCommand::ToggleFieldsOfView);
        let tooltip = "What the formulas say of the selected reflector, over every map (T)";
        mark(ui, settings.show_theory, "theory", tooltip, ViewCommand::ToggleTheory);
    });
}

fn failures(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    row_of(ui, "Failures", "Kinds of failure", |ui| {
        let tip = "What became of every object: found, missed, merged, on the wrong tooth; and ghosts (H)";
        tick(ui, settings.show_kinds, "mark", tip, |_| ViewCommand::ToggleKinds, asked);
    });
}
