//! The app in a folder of its own, with a small radar.

pub use apertura::app::{
    App, Command, DocumentCommand, EditCommand, ExportCommand, FailureChoice, LessonCommand, MapKind, NewObject,
    Options, Panel, RadarCommand, RowsCommand, ViewCommand, WindowCommand,
};
pub use apertura::evaluate::rows::read_rows;
pub use apertura::evaluate::trial::Trial;
pub use apertura::interact::{Document, Editor, Place, SelectionMode};
pub use apertura::maps::Normalisation;
pub use apertura::radar::{Carrier, Convention, DecibelMilliwatts, Decibels, LayoutKind, Radar, WindowFunction};
pub use apertura::reconstruct::{
    Baseline, CAPON, IAA, MatchedFilter, MethodInfo, ReconstructError, Reconstruction, Reconstructor, Request,
};
pub use apertura::scene::generate::{Generator, Kind, Purpose, Reading};
pub use apertura::scene::{Object, Scene};
pub use apertura::signal::{Floor, TwoEnds, simulate};
pub use eframe::egui;
pub use eframe::egui::accesskit::Role;
pub use eframe::egui::{Event, Key, Modifiers, OutputCommand, PointerButton, Pos2, Shape, pos2, vec2};
pub use egui_kittest::Harness;
pub use egui_kittest::kittest::{NodeT, Queryable};
pub use rand::RngExt;
pub use std::collections::BTreeSet;
pub use std::path::{Path, PathBuf};
pub use std::sync::Arc;
pub use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::SeqCst};
pub use std::time::{Duration, Instant};
pub use tempfile::{TempDir, tempdir};

const SCENE: &str = "[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = 0.0\ny_metres = 20.0\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = 8.0\ny_metres = 12.0\n";

pub const USUAL_SIZE: [f32; 2] = [1440.0, 900.0];

pub type Methods = Vec<Arc<dyn Reconstructor>>;

pub fn baseline() -> Methods {
    vec![Arc::new(Baseline)]
}

pub fn with_capon() -> Methods {
    vec![Arc::new(Baseline), Arc::new(CAPON)]
}

pub struct Session {
    pub app: Harness<'static, App>,
    pub folder: TempDir,
}

impl Session {
    pub fn start() -> Session {
        Session::with_methods(baseline())
    }

    pub fn with_methods(methods: Methods) -> Session {
        let folder = tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        Session::opened(folder, Some("scene.toml"), methods, USUAL_SIZE)
    }

    /// A window in a folder, on one of its files or on the autosave.
    pub fn opened(folder: TempDir, scene: Option<&str>, methods: Methods, size: [f32; 2]) -> Session {
        let mut session = Session { app: harness(folder.path(), scene, methods, size), folder };
        session.settle();
        session
    }

    pub fn state(&self) -> &App {
        self.app.state()
    }

