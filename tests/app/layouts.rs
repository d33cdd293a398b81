//! Other elements than those of the two ends are heard.

use crate::session::*;
use apertura::evaluate::Target;

fn session() -> Session {
    let mut s = Session::with_methods(vec![Arc::new(Baseline), Arc::new(MatchedFilter::Coherent), Arc::new(IAA)]);
    s.ask(ViewCommand::Method("baseline"));
    s
}

fn nested() -> LayoutKind {
    LayoutKind::Nested { neighbours: 10, apart: 10 }
}

#[test]
fn methods_hear_the_layout_that_was_chosen() {
    let mut s = session();
    let before = s.state().shared_text();
    s.ask(ViewCommand::Hear(Some(nested())));
    assert_eq!((s.state().shown_method(), s.state().notices.list.len()), (Some("iaa"), 1));
    let pictures = s.state().pictures();
    assert!(pictures.contains(&MapKind::Input0) && !pictures.contains(&MapKind::Input1), "{pictures:?}");
    let (radar, scene, view) = (s.state().radar(), s.editor().scene(), &s.state().settings.view);
    let layout = nested().numbers(radar).unwrap();
    let (floor, normalisation) = (view.floor, view.normalisation);
    let trial = Trial::against(Target::Measured, Some(&layout), radar, scene, floor, normalisation).unwrap();
    let request = Request { noise: floor.into(), normalisation, ..Request::default() };
    let expected = trial.ask(&IAA, &request).unwrap().metrics.squared_error;
    assert_eq!(s.state().metrics().unwrap().squared_error, expected, "as a command finds it");
    s.ask(ViewCommand::Method("baseline"));
    assert_eq!(s.state().shown_method(), Some("iaa"), "baseline can't hear it");
    s.ask(ViewCommand::NextMethod);
    assert_eq!(s.state().shown_method(), Some("matched-filter"), "baseline is passed over");
    s.ask(ViewCommand::Hear(None));
    assert!(s.state().pictures().contains(&MapKind::Input1));
    s.ask(ViewCommand::Method("baseline"));
    assert_eq!(s.state().shared_text(), before, "a text says no layout where none was chosen");
}

#[test]
fn a_layout_that_the_radar_has_not_is_let_go() {
    let mut s = session();
    s.ask(ViewCommand::Hear(Some(nested())));
    let told = s.state().notices.list.len();
    s.ask(RadarCommand::Set(Box::new(Radar { elements: 64, end_elements: 6, ..s.state().radar().clone() })));
    assert_eq!((&s.state().settings.view.layout, s.state().notices.list.len()), (&None, told + 1));
    assert!(s.state().pictures().contains(&MapKind::Input1) && s.state().refusal().is_none());
}
