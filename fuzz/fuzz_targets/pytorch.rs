//! PyTorch checkpoints, up to the safetensors they are translated to.
#![no_main]

use apertura::network::pytorch::read_weights;
use libfuzzer_sys::fuzz_target;
use std::io::Write;

fuzz_target!(|bytes: &[u8]| {
    let mut damaged = tempfile::Builder::new().suffix(".pt").tempfile().expect("a temporary file");
    damaged.write_all(bytes).expect("room for it");
    let _any = read_weights(damaged.path());
});
