//! Commands about the rows of the panel Evaluate: try methods, open a row, look for worse scenes, keep scenes.

use crate::app::state::{FailureChoice, SearchChoice};
use std::path::PathBuf;

/// Commands about the rows of the panel Evaluate: try methods, open a row, look for worse scenes, keep scenes.
#[derive(Debug, Clone, PartialEq)]
pub enum RowsCommand {
    /// Try methods on scenes, row by row.
    Try(FailureChoice),
    /// Stop trying; the rows stay.
    CancelTrying,
    /// Show the rows of this file.
    OpenFile(PathBuf),
    /// Show what this CSV file holds: rows, or the log of a training.
    OpenTable(PathBuf),
    /// Save the rows as CSV in this file.
    SaveTo(PathBuf),
    /// Forget every row.
    Clear,
    /// Bring the rows back that others took the place of.
    BringBack,
    /// Put the scene of this row on screen, with its floor and method.
    Show(usize),
    /// Look for a worse scene near the one on screen, or for its repair.
    Search(SearchChoice),
    /// Stop looking; what was found stays.
    CancelSearch,
    /// Put what the search found on screen.
    TakeFinding,
    /// Forget the search and its path.
    ForgetSearch,
    /// Keep the scene on screen among one's own, with this note.
    KeepScene(String),
    /// The folder of one's own scenes is the one that this file lies in.
    SetOwnScenes(PathBuf),
}
