//! MATLAB's `.mat` files, versions 5 and 7 ("MAT-File Format", The MathWorks): numeric arrays, real or complex, compressed or not.
//!
//! The crates that read them know no complex numbers (`mat5`) or inflate without a bound (`matfile`), so this reader is the
//! program's own. It reads forward only, and asks for no memory before the size was compared with what the file says elsewhere.

use super::numbers::{MAX_NUMBERS, Numbers, bounded_count};
use flate2::read::ZlibDecoder;
use ndarray::{ArrayD, IxDyn, ShapeBuilder, ShapeError};
use num_complex::Complex64;
use std::io::{self, Read};

/// Why an array could not be read.
#[derive(Debug, thiserror::Error)]
pub enum MatError {
    /// The system could not read.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The header is that of another kind of file.
    #[error("not a MATLAB file of version 5 or 7 ({0})")]
    Header(&'static str),
    /// The file lacks the array.
    #[error("has no array \"{key}\"; expected it beside what is there: {found}")]
    Missing {
        /// The name asked for.
        key: String,
        /// The names the file has.
        found: String,
    },
    /// Something other than numbers.
    #[error("\"{key}\" is {found}; expected an array of numbers")]
    Kind {
        /// The name.
        key: String,
        /// What it is.
        found: &'static str,
    },
    /// More numbers than are read.
    #[error("array \"{key}\" has shape {shape:?}; expected at most {MAX_NUMBERS} numbers")]
    TooLarge {
        /// The name.
        key: String,
        /// Its shape.
        shape: Vec<usize>,
    },
    /// The bytes contradict themselves or end too soon.
    #[error("{what} can't be read: {reason}")]
    Damaged {
        /// Which part of the file.
        what: String,
        /// What is wrong.
        reason: String,
    },
}

const HEADER_BYTES: usize = 128;
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Longest name that is read, bytes; MATLAB's own have up to 63.
const MAX_NAME_BYTES: u64 = 256;

/// Most dimensions of an array.
const MAX_DIMENSIONS: u64 = 16;

/// Reads the array called `key`.
///
/// # Errors
/// [`MatError`] names the array, and what was expected of it.
pub(super) fn read_mat(mut file: impl Read, key: &str) -> Result<Numbers, MatError> {
    let big_endian = header(&mut file)?;
    let mut found = Vec::new();
    loop {
        let mut reader = Elements { file: &mut file, big_endian };
        let Some(tag) = reader.tag().map_err(|e| damaged("the file", e))? else { break };
        let mut part = (&mut file).take(tag.bytes);
        let variable = match tag.kind {
            MATRIX => variable(&mut part, big_endian, key)?,
            COMPRESSED => {
                let mut inflated = ZlibDecoder::new(&mut part);
                let mut reader = Elements { file: &mut inflated, big_endian };
                let inner = reader.tag().map_err(|e| damaged("a compressed variable", e))?;
                match inner {
                    Some(inner) if inner.kind == MATRIX => {
                        variable(&mut inflated.by_ref().take(inner.bytes), big_endian, key)?
                    }
                    _ => return Err(damaged("a compressed variable", "it holds no array")),
                }
            }
            _ => return Err(damaged("the file", format!("it holds an element of kind {}, no variable", tag.kind))),
        };
        match variable {
            Variable::Wanted(numbers) => return Ok(numbers),
            Variable::Other(name) => found.push(name),
        }
        io::copy(&mut part, &mut io::sink())?;
    }
    let found = if found.is_empty() { "nothing".to_owned() } else { found.join(", ") };
    Err(MatError::Missing { key: key.to_owned(), found })
}

fn damaged(what: &str, reason: impl ToString) -> MatError {
    MatError::Damaged { what: what.to_owned(), reason: reason.to_string() }
}

/// Reads the header and says whether numbers stand with their high byte first.
fn header(file: &mut impl Read) -> Result<bool, MatError> {
    let mut header = [0; HEADER_BYTES];
    file.read_exact(&mut header).map_err(|_| MatError::Header("it is shorter than the header"))?;
    if header.starts_with(b"MATLAB 7.3") || header.starts_with(b"\x89HDF") {
        return Err(MatError::Header("it is version 7.3, an HDF5 file; save it with the option -v7"));
    }
    match &header[124..] {
        [0, 1, b'I', b'M'] => Ok(false),
        [1, 0, b'M', b'I'] => Ok(true),
        _ => Err(MatError::Header(
            "its header ends in neither byte order; a file of version 4 can be saved with the option -v7",
        )),
    }
}

/// What stood under a name.
enum Variable {
    Wanted(Numbers),
    Other(String),
}

/// Reads flags, dimensions and name of a variable, and its numbers where it is the one called `key`.
fn variable(file: &mut dyn Read, big_endian: bool, key: &str) -> Result<Variable, MatError> {
    let mut reader = Elements { file, big_endian };
    let unnamed = |e| damaged("a variable", e);
    let flags = reader.element(8).map_err(unnamed)?;
    let dimensions = reader.element(4 * MAX_DIMENSIONS).map_err(unnamed)?;
    let name = reader.element(MAX_NAME_BYTES).map_err(unnamed)?;
    let name = String::from_utf8_lossy(&name.bytes).trim_end_matches('\0').to_owned();
    if name != key {
        return Ok(Variable::Other(name));
    }
    let what = format!("array \"{key}\"");
    let word = flags.bytes.first_chunk().map(|b| reader.word(*b)).ok_or_else(|| damaged(&what, "it has no flags"))?;
    if let Some(found) = no_numbers(word & 0xff) {
        return Err(MatError::Kind { key: name, found });
    }
    let shape: Vec<usize> =
        dimensions.bytes.chunks_exact(4).map(|b| reader.word([b[0], b[1], b[2], b[3]]) as usize).collect();
    let Some(count) = bounded_count(&shape) else { return Err(MatError::TooLarge { key: name, shape }) };
    let mut part = || reader.numbers(count).map_err(|e| damaged(&what, e));
    let column_major = |e: ShapeError| damaged(&what, e);
    let real = part()?;
    let is_complex = word & 0x800 != 0;
    let order = IxDyn(&shape).f();
    Ok(Variable::Wanted(if is_complex {
        let values = real.into_iter().zip(part()?).map(|(re, im)| Complex64::new(re, im)).collect();
        Numbers::Complex(ArrayD::from_shape_vec(order, values).map_err(column_major)?)
    } else {
        Numbers::Real(ArrayD::from_shape_vec(order, real).map_err(column_major)?)
    }))
}

/// What a class is where it is not made of numbers.
fn no_numbers(class: u32) -> Option<&'static str> {
    match class {
        6..=15 => None,
        1 => Some("a cell array"),
        2 => Some("a struct"),
        3 | 17 => Some("an object"),
        4 => Some("text"),
        5 => Some("a sparse matrix"),
        16 => Some("a function"),
        _ => Some("of an unknown class"),
    }
}

