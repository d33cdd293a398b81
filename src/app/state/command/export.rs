//! Commands that write for other programs: files and the clipboard.

use crate::app::state::MapKind;
use std::path::PathBuf;

/// Commands that write for other programs: files and the clipboard.
#[derive(Debug, Clone, PartialEq)]
pub enum ExportCommand {
    /// Ask where to save the window as a picture, or the scene's panels as a drawing.
    Picture,
    /// Save the window (.png) or the scene's panels (.svg) in this file.
    PictureTo(PathBuf),
    /// Ask where to save the maps as NumPy arrays.
    Maps,
    /// Save the maps in this file.
    MapsTo(PathBuf),
    /// Ask where to save the figures as CSV.
    Metrics,
    /// Save the figures in this file.
    MetricsTo(PathBuf),
    /// Ask where to record the next drag.
    RecordDrag,
    /// Record the next drag in this file.
    RecordDragTo(PathBuf),
    /// Ask where to draw the steps of the lesson.
    DrawLesson,
    /// Draw them beside this file, numbered.
    DrawLessonTo(PathBuf),
    /// Give up what is recorded or drawn.
    StopRecording,
    /// Copy the picture of a map to the clipboard.
    CopyMap(MapKind),
    /// Copy scene, radar, view, method and lesson step as one line of text.
    CopyShared,
    /// Copy a link to the page that shows what is on screen.
    CopyLink,
    /// Copy what the evaluation found, as CSV.
    CopyEvaluation,
}
