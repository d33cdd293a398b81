//! Arrays of numbers in HDF5 files ("HDF5 File Format Specification", version 3.0), as h5py writes them and MATLAB (`.mat` 7.3): integers,
//! floating-point and complex numbers, in one piece or in chunks, compressed by deflate, in groups.
//!
//! Features of newer writers (version 4 of chunks, dense groups, other filters) are refused by name. A file is read by seeking, and no
//! memory is asked for before the size was compared with the file's or with the bound.
//!
//! `source` reads bytes, `object` headers of objects, `data` numbers.

mod data;
mod object;
mod source;
#[cfg(test)]
mod tests;

pub use source::Hdf5Error;

use super::{NumberKind, Numbers};
use ndarray::ArrayD;
use num_complex::Complex64;
use object::{Hdf5Object, MAX_OBJECTS};
use source::{Hdf5Bytes, HeaderBytes};
use std::io::{Read, Seek};

const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";
/// Possible places of a superblock: at the beginning, or behind a block of the writer's own.
const SUPERBLOCK_OFFSETS: [u64; 6] = [0, 512, 1024, 2048, 4096, 8192];
/// Depth to which groups are read.
const MAX_GROUP_DEPTH: usize = 8;

/// An HDF5 file.
#[derive(Debug)]
pub struct Hdf5<R> {
    source: Hdf5Bytes<R>,
    root: u64,
}

impl<R: Read + Seek> Hdf5<R> {
    /// Finds the superblock of `file`.
    /// # Errors
    /// [`Hdf5Error`] where there is none.
    pub fn open(file: R) -> Result<Self, Hdf5Error> {
        let mut source = Hdf5Bytes::new(file)?;
        for place in SUPERBLOCK_OFFSETS {
            if place + 8 <= source.bytes && source.read(place, 8)? == SIGNATURE {
                let root = superblock(&mut source, place)?;
                return Ok(Hdf5 { source, root });
            }
        }
        Err(Hdf5Error::Signature)
    }

    /// Names and shapes of all arrays of numbers; those in groups as `group.name`.
    pub fn shapes(&mut self) -> Result<Vec<(String, Vec<usize>)>, Hdf5Error> {
        Ok(self.arrays()?.into_iter().map(|(name, object)| (name, object.shape)).collect())
    }

    /// The numbers of the array called `key`, of at most `most` numbers.
    /// # Errors
    /// [`Hdf5Error`] names the array, and what was expected of it.
    pub fn values(&mut self, key: &str, most: usize) -> Result<Numbers, Hdf5Error> {
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
        let bytes = self.source.bytes_of(object, count, most)?;
        let fits = |_| Hdf5Error::Damaged("an array has fewer numbers than its shape");
        let all = bytes.chunks_exact(number.bytes);
        let value =
            |b: &[u8], (at, kind): &(usize, NumberKind)| b.get(*at..at + kind.bytes).map_or(0.0, |b| kind.value(b));
        Ok(match number.parts.as_slice() {
            [re, im] => {
                let all = all.map(|b| Complex64::new(value(b, re), value(b, im))).collect();
                Numbers::Complex(ArrayD::from_shape_vec(shape, all).map_err(fits)?)
            }
            parts => {
                let all = all.flat_map(|b| parts.iter().map(move |part| value(b, part))).collect();
                Numbers::Real(ArrayD::from_shape_vec(shape, all).map_err(fits)?)
            }
        })
    }

    /// The arrays of numbers in all groups.
    fn arrays(&mut self) -> Result<Vec<(String, Hdf5Object)>, Hdf5Error> {
        let mut waiting = vec![(String::new(), self.root, 0)];
        let mut seen = Vec::new();
        let mut all = Vec::new();
        while let Some((name, address, depth)) = waiting.pop() {
            if seen.contains(&address) || seen.len() > MAX_OBJECTS {
                continue;
            }
            seen.push(address);
            let mut object = self.source.object(address)?;
            let named = |child: &str| if name.is_empty() { child.to_owned() } else { format!("{name}.{child}") };
            if depth < MAX_GROUP_DEPTH {
                // MATLAB keeps the contents of cells in a group of its own.
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
}

/// Reads the superblock at `place`: the base of addresses, and the sizes of addresses and lengths. Returns the address of the root group.
fn superblock<R: Read + Seek>(source: &mut Hdf5Bytes<R>, place: u64) -> Result<u64, Hdf5Error> {
    let block = source.read(place, 128.min(source.bytes - place))?;
    let mut part = HeaderBytes::new(&block[8..]);
    let version = part.byte()?;
    let sizes = if version < 2 { 4 } else { 0 };
    part.skip(sizes)?;
    [source.offset_bytes, source.length_bytes] = [part.byte()?.into(), part.byte()?.into()];
    if ![source.offset_bytes, source.length_bytes].iter().all(|n| [2, 4, 8].contains(n)) {
        return Err(Hdf5Error::Damaged("its addresses have no usual size"));
    }
    let offset = source.offset_bytes;
    // Version 0 and 1: sizes of trees, three addresses and the name of the root group's entry stand before its address.
    let [before_base, before_root] = match version {
        0 => [9, 4 * offset],
        1 => [13, 4 * offset],
        2 | 3 => [1, 2 * offset],
        _ => return Err(Hdf5Error::Unread("a superblock of a newer version")),
    };
    part.skip(before_base)?;
    source.base = part.number(offset)?;
    part.skip(before_root)?;
    part.number(offset)
}