/// Kind and size of an element; small ones have their bytes in the tag.
struct Tag {
    kind: u32,
    bytes: u64,
    small: Option<[u8; 4]>,
}

/// An element's kind and bytes.
struct Element {
    kind: u32,
    bytes: Vec<u8>,
}

/// Elements one after another.
struct Elements<'a> {
    file: &'a mut dyn Read,
    big_endian: bool,
}

impl Elements<'_> {
    fn word(&self, bytes: [u8; 4]) -> u32 {
        if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }

    /// The next tag; `None` at the end.
    fn tag(&mut self) -> io::Result<Option<Tag>> {
        let mut words = [[0; 4]; 2];
        if self.file.read(&mut words[0][..1])? == 0 {
            return Ok(None);
        }
        self.file.read_exact(&mut words[0][1..])?;
        self.file.read_exact(&mut words[1])?;
        let [first, second] = words.map(|w| self.word(w));
        Ok(Some(match first >> 16 {
            0 => Tag { kind: first, bytes: second.into(), small: None },
            bytes => Tag { kind: first & 0xffff, bytes: bytes.into(), small: Some(words[1]) },
        }))
    }

    /// The next element, of at most `most` bytes.
    fn element(&mut self, most: u64) -> Result<Element, String> {
        let tag = self.tag().map_err(|e| e.to_string())?.ok_or("it ends too soon")?;
        if tag.bytes > most || (tag.small.is_some() && tag.bytes > 4) {
            return Err(format!("a part of it has {} bytes; expected at most {most}", tag.bytes));
        }
        if let Some(small) = tag.small {
            return Ok(Element { kind: tag.kind, bytes: small[..tag.bytes as usize].to_vec() });
        }
        let mut bytes = Vec::new();
        let padding = (8 - tag.bytes % 8) % 8;
        self.file.take(tag.bytes).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
        if bytes.len() as u64 != tag.bytes {
            return Err(format!("it ends {} bytes too soon", tag.bytes - bytes.len() as u64));
        }
        io::copy(&mut self.file.take(padding), &mut io::sink()).map_err(|e| e.to_string())?;
        Ok(Element { kind: tag.kind, bytes })
    }

    /// The next element as `count` numbers, in whatever type it is stored.
    fn numbers(&mut self, count: usize) -> Result<Vec<f64>, String> {
        let Element { kind, bytes } = self.element(8 * count as u64)?;
        let width = match kind {
            1 | 2 => 1,
            3 | 4 => 2,
            5..=7 => 4,
            9 | 12 | 13 => 8,
            _ => return Err(format!("its numbers are of kind {kind}; expected integers, single or double")),
        };
        if bytes.len() != width * count {
            return Err(format!("it has {} bytes of numbers; expected {}", bytes.len(), width * count));
        }
        Ok(bytes.chunks_exact(width).map(|b| number(kind, b, self.big_endian)).collect())
    }
}

