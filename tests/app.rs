//! Drives the whole app without a display: pointer, keys, files; asserts on state and on what was computed and what was not.
#![cfg(feature = "app")]

use apertura::app::{App, Command, MapKind, NewObject, Options, Panel};
use apertura::live::Stage;
use apertura::maps::Normalisation;
use apertura::radar::{Carrier, Decibels, Radar, WindowFunction};
use apertura::reconstruct::{Baseline, ReconstructError, Reconstruction, Reconstructor, Request};
use apertura::scene::Object;
use apertura::signal::{Floor, TwoEnds};
use eframe::egui::{self, Event, Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A radar small enough that its maps take a moment only, and two points.
const SCENE: &str = "[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = 0.0\ny_metres = 20.0\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = 8.0\ny_metres = 12.0\n";

struct Session {
    app: Harness<'static, App>,
    folder: TempDir,
}

impl Session {
    fn start() -> Session {
        Session::with_methods(vec![Arc::new(Baseline)])
    }

    fn with_methods(methods: Vec<Arc<dyn Reconstructor>>) -> Session {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        let app = harness(folder.path(), Some("scene.toml"), methods);
        let mut session = Session { app, folder };
        session.settle();
        session
    }

    fn state(&self) -> &App {
        self.app.state()
    }

    /// Steps until the workers have nothing to do and what they made has been taken in.
    fn settle(&mut self) {
        let deadline = Instant::now() + Duration::from_secs(60);
        let mut quiet = 0;
        while quiet < 4 {
            assert!(Instant::now() < deadline, "the workers never came to rest");
            self.app.step();
            quiet = if self.state().is_busy() { 0 } else { quiet + 1 };
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn ask(&mut self, command: Command) {
        self.app.state_mut().ask(command);
        self.settle();
    }

    fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.app.key_press_modifiers(modifiers, key);
        self.settle();
    }

    fn place(&self, object: usize) -> [f64; 2] {
        self.state().editor().scene().objects[object].centre_metres()
    }

    fn handle(&self, label: &str) -> Pos2 {
        self.app.get_by_label(label).rect().center()
    }

    fn drag(&mut self, from: Pos2, by: egui::Vec2, steps: u32) {
        self.app.hover_at(from);
        self.app.step();
        self.app.drag_at(from);
        self.app.step();
        for i in 1..=steps {
            self.app.hover_at(from + by * (i as f32 / steps as f32));
            self.app.step();
        }
        self.app.drop_at(from + by);
        self.settle();
    }
}

fn harness(folder: &Path, scene: Option<&str>, methods: Vec<Arc<dyn Reconstructor>>) -> Harness<'static, App> {
    let options = Options {
        scene: scene.map(|s| folder.join(s)),
        methods,
        data_folder: Some(folder.join("data")),
        ..Options::default()
    };
    Harness::builder()
        .with_size([1440.0, 900.0])
        .with_step_dt(1.0 / 60.0)
        .build_eframe(|creation| App::new(creation, options).unwrap())
}

#[test]
fn all_maps_are_there_soon_after_the_start_and_idling_computes_nothing() {
    let mut s = Session::start();
    use MapKind::*;
    let first = [Input0, Input1, Target, Output, TargetAbove, OutputAbove];
    assert_eq!(s.state().pictures(), first, "the difference is behind another tab");
    let before = s.state().work_done();
    s.app.run_steps(40);
    assert_eq!(s.state().work_done(), before);
}

#[test]
fn a_drag_moves_one_object_from_its_first_pixel_and_undo_brings_it_back() {
    let mut s = Session::start();
    let (requests, painted) = s.state().work_done();
    let (a, b) = (s.handle("point 1: move"), s.handle("point 2: move"));
    let metres_per_point = 8.0 / f64::from((b - a).x);
    s.drag(a, vec2(30.0, 12.0), 60);
    let [x, y] = s.place(0);
    assert!((x - 30.0 * metres_per_point).abs() < 0.02, "{x}: no pixel is lost");
    assert!((y - 20.0 + 12.0 * metres_per_point).abs() < 0.02, "{y}");
    assert_eq!(s.place(1), [8.0, 12.0]);
    let (requests_after, painted_after) = s.state().work_done();
    assert!(requests_after > requests + 5 && painted_after >= painted + 6, "every map followed");
    let depth = s.state().editor().history().depth();
    s.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(s.place(0), [0.0, 20.0], "a drag is one step");
    assert_eq!(s.state().editor().history().depth(), depth - 1);
    s.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!((s.place(0)[0] - x).abs() < 1e-12);
}

#[test]
fn boxes_select_and_keys_nudge_duplicate_and_delete() {
    let mut s = Session::start();
    let (a, b) = (s.handle("point 1: move"), s.handle("point 2: move"));
    let corner = a.min(b) - vec2(25.0, 25.0);
    let far = a.max(b) + vec2(25.0, 25.0);
    s.drag(corner, far - corner, 8);
    assert_eq!(s.state().editor().selection().len(), 2);
    s.press(Modifiers::NONE, Key::ArrowRight);
    assert!(s.place(0)[0] > 0.0 && s.place(1)[0] > 8.0);
    s.press(Modifiers::COMMAND, Key::D);
    assert_eq!(s.state().editor().scene().objects.len(), 4);
    s.press(Modifiers::NONE, Key::Delete);
    assert_eq!(s.state().editor().scene().objects.len(), 2);
}

#[test]
fn objects_travel_through_the_clipboard_as_toml() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.app.event(Event::Cut);
    s.settle();
    assert!(s.state().editor().scene().objects.is_empty());
    s.press(Modifiers::COMMAND, Key::Z);
    let text = s.state().editor().copy().unwrap();
    assert!(text.contains("[[object]]") && text.contains("kind = \"point\""));
    s.app.event(Event::Paste(text));
    s.settle();
    assert_eq!(s.state().editor().scene().objects.len(), 4);
    s.app.event(Event::Paste("not a scene".to_owned()));
    s.settle();
    assert_eq!(s.state().editor().scene().objects.len(), 4);
    assert_eq!(s.state().messages(), 1, "and says why");
}

