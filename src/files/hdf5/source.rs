//! The bytes of a file and of its headers. Each read is checked against the file's size.

use std::io::{self, Read, Seek, SeekFrom};

/// An error of reading an array.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum Hdf5Error {
    #[error("{0}")]
    Io(#[from] io::Error),
    #[error("not an HDF5 file; expected one as h5py or MATLAB (-v7.3) writes it")]
    Signature,
    /// The bytes contradict themselves or end too soon.
    #[error("the HDF5 file is damaged: {0}")]
    Damaged(&'static str),
    /// A way of storing that is not read.
    #[error("{0} is not read; expected it as h5py writes by itself, or as an .npz")]
    Unread(&'static str),
    #[error("has no array \"{key}\"; expected it beside what is there: {found}")]
    Missing { key: String, found: String },
    #[error("array \"{key}\" has shape {shape:?}; expected at most {most} numbers")]
    TooLarge { key: String, shape: Vec<usize>, most: usize },
}

/// The file, and the sizes of its addresses and lengths.
#[derive(Debug)]
pub struct Hdf5Bytes<R> {
    file: R,
    pub bytes: u64,
    /// Byte from which addresses count.
    pub base: u64,
    pub offset_bytes: usize,
    pub length_bytes: usize,
}

impl<R: Read + Seek> Hdf5Bytes<R> {
    /// The bytes of a whole file, with the usual sizes of addresses and lengths.
    pub fn new(mut file: R) -> Result<Self, Hdf5Error> {
        let bytes = file.seek(SeekFrom::End(0))?;
        Ok(Hdf5Bytes { file, bytes, base: 0, offset_bytes: 8, length_bytes: 8 })
    }

    pub fn read(&mut self, place: u64, count: u64) -> Result<Vec<u8>, Hdf5Error> {
        if place.checked_add(count).is_none_or(|end| end > self.bytes) {
            return Err(Hdf5Error::Damaged("it points beyond its end"));
        }
        let mut bytes = vec![0; count as usize];
        self.file.seek(SeekFrom::Start(place))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// Bytes at an address, which counts from the superblock's base.
    pub fn at(&mut self, address: u64, count: u64) -> Result<Vec<u8>, Hdf5Error> {
        self.read(address.checked_add(self.base).ok_or(Hdf5Error::Damaged("it points beyond its end"))?, count)
    }

    /// At most `most` bytes at an address: fewer where the file ends.
    pub fn up_to(&mut self, address: u64, most: u64) -> Result<Vec<u8>, Hdf5Error> {
        let there = self.bytes.saturating_sub(address.saturating_add(self.base));
        self.at(address, most.min(there))
    }
}

/// A part of the file that is read from its beginning.
#[derive(Clone, Copy)]
pub(super) struct HeaderBytes<'a> {
    pub rest: &'a [u8],
}

impl<'a> HeaderBytes<'a> {
    pub fn new(rest: &'a [u8]) -> Self {
        HeaderBytes { rest }
    }

    pub fn take(&mut self, count: usize) -> Result<&'a [u8], Hdf5Error> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(Hdf5Error::Damaged("a header ends too soon"))?;
        self.rest = rest;
        Ok(taken)
    }

    pub fn skip(&mut self, count: usize) -> Result<(), Hdf5Error> {
        self.take(count).map(|_| ())
    }

    pub fn byte(&mut self) -> Result<u8, Hdf5Error> {
        Ok(self.take(1)?[0])
    }

    /// A number of up to 8 bytes, low byte first.
    pub fn number(&mut self, bytes: usize) -> Result<u64, Hdf5Error> {
        Ok(self.take(bytes)?.iter().rev().fold(0, |n, b| n << 8 | u64::from(*b)))
    }

    pub fn word(&mut self) -> Result<usize, Hdf5Error> {
        Ok(self.number(4)? as usize)
    }

    pub fn half(&mut self) -> Result<usize, Hdf5Error> {
        Ok(self.number(2)? as usize)
    }

    /// The text up to the next zero.
    pub fn text(&mut self) -> Result<String, Hdf5Error> {
        let end = self.rest.iter().position(|b| *b == 0).ok_or(Hdf5Error::Damaged("a name has no end"))?;
        let name = String::from_utf8_lossy(self.take(end)?).into_owned();
        self.skip(1)?;
        Ok(name)
    }
}
