//! Several files that are read as one: the files of a split capture, and those of the chips of a cascade.

use std::io::{self, Read, Seek, SeekFrom};

pub(super) trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// A function that opens a data file by its name in the TOML.
pub(super) type Open<'a> = &'a dyn Fn(&str) -> io::Result<Box<dyn Source>>;

/// Opens `first` alone, or as one file with the `more` files that continue it, or with those of the other `chips` of a cascade.
pub(super) fn open_joined<T>(
    first: &T,
    more: &[T],
    chips: &[T],
    open: impl Fn(&T) -> io::Result<Box<dyn Source>>,
) -> io::Result<Box<dyn Source>> {
    if more.is_empty() && chips.is_empty() {
        return open(first);
    }
    let files = std::iter::once(first).chain(more).chain(chips).map(open).collect::<io::Result<_>>()?;
    Ok(if chips.is_empty() { Box::new(Chain::new(files)?) } else { Box::new(Chips::new(files)?) })
}

/// Files that are read one after another, with their sizes in bytes; `at` is the position in bytes.
struct Chain {
    files: Vec<(Box<dyn Source>, u64)>,
    at: u64,
}

impl Chain {
    fn new(files: Vec<Box<dyn Source>>) -> io::Result<Self> {
        let with_size = |mut file: Box<dyn Source>| file.seek(SeekFrom::End(0)).map(|bytes| (file, bytes));
        Ok(Chain { files: files.into_iter().map(with_size).collect::<io::Result<_>>()?, at: 0 })
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
        self.at = position_after(to, self.at, self.files.iter().map(|(_, bytes)| bytes).sum())?;
        Ok(self.at)
    }
}

fn position_after(to: SeekFrom, at: u64, bytes: u64) -> io::Result<u64> {
    let position = match to {
        SeekFrom::Start(at) => Some(at),
        SeekFrom::End(by) => bytes.checked_add_signed(by),
        SeekFrom::Current(by) => at.checked_add_signed(by),
    };
    position.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a place before the first byte"))
}

/// Bytes of a sample of the four receivers of a chip, in pairs of 16-bit words.
const CHIP_BYTES: u64 = 16;
/// Most samples of a chip that are read at once.
const MAX_READ_SAMPLES: u64 = 4096;

/// Files of a cascade's chips, four interleaved receivers each, as one of all receivers interleaved: `samples` a receiver, `at` in bytes.
struct Chips {
    files: Vec<Box<dyn Source>>,
    samples: u64,
    at: u64,
}

impl Chips {
    /// The files in the order of the receivers. All are cut to the length of the shortest.
    fn new(mut files: Vec<Box<dyn Source>>) -> io::Result<Self> {
        let sizes = files.iter_mut().map(|file| file.seek(SeekFrom::End(0))).collect::<io::Result<Vec<u64>>>()?;
        Ok(Chips { files, samples: sizes.into_iter().min().unwrap_or(0) / CHIP_BYTES, at: 0 })
    }

    fn sample_bytes(&self) -> u64 {
        CHIP_BYTES * self.files.len() as u64
    }
}

impl Read for Chips {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let size = self.sample_bytes();
        let wanted = (buffer.len() as u64).min((self.samples * size).saturating_sub(self.at));
        if wanted == 0 {
            return Ok(0);
        }
        let (first, within) = (self.at / size, self.at % size);
        let count = (within + wanted).div_ceil(size).min(MAX_READ_SAMPLES) as usize;
        let mut interleaved = vec![0; count * size as usize];
        let mut chip_bytes = vec![0; count * CHIP_BYTES as usize];
        for (chip, file) in self.files.iter_mut().enumerate() {
            file.seek(SeekFrom::Start(first * CHIP_BYTES))?;
            file.read_exact(&mut chip_bytes)?;
            let samples = interleaved.chunks_exact_mut(size as usize).zip(chip_bytes.chunks_exact(CHIP_BYTES as usize));
            samples.for_each(|(to, from)| to[chip * from.len()..][..from.len()].copy_from_slice(from));
        }
        let read = &interleaved[within as usize..];
        let read = &read[..read.len().min(wanted as usize)];
        buffer[..read.len()].copy_from_slice(read);
        self.at += read.len() as u64;
        Ok(read.len())
    }
}

impl Seek for Chips {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = position_after(to, self.at, self.samples * self.sample_bytes())?;
        Ok(self.at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn samples_of_chips_are_interleaved() {
        let file =
            |chip: u8| Box::new(Cursor::new((0..40).map(|n| 64 * chip + n).collect::<Vec<u8>>())) as Box<dyn Source>;
        let mut chips = Chips::new(vec![file(0), file(1), file(2)]).unwrap();
        // Two whole samples of each; the rest of 8 bytes is left out.
        assert_eq!(chips.seek(SeekFrom::End(0)).unwrap(), 96);
        let mut all = Vec::new();
        let _at = chips.seek(SeekFrom::Start(10)).unwrap();
        let read = chips.read_to_end(&mut all).unwrap();
        assert_eq!((read, all[0], all[6], all[22], all[38]), (86, 10, 64, 128, 16));
    }
}
