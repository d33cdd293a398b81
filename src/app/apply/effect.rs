//! What a command asks of the window.

use crate::app::state::Brightness;
use eframe::egui::ColorImage;

/// What a command asks of the window.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Light or dark.
    Brightness(Brightness),
    /// Another size of the interface, as a factor; back to normal where `None`.
    Zoom(Option<f32>),
    /// This text on the clipboard.
    Copy(String),
    /// This picture on the clipboard.
    CopyImage(ColorImage),
    /// Ask the system for the clipboard.
    RequestPaste,
    /// Show or hide the palette.
    Palette,
    /// Close.
    Close,
}
