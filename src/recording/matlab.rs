//! MATLAB's `.mat` files, versions 5 and 7 ("MAT-File Format", The MathWorks): numeric arrays, real or complex, compressed or not,
//! by themselves, in structs or in cells.
//!
//! The crates that read them know no complex numbers (`mat5`) or inflate without a bound (`matfile`), so this reader is the
//! program's own. It reads forward only. Before it asks for memory, it compares a size with the file's other sizes.

use super::Fault;
use super::numbers::{MAX_NUMBERS, Numbers, bounded_count, too_large};
use crate::files::NumberKind;
use flate2::read::ZlibDecoder;
use ndarray::{ArrayD, Axis, IxDyn, ShapeBuilder, ShapeError, stack};
use num_complex::Complex64;
use std::fmt::Display;
use std::io::{self, Read};

const HEADER_BYTES: usize = 128;
const MATRIX: u32 = 14;
/// Classes of arrays that hold others.
const CELL: u32 = 1;
const STRUCT: u32 = 2;
const COMPRESSED: u32 = 15;

/// Longest name that is read, bytes; MATLAB's own have up to 63.
const MAX_NAME_BYTES: u64 = 256;

const MAX_DIMENSIONS: u64 = 16;

/// Longest text of a struct's field names, bytes; most cells that are frames of one array; and how deep structs are looked into.
const MAX_FIELD_BYTES: u64 = 1 << 16;
const MAX_CELLS: usize = 1 << 12;
const MAX_DEPTH: usize = 4;

/// Reads the array called `key`: a variable, a member of a struct (`radar.adcData`), or the cells of one, all of one shape, one after
/// another along a first axis.
///
/// # Errors
/// [`Fault`] names the array, and what was expected of it.
pub(super) fn read_mat(file: impl Read, key: &str) -> Result<Numbers, Fault> {
    let mut search = Search { want: Some(key), ..Search::default() };
    look_through(file, &mut search)?;
    let found = if search.names.is_empty() { "nothing".to_owned() } else { search.names.join(", ") };
    let message = || format!("has no array \"{key}\"; expected it beside what is there: {found}");
    search.wanted.ok_or_else(|| Fault::Data(message()))
}

/// Names and shapes of all arrays of numbers, those in structs and cells too.
///
/// # Errors
/// [`Fault`].
pub(super) fn shapes(file: impl Read) -> Result<Vec<(String, Vec<usize>)>, Fault> {
    let mut search = Search::default();
    look_through(file, &mut search)?;
    Ok(search.shapes)
}

/// The array that is looked for, and the names and shapes of the arrays read so far.
#[derive(Default)]
struct Search<'a> {
    want: Option<&'a str>,
    wanted: Option<Numbers>,
    names: Vec<String>,
    shapes: Vec<(String, Vec<usize>)>,
}

fn look_through(mut file: impl Read, search: &mut Search<'_>) -> Result<(), Fault> {
    let big_endian = header(&mut file)?;
    loop {
        let mut reader = Elements { file: &mut file, big_endian };
        let Some(tag) = reader.tag().map_err(|e| damaged("the file", e))? else { return Ok(()) };
        let mut part = (&mut file).take(tag.bytes);
        match tag.kind {
            MATRIX => matrix(&mut part, big_endian, None, 0, search)?,
            COMPRESSED => {
                let mut inflated = ZlibDecoder::new(&mut part);
                let mut reader = Elements { file: &mut inflated, big_endian };
                let inner = reader.tag().map_err(|e| damaged("a compressed variable", e))?;
                match inner {
                    Some(inner) if inner.kind == MATRIX => {
                        matrix(&mut inflated.by_ref().take(inner.bytes), big_endian, None, 0, search)?;
                    }
                    _ => return Err(damaged("a compressed variable", "it holds no array")),
                }
            }
            _ => return Err(damaged("the file", format!("it holds an element of kind {}, no variable", tag.kind))),
        }
        if search.wanted.is_some() {
            return Ok(());
        }
        io::copy(&mut part, &mut io::sink())?;
    }
}

fn damaged(what: &str, reason: impl Display) -> Fault {
    Fault::Data(format!("{what} can't be read: {reason}"))
}

fn no_numbers_in(key: &str, found: &str) -> Fault {
    Fault::Data(format!("\"{key}\" is {found}; expected an array of numbers"))
}

/// Reads the header and says whether numbers stand with their high byte first.
fn header(file: &mut impl Read) -> Result<bool, Fault> {
    let mut header = [0; HEADER_BYTES];
    let unlike = |reason: &str| Fault::Data(format!("not a MATLAB file of version 5 or 7 ({reason})"));
    file.read_exact(&mut header).map_err(|_| unlike("it is shorter than the header"))?;
    match &header[124..] {
        [0, 1, b'I', b'M'] => Ok(false),
        [1, 0, b'M', b'I'] => Ok(true),
        _ => Err(unlike("its header ends in neither byte order; a file of version 4 can be saved with the option -v7")),
    }
}

