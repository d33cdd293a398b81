use super::*;
use crate::app::state::Panel;
use crate::app::state::lesson_focus::control_of;
use crate::app::widgets::seen;
use crate::lesson::shipped;
use eframe::egui;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// A panel whose commands are executed as in the app.
fn panel(radar: Radar, measured: Option<Measured>) -> Harness<'static, (Radar, Vec<Command>)> {
    let draw = move |ui: &mut Ui, state: &mut (Radar, Vec<Command>)| {
        let asked = show(ui, Input { radar: &state.0, measured, selected: None, sought: None });
        for command in &asked {
            match command {
                Command::Radar(RadarCommand::Set(radar)) => state.0 = (**radar).clone(),
                Command::Radar(RadarCommand::Preset(index)) => state.0 = presets::ALL[*index].radar.clone(),
                other => panic!("{other:?}"),
            }
        }
        state.1.extend(asked);
    };
    Harness::builder().with_size([640.0, 420.0]).build_ui_state(draw, (radar, Vec::new()))
}

fn type_into(panel: &mut Harness<'_, (Radar, Vec<Command>)>, label: &str, text: &str) {
    let field = panel.get_by(|n| n.label().as_deref() == Some(label) && n.role() == egui::accesskit::Role::SpinButton);
    field.focus();
    panel.run();
    panel.event(egui::Event::Text(text.to_owned()));
    panel.run();
    panel.key_press(egui::Key::Enter);
    panel.run();
}

#[test]
fn every_consequence_is_in_sight_in_a_panel_beside_the_maps() {
    let draw = |ui: &mut Ui, (): &mut ()| {
        _ = show(ui, Input { radar: &Radar::default(), measured: None, selected: None, sought: None })
    };
    let panel = Harness::builder().with_size([480.0, 700.0]).build_ui_state(draw, ());
    seen::assert_readable(panel.output());
    for label in ["range bin 7.49 cm", "one phase cycle per wavelength of range (the thesis' convention)"] {
        assert!(panel.get_by_label(label).rect().right() <= 480.0, "{label}");
    }
}

/// Widths of the panel in a window of 1280 by 720 points: among the settings, and with the guide beside it.
const PANEL_WIDTHS_POINTS: [f32; 2] = [438.0, 342.0];

