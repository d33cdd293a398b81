//! The thin part that wires panels, settings, editor and workers together.

use super::bounds::Bounds;
use super::command::Command;
use super::evaluation::Evaluation;
use super::evaluation_panel::EvaluationPanel;
use super::export::Export;
use super::files::Files;
use super::frame_log::FrameLog;
use super::front_panel::FrontPanel;
use super::guide_panel::Guide;
use super::layout::{self, Layout, Panel};
use super::messages::{self, Kind, Messages};
use super::palette::Palette;
use super::pictures::MapKind;
use super::pipeline::{LiveRequest, Pipeline};
use super::settings::Settings;
use super::training::Training;
use super::view::{Cursor, SceneView, Window};
use super::{APP_ID, execute, menu, status_bar, theme};
use crate::interact::{Document, Editor};
use crate::live::Wanted;
use crate::radar::Radar;
use crate::reconstruct::Reconstructor;
use crate::scene::presets;
use eframe::egui;
use eframe::egui::{ColorImage, TextureHandle};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// How the app is started.
#[derive(Default)]
pub struct Options {
    /// Scene to open.
    pub scene: Option<PathBuf>,
    /// CSV file for the time of every frame.
    pub frame_log: Option<PathBuf>,
    /// When the program was started, for that file; now where `None`.
    pub started: Option<Instant>,
    /// Reconstruction methods; those of [`crate::methods::all`] where empty.
    pub methods: Vec<Arc<dyn Reconstructor>>,
    /// Folder for the autosave; the system's usual one where `None`, none at all in a test.
    pub data_folder: Option<PathBuf>,
}

/// What is kept from one start to the next.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Kept {
    settings: Settings,
    layout: Layout,
    recent: Vec<PathBuf>,
}

/// Where a texture came from: the picture is sent to the graphics card only when it changed.
struct Texture {
    handle: TextureHandle,
    image: Arc<ColorImage>,
}

/// The app.
pub struct App {
    pub(super) editor: Editor,
    pub(super) radar: Radar,
    pub(super) settings: Settings,
    pub(super) layout: Layout,
    pub(super) pipeline: Pipeline,
    pub(super) bounds: Bounds,
    pub(super) evaluation: EvaluationPanel,
    pub(super) front: FrontPanel,
    pub(super) training: Training,
    pub(super) guide: Guide,
    pub(super) files: Files,
    pub(super) messages: Messages,
    /// Exports that other threads have finished.
    pub(super) exports: (Sender<Export>, Receiver<Export>),
    pub(super) palette: Palette,
    /// What panels asked for; done at the end of the frame.
    pub(super) commands: Vec<Command>,
    pub(super) scene_view: SceneView,
    /// Corner where a box selection began.
    pub(super) box_start: Option<crate::interact::Place>,
    pub(super) range_angle: Window,
    pub(super) cartesian: Window,
    /// Where the pointer was in the last frame.
    pub(super) cursor: Option<Cursor>,
    /// Where the pointer is in this frame; the panels fill it in.
    pub(super) next_cursor: Option<Cursor>,
    /// Where the pointer was last, for panels that need a place even when it is elsewhere.
    last_cursor: Option<Cursor>,
    textures: BTreeMap<MapKind, Texture>,
    frame_log: Option<FrameLog>,
    title: String,
}

