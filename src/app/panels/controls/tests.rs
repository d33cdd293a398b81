use super::*;
use crate::app::state::{EditCommand, RadarCommand, Settings, View};
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::evaluate::Metrics;
use crate::interact::Snap;
use crate::maps::Normalisation;
use crate::maps::cfar::{Cfar, Statistic};
use crate::radar::{DecibelMilliwatts, Decibels, WindowFunction};
use crate::reconstruct::{Baseline, CAPON, Reconstructor};
use crate::signal::Floor;
use std::sync::Arc;

fn panel(run: impl Fn() -> Run<'static> + 'static) -> Harness<'static, Vec<Command>> {
    panel_for(Uses::ALL, run)
}

fn panel_for(uses: Uses, run: impl Fn() -> Run<'static> + 'static) -> Harness<'static, Vec<Command>> {
    panel_of([420.0, 780.0], Settings::default(), move |input| Input { run: run(), uses, ..input })
}

/// The panel of the baseline at rest, with its input changed by `change`.
fn panel_of(
    size: [f32; 2],
    settings: Settings,
    change: impl for<'a> Fn(Input<'a>) -> Input<'a> + 'static,
) -> Harness<'static, Vec<Command>> {
    let mut state = State { settings, ..State::new(vec![Arc::new(Baseline), Arc::new(CAPON)]) };
    state.settings.method = Baseline.name().to_owned();
    seen::asking(size, move |ui| {
        let input = Input { state: &state, eta: Baseline.eta(), range_db: None, run: Run::default(), uses: Uses::ALL };
        show(ui, &change(input))
    })
}

fn scored() -> Run<'static> {
    let metrics = Metrics { squared_error: 321.4, detection: Some(1.0), false_alarm: 0.0163 };
    let scores = Some(Scores { metrics, target_blobs: 1, output_blobs: 2 });
    Run { output: Some(("capon", Duration::from_millis(20))), scores, ..Run::default() }
}

#[test]
fn a_figure_is_nearer_to_its_name_than_to_the_figure_before() {
    let shown = panel(scored);
    let texts = seen::texts(shown.output());
    let rect = |text: &str| texts.iter().find(|t| t.text == text).map(|t| t.rect).unwrap();
    let apart = rect("P_FA").left() - rect("100.00 %").right();
    let beside = rect("1.63 %").left() - rect("P_FA").right();
    assert!(apart > 15.0 && apart > 2.0 * beside && beside > 2.0, "{apart} before the name, {beside} after it");
}

#[test]
fn every_method_of_the_list_says_in_a_line_what_it_is() {
    let mut controls = panel(Run::default);
    controls.run();
    controls.get_by_role_and_label(eframe::egui::accesskit::Role::ComboBox, "Method").click();
    controls.run();
    for method in [&Baseline as &dyn Reconstructor, &CAPON] {
        let name = controls.get_by_role_and_label(eframe::egui::accesskit::Role::Button, method.name()).rect();
        let line = controls.get_by_label(method.description()).rect();
        assert!(line.left() > name.left() && (line.center().y - name.center().y).abs() < 14.0, "{name:?} {line:?}");
    }
    controls.clicks(&[CAPON.description()]);
    assert_eq!(controls.state(), &[Command::View(ViewCommand::Method("capon"))]);
}

#[test]
fn thresholds_are_told_in_decibels_where_these_are_chosen() {
    let settings =
        Settings { view: View { units: Units::Decibels, target_eta: 0.9, ..View::default() }, ..Settings::default() };
    let controls = panel_of([420.0, 780.0], settings, |input| Input { eta: 0.8, range_db: Some(300.0), ..input });
    let _told = ["−60.0 dB", "−30.0 dB"].map(|text| controls.get_by_label(text));
}

#[test]
fn every_click_is_one_command() {
    let mut controls = panel(Run::default);
    controls.run();
    assert!(controls.state().is_empty(), "nobody but the user moves anything: {:?}", controls.state());
    unfold(&mut controls);
    controls.clicks(&["hamming", "Exact", "dBm", "0.5 m", "Min–max", "60 dB", "dB"]);
    let asked = [
        Command::Radar(RadarCommand::SetWindow(WindowFunction::Hamming)),
        Command::View(ViewCommand::SetFloor(Floor::Exact)),
        Command::View(ViewCommand::SetFloor(Floor::Level(DecibelMilliwatts(-20.0)))),
        Command::Edit(EditCommand::SetSnap(Snap::Metres(0.5))),
        Command::View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(60.0)))),
        Command::View(ViewCommand::SetUnits(Units::Decibels)),
    ];
    assert_eq!(controls.state(), &asked, "and what is chosen already is not asked for");
}

