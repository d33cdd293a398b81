//! Files beside a capture: its `.cfg`, and the files that go on from it.

use crate::files::{ends_in, folder_of};
use crate::platform::fs;
use crate::recording::{Fault, RecordingError};
use std::path::{Path, PathBuf};

const MOST_FILES: usize = 10_000;
const MOST_PARTS: usize = 64;

/// The capture: `path`, or where that is a `.cfg`, the data file beside it.
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

/// The `.cfg` of the same name beside the capture, or the only one there.
pub(super) fn config_of(data: &Path) -> Option<PathBuf> {
    let same = data.with_extension("cfg");
    if fs::exists(&same) { Some(same) } else { only(data, &["cfg"]) }
}

/// The only file of these endings beside `path`.
fn only(path: &Path, endings: &[&str]) -> Option<PathBuf> {
    let entries = fs::read_dir(folder_of(path)).ok()?;
    let names = entries.take(MOST_FILES).filter_map(Result::ok).map(|entry| PathBuf::from(entry.file_name()));
    let mut found = names.filter(|name| ends_in(name, endings));
    let first = found.next()?;
    found.next().is_none().then(|| path.with_file_name(first))
}

/// Words in the file names of a cascade's chips, in the order of TI's capture program.
const CHIPS: [&str; 4] = ["master", "slave1", "slave2", "slave3"];

/// The files of the chips of a cascade in their order, and names of those that are not there, where the capture is one chip's.
pub(super) fn chips(data: &Path) -> (Vec<PathBuf>, Vec<String>) {
    let name = data.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let Some(own) = CHIPS.into_iter().find(|chip| name.contains(chip)) else { return Default::default() };
    let names = CHIPS.map(|chip| name.replacen(own, chip, 1));
    let (found, lacking): (Vec<String>, Vec<String>) =
        names.into_iter().partition(|name| fs::exists(&data.with_file_name(name)));
    (found.into_iter().map(|name| data.with_file_name(name)).collect(), lacking)
}

/// Files that go on from the first, where its name ends with `_0`: `_1` and so on, as capture programs split at a gigabyte.
pub(super) fn more_files(data: &Path) -> Vec<PathBuf> {
    let Some(stem) = data.file_stem().and_then(|s| s.to_str()).and_then(|s| s.strip_suffix("_0")) else {
        return Vec::new();
    };
    let end = data.extension().and_then(|e| e.to_str()).unwrap_or("bin");
    let part = |n: usize| data.with_file_name(format!("{stem}_{n}.{end}"));
    (1..MOST_PARTS).map(part).take_while(|path| fs::exists(path)).collect()
}
