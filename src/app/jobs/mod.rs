//! Work on threads of its own beside the window. Each frame polls it at its beginning, and at its end asks for the values that its panels showed.

mod age;
mod background;
mod bounds;
mod calibration;
mod chirp;
mod derived;
mod detected;
mod dialogs;
mod doppler;
mod export;
mod failures;
mod frame_log;
mod heard;
mod kinds;
mod lessons;
mod listening;
mod maps;
mod memo;
mod method;
mod one_scale;
mod painter;
mod phasors;
mod pipeline;
mod recorded;
mod rest;
mod rows;
mod run_time;
mod scene_maps;
mod sentence;
mod several;
mod source;
mod subject;
mod theory;
mod training;

use background::Background;
pub use bounds::{BoundsRequest, BoundsResult};
pub use calibration::Calibrated;
pub use calibration::CalibrationQuery;
pub use chirp::{ChirpQuery, ChirpResult};
pub use derived::{Derived, Failure, Query};
pub use dialogs::{Dialogs, Question};
pub use doppler::{DopplerQuery, DopplerResult};
pub use export::{EXPORT_MESSAGE_START, Exports};
#[cfg(test)]
pub use failures::some_row;
pub use failures::{
    Failures, FailuresPlan, RowTable, THUMBNAIL_HEIGHT, THUMBNAIL_WIDTH, Thumbnail, is_table_of_rows, keep,
};
pub use frame_log::FrameLog;
use kinds::KindsQuery;
pub use kinds::{JudgedOutput, VerdictMark, judged_output};
pub use lessons::Lessons;
pub use listening::{Listening, is_live};
pub use memo::Memo;
pub use method::Refusal;
pub use phasors::{PhasorsQuery, PhasorsResult};
pub use pipeline::{Pipeline, Want};
use rows::RowJob;
pub use run_time::RunTimePlan;
pub use scene_maps::Scores;
pub use several::{SeveralMaps, Small};
use theory::TheoryRequest;
pub use theory::TheoryResult;
pub use training::{LOG_INTERVAL, Log, LogQuery, Watched};

use crate::app::state::{Command, DocumentCommand, Panel, Purpose, RowsCommand, State};
use crate::interact::Autosave;
use crate::platform;
use eframe::egui::{Context, DroppedFile};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Time between two frames while a progress bar is shown.
const PROGRESS_FRAME_INTERVAL: Duration = Duration::from_millis(100);

/// All work of the app.
pub struct Jobs {
    pub pipeline: Pipeline,
    pub failures: Failures,
    pub run_time: RowJob<RunTimePlan>,
    pub training: Option<Watched>,
    pub several: SeveralMaps,
    /// The verdict on every object in the outputs.
    pub kinds: Derived<KindsQuery>,
    /// Predictions and position bound of one reflector by formulas.
    pub theory: Derived<TheoryRequest>,
    /// Predictions and challenges being judged.
    pub lessons: Lessons,
    pub exports: Exports,
    /// The capture card that is listened to.
    pub listening: Listening,
    pub dialogs: Dialogs,
    /// The autosave of unsaved scenes, if there is a folder for it.
    pub autosave: Option<Autosave>,
    wake: Context,
    folder: Option<PathBuf>,
}

impl Jobs {
    /// Starts every thread. The autosave is kept in `folder`; there is none without it.
    pub fn start(ctx: &Context, folder: Option<&Path>, dialogs: Dialogs) -> Jobs {
        let wake = platform::waker(ctx);
        Jobs {
            pipeline: Pipeline::start(wake.clone()),
            failures: Failures::start(folder, ctx),
            run_time: RowJob::start(wake.clone()),
            training: None,
            several: SeveralMaps::start(wake.clone()),
            kinds: Derived::start(wake.clone()),
            theory: Derived::start(wake),
            lessons: Lessons::start(ctx),
            exports: Exports(Background::new(ctx.clone())),
            listening: Listening::new(ctx.clone()),
            dialogs,
            autosave: folder.map(Autosave::claim),
            wake: ctx.clone(),
            folder: folder.map(Path::to_path_buf),
        }
    }

