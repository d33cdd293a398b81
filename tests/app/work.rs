//! Long work beside the window: evaluations, measurements, training logs, methods that fail.

use crate::session::{Session, step_until};
use apertura::app::{Command, MapKind, Panel};
use apertura::radar::Radar;
use apertura::reconstruct::{About, Baseline, ReconstructError, Reconstruction, Reconstructor, Request};
use apertura::scene::generate::Kind;
use apertura::signal::TwoEnds;
use eframe::egui::{self};
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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
    fn about(&self) -> About {
        About { name: "fragile", description: "fails on demand", told: "nothing", eta: 0.5 }
    }
    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        assert!(!self.0.load(Ordering::SeqCst), "on demand");
        Baseline.estimate(radar, ends, request)
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
    s.ask(Command::RandomScene(Kind::Set1));
    assert!(s.state().pictures().contains(&MapKind::Output), "and so does the method");
}
