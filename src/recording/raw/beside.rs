//! Files beside a capture: its `.cfg`, the other files of a split capture, and those of a cascade's other chips.

use crate::files::{ends_in, folder_of};
use crate::platform::fs;
use crate::recording::recording_text::data_path;
use crate::recording::{Fault, RecordingError};
use std::path::{Path, PathBuf};

/// Most files of a folder that are searched, and most files of a split capture.
const MAX_FILES: usize = 10_000;
const MAX_PARTS: usize = 64;

/// The data file of a capture: `path`, or the file beside it where `path` is a `.cfg`.
pub(super) fn data_of(path: &Path) -> Result<PathBuf, RecordingError> {
    if !ends_in(path, &["cfg"]) {
        return Ok(path.to_owned());
    }
    let all = ["bin", "dat", "raw", "npy", "npz", "mat", "h5", "hdf5"];
    if let Some(same) = all.into_iter().map(|end| path.with_extension(end)).find(|same| fs::exists(same)) {
        return Ok(same);
    }
    only(path, &all).ok_or_else(|| {
        let expected = "a capture beside it, of the same name (.bin) or the only one there";
        Fault::key("the .cfg", "sets a radar up and holds no samples", expected).of(path)
    })
}

/// The `.cfg` of the same name beside the capture, or the only one in its folder.
pub(super) fn config_of(data: &Path) -> Option<PathBuf> {
    let same = data.with_extension("cfg");
    if fs::exists(&same) { Some(same) } else { only(data, &["cfg"]) }
}

/// The TOML of the same name beside the file `data`, where it describes that file.
pub(super) fn toml_of(data: &Path) -> Option<PathBuf> {
    let toml = data.with_extension("toml");
    (data_path(&toml)? == data).then_some(toml)
}

/// The file with one of these endings in the folder of `path`; `None` where there are several.
fn only(path: &Path, endings: &[&str]) -> Option<PathBuf> {
    let entries = fs::read_dir(folder_of(path)).ok()?;
    let names = entries.take(MAX_FILES).filter_map(Result::ok).map(|entry| PathBuf::from(entry.file_name()));
    let mut found = names.filter(|name| ends_in(name, endings));
    let first = found.next()?;
    found.next().is_none().then(|| path.with_file_name(first))
}

/// Words in the file names of a cascade's chips, in the order of TI's capture program.
const CHIP_NAMES: [&str; 4] = ["master", "slave1", "slave2", "slave3"];

/// Where the capture is of one chip of a cascade: the files of all chips in their order, and the names of missing ones.
pub(super) fn chips(data: &Path) -> (Vec<PathBuf>, Vec<String>) {
    let name = data.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let Some(own) = CHIP_NAMES.into_iter().find(|chip| name.contains(chip)) else { return Default::default() };
    let names = CHIP_NAMES.map(|chip| name.replacen(own, chip, 1));
    let (found, missing): (Vec<String>, Vec<String>) =
        names.into_iter().partition(|name| fs::exists(&data.with_file_name(name)));
    (found.into_iter().map(|name| data.with_file_name(name)).collect(), missing)
}

/// The other files of a split capture: `_1` and so on after a first file `_0`. Capture programs split files at a gigabyte.
pub(super) fn more_files(data: &Path) -> Vec<PathBuf> {
    let Some(stem) = data.file_stem().and_then(|s| s.to_str()).and_then(|s| s.strip_suffix("_0")) else {
        return Vec::new();
    };
    let end = data.extension().and_then(|e| e.to_str()).unwrap_or("bin");
    let part = |n: usize| data.with_file_name(format!("{stem}_{n}.{end}"));
    (1..MAX_PARTS).map(part).take_while(|path| fs::exists(path)).collect()
}
