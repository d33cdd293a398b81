//! Files that are read as one.

use std::io::{self, Read, Seek, SeekFrom};

/// Something to read a data file from.
pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// Files that are read as one, one after another.
pub(super) struct Chain {
    files: Vec<(Box<dyn Source>, u64)>,
    at: u64,
}

impl Chain {
    /// The files in order.
    ///
    /// # Errors
    /// What the system says.
    pub fn new(files: Vec<Box<dyn Source>>) -> io::Result<Self> {
        let sized = |mut file: Box<dyn Source>| file.seek(SeekFrom::End(0)).map(|bytes| (file, bytes));
        Ok(Chain { files: files.into_iter().map(sized).collect::<io::Result<_>>()?, at: 0 })
    }
}

impl Read for Chain {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut start = 0;
        for (file, bytes) in &mut self.files {
            if self.at < start + *bytes {
                file.seek(SeekFrom::Start(self.at - start))?;
                let here = buffer.len().min((start + *bytes - self.at) as usize);
                let read = file.read(&mut buffer[..here])?;
                self.at += read as u64;
                return Ok(read);
            }
            start += *bytes;
        }
        Ok(0)
    }
}

impl Seek for Chain {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let all: u64 = self.files.iter().map(|(_, bytes)| bytes).sum();
        let place = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => all.checked_add_signed(by),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
        };
        self.at = place.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a place before the first byte"))?;
        Ok(self.at)
    }
}
