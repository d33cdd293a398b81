//! Writing to standard output.

use std::io::{self, Write};

/// Prints `text` and a line end to standard output. A reader that has gone away (`apertura ... | head`) is no error.
pub fn print(text: &str) -> Result<(), super::CommandError> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(super::CommandError::File { path: "standard output".into(), source: error })
        }
        _ => Ok(()),
    }
}
