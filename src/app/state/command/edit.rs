//! Commands that select objects and change the scene on screen.

use super::NewObject;
use crate::interact::blob::BlobHit;
use crate::interact::{Coordinates, Field, FieldChange, Place, SelectionMode, Snap};

/// Commands that select objects and change the scene on screen.
#[derive(Debug, Clone, PartialEq)]
pub enum EditCommand {
    /// Undo the last change of the scene.
    Undo,
    /// Redo what was undone.
    Redo,
    /// End the current undo step, as when the mouse button is let go.
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
    /// Select these objects.
    Select(Vec<usize>, SelectionMode),
    /// Select the object after the one that was picked last.
    SelectNext,
    /// Select the one before it.
    SelectPrevious,
    /// Change a number of every selected object.
    SetField(Field, FieldChange),
    /// Name the selected object.
    Name(String),
    /// Start dragging the object behind a blob.
    Grab(BlobHit),
    /// Drag what is held here.
    DragTo(Place),
    /// Let go of it.
    Drop,
    /// Add an object, at a place or where there is room.
    Add(NewObject, Option<Place>),
    /// Move the selected objects.
    Nudge {
        /// Along the array.
        dx_metres: f64,
        /// Ahead of it.
        dy_metres: f64,
    },
    /// Seed of the noise beneath the scene, which is part of it.
    SetNoiseSeed(u64),
    /// Where dragged objects come to rest.
    SetSnap(Snap),
    /// In which numbers places are told and entered.
    SetCoordinates(Coordinates),
}
