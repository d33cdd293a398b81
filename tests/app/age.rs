//! The pictures on screen are of the scene on screen, or are marked as old.

use crate::session::*;
use proptest::prelude::*;

fn panels() -> Vec<Panel> {
    use MapKind::{Difference, Input0, Output, OutputAbove, Target};
    use Panel::{Bounds, Chirp, Compare, Cuts, Elements, Found, Phasors, RangeDoppler, Roc, Scene, Several, Values};
    let others = [Cuts, Bounds, Phasors, Chirp, RangeDoppler, Several, Values, Scene, Elements, Roc, Compare, Found];
    [Output, Output, OutputAbove, Target, Input0, Difference].map(Panel::Map).into_iter().chain(others).collect()
}

fn action() -> impl Strategy<Value = Command> {
    let window = prop_oneof![Just(WindowFunction::Hann), Just(WindowFunction::Hamming)];
    let floor = prop_oneof![Just(Floor::Thesis), Just(Floor::Exact)];
    prop_oneof![
        4 => (-2.0..2.0f64, -2.0..2.0f64)
            .prop_map(|(dx_metres, dy_metres)| Command::from(EditCommand::Nudge { dx_metres, dy_metres })),
        2 => Just(EditCommand::Undo.into()),
        1 => Just(EditCommand::Redo.into()),
        1 => Just(EditCommand::Delete.into()),
        1 => Just(EditCommand::Add(NewObject::Point, None).into()),
        1 => Just(EditCommand::SelectAll.into()),
        1 => window.prop_map(|window| RadarCommand::SetWindow(window).into()),
        1 => Just(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(60.0))).into()),
        1 => floor.prop_map(|floor| ViewCommand::SetFloor(floor).into()),
        6 => prop::sample::select(panels()).prop_map(|panel| WindowCommand::TogglePanel(panel).into()),
        2 => (0..3usize).prop_map(|i| ViewCommand::Method(["baseline", "capon", "stub"][i]).into()),
        1 => Just(ViewCommand::ToggleFound.into()),
        1 => Just(ViewCommand::ToggleKinds.into()),
        1 => Just(ViewCommand::ToggleTheory.into()),
    ]
}

/// Longer than an old picture may be drawn as fresh, and a few frames.
const GRACE: Duration = Duration::from_millis(600);

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, max_shrink_iters: 40, ..ProptestConfig::default() })]

    #[test]
    fn nothing_older_than_the_scene_is_drawn_as_fresh(
        actions in prop::collection::vec((action(), 0u32..4), 8..20),
    ) {
        let mut s = Session::with_methods(vec![Arc::new(Baseline), Arc::new(CAPON), Arc::new(Stub::slow(900))]);
        s.ask(EditCommand::SelectAll);
        for (action, then) in actions {
            let told = format!("after {action:?}");
            s.app.state_mut().ask(action);
            // Some actions follow at once, others after what is old must be marked, others at rest.
            match then {
                0 => s.app.step(),
                1 => s.settle(),
                _ => {
                    let began = Instant::now();
                    step_until(&mut s, "the grace passes", |_| began.elapsed() > GRACE);
                }
            }
            if then > 0 {
                let old = s.state().drawn_as_fresh_but_old();
                prop_assert!(old.is_empty(), "{old:?} {told}");
            }
        }
    }
}

#[test]
fn found_places_follow_the_scene_while_the_output_is_closed() {
    let mut s = Session::with_methods(vec![Arc::new(apertura::reconstruct::Omp::default())]);
    for panel in [MapKind::Output, MapKind::OutputAbove, MapKind::Difference].map(Panel::Map) {
        s.ask(WindowCommand::TogglePanel(panel));
    }
    s.ask(ViewCommand::ToggleFound);
    let before = s.state().marked_found().to_vec();
    assert!(!before.is_empty());
    s.ask(EditCommand::SelectAll);
    s.ask(EditCommand::Nudge { dx_metres: 3.0, dy_metres: 0.0 });
    assert_ne!(s.state().marked_found(), before);
    assert_eq!(s.state().drawn_as_fresh_but_old(), Vec::<String>::new());
}
