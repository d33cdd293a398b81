//! MATLAB's `.mat` files, versions 5 and 7 ("MAT-File Format", The MathWorks): numeric arrays, real or complex, compressed or not,
//! by themselves, in structs or in cells.
//!
//! The crates for these files lack complex numbers (`mat5`) or inflate without a bound (`matfile`), so this reader is the program's own. It reads
//! forward only. Before it allocates memory, it compares a size with the file's other sizes.

use super::Fault;
use super::numbers::{MAX_NUMBERS, Numbers, bounded_count, too_large};
use crate::files::NumberKind;
use flate2::read::ZlibDecoder;
use ndarray::{ArrayD, Axis, IxDyn, ShapeBuilder, ShapeError, stack};
use num_complex::Complex64;
use std::fmt::Display;
use std::io::{self, Read};

const HEADER_BYTES: usize = 128;
/// Kinds of elements: an array (miMATRIX), and a compressed one (miCOMPRESSED).
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Classes of arrays that hold other arrays: mxCELL_CLASS and mxSTRUCT_CLASS.
const CELL: u32 = 1;
const STRUCT: u32 = 2;

/// Longest name of an array that is read, bytes; MATLAB's own names have up to 63.
const MAX_NAME_BYTES: u64 = 256;

const MAX_DIMENSIONS: u64 = 16;

/// Longest text of a struct's field names, bytes.
const MAX_FIELD_BYTES: u64 = 1 << 16;
/// Most cells that are joined to one array.
const MAX_CELLS: usize = 1 << 12;
/// Most levels of structs and cells that are searched.
const MAX_DEPTH: usize = 4;

/// Reads the array called `key`: a variable, a member of a struct (`radar.adcData`), or cells of one shape, stacked along a first axis.
pub(super) fn read_mat(file: impl Read, key: &str) -> Result<Numbers, Fault> {
    let mut search = Search { key: Some(key), ..Search::default() };
    read_variables(file, &mut search)?;
    let present = if search.names.is_empty() { "nothing".to_owned() } else { search.names.join(", ") };
    let message = || format!("has no array \"{key}\"; expected it beside what is there: {present}");
    search.found.ok_or_else(|| Fault::Data(message()))
}

/// Names and shapes of all arrays of numbers, those in structs and cells too.
pub(super) fn shapes(file: impl Read) -> Result<Vec<(String, Vec<usize>)>, Fault> {
    let mut search = Search::default();
    read_variables(file, &mut search)?;
    Ok(search.shapes)
}

/// A search for the array called `key`, or for the shapes of all arrays where there is no `key`.
#[derive(Default)]
struct Search<'a> {
    key: Option<&'a str>,
    found: Option<Numbers>,
    /// Names of all arrays read so far.
    names: Vec<String>,
    /// Names and shapes of the arrays of numbers read so far.
    shapes: Vec<(String, Vec<usize>)>,
}

/// Reads the variables of a file until the array is found.
fn read_variables(mut file: impl Read, search: &mut Search<'_>) -> Result<(), Fault> {
    let is_big_endian = read_header(&mut file)?;
    loop {
        let mut reader = Elements { file: &mut file, is_big_endian };
        let Some(tag) = reader.tag().map_err(|e| damaged("the file", e))? else { return Ok(()) };
        let mut part = (&mut file).take(tag.bytes);
        match tag.kind {
            MATRIX => read_matrix(&mut part, is_big_endian, None, 0, search)?,
            COMPRESSED => {
                let mut inflated = ZlibDecoder::new(&mut part);
                let mut reader = Elements { file: &mut inflated, is_big_endian };
                let inner = reader.tag().map_err(|e| damaged("a compressed variable", e))?;
                match inner {
                    Some(inner) if inner.kind == MATRIX => {
                        read_matrix(&mut inflated.by_ref().take(inner.bytes), is_big_endian, None, 0, search)?;
                    }
                    _ => return Err(damaged("a compressed variable", "it holds no array")),
                }
            }
            _ => return Err(damaged("the file", format!("it holds an element of kind {}, no variable", tag.kind))),
        }
        if search.found.is_some() {
            return Ok(());
        }
        io::copy(&mut part, &mut io::sink())?;
    }
}

/// The error of a damaged `subject`, such as `array "x"`.
fn damaged(subject: &str, reason: impl Display) -> Fault {
    Fault::Data(format!("{subject} can't be read: {reason}"))
}

/// The error of an array called `key` that is `found` instead of numbers.
fn not_numeric(key: &str, found: &str) -> Fault {
    Fault::Data(format!("\"{key}\" is {found}; expected an array of numbers"))
}

/// Reads the header. Returns whether numbers are big-endian.
fn read_header(file: &mut impl Read) -> Result<bool, Fault> {
    let mut header = [0; HEADER_BYTES];
    let other_format = |reason: &str| Fault::Data(format!("not a MATLAB file of version 5 or 7 ({reason})"));
    file.read_exact(&mut header).map_err(|_| other_format("it is shorter than the header"))?;
    match &header[124..] {
        [0, 1, b'I', b'M'] => Ok(false),
        [1, 0, b'M', b'I'] => Ok(true),
        _ => Err(other_format(
            "its header ends in neither byte order; a file of version 4 can be saved with the option -v7",
        )),
    }
}

