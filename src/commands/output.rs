//! Writing to standard output and to files.

use super::CommandError;
use crate::files::write_bytes;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;

/// Prints `text` and a line end to standard output. A reader that has gone away (`apertura ... | head`) is no error.
pub fn print(text: &str) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(CommandError::File { path: "standard output".into(), source: error })
        }
        _ => Ok(()),
    }
}

pub fn print_json(report: &impl Serialize) -> Result<(), CommandError> {
    print(&serde_json::to_string_pretty(report).map_err(CommandError::failed)?)
}

/// Writes a whole file, or none.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    write_bytes(path, bytes).map_err(|source| CommandError::File { path: path.to_owned(), source })
}
