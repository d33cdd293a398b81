use super::*;
use crate::app::widgets::seen::{Harness, Queryable, User};
use eframe::egui::{Event, Modifiers};

/// A field for x, a field for a count, and the number of changes of x.
struct Shown {
    x_metres: f64,
    count: u32,
    changes: usize,
}

fn panel() -> Harness<'static, Shown> {
    let draw = |ui: &mut Ui, shown: &mut Shown| {
        let label = ui.label("x");
        let field = NumberField::new(&mut shown.x_metres).range(-1e4..=1e4).suffix(" m").max_decimals(3);
        shown.changes += usize::from(ui.add(field).labelled_by(label.id).changed());
        let label = ui.label("count");
        ui.add(NumberField::new(&mut shown.count).range(1..=9)).labelled_by(label.id);
    };
    let shown = Shown { x_metres: 1.0 / 3.0, count: 5, changes: 0 };
    let mut panel = Harness::builder().with_size([420.0, 200.0]).build_ui_state(draw, shown);
    panel.run();
    panel
}

fn field<'h>(panel: &'h Harness<'_, Shown>, name: &'h str) -> egui_kittest::Node<'h> {
    let is_field = |role| role == egui::accesskit::Role::SpinButton;
    panel.get_by(move |n| n.label().as_deref() == Some(name) && is_field(n.role()))
}

fn says(panel: &Harness<'_, Shown>, what: &str) -> bool {
    panel.query_by_label_contains(what).is_some()
}

#[test]
fn a_number_is_read_in_another_unit_of_its_quantity() {
    let of = |unit: &str, text: &str| Wanted { unit: unit.to_owned(), ..Wanted::any() }.read(text);
    for (unit, text, expected) in [
        ("m", "7.5 cm", 0.075),
        ("m", "75mm", 0.075),
        ("m", "0,075", 0.075),
        (" GHz", "200 MHz", 0.2),
        ("m/s", "36 km/h", 10.0),
        (" ms", "2 ms", 2.0),
        (" mm", "2 cm", 20.0),
    ] {
        let read = of(unit, text).unwrap();
        assert!((read - expected).abs() < 1e-9, "{text} in {unit}: {read}");
    }
    assert!(of("m", "7.5 dB").is_err() && of("dB", "7.5 cm").is_err());
}

#[test]
fn a_decimal_comma_is_read() {
    let metres = Wanted { range: -1e4..=1e4, is_whole: false, unit: " m".to_owned() };
    for (text, value) in [("-3,5", -3.5), ("-3.5", -3.5), ("−3.5 m", -3.5), (" 1 000 ", 1000.0), ("+2e3", 2000.0)] {
        assert_eq!(metres.read(text), Ok(value), "{text}");
    }
}

#[test]
fn a_wrong_entry_is_told_by_its_reason() {
    let metres = Wanted { range: -1e4..=1e4, is_whole: false, unit: " m".to_owned() };
    for (text, reason) in [
        ("nan", "“nan” is not a number"),
        ("inf", "is not a number"),
        ("abc", "“abc” is not a number"),
        ("1.234,5", "is not a number"),
        ("", "Nothing is not a number"),
        ("1e400", "“1e400” is out of range"),
        ("20000", "“20000” is out of range. Enter a number from −10000 to 10000 m."),
    ] {
        let told = metres.read(text).unwrap_err();
        assert!(told.contains(reason), "{told}");
    }
    let count = Wanted { range: 1.0..=u64::MAX as f64, is_whole: true, unit: String::new() };
    assert_eq!(count.read("2.5"), Err("“2.5” is not a whole number. Enter a whole number, 1 or more.".to_owned()));
}

#[test]
fn a_wrong_entry_changes_nothing() {
    for text in ["nan", "1e400", "abc", "-3,5,1", "12345678"] {
        let mut panel = panel();
        panel.enters("x", text);
        assert_eq!((panel.state().x_metres, panel.state().changes), (1.0 / 3.0, 0), "{text}");
    }
}

#[test]
fn a_wrong_entry_stays_in_the_field_with_the_focus() {
    let mut panel = panel();
    let before = field(&panel, "count").rect();
    panel.enters("x", "abc");
    assert_eq!(field(&panel, "count").rect(), before, "the message moves nothing");
    assert!(field(&panel, "x").is_focused() && panel.ctx.text_edit_focused());
    assert_eq!(field(&panel, "x").value().as_deref(), Some("abc"));
    assert!(says(&panel, "Enter a number from −10000 to 10000 m."));
    // A click elsewhere removes the focus, but keeps the entry.
    panel.clicks(&["count"]);
    assert_eq!(field(&panel, "x").value().as_deref(), Some("abc"));
    assert!(says(&panel, "“abc” is not a number"));
    assert!(panel.reads("abc"));
}

#[test]
fn a_wrong_entry_ends_by_a_right_one_escape_or_from_elsewhere() {
    type Way = (fn(&mut Harness<'_, Shown>), f64, usize);
    let ways: [Way; 3] = [
        (|panel| panel.enters("x", "-3,5"), -3.5, 1),
        (|panel| panel.presses(&[Key::Escape]), 1.0 / 3.0, 0),
        (|panel| panel.state_mut().x_metres = 8.0, 8.0, 0),
    ];
    for (way, x_metres, changes) in ways {
        let mut panel = panel();
        panel.enters("x", "abc");
        way(&mut panel);
        panel.run();
        assert!(!says(&panel, "is not a number"));
        assert!(changes == 0 || !panel.ctx.text_edit_focused(), "a right entry gives the focus up");
        assert_eq!((panel.state().x_metres, panel.state().changes), (x_metres, changes));
        let text = field(&panel, "x").value();
        assert!(x_metres != 1.0 / 3.0 || text.as_deref() == Some("0.333 m"), "{text:?}");
    }
}

#[test]
fn nothing_counts_before_the_entry_ends() {
    let mut panel = panel();
    field(&panel, "x").focus();
    panel.run();
    panel.key_press_modifiers(Modifiers::COMMAND, Key::A);
    panel.event(Event::Text("12".to_owned()));
    panel.run();
    assert_eq!(panel.state().changes, 0);
    panel.presses(&[Key::Tab]);
    assert_eq!((panel.state().x_metres, panel.state().changes), (12.0, 1));
}

#[test]
fn the_focus_passes_through_without_rounding() {
    let mut panel = panel();
    panel.presses(&[Key::Tab; 3]);
    assert_eq!((panel.state().x_metres, panel.state().changes), (1.0 / 3.0, 0));
}

#[test]
fn a_count_takes_whole_numbers_only() {
    let mut panel = panel();
    panel.enters("count", "2.5");
    assert!(says(&panel, "Enter a whole number from 1 to 9.") && panel.state().count == 5);
    panel.enters("count", "7");
    assert_eq!(panel.state().count, 7);
}

fn sources(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}

#[test]
fn every_number_of_the_window_is_entered_here() {
    let app = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/app");
    let here =
        |path: &std::path::Path| path.to_string_lossy().contains("number_field") || path.ends_with("focus_ring.rs");
    for path in sources(&app).into_iter().filter(|path| !here(path)) {
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("DragValue"), "{} has a field that takes what is no number", path.display());
    }
}
