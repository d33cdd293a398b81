//! Changes to the window that a command causes.

use crate::app::state::Brightness;
use eframe::egui::ColorImage;

/// A change to the window that a command causes.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Light or dark theme.
    Brightness(Brightness),
    /// Another scale of the interface: a step added to the factor, or normal size where `None`.
    Zoom(Option<f32>),
    /// Text for the clipboard.
    Copy(String),
    /// Picture for the clipboard.
    CopyImage(ColorImage),
    /// Asks the system for the clipboard's content.
    RequestPaste,
    /// Shows or hides the palette.
    Palette,
    /// Closes the window.
    Close,
}
