//! Enlarged text, to be read first.

use eframe::egui::{RichText, TextStyle, Ui};

/// Size of enlarged text relative to the rest.
pub const LARGE_TEXT_RATIO: f32 = 1.15;

/// Enlarged text.
pub fn large(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).size(LARGE_TEXT_RATIO * TextStyle::Body.resolve(ui.style()).size)
}
