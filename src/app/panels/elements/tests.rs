use super::*;
use crate::app::jobs::Calibrated;
use crate::app::state::ViewCommand;
use crate::app::widgets::seen::{Harness, Queryable, User};
use crate::radar::LayoutKind;
use crate::scene::Reflector;
use crate::signal::{Floor, calibrate, simulate_built};
use eframe::egui::{self, Key, pos2, vec2};

struct Panel {
    state: State,
    memory: ElementsMemory,
    asked: usize,
    calibrated: Option<Calibrated>,
}

impl Panel {
    fn set(&mut self, elements: BuiltArray) {
        self.state.editor.edit(None, |scene, _| scene.disturbances.elements = elements);
    }
}

fn radar() -> Radar {
    Radar { elements: 32, samples: 64, ..Radar::default() }
}

fn panel(elements: BuiltArray, calibrated: Option<Calibrated>) -> Harness<'static, Panel> {
    let draw = |ui: &mut Ui, panel: &mut Panel| {
        for command in show(ui, &panel.state, panel.calibrated.as_ref().map(Ok), &mut panel.memory) {
            match command {
                Command::Radar(RadarCommand::SetElements(elements)) => panel.set(BuiltArray::clone(&elements)),
                Command::View(ViewCommand::Hear(layout)) => panel.state.settings.layout = layout,
                other => panic!("{other:?}"),
            }
            panel.asked += 1;
        }
    };
    let state = State::of(radar(), crate::scene::Scene::default());
    let mut state = Panel { state, memory: ElementsMemory::default(), asked: 0, calibrated };
    state.set(elements);
    let mut panel = Harness::builder().with_size([640.0, 420.0]).build_ui_state(draw, state);
    panel.run();
    panel
}

#[test]
fn a_click_switches_an_element_off_or_on() {
    let mut panel = panel(BuiltArray::default(), None);
    let strip = panel.get_by_label("Elements").rect();
    let on_fifth = pos2(strip.left() + 5.5 / 32.0 * strip.width(), strip.center().y);
    for dead in [true, false] {
        panel.drags(&[on_fifth]);
        assert_eq!(panel.state().state.elements().elements[5].dead, dead);
    }
    assert_eq!(panel.state().asked, 2);
    assert!(panel.state().state.elements().is_ideal());
}

#[test]
fn a_layout_is_chosen_or_typed() {
    let mut panel = panel(BuiltArray::default(), None);
    panel.clicks(&["heard", "nested=4x6"]);
    assert_eq!(panel.state().state.settings.layout, Some(LayoutKind::Nested { neighbours: 4, apart: 6 }));
    for (text, told) in [("0-3 40", Some("the radar has elements 0 to 31")), ("0-3 30", None)] {
        panel.enters("as text", text);
        match told {
            Some(told) => assert!(panel.query_by_label_contains(told).is_some(), "{text}"),
            None => assert_eq!(panel.state().state.settings.layout, Some(LayoutKind::Listed(vec![0, 1, 2, 3, 30]))),
        }
    }
}

#[test]
fn an_element_is_moved_by_the_mouse() {
    let mut panel = panel(BuiltArray::default(), None);
    let strip = panel.get_by_label("Elements").rect();
    let from = pos2(strip.left() + 5.5 / 32.0 * strip.width(), strip.center().y);
    panel.drags(&[vec2(0.0, 0.0), vec2(10.0, -8.0), vec2(40.0, -20.0)].map(|by| from + by));
    let elements = panel.state().state.elements().clone();
    let moved = elements.element(5);
    assert!((moved.position_millimetres - 2.0).abs() < 0.1, "{moved:?}");
    assert!((moved.forward_millimetres - 1.0).abs() < 0.1 && !moved.dead, "{moved:?}");
    assert!(!elements.is_displaced(6));
}

#[test]
fn a_bent_line_can_be_drawn() {
    let mut panel = panel(BuiltArray::default(), None);
    panel.enters("ends back by", "5");
    panel.clicks(&["Bend"]);
    assert_eq!(*panel.state().state.elements(), BuiltArray::default().bent(&radar(), 5.0));
    assert!(panel.query_by_label_contains("up to 5.00 mm off the line").is_some());
}

#[test]
fn a_pasted_list_replaces_the_elements() {
    let mut panel = panel(BuiltArray::default(), None);
    panel.clicks(&["From a list"]);
    panel.get_by_label("place mm, forward mm, gain dB, phase °").focus();
    panel.run();
    panel.event(egui::Event::Paste("0.1\t-2\n".repeat(31)));
    panel.run();
    assert!(panel.query_by_label_contains("31 lines for 32 elements").is_some());
    assert!(panel.query_by_label("Use the list").is_none());
    panel.event(egui::Event::Paste("0.1\t-2".to_owned()));
    panel.run();
    panel.get_by_label("Use the list").click_accesskit();
    panel.run();
    let elements = &panel.state().state.elements().elements;
    assert!(elements.len() == 32 && elements.iter().all(|e| e.forward_millimetres == -2.0), "{elements:?}");
}

#[test]
fn arrow_keys_and_the_space_bar_silence_an_element() {
    let mut panel = panel(BuiltArray::default(), None);
    panel.get_by_label("Elements").focus();
    panel.run();
    panel.presses(&[Key::ArrowRight, Key::ArrowRight, Key::Space]);
    assert!(panel.state().state.elements().elements[2].dead && panel.state().state.elements().dead() == 1);
}

#[test]
fn errors_are_drawn_from_a_seed_and_taken_back() {
    let mut panel = panel(BuiltArray::default(), None);
    panel.clicks(&["Draw"]);
    let tolerances = ElementsMemory::default().tolerances;
    assert_eq!(*panel.state().state.elements(), tolerances.build(&radar(), 0));
    panel.clicks(&["Ideal array"]);
    assert!(panel.state().state.elements().is_ideal() && panel.query_by_label("Ideal array").is_none());
}

#[test]
fn a_calibration_takes_the_errors_away() {
    let radar = radar();
    let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 20.0, position_millimetres: 0.0 };
    let array = tolerances.build(&radar, 1);
    let scene = crate::scene::Scene::of_points([(0.0, 2.0)]);
    let reflector: Reflector = scene.reflectors()[0];
    let signal = simulate_built(&radar, &scene, &array, Floor::Exact, 0).unwrap();
    let calibration = calibrate(&radar, &signal, &reflector).unwrap();
    let left = array.corrected(&calibration.array);
    let calibrated = Calibrated { name: "point 1".to_owned(), calibration, left };
    let mut panel = panel(array, Some(calibrated));
    let _told =
        (panel.get_by_label("Calibration on point 1"), panel.get_by_label("0.0 % of the power comes from elsewhere"));
    panel.clicks(&["Calibrate on this reflector"]);
    let left = panel.state().state.elements().spread();
    assert!(left.gain.0 < 1e-6 && left.phase_degrees < 1e-4, "{left:?}");
}
