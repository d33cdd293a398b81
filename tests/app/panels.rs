//! Panels that are shown, and the work that is done for them and for no others.

use crate::session::*;
use apertura::engine::EngineStage;
use eframe::egui::Rangef;

#[test]
fn idling_computes_nothing() {
    let mut s = Session::start();
    use MapKind::*;
    let first = [Input0, Input1, Target, Output, TargetAbove, OutputAbove];
    assert_eq!(s.state().pictures(), first, "the difference is behind another tab");
    let before = s.state().work_done();
    s.app.run_steps(40);
    assert_eq!(s.state().work_done(), before);
}

#[test]
fn an_empty_scene_has_figures_over_noise_alone() {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.press(Modifiers::NONE, Key::Delete);
    for floor in [Floor::Exact, Floor::Thesis] {
        for normalisation in [Normalisation::DynamicRange(Decibels(100.0)), Normalisation::MinMax] {
            s.ask(ViewCommand::SetFloor(floor));
            s.ask(ViewCommand::Normalise(normalisation));
            assert_eq!(s.state().metrics(), None, "{floor} {normalisation}: there is nothing to judge");
        }
    }
    s.ask(ViewCommand::SetFloor(Floor::Level(DecibelMilliwatts(-20.0))));
    let noise = s.state().metrics().unwrap();
    assert_eq!((noise.detection, noise.false_alarm), (None, 0.0), "no cell of noise alone is an echo");
}

#[test]
fn hidden_panels_are_not_computed() {
    let mut s = Session::start();
    // The tabs behind the two output maps need the output too.
    for kind in [MapKind::Input1, MapKind::Output, MapKind::OutputAbove, MapKind::Difference] {
        s.ask(WindowCommand::ClosePanel(Panel::Map(kind)));
    }
    s.ask(WindowCommand::ClosePanel(Panel::Roc));
    assert_eq!(s.state().pictures(), [MapKind::Input0, MapKind::Target, MapKind::TargetAbove]);
    s.ask(DocumentCommand::RandomScene(Kind::Set2));
    let ran = |stage| s.state().report().unwrap().ran(stage);
    assert!(ran(EngineStage::FirstMap) && ran(EngineStage::FullMap));
    assert!(!ran(EngineStage::LastMap) && !ran(EngineStage::Ends), "input 1 and every output are out of sight");
    s.ask(WindowCommand::TogglePanel(Panel::Map(MapKind::Input1)));
    assert!(s.state().pictures().contains(&MapKind::Input1));
}

#[test]
fn a_maximised_map_is_the_only_one_computed() {
    let mut s = Session::start();
    s.ask(WindowCommand::Maximise(Panel::Map(MapKind::Input0)));
    assert_eq!(s.state().pictures(), [MapKind::Input0]);
    s.ask(DocumentCommand::RandomScene(Kind::Set1));
    let ran = |stage| s.state().report().unwrap().ran(stage);
    assert!(ran(EngineStage::FirstMap) && !ran(EngineStage::FullMap) && !ran(EngineStage::LastMap));
    s.press(Modifiers::NONE, Key::Escape);
    assert_eq!(s.state().pictures().len(), 6);
}

#[test]
fn bounds_follow_the_selected_reflector() {
    let mut s = Session::start();
    let requests = |s: &Session| s.state().panels.requests(Panel::Bounds);
    assert_eq!(requests(&s), 0);
    s.ask(WindowCommand::OpenPanel(Panel::Bounds));
    let before = s.state().position_bound().expect("of the first reflector");
    s.drag(s.handle("point 2: move"), vec2(0.0, 20.0), 4);
    assert_ne!(s.state().position_bound().unwrap(), before);
    s.ask(WindowCommand::TogglePanel(Panel::Bounds));
    let asked = requests(&s);
    s.drag(s.handle("point 2: move"), vec2(0.0, 20.0), 4);
    assert_eq!(requests(&s), asked);
}

fn press_in_the_guide(s: &mut Session, name: &str) {
    while s.app.query_by_role_and_label(Role::Button, name).is_none() {
        s.app.get_by_role_and_label(Role::Button, "Next").click();
        s.settle();
    }
    s.app.get_by_role_and_label(Role::Button, name).scroll_to_me();
    s.settle();
    s.app.get_by_role_and_label(Role::Button, name).click();
    s.settle();
}

#[test]
fn undo_takes_back_everything_that_a_button_of_the_guide_did() {
    let mut s = Session::start();
    s.ask(ViewCommand::SetFloor(Floor::Snr(Decibels(30.0))));
    let (scene, radar, settings) = (s.editor().scene().clone(), s.state().radar().clone(), s.state().settings.clone());
    s.ask(WindowCommand::Maximise(Panel::Guide));
    for button in ["No window", "Hamming"] {
        press_in_the_guide(&mut s, button);
    }
    assert_eq!((s.state().radar().window, s.state().settings.floor), (WindowFunction::Hamming, Floor::Exact));
    s.undo();
    assert_eq!(s.state().radar().window, WindowFunction::Rectangular);
    s.undo();
    assert!(Arc::ptr_eq(&scene, s.editor().scene()));
    assert_eq!((s.state().radar(), &s.state().settings), (&radar, &settings));
    s.redo();
    assert_eq!((s.state().radar().window, s.state().settings.floor), (WindowFunction::Rectangular, Floor::Exact));
}

#[test]
fn random_scenes_are_those_of_the_tables() {
    let mut s = Session::start();
    s.ask(DocumentCommand::SetNextRandom { seed: 7, number: 3 });
    for number in [3, 4] {
        s.ask(DocumentCommand::RandomScene(Kind::Set3));
        let generator = Generator::new(s.state().radar(), Reading::Program, Purpose::Test, 7);
        assert_eq!(s.objects(), generator.scene(Kind::Set3, number).objects);
    }
}

#[test]
fn frames_stay_aligned_while_a_panel_is_open_below_one() {
    let mut s = Session::start();
    let names = ["Input 0 map", "Input 1 map", "Target map", "Output map"];
    let frames = |s: &Session| names.map(|name| s.app.get_by_label(name).rect().y_range());
    let near = |a: Rangef, b: Rangef| (a.min - b.min).abs() < 1.0 && (a.max - b.max).abs() < 1.0;
    let before = frames(&s);
    s.ask(WindowCommand::OpenPanel(Panel::Chirp));
    s.app.run_steps(4);
    let [input_0, input_1, target, output] = frames(&s);
    assert!(near(input_0, input_1) && near(target, output), "{:?}", frames(&s));
    assert!(input_0.span() < before[0].span(), "the panel has taken room");
    s.ask(WindowCommand::ClosePanel(Panel::Chirp));
    s.app.run_steps(4);
    assert!(frames(&s).into_iter().zip(before).all(|(now, before)| near(now, before)), "{:?}", frames(&s));
}
