//! Commands that export files and copy to the clipboard.

use crate::app::state::MapKind;
use std::path::PathBuf;

/// A command that exports a file or copies to the clipboard.
#[derive(Debug, Clone, PartialEq)]
pub enum ExportCommand {
    /// Save the scene's panels as a picture (.png or .svg) in this file.
    PictureTo(PathBuf),
    /// Save the maps as NumPy arrays in this file.
    MapsTo(PathBuf),
    /// Copy the picture of a map to the clipboard.
    CopyMap(MapKind),
    /// Copy scene, radar, view, method and lesson step as one line of text.
    CopyShared,
    /// Copy a link to this page that opens the scene on screen.
    CopyLink,
}
