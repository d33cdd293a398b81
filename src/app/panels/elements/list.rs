//! Elements from a pasted list, and elements on a bent line.

use crate::app::state::{Command, RadarCommand};
use crate::app::widgets::{NumberField, labelled, press};
use crate::radar::{BuiltArray, Radar};
use eframe::egui::{CollapsingHeader, TextEdit, Ui};
use std::sync::Arc;

/// Contents of the fields, kept between frames.
#[derive(Default)]
pub(super) struct ElementListMemory {
    /// The pasted list.
    text: String,
    /// Distance of the line's ends behind its middle, millimetres.
    back_millimetres: f64,
}

/// Hint in the field of the list: its columns and their units.
const EXAMPLE: &str = "place mm, forward mm, gain dB, phase °";

/// Draws the field of the bend and that of the list.
pub(super) fn show(
    ui: &mut Ui,
    radar: &Radar,
    elements: &BuiltArray,
    memory: &mut ElementListMemory,
    asked: &mut Vec<Command>,
) {
    bend(ui, radar, elements, memory, asked);
    let tooltip = "One line an element from the leftmost, as a spreadsheet copies it. Missing numbers are 0";
    CollapsingHeader::new("From a list").id_salt("elements from a list").show(ui, |ui| {
        let lines = TextEdit::multiline(&mut memory.text).desired_rows(4).desired_width(f32::INFINITY).code_editor();
        labelled(ui, EXAMPLE, tooltip, lines);
        match BuiltArray::from_list(&memory.text, radar.elements) {
            _ if memory.text.trim().is_empty() => {}
            Ok(elements) => {
                let (tip, command) =
                    ("Replace all elements; undo brings them back", RadarCommand::SetElements(Arc::new(elements)));
                press(ui, "Use the list", tip, command, asked);
            }
            Err(error) => _ = ui.colored_label(ui.visuals().error_fg_color, error.to_string()),
        }
    });
}

/// Draws the field that puts the elements on a bent line, as on a bumper.
fn bend(ui: &mut Ui, radar: &Radar, elements: &BuiltArray, memory: &mut ElementListMemory, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let field = NumberField::new(&mut memory.back_millimetres).range(-1000.0..=1000.0).speed(0.05);
        let tooltip = "How far the ends of a bent line stand behind its middle";
        labelled(ui, "ends back by", tooltip, field.max_decimals(2).suffix(" mm"));
        let tooltip =
            "Put the elements on a parabola. Maps and methods still take them for a straight line: compare the target";
        if ui.button("Bend").on_hover_text(tooltip).clicked() {
            let bent = elements.bent(radar, memory.back_millimetres);
            asked.push(RadarCommand::SetElements(Arc::new(bent)).into());
        }
    });
}