    /// Takes in work finished since the last frame. Returns the commands of chosen files, lessons, frames and searches.
    pub fn poll(&mut self, state: &mut State) -> Vec<Command> {
        let mut errors = platform::problems();
        errors.extend(self.pipeline.poll(&mut state.method_times));
        errors.extend(self.kinds.poll());
        errors.extend(self.theory.poll());
        errors.extend(self.failures.poll());
        let (found, failed) = self.failures.search.poll();
        errors.extend(failed);
        errors.extend(self.run_time.poll());
        errors.extend(self.several.poll());
        errors.extend(self.lessons.poll(state));
        let mut chosen = self.chosen(state);
        for opened in self.lessons.opened.finished() {
            opened.map_or_else(|error| errors.push(error), |lesson| chosen.push(lesson.into()));
        }
        errors.into_iter().for_each(|e| state.notices.error(e));
        for export in self.exports.0.finished() {
            state.notices.list.retain(|notice| !notice.text.starts_with(EXPORT_MESSAGE_START));
            tell(state, export);
        }
        let (frame, failed) = self.listening.poll();
        failed.into_iter().for_each(|e| state.notices.error(e));
        chosen.extend(frame.map(|frame| DocumentCommand::ShowFrame(frame).into()));
        // The search's result replaces the scene that the search began at, but not one edited since.
        if found && self.failures.search.is_about(state.editor.scene()) {
            chosen.push(RowsCommand::TakeFinding.into());
        }
        chosen
    }

    /// Asks for the values that this frame's panels need, if they changed; `wants` has the maps and methods they read.
    pub fn ask(&mut self, state: &mut State, wants: &BTreeSet<Want>) {
        self.pipeline.ask(state, wants);
        self.lessons.ask(state);
        self.several.ask(state);
        let shown = state.arrangement.shown();
        let draws = |panel| shown.contains(&panel);
        if let Some(later) = self.failures.ask(state, draws(Panel::Failures)) {
            self.wake.request_repaint_after(later);
        }
        self.kinds.ask(KindsQuery::of(state, &self.pipeline));
        self.theory.ask(TheoryRequest::of(state));
        if let Some(later) = self.pipeline.maps.rests_in {
            self.wake.request_repaint_after(later);
        }
        if self.pipeline.is_busy() {
            self.wake.request_repaint_after(PROGRESS_FRAME_INTERVAL);
        }
        self.keep_unsaved(state);
    }

    /// Keeps copies of unsaved scenes, except during a drag.
    fn keep_unsaved(&mut self, state: &mut State) {
        let Some(autosave) = &mut self.autosave else { return };
        for problem in autosave.poll() {
            state.notices.error(format!("The scene could not be autosaved: {problem}"));
        }
        if state.editor.dragged().is_none()
            && let Some(later) = autosave.keep(&state.editor)
        {
            self.wake.request_repaint_after(later);
        }
    }

    /// Opens a file dialog; [`Jobs::poll`] returns the command of the chosen file.
    pub fn choose_file(&mut self, state: &mut State, purpose: Purpose) {
        let wake = platform::waker(&self.wake);
        let question = Question::beside(purpose, state.editor.document().likely_path().as_deref());
        if let Err(error) = self.dialogs.ask(question, wake) {
            let advice = "Drop a file on the window instead.";
            state.notices.error(format!("The file dialog could not be opened: {error}. {advice}"));
        }
    }

    /// Opens a file dropped on the window; returns its command, where it is known at once.
    pub fn open_dropped(&mut self, state: &mut State, file: &Arc<dyn DroppedFile + Send + Sync>) -> Vec<Command> {
        self.dialogs.open_dropped(file, platform::waker(&self.wake));
        self.chosen(state)
    }

    /// The commands of chosen files.
    fn chosen(&mut self, state: &mut State) -> Vec<Command> {
        let (chosen, problems, told) = self.dialogs.poll();
        told.into_iter().for_each(|t| state.notices.info(t));
        problems.into_iter().for_each(|e| state.notices.error(e));
        chosen
    }

    /// The folder of the user's own scenes: the chosen one, or `scenes` in the app's folder.
    pub fn own_scenes(&self, state: &State) -> Option<PathBuf> {
        let usual = || self.folder.as_ref().map(|folder| folder.join("scenes"));
        state.settings.own_scenes.clone().or_else(usual)
    }

    /// Whether maps, outputs, files or other values are being computed, read or written.
    pub fn is_busy(&self) -> bool {
        self.pipeline.is_busy()
            || self.kinds.is_busy()
            || self.theory.is_busy()
            || self.several.is_busy()
            || self.lessons.opened.is_busy()
            || self.failures.is_busy()
            || self.autosave.as_ref().is_some_and(|a| a.is_busy())
    }
}

/// Shows the result of work as a message.
pub fn tell(state: &mut State, said: Result<String, String>) {
    match said {
        Ok(info) => state.notices.info(info),
        Err(error) => state.notices.error(error),
    }
}
