//! Windows without a display, texts of a drawn frame, and actions of a user, for tests.

pub use egui_kittest::Harness;
pub use egui_kittest::kittest::{NodeT, Queryable};

use eframe::egui::epaint::{ClippedShape, Shape};
use eframe::egui::{Event, FullOutput, Key, Modifiers, Pos2, Rect, Ui};

/// A window of this size, and all that `show` has asked for.
pub fn asking<'a, T, C: IntoIterator<Item = T>>(
    size: [f32; 2],
    mut show: impl FnMut(&mut Ui) -> C + 'a,
) -> Harness<'a, Vec<T>> {
    let draw = move |ui: &mut Ui, asked: &mut Vec<T>| asked.extend(show(ui));
    Harness::builder().with_size(size).build_ui_state(draw, Vec::new())
}

/// As [`asking`], with a memory that `show` changes.
pub fn asking_with<'a, M, T, C: IntoIterator<Item = T>>(
    size: [f32; 2],
    memory: M,
    mut show: impl FnMut(&mut Ui, &mut M) -> C + 'a,
) -> Harness<'a, (M, Vec<T>)> {
    let draw = move |ui: &mut Ui, (memory, asked): &mut (M, Vec<T>)| asked.extend(show(ui, memory));
    Harness::builder().with_size(size).build_ui_state(draw, (memory, Vec::new()))
}

/// A text on screen.
#[derive(Debug, Clone)]
pub struct Seen {
    pub text: String,
    pub rect: Rect,
    pub clip: Rect,
    /// Whether the text is cut short for lack of room.
    pub is_shortened: bool,
}

/// Every text of a frame that is at least partly visible.
pub fn texts(output: &FullOutput) -> Vec<Seen> {
    let mut found = Vec::new();
    for ClippedShape { clip_rect, shape, .. } in &output.shapes {
        gather(*clip_rect, shape, &mut found);
    }
    found
}

fn gather(clip: Rect, shape: &Shape, found: &mut Vec<Seen>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| gather(clip, shape, found)),
        Shape::Text(text) => {
            let (rect, said) = (text.visual_bounding_rect(), text.galley.text().to_owned());
            if !said.trim().is_empty() && rect.intersects(clip) {
                found.push(Seen { text: said, rect, clip, is_shortened: text.galley.elided });
            }
        }
        _ => {}
    }
}

/// Asserts that each of these texts is on screen.
pub fn assert_reads(output: &FullOutput, wanted: &[&str]) {
    let texts = texts(output);
    for text in wanted {
        assert!(texts.iter().any(|t| t.text == *text), "{text} in {texts:?}");
    }
}

/// Asserts that no text is cut off and none overlaps another.
pub fn assert_readable(output: &FullOutput) {
    let texts = texts(output);
    for (i, a) in texts.iter().enumerate() {
        assert!(a.clip.expand(1.0).contains_rect(a.rect), "cut off: {a:?}");
        for b in &texts[i + 1..] {
            assert!(!a.rect.shrink(1.0).intersects(b.rect.shrink(1.0)), "one over the other: {a:?}, {b:?}");
        }
    }
}

/// A user before a harness. Each action ends when the window rests, after four frames at most.
pub trait User {
    /// Clicks the widgets with these labels, one after the other.
    fn clicks(&mut self, labels: &[&str]);
    fn presses(&mut self, keys: &[Key]);
    /// Types a text in place of the text of a field, and enters it.
    fn enters(&mut self, label: &str, text: &str);
    fn drags(&mut self, places: &[Pos2]);
    /// Whether one text on screen is `text`.
    fn reads(&self, text: &str) -> bool;
}

impl<S> User for Harness<'_, S> {
    fn clicks(&mut self, labels: &[&str]) {
        for label in labels {
            self.get_by_label(label).click();
            self.run_ok();
        }
    }

    fn presses(&mut self, keys: &[Key]) {
        for key in keys {
            self.key_press(*key);
            self.run_ok();
        }
    }

    fn enters(&mut self, label: &str, text: &str) {
        let role = |node: &egui_kittest::Node<'_>| {
            use eframe::egui::accesskit::Role::{SpinButton, TextInput};
            [SpinButton, TextInput].contains(&node.accesskit_node().role())
        };
        self.query_all_by_label(label).find(role).expect(label).focus();
        self.run_ok();
        self.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.event(Event::Text(text.to_owned()));
        self.run_ok();
        self.presses(&[Key::Enter]);
    }

    fn drags(&mut self, places: &[Pos2]) {
        self.hover_at(places[0]);
        self.step();
        self.drag_at(places[0]);
        self.step();
        for place in &places[1..] {
            self.hover_at(*place);
            self.step();
        }
        self.drop_at(places[places.len() - 1]);
        self.run_ok();
    }

    fn reads(&self, text: &str) -> bool {
        texts(self.output()).iter().any(|t| t.text == text)
    }
}