/// Reads flags, dimensions and name of an array, and its numbers where it is the one that is looked for. An array inside a struct or a cell has no
/// name of its own and is called `named`.
fn matrix(
    file: &mut dyn Read,
    big_endian: bool,
    named: Option<&str>,
    depth: usize,
    search: &mut Search<'_>,
) -> Result<(), Fault> {
    let mut reader = Elements { file, big_endian };
    let unnamed = |e| damaged("a variable", e);
    let flags = reader.element(8).map_err(unnamed)?;
    let dimensions = reader.element(4 * MAX_DIMENSIONS).map_err(unnamed)?;
    let own = reader.element(MAX_NAME_BYTES).map_err(unnamed)?;
    let own = String::from_utf8_lossy(&own.bytes).trim_end_matches('\0').to_owned();
    let name = named.map_or(own, str::to_owned);
    let what = format!("array \"{name}\"");
    let word = flags.bytes.first_chunk().map(|b| reader.word(*b)).ok_or_else(|| damaged(&what, "it has no flags"))?;
    let shape: Vec<usize> =
        dimensions.bytes.chunks_exact(4).map(|b| reader.word([b[0], b[1], b[2], b[3]]) as usize).collect();
    let is_wanted = search.want == Some(name.as_str());
    let one = shape.iter().all(|len| *len == 1);
    search.names.push(name.clone());
    match (word & 0xff, no_numbers(word & 0xff)) {
        (_, None) if is_wanted => search.wanted = Some(numbers_of(&mut reader, &name, shape, word & 0x800 != 0)?),
        (_, None) => search.shapes.push((name, shape)),
        (STRUCT, _) if one && !is_wanted && depth < MAX_DEPTH => fields(&mut reader, &name, depth, search)?,
        (CELL, _) if depth < MAX_DEPTH => cells(&mut reader, &name, &shape, depth, search)?,
        (_, Some(found)) if is_wanted => return Err(no_numbers_in(&name, found)),
        _ => {}
    }
    Ok(())
}

/// The numbers of an array of this shape.
fn numbers_of(reader: &mut Elements<'_>, name: &str, shape: Vec<usize>, is_complex: bool) -> Result<Numbers, Fault> {
    let what = format!("array \"{name}\"");
    let count = bounded_count(&shape).ok_or_else(|| too_large(&what, &shape))?;
    let mut part = || reader.numbers(count).map_err(|e| damaged(&what, e));
    let column_major = |e: ShapeError| damaged(&what, e);
    let real = part()?;
    let order = IxDyn(&shape).f();
    Ok(if is_complex {
        let values = real.into_iter().zip(part()?).map(|(re, im)| Complex64::new(re, im)).collect();
        Numbers::Complex(ArrayD::from_shape_vec(order, values).map_err(column_major)?)
    } else {
        Numbers::Real(ArrayD::from_shape_vec(order, real).map_err(column_major)?)
    })
}

/// The next array inside a struct or a cell.
fn inner(reader: &mut Elements<'_>, named: &str, depth: usize, search: &mut Search<'_>) -> Result<(), Fault> {
    let what = format!("\"{named}\"");
    let tag = reader.tag().map_err(|e| damaged(&what, e))?.filter(|tag| tag.kind == MATRIX);
    let tag = tag.ok_or_else(|| damaged(&what, "it ends too soon or holds no array"))?;
    let mut part = (&mut *reader.file).take(tag.bytes);
    if tag.bytes > 0 {
        matrix(&mut part, reader.big_endian, Some(named), depth + 1, search)?;
    }
    io::copy(&mut part, &mut io::sink())?;
    Ok(())
}

/// The members of a struct, as `name.member`.
fn fields(reader: &mut Elements<'_>, name: &str, depth: usize, search: &mut Search<'_>) -> Result<(), Fault> {
    let what = format!("struct \"{name}\"");
    let length = reader.element(8).map_err(|e| damaged(&what, e))?;
    let length = length.bytes.first_chunk().map_or(0, |b| reader.word(*b) as usize);
    let names = reader.element(MAX_FIELD_BYTES).map_err(|e| damaged(&what, e))?;
    if length == 0 {
        return Err(damaged(&what, "its members have no names"));
    }
    for field in names.bytes.chunks_exact(length) {
        let field = String::from_utf8_lossy(field);
        let end = field.find('\0').unwrap_or(field.len());
        inner(reader, &format!("{name}.{}", &field[..end]), depth, search)?;
        if search.wanted.is_some() {
            break;
        }
    }
    Ok(())
}

/// The cells of an array as one array: all of one shape, along a first axis.
fn cells(
    reader: &mut Elements<'_>,
    name: &str,
    shape: &[usize],
    depth: usize,
    search: &mut Search<'_>,
) -> Result<(), Fault> {
    let is_wanted = search.want == Some(name);
    let count = bounded_count(shape).filter(|count| *count <= MAX_CELLS).unwrap_or(0);
    let mut all: Vec<ArrayD<Complex64>> = Vec::new();
    let mut is_complex = false;
    let unlike = || no_numbers_in(name, "a cell array whose cells are no arrays of one shape");
    for n in 0..count {
        let mut one = Search { want: is_wanted.then_some(name), ..Search::default() };
        inner(reader, name, depth, &mut one)?;
        match one.wanted {
            None if is_wanted => return Err(unlike()),
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
        let joined = stack(Axis(0), &views).map_err(|_| unlike())?;
        search.wanted = Some(if is_complex { Numbers::Complex(joined) } else { Numbers::Real(joined.mapv(|v| v.re)) });
    }
    Ok(())
}

/// The kind of a class that is not made of numbers.
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

struct Element {
    kind: u32,
    bytes: Vec<u8>,
}

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

    /// The next element as `count` numbers, in any type.
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
        let (is_float, is_signed) = ([7, 9].contains(&kind), [1, 3, 5, 12].contains(&kind));
        let kind = NumberKind { bytes: width, is_float, is_signed, is_big: self.big_endian };
        Ok(bytes.chunks_exact(width).map(|b| kind.value(b)).collect())
    }
}

#[cfg(test)]
mod tests;
