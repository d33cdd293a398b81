//! Copies of unsaved documents: scene files with a table of the autosave's own.
#![no_main]

use apertura::scene::file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok((scene, Some(table))) = file::from_toml_beside::<toml::Table>(text, "document") {
        file::to_toml_beside(&scene, "document", &table).expect("what was read can be written");
    }
});
