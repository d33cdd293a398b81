//! Progress bars of long work, and the buttons that start and cancel it.

use crate::app::state::Command;
use eframe::egui::{Button, ProgressBar, Ui, vec2};

/// Largest shown part. The work goes on, so the bar never reads 100 %.
const MAX_PART: f32 = 0.99;

/// Least width of a button that changes its name, points, so that its neighbours don't move.
const MIN_BUTTON_WIDTH_POINTS: f32 = 64.0;

/// A button that starts work, or sends `cancel` while the work `runs`; `tips` are its two tooltips. Returns whether to start the work.
pub fn start_or_cancel(
    ui: &mut Ui,
    (start, cancel): (&str, impl Into<Command>),
    runs: bool,
    is_ready: bool,
    tips: [&str; 2],
    asked: &mut Vec<Command>,
) -> bool {
    let (name, tip) = if runs { ("Cancel", tips[1]) } else { (start, tips[0]) };
    let size = vec2(MIN_BUTTON_WIDTH_POINTS, ui.spacing().interact_size.y);
    let button = ui.add_enabled(runs || is_ready, Button::new(name).min_size(size));
    let is_pressed = button.on_hover_text(tip).on_disabled_hover_text(tip).clicked();
    asked.extend((is_pressed && runs).then(|| cancel.into()));
    is_pressed && !runs
}

/// Draws a progress bar while work runs; `part` is 0 to 1, and 0 stands for an unknown part.
pub fn bar(ui: &mut Ui, part: Option<f32>, width: f32) {
    let Some(part) = part else { return };
    let bar = if part > 0.0 {
        ProgressBar::new(part.min(MAX_PART)).show_percentage()
    } else {
        ProgressBar::new(0.0).animate(true)
    };
    ui.add(bar.desired_width(width));
}

/// Draws a progress bar and a button beside it; returns whether the button was pressed.
pub fn progress(ui: &mut Ui, part: f32, width: f32, cancel_tooltip: &str) -> bool {
    ui.horizontal(|ui| {
        bar(ui, Some(part), width);
        ui.small_button("Cancel").on_hover_text(cancel_tooltip).clicked()
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::RowsCommand;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    #[test]
    fn nothing_moves_when_work_begins() {
        let draw = |ui: &mut Ui, runs: &mut bool| {
            ui.horizontal(|ui| {
                let (button, mut asked) = (("Try", RowsCommand::CancelTrying), Vec::new());
                *runs |= start_or_cancel(ui, button, *runs, true, ["try", "stop"], &mut asked);
                *runs &= asked.is_empty();
                _ = ui.button("Save…");
            });
        };
        let mut row = Harness::builder().with_size([400.0, 60.0]).build_ui_state(draw, false);
        let before = (row.get_by_label("Try").rect(), row.get_by_label("Save…").rect());
        row.clicks(&["Try"]);
        assert_eq!((row.get_by_label("Cancel").rect(), row.get_by_label("Save…").rect()), before);
        row.clicks(&["Cancel"]);
        assert!(!row.state());
    }

    #[test]
    fn work_that_goes_on_never_reads_100_per_cent() {
        let harness = Harness::builder().with_size([400.0, 60.0]).build_ui(|ui| _ = progress(ui, 1.0, 150.0, "stop"));
        seen::assert_reads(harness.output(), &["99%"]);
    }
}
