//! Long work beside the window: evaluations, training logs, methods that fail.

use crate::session::*;
use apertura::engine::{StageOutcome, StageReport};
use apertura::files::npz::Npz;
use ndarray::IxDyn;
use std::cell::Cell;

#[test]
fn an_evaluation_runs_beside_the_app() {
    let mut s = Session::start();
    s.ask(WindowCommand::Maximise(Panel::Evaluation));
    // The panel's tab has the same name as the button below it.
    s.app.get_all_by_label("Evaluate").last().unwrap().click();
    step_until(&mut s, "it starts", |s| s.state().is_at_work());
    step_until(&mut s, "it can be cancelled", |s| s.app.query_by_label("Cancel").is_some());
    s.app.get_by_label("Cancel").click();
    step_until(&mut s, "it ends", |s| !s.state().is_at_work());
    s.settle();
    assert!(s.shows("cancelled"));
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

#[test]
fn a_training_log_is_followed() {
    let mut s = Session::start();
    let log = s.path("log.csv");
    std::fs::write(&log, "step,loss\n1,4.25\n").unwrap();
    s.app.input_mut().dropped_files.push(Arc::new(Dropped(log.clone())));
    let shows = |text: &'static str| move |s: &Session| s.app.query_all_by_label(text).next().is_some();
    step_until(&mut s, "the last loss is shown", shows("4.2500e0"));
    std::fs::write(&log, "step,loss\n1,4.25\n2,3.5\n").unwrap();
    step_until(&mut s, "it grew", shows("3.5000e0"));
    std::fs::write(&log, "step,loss\n1,none\n").unwrap();
    step_until(&mut s, "it is told", |s| s.shows("line 2"));
}

#[test]
fn a_method_that_panics_is_a_message() {
    let method = Stub { panics: Arc::new(true.into()), ..Stub::default() };
    let mut s = Session::with_methods(vec![Arc::new(method.clone())]);
    assert_eq!(s.state().notices.list.len(), 1);
    assert!(!s.state().pictures().contains(&MapKind::Output));
    assert!(s.state().pictures().contains(&MapKind::Target), "the maps go on");
    method.panics.store(false, SeqCst);
    s.ask(DocumentCommand::RandomScene(Kind::Set1));
    assert!(s.state().pictures().contains(&MapKind::Output), "and so does the method");
}

#[test]
fn a_method_that_refuses_leaves_no_old_output() {
    let one_way = Stub { refuses: Some(|radar| radar.carrier == Carrier::TwoWay), ..Stub::default() };
    let mut s = Session::with_methods(vec![Arc::new(one_way), Arc::new(Baseline)]);
    assert!(s.state().pictures().contains(&MapKind::Output) && s.state().metrics().is_some());
    s.ask(RadarCommand::SetCarrier(Carrier::TwoWay));
    assert_eq!(s.state().shown_method(), None);
    assert!(!s.state().pictures().iter().any(|kind| kind.needs_output()), "{:?}", s.state().pictures());
    assert_eq!(s.state().metrics(), None, "no figures beside no output");
    assert!(s.app.query_all_by_label_contains("made for other radars").count() > 0, "and it says why");
    s.app.get_all_by_label("Use baseline").next().unwrap().click();
    s.settle();
    assert_eq!(s.state().shown_method(), Some("baseline"));
    assert!(s.state().pictures().contains(&MapKind::Output) && s.state().metrics().is_some());
}

#[test]
fn figures_are_of_one_pair_of_maps() {
    let mut s = Session::with_methods(vec![Arc::new(Stub::slow(1200))]);
    let before = s.state().metrics().unwrap();
    assert!(!s.state().jobs.pipeline.output_is_outdated());
    s.app.state_mut().ask(DocumentCommand::RandomScene(Kind::Set2));
    let target = s.state().report().unwrap().total;
    step_until(&mut s, "the maps are new", |s| s.state().report().unwrap().total != target);
    step_until(&mut s, "the output is told to be old", |s| s.shows("(updating)"));
    assert!(s.state().jobs.pipeline.output_is_outdated());
    assert_eq!(s.state().metrics(), Some(before), "the figures are those of the output that is shown");
    s.settle();
    assert!(!s.state().jobs.pipeline.output_is_outdated() && s.state().metrics() != Some(before));
}

#[test]
fn nothing_found_in_one_recording_is_listed_over_the_next() {
    let mut s = Session::with_methods(vec![Arc::new(Stub::slow(1200))]);
    s.ask(DocumentCommand::Recording(0));
    assert!(s.state().found().is_some_and(|found| !found.is_empty()) && !s.state().marked_found().is_empty());
    s.app.state_mut().ask(DocumentCommand::Recording(1));
    step_until(&mut s, "the next recording is on screen", |s| s.state().radar().samples == 128);
    for _ in 0..5 {
        assert_eq!((s.state().found(), s.state().marked_found().len()), (None, 0));
        assert!(s.app.query_all_by_label("Nothing is listed yet.").next().is_some());
        s.app.step();
    }
    s.settle();
    assert!(s.state().found().is_some_and(|found| !found.is_empty()));
}

#[test]
fn a_drag_lets_a_slow_method_finish_sometimes() {
    let method = Stub::slow(1200);
    let finished = || method.answers.load(SeqCst);
    let mut s = Session::with_methods(vec![Arc::new(method.clone())]);
    let at = s.handle("point 1: move");
    s.hold(at);
    let (before, began) = (finished(), Instant::now());
    while finished() < before + 2 {
        assert!(began.elapsed() < Duration::from_secs(20), "the output froze");
        s.app.hover_at(at + vec2((began.elapsed().as_secs_f32() * 5.0) % 40.0, 10.0));
        s.app.step();
        std::thread::sleep(Duration::from_millis(10));
    }
    s.app.drop_at(at);
    s.settle();
}

const CLUSTER: usize = 12_000;

#[test]
fn an_edit_does_not_wait_for_a_heavy_scene_to_come_to_rest() {
    let mut s = Session::start();
    let path = s.path("heavy.toml");
    let radar = "[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\n";
    let place = "x_metres = 0.0\ny_metres = 10.0\nx_std_metres = 2.0\ny_std_metres = 2.0\n";
    let cluster = format!("[[object]]\nkind = \"gaussian\"\n{place}count = {CLUSTER}\nseed = 1\n");
    std::fs::write(&path, radar.to_owned() + &cluster).unwrap();
    s.ask(DocumentCommand::OpenPath(path));
    let said = |s: &Session, text: &str| {
        let says = |stage: &StageReport| matches!(&stage.outcome, StageOutcome::Computed(what) if what.contains(text));
        s.state().report().unwrap().stages.iter().any(says)
    };
    // A machine may be so quick that the scene rests before the edit is seen, but not every time.
    let given_up = (1..=10).step_by(2).any(|points| {
        s.app.state_mut().ask(EditCommand::Add(NewObject::Point, None));
        step_until(&mut s, "the maps follow", |s| said(s, &format!("{} reflectors", CLUSTER + points)));
        step_until(&mut s, "the scene rests", |s| s.state().jobs.pipeline.maps.is_settling());
        s.app.state_mut().ask(EditCommand::Add(NewObject::Point, None));
        let came_to_rest = Cell::new(false);
        step_until(&mut s, "the maps follow", |s| {
            came_to_rest.set(came_to_rest.get() || said(s, "from scratch in f64"));
            said(s, &format!("{} reflectors", CLUSTER + points + 1))
        });
        !came_to_rest.get()
    });
    assert!(given_up, "maps of the scene before are computed to the end");
    s.settle();
    assert!(s.state().jobs.pipeline.maps.is_settled());
}

#[test]
fn the_window_exports_what_apertura_maps_writes() {
    exports_agree(Session::start(), &["--method", "baseline"]);
    let mut s = Session::with_methods(vec![Arc::new(MatchedFilter::Coherent)]);
    s.ask(ViewCommand::Hear(Some(LayoutKind::Thinned { step: 9 })));
    let keys = exports_agree(s, &["--method", "matched-filter", "--layout", "thinned=9"]);
    assert!(keys.contains("heard") && keys.contains("layout"), "{keys:?}");
}

fn exports_agree(mut s: Session, arguments: &[&str]) -> BTreeSet<String> {
    let [by_window, by_command] = ["window.npz", "command.npz"].map(|name| s.path(name));
    s.ask(ExportCommand::MapsTo(by_window.clone()));
    step_until(&mut s, "it is written", |_| by_window.exists());
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_apertura"));
    command.arg("maps").arg(s.path("scene.toml")).arg("-o").arg(&by_command);
    assert!(command.args(arguments).status().unwrap().success());
    let [mut window, mut command] = [by_window, by_command].map(|path| Npz::open(&path).unwrap());
    let [keys, expected] = [&window, &command].map(|archive| archive.keys().iter().cloned().collect::<BTreeSet<_>>());
    assert_eq!(keys, expected);
    for key in &keys {
        match window.reals::<IxDyn>(key) {
            Ok(array) => assert_eq!(array, command.reals::<IxDyn>(key).unwrap(), "{key}"),
            Err(_) => {
                let array = window.complexes::<IxDyn>(key).unwrap();
                assert_eq!(array, command.complexes::<IxDyn>(key).unwrap(), "{key}");
            }
        }
    }
    assert!(keys.contains("cos_theta") && keys.contains("output"));
    keys
}
