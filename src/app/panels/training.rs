//! The training panel: the loss in the log of a training.

use crate::app::content::{Content, Cx};
use crate::app::jobs::{LOG_INTERVAL, Log, LogQuery, Watched};
use crate::app::state::{Command, Purpose};
use crate::app::widgets::legend::{self, Sign};
use crate::app::widgets::{Axis, Chart, Computed, button, padded, scientific, theme, warning};
use eframe::egui::{Color32, Grid, Sense, Stroke, Ui};
use egui_plot::LineStyle;
use std::path::Path;

pub const PANEL: Content<(), LogQuery> =
    Content { marks_age: true, ..Content::computed(|_, jobs| jobs.training.as_ref().map(Watched::query), draw) };

fn draw(ui: &mut Ui, cx: Cx<'_, (), LogQuery>) -> Vec<Command> {
    let path = cx.jobs.training.as_ref().map(|watched| watched.path.as_path());
    if path.is_some() {
        ui.ctx().request_repaint_after(LOG_INTERVAL);
    }
    show(ui, path, cx.value)
}

/// Draws the log at `path`, or the error of its last reading.
pub fn show(ui: &mut Ui, path: Option<&Path>, read: Computed<'_, Log>) -> Vec<Command> {
    let error = read.and_then(Result::err);
    padded(ui, |ui, asked| {
        button(ui, "Open training log…", Purpose::OpenLog, true, asked);
        warning(ui, error);
        match read.and_then(Result::ok).filter(|l| !l.loss.is_empty()) {
            Some(log) => curves(ui, log),
            None => _ = ui.weak(waiting(path, error.is_some())),
        }
    })
}

/// Text in place of the curve, while there is none.
fn waiting(path: Option<&Path>, has_failed: bool) -> String {
    match path {
        // There is no waiting for a log that can't be read.
        Some(path) if !has_failed => format!("Waiting for the first line of {}…", path.display()),
        Some(path) => format!("{} has no line.", path.display()),
        None => "Open the log.csv of a training (apertura train), and watch its loss while it learns.".to_owned(),
    }
}

fn curves(ui: &mut Ui, log: &Log) {
    Grid::new("last").num_columns(8).spacing([10.0, 2.0]).show(ui, |ui| {
        for (i, (name, value)) in log.last.iter().enumerate() {
            ui.weak(name.replace('_', " "));
            // A whole number has all digits, others have five.
            ui.monospace(match value.parse::<f64>() {
                Ok(number) if number != number.trunc() || number.abs() >= 1e9 => scientific(number, 4),
                Ok(number) => number.to_string(),
                Err(_) => value.clone(),
            });
            if i % 4 == 3 {
                ui.end_row();
            }
        }
    });
    let log10 = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        points.iter().filter(|p| p[1] > 0.0).map(|p| [p[0], p[1].log10()]).collect()
    };
    let lines = [("loss", Color32::GRAY), ("smoothed", theme::Inks::of(ui.visuals()).selected)];
    legend::row(ui, &lines.map(|(name, colour)| (Sign::Line, colour, name.to_owned())));
    let loss = log10(&log.loss);
    let ends = |axis: usize, room: f64| {
        let (low, high) =
            loss.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        let room = room * (high - low).max(1e-3);
        if low <= high { [low - room, high + room] } else { [0.0, 1.0] }
    };
    let ([first, last], [low, high]) = (ends(0, 0.0), ends(1, 0.05));
    let (x, y) = (Axis::new(first, last.max(first + 1.0), "step"), Axis::new(low, high, "loss, powers of ten"));
    let mut chart = Chart::new("Loss against step", x, y).with_zoom();
    chart.line(loss.iter().copied(), Stroke::new(1.0, Color32::GRAY), LineStyle::Solid);
    chart.line(log10(&log.smoothed), Stroke::new(1.8, lines[1].1), LineStyle::Solid);
    let drawn = chart.show(ui, ui.available_rect_before_wrap(), Sense::click_and_drag());
    drawn.tell(|[step, power]| Some(format!("step {step:.0}\nloss {}", scientific(10f64.powf(power), 3))));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable};

    fn panel(note: Option<&'static str>) -> Harness<'static> {
        let draw = move |ui: &mut Ui| _ = show(ui, Some(Path::new("log.csv")), note.map(Err));
        Harness::builder().with_size([500.0, 300.0]).build_ui(draw)
    }

    #[test]
    fn a_log_that_cannot_be_read_is_not_waited_for() {
        assert!(panel(None).query_by_label_contains("Waiting for the first line").is_some());
        assert!(panel(Some("log.csv: line 3")).query_by_label_contains("Waiting").is_none());
    }
}
