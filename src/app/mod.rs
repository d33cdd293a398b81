//! The desktop program: a scene to edit, with all maps beside it.
//!
//! ```text
//!   keys, files ──► input ──┐                        ┌──► State ──► contents ──► panels, chrome ──┐
//!                           ├──► Command ──► apply ──┤                                            │
//!   panels' commands ───────┘                        └──► Jobs (threads) ──► poll ──► State       │
//!          ▲                                                                                      │
//!          └──────────────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! A panel asks for its value and answers with commands. Only [`apply`] changes settings. Imports run downward: application, contents, panels and chrome,
//! content, jobs, widgets, state. A shown value stays until the next one is there. The editor itself is in [`crate::interact`], without egui.

#[macro_use]
mod registry;

mod application;
mod apply;
mod chrome;
mod content;
mod contents;
mod input;
mod inspect;
mod jobs;
mod kept;
mod page;
mod panels;
mod shared;
mod state;
mod widgets;

use crate::platform;

pub use page::{open_page, options_of};

pub use application::{APP_ID, App, Options};
pub use state::{
    Arrangement, BoundsSettings, ChirpSettings, Command, Compare, Cursor, DifferenceView, Directions, DocumentCommand,
    EditCommand, Elements, Entry, ExportCommand, FailureChoice, Layout, LessonCommand, MapKind, MethodSlot, NewObject,
    Panel, Projection, Purpose, RadarCommand, RowsCommand, Settings, Units, ViewCommand, Way, WindowCommand,
    WorkCommand, listed, listed_on_a_page,
};

/// The reason why the app did not open.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// There is no display or no OpenGL.
    #[error("no window could be opened: {0}")]
    Window(String),
    /// The frame log could not be created or a thread not be started.
    #[error("the app could not start: {0}")]
    Start(#[from] std::io::Error),
}

/// Opens the window and runs until it is closed.
///
/// # Errors
/// [`AppError`] where there is no display or no OpenGL, where the frame log can't be created or no thread be started.
pub fn run(mut options: Options) -> Result<(), AppError> {
    options.problems.extend(kept::problems(platform::storage_folder(APP_ID).as_deref()));
    let create: eframe::AppCreator<'static> = Box::new(|creation| Ok(Box::new(App::new(creation, options)?)));
    platform::open_window(APP_ID, create).map_err(|error| match error {
        eframe::Error::AppCreation(error) => AppError::Start(std::io::Error::other(error)),
        error => AppError::Window(error.to_string()),
    })
}