/// One number of `kind` from its bytes.
fn number(kind: u32, bytes: &[u8], big_endian: bool) -> f64 {
    // Low byte first, so that the narrow types are the first bytes of the wide ones.
    let mut low_first = [0; 8];
    let width = bytes.len();
    low_first[..width].copy_from_slice(bytes);
    if big_endian {
        low_first[..width].reverse();
    }
    let word = u64::from_le_bytes(low_first);
    match kind {
        1 => f64::from(word as i8),
        3 => f64::from(word as i16),
        5 => f64::from(word as i32),
        7 => f64::from(f32::from_bits(word as u32)),
        9 => f64::from_bits(word),
        12 => word as i64 as f64,
        _ => word as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::{Compression, write::ZlibEncoder};
    use ndarray::array;
    use proptest::prelude::*;
    use std::io::Write;

    fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
        let mut out = [kind.to_le_bytes(), (bytes.len() as u32).to_le_bytes()].concat();
        out.extend_from_slice(bytes);
        out.resize(out.len().next_multiple_of(8), 0);
        out
    }

    /// One variable, as MATLAB writes it.
    fn variable(name: &str, class: u32, shape: &[i32], parts: &[(u32, Vec<u8>)]) -> Vec<u8> {
        let flags = class | if parts.len() == 2 { 0x800 } else { 0 };
        let shape: Vec<u8> = shape.iter().flat_map(|d| d.to_le_bytes()).collect();
        let mut body = element(6, &[flags.to_le_bytes(), [0; 4]].concat());
        body.extend(element(5, &shape));
        // Short names stand in the tag itself.
        let mut small = (1u32 | (name.len() as u32) << 16).to_le_bytes().to_vec();
        small.extend_from_slice(name.as_bytes());
        small.resize(8, 0);
        body.extend(if name.len() <= 4 { small } else { element(1, name.as_bytes()) });
        parts.iter().for_each(|(kind, bytes)| body.extend(element(*kind, bytes)));
        element(MATRIX, &body)
    }

    fn file(variables: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = vec![b' '; 124];
        bytes[..10].copy_from_slice(b"MATLAB 5.0");
        bytes.extend_from_slice(&[0, 1, b'I', b'M']);
        variables.iter().for_each(|v| bytes.extend(v));
        bytes
    }

    fn compressed(variable: &[u8]) -> Vec<u8> {
        let mut zip = ZlibEncoder::new(Vec::new(), Compression::default());
        zip.write_all(variable).unwrap();
        let zip = zip.finish().unwrap();
        [COMPRESSED.to_le_bytes().to_vec(), (zip.len() as u32).to_le_bytes().to_vec(), zip].concat()
    }

    fn doubles(values: &[f64]) -> (u32, Vec<u8>) {
        (9, values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    fn sample() -> Vec<u8> {
        let complex = variable("data", 6, &[1, 2], &[doubles(&[1.0, 2.0]), doubles(&[-1.0, 0.5])]);
        let narrow =
            variable("narrow", 6, &[2, 2], &[(3, [1i16, -2, 3, 4].iter().flat_map(|v| v.to_le_bytes()).collect())]);
        file(&[variable("text", 4, &[1, 1], &[(4, vec![65, 0])]), compressed(&complex), narrow])
    }

    #[test]
    fn every_number_format_is_read() {
        let complex = array![[Complex64::new(1.0, -1.0), Complex64::new(2.0, 0.5)]].into_dyn();
        assert_eq!(read_mat(sample().as_slice(), "data").unwrap(), Numbers::Complex(complex));
        let real = array![[1.0, 3.0], [-2.0, 4.0]].into_dyn();
        assert_eq!(read_mat(sample().as_slice(), "narrow").unwrap(), Numbers::Real(real), "columns first");
    }

    #[test]
    fn high_byte_first() {
        let swap = |words: &[u32]| words.iter().flat_map(|w| w.to_be_bytes()).collect::<Vec<u8>>();
        let body = [
            swap(&[6, 8, 6, 0, 5, 8, 1, 1, 1 | 1 << 16]),
            b"a\0\0\0".to_vec(),
            swap(&[9, 8]),
            1.5f64.to_be_bytes().to_vec(),
        ]
        .concat();
        let mut bytes = vec![b' '; 124];
        bytes.extend_from_slice(&[1, 0, b'M', b'I']);
        bytes.extend(swap(&[MATRIX, body.len() as u32]));
        bytes.extend(body);
        assert_eq!(read_mat(bytes.as_slice(), "a").unwrap(), Numbers::Real(array![[1.5]].into_dyn()));
    }

    #[test]
    fn faults_name_what_was_expected() {
        let told = |bytes: &[u8], key: &str, parts: [&str; 2]| {
            let message = read_mat(bytes, key).unwrap_err().to_string();
            assert!(parts.iter().all(|p| message.contains(p)), "{message}");
        };
        told(&sample(), "iq", ["\"iq\"", "text, data, narrow"]);
        told(&sample(), "text", ["\"text\" is text", "numbers"]);
        told(b"short", "a", ["version 5 or 7", "shorter"]);
        told(&[b'x'; 200], "a", ["version 5 or 7", "byte order"]);
        let mut new = sample();
        new[..10].copy_from_slice(b"MATLAB 7.3");
        told(&new, "a", ["HDF5", "-v7"]);
        told(&file(&[variable("a", 6, &[-1, -1], &[doubles(&[1.0])])]), "a", ["\"a\"", "at most"]);
        told(&file(&[variable("a", 6, &[1, 3], &[doubles(&[1.0])])]), "a", ["\"a\"", "expected 24"]);
        told(&file(&[variable("a", 6, &[1, 1], &[doubles(&[1.0, 2.0])])]), "a", ["\"a\"", "at most 8"]);
        told(&file(&[element(9, &[0; 8])]), "a", ["kind 9", "no variable"]);
        let whole = file(&[variable("a", 6, &[1, 1], &[doubles(&[1.0])])]);
        told(&whole[..whole.len() - 4], "a", ["\"a\"", "too soon"]);
    }

    #[test]
    fn what_inflates_without_end_takes_no_memory() {
        // 64 MiB of zeros behind an array that claims to be small.
        let mut bomb = variable("a", 6, &[1, 1], &[(9, vec![0; 64 << 20])]);
        bomb.truncate(64 << 20);
        let message = read_mat(file(&[compressed(&bomb)]).as_slice(), "a").unwrap_err().to_string();
        assert!(message.contains("at most 8"), "{message}");
    }

    proptest! {
        #[test]
        fn mutated_files_are_read_or_refused(at in 128usize..600, byte: u8, cut in 0usize..16) {
            let mut bytes = sample();
            let length = bytes.len();
            bytes[128 + at % (length - 128)] = byte;
            bytes.truncate(length - cut);
            for key in ["data", "narrow"] {
                if let Ok(numbers) = read_mat(bytes.as_slice(), key) {
                    prop_assert!(numbers.shape().iter().product::<usize>() <= 8, "no more numbers than bytes");
                }
            }
        }
    }
}
