//! Scene files: what is accepted can be written, and read again as the same.
#![no_main]

use apertura::scene::file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(scene) = file::from_toml(text) {
        let again = file::to_toml(&scene).expect("what was read can be written");
        assert_eq!(file::from_toml(&again).as_ref(), Ok(&scene));
    }
});
