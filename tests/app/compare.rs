//! Two methods on one scene, one flipped in the place of the other.

use crate::session::*;
use apertura::app::{Compare, Layout, MethodSlot};

#[test]
fn the_second_outputs_figures_are_those_of_the_command_line() {
    let mut s = Session::with_methods(with_capon());
    assert!(s.state().jobs.pipeline.method(MethodSlot::Second).output().is_none(), "it is out of sight");
    s.ask(WindowCommand::OpenPanel(Panel::Compare));
    for round in 0..2 {
        let answer = s.trial().ask(&CAPON, &Request { noise: Floor::Thesis.into(), ..Request::default() }).unwrap();
        let shown = &s.state().jobs.pipeline.method(MethodSlot::Second).output().expect("capon's output").pair.output;
        let apart = (&shown.lambda - &answer.found.lambda.lambda).fold(0.0, |most: f32, v| most.max(v.abs()));
        assert!(apart < 1e-5, "round {round}");
        let scores = s.state().jobs.pipeline.scores_in(MethodSlot::Second).expect("its figures");
        assert_eq!(scores.metrics, answer.metrics, "round {round}");
        assert_eq!(s.state().shown_method(), Some("baseline"), "beside the first");
        s.drag(s.handle("point 1: move"), vec2(14.0, 9.0), 5);
    }
    s.ask(ViewCommand::SetCompare(Box::new(Compare { second: "baseline".into(), ..Compare::default() })));
    let [first, second] = MethodSlot::BOTH.map(|slot| s.state().jobs.pipeline.scores_in(slot).map(|s| s.metrics));
    assert_eq!(first, second, "the same method twice");
}

#[test]
fn the_second_method_works_only_while_the_panel_is_open() {
    let second = Stub::default();
    let finished = || second.answers.load(SeqCst);
    let mut s = Session::with_methods(vec![Arc::new(Baseline), Arc::new(second.clone())]);
    s.ask(DocumentCommand::RandomScene(Kind::Set1));
    assert_eq!(finished(), 0);
    s.ask(WindowCommand::Maximise(Panel::Compare));
    assert_eq!(finished(), 1);
    assert!(!s.shows("(updating)"));

    second.milliseconds.store(900, SeqCst);
    s.app.state_mut().ask(DocumentCommand::RandomScene(Kind::Set2));
    step_until(&mut s, "the second output is told to be old", |s| {
        s.painted().iter().any(|text| text.starts_with("stub") && text.contains("(updating)"))
    });
    s.settle();
    assert!(!s.shows("(updating)"));
    let before = finished();
    s.ask(WindowCommand::Maximise(Panel::Compare));
    s.ask(DocumentCommand::RandomScene(Kind::Set1));
    assert_eq!(finished(), before, "the panel is out of sight");
}

#[test]
fn a_second_method_that_refuses_leaves_the_first() {
    let mut s =
        Session::with_methods(vec![Arc::new(Baseline), Arc::new(Stub { refuses: Some(|_| true), ..Stub::default() })]);
    s.ask(WindowCommand::Maximise(Panel::Compare));
    assert!(s.shows("made for other radars"));
    assert!(s.state().pictures().contains(&MapKind::Output) && s.state().metrics().is_some());
    assert!(!s.state().pictures().contains(&MapKind::Second));
}

#[test]
fn one_key_flips_two_maps_in_place() {
    let mut s = Session::with_methods(with_capon());
    s.press(Modifiers::NONE, Key::X);
    assert!(s.state().arrangement.is_open(Panel::Compare));
    s.ask(WindowCommand::Maximise(Panel::Compare));
    let place = |s: &Session, label: &str| s.app.query_by_label(label).map(|map| map.rect());
    let first = place(&s, "Output map").expect("the first is in front");
    assert!(s.state().pictures().contains(&MapKind::Second), "the other is ready");
    s.press(Modifiers::NONE, Key::X);
    assert_eq!((place(&s, "Output map"), place(&s, "Second output map")), (None, Some(first)));
    s.press(Modifiers::NONE, Key::X);
    assert_eq!(place(&s, "Output map"), Some(first));
    let maps = [MapKind::Target, MapKind::Input1];
    s.ask(ViewCommand::SetCompare(Box::new(Compare { maps, layout: Layout::Flip, ..Compare::default() })));
    assert_eq!(s.state().pictures(), [MapKind::Input1, MapKind::Target], "any two, and no others");
    s.press(Modifiers::NONE, Key::X);
    assert!(place(&s, "Input 1 map").is_some());
}
