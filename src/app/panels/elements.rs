//! The elements panel: the elements that methods use, and their errors: a strip to click, numbers to type, a seed, and a calibration.

mod heard;
mod strip;
#[cfg(test)]
mod tests;

use self::strip::MAX_DISPLACEMENT_MILLIMETRES;
use crate::app::content::Content;
use crate::app::jobs::{Calibrated, CalibrationQuery};
use crate::app::state::{Command, RadarCommand, State};
use crate::app::widgets::{Computed, NumberField, labelled, press, scrolled};
use crate::radar::{BuiltArray, Decibels, ElementError, Radar, Tolerances};
use eframe::egui::{CollapsingHeader, Grid, TextEdit, Ui};
use std::sync::Arc;

pub struct ElementsMemory {
    chosen: usize,
    tolerances: Tolerances,
    seed: u64,
    list: String,
    /// Distance of a bent line's ends behind its middle, millimetres.
    back_millimetres: f64,
}

impl Default for ElementsMemory {
    fn default() -> Self {
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 10.0, position_millimetres: 0.0 };
        ElementsMemory { chosen: 0, tolerances, seed: 0, list: String::new(), back_millimetres: 0.0 }
    }
}

pub const PANEL: Content<ElementsMemory, CalibrationQuery> =
    Content::computed(|state, _| CalibrationQuery::of(state), |ui, cx| show(ui, cx.state, cx.value, cx.memory));

/// Draws the panel with the calibration on the selected point; `None` where no point is selected.
pub fn show(ui: &mut Ui, state: &State, found: Computed<'_, Calibrated>, memory: &mut ElementsMemory) -> Vec<Command> {
    memory.chosen = memory.chosen.min(state.radar().elements - 1);
    scrolled(ui, |ui, asked| {
        summary(ui, state.elements(), asked);
        heard::show(ui, state, asked);
        if let Some((n, error)) = strip::show(ui, state, &mut memory.chosen) {
            asked.push(with(state, n, error));
        }
        one(ui, state, memory, asked);
        ui.separator();
        draw_from_seed(ui, state, memory, asked);
        bend(ui, state, memory, asked);
        list(ui, state.radar(), memory, asked);
        ui.separator();
        calibration(ui, found, asked);
    })
}

/// The command for an array whose element `n` has these errors.
fn with(state: &State, n: usize, error: ElementError) -> Command {
    let mut elements = state.elements().elements.clone();
    elements.resize(state.radar().elements, ElementError::default());
    elements[n] = error;
    Command::Radar(RadarCommand::SetElements(Arc::new(BuiltArray { elements })))
}

fn summary(ui: &mut Ui, elements: &BuiltArray, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        if elements.is_ideal() {
            ui.weak("No element errors. Click an element to disable it.");
            return;
        }
        let living = elements.elements.len() - elements.dead();
        ui.label(told(elements)).on_hover_text(spread_tooltip(living));
        let tooltip = "Remove all element errors; undo brings them back";
        if ui.small_button("Ideal array").on_hover_text(tooltip).clicked() {
            asked.push(RadarCommand::SetElements(Arc::default()).into());
        }
    });
}

/// Text of an array's errors: dead elements, and the spread of gain, phase and place.
fn told(elements: &BuiltArray) -> String {
    let Tolerances { gain: Decibels(gain), phase_degrees, position_millimetres } = elements.spread();
    let dead = match elements.dead() {
        0 => String::new(),
        n => format!("{n} dead, "),
    };
    let off_the_line = match elements.most_forward_millimetres() {
        0.0 => String::new(),
        most => format!(", up to {most:.2} mm off the line"),
    };
    let place = format!("place ±{position_millimetres:.2} mm{off_the_line}");
    format!("{dead}as drawn: gain ±{gain:.2} dB, phase ±{phase_degrees:.1}°, {place}")
}

/// Tooltip of the spread, with its usual random difference from the chosen standard deviation.
fn spread_tooltip(living: usize) -> String {
    let percent = 100.0 / (2.0 * living.max(1) as f64).sqrt();
    format!(
        "Root mean square over the {living} elements that hear. Errors are drawn from normal distributions: over so many elements it \
         differs from the standard deviation asked for by about {percent:.0} % from draw to draw."
    )
}

