//! Recordings: the text that describes one, beside whole data; and what a radar's own profile says.
#![no_main]

use apertura::recording::{RadarProfile, file};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;
use tempfile::TempDir;

const DATA: [(&str, &[u8]); 2] = [
    ("chip-8.npz", include_bytes!("../../assets/recordings/chip-8.npz")),
    ("cascade-86.mat", include_bytes!("../../assets/recordings/cascade-86.mat")),
];

/// Writing the data takes longer than any text: it is done once.
static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, data) in DATA {
        std::fs::write(folder.path().join(name), data).expect("room for it");
    }
    folder
});

fuzz_target!(|text: &str| {
    let _any = RadarProfile::parse(text);
    let path = FOLDER.path().join("recording.toml");
    std::fs::write(&path, text).expect("room for it");
    let _any = file::load(&path);
});