impl App {
    /// Starts workers and opens the scene asked for, an unsaved one of an earlier run, or the default.
    ///
    /// # Errors
    /// When the system can't start a thread or create the frame log.
    pub fn new(creation: &eframe::CreationContext<'_>, options: Options) -> std::io::Result<Self> {
        let ctx = creation.egui_ctx.clone();
        let kept: Kept = creation.storage.and_then(|s| eframe::get_value(s, eframe::APP_KEY)).unwrap_or_default();
        let methods = if options.methods.is_empty() { crate::methods::all() } else { options.methods };
        let wake = {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        let folder = options.data_folder.or_else(|| creation.storage.and_then(|_| eframe::storage_dir(APP_ID)));
        let default = presets::default_scene();
        let began = options.started.unwrap_or_else(Instant::now);
        let frame_log = options.frame_log.map(|path| FrameLog::create(&path, began)).transpose()?;
        let mut app = App {
            editor: Editor::of(Document::shipped(default)),
            radar: Radar::default(),
            settings: kept.settings,
            layout: kept.layout,
            pipeline: Pipeline::start(methods, wake.clone())?,
            bounds: Bounds::start(wake.clone())?,
            evaluation: EvaluationPanel::new(Evaluation::start(wake.clone())?),
            front: FrontPanel::start(wake.clone())?,
            training: Training::start(wake)?,
            guide: Guide::default(),
            files: Files::new(folder.as_deref(), kept.recent)?,
            messages: Messages::default(),
            exports: channel(),
            palette: Palette::default(),
            commands: Vec::new(),
            scene_view: SceneView::default(),
            box_start: None,
            range_angle: Window::default(),
            cartesian: Window::default(),
            cursor: None,
            next_cursor: None,
            last_cursor: None,
            textures: BTreeMap::new(),
            frame_log,
            title: String::new(),
        };
        theme::apply(&ctx, app.settings.theme);
        app.start(options.scene);
        Ok(app)
    }

    /// Opens the file asked for, and what an earlier run left unsaved.
    fn start(&mut self, asked: Option<PathBuf>) {
        let restored = self.files.autosave.as_ref().map(|a| a.restore()).unwrap_or_default();
        for problem in &restored.problems {
            self.error(format!("An unsaved scene of the last session can't be read: {problem}"));
        }
        let unsaved = restored.on_screen.is_some();
        let asked = asked.and_then(|path| {
            self.files.open(&path).map_err(|e| self.error(format!("{e}\nThe scene on screen was kept."))).ok()
        });
        match (unsaved, &asked) {
            (true, None) => self.info("The unsaved scene of the last session is back. Save it (Ctrl+S) to keep it."),
            (true, Some(_)) => self.info("The last session left an unsaved scene: undo (Ctrl+Z) brings it back."),
            (false, _) => {}
        }
        let otherwise = self.editor.document().clone();
        self.editor = Editor::start(restored, asked, otherwise);
        self.follow_document();
    }

    /// Opens a scene file; on any error the scene on screen stays.
    pub(super) fn open(&mut self, path: PathBuf) {
        match self.files.open(&path) {
            Ok(document) => self.set_document("open", document),
            Err(message) => self.error(format!("{message}\nThe scene on screen was kept.")),
        }
    }

    /// Puts another document on screen; undo brings the last one back.
    pub(super) fn set_document(&mut self, label: &str, document: Document) {
        self.editor.open(label, document);
        self.follow_document();
        self.scene_view.fit = true;
    }

    /// Shows the radar of the document.
    pub(super) fn follow_document(&mut self) {
        self.radar = Radar::clone(self.editor.radar());
        self.settings.carrier = self.radar.carrier;
        self.settings.window = self.radar.window;
    }

    /// Changes the document's radar, as a step that can be undone.
    pub(super) fn edit_radar(&mut self, label: &str, change: impl FnOnce(&mut Radar)) {
        if let Err(error) = self.editor.edit_radar(label, None, change) {
            self.error(error.to_string());
        }
        self.follow_document();
    }

    /// Shows a message that passes.
    pub(super) fn info(&mut self, text: impl Into<String>) {
        self.messages.add(Kind::Info, text.into());
    }

    /// Shows a message that stays a while.
    pub(super) fn error(&mut self, text: impl Into<String>) {
        let text = text.into();
        tracing::warn!("{text}");
        self.messages.add(Kind::Error, text);
    }

    /// The method in use.
    pub(super) fn method(&self) -> Option<Arc<dyn Reconstructor>> {
        self.pipeline.method_named(&self.settings.method).cloned()
    }

    /// eta of the method in use: the user's, or the method's own.
    pub(super) fn output_eta(&self) -> f32 {
        let Some(method) = self.method() else { return crate::evaluate::TARGET_ETA };
        self.settings.method_eta.get(method.name()).copied().unwrap_or_else(|| method.eta())
    }

    /// Where cuts are taken: under the pointer, where it was last, or through the first object.
    pub(super) fn cut_cursor(&self) -> Cursor {
        let first =
            || self.editor.scene().objects.first().map(|o| Cursor::at_place(&self.radar, o.centre_metres().into()));
        let inside = |c: &Cursor| c.cell(&self.radar).is_some();
        self.last_cursor.or_else(first).filter(inside).unwrap_or_else(|| Cursor::at_cell(&self.radar, 0.0, 0.0))
    }

    /// The texture of a map's latest picture.
    pub(super) fn texture(&mut self, ctx: &egui::Context, kind: MapKind) -> Option<egui::TextureId> {
        let image = self.pipeline.result.as_ref()?.pictures.get(&kind)?.image.clone();
        let options =
            egui::TextureOptions { minification: egui::TextureFilter::Linear, ..egui::TextureOptions::NEAREST };
        match self.textures.get_mut(&kind) {
            Some(texture) => {
                if !Arc::ptr_eq(&texture.image, &image) {
                    texture.handle.set(image.clone(), options);
                    texture.image = image;
                }
            }
            None => {
                let handle = ctx.load_texture(kind.title(), image.clone(), options);
                self.textures.insert(kind, Texture { handle, image });
            }
        }
        self.textures.get(&kind).map(|t| t.handle.id())
    }

    /// Asks the workers for what the panels drawn in this frame need, if that changed.
    fn ask_for_maps(&mut self) {
        let shown = self.layout.shown();
        let map = |kind| shown.contains(&Panel::Map(kind));
        let (cuts, roc) = (shown.contains(&Panel::Cuts), shown.contains(&Panel::Roc));
        let output = MapKind::ALL.into_iter().any(|k| k.needs_output() && map(k)) || cuts || roc;
        let scores = output && !self.editor.scene().objects.is_empty();
        let wanted = Wanted {
            floor: self.settings.floor,
            seed: self.settings.seed,
            normalisation: self.settings.normalisation,
            first: map(MapKind::Input0) || cuts,
            last: map(MapKind::Input1) || cuts,
            full: map(MapKind::Target) || map(MapKind::TargetAbove) || output,
            ends: output,
        };
        let request = LiveRequest {
            radar: self.radar.clone(),
            scene: self.editor.scene().clone(),
            wanted,
            pictures: MapKind::ALL.into_iter().filter(|k| map(*k)).collect(),
            output: self.pipeline.output.as_ref().filter(|_| output).map(|o| o.lambda.clone()),
            colours: self.settings.colours,
            projection: self.settings.projection,
            target_eta: self.settings.target_eta,
            output_eta: self.output_eta(),
            scores,
            roc,
        };
        self.pipeline.ask(request);
        if output {
            self.pipeline.ask_method(&self.radar, &self.settings, wanted);
        }
    }

    fn keep_unsaved_scene(&mut self, ctx: &egui::Context) {
        let Some(autosave) = &mut self.files.autosave else { return };
        let problems = autosave.poll();
        if self.editor.dragged().is_none()
            && let Some(later) = autosave.keep(&self.editor)
        {
            ctx.request_repaint_after(later);
        }
        for problem in problems {
            self.error(format!("The scene could not be autosaved: {problem}"));
        }
    }

    fn update_title(&mut self, ctx: &egui::Context) {
        let title = format!("{} — apertura", self.editor.document().title());
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(log) = &mut self.frame_log {
            log.begin_frame();
        }
        let ctx = ui.ctx().clone();
        let mut messages = self.pipeline.poll();
        messages.extend(self.bounds.poll());
        messages.extend(self.evaluation.evaluation.poll());
        messages.extend(self.front.poll());
        messages.extend(self.training.poll());
        messages.into_iter().for_each(|m| self.error(m));
        execute::read_input(self, &ctx);
        menu::show(self, ui);
        status_bar::show(self, ui);
        let background = egui::Frame::NONE.fill(ui.visuals().panel_fill);
        egui::CentralPanel::default().frame(background).show(ui, |ui| layout::show(self, ui));
        super::palette::show(self, &ctx);
        for command in std::mem::take(&mut self.commands) {
            execute::run(self, &ctx, command);
        }
        if self.next_cursor != self.cursor {
            // Panels drawn before the one under the pointer still show the old place.
            ctx.request_repaint();
        }
        self.cursor = self.next_cursor.take();
        self.last_cursor = self.cursor.filter(|c| c.cell(&self.radar).is_some()).or(self.last_cursor);
        self.ask_for_maps();
        self.keep_unsaved_scene(&ctx);
        self.update_title(&ctx);
        messages::show(self, &ctx);
        if self.pipeline.method_progress().is_some() {
            ctx.request_repaint_after(Duration::from_millis(100));
        }
        let (requested, painted) = self.work_done();
        if let Some(log) = &mut self.frame_log
            && let Err(error) = log.write(frame.info().cpu_usage, requested, painted)
        {
            self.frame_log = None;
            self.error(format!("The frame log can't be written: {error}"));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        let layout = std::mem::take(&mut self.layout);
        let kept = Kept { settings: self.settings.clone(), layout, recent: self.files.recent.clone() };
        eframe::set_value(storage, eframe::APP_KEY, &kept);
        self.layout = kept.layout;
        if let Some(autosave) = &mut self.files.autosave
            && let Err(error) = autosave.keep_now(&self.editor)
        {
            tracing::warn!("the scene could not be autosaved: {error}");
        }
    }
}