#[test]
fn every_consequence_can_be_read_in_a_small_window() {
    for width in PANEL_WIDTHS_POINTS.into_iter().chain([600.0]) {
        let draw = |ui: &mut Ui, (): &mut ()| {
            _ = show(ui, Input { radar: &Radar::default(), measured: None, selected: None, sought: None })
        };
        let panel = Harness::builder().with_size([width, 900.0]).build_ui_state(draw, ());
        seen::assert_readable(panel.output());
        for label in ["range bin 7.49 cm", "maximum range", "far field", "first grating lobe", "from side to side"] {
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
            let draw = |ui: &mut Ui, radar: &mut Radar| {
                _ = show(ui, Input { radar, measured: None, selected: None, sought: None })
            };
            let panel = Harness::builder().with_size([width, 900.0]).build_ui_state(draw, radar);
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
            let draw = |ui: &mut Ui, frames: &mut usize| {
                *frames += 1;
                let sought = Some(sought).filter(|_| *frames == 1);
                show(ui, Input { radar: &step.radar, measured: None, selected: None, sought });
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
fn a_bandwidth_changes_its_consequence() {
    let mut panel = panel(Radar::default(), None);
    let _told = panel.get_by_label("range bin 7.49 cm");
    type_into(&mut panel, "bandwidth", "150");
    let _told = (panel.get_by_label("range bin 99.93 cm"), panel.get_by_label("maximum range 511.65 m"));
    assert!((panel.state().0.bandwidth_hz - 150e6).abs() < 1.0);
    assert_eq!(panel.state().1.len(), 1, "one edit is one command");
}

#[test]
fn fewer_elements_take_their_ends_along() {
    let mut panel = panel(Radar::default(), None);
    type_into(&mut panel, "elements", "16");
    assert_eq!((panel.state().0.elements, panel.state().0.end_elements), (16, 8));
}

#[test]
fn the_spacing_is_typed_in_wavelengths() {
    let mut panel = panel(Radar { elements: 16, end_elements: 8, ..Radar::default() }, None);
    type_into(&mut panel, "spacing / λ", "1");
    let spacing = panel.state().0.element_spacing_metres;
    assert!((spacing - panel.state().0.wavelength_metres()).abs() < 1e-12);
    let _told = panel.get_by_label_contains("some directions are indistinguishable");
    panel.state().0.validate().unwrap();
}

#[test]
fn the_focus_passes_through_without_a_change() {
    let odd = Radar { carrier_hz: 76.123_456_789e9, element_spacing_metres: 1.234_567e-3, ..Radar::default() };
    let mut panel = panel(odd, None);
    for _ in 0..30 {
        panel.key_press(egui::Key::Tab);
        panel.run();
    }
    assert!(panel.state().1.is_empty(), "{:?}", panel.state().1);
}

#[test]
fn a_preset_is_chosen_from_a_list() {
    let mut free = panel(Radar::default(), None);
    free.get_by_label("Start from").click();
    free.run();
    free.get_by_label("24 GHz, 256 elements").click();
    free.run();
    let number = presets::ALL.iter().position(|p| p.id == "24-ghz").unwrap();
    assert_eq!(free.state().1, [Command::Radar(RadarCommand::Preset(number))]);
    let _told = free.get_by_label_contains("range bins of 60 cm");
}

#[test]
fn a_measured_radar_stays_as_it_is() {
    let mut measured = panel(Radar::default(), Some(Measured { by_all_elements: true }));
    measured.run();
    assert!(measured.query_by_label("Start from").is_none());
    measured.get_by_label("two-way").click();
    measured.run();
    assert!(measured.state().1.is_empty());
}

#[test]
fn ends_are_no_part_of_a_measurement() {
    let mut measured = panel(Radar::default(), Some(Measured { by_all_elements: true }));
    type_into(&mut measured, "elements of an end", "20");
    assert_eq!(measured.state().0.end_elements, 20);
}

#[test]
fn the_window_is_no_part_of_a_measurement() {
    let mut measured = panel(Radar::default(), Some(Measured { by_all_elements: true }));
    measured.get_by_label("hamming").click();
    measured.run();
    assert_eq!(measured.state().0.window, WindowFunction::Hamming);
}

#[test]
fn a_convention_brings_its_spacing_with_it() {
    let mut panel = panel(Radar { bandwidth_hz: 1e9, ..Radar::default() }, None);
    let _told = panel.get_by_label_contains("% nearer to broadside");
    panel.get_by_label("physical").click();
    panel.run();
    let usual = Radar { bandwidth_hz: 1e9, ..Radar::default() };
    assert_eq!(panel.state().0, usual.clone().in_convention(Convention::Physical));
    let _told = panel.get_by_label_contains("% farther from broadside");
    panel.get_by(|n| n.label().as_deref() == Some("convention") && n.role() != egui::accesskit::Role::Label).click();
    panel.run();
    assert_eq!(panel.state().0, usual);
}

#[test]
fn pairs_are_chosen_with_their_counts() {
    let mut panel = panel(Radar { elements: 192, ..Radar::default() }.in_convention(Convention::Physical), None);
    panel.get_by_label("pairs").click();
    panel.run();
    let radar = panel.state().0.clone();
    radar.validate().unwrap();
    assert_eq!((radar.elements, radar.is_monostatic()), (192, false));
    let _told = panel.get_by_label_contains("12 × 16 pairs are 192 elements");
    type_into(&mut panel, "receivers", "4");
    assert_eq!(panel.state().0.elements, 48);
    panel.state().0.validate().unwrap();
}

fn snapshot() -> Radar {
    Radar { samples: 1, elements: 86, ..Radar::default() }
}

#[test]
fn a_snapshot_has_no_ranges() {
    let free = panel(snapshot(), None);
    let _told =
        (free.get_by_label("one sample has no range resolution"), free.get_by_label("a snapshot: one range bin"));
}

#[test]
fn a_snapshot_that_was_measured_has_no_bandwidth() {
    let measured = panel(snapshot(), Some(Measured { by_all_elements: true }));
    let _told = measured.get_by_label("not known");
    assert!(measured.query_by_label_contains("2000").is_none());
}

/// The heading of the group.
const BUDGET: &str = "Link budget";

fn with_budget(size: [f32; 2]) -> Harness<'static, Radar> {
    let draw = |ui: &mut Ui, radar: &mut Radar| {
        let selected = Some(Selected { name: "point 1".to_owned(), place_metres: [0.0, 10.0], reflectivity: 1.0 });
        for command in show(ui, Input { radar, measured: None, selected, sought: None }) {
            match command {
                Command::Radar(RadarCommand::Set(changed)) => *radar = *changed,
                other => panic!("{other:?}"),
            }
        }
    };
    Harness::builder().with_size(size).build_ui_state(draw, Radar::default())
}

fn click(panel: &mut Harness<'static, Radar>, label: &str) {
    panel.get_by_label(label).click();
    panel.run();
}

/// Label of the box that switches a link budget on or off.
const USE: &str = "Use a link budget";

#[test]
fn a_link_budget_is_folded_away_at_first() {
    let mut panel = with_budget([600.0, 1400.0]);
    assert!(panel.query_by_label(USE).is_none());
    click(&mut panel, BUDGET);
    assert!(panel.query_by_label(USE).is_some());
}

#[test]
fn the_thesis_convention_is_the_default() {
    let mut panel = with_budget([600.0, 1400.0]);
    click(&mut panel, BUDGET);
    assert!(panel.query_by_label_contains("the thesis' convention. A sample's").is_some());
}

/// The panel of a radar with a link budget.
fn with_budget_in_use(size: [f32; 2]) -> Harness<'static, Radar> {
    let mut panel = with_budget(size);
    [BUDGET, USE].into_iter().for_each(|label| click(&mut panel, label));
    panel
}

#[test]
fn a_link_budget_tells_what_is_received() {
    let panel = with_budget_in_use([600.0, 1400.0]);
    assert_eq!(panel.state().budget, Some(crate::radar::LinkBudget::default()));
    // 12 + 20 - 48.2 - 33.0 - 40 dBm, over -174 + 73 + 12 dBm of noise; 512 samples under a Hann window gain 25.3 dB.
    let told = "received with -89.2 dBm. SNR -0.2 dB in a sample, 25.1 dB in its range bin";
    assert!(panel.query_by_label_contains(told).is_some(), "{:?}", seen::texts(panel.output()));
    let chart = panel.get_by_label("SNR against range").rect();
    assert!(chart.width() > 200.0 && chart.height() > 80.0, "{chart:?}");
}

#[test]
fn a_link_budget_is_taken_away_again() {
    let mut panel = with_budget_in_use([600.0, 1400.0]);
    click(&mut panel, USE);
    assert_eq!(panel.state(), &Radar::default());
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
