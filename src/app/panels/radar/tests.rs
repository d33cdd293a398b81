use super::*;
use crate::app::state::Panel;
use crate::app::state::lesson_focus::control_of;
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::lesson::shipped;
use crate::recording::Recording;
use crate::scene::Scene;
use crate::signal::BeatSignal;
use eframe::egui;

type Drawn = (State, Vec<Command>);

/// A panel whose commands are executed as in the app.
fn panel_of(size: [f32; 2], state: State) -> Harness<'static, Drawn> {
    let draw = |ui: &mut Ui, (state, all): &mut Drawn| {
        let asked = show(ui, state, None);
        for command in &asked {
            let changed = match command {
                Command::Radar(RadarCommand::Set(radar)) => Radar::clone(radar),
                Command::Radar(RadarCommand::Preset(index)) => presets::ALL[*index].radar.clone(),
                other => panic!("{other:?}"),
            };
            state.editor.edit_radar(None, |radar| *radar = changed).unwrap();
        }
        all.extend(asked);
    };
    Harness::builder().with_size(size).build_ui_state(draw, (state, Vec::new()))
}

fn panel(radar: Radar) -> Harness<'static, Drawn> {
    panel_of([640.0, 420.0], State::of(radar, Scene::default()))
}

fn measured(radar: Radar) -> Harness<'static, Drawn> {
    let signal = BeatSignal::silence(&radar);
    panel_of([640.0, 420.0], State::recorded(Recording::of_signal(radar, signal)))
}

/// Widths of the panel in a window of 1280 by 720 points: among the settings, and with the guide beside it.
const PANEL_WIDTHS_POINTS: [f32; 2] = [438.0, 342.0];

#[test]
fn every_consequence_can_be_read_in_a_small_window() {
    for width in PANEL_WIDTHS_POINTS.into_iter().chain([480.0, 600.0]) {
        let panel = panel_of([width, 900.0], State::of(Radar::default(), Scene::default()));
        seen::assert_readable(panel.output());
        let convention = "one phase cycle per wavelength of range (the thesis' convention)";
        let lengths = ["range bin 7.49 cm", "maximum range", "far field", "first grating lobe", "from side to side"];
        for label in lengths.into_iter().chain([convention]) {
            let text = panel.get_by_label_contains(label).rect();
            let lines = text.height() / panel.get_by_label("power").rect().height();
            assert!(text.right() <= width && lines < 4.5, "{label} at {width}: {text}");
        }
    }
}

#[test]
fn the_table_stays_where_it_is_when_the_preset_goes() {
    for width in PANEL_WIDTHS_POINTS.into_iter().chain([640.0]) {
        let place = |radar: Radar| {
            let panel = panel_of([width, 900.0], State::of(radar, Scene::default()));
            panel.get_by_role_and_label(egui::accesskit::Role::SpinButton, "bandwidth").rect().top()
        };
        let own = place(Radar { bandwidth_hz: 123e6, ..Radar::default() });
        for preset in presets::ALL.iter() {
            assert_eq!(place(preset.radar.clone()), own, "{} at {width}", preset.name);
        }
    }
}

#[test]
fn the_constant_that_a_challenge_needs_is_brought_into_sight() {
    let mut found = 0;
    for step in shipped::ALL.iter().filter_map(|file| file.load().unwrap().steps.last().cloned()) {
        if control_of(&step).is_none_or(|(panel, _)| panel != Panel::Radar) {
            continue;
        }
        found += 1;
        let sought = solved_by(&step).unwrap();
        for width in [280.0, 640.0] {
            let state = State::of(step.radar.clone(), Scene::default());
            let draw = |ui: &mut Ui, frames: &mut usize| {
                *frames += 1;
                show(ui, &state, Some(sought).filter(|_| *frames == 1));
            };
            let mut panel = Harness::builder().with_size([width, 160.0]).build_ui_state(draw, 0);
            panel.run();
            let is_seen = panel.query_all_by_label(sought).any(|n| n.rect().top() > 0.0 && n.rect().bottom() < 160.0);
            assert!(is_seen, "{sought} at {width}");
        }
    }
    assert!(found >= 5, "{found}");
}

#[test]
fn a_typed_constant_changes_its_consequence() {
    let mut panel = panel(Radar::default());
    let _told = panel.get_by_label("range bin 7.49 cm");
    panel.enters("bandwidth", "150");
    let _told = (panel.get_by_label("range bin 99.93 cm"), panel.get_by_label("maximum range 511.65 m"));
    assert!((panel.state().0.radar().bandwidth_hz - 150e6).abs() < 1.0);
    assert_eq!(panel.state().1.len(), 1, "one edit is one command");
    panel.enters("elements", "16");
    let radar = panel.state().0.radar();
    assert_eq!((radar.elements, radar.end_elements), (16, 8), "fewer elements take their ends along");
    panel.enters("spacing / λ", "1");
    let radar = panel.state().0.radar();
    assert!((radar.element_spacing_metres - radar.wavelength_metres()).abs() < 1e-12);
    let _told = panel.get_by_label_contains("some directions are indistinguishable");
    radar.validate().unwrap();
}

