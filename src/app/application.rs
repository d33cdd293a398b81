//! The app: input, state, jobs and panels of each frame, in the order poll, input, draw, apply, ask.

mod zoom;

use super::apply;
use super::chrome::{file_dialog, help, menu, messages, palette, save_question, status_bar, tiles};
use super::contents::{Contents, Panels};
use super::input;
use super::jobs::{Dialogs, FrameLog, Jobs};
use super::kept::{self, KeptSettings};
use super::state::{Arrangement, Command, State, ViewCommand, WindowCommand};
use super::widgets::{focus_ring, theme};
use crate::interact::Editor;
use crate::platform::{self, Instant};
use crate::reconstruct::Reconstructor;
use eframe::egui;
use std::path::PathBuf;
use std::sync::Arc;
use zoom::Zoom;

/// Name of the storage of settings and autosave.
pub const APP_ID: &str = "apertura";

/// Options with which the app starts.
#[derive(Default)]
pub struct Options {
    /// Scene or recording to open.
    pub scene: Option<PathBuf>,
    /// Name of the reconstruction to begin with; the one used last where `None`.
    pub method: Option<String>,
    /// CSV file in which the time of every frame is written.
    pub frame_log: Option<PathBuf>,
    /// Start of the program, for the frame log; now where `None`.
    pub started: Option<Instant>,
    /// Reconstruction methods; those of [`crate::methods::all`] where empty.
    pub methods: Vec<Arc<dyn Reconstructor>>,
    /// Folder for the autosave; where `None`, the system's usual one, or none in a test.
    pub data_folder: Option<PathBuf>,
    /// Whether file dialogs are the window's own even where the system has one.
    pub own_dialogs: bool,
    /// Commands for the first frame.
    pub commands: Vec<Command>,
    /// Problems from before the window opened, told as messages.
    pub problems: Vec<String>,
}

pub struct App {
    pub(super) state: State,
    pub jobs: Jobs,
    pub panels: Panels,
    palette: palette::PaletteMemory,
    file_dialog: file_dialog::FileDialogMemory,
    /// Commands asked for outside a frame.
    pub(super) asked: Vec<Command>,
    frame_log: Option<FrameLog>,
    title: String,
    zoom: Zoom,
    /// Keys that came too quickly for one frame, for the next ones.
    later: input::Later,
    /// Whether a field had the focus at the end of the last frame.
    in_a_field: bool,
    /// Whether a request to close the window was refused once, because unsaved work could not be kept.
    close_refused: bool,
}

impl App {
    /// Starts workers and opens the scene asked for, an unsaved one of an earlier run, or the default.
    ///
    /// # Errors
    /// When the frame log can't be created.
    pub fn new(creation: &eframe::CreationContext<'_>, options: Options) -> std::io::Result<Self> {
        let ctx = &creation.egui_ctx;
        let methods = if options.methods.is_empty() { crate::methods::all() } else { options.methods };
        let folder = options.data_folder.or_else(|| creation.storage.and_then(|_| platform::storage_folder(APP_ID)));
        let (kept, captions, unread) = kept::read(creation.storage, folder.as_deref());
        let began = options.started.unwrap_or_else(Instant::now);
        let frame_log = options.frame_log.map(|path| FrameLog::create(&path, began)).transpose()?;
        let mut state = State {
            settings: kept.settings,
            method_times: kept.method_times,
            arrangement: kept.arrangement,
            progress: kept.progress,
            recent: kept.recent,
            captions,
            dark: ctx.theme() == egui::Theme::Dark,
            ..State::new(methods)
        };
        let dialogs = if options.own_dialogs { Dialogs::of_the_window() } else { Dialogs::of_the_system() };
        let jobs = Jobs::start(ctx, folder.as_deref(), dialogs);
        theme::apply(ctx, state.settings.theme);
        options.method.into_iter().for_each(|method| state.settings.method = method);
        if let Some(zoom) = kept.zoom {
            ctx.set_zoom_factor(zoom);
        }
        options.problems.into_iter().chain(unread).for_each(|problem| state.notices.error(problem));
        start(&mut state, &jobs, options.scene);
        Ok(App {
            state,
            jobs,
            panels: Panels::start(platform::waker(ctx)),
            palette: palette::PaletteMemory::remembering(kept.recent_commands),
            file_dialog: Default::default(),
            asked: options.commands,
            frame_log,
            title: String::new(),
            zoom: Zoom::default(),
            later: Default::default(),
            in_a_field: false,
            close_refused: false,
        })
    }

