//! What is shown to many people, or taken to their slides.

use crate::session::{Session, step_until};
use apertura::app::{Command, MapKind, Panel};
use eframe::egui::{Event, Key, Modifiers, OutputCommand, PointerButton, vec2};
use egui_kittest::kittest::Queryable;
use std::collections::BTreeSet;

#[test]
fn one_key_begins_a_presentation_and_the_same_brings_everything_back() {
    let mut s = Session::start();
    s.ask(Command::Maximise(Panel::Cuts));
    s.ask(Command::Maximise(Panel::Cuts));
    s.ask(Command::ClosePanel(Panel::Inspector));
    s.ask(Command::ZoomIn);
    let (zoom, before) = (s.app.ctx.zoom_factor(), s.state().arrangement().shown().clone());
    assert!(s.app.query_by_label_contains("objects").is_some(), "the status bar tells numbers");
    s.press(Modifiers::NONE, Key::F11);
    let shown = [Panel::Scene, Panel::Map(MapKind::Input0), Panel::Map(MapKind::Target), Panel::Map(MapKind::Output)];
    assert_eq!(*s.state().arrangement().shown(), BTreeSet::from(shown));
    assert!((s.app.ctx.zoom_factor() / zoom - 1.5).abs() < 1e-6, "larger type");
    assert!(s.app.query_by_label_contains("objects").is_none(), "no numbers");
    s.ask(Command::OpenPanel(Panel::Roc));
    s.press(Modifiers::NONE, Key::F11);
    assert_eq!(s.app.ctx.zoom_factor(), zoom);
    assert_eq!(*s.state().arrangement().shown(), before, "whatever was opened meanwhile");
    assert!(!s.state().arrangement().is_open(Panel::Inspector) && !before.contains(&Panel::Inspector));
}

#[test]
fn a_map_is_copied_upright_a_pixel_a_cell() {
    let mut s = Session::start();
    s.app.state_mut().ask(Command::CopyMap(MapKind::Target));
    s.app.step();
    let commands = &s.app.output().platform_output.commands;
    let image = commands.iter().find_map(|c| if let OutputCommand::CopyImage(image) = c { Some(image) } else { None });
    let image = image.expect("a picture on the clipboard").clone();
    let radar = s.state().radar().clone();
    assert_eq!(image.size, [radar.elements, radar.samples]);
    // The brightest row is that of a reflector, counted from below.
    let brightness =
        |row: usize| image.pixels[row * radar.elements..][..radar.elements].iter().map(|p| u64::from(p.g())).max();
    let brightest = (0..radar.samples).max_by_key(|row| brightness(*row)).unwrap();
    let bins = [[0.0f64, 20.0], [8.0, 12.0]].map(|[x, y]| radar.bin_of_range(x.hypot(y)));
    let bin = (radar.samples - 1 - brightest) as f64;
    assert!(bins.iter().any(|b| (b - bin).abs() <= 1.5), "row {brightest} is bin {bin}, reflectors in {bins:?}");
    s.ask(Command::ClosePanel(Panel::Map(MapKind::Target)));
    let before = s.state().messages();
    s.ask(Command::CopyMap(MapKind::Target));
    assert_eq!(s.state().messages(), before + 1, "a map that isn't drawn is no picture: that is told");
}

#[test]
fn a_blob_in_a_map_is_selected_by_a_click_and_moved_by_a_drag() {
    let mut s = Session::start();
    let rect = s.app.get_by_label("Target map").rect();
    let radar = s.state().radar().clone();
    let at = |place: [f64; 2]| {
        let blob = radar.blob_of(0.0, place[0], place[1]);
        let across = (radar.column_of_cos(blob.cos_theta) + 0.5) / radar.elements as f64;
        let up = (radar.bin_of_range(blob.range_metres) + 0.5) / radar.samples as f64;
        rect.left_bottom() + vec2(rect.width() * across as f32, -rect.height() * up as f32)
    };
    let from = at(s.place(1));
    for pressed in [true, false] {
        s.app.hover_at(from);
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        s.app.event(Event::PointerButton { pos: from, button, pressed, modifiers });
        s.app.step();
    }
    s.settle();
    assert_eq!(s.state().editor().selection().single(), Some(1));
    step_until(&mut s, "no longer a double click", |s| s.app.ctx.input(|i| i.pointer.time_since_last_click() > 1.0));
    assert!(rect.contains(from), "it is grasped in the map");
    s.drag(from, vec2(-40.0, 20.0), 5);
    let moved = at(s.place(1));
    assert!(moved.distance(from + vec2(-40.0, 20.0)) < 2.0, "{moved} from {from}");
    s.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(s.place(1), [8.0, 12.0]);
}