#[test]
fn a_bad_file_is_told_and_nothing_is_lost() {
    let mut s = Session::start();
    let scene = s.state().editor().scene().clone();
    for (name, text) in [
        ("broken.toml", "[[object]]\nkind = \"ghost\"\n"),
        ("nan.toml", "[[object]]\nkind = \"point\"\nx_metres = nan\ny_metres = 1.0\n"),
        ("not.npz", "PK?"),
    ] {
        let path = s.folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let before = s.state().messages();
        s.ask(Command::OpenPath(path));
        assert!(Arc::ptr_eq(&scene, s.state().editor().scene()), "{name}");
        assert_eq!(s.state().messages(), before + 1, "{name}");
    }
    s.ask(Command::OpenPath(s.folder.path().join("missing.toml")));
    assert!(Arc::ptr_eq(&scene, s.state().editor().scene()));
}

#[test]
fn another_normalisation_computes_no_signal_and_no_map() {
    let mut s = Session::start();
    for normalisation in [
        Normalisation::DynamicRange(Decibels(60.0)),
        Normalisation::DynamicRange(Decibels(100.0)),
        Normalisation::MinMax,
    ] {
        let (_, painted) = s.state().work_done();
        s.ask(Command::Normalise(normalisation));
        assert_eq!(s.state().settings().normalisation, normalisation);
        assert!(s.state().work_done().1 >= painted + 6, "every map was painted again");
        let report = s.state().report().unwrap();
        for stage in [Stage::Signal, Stage::FirstMap, Stage::LastMap, Stage::FullMap] {
            assert!(!report.ran(stage), "{stage}");
        }
    }
    s.ask(Command::SetFloor(Floor::Exact));
    assert_eq!(s.state().settings().floor, Floor::Exact);
}

#[test]
fn hidden_panels_are_not_computed() {
    let mut s = Session::start();
    // The tabs behind the two output maps need the output too.
    for kind in [MapKind::Input1, MapKind::Output, MapKind::OutputAbove, MapKind::Difference] {
        s.ask(Command::ClosePanel(Panel::Map(kind)));
    }
    s.ask(Command::ClosePanel(Panel::Roc));
    assert_eq!(s.state().pictures(), [MapKind::Input0, MapKind::Target, MapKind::TargetAbove]);
    s.ask(Command::RandomScene(2));
    let report = s.state().report().unwrap();
    assert!(report.ran(Stage::FirstMap) && report.ran(Stage::FullMap));
    assert!(!report.ran(Stage::LastMap) && !report.ran(Stage::Ends), "nobody looks at input 1 or an output");
    s.ask(Command::TogglePanel(Panel::Map(MapKind::Input1)));
    assert!(s.state().pictures().contains(&MapKind::Input1));
}