/// Draws the fields of the chosen element.
fn one(ui: &mut Ui, state: &State, memory: &mut ElementsMemory, asked: &mut Vec<Command>) {
    let n = memory.chosen;
    let mut error = state.elements().element(n);
    ui.horizontal_wrapped(|ui| {
        let most = state.radar().elements - 1;
        labelled(ui, "element", "", NumberField::new(&mut memory.chosen).range(0..=most).speed(0.2));
        ui.checkbox(&mut error.dead, "dead");
        for (name, value, unit, most, speed) in [
            ("gain", &mut error.gain.0, " dB", 60.0, 0.05),
            ("phase", &mut error.phase_degrees, "°", 360.0, 0.5),
            ("place", &mut error.position_millimetres, " mm", MAX_DISPLACEMENT_MILLIMETRES, 0.01),
            ("forward", &mut error.forward_millimetres, " mm", MAX_DISPLACEMENT_MILLIMETRES, 0.01),
        ] {
            let field = NumberField::new(value).range(-most..=most).clamp_existing_to_range(false);
            labelled(ui, name, "", field.speed(speed).max_decimals(3).suffix(unit));
        }
    });
    if error != state.elements().element(n) {
        asked.push(with(state, n, error));
    }
}

fn draw_from_seed(ui: &mut Ui, state: &State, memory: &mut ElementsMemory, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let Tolerances { gain, phase_degrees, position_millimetres } = &mut memory.tolerances;
        for (name, value, unit, most) in [
            ("gains ±", &mut gain.0, " dB", 40.0),
            ("phases ±", phase_degrees, "°", 180.0),
            ("places ±", position_millimetres, " mm", 100.0),
        ] {
            let field = NumberField::new(value).range(0.0..=most).speed(0.05).max_decimals(2).suffix(unit);
            labelled(ui, name, "Standard deviation", field);
        }
        labelled(ui, "seed", "", NumberField::new(&mut memory.seed).speed(0.05));
        let tooltip = "Give every element an error of its own; the dead stay dead";
        if ui.button("Draw").on_hover_text(tooltip).clicked() {
            let mut drawn = memory.tolerances.build(state.radar(), memory.seed);
            drawn.elements.iter_mut().enumerate().for_each(|(n, e)| e.dead = state.elements().element(n).dead);
            asked.push(RadarCommand::SetElements(Arc::new(drawn)).into());
        }
    });
}

/// Draws the field that puts the elements on a bent line, as on a bumper.
fn bend(ui: &mut Ui, state: &State, memory: &mut ElementsMemory, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let field = NumberField::new(&mut memory.back_millimetres).range(-1000.0..=1000.0).speed(0.05);
        let tooltip = "How far the ends of a bent line stand behind its middle";
        labelled(ui, "ends back by", tooltip, field.max_decimals(2).suffix(" mm"));
        let bent = state.elements().bent(state.radar(), memory.back_millimetres);
        let tooltip =
            "Put the elements on a parabola. Maps and methods still take them for a straight line: compare the target";
        press(ui, "Bend", tooltip, RadarCommand::SetElements(Arc::new(bent)), asked);
    });
}

/// Hint in the field of the list: its columns and their units.
const LIST_COLUMNS: &str = "place mm, forward mm, gain dB, phase °";

fn list(ui: &mut Ui, radar: &Radar, memory: &mut ElementsMemory, asked: &mut Vec<Command>) {
    let tooltip = "One line an element from the leftmost, as a spreadsheet copies it. Missing numbers are 0";
    CollapsingHeader::new("From a list").id_salt("elements from a list").show(ui, |ui| {
        let lines = TextEdit::multiline(&mut memory.list).desired_rows(4).desired_width(f32::INFINITY).code_editor();
        labelled(ui, LIST_COLUMNS, tooltip, lines);
        match BuiltArray::from_list(&memory.list, radar.elements) {
            _ if memory.list.trim().is_empty() => {}
            Ok(elements) => {
                let command = RadarCommand::SetElements(Arc::new(elements));
                press(ui, "Use the list", "Replace all elements; undo brings them back", command, asked);
            }
            Err(error) => _ = ui.colored_label(ui.visuals().error_fg_color, error),
        }
    });
}

fn calibration(ui: &mut Ui, calibrated: Computed<'_, Calibrated>, asked: &mut Vec<Command>) {
    let found = match calibrated.unwrap_or(Err("Select a point to calibrate the elements on its echo.")) {
        Ok(found) => found,
        Err(reason) => {
            ui.weak(reason);
            return;
        }
    };
    ui.strong(format!("Calibration on {}", found.name));
    Grid::new("calibration").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| {
        let unexplained = format!("{:.1} % of the power comes from elsewhere", 100.0 * found.calibration.unexplained);
        let rows = [
            ("found", told(&found.calibration.array), "Gain and phase that the reflector's echo tells of each element"),
            ("left", told(&found.left), "Errors of the elements that stay once that is taken off: places can't be"),
            ("residual", unexplained, "Other reflectors, noise, and errors that are no gain and no phase"),
        ];
        for (name, text, tooltip) in rows {
            ui.weak(name).on_hover_text(tooltip);
            ui.label(text).on_hover_text(tooltip);
            ui.end_row();
        }
    });
    let tooltip = "Divide every element's samples by what was found of it";
    press(ui, "Calibrate on this reflector", tooltip, RadarCommand::SetElements(Arc::new(found.left.clone())), asked);
}
