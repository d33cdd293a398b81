//! Pasteable strings: any text, and any text packed as one is; what is accepted can be shared again, and opened as the same.
#![no_main]

use apertura::share::SharedScene;
use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::{Compression, write::ZlibEncoder};
use libfuzzer_sys::fuzz_target;
use std::io::Write;

fn packed(text: &str) -> String {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::none());
    packed.write_all(text.as_bytes()).expect("memory");
    format!("apertura:1:{}", URL_SAFE_NO_PAD.encode(packed.finish().expect("memory")))
}

fuzz_target!(|text: &str| {
    for text in [text.to_owned(), packed(text)] {
        if let Ok(shared) = SharedScene::from_text(&text)
            && let Ok(again) = shared.to_text()
        {
            assert_eq!(SharedScene::from_text(&again).as_ref(), Ok(&shared));
        }
    }
});
