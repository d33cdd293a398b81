//! Read access to the app for tests.

use super::application::App;
use super::apply;
use super::jobs::{BoundsRequest, DopplerQuery};
use super::state::{Command, MapKind, MethodSlot, Panel, State};
use super::widgets::Texture;
use crate::bounds::PositionBound;
use crate::engine::EngineReport;
use crate::evaluate::Metrics;
use crate::evaluate::rows::Row;
use crate::maps::RangeAngleMap;
use crate::reconstruct::Detection;
use crate::scene::Reflector;
use std::ops::Deref;
use std::sync::Arc;

/// The app's state is that of its document, panels, settings and messages.
impl Deref for App {
    type Target = State;

    fn deref(&self) -> &State {
        &self.state
    }
}

impl App {
    /// Queues a command, as a menu entry would.
    pub fn ask(&mut self, command: impl Into<Command>) {
        self.asked.push(command.into());
    }

    /// Whether a worker of jobs or panels is busy.
    pub fn is_busy(&self) -> bool {
        self.jobs.is_busy() || self.panels.is_busy()
    }

    /// Whether the autosave on disk holds all unsaved scenes as they are.
    pub fn is_kept(&self) -> bool {
        self.jobs.autosave.as_ref().is_some_and(|autosave| autosave.holds(&self.state.editor))
    }

    /// Report of the engine's last update, if there was one.
    pub fn report(&self) -> Option<&EngineReport> {
        self.jobs.pipeline.maps.result().map(|r| &r.frame.report)
    }

    /// Maps with a picture of the latest scene.
    pub fn pictures(&self) -> Vec<MapKind> {
        self.jobs.pipeline.maps.result().map(|r| r.pictures.keys().copied().collect()).unwrap_or_default()
    }

    /// Requests sent to the maps' worker, and pictures painted, since the start.
    pub fn work_done(&self) -> (u64, u64) {
        (self.jobs.pipeline.maps.requests, self.jobs.pipeline.maps.result().map_or(0, |r| r.painted))
    }

    /// Reflectors found by the method, as far as the maps mark them.
    pub fn marked_found(&self) -> &[Reflector] {
        self.jobs.pipeline.shown_found(&self.state)
    }

    /// Detections of the method, where they are listed.
    pub fn found(&self) -> Option<&[Detection]> {
        self.jobs.pipeline.output_of(&self.state)?.found.as_deref()
    }

    /// Part of the recording's power that the drawn reflectors explain, where a panel shows it.
    pub fn explained(&self) -> Option<f64> {
        self.jobs.pipeline.unexplained().map(|u| u.explained)
    }

    /// The reason why the method has no output, where it has none.
    pub fn refusal(&self) -> Option<&str> {
        self.jobs.pipeline.method(MethodSlot::First).refusal().map(|r| r.reason.as_str())
    }

    /// Cells that the detector in use finds in the target and in the first method's output, and the reason where it fails.
    pub fn detected(&self) -> ([Option<usize>; 2], Option<&str>) {
        let count = |map: &Option<Arc<RangeAngleMap>>| Some(map.as_ref()?.lambda.iter().filter(|v| **v > 0.5).count());
        let found = self.jobs.pipeline.maps.result().map(|r| &r.detected);
        let counts = found.map_or([None, None], |found| [count(&found.target), count(&found.outputs[0])]);
        (counts, self.jobs.pipeline.detector_error())
    }

    /// Names of the results drawn as fresh that belong to an earlier scene or settings. There are some only for a moment after a change.
    pub fn drawn_as_fresh_but_old(&self) -> Vec<String> {
        let mut old = self.jobs.drawn_as_fresh_but_old(&self.state);
        old.extend(self.panels.drawn_as_fresh_but_old(&self.state, &self.jobs));
        old
    }

    /// The bound on screen, if there is one.
    pub fn position_bound(&self) -> Option<PositionBound> {
        self.panels.derived::<Texture, BoundsRequest>(Panel::Bounds)?.value()?.ok()?.bound.ok()
    }

    /// Range bin and column of the strongest cell of the range-Doppler map on screen.
    pub fn doppler_peak(&self) -> Option<(usize, usize)> {
        let decades =
            self.panels.derived::<Texture, DopplerQuery>(Panel::RangeDoppler)?.value()?.ok()?.decades.decades();
        decades.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).map(|(cell, _)| cell)
    }

    /// Name of the method whose output is on screen, if there is one.
    pub fn shown_method(&self) -> Option<&'static str> {
        self.jobs.pipeline.output().map(|output| output.method())
    }

    /// Figures of the first method's output, if there are any.
    pub fn metrics(&self) -> Option<Metrics> {
        self.jobs.pipeline.scores_in(MethodSlot::First).map(|s| s.metrics)
    }

    /// Whether a job started in a tool's panel runs.
    pub fn is_at_work(&self) -> bool {
        let jobs = &self.jobs;
        jobs.failures.run.progress().is_some()
            || jobs.failures.search.job.progress().is_some()
            || jobs.run_time.progress().is_some()
    }

    /// The rows of the panel Evaluate.
    pub fn rows(&self) -> &[Row] {
        self.jobs.failures.table.rows()
    }

    /// Index of the row that was opened last.
    pub fn opened_row(&self) -> Option<usize> {
        self.state.failures.opened.as_ref().map(|opened| opened.index)
    }

    /// The scene on screen as a line of text, where it can be shared ([`crate::share`]).
    pub fn shared_text(&self) -> Option<String> {
        apply::shared_text(&self.state).ok()
    }
}
