//! Thresholds for the whole map or a detector with a constant false-alarm rate, and the detector's cells.

use crate::app::state::{Command, Settings, ViewCommand};
use crate::app::widgets::{NumberField, choices, row, row_of};
use crate::maps::cfar::{Cfar, MOST_CELLS, Statistic};
use eframe::egui::{Response, Ui};

/// Draws the choice between a global threshold and the detectors.
pub fn choice(ui: &mut Ui, settings: &Settings, asked: &mut Vec<Command>) {
    let tooltip = "The rule for detected cells in the panels Target > η' and Output > η";
    row_of(ui, "Detect", tooltip, |ui| {
        let of = [
            (None, "Global", "One threshold for the whole map"),
            (
                Some(Statistic::CellAveraging),
                "CA",
                "Cell averaging (CFAR): the threshold of a cell is the mean power of its training cells times a factor",
            ),
            (
                Some(Statistic::OrderedStatistics),
                "OS",
                "Ordered statistics (CFAR): the threshold is the training cell of rank 3/4 times a factor, so that strong \
                 neighbours hide no echo",
            ),
        ];
        let chosen = settings.cfar.map(|cfar| cfar.statistic);
        choices(ui, chosen, of, ViewCommand::Detect, asked);
    });
}

/// Draws the fields of the detector's cells and of its rate.
pub fn cells(ui: &mut Ui, cfar: &Cfar, error: Option<&str>, asked: &mut Vec<Command>) {
    let mut changed = *cfar;
    let tooltip = "Cells a side that may hold the echo itself and measure nothing";
    sides(ui, "Guard", tooltip, &mut changed.guard);
    sides(ui, "Training", "Cells a side beyond the guard cells, which measure the noise", &mut changed.training);
    rate(ui, &mut changed.false_alarm);
    if changed != *cfar {
        asked.push(ViewCommand::SetCfar(Some(changed)).into());
    }
    if let Some(error) = error {
        ui.colored_label(ui.visuals().error_fg_color, error);
    }
}

/// Draws the fields of cells a side, in range and in angle.
fn sides(ui: &mut Ui, name: &str, tooltip: &str, cells: &mut [usize; 2]) {
    row_of(ui, name, tooltip, |ui| {
        let [bins, columns] = cells;
        for (cells, along, unit) in [(bins, "in range", " bins"), (columns, "in angle", " columns")] {
            let field = NumberField::new(cells).range(0..=MOST_CELLS).speed(0.05).suffix(unit);
            let field = ui.add(field).on_hover_text(format!("{tooltip}, {along}"));
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(format!("{name} cells {along}")));
        }
    });
}

/// Draws the field of the wanted rate of false alarms.
fn rate(ui: &mut Ui, false_alarm: &mut f64) {
    let tooltip = "Part of the cells of noise alone that are to be detected. It holds for noise that is independent from cell to \
                   cell: a window function makes neighbours alike.";
    row(ui, "P_FA", tooltip, |ui| -> Response {
        let text = shown(*false_alarm);
        let speed = 0.02 * *false_alarm;
        ui.add(NumberField::new(false_alarm).range(1e-12..=0.9).speed(speed).standing_for(&text))
    });
}

/// Text of a rate, which the field can parse again.
fn shown(rate: f64) -> String {
    if rate < 1e-3 { format!("{rate:.1e}") } else { format!("{rate:.3}") }
}
