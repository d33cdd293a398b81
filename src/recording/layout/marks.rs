//! Headers before chirps, found by their first bytes.

use super::stream::CaptureStream;
use std::io::{self, Read, Seek};

/// First bytes of a chirp's header: 0x0CDA0ADC twice, high half word first.
pub(super) const MAGIC: [u8; 8] = [0xdc, 0x0a, 0xda, 0x0c, 0xdc, 0x0a, 0xda, 0x0c];

pub const HEADER_BYTES: usize = 64;

/// Bytes at the beginning of a file that are searched for headers.
const MAX_SEARCHED_BYTES: u64 = 1 << 20;

/// Headers of chirps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Marks {
    /// Number of headers found.
    pub found: usize,
    /// Bytes from one to the next; 0 for a single one.
    pub apart: usize,
}

/// Finds headers at equal distances from the first byte on; `None` where the file begins with no header.
pub(super) fn marks<R: Read + Seek>(stream: &mut CaptureStream<R>) -> io::Result<Option<Marks>> {
    let mut start = vec![0; stream.bytes().min(MAX_SEARCHED_BYTES) as usize];
    stream.read_at(0, &mut start)?;
    if !start.starts_with(&MAGIC) {
        return Ok(None);
    }
    let next = start.windows(MAGIC.len()).skip(1).position(|bytes| bytes == MAGIC).map(|at| at + 1);
    let Some(apart) = next.filter(|apart| *apart > HEADER_BYTES) else { return Ok(Some(Marks { found: 1, apart: 0 })) };
    let found = start.chunks(apart).take_while(|chunk| chunk.starts_with(&MAGIC)).count();
    Ok(Some(Marks { found, apart }))
}
