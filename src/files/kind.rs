//! The kind of a file by its first bytes, for messages about a wrong file.

use super::read_start;
use std::path::Path;

/// Bytes of the beginning of a file by which its kind is found.
const START_BYTES: u64 = 1 << 16;

/// The kind of the file at `path`, as a noun for a message: "an ONNX model"; `None` where no kind is recognised or the file can't be read.
pub fn kind_at(path: &Path) -> Option<&'static str> {
    kind_of(&read_start(path, START_BYTES).ok()?)
}

/// The kind of text at `path`, as [`kind_at`] has it; `None` for other files.
pub fn text_kind_at(path: &Path) -> Option<&'static str> {
    text_kind(&read_start(path, START_BYTES).ok().filter(|bytes| !bytes.is_empty())?)
}

/// The kind of a file that begins with `bytes`.
pub fn kind_of(bytes: &[u8]) -> Option<&'static str> {
    let begins = |start: &[u8]| bytes.starts_with(start);
    Some(match bytes {
        [] => "an empty file",
        _ if begins(b"PK\x03\x04") => archive(bytes),
        _ if begins(b"PK\x05\x06") => "an empty zip archive",
        _ if begins(b"\x93NUMPY") => "one NumPy array (.npy)",
        _ if begins(b"\x89HDF\r\n") => "an HDF5 file",
        _ if begins(b"MATLAB 5.0") => "a MATLAB file (.mat)",
        _ if begins(b"\x89PNG\r\n") => "a picture (.png)",
        _ if begins(b"GIF8") => "a picture (.gif)",
        _ if begins(b"\xFF\xD8\xFF") => "a picture (.jpg)",
        _ if begins(b"%PDF-") => "a PDF document",
        _ if begins(b"\x1F\x8B") => "a gzip file",
        [0x80, 2..=5, ..] => "a Python pickle",
        _ if is_safetensors(bytes) => "weights (.safetensors)",
        _ if is_onnx(bytes) => "an ONNX model",
        _ => return text_kind(bytes),
    })
}

/// The kind of a zip archive, by the name of its first entry, which stands 30 bytes behind its start.
fn archive(bytes: &[u8]) -> &'static str {
    let length = bytes.get(26..28).map_or(0, |n| usize::from(n[0]) + 256 * usize::from(n[1]));
    let name = bytes.get(30..30 + length).unwrap_or_default();
    let holds = |part: &[u8]| name.windows(part.len()).any(|at| at == part);
    match () {
        () if name.ends_with(b".npy") => "a NumPy archive (.npz)",
        () if holds(b"/data.pkl") || holds(b"/.format_version") => "a PyTorch checkpoint (.pt)",
        () => "a zip archive",
    }
}

/// A length of eight bytes, then a JSON object.
fn is_safetensors(bytes: &[u8]) -> bool {
    matches!(bytes, [_, _, _, _, 0, 0, 0, 0, b'{', ..])
}

/// A protocol buffer that begins with a small `ir_version`, as ONNX does, and goes on with another of a model's fields.
fn is_onnx(bytes: &[u8]) -> bool {
    // Fields 2 (producer), 3, 4 (domain), 5 (version), 6, 7 (graph) and 8 (operator set) with their wire types.
    matches!(bytes, [0x08, 1..=32, 0x12 | 0x1A | 0x22 | 0x28 | 0x32 | 0x3A | 0x42, ..])
}

fn text_kind(bytes: &[u8]) -> Option<&'static str> {
    // The last character may be cut.
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(e) if bytes.len() - e.valid_up_to() < 4 => std::str::from_utf8(&bytes[..e.valid_up_to()]).ok()?,
        Err(_) => return None,
    };
    if text.chars().any(|c| c.is_control() && !c.is_whitespace()) {
        return None;
    }
    let has_line = |start: &str| text.lines().any(|line| line.trim_start().starts_with(start));
    Some(match () {
        () if has_line("[[object]]") => "a scene (.toml)",
        () if has_line("[recording]") => "a recording (.toml)",
        () if has_line("[[step]]") => "a lesson (.toml)",
        () if text.trim_start().starts_with('<') => "an XML or HTML file, such as a drawing (.svg)",
        () => "a text file",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_by_how_they_begin() {
        let npz = [b"PK\x03\x04".as_slice(), &[0; 22], &[8, 0, 0, 0], b"sub0.npy"].concat();
        for (start, kind) in [
            (npz.as_slice(), Some("a NumPy archive (.npz)")),
            (b"", Some("an empty file")),
            (b"\x08\x08\x12\x07pytorch", Some("an ONNX model")),
            (b"\x08\x01\x00", None),
            (b"\x10\0\0\0\0\0\0\0{\"a\":1}", Some("weights (.safetensors)")),
            (b"name = \"x\"\n\n[[object]]\nkind = \"point\"\n", Some("a scene (.toml)")),
            (b"[recording]\nfile = \"a.npz\"\n", Some("a recording (.toml)")),
            (b"<svg/>", Some("an XML or HTML file, such as a drawing (.svg)")),
            ("caf\u{e9}".as_bytes().split_last().unwrap().1, Some("a text file")),
            (b"\xC3\x28\xC3\x28\xC3\x28", None),
            (b"a\0b", None),
        ] {
            assert_eq!(kind_of(start), kind, "{start:?}");
        }
        let kinds =
            ["assets/weights/unet.safetensors", "tests/data/thesis_reference_weights.pt", "assets/scenes/street.toml"];
        let found = kinds.map(|path| kind_at(Path::new(path)));
        assert_eq!(
            found,
            [Some("weights (.safetensors)"), Some("a PyTorch checkpoint (.pt)"), Some("a scene (.toml)")]
        );
        assert_eq!(kinds.map(|path| text_kind_at(Path::new(path))), [None, None, Some("a scene (.toml)")]);
        assert_eq!(kind_at(Path::new("none/such")), None);
        assert_eq!(kind_at(Path::new("src")), None);
    }
}
