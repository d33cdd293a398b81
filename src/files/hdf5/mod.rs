//! Arrays of numbers in HDF5 files ("HDF5 File Format Specification", version 3.0), as h5py writes them and MATLAB (`.mat` 7.3): integers,
//! floating-point and complex numbers, in one piece or in chunks, compressed by deflate, in groups.
//!
//! What newer writers may use instead (version 4 of chunks, dense groups, other filters) is told by name. A file is read by seeking, and no
//! memory is asked for before the size was compared with the file's or with the bound.
//!
//! `object` reads headers of objects, `data` reads numbers.

mod data;
mod object;
#[cfg(test)]
mod tests;

pub use data::half_value;

use ndarray::ArrayD;
use num_complex::Complex64;
use object::{Member, Object};
use std::io::{self, Read, Seek, SeekFrom};

const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";
/// Where a superblock may stand: at the beginning, or behind a block of the writer's own.
const PLACES: [u64; 6] = [0, 512, 1024, 2048, 4096, 8192];
/// Most objects that are looked at, and how deep groups are looked into.
const MOST_OBJECTS: usize = 1 << 14;
const MOST_DEPTH: usize = 8;
/// Most bytes of one part of a header.
const MOST_PART_BYTES: u64 = 1 << 20;

/// Why an array could not be read.
#[derive(Debug, thiserror::Error)]
pub enum Hdf5Error {
    /// The system could not read.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The file has no superblock.
    #[error("not an HDF5 file; expected one as h5py or MATLAB (-v7.3) writes it")]
    Signature,
    /// The bytes contradict themselves or end too soon.
    #[error("the HDF5 file is damaged: {0}")]
    Damaged(&'static str),
    /// A way of storing that is not read.
    #[error("{0} is not read; expected it as h5py writes by itself, or as an .npz")]
    Unread(&'static str),
    /// The file lacks the array.
    #[error("has no array \"{key}\"; expected it beside what is there: {found}")]
    Missing {
        /// The name asked for.
        key: String,
        /// The names the file has.
        found: String,
    },
    /// More numbers than are read.
    #[error("array \"{key}\" has shape {shape:?}; expected at most {most} numbers")]
    TooLarge {
        /// The name.
        key: String,
        /// Its shape.
        shape: Vec<usize>,
        /// Most numbers that are read.
        most: usize,
    },
}

/// Numbers of an array, in the order of its axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Hdf5Values {
    /// Real numbers or integers.
    Real(ArrayD<f64>),
    /// Complex numbers: compounds of two.
    Complex(ArrayD<Complex64>),
}

/// An HDF5 file.
#[derive(Debug)]
pub struct Hdf5<R> {
    file: R,
    bytes: u64,
    base: u64,
    offset_bytes: usize,
    length_bytes: usize,
    root: u64,
}

impl<R: Read + Seek> Hdf5<R> {
    /// Finds the superblock of `file`.
    ///
    /// # Errors
    /// [`Hdf5Error`] where there is none.
    pub fn open(mut file: R) -> Result<Self, Hdf5Error> {
        let bytes = file.seek(SeekFrom::End(0))?;
        let mut open = Hdf5 { file, bytes, base: 0, offset_bytes: 8, length_bytes: 8, root: 0 };
        for place in PLACES.into_iter().filter(|place| place + 8 <= bytes) {
            if open.read(place, 8)? == SIGNATURE {
                open.superblock(place)?;
                return Ok(open);
            }
        }
        Err(Hdf5Error::Signature)
    }

    fn superblock(&mut self, place: u64) -> Result<(), Hdf5Error> {
        let block = self.read(place, 128.min(self.bytes - place))?;
        let mut part = Part::new(&block[8..]);
        let version = part.byte()?;
        let sizes = if version < 2 { 4 } else { 0 };
        part.skip(sizes)?;
        [self.offset_bytes, self.length_bytes] = [part.byte()?.into(), part.byte()?.into()];
        if ![self.offset_bytes, self.length_bytes].iter().all(|n| [2, 4, 8].contains(n)) {
            return Err(Hdf5Error::Damaged("its addresses have no usual size"));
        }
        let offset = self.offset_bytes;
        // Version 0 and 1: sizes of trees, three addresses and the name of the root group's entry stand before its address.
        let [before_base, before_root] = match version {
            0 => [9, 4 * offset],
            1 => [13, 4 * offset],
            2 | 3 => [1, 2 * offset],
            _ => return Err(Hdf5Error::Unread("a superblock of a newer version")),
        };
        part.skip(before_base)?;
        self.base = part.number(offset)?;
        part.skip(before_root)?;
        self.root = part.number(offset)?;
        Ok(())
    }

    /// Names and shapes of all arrays of numbers; those in groups as `group.name`.
    ///
    /// # Errors
    /// [`Hdf5Error`].
    pub fn shapes(&mut self) -> Result<Vec<(String, Vec<usize>)>, Hdf5Error> {
        Ok(self.arrays()?.into_iter().map(|(name, object)| (name, object.shape)).collect())
    }