#[test]
fn a_maximised_map_is_the_only_one_computed() {
    let mut s = Session::start();
    s.ask(Command::Maximise(Panel::Map(MapKind::Input0)));
    assert_eq!(s.state().pictures(), [MapKind::Input0]);
    s.ask(Command::RandomScene(1));
    let report = s.state().report().unwrap();
    assert!(report.ran(Stage::FirstMap) && !report.ran(Stage::FullMap) && !report.ran(Stage::LastMap));
    s.press(Modifiers::NONE, Key::Escape);
    assert_eq!(s.state().pictures().len(), 6);
}

#[test]
fn the_palette_runs_a_command_by_name() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::K);
    s.app.event(Event::Text("add line".to_owned()));
    s.settle();
    s.press(Modifiers::NONE, Key::Enter);
    let objects = &s.state().editor().scene().objects;
    assert!(matches!(objects.last(), Some(Object::Line(_))), "{objects:?}");
    let _shown = s.handle("line 3: move the near end: more or fewer reflectors");
}

#[test]
fn a_double_click_adds_a_point_where_it_was() {
    let mut s = Session::start();
    let at = s.handle("point 1: move") + vec2(-60.0, 0.0);
    for _ in 0..2 {
        s.app.hover_at(at);
        s.app.drag_at(at);
        s.app.drop_at(at);
        s.app.step();
    }
    s.settle();
    assert_eq!(s.state().editor().scene().objects.len(), 3);
    assert!(s.place(2)[0] < 0.0 && (s.place(2)[1] - 20.0).abs() < 0.2);
}

#[test]
fn an_unsaved_scene_comes_back_after_a_crash() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.press(Modifiers::NONE, Key::ArrowUp);
    let scene = s.state().editor().scene().clone();
    let autosave = s.folder.path().join("data/autosave.toml");
    let deadline = Instant::now() + Duration::from_secs(10);
    while !autosave.exists() {
        assert!(Instant::now() < deadline, "no autosave");
        std::thread::sleep(Duration::from_millis(20));
        s.app.step();
    }
    let Session { app, folder } = s;
    drop(app);
    let app = harness(folder.path(), None, vec![Arc::new(Baseline)]);
    assert_eq!(app.state().editor().scene().objects, scene.objects);
    assert!(app.state().editor().is_modified());
}

#[test]
fn two_windows_keep_apart_and_a_killed_one_leaves_its_scene_to_the_next() {
    let mut first = Session::start();
    first.press(Modifiers::COMMAND, Key::A);
    first.press(Modifiers::NONE, Key::Delete);
    let copies = |folder: &Path| -> Vec<_> {
        let files = std::fs::read_dir(folder.join("data")).unwrap().map(|f| f.unwrap().file_name());
        let mut copies: Vec<_> = files.filter(|n| n.to_string_lossy().ends_with(".toml")).collect();
        copies.sort();
        copies
    };
    let Session { app: first, folder } = first;
    assert_eq!(copies(folder.path()), ["autosave.toml"]);
    let mut second = harness(folder.path(), None, vec![Arc::new(Baseline)]);
    assert!(!second.state().editor().scene().objects.is_empty(), "what an open window holds is not restored");
    second.state_mut().ask(Command::Add(NewObject::Point, None));
    second.run_steps(2);
    assert_eq!(copies(folder.path()), ["autosave-2.toml", "autosave.toml"]);
    // Dropped without being closed, as a kill would.
    drop(first);
    let third = harness(folder.path(), None, vec![Arc::new(Baseline)]);
    assert!(third.state().editor().scene().objects.is_empty() && third.state().editor().is_modified());
}

#[test]
fn messages_can_be_closed() {
    let mut s = Session::start();
    s.ask(Command::OpenPath(s.folder.path().join("missing.toml")));
    assert_eq!(s.state().messages(), 1);
    s.app.get_by_label("Close this message").click();
    s.settle();
    assert_eq!(s.state().messages(), 0);
}

#[test]
fn the_window_reaches_the_maps_and_comes_back() {
    let mut s = Session::start();
    let (requests, painted) = s.state().work_done();
    s.app.get_by_label("hamming").scroll_to_me();
    s.settle();
    s.app.get_by_label("hamming").click();
    s.settle();
    assert_eq!(s.state().settings().window, WindowFunction::Hamming);
    let after = s.state().work_done();
    assert!(after.0 > requests && after.1 >= painted + 6, "every map was made again");
    s.ask(Command::SetWindow(WindowFunction::Hann));
    assert_eq!(s.state().settings().window, WindowFunction::Hann);
}