/// Reads flags, dimensions and name of an array, and its numbers where it is the searched one. An array in a struct or a cell has no name of its own:
/// it gets the name `outer_name`. `depth` is the number of structs and cells around it.
fn read_matrix(
    file: &mut dyn Read,
    is_big_endian: bool,
    outer_name: Option<&str>,
    depth: usize,
    search: &mut Search<'_>,
) -> Result<(), Fault> {
    let mut reader = Elements { file, is_big_endian };
    let unnamed = |e| damaged("a variable", e);
    let flags = reader.element(8).map_err(unnamed)?;
    let dimensions = reader.element(4 * MAX_DIMENSIONS).map_err(unnamed)?;
    let own_name = reader.element(MAX_NAME_BYTES).map_err(unnamed)?;
    let own_name = String::from_utf8_lossy(&own_name.bytes).trim_end_matches('\0').to_owned();
    let name = outer_name.map_or(own_name, str::to_owned);
    let subject = format!("array \"{name}\"");
    let word =
        flags.bytes.first_chunk().map(|b| reader.word(*b)).ok_or_else(|| damaged(&subject, "it has no flags"))?;
    let shape: Vec<usize> =
        dimensions.bytes.chunks_exact(4).map(|b| reader.word([b[0], b[1], b[2], b[3]]) as usize).collect();
    let is_wanted = search.key == Some(name.as_str());
    let is_scalar = shape.iter().all(|len| *len == 1);
    search.names.push(name.clone());
    // The low byte of the flags is the class, bit 11 says that there are imaginary parts.
    match (word & 0xff, class_without_numbers(word & 0xff)) {
        (_, None) if is_wanted => search.found = Some(read_numbers(&mut reader, &name, shape, word & 0x800 != 0)?),
        (_, None) => search.shapes.push((name, shape)),
        (STRUCT, _) if is_scalar && !is_wanted && depth < MAX_DEPTH => read_members(&mut reader, &name, depth, search)?,
        (CELL, _) if depth < MAX_DEPTH => read_cells(&mut reader, &name, &shape, depth, search)?,
        (_, Some(found)) if is_wanted => return Err(not_numeric(&name, found)),
        _ => {}
    }
    Ok(())
}

/// Reads the numbers of an array of `shape`: all real parts, then all imaginary parts, both in column-major order.
fn read_numbers(reader: &mut Elements<'_>, name: &str, shape: Vec<usize>, is_complex: bool) -> Result<Numbers, Fault> {
    let subject = format!("array \"{name}\"");
    let count = bounded_count(&shape).ok_or_else(|| too_large(&subject, &shape))?;
    let mut part = || reader.numbers(count).map_err(|e| damaged(&subject, e));
    let column_major = |e: ShapeError| damaged(&subject, e);
    let real = part()?;
    let order = IxDyn(&shape).f();
    Ok(if is_complex {
        let values = real.into_iter().zip(part()?).map(|(re, im)| Complex64::new(re, im)).collect();
        Numbers::Complex(ArrayD::from_shape_vec(order, values).map_err(column_major)?)
    } else {
        Numbers::Real(ArrayD::from_shape_vec(order, real).map_err(column_major)?)
    })
}

/// Reads the next array in a struct or a cell, as an array called `name`.
fn read_inner(reader: &mut Elements<'_>, name: &str, depth: usize, search: &mut Search<'_>) -> Result<(), Fault> {
    let subject = format!("\"{name}\"");
    let tag = reader.tag().map_err(|e| damaged(&subject, e))?.filter(|tag| tag.kind == MATRIX);
    let tag = tag.ok_or_else(|| damaged(&subject, "it ends too soon or holds no array"))?;
    let mut part = (&mut *reader.file).take(tag.bytes);
    if tag.bytes > 0 {
        read_matrix(&mut part, reader.is_big_endian, Some(name), depth + 1, search)?;
    }
    io::copy(&mut part, &mut io::sink())?;
    Ok(())
}

/// Reads the members of a struct, as arrays called `name.member`.
fn read_members(reader: &mut Elements<'_>, name: &str, depth: usize, search: &mut Search<'_>) -> Result<(), Fault> {
    let subject = format!("struct \"{name}\"");
    let length = reader.element(8).map_err(|e| damaged(&subject, e))?;
    let length = length.bytes.first_chunk().map_or(0, |b| reader.word(*b) as usize);
    let names = reader.element(MAX_FIELD_BYTES).map_err(|e| damaged(&subject, e))?;
    if length == 0 {
        return Err(damaged(&subject, "its members have no names"));
    }
    for field in names.bytes.chunks_exact(length) {
        let field = String::from_utf8_lossy(field);
        let end = field.find('\0').unwrap_or(field.len());
        read_inner(reader, &format!("{name}.{}", &field[..end]), depth, search)?;
        if search.found.is_some() {
            break;
        }
    }
    Ok(())
}