    /// The numbers of the array called `key`, of at most `most` numbers.
    ///
    /// # Errors
    /// [`Hdf5Error`] names the array, and what was expected of it.
    pub fn values(&mut self, key: &str, most: usize) -> Result<Hdf5Values, Hdf5Error> {
        let arrays = self.arrays()?;
        let Some((_, object)) = arrays.iter().find(|(name, _)| name == key) else {
            let found: Vec<&str> = arrays.iter().map(|(name, _)| name.as_str()).collect();
            let found = if found.is_empty() { "nothing".to_owned() } else { found.join(", ") };
            return Err(Hdf5Error::Missing { key: key.to_owned(), found });
        };
        let shape = object.shape.clone();
        let count = shape.iter().try_fold(1usize, |n, len| n.checked_mul(*len)).filter(|n| *n <= most);
        let Some(count) = count else { return Err(Hdf5Error::TooLarge { key: key.to_owned(), shape, most }) };
        let number = object.number.as_ref().ok_or(Hdf5Error::Unread("an array of something other than numbers"))?;
        let bytes = self.bytes_of(object, count, most)?;
        let fits = |_| Hdf5Error::Damaged("an array has fewer numbers than its shape");
        Ok(match number {
            Member::One(kind) => {
                let all = bytes.chunks_exact(kind.bytes).map(|b| kind.value(b)).collect();
                Hdf5Values::Real(ArrayD::from_shape_vec(shape, all).map_err(fits)?)
            }
            Member::Two { bytes: size, parts } => {
                let part = |b: &[u8], n: usize| {
                    let (at, kind) = &parts[n];
                    b.get(*at..at + kind.bytes).map_or(0.0, |b| kind.value(b))
                };
                let all = bytes.chunks_exact(*size).map(|b| Complex64::new(part(b, 0), part(b, 1))).collect();
                Hdf5Values::Complex(ArrayD::from_shape_vec(shape, all).map_err(fits)?)
            }
        })
    }

    /// The arrays of numbers in all groups.
    fn arrays(&mut self) -> Result<Vec<(String, Object)>, Hdf5Error> {
        let mut waiting = vec![(String::new(), self.root, 0)];
        let mut seen = Vec::new();
        let mut all = Vec::new();
        while let Some((name, address, depth)) = waiting.pop() {
            if seen.contains(&address) || seen.len() > MOST_OBJECTS {
                continue;
            }
            seen.push(address);
            let mut object = self.object(address)?;
            let named = |child: &str| if name.is_empty() { child.to_owned() } else { format!("{name}.{child}") };
            if depth < MOST_DEPTH {
                // MATLAB keeps what cells hold in a group of its own.
                let children = std::mem::take(&mut object.children);
                let told = children.into_iter().filter(|(child, _)| child != "#refs#" && child != "#subsystem#");
                waiting.extend(told.map(|(child, address)| (named(&child), address, depth + 1)));
            }
            if object.number.is_some() && !object.shape.is_empty() {
                all.push((name, object));
            }
        }
        all.sort_by(|a, b| a.0.cmp(&b.0));
        Ok(all)
    }

    /// Bytes of the file.
    fn read(&mut self, place: u64, count: u64) -> Result<Vec<u8>, Hdf5Error> {
        if place.checked_add(count).is_none_or(|end| end > self.bytes) {
            return Err(Hdf5Error::Damaged("it points beyond its end"));
        }
        let mut bytes = vec![0; count as usize];
        self.file.seek(SeekFrom::Start(place))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// Bytes at an address, which counts from the superblock's base.
    fn at(&mut self, address: u64, count: u64) -> Result<Vec<u8>, Hdf5Error> {
        self.read(address.checked_add(self.base).ok_or(Hdf5Error::Damaged("it points beyond its end"))?, count)
    }

    /// At most so many bytes at an address: fewer where the file ends.
    fn up_to(&mut self, address: u64, most: u64) -> Result<Vec<u8>, Hdf5Error> {
        let there = self.bytes.saturating_sub(address.saturating_add(self.base));
        self.at(address, most.min(there))
    }
}

/// A part of the file that is read from its beginning.
#[derive(Clone, Copy)]
struct Part<'a> {
    rest: &'a [u8],
}

impl<'a> Part<'a> {
    fn new(rest: &'a [u8]) -> Self {
        Part { rest }
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Hdf5Error> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(Hdf5Error::Damaged("a header ends too soon"))?;
        self.rest = rest;
        Ok(taken)
    }

    fn skip(&mut self, count: usize) -> Result<(), Hdf5Error> {
        self.take(count).map(|_| ())
    }

    fn byte(&mut self) -> Result<u8, Hdf5Error> {
        Ok(self.take(1)?[0])
    }

    /// A number of up to 8 bytes, low byte first.
    fn number(&mut self, bytes: usize) -> Result<u64, Hdf5Error> {
        Ok(self.take(bytes)?.iter().rev().fold(0, |n, b| n << 8 | u64::from(*b)))
    }

    fn word(&mut self) -> Result<usize, Hdf5Error> {
        Ok(self.number(4)? as usize)
    }

    fn half(&mut self) -> Result<usize, Hdf5Error> {
        Ok(self.number(2)? as usize)
    }

    /// The text up to the next zero.
    fn text(&mut self) -> Result<String, Hdf5Error> {
        let end = self.rest.iter().position(|b| *b == 0).ok_or(Hdf5Error::Damaged("a name has no end"))?;
        let name = String::from_utf8_lossy(self.take(end)?).into_owned();
        self.skip(1)?;
        Ok(name)
    }
}
