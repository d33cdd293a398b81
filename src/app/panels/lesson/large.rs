//! Text that is to be read first.

use eframe::egui::{RichText, TextStyle, Ui};

/// Text that is to be read first is this much larger than the rest.
pub const LARGE_TEXT_RATIO: f32 = 1.15;

/// Such a text.
pub fn large(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).size(LARGE_TEXT_RATIO * TextStyle::Body.resolve(ui.style()).size)
}
