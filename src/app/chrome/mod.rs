//! The parts of the window around the panels: tiles, column, menu bar, palette, messages, status bar, dialogs.

pub mod column;
mod file_browser;
pub mod file_dialog;
pub mod help;
pub mod menu;
pub mod messages;
pub mod palette;
pub mod save_question;
pub mod status_bar;
pub mod tiles;
pub mod unsaved;
