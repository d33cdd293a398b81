//! Editing a document by hand, without any GUI crate: hits, drags, snapping, selection, undo, and the saved content.
//!
//! All places are in metres of the scene. A view gives the metres that one of its points covers.
//!
//! ```text
//!  pointer ──► hit::test ──► Editor::begin_drag ──► drag_to ──► drag_to ──► end_drag     (one step of the history)
//!                               │
//!  key, menu ──────────────► Editor::{add, delete_selected, nudge, paste, ..}            (one step each)
//! ```

pub mod autosave;
pub mod blob;
mod body_grip;
pub mod clipboard;
mod document;
mod editor;
mod field;
mod grip;
mod grip_kind;
mod history;
pub mod hit;
mod selection;
mod snap;

pub use autosave::Autosave;
pub use document::{Document, Restored};
pub use editor::{Editor, Saved};
pub use field::{Coordinates, Field, FieldChange, SharedField, shared};
pub use grip::{MAX_LINE_COUNT, grips, move_grip};
pub use grip_kind::{Grip, GripPlace};
pub use history::History;
pub use selection::{Selection, SelectionMode};
pub use snap::Snap;

/// A place of the scene: x along the array's axis, y ahead of the array.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    pub x_metres: f64,
    pub y_metres: f64,
}

impl Place {
    pub fn new(x_metres: f64, y_metres: f64) -> Self {
        Place { x_metres, y_metres }
    }

    pub fn distance_metres(self, other: Place) -> f64 {
        (self.x_metres - other.x_metres).hypot(self.y_metres - other.y_metres)
    }
}

impl From<[f64; 2]> for Place {
    fn from([x_metres, y_metres]: [f64; 2]) -> Self {
        Place { x_metres, y_metres }
    }
}
