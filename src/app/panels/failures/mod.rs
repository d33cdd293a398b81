//! The failures panel: the scenes that methods were tried on, row by row: sorted, filtered, charted, opened, made worse, kept.

mod cells;
mod charts;
mod choices;
mod filter;
mod input;
mod opened;
mod order;
mod points;
mod table;

use crate::app::content::{Content, Cx};
use crate::app::jobs::{Jobs, judged_output};
use crate::app::state::{Command, MethodSlot, RowsCommand, State};
use crate::evaluate::worsen::summary;
use crate::radar::counted;
use charts::View;
use eframe::egui::{self, Frame, Margin, Ui, Vec2};
pub use input::{Input, Now};
use order::{Boxed, Order, Sort};
use std::collections::BTreeSet;

#[derive(Default)]
pub struct FailuresMemory {
    choices: choices::ChoicesMemory,
    filter: filter::FilterMemory,
    sort: Option<Sort>,
    order: Order,
    boxed: Option<Boxed>,
    charts: charts::ChartsMemory,
    table: table::TableMemory,
    opened: opened::OpenedMemory,
}

pub const PANEL: Content<FailuresMemory> = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_, FailuresMemory>) -> Vec<Command> {
    let (state, jobs) = (&*cx.state, cx.jobs);
    let own = jobs.own_scenes(state);
    let input = Input { state, job: &jobs.failures, own: own.as_deref(), now: now(state, jobs) };
    let asked = show(ui, &input, cx.memory);
    cx.state.failures.in_sight = cx.memory.table.in_sight.clone();
    asked
}

/// Figures of the method in use for the row on screen.
fn now(state: &State, jobs: &Jobs) -> Option<Now> {
    let pipeline = &jobs.pipeline;
    if state.row_on_screen().is_none() || pipeline.output_is_outdated() || state.is_predicting() {
        return None;
    }
    let judged = judged_output(&jobs.kinds, MethodSlot::First, pipeline).filter(|(_, current)| *current);
    let (output, scores) = (pipeline.output()?, pipeline.scores_in(MethodSlot::First)?);
    let verdicts = judged.map(|(judged, _)| summary(&judged.verdicts));
    Some(Now { method: output.method(), metrics: scores.metrics, verdicts })
}

const NO_ROWS: &str = "Try methods on scenes, or open rows that apertura evaluate --rows wrote: every scene is a row to sort, filter and open.";

pub fn show(ui: &mut Ui, input: &Input<'_>, memory: &mut FailuresMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    Frame::NONE.inner_margin(Margin::symmetric(8, 6)).show(ui, |ui| {
        choices::show(ui, input, &mut memory.choices, &mut asked);
        let below = egui::Panel::bottom("row on screen").resizable(false);
        let below = below.frame(Frame::NONE.inner_margin(Margin::symmetric(0, 4)));
        below.show(ui, |ui| opened::show(ui, input, &mut memory.opened, &mut asked));
        if input.job.table.rows().is_empty() {
            memory.table.in_sight.clear();
            ui.weak(NO_ROWS);
            return;
        }
        let tried = input.job.table.methods().iter().map(String::as_str);
        let known: BTreeSet<&str> = tried.chain(input.state.methods.all.iter().map(|m| m.name())).collect();
        filter::show(ui, &known.into_iter().collect::<Vec<_>>(), &mut memory.filter);
        update(ui, input, memory);
        head(ui, input, memory);
        if memory.charts.view != View::None {
            let panel = beside_or_below(ui.available_size()).frame(Frame::NONE);
            panel.show(ui, |ui| chart(ui, input, memory, &mut asked));
        }
        let open = table::show(ui, input, &memory.order.shown, &mut memory.sort, &mut memory.table);
        asked.extend(open.map(|v| Command::Rows(RowsCommand::Show(v))));
    });
    asked
}

/// Place of a chart: beside the rows in a wide panel, else below them.
fn beside_or_below(room: Vec2) -> egui::Panel {
    let of = |length: f32| (0.45 * length, 90.0..=(0.8 * length).max(90.0));
    if room.x > 2.2 * room.y {
        let (usual, range) = of(room.x);
        egui::Panel::right("chart beside rows").default_size(usual).size_range(range)
    } else {
        let (usual, range) = of(room.y);
        egui::Panel::bottom("chart below rows").default_size(usual).size_range(range)
    }
}

/// Filters and sorts the rows, if something changed.
fn update(ui: &Ui, input: &Input<'_>, memory: &mut FailuresMemory) {
    let table = &input.job.table;
    memory.boxed.take_if(|boxed| boxed.generation != table.generation());
    let later = memory.order.update(table, memory.filter.filter.as_ref(), memory.sort, memory.boxed.as_ref());
    if let Some(later) = later {
        ui.ctx().request_repaint_after(later);
    }
}

/// Draws the number of shown rows, the button of the box, and the choice of chart.
fn head(ui: &mut Ui, input: &Input<'_>, memory: &mut FailuresMemory) {
    ui.horizontal_wrapped(|ui| {
        let (shown, all) = (memory.order.shown.len(), input.job.table.rows().len());
        let rows = counted(all, "row", "rows");
        ui.weak(if shown == all { rows } else { format!("{shown} of {rows}") });
        if let Some(boxed) = &memory.boxed {
            let name = format!("× {} in the box", boxed.rows.len());
            if ui.small_button(name).on_hover_text("Show rows outside the box again").clicked() {
                memory.boxed = None;
            }
        }
        ui.separator();
        charts::choices(ui, &input.job.table, &mut memory.charts);
        // In a row that is always there, so that nothing moves while an expression is typed.
        filter::problem(ui, &memory.filter);
    });
}

fn chart(ui: &mut Ui, input: &Input<'_>, memory: &mut FailuresMemory, asked: &mut Vec<Command>) {
    let (open, boxed) = charts::show(ui, input, &memory.order, memory.boxed.as_ref(), &mut memory.charts);
    asked.extend(open.map(|v| Command::Rows(RowsCommand::Show(v))));
    if let Some(boxed) = boxed {
        // An empty box selects all rows.
        memory.boxed = Some(boxed).filter(|boxed| !boxed.rows.is_empty());
        ui.request_repaint();
    }
}

#[cfg(test)]
mod tests;
