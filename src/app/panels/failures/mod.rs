//! The failures panel: the scenes that methods were tried on, row by row: sorted, filtered, charted, opened, made worse, kept.

mod cells;
mod charts;
mod choices;
mod filter;
mod input;
mod opened;
mod order;
mod points;
mod shared;
mod table;

use crate::app::content::{Content, Cx, Nothing};
use crate::app::jobs::{Jobs, fates_of};
use crate::evaluate::worsen::summary;
pub use input::{Input, Now};

use crate::app::state::{Command, MethodSlot, RowsCommand, State};
use crate::radar::counted;
use charts::View;
use eframe::egui::{self, Frame, Margin, Ui, Vec2};
use order::{Boxed, Order, Sort, Wanted};
use std::collections::BTreeSet;

/// State of the panel's parts, kept between frames.
#[derive(Default)]
pub struct FailuresMemory {
    choices: choices::ChoicesMemory,
    filter: filter::FilterMemory,
    sort: Option<Sort>,
    order: Order,
    boxed: Option<Boxed>,
    charts: charts::ChartsMemory,
    shared: shared::SharedRulesMemory,
    table: table::TableMemory,
    opened: opened::OpenedMemory,
    in_sight: Vec<usize>,
}

impl FailuresMemory {
    /// Indices of the rows in sight, from top to bottom.
    pub fn in_sight(&self) -> &[usize] {
        &self.in_sight
    }
}

pub struct FailuresPanel;

impl Content for FailuresPanel {
    type Asks = Nothing;
    type Remembers = FailuresMemory;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let (state, jobs) = (&*cx.state, cx.jobs);
        let own = jobs.own_scenes(state);
        let input = Input { state, job: &jobs.failures, own: own.as_deref(), now: now(state, jobs) };
        let asked = show(ui, &input, cx.memory);
        cx.state.failures.in_sight = cx.memory.in_sight().to_vec();
        asked
    }
}

/// Figures of the method in use for the row on screen.
fn now(state: &State, jobs: &Jobs) -> Option<Now> {
    let pipeline = &jobs.pipeline;
    if state.row_on_screen().is_none() || pipeline.output_is_outdated() || state.is_predicting() {
        return None;
    }
    let fates = fates_of(&jobs.kinds, MethodSlot::First, pipeline).filter(|(_, current)| *current);
    let (output, scores) = (pipeline.output()?, pipeline.scores_in(MethodSlot::First)?);
    let fates = fates.map(|(fates, _)| summary(&fates.failures));
    Some(Now { method: output.method(), metrics: scores.metrics, fates })
}

pub fn show(ui: &mut Ui, input: &Input<'_>, memory: &mut FailuresMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    Frame::NONE.inner_margin(Margin::symmetric(8, 6)).show(ui, |ui| {
        choices::show(ui, input, &mut memory.choices, &mut asked);
        egui::Panel::bottom("row on screen").resizable(false).frame(Frame::NONE.inner_margin(Margin::symmetric(0, 4))).show(
            ui,
            |ui| opened::show(ui, input, &mut memory.opened, &mut asked),
        );
        if input.job.table.rows().is_empty() {
            memory.in_sight.clear();
            let text = "Try methods on scenes, or open rows that apertura evaluate --rows wrote: every scene is a row to \
                        sort, filter and open.";
            ui.weak(text);
            return;
        }
        let known: BTreeSet<&str> =
            input.job.table.methods().iter().map(String::as_str).chain(input.state.methods.all.iter().map(|m| m.name())).collect();
        filter::show(ui, &known, &mut memory.filter);
        update(ui, input, memory);
        head(ui, input, memory);
        if memory.charts.view != View::None {
            let panel = beside_or_below(ui.available_size()).frame(Frame::NONE);
            panel.show(ui, |ui| chart(ui, input, memory, &mut asked));
        }
        rows(ui, input, memory, &mut asked);
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
    memory.boxed.take_if(|boxed| boxed.generation != input.job.table.generation());
    let wanted = Wanted {
        table: &input.job.table,
        filter: memory.filter.filter(),
        sort: memory.sort,
        boxed: memory.boxed.as_ref(),
    };
    if let Some(later) = memory.order.update(&wanted) {
        ui.ctx().request_repaint_after(later);
    }
}

/// Draws the number of shown rows, the button of the box, and the choice of chart.
fn head(ui: &mut Ui, input: &Input<'_>, memory: &mut FailuresMemory) {
    ui.horizontal_wrapped(|ui| {
        let (shown, all) = (memory.order.shown().len(), input.job.table.rows().len());
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
    if memory.charts.view == View::Shared {
        if let Some(rule) = shared::show(ui, &input.job.table, &mut memory.shared) {
            memory.filter.set(rule);
            ui.request_repaint();
        }
        return;
    }
    let of = charts::Input { table: &input.job.table, order: &memory.order, opened: input.opened() };
    let answer = charts::show(ui, &of, memory.boxed.as_ref(), &mut memory.charts);
    asked.extend(answer.open.map(|v| Command::Rows(RowsCommand::Show(v))));
    if let Some(boxed) = answer.boxed {
        // An empty box selects all rows.
        memory.boxed = Some(boxed).filter(|boxed| !boxed.rows.is_empty());
        ui.request_repaint();
    }
}

fn rows(ui: &mut Ui, input: &Input<'_>, memory: &mut FailuresMemory, asked: &mut Vec<Command>) {
    let of = table::Input {
        table: &input.job.table,
        album: &input.job.thumbnails.album,
        shown: memory.order.shown(),
        sort: memory.sort,
        opened: input.opened(),
        colours: input.state.settings.colours,
    };
    let answer = table::show(ui, &of, &mut memory.table);
    asked.extend(answer.open.map(|v| Command::Rows(RowsCommand::Show(v))));
    if let Some(column) = answer.sort {
        memory.sort = Sort::clicked(memory.sort, column);
        ui.request_repaint();
    }
    memory.in_sight = answer.in_sight;
}

#[cfg(test)]
mod tests;
