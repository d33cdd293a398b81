//! NumPy archives: every key as every kind of array, and as a scene.
#![no_main]

use apertura::files::npz::Npz;
use apertura::scene::file;
use libfuzzer_sys::fuzz_target;
use ndarray::{Ix1, Ix2, Ix3};
use std::io::Write;

fuzz_target!(|bytes: &[u8]| {
    let mut damaged = tempfile::Builder::new().suffix(".npz").tempfile().expect("a temporary file");
    damaged.write_all(bytes).expect("room for it");
    if let Ok(mut npz) = Npz::open(damaged.path()) {
        for key in npz.keys().to_vec() {
            let _any = (npz.reals::<Ix1>(&key), npz.complexes::<Ix2>(&key), npz.reals::<Ix3>(&key));
        }
    }
    let _any = file::load(damaged.path());
});
