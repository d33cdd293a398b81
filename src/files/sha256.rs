//! SHA-256, which identifies weights, programs and folders of scenes in the record of a run.

use crate::platform::fs::File;
use sha2::{Digest, Sha256};
use std::io;
use std::path::Path;

/// SHA-256 of the file at `path`, hexadecimal.
/// # Errors
/// The system's error where the file can't be read.
pub fn of_file(path: &Path) -> io::Result<String> {
    let mut digest = Sha256::new();
    io::copy(&mut File::open(path)?, &mut digest)?;
    Ok(hexadecimal(digest))
}

/// SHA-256 of these bytes.
pub fn of_bytes(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(bytes))
}

/// SHA-256 of several pieces of bytes. The length of each piece counts too, so that pieces can't run into each other.
pub fn of_pieces<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut digest = Sha256::new();
    for piece in pieces {
        digest.update((piece.len() as u64).to_le_bytes());
        digest.update(piece);
    }
    hexadecimal(digest)
}

/// The first 12 digits: enough to tell files apart that were not forged.
pub fn short(digest: &str) -> &str {
    digest.get(..12).unwrap_or(digest)
}

fn hexadecimal(digest: Sha256) -> String {
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_digest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("abc");
        std::fs::write(&path, "abc").unwrap();
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(of_file(&path).unwrap(), expected);
        assert!(of_file(&folder.path().join("none")).is_err());
        assert_eq!(short(expected), "ba7816bf8f01");
    }

    #[test]
    fn pieces_do_not_run_into_each_other() {
        let of = |pieces: [&str; 2]| of_pieces(pieces.map(str::as_bytes));
        assert_eq!(of(["ab", "c"]), of(["ab", "c"]));
        assert_ne!(of(["ab", "c"]), of(["a", "bc"]));
    }
}
