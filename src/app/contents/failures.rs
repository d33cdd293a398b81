//! What the panel of failures is told.

use super::{Contents, offered};
use crate::app::jobs::{Jobs, fates_of};
use crate::app::panels::failures;
use crate::app::state::{Command, MethodSlot, State};
use crate::evaluate::worsen::summary;
use eframe::egui::Ui;

impl Contents<'_> {
    pub(super) fn failures(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (state, jobs) = (&*self.state, self.jobs);
        let (job, own) = (&jobs.failures, jobs.own_scenes(state));
        let (table, search) = (job.table(), &job.search);
        let opened = state.failures.opened.as_ref().filter(|opened| opened.generation == table.generation());
        let input = failures::Input {
            methods: offered(state, jobs),
            method: state.method().map(|m| m.name()),
            table,
            album: job.album(),
            before: job.before(),
            progress: job.progress(),
            note: job.note(),
            unfit: job.unfit(),
            own: own.as_deref(),
            colours: state.settings.colours,
            opened: opened.map(|opened| opened.index),
            on_screen: live(state, jobs),
            search: failures::Searched {
                progress: search.progress(),
                summary: search.summary(),
                note: search.note(),
                has_found: search.path().len() > 1,
            },
        };
        let asked = failures::show(ui, &input, &mut self.memory.failures);
        self.state.failures.in_sight = self.memory.failures.in_sight().to_vec();
        asked
    }
}

/// The row that was opened, while its scene is on screen, and the figures of now.
fn live<'a>(state: &'a State, jobs: &Jobs) -> Option<failures::Live<'a>> {
    let opened = state.row_on_screen()?;
    let pipeline = &jobs.pipeline;
    let is_new = !pipeline.output_is_outdated() && !state.is_predicting();
    let fates = fates_of(&jobs.kinds, MethodSlot::First, pipeline).filter(|(_, current)| *current);
    let now = pipeline.output().zip(pipeline.scores()).filter(|_| is_new).map(|(output, scores)| failures::Now {
        method: output.method,
        metrics: scores.metrics,
        fates: fates.map(|(fates, _)| summary(&fates.failures)),
    });
    Some(failures::Live { row: &opened.row, now })
}
