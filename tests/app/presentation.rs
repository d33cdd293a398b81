//! The presentation, and pictures for slides.

use crate::session::*;

#[test]
fn one_key_toggles_a_presentation() {
    let mut s = Session::start();
    s.ask(WindowCommand::Maximise(Panel::Cuts));
    s.ask(WindowCommand::Maximise(Panel::Cuts));
    s.ask(WindowCommand::ClosePanel(Panel::Inspector));
    s.ask(WindowCommand::ZoomIn);
    let (zoom, before) = (s.app.ctx.zoom_factor(), s.state().arrangement.shown().clone());
    s.press(Modifiers::NONE, Key::F11);
    let maps = [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output].map(Panel::Map);
    let shown: BTreeSet<Panel> = maps.into_iter().chain([Panel::Scene]).collect();
    assert_eq!(*s.state().arrangement.shown(), shown);
    assert!(s.app.ctx.zoom_factor() / zoom >= 1.25, "larger type");
    s.ask(WindowCommand::OpenPanel(Panel::Roc));
    s.press(Modifiers::NONE, Key::F11);
    assert_eq!(s.app.ctx.zoom_factor(), zoom);
    assert_eq!(*s.state().arrangement.shown(), before, "the panel opened meanwhile is gone");
    assert!(!before.contains(&Panel::Inspector));
}

#[test]
fn both_presentations_enlarge_the_axes() {
    for modifiers in [Modifiers::NONE, Modifiers::SHIFT] {
        let mut s = Session::start();
        let tallest = |s: &Session, text: &str| {
            let of = s.texts().into_iter().filter(|(_, t)| t.galley.text().contains(text));
            of.map(|(_, t)| t.galley.size().y * s.app.ctx.zoom_factor()).fold(0.0, f32::max)
        };
        let labels = ["range, m", "cos θ", "Λ"];
        let before = labels.map(|label| tallest(&s, label));
        s.press(modifiers, Key::F11);
        for (label, before) in labels.into_iter().zip(before) {
            let now = tallest(&s, label);
            assert!(before > 0.0 && now > 1.35 * before, "{label} with {modifiers:?}: {before}, then {now}");
        }
        s.press(modifiers, Key::F11);
        assert_eq!(tallest(&s, "range, m"), before[0]);
    }
}

#[test]
fn a_map_that_is_not_drawn_is_told_and_not_copied() {
    let mut s = Session::start();
    s.ask(WindowCommand::ClosePanel(Panel::Map(MapKind::Target)));
    let before = s.state().notices.list.len();
    s.ask(ExportCommand::CopyMap(MapKind::Target));
    assert_eq!(s.state().notices.list.len(), before + 1);
}