/// Reads a cell array as one array: cells of one shape, stacked along a first axis. Of an array that is not searched, only the first cell is read.
fn read_cells(
    reader: &mut Elements<'_>,
    name: &str,
    shape: &[usize],
    depth: usize,
    search: &mut Search<'_>,
) -> Result<(), Fault> {
    let is_wanted = search.key == Some(name);
    let count = bounded_count(shape).filter(|count| *count <= MAX_CELLS).unwrap_or(0);
    let mut all: Vec<ArrayD<Complex64>> = Vec::new();
    let mut is_complex = false;
    let other_shapes = || not_numeric(name, "a cell array whose cells are no arrays of one shape");
    for n in 0..count {
        let mut one = Search { key: is_wanted.then_some(name), ..Search::default() };
        read_inner(reader, name, depth, &mut one)?;
        match one.found {
            None if is_wanted => return Err(other_shapes()),
            None => {
                let of_first = one.shapes.into_iter().next().filter(|_| n == 0);
                search.shapes.extend(of_first.map(|(_, inner)| (name.to_owned(), [vec![count], inner].concat())));
                return Ok(());
            }
            Some(Numbers::Real(values)) => all.push(values.mapv(Complex64::from)),
            Some(Numbers::Complex(values)) => {
                is_complex = true;
                all.push(values);
            }
        }
        let held = all[0].len().saturating_mul(count);
        if held > MAX_NUMBERS {
            return Err(too_large(&format!("array \"{name}\""), &[&[count], all[0].shape()].concat()));
        }
    }
    if is_wanted {
        let views: Vec<_> = all.iter().map(|a| a.view()).collect();
        let joined = stack(Axis(0), &views).map_err(|_| other_shapes())?;
        search.found = Some(if is_complex { Numbers::Complex(joined) } else { Numbers::Real(joined.mapv(|v| v.re)) });
    }
    Ok(())
}

/// A name of a class of arrays that are not made of numbers; `None` for a numeric class.
fn class_without_numbers(class: u32) -> Option<&'static str> {
    match class {
        // mxDOUBLE_CLASS to mxUINT64_CLASS.
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

/// The tag before an element's data.
struct Tag {
    /// Type of the data (miINT8 and so on).
    kind: u32,
    /// Length of the data.
    bytes: u64,
    /// The data of a small element, which has at most four bytes in the tag itself.
    inline: Option<[u8; 4]>,
}

struct Element {
    kind: u32,
    bytes: Vec<u8>,
}

struct Elements<'a> {
    file: &'a mut dyn Read,
    is_big_endian: bool,
}

impl Elements<'_> {
    fn word(&self, bytes: [u8; 4]) -> u32 {
        if self.is_big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }

    /// Reads the next tag; `None` at the end of the file.
    fn tag(&mut self) -> io::Result<Option<Tag>> {
        let mut words = [[0; 4]; 2];
        if self.file.read(&mut words[0][..1])? == 0 {
            return Ok(None);
        }
        self.file.read_exact(&mut words[0][1..])?;
        self.file.read_exact(&mut words[1])?;
        let [first, second] = words.map(|w| self.word(w));
        Ok(Some(match first >> 16 {
            0 => Tag { kind: first, bytes: second.into(), inline: None },
            bytes => Tag { kind: first & 0xffff, bytes: bytes.into(), inline: Some(words[1]) },
        }))
    }

    /// Reads the next element, of at most `max_bytes` bytes, and its padding.
    fn element(&mut self, max_bytes: u64) -> Result<Element, String> {
        let tag = self.tag().map_err(|e| e.to_string())?.ok_or("it ends too soon")?;
        if tag.bytes > max_bytes || (tag.inline.is_some() && tag.bytes > 4) {
            return Err(format!("a part of it has {} bytes; expected at most {max_bytes}", tag.bytes));
        }
        if let Some(inline) = tag.inline {
            return Ok(Element { kind: tag.kind, bytes: inline[..tag.bytes as usize].to_vec() });
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

    /// Reads the next element as `count` numbers of any type.
    fn numbers(&mut self, count: usize) -> Result<Vec<f64>, String> {
        let Element { kind, bytes } = self.element(8 * count as u64)?;
        // 1 to 7 are miINT8 to miSINGLE, 9 is miDOUBLE, 12 and 13 are miINT64 and miUINT64.
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
        let (is_float, is_signed) = ([7, 9].contains(&kind), [1, 3, 5, 12].contains(&kind));
        let kind = NumberKind { bytes: width, is_float, is_signed, is_big: self.is_big_endian };
        Ok(bytes.chunks_exact(width).map(|b| kind.value(b)).collect())
    }
}

#[cfg(test)]
mod tests;