    fn apply(&mut self, ctx: &egui::Context, commands: Vec<Command>) {
        if commands.iter().any(|c| !matches!(c, Command::View(ViewCommand::Hover(_)))) {
            ctx.request_repaint();
        }
        for command in commands {
            match command {
                Command::Window(WindowCommand::Palette) => self.palette.toggle(),
                command => apply::apply(ctx, &mut self.state, &mut self.jobs, command),
            }
        }
    }

    /// The commands of keys, dropped files and calls outside a frame.
    fn read_input(&mut self, ctx: &egui::Context) -> Vec<Command> {
        let mut commands = std::mem::take(&mut self.asked);
        let input = input::Input {
            keys_taken: self.palette.is_open()
                || self.file_dialog.is_open()
                || self.state.help.is_some()
                || self.state.save_question.is_some(),
            in_a_field: self.in_a_field,
            selected: !self.state.editor.selection().is_empty(),
            bin_metres: self.state.radar().range_resolution_metres(),
        };
        if let Some(file) = ctx.input(|i| i.raw.dropped_files.first().cloned()) {
            commands.extend(self.jobs.open_dropped(&mut self.state, &file));
        }
        commands.extend(input::read(ctx, input));
        commands
    }

    /// Refuses the first request to close the window where unsaved work can't be autosaved. The second request closes it.
    fn check_close(&mut self, ctx: &egui::Context) {
        if !ctx.input(|i| i.viewport().close_requested()) {
            return;
        }
        let editor = &self.state.editor;
        let is_unsaved = editor.is_modified() || !editor.left().is_empty();
        let kept = match &mut self.jobs.autosave {
            _ if !is_unsaved => Ok(()),
            Some(autosave) => autosave.keep_now(editor),
            None => Err("this program has no settings folder".to_owned()),
        };
        match kept {
            Err(reason) if !self.close_refused => {
                ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
                let advice = "Save it elsewhere (Ctrl+Shift+S), or close the window again to lose it.";
                self.state.notices.error(format!("The scene is unsaved and can't be autosaved: {reason}. {advice}"));
                self.close_refused = true;
            }
            _ => self.close_refused = false,
        }
    }

    fn draw(&mut self, ui: &mut egui::Ui) -> Vec<Command> {
        let (state, jobs) = (&mut self.state, &self.jobs);
        let mut commands = menu::show(ui, state);
        status_bar::show(ui, state, jobs.pipeline.maps.took);
        let background = egui::Frame::NONE.fill(ui.visuals().panel_fill);
        egui::CentralPanel::default().frame(background).show(ui, |ui| {
            let mut arrangement = std::mem::replace(&mut state.arrangement, Arrangement::empty());
            let mut panels = Contents { state, jobs, panels: &mut self.panels, commands: Vec::new() };
            commands.extend(tiles::show(ui, &mut arrangement, &mut panels));
            commands.extend(panels.commands);
            state.arrangement = arrangement;
        });
        commands.extend(palette::show(ui.ctx(), &state.methods.all, &mut self.palette));
        commands.extend(help::show(ui.ctx(), state.help));
        commands.extend(file_dialog::show(ui.ctx(), &mut self.file_dialog));
        commands.extend(save_question::show(ui.ctx(), state.save_question.as_ref()));
        commands
    }

    /// Moves the time of a playing scene or recording on; returns to time 0 after an edit.
    fn let_time_go_on(&mut self, ctx: &egui::Context) {
        let State { timeline, editor, .. } = &mut self.state;
        timeline.follow(editor.scene());
        if timeline.is_playing {
            let step = f64::from(ctx.input(|i| i.stable_dt).min(0.1));
            match editor.document().recording() {
                Some(_) => apply::next_frame(&mut self.state, step),
                None => timeline.set(editor.scene(), timeline.seconds + step),
            }
            ctx.request_repaint();
        }
    }