#[test]
fn bounds_follow_the_selected_reflector_and_are_only_computed_while_visible() {
    let mut s = Session::start();
    assert_eq!(s.state().bounds_asked(), 0);
    s.ask(Command::OpenPanel(Panel::Bounds));
    let before = s.state().position_bound().expect("of the first reflector");
    let at = s.handle("point 2: move");
    s.drag(at, vec2(0.0, 20.0), 4);
    let after = s.state().position_bound().unwrap();
    assert_ne!(before, after);
    s.ask(Command::TogglePanel(Panel::Bounds));
    let asked = s.state().bounds_asked();
    let at = s.handle("point 2: move");
    s.drag(at, vec2(0.0, 20.0), 4);
    assert_eq!(s.state().bounds_asked(), asked);
}

#[test]
fn every_button_of_the_guide_leaves_a_working_app() {
    let mut s = Session::start();
    s.ask(Command::Maximise(Panel::Guide));
    s.app.get_by_label("Two-way").scroll_to_me();
    s.settle();
    s.app.get_by_label("Two-way").click();
    s.settle();
    assert_eq!(s.state().settings().carrier, Carrier::TwoWay);
    assert_eq!(s.state().editor().scene().name, "Four reflectors");
    assert_eq!(s.state().messages(), 0);
}

/// Steps until `done`, without waiting for everything to rest.
fn step_until(s: &mut Session, what: &str, done: impl Fn(&Session) -> bool) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !done(s) {
        assert!(Instant::now() < deadline, "{what}");
        s.app.step();
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn an_evaluation_runs_beside_the_app_and_can_be_cancelled() {
    let mut s = Session::start();
    s.ask(Command::Maximise(Panel::Evaluation));
    s.app.get_by_label("Evaluate").click();
    step_until(&mut s, "it starts", |s| s.state().is_at_work());
    step_until(&mut s, "it can be cancelled", |s| s.app.query_by_label("Cancel").is_some());
    s.app.get_by_label("Cancel").click();
    step_until(&mut s, "it ends", |s| !s.state().is_at_work());
    s.settle();
    assert!(s.state().evaluation_csv().starts_with("set,method,"));
    assert!(s.app.query_by_label_contains("cancelled").is_some());
}

#[test]
fn run_times_arrive_while_they_are_measured() {
    let mut s = Session::start();
    s.ask(Command::Maximise(Panel::Front));
    s.app.get_by_label("Measure").click();
    step_until(&mut s, "a row arrives", |s| s.state().front_rows() > 0);
    s.app.step();
    s.app.get_by_label("Cancel").click();
    step_until(&mut s, "it ends", |s| !s.state().is_at_work());
    assert!(s.state().front_rows() > 0, "what was measured stays");
}

/// A file dropped on the window.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

#[test]
fn a_training_log_is_followed_and_a_broken_one_is_told() {
    let mut s = Session::start();
    let log = s.folder.path().join("log.csv");
    std::fs::write(&log, "step,loss\n1,4.25\n").unwrap();
    s.app.input_mut().dropped_files.push(Arc::new(Dropped(log.clone())));
    let shows = |text: &'static str| move |s: &Session| s.app.query_all_by_label(text).next().is_some();
    step_until(&mut s, "the last loss is shown", shows("4.2500e0"));
    std::fs::write(&log, "step,loss\n1,4.25\n2,3.5\n").unwrap();
    step_until(&mut s, "it grew", shows("3.5000e0"));
    std::fs::write(&log, "step,loss\n1,none\n").unwrap();
    step_until(&mut s, "it is told", |s| s.app.query_by_label_contains("line 2").is_some());
}

/// Panics until told not to.
struct Fragile(Arc<AtomicBool>);

impl Reconstructor for Fragile {
    fn name(&self) -> &'static str {
        "fragile"
    }
    fn description(&self) -> &'static str {
        "fails on demand"
    }
    fn eta(&self) -> f32 {
        0.5
    }
    fn reconstruct(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        assert!(!self.0.load(Ordering::SeqCst), "on demand");
        Baseline.reconstruct(radar, ends, request)
    }
}

#[test]
fn a_method_that_panics_is_a_message_and_the_app_goes_on() {
    let fails = Arc::new(AtomicBool::new(true));
    let mut s = Session::with_methods(vec![Arc::new(Fragile(fails.clone()))]);
    assert_eq!(s.state().messages(), 1);
    assert!(!s.state().pictures().contains(&MapKind::Output));
    assert!(s.state().pictures().contains(&MapKind::Target), "the maps go on");
    fails.store(false, Ordering::SeqCst);
    s.ask(Command::RandomScene(1));
    assert!(s.state().pictures().contains(&MapKind::Output), "and so does the method");
}