#[test]
fn a_preset_is_chosen_from_a_list() {
    let mut free = panel(Radar::default());
    free.clicks(&["Start from", "24 GHz, 256 elements"]);
    let number = presets::ALL.iter().position(|p| p.id == "24-ghz").unwrap();
    assert_eq!(free.state().1, [Command::Radar(RadarCommand::Preset(number))]);
    let _told = free.get_by_label_contains("range bins of 60 cm");
}

#[test]
fn a_measured_radar_stays_as_it_is() {
    let mut measured = measured(Radar::default());
    measured.run();
    assert!(measured.query_by_label("Start from").is_none());
    measured.clicks(&["two-way"]);
    assert!(measured.state().1.is_empty());
    // Ends and window are no part of a measurement.
    measured.enters("elements of an end", "20");
    measured.clicks(&["hamming"]);
    let radar = measured.state().0.radar();
    assert_eq!((radar.end_elements, radar.window), (20, WindowFunction::Hamming));
}

#[test]
fn a_convention_brings_its_spacing_with_it() {
    let mut panel = panel(Radar { bandwidth_hz: 1e9, ..Radar::default() });
    let _told = panel.get_by_label_contains("% nearer to broadside");
    panel.clicks(&["physical"]);
    let usual = Radar { bandwidth_hz: 1e9, ..Radar::default() };
    assert_eq!(*panel.state().0.radar(), usual.clone().in_convention(Convention::Physical));
    let _told = panel.get_by_label_contains("% farther from broadside");
    panel.get_by(|n| n.label().as_deref() == Some("convention") && n.role() != egui::accesskit::Role::Label).click();
    panel.run();
    assert_eq!(*panel.state().0.radar(), usual);
}

#[test]
fn pairs_are_chosen_with_their_counts() {
    let mut panel = panel(Radar { elements: 192, ..Radar::default() }.in_convention(Convention::Physical));
    panel.clicks(&["pairs"]);
    let radar = panel.state().0.radar().clone();
    radar.validate().unwrap();
    assert_eq!((radar.elements, radar.is_monostatic()), (192, false));
    let _told = panel.get_by_label_contains("12 × 16 pairs are 192 elements");
    panel.enters("receivers", "4");
    assert_eq!(panel.state().0.radar().elements, 48);
    panel.state().0.radar().validate().unwrap();
}

#[test]
fn a_snapshot_has_no_ranges_and_no_bandwidth() {
    let snapshot = Radar { samples: 1, elements: 86, ..Radar::default() };
    let free = panel(snapshot.clone());
    let _told =
        (free.get_by_label("one sample has no range resolution"), free.get_by_label("a snapshot: one range bin"));
    let measured = measured(snapshot);
    let _told = measured.get_by_label("not known");
    assert!(measured.query_by_label_contains("2000").is_none());
}

const BUDGET: &str = "Link budget";
const USE: &str = "Use a link budget";

fn with_budget(size: [f32; 2]) -> Harness<'static, Drawn> {
    let mut state = State::of(Radar::default(), Scene::of_points([(0.0, 10.0)]));
    state.editor.select_all();
    panel_of(size, state)
}

fn with_budget_in_use(size: [f32; 2]) -> Harness<'static, Drawn> {
    let mut panel = with_budget(size);
    panel.clicks(&[BUDGET, USE]);
    panel
}

#[test]
fn a_link_budget_tells_what_is_received() {
    let panel = with_budget_in_use([600.0, 1400.0]);
    assert_eq!(panel.state().0.radar().budget, Some(crate::radar::LinkBudget::default()));
    // 12 + 20 - 48.2 - 33.0 - 40 dBm, over -174 + 73 + 12 dBm of noise; 512 samples under a Hann window gain 25.3 dB.
    let told = "received with −89.2 dBm. SNR −0.2 dB in a sample, 25.1 dB in its range bin";
    assert!(panel.query_by_label_contains(told).is_some(), "{:?}", seen::texts(panel.output()));
    let chart = panel.get_by_label("SNR against range").rect();
    assert!(chart.width() > 200.0 && chart.height() > 80.0, "{chart:?}");
}

#[test]
fn a_link_budget_is_folded_away_and_off_at_first() {
    let mut panel = with_budget([600.0, 1400.0]);
    assert!(panel.query_by_label(USE).is_none());
    panel.clicks(&[BUDGET]);
    assert!(panel.query_by_label(USE).is_some());
    assert!(panel.query_by_label_contains("the thesis' convention. A sample's").is_some());
    panel.clicks(&[USE, USE]);
    assert_eq!(*panel.state().0.radar(), Radar::default(), "it is taken away again");
}

#[test]
fn a_link_budget_can_be_read_in_a_narrow_panel() {
    for width in [342.0, 438.0, 600.0] {
        let panel = with_budget_in_use([width, 1600.0]);
        seen::assert_readable(panel.output());
        for label in ["noise of", "MHz of noise", "there and back"] {
            assert!(panel.get_by_label_contains(label).rect().right() <= width, "{label} at {width}");
        }
    }
}
