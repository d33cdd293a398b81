//! Raw captures: bytes whose layout is found, packets included, beside a `.cfg` or none; and packets as they come from a card.
#![no_main]

use apertura::recording::layout::{find, stream::CaptureStream};
use apertura::recording::packets::FrameAssembler;
use apertura::recording::raw;
use libfuzzer_sys::fuzz_target;
use std::io::Cursor;
use std::sync::LazyLock;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().expect("a temporary folder"));

fuzz_target!(|data: &[u8]| {
    // The first byte says how much of the rest is the .cfg.
    let Some((length, rest)) = data.split_first() else { return };
    let (config, samples) = rest.split_at(rest.len().min(4 * usize::from(*length)));
    if let Ok(mut stream) = CaptureStream::new(Cursor::new(samples)) {
        let mut bytes = vec![0; 4096];
        let _any = stream.read_at(u64::from(*length) * 97, &mut bytes);
        let _any = find(&mut stream, None);
    }
    let mut assembler = FrameAssembler::new(1 + 16 * usize::from(*length));
    for packet in rest.chunks(64) {
        assert!(assembler.take(packet).iter().all(|frame| frame.bytes.len() == 1 + 16 * usize::from(*length)));
    }
    let [capture, setup] = ["c.bin", "c.cfg"].map(|name| FOLDER.path().join(name));
    std::fs::write(&capture, samples).expect("room for it");
    std::fs::write(&setup, config).expect("room for it");
    let _any = raw::open(&capture, Some(&setup));
});
