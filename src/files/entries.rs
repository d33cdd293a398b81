//! The number of entries that a zip archive claims, checked before memory is reserved.

use std::io::{self, Read, Seek, SeekFrom};

/// Bytes from the end within which an archive's last record begins: it is 22 long and may have a comment of 65 535.
const TAIL_BYTES: u64 = 65_535 + 22 + 76;

const ENTRY_BYTES: u64 = 46;

/// Checks that an archive ends in a list that can hold as many entries as it claims; leaves `file` at its beginning. Without the list the archive's
/// reader would look for it in all of the file, which takes minutes where that has gigabytes.
/// # Errors
/// [`io::ErrorKind::InvalidData`] where it has none, or can't hold them, and errors of the file.
pub fn check_entries(file: &mut (impl Read + Seek)) -> io::Result<()> {
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(length.saturating_sub(TAIL_BYTES)))?;
    let mut tail = Vec::new();
    file.take(TAIL_BYTES).read_to_end(&mut tail)?;
    file.seek(SeekFrom::Start(0))?;
    let number = |at: usize, width: usize| {
        let bytes = tail.get(at..at + width)?;
        Some(bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
    };
    if !tail.windows(4).any(|bytes| bytes == b"PK\x05\x06") {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "it does not end in a list of entries"));
    }
    let has_longer_record = tail.windows(4).any(|bytes| bytes == b"PK\x06\x06");
    for at in 0..tail.len().saturating_sub(3) {
        let claimed = match &tail[at..at + 4] {
            // 65 535 stands for "see the longer record".
            b"PK\x05\x06" => number(at + 8, 2).max(number(at + 10, 2)).filter(|n| *n != 0xffff || !has_longer_record),
            b"PK\x06\x06" => number(at + 32, 8),
            _ => None,
        };
        if let Some(claimed) = claimed.filter(|n| n.saturating_mul(ENTRY_BYTES) > length) {
            let message = format!("its list claims {claimed} entries, more than the file has room for");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn a_list_that_claims_more_than_there_is_room_for_is_refused() {
        let record = |count: u16| {
            let mut bytes = vec![0; 100];
            bytes.extend(b"PK\x05\x06\0\0\0\0");
            bytes.extend([count.to_le_bytes(), count.to_le_bytes()].concat());
            bytes.extend([0; 10]);
            check_entries(&mut Cursor::new(bytes)).map_err(|e| e.to_string())
        };
        assert_eq!(record(2), Ok(()));
        assert!(record(16_386).unwrap_err().contains("16386 entries"));
        let mut long = b"PK\x05\x06".to_vec();
        long.extend([0; 18]);
        long.extend(b"PK\x06\x06");
        long.extend([0; 28]);
        long.extend(u64::MAX.to_le_bytes());
        assert!(check_entries(&mut Cursor::new(long)).unwrap_err().to_string().contains("entries, more than"));
        let none = check_entries(&mut Cursor::new(vec![0; 1 << 20])).unwrap_err().to_string();
        assert_eq!(none, "it does not end in a list of entries");
    }
}
