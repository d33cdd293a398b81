//! Figures on screen are those of the command line, bit for bit, after anything that the window showed before.

use crate::session::*;
use apertura::reconstruct::Hybrid;
use apertura::reconstruct::search::Settings;

const SCENE: &str = "noise_seed = 12\n\n[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = 3.0\ny_metres = 12.0\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = -4.0\ny_metres = 20.0\n\n\
                     [[object]]\nkind = \"line\"\nx_metres = 8.0\ny_start_metres = 8.0\nspacing_metres = 0.5\ncount = 30\n";

/// Squared error, P_D and P_FA.
type Figures = (f64, Option<f64>, f64);

fn on_screen(s: &Session) -> Figures {
    let m = s.state().metrics().expect("figures");
    (m.squared_error, m.detection, m.false_alarm)
}

fn on_the_command_line(scene: &Path) -> Figures {
    let folder = tempdir().unwrap();
    std::fs::create_dir(folder.path().join("scenes")).unwrap();
    std::fs::copy(scene, folder.path().join("scenes/scene.toml")).unwrap();
    let mut program = assert_cmd::Command::new(env!("CARGO_BIN_EXE_apertura"));
    let arguments = ["evaluate", "--scenes", "scenes", "--method", "baseline", "--rows", "rows.csv"];
    program.current_dir(&folder).args(arguments).assert().success();
    let rows = read_rows(std::fs::File::open(folder.path().join("rows.csv")).unwrap()).unwrap();
    (rows[0].squared_error, rows[0].detection, rows[0].false_alarm)
}

#[test]
fn one_scene_has_one_set_of_figures() {
    let s = Session::start();
    let file = s.path("figures.toml");
    std::fs::write(&file, SCENE).unwrap();
    let expected = on_the_command_line(&file);

    let fresh = s.reopened(Some("figures.toml"), baseline());
    assert_eq!(on_screen(&fresh), expected, "after a fresh start");

    let mut s = fresh.reopened(Some("scene.toml"), baseline());
    s.drag(s.handle("point 1: move"), vec2(30.0, 12.0), 20);
    s.ask(DocumentCommand::RandomScene(Kind::Set2));
    s.ask(DocumentCommand::OpenPath(file));
    assert_eq!(on_screen(&s), expected, "after other scenes");

    s.drag(s.handle("point 2: move"), vec2(25.0, -9.0), 20);
    let moved = s.path("moved.toml");
    let scene = s.editor().document().to_file();
    apertura::scene::file::save(&moved, &scene).unwrap();
    let expected = on_the_command_line(&moved);
    assert_eq!(on_screen(&s), expected, "after a drag");
    s.wait_for_autosave();
    let s = s.reopened(None, baseline());
    assert_eq!(**s.editor().scene(), scene.scene);
    assert_eq!(on_screen(&s), expected, "after a restore");
}

#[test]
fn the_noise_belongs_to_the_scene() {
    let mut s = Session::start();
    let before = on_screen(&s);
    s.ask(EditCommand::SetNoiseSeed(7));
    assert_ne!(on_screen(&s), before);
    s.ask(DocumentCommand::Save);
    let path = s.path("scene.toml");
    assert_eq!(Document::read(&path).unwrap().scene().noise_seed, 7);
    assert_eq!(on_screen(&s), on_the_command_line(&path));
    s.ask(EditCommand::Undo);
    assert_eq!((s.editor().scene().noise_seed, on_screen(&s)), (0, before));
}

#[test]
fn a_scene_that_comes_to_rest_is_not_reconstructed_again() {
    let method = Stub::default();
    let mut s = Session::with_methods(vec![Arc::new(method.clone())]);
    assert_eq!(method.answers.load(SeqCst), 1);
    let before = on_screen(&s);
    s.ask(EditCommand::Add(NewObject::Point, None));
    assert_eq!(method.answers.load(SeqCst), 2);
    assert_ne!(on_screen(&s), before);
    assert!(s.state().jobs.pipeline.maps.is_settled() && !s.state().jobs.pipeline.output_is_outdated());
}

/// Counts how often its method is asked from scratch, and how often with leave to follow.
struct Watched {
    method: Arc<dyn Reconstructor>,
    asked: Arc<[AtomicU32; 2]>,
}

impl Reconstructor for Watched {
    fn info(&self) -> MethodInfo {
        self.method.info()
    }
    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        self.asked[usize::from(request.may_follow)].fetch_add(1, SeqCst);
        self.method.estimate(radar, ends, request)
    }
    fn following(&self) -> Option<Arc<dyn Reconstructor>> {
        Some(Arc::new(Watched { method: self.method.following()?, asked: self.asked.clone() }))
    }
}

#[test]
fn at_rest_the_answer_is_that_from_scratch() {
    let asked = Arc::new([AtomicU32::new(0), AtomicU32::new(0)]);
    let count = |i: usize| asked[i].load(SeqCst);
    // Work enough for two points.
    let few = Settings { max_work: 1000, ..Settings::default() };
    let hybrid = Arc::new(Hybrid::new(Arc::new(Baseline)).with_settings(few));
    let mut s = Session::with_methods(vec![Arc::new(Watched { method: hybrid.clone(), asked: asked.clone() })]);
    let scratch = count(0);
    assert!(scratch > 0);
    let at = s.handle("point 1: move");
    s.hold(at);
    for i in 1..=3 {
        let followed = count(1);
        s.app.hover_at(at + vec2(6.0, 2.0) * i as f32);
        step_until(&mut s, "the drag is followed", |_| count(1) > followed);
    }
    assert_eq!(count(0), scratch, "nothing from scratch while it is held");
    s.app.drop_at(at + vec2(18.0, 6.0));
    s.settle();
    assert_eq!(count(0), scratch + 1);
    let answer = s.trial().ask(hybrid.as_ref(), &Request::default()).unwrap();
    assert_eq!(s.state().metrics(), Some(answer.metrics));
}