#[test]
fn the_focus_passes_through_a_threshold_without_rounding_it() {
    assert_eq!((moved(0.851, 0.851), moved(0.851, 0.85)), (None, Some(0.85)));
    let settings = Settings { view: View { target_eta: 0.851_234_5, ..View::default() }, ..Settings::default() };
    let mut controls = panel_of([420.0, 640.0], settings, |input| Input { eta: 0.763_194_2, ..input });
    controls.presses(&[egui::Key::Tab; 30]);
    assert!(controls.state().is_empty(), "{:?}", controls.state());
    let shown = seen::texts(controls.output());
    assert!(shown.iter().any(|t| t.text == "0.7631942"), "every digit, so that P_FA can be had again: {shown:?}");
}

fn unfold<State>(controls: &mut Harness<'_, State>) {
    controls.clicks(&["Seed of the noise"]);
}

#[test]
fn figures_stand_still_when_the_bar_comes() {
    let height = |progress| panel(move || Run { progress, ..scored() }).get_by_label("P_D").rect().top();
    assert_eq!(height(None), height(Some(0.25)));
}

#[test]
fn every_choice_is_called_what_it_says_in_a_narrow_panel() {
    let mut controls = panel_of([260.0, 1100.0], Settings::default(), |input| input);
    seen::assert_readable(controls.output());
    unfold(&mut controls);
    const LABELS: &str = "Min–max|Thesis|hann|cos θ|Λ|grey|Off|100 dB|SNR|dBm|rectangular|inferno|degrees|Cells";
    for label in LABELS.split('|') {
        assert!(controls.get_by_label(label).rect().right() <= 260.0, "{label}");
    }
    seen::assert_readable(controls.output());
}

#[test]
fn figures_stand_beside_the_bar_that_cancels() {
    let mut controls = panel(|| Run { progress: Some(0.25), outdated: true, ..scored() });
    let _told = (controls.get_by_label("321"), controls.get_by_label("1 blob in the target, 2 in the output"));
    controls.clicks(&["Cancel"]);
    assert_eq!(controls.state(), &[Command::Work(WorkCommand::CancelMethod)]);
}

#[test]
fn what_a_lesson_does_not_use_is_not_shown() {
    let shown = |uses: Uses| {
        let panel = panel_for(uses, Run::default);
        ["Reconstruction", "Method", "η", "η'", "Colours"].map(|text| panel.query_all_by_label(text).count() > 0)
    };
    assert_eq!(shown(Uses::ALL), [true; 5]);
    for (output, threshold, expected) in [
        (false, false, [false, false, false, false, true]),
        (false, true, [false, false, false, true, true]),
        (true, false, [true, true, false, false, true]),
    ] {
        assert_eq!(shown(Uses { output, threshold }), expected, "{output} {threshold}");
    }
}

fn detecting(cfar: Option<Cfar>, error: Option<&'static str>) -> Harness<'static, Vec<Command>> {
    let settings = Settings { view: View { cfar, ..View::default() }, ..Settings::default() };
    panel_of([300.0, 900.0], settings, move |input| Input {
        run: Run { detector_error: error, ..Run::default() },
        ..input
    })
}

#[test]
fn a_detector_stands_in_the_place_of_the_thresholds() {
    let mut global = detecting(None, None);
    assert!(global.query_by_label("η in numbers").is_some() && global.query_by_label("Guard cells in range").is_none());
    global.clicks(&["OS"]);
    assert_eq!(global.state(), &[ViewCommand::Detect(Some(Statistic::OrderedStatistics)).into()]);
    let detecting = detecting(Some(Cfar::default()), Some("There are no training cells."));
    assert!(detecting.query_by_label("η in numbers").is_none() && detecting.query_by_label("η' in numbers").is_none());
    for label in ["Guard cells in range", "Training cells in angle", "P_FA", "There are no training cells."] {
        assert!(detecting.query_by_label(label).is_some(), "{label}");
    }
    seen::assert_readable(detecting.output());
}
