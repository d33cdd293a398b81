//! Commands that select objects and change the scene on screen.

use super::NewObject;
use crate::interact::blob::BlobHit;
use crate::interact::{Coordinates, Field, FieldChange, Place, SelectionMode, Snap};

/// A command that selects objects or changes the scene on screen.
#[derive(Debug, Clone, PartialEq)]
pub enum EditCommand {
    /// Undo the last change of the scene.
    Undo,
    /// Redo the last undone change.
    Redo,
    /// End the current undo step, as when the mouse button is released.
    Seal,
    /// Cut the selected objects to the clipboard.
    Cut,
    /// Copy the selected objects as TOML.
    Copy,
    /// Ask the system for the clipboard and add its objects.
    Paste,
    /// Add the objects in this text.
    PasteText(String),
    /// Copy the selected objects a little aside.
    Duplicate,
    /// Delete the selected objects.
    Delete,
    /// Select every object.
    SelectAll,
    /// Select the objects of these indices.
    Select(Vec<usize>, SelectionMode),
    /// Select the object after the one selected last.
    SelectNext,
    /// Select the object before the one selected last.
    SelectPrevious,
    /// Change a number of every selected object.
    SetField(Field, FieldChange),
    /// Name the selected object.
    Name(String),
    /// Start dragging the object behind a blob.
    Grab(BlobHit),
    /// Drag the held object to this place.
    DragTo(Place),
    /// Release the held object.
    Drop,
    /// Add an object at a place, or where there is room.
    Add(NewObject, Option<Place>),
    /// Move the selected objects.
    Nudge {
        /// Distance along the array.
        dx_metres: f64,
        /// Distance ahead of the array.
        dy_metres: f64,
    },
    /// Set the seed of the noise beneath the scene.
    SetNoiseSeed(u64),
    /// Set the grid that dragged objects snap to.
    SetSnap(Snap),
    /// Set the coordinates in which places are shown and entered.
    SetCoordinates(Coordinates),
}
