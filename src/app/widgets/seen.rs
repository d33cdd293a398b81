//! What tests see of a frame: every text, where it is, and whether it can be read.

use eframe::egui::epaint::{ClippedShape, Shape};
use eframe::egui::{FullOutput, Rect};

/// A text on screen.
#[derive(Debug, Clone)]
pub struct Seen {
    /// What it says.
    pub text: String,
    /// Where.
    pub rect: Rect,
    /// What may be drawn to at all there.
    pub clip: Rect,
    /// Whether its end is left out for want of room.
    pub is_shortened: bool,
}

/// Every text of a frame of which anything can be seen.
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

/// That no text is cut off and none lies over another.
pub fn assert_readable(output: &FullOutput) {
    let texts = texts(output);
    for (i, a) in texts.iter().enumerate() {
        assert!(a.clip.expand(1.0).contains_rect(a.rect), "cut off: {a:?}");
        for b in &texts[i + 1..] {
            assert!(!a.rect.shrink(1.0).intersects(b.rect.shrink(1.0)), "one over the other: {a:?}, {b:?}");
        }
    }
}
