//! Texts of a drawn frame, for tests: their places, and whether they are readable.

use eframe::egui::epaint::{ClippedShape, Shape};
use eframe::egui::{FullOutput, Rect};

/// A text on screen.
#[derive(Debug, Clone)]
pub struct Seen {
    /// The text.
    pub text: String,
    /// Rectangle of the text.
    pub rect: Rect,
    /// Clip rectangle of the text.
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
