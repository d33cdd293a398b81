//! Detection at a constant false-alarm rate in the window.

use crate::session::*;
use apertura::maps::cfar::{Cfar, Statistic};

const CELLS: Cfar = Cfar { statistic: Statistic::CellAveraging, guard: [2, 2], training: [4, 6], false_alarm: 1e-3 };

fn session() -> Session {
    let mut s = Session::start();
    s.ask(WindowCommand::OpenPanel(Panel::Map(MapKind::TargetAbove)));
    s.ask(WindowCommand::OpenPanel(Panel::Map(MapKind::OutputAbove)));
    s
}

#[test]
fn cells_and_rates_on_screen_are_those_of_the_library() {
    let mut s = session();
    assert_eq!(s.state().detected(), ([None, None], None), "a detector that is off finds nothing");
    let global = s.state().metrics().unwrap();
    s.ask(ViewCommand::SetCfar(Some(CELLS)));
    let trial = s.trial();
    let answer = trial.ask(&Baseline, &Request::default()).unwrap();
    for statistic in Statistic::ALL {
        s.ask(ViewCommand::Detect(Some(statistic)));
        let cfar = Cfar { statistic, ..CELLS };
        assert_eq!(s.state().settings.cfar, Some(cfar), "the cells stay");
        let expected = trial.cfar_metrics(&answer, &cfar).unwrap();
        let shown = s.state().metrics().unwrap();
        assert_eq!((shown.detection, shown.false_alarm), (expected.detection, expected.false_alarm));
        assert_eq!(shown.squared_error, global.squared_error, "the squared error has no threshold");
        let ([target, output], error) = s.state().detected();
        assert!(target > Some(0) && output > Some(0) && error.is_none(), "{target:?} {output:?} {error:?}");
    }
    s.ask(ViewCommand::Detect(None));
    assert_eq!((s.state().metrics(), s.state().detected().0), (Some(global), [None, None]));
}

#[test]
fn a_detector_that_can_not_work_says_why() {
    let mut s = session();
    s.ask(ViewCommand::SetCfar(Some(Cfar { training: [0, 500], ..CELLS })));
    assert!(s.shows("Guard and training cells span 1005 columns"));
    s.ask(ViewCommand::SetCfar(Some(CELLS)));
    assert_eq!(s.state().detected().1, None);
}