    fn update_title(&mut self, ctx: &egui::Context) {
        let title = self.state.title();
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    fn write_frame_log(&mut self, previous: Option<f32>) {
        let (requested, painted) = self.work_done();
        if let Some(log) = &mut self.frame_log
            && let Err(error) = log.write(previous, requested, painted)
        {
            self.frame_log = None;
            self.state.notices.error(format!("The frame log can't be written: {error}"));
        }
    }
}

/// Opens the file asked for, and the unsaved scenes of an earlier window.
fn start(state: &mut State, jobs: &Jobs, asked: Option<PathBuf>) {
    let restored = jobs.autosave.as_ref().map(|a| a.restore()).unwrap_or_default();
    for problem in &restored.problems {
        state.notices.error(format!("An unsaved scene of the last session can't be read: {problem}"));
    }
    let asked = asked.and_then(|path| apply::read(state, &path));
    match (&restored.on_screen, &asked) {
        (Some(_), None) => {
            state.notices.info("The unsaved scene of the last session is back. Save it (Ctrl+S) to keep it.");
        }
        (Some(_), Some(_)) => {
            state.notices.info("The last session left an unsaved scene: undo (Ctrl+Z) brings it back.");
        }
        (None, _) => {}
    }
    if !restored.left.is_empty() {
        state.notices.info("Unsaved scenes of earlier sessions are in File > Unsaved scenes.");
    }
    let otherwise = state.editor.document().clone();
    let is_asked = asked.is_some();
    state.editor = Editor::start(restored, asked, otherwise);
    if is_asked {
        apply::opened(state);
    }
    state.scene_view.fit = true;
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        // No tooltip of what has come under the pointer, until it moves.
        if std::mem::take(&mut self.zoom.turned) {
            input.events.insert(0, egui::Event::PointerGone);
        }
        if self.later.sort(input) {
            ctx.request_repaint();
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(log) = &mut self.frame_log {
            log.begin_frame();
        }
        let ctx = ui.ctx().clone();
        self.state.dark = ctx.theme() == egui::Theme::Dark;
        let mut commands = self.jobs.poll(&mut self.state);
        self.panels.poll().into_iter().for_each(|error| self.state.notices.error(error));
        // Before anything is drawn, so that no panel acts on an object that is gone.
        commands.extend(self.read_input(&ctx));
        self.apply(&ctx, commands);
        self.check_close(&ctx);
        if let Some(question) = self.jobs.dialogs.take_unanswered() {
            self.file_dialog.ask(question);
        }
        self.let_time_go_on(&ctx);
        apply::follow_challenge(&mut self.state);
        apply::follow_failure(&mut self.state, &self.jobs);
        let commands = self.draw(ui);
        self.apply(&ctx, commands);
        if self.state.pointer.turn(self.state.editor.radar()) {
            // Panels drawn before the one under the pointer still show the pointer's old place.
            ctx.request_repaint();
        }
        if self.state.editor.dragged().is_some() {
            self.state.note_first_drag();
        }
        let wants = self.panels.wants(&self.state);
        self.jobs.ask(&mut self.state, &wants);
        self.panels.ask(&self.state, &self.jobs);
        self.update_title(&ctx);
        self.zoom.follow(&ctx, &self.state);
        messages::show(&ctx, &mut self.state.notices);
        focus_ring::draw(&ctx);
        self.in_a_field = ctx.text_edit_focused();
        self.write_frame_log(frame.info().cpu_usage);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        let state = &mut self.state;
        let arrangement = std::mem::replace(state.kept_arrangement(), Arrangement::empty());
        let kept = KeptSettings {
            settings: state.settings.clone(),
            view: Some(state.settings.view.clone()),
            arrangement,
            recent: state.recent.clone(),
            progress: state.progress.clone(),
            captions_seen: !state.captions,
            recent_commands: self.palette.recent.clone(),
            method_times: state.method_times.clone(),
            zoom: self.zoom.before(),
        };
        kept.write(storage);
        *state.kept_arrangement() = kept.arrangement;
        if let Some(autosave) = &mut self.jobs.autosave
            && let Err(error) = autosave.keep_now(&state.editor)
        {
            tracing::warn!("the scene could not be autosaved: {error}");
        }
        if let Err(error) = self.jobs.failures.keep_now() {
            tracing::warn!("the rows could not be kept: {error}");
        }
    }
}
