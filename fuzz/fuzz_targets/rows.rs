//! Rows of CSV: what is accepted can be written, and read again as the same.
#![no_main]

use apertura::evaluate::rows::{read_rows, write_rows};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(rows) = read_rows(bytes) {
        let mut again = Vec::new();
        write_rows(&mut again, &rows).expect("what was read can be written");
        assert_eq!(read_rows(again.as_slice()).expect("and read again"), rows);
    }
});
