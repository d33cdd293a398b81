//! Writing to standard output and to files.

use super::CommandError;
use crate::files::{ends_in, write_bytes};
use crate::picture::PictureFormat;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;

/// Prints `text` and a line end to standard output. A reader that has gone away (`apertura ... | head`) is no error.
pub fn print(text: &str) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(CommandError(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

pub fn print_json(report: &impl Serialize) -> Result<(), CommandError> {
    print(&serde_json::to_string_pretty(report)?)
}

/// The kind of picture to write to `path`; `None` where its name ends in one of `others`, which are no pictures.
pub fn picture_format(path: &Path, others: &[&str], expected: &str) -> Result<Option<PictureFormat>, CommandError> {
    if ends_in(path, others) {
        return Ok(None);
    }
    let told = format!("can't tell what to write from this name; expected one ending in {expected}");
    PictureFormat::of_path(path).map(Some).ok_or_else(|| CommandError(format!("{}: {told}", path.display())))
}

/// Refuses options of a picture, each a name and whether it was given, beside the file at `path`, which is none.
pub fn check_no_picture(path: &Path, options: &[(&str, bool)]) -> Result<(), CommandError> {
    options.iter().find(|(_, is_given)| *is_given).map_or(Ok(()), |(name, _)| {
        let message = format!("{name} is a picture's; expected the name of a picture to write to");
        Err(CommandError::on(path)(message))
    })
}

/// Writes a whole file, or none.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    write_bytes(path, bytes).map_err(CommandError::on(path))
}
