//! The desktop program: a scene to play with, and every map beside it.
//!
//! ```text
//!   panels ──► Command, Editor, Settings ──► Pipeline ──► two workers (maps and pictures; reconstruction)
//!     ▲                                         │
//!     └────────────── latest results ◄──────────┘            nothing shown is ever taken away before its successor is there
//! ```
//!
//! One panel a file; [`App`] only wires them together. Editing itself is in [`crate::interact`], without egui.

use eframe::egui;
mod application;
mod axes;
mod bounds;
mod bounds_panel;
mod command;
mod controls_panel;
mod cuts_panel;
mod evaluation;
mod evaluation_panel;
mod execute;
mod export;
mod files;
mod frame_log;
mod front_panel;
mod guide_panel;
mod inspect;
mod inspector_panel;
mod jobs;
mod layout;
mod map_panel;
mod menu;
mod messages;
mod palette;
mod pictures;
mod pipeline;
mod roc_panel;
mod scene_canvas;
mod scene_panel;
mod settings;
mod status_bar;
mod theme;
mod timing_panel;
mod training;
mod training_panel;
mod view;

pub use application::{App, Options};
pub use bounds::Elements;
pub use bounds_panel::BoundsSettings;
pub use command::{Command, NewObject};
pub use layout::Panel;
pub use pictures::MapKind;
pub use settings::{Projection, Settings};

/// Name under which settings and the autosave are kept.
const APP_ID: &str = "apertura";

/// Why the app did not open.
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
pub fn run(options: Options) -> Result<(), AppError> {
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("apertura")
            .with_app_id(APP_ID)
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([800.0, 520.0])
            .with_drag_and_drop(true),
        ..eframe::NativeOptions::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(|creation| Ok(Box::new(App::new(creation, options)?)));
    eframe::run_native(APP_ID, native, create).map_err(|error| match error {
        eframe::Error::AppCreation(error) => AppError::Start(std::io::Error::other(error)),
        error => AppError::Window(error.to_string()),
    })
}
