//! Commands on the rows of the panel Evaluate: try methods, open a row, search for worse scenes, keep scenes.

use crate::app::state::{FailureChoice, SearchChoice};
use std::path::PathBuf;

/// A command on the rows of the panel Evaluate: try methods, open a row, search for worse scenes, keep scenes.
#[derive(Debug, Clone, PartialEq)]
pub enum RowsCommand {
    /// Try methods on scenes, row by row.
    Try(FailureChoice),
    /// Stop the trial of methods; the rows stay.
    CancelTrying,
    /// Show the rows of this file.
    OpenFile(PathBuf),
    /// Show a CSV file: rows, or the log of a training.
    OpenTable(PathBuf),
    /// Save the rows as CSV in this file.
    SaveTo(PathBuf),
    /// Remove every row.
    Clear,
    /// Bring back the rows last replaced.
    BringBack,
    /// Open the scene of the row of this index, with its floor and method.
    Show(usize),
    /// Search for a worse scene near the one on screen, or for its repair.
    Search(SearchChoice),
    /// Stop the search; its findings stay.
    CancelSearch,
    /// Put the search's last finding on screen.
    TakeFinding,
    /// Drop the search and its path.
    ForgetSearch,
    /// Keep the scene on screen in the user's own folder, with this note.
    KeepScene(String),
    /// Make the folder of this file the user's own folder of scenes.
    SetOwnScenes(PathBuf),
}
