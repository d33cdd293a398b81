//! A row of choices, of which one is chosen.

use crate::app::state::Command;
use crate::app::widgets::tipped;
use eframe::egui::Ui;

/// Draws a label for each choice. `of` yields the choice, its name and its tooltip. A click on another choice sends its `command`.
pub(super) fn choices<T: PartialEq + Copy, C: Into<Command>>(
    ui: &mut Ui,
    chosen: T,
    of: impl IntoIterator<Item = (T, &'static str, &'static str)>,
    command: impl Fn(T) -> C,
    asked: &mut Vec<Command>,
) {
    for (choice, name, tooltip) in of {
        if tipped(ui.selectable_label(choice == chosen, name), tooltip).clicked() && choice != chosen {
            asked.push(command(choice).into());
        }
    }
}
