use super::*;
use crate::app::widgets::seen;
use crate::evaluate::Metrics;
use crate::reconstruct::{Baseline, CAPON};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn panel(run: impl Fn() -> Run<'static> + 'static) -> Harness<'static, Vec<Command>> {
    let (settings, radar) = (Settings::default(), Radar::default());
    let methods: Vec<Arc<dyn Reconstructor>> = vec![Arc::new(Baseline), Arc::new(CAPON)];
    let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
        let input = Input {
            is_recorded: false,
            settings: &settings,
            radar: &radar,
            noise_seed: 0,
            methods: &methods,
            method: Some(&Baseline),
            eta: Baseline.eta(),
            run: run(),
        };
        asked.extend(show(ui, input));
    };
    Harness::builder().with_size([420.0, 780.0]).build_ui_state(draw, Vec::new())
}

#[test]
fn a_click_is_one_command_and_nothing_else_changes() {
    let mut controls = panel(Run::default);
    controls.run();
    assert!(controls.state().is_empty(), "nobody but the user moves anything: {:?}", controls.state());
    for label in ["hamming", "Two-way", "Exact", "found", "0.5 m", "Min–max", "60 dB", "dB", "absolute"] {
        controls.get_by_label(label).click();
        controls.run();
    }
    let asked = [
        Command::SetWindow(WindowFunction::Hamming),
        Command::SetCarrier(Carrier::TwoWay),
        Command::SetFloor(Floor::Exact),
        Command::ToggleFound,
        Command::SetSnap(Snap::Metres(0.5)),
        Command::Normalise(Normalisation::DynamicRange(Decibels(60.0))),
        Command::SetUnits(Units::Decibels),
        Command::ToggleAbsoluteDifference,
    ];
    assert_eq!(controls.state(), &asked, "and what is chosen already is not asked for");
}

#[test]
fn the_focus_passes_through_a_threshold_without_rounding_it() {
    assert_eq!((moved(0.851, 0.85), moved(0.851, 0.86)), (None, Some(0.86)));
    let settings = Settings { target_eta: 0.851, ..Settings::default() };
    let (radar, capon) = (Radar::default(), CAPON);
    let draw = |ui: &mut Ui, asked: &mut Vec<Command>| {
        let (eta, run) = (0.123, Run::default());
        let (method, noise_seed): (Option<&dyn Reconstructor>, u64) = (Some(&capon), 0);
        let (is_recorded, settings, radar) = (false, &settings, &radar);
        let input = Input { is_recorded, settings, radar, noise_seed, methods: &[], method, eta, run };
        asked.extend(show(ui, input));
    };
    let mut controls = Harness::builder().with_size([420.0, 640.0]).build_ui_state(draw, Vec::new());
    for _ in 0..30 {
        controls.key_press(eframe::egui::Key::Tab);
        controls.run();
    }
    assert!(controls.state().is_empty(), "{:?}", controls.state());
}

#[test]
fn every_choice_is_called_what_it_says() {
    let controls = panel(Run::default);
    for label in ["Min–max", "Thesis", "One-way", "hann", "Range–angle", "Λ", "grey", "reflectors", "Off"] {
        let _one = controls.get_by_label(label);
    }
}

#[test]
fn figures_stand_still_when_the_bar_comes() {
    let metrics = Metrics { squared_error: 321.4, detection: Some(0.5), false_alarm: 0.01 };
    let scores = Scores { metrics, target_blobs: 1, output_blobs: 2 };
    let output = Some(("capon", Duration::from_millis(20)));
    let height = |progress| {
        let run = move || Run { progress, output, scores: Some(scores), ..Run::default() };
        panel(run).get_by_label("P_D").rect().top()
    };
    assert_eq!(height(None), height(Some(0.25)));
}

#[test]
fn the_level_of_the_noise_can_be_chosen() {
    let mut controls = panel(Run::default);
    controls.get_by_label("dBm").click();
    controls.run();
    assert_eq!(controls.state(), &[Command::SetFloor(Floor::Level(DecibelMilliwatts(-20.0)))]);
}

#[test]
fn no_choice_leaves_a_narrow_panel() {
    let (radar, settings) = (Radar::default(), Settings::default());
    let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
        let (method, run) = (&Baseline, Run::default());
        let input = Input {
            is_recorded: false,
            settings: &settings,
            radar: &radar,
            noise_seed: 0,
            methods: &[],
            method: Some(method),
            eta: 0.5,
            run,
        };
        asked.extend(show(ui, input));
    };
    let controls = Harness::builder().with_size([284.0, 900.0]).build_ui_state(draw, Vec::new());
    for label in ["100 dB", "SNR", "dBm", "Two-way", "rectangular", "inferno", "views", "Cells"] {
        assert!(controls.get_by_label(label).rect().right() <= 284.0, "{label}");
    }
    seen::assert_readable(controls.output());
}

#[test]
fn figures_stand_beside_the_bar_that_cancels() {
    let metrics = Metrics { squared_error: 321.4, detection: Some(0.5), false_alarm: 0.01 };
    let scores = Scores { metrics, target_blobs: 1, output_blobs: 2 };
    let run = move || Run { progress: Some(0.25), scores: Some(scores), outdated: true, ..Run::default() };
    let mut controls = panel(run);
    let _told = (controls.get_by_label("321"), controls.get_by_label("1 blob in the target, 2 in the output"));
    controls.get_by_label("Cancel").click();
    controls.step();
    assert_eq!(controls.state(), &[Command::CancelMethod]);
}
