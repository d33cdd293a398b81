//! Reading of files line by line, with a limit to the length of a line.

use std::io::{self, BufRead, BufReader, Read};

/// Most rows that a file may have: they take some 1 GB.
pub const MAX_ROWS: usize = 2_000_000;
pub(super) const MAX_LINE_BYTES: usize = 64 << 10;

#[derive(Debug, thiserror::Error)]
#[error("line {line} is too long")]
pub(super) struct LongLine {
    /// Number of the line, from 1.
    pub line: u64,
}

/// A reader that passes on lines up to the limit and refuses longer ones, so that no file can ask for more memory than a line.
pub(super) struct ShortLines<R> {
    input: BufReader<R>,
    whole_only: bool,
    line: Vec<u8>,
    passed: usize,
    number: u64,
    /// Whether the last line had no end of line.
    pub is_cut: bool,
    /// Bytes of the lines with an end of line.
    pub whole_bytes: u64,
}

impl<R: Read> ShortLines<R> {
    /// Reads from `input`; `whole_only` leaves out a last line without an end.
    pub fn new(input: R, whole_only: bool) -> Self {
        let input = BufReader::new(input);
        ShortLines { input, whole_only, line: Vec::new(), passed: 0, number: 0, is_cut: false, whole_bytes: 0 }
    }

    fn next_line(&mut self) -> io::Result<()> {
        (self.line, self.passed, self.number) = (Vec::new(), 0, self.number + 1);
        let most = MAX_LINE_BYTES + 1;
        (&mut self.input).take(most as u64).read_until(b'\n', &mut self.line)?;
        match self.line.last() {
            None => {}
            Some(b'\n') => self.whole_bytes += self.line.len() as u64,
            Some(_) if self.line.len() == most => return Err(io::Error::other(LongLine { line: self.number })),
            Some(_) => {
                self.is_cut = true;
                if self.whole_only {
                    self.line.clear();
                }
            }
        }
        Ok(())
    }
}

impl<R: Read> Read for ShortLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.passed == self.line.len() && !self.is_cut {
            self.next_line()?;
        }
        let rest = &self.line[self.passed..];
        let read = rest.len().min(buffer.len());
        buffer[..read].copy_from_slice(&rest[..read]);
        self.passed += read;
        Ok(read)
    }
}
