//! HDF5: the shapes of a file, and every array that it says it has.
#![no_main]

use apertura::files::hdf5::Hdf5;
use libfuzzer_sys::fuzz_target;
use std::io::Cursor;

/// Numbers of an array, at most.
const MAX_NUMBERS: usize = 1 << 16;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mut file) = Hdf5::open(Cursor::new(bytes)) else { return };
    for (name, _) in file.shapes().unwrap_or_default() {
        let _any = file.values(&name, MAX_NUMBERS);
    }
});
