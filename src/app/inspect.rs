//! What may be seen of the app from outside: tests ask it what was computed and what was not.

use super::application::App;
use super::command::Command;
use super::layout::Layout;
use super::pictures::MapKind;
use super::settings::Settings;
use crate::bounds::PositionBound;
use crate::interact::Editor;
use crate::live::Report;

impl App {
    /// The scene being edited, what is selected and what can be undone.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// What the user chose.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Where the panels are.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Asks for a command, as a menu entry would.
    pub fn ask(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Whether a worker has something to do.
    pub fn is_busy(&self) -> bool {
        self.pipeline.is_busy() || self.bounds.is_busy() || self.files.autosave.as_ref().is_some_and(|a| a.is_busy())
    }

    /// Report of the last update, if there was one.
    pub fn report(&self) -> Option<&Report> {
        self.pipeline.result.as_ref().map(|r| &r.frame.report)
    }

    /// Maps with a picture of the latest scene.
    pub fn pictures(&self) -> Vec<MapKind> {
        self.pipeline.result.as_ref().map(|r| r.pictures.keys().copied().collect()).unwrap_or_default()
    }

    /// Requests sent to the maps worker, and pictures painted, since the start.
    pub fn work_done(&self) -> (u64, u64) {
        (self.pipeline.requests, self.pipeline.result.as_ref().map_or(0, |r| r.painted))
    }

    /// Bounds asked for since the start.
    pub fn bounds_asked(&self) -> u64 {
        self.bounds.requests
    }

    /// The bound on screen, if there is one.
    pub fn position_bound(&self) -> Option<PositionBound> {
        self.bounds.result.as_ref().and_then(|r| r.bound.ok())
    }

    /// Name of the method whose output is on screen, if there is one.
    pub fn shown_method(&self) -> Option<&'static str> {
        self.pipeline.output.as_ref().map(|output| output.method)
    }

    /// Rows that the run-time panel has measured.
    pub fn front_rows(&self) -> usize {
        self.front.rows().len()
    }

    /// Whether something runs that was started in a tool's panel.
    pub fn is_at_work(&self) -> bool {
        self.evaluation.evaluation.progress().is_some() || self.front.progress().is_some() || self.training.is_running()
    }

    /// What the evaluation has found, as CSV.
    pub fn evaluation_csv(&self) -> String {
        self.evaluation.evaluation.to_csv()
    }

    /// Number of messages on screen.
    pub fn messages(&self) -> usize {
        self.messages.len()
    }
}
