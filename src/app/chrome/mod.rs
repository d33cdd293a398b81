//! What stands around the panels: tiles, one column in a narrow window, menu bar, palette of commands, messages, status bar, file dialog, questions.

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
