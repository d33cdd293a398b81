//! Commands that write for other programs: files and the clipboard.

use crate::app::state::MapKind;
use std::path::PathBuf;

/// Commands that write for other programs: files and the clipboard.
#[derive(Debug, Clone, PartialEq)]
pub enum ExportCommand {
    /// Save the window (.png) or the scene's panels (.svg) in this file.
    PictureTo(PathBuf),
    /// Save the maps as NumPy arrays in this file.
    MapsTo(PathBuf),
    /// Copy the picture of a map to the clipboard.
    CopyMap(MapKind),
    /// Copy scene, radar, view, method and lesson step as one line of text.
    CopyShared,
    /// Copy a link to the page that shows what is on screen.
    CopyLink,
}