    /// Steps until the workers are idle and their results were taken in.
    pub fn settle(&mut self) {
        let deadline = Instant::now() + Duration::from_secs(60);
        let mut quiet = 0;
        while quiet < 4 {
            assert!(Instant::now() < deadline, "the workers never came to rest");
            self.app.step();
            quiet = if self.state().is_busy() { 0 } else { quiet + 1 };
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    pub fn reopened(self, scene: Option<&str>, methods: Methods) -> Session {
        let Session { app, folder } = self;
        drop(app);
        Session::opened(folder, scene, methods, USUAL_SIZE)
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn wait_for_autosave(&mut self) {
        step_until(self, "no autosave", |s| s.path("data/autosave.toml").exists());
    }

    pub fn shows(&self, text: &str) -> bool {
        self.app.query_all_by_label_contains(text).next().is_some()
    }

    pub fn paints(&self, text: &str) -> bool {
        self.painted().iter().any(|painted| painted.contains(text))
    }

    pub fn click(&mut self, label: &str) {
        self.app.get_by_label(label).click();
        self.settle();
    }

    pub fn undo(&mut self) {
        self.press(Modifiers::COMMAND, Key::Z);
    }

    pub fn redo(&mut self) {
        self.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }

    pub fn editor(&self) -> &Editor {
        &self.state().editor
    }

    pub fn objects(&self) -> &[Object] {
        &self.editor().scene().objects
    }

    /// The scene on screen over the thesis' floor, as a command judges it.
    pub fn trial(&self) -> Trial {
        Trial::new(self.state().radar(), self.editor().scene(), Floor::Thesis, Normalisation::MinMax).unwrap()
    }

    pub fn select(&mut self, object: usize) {
        self.ask(EditCommand::Select(vec![object], SelectionMode::Replace));
    }

    pub fn hold(&mut self, at: Pos2) {
        self.app.hover_at(at);
        self.app.step();
        self.app.drag_at(at);
        self.app.step();
    }

    /// Replaces what the field called `label` holds.
    pub fn enter(&mut self, label: &str, text: &str) {
        self.app.get_by_label(label).focus();
        self.app.step();
        self.press(Modifiers::COMMAND, Key::A);
        self.app.event(Event::Text(text.to_owned()));
        self.settle();
    }

    /// Every text of the last frame with its drawable area, those without a screen reader's node included.
    pub fn texts(&self) -> Vec<(egui::Rect, egui::epaint::TextShape)> {
        fn gather(clip: egui::Rect, shape: &Shape, found: &mut Vec<(egui::Rect, egui::epaint::TextShape)>) {
            match shape {
                Shape::Vec(shapes) => shapes.iter().for_each(|shape| gather(clip, shape, found)),
                Shape::Text(text) => found.push((clip, text.clone())),
                _ => {}
            }
        }
        let mut found = Vec::new();
        self.app.output().shapes.iter().for_each(|clipped| gather(clipped.clip_rect, &clipped.shape, &mut found));
        found
    }

    pub fn painted(&self) -> Vec<String> {
        self.texts().into_iter().map(|(_, text)| text.galley.text().to_owned()).collect()
    }

    pub fn ask(&mut self, command: impl Into<Command>) {
        self.app.state_mut().ask(command);
        self.settle();
    }

    /// Sends a command that starts work beside the window, and waits for its end, which may come within the same frame.
    pub fn ask_and_wait(&mut self, command: impl Into<Command>) {
        self.app.state_mut().ask(command);
        self.app.step();
        step_until(self, "it ends", |s| !s.state().is_at_work());
        self.settle();
    }

    pub fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.app.key_press_modifiers(modifiers, key);
        self.settle();
    }

    pub fn place(&self, object: usize) -> [f64; 2] {
        self.objects()[object].centre_metres()
    }

    pub fn handle(&self, label: &str) -> Pos2 {
        self.app.get_by_label(label).rect().center()
    }

    pub fn drag(&mut self, from: Pos2, by: egui::Vec2, steps: u32) {
        self.hold(from);
        for i in 1..=steps {
            self.app.hover_at(from + by * (i as f32 / steps as f32));
            self.app.step();
        }
        self.app.drop_at(from + by);
        self.settle();
    }
}

pub fn harness(folder: &Path, scene: Option<&str>, methods: Methods, size: [f32; 2]) -> Harness<'static, App> {
    let options = Options {
        scene: scene.map(|s| folder.join(s)),
        methods,
        data_folder: Some(folder.join("data")),
        own_dialogs: true,
        ..Options::default()
    };
    let builder = Harness::builder().with_size(size).with_step_dt(1.0 / 60.0);
    builder.build_eframe(|creation| App::new(creation, options).unwrap())
}

pub fn step_until(s: &mut Session, what: &str, done: impl Fn(&Session) -> bool) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !done(s) {
        assert!(Instant::now() < deadline, "{what}");
        s.app.step();
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A method that answers as the baseline does, some milliseconds later, and panics or refuses radars as it is told.
#[derive(Clone, Default)]
pub struct Stub {
    pub milliseconds: Arc<AtomicU32>,
    pub answers: Arc<AtomicU32>,
    pub panics: Arc<AtomicBool>,
    pub refuses: Option<fn(&Radar) -> bool>,
}

impl Stub {
    pub fn slow(milliseconds: u32) -> Stub {
        Stub { milliseconds: Arc::new(milliseconds.into()), ..Stub::default() }
    }
}

impl Reconstructor for Stub {
    fn info(&self) -> MethodInfo {
        MethodInfo { name: "stub", description: "does as it is told", prior_knowledge: "", eta: 0.5 }
    }
    fn knows_pairs(&self) -> bool {
        true
    }
    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        assert!(!self.panics.load(SeqCst), "on demand");
        if self.refuses.is_some_and(|refuses| refuses(radar)) {
            return Err(ReconstructError::Unusable { method: "stub", reason: "made for other radars".into() });
        }
        let began = Instant::now();
        while began.elapsed() < Duration::from_millis(self.milliseconds.load(SeqCst).into()) {
            request.task.check()?;
            std::thread::sleep(Duration::from_millis(5));
        }
        self.answers.fetch_add(1, SeqCst);
        Baseline.estimate(radar, ends, request)
    }
}

pub fn is_used(role: Role) -> bool {
    use Role::*;
    matches!(role, Button | CheckBox | RadioButton | SpinButton | Slider | ComboBox | TextInput | Link)
}
