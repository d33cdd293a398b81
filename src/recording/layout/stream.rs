//! The bytes of a capture, read by seeking. Headers of network packets are left out, and lost packets are zeros.

use std::io::{self, Read, Seek, SeekFrom};

/// Bytes of a packet: 4 of number, 6 of the count of bytes before, then the data.
pub const PACKET_BYTES: u64 = HEADER_BYTES + DATA_BYTES;

/// Bytes before the data of a packet.
const HEADER_BYTES: u64 = 10;
const DATA_BYTES: u64 = 1456;

/// Packets at the beginning that must follow each other for a file to hold packets.
const LOOKED_AT: u64 = 16;

/// Bytes of a capture.
#[derive(Debug)]
pub struct Stream<R> {
    file: R,
    file_bytes: u64,
    packets: Option<Packets>,
}

#[derive(Debug, Clone, Copy)]
struct Packets {
    /// The count of the first packet.
    begins: u64,
    /// Number of packets in the file.
    count: u64,
    /// Bytes of data in all packets of the capture, lost ones included.
    bytes: u64,
}

impl<R: Read + Seek> Stream<R> {
    /// The bytes of `file`; it holds packets where its beginning says so.
    ///
    /// # Errors
    /// The error of the read or the seek.
    pub fn new(mut file: R) -> io::Result<Self> {
        let file_bytes = file.seek(SeekFrom::End(0))?;
        let mut stream = Stream { file, file_bytes, packets: None };
        stream.packets = stream.find_packets()?;
        Ok(stream)
    }

    /// The bytes of `file`, packets or not.
    ///
    /// # Errors
    /// The error of the seek.
    pub fn plain(mut file: R) -> io::Result<Self> {
        let file_bytes = file.seek(SeekFrom::End(0))?;
        Ok(Stream { file, file_bytes, packets: None })
    }

    /// Whether the file holds packets.
    pub fn has_packets(&self) -> bool {
        self.packets.is_some()
    }

    /// Bytes of data, lost ones counted.
    pub fn bytes(&self) -> u64 {
        self.packets.map_or(self.file_bytes, |p| p.bytes)
    }

    /// Packets that are gone from the whole file.
    pub fn lost_packets(&self) -> u64 {
        self.packets.map_or(0, |p| p.bytes.div_ceil(DATA_BYTES).saturating_sub(p.count))
    }

    /// Reads `buffer.len()` bytes from `offset` on. Lost packets and bytes behind the end are zeros.
    ///
    /// # Errors
    /// The error of the read or the seek.
    pub fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<()> {
        buffer.fill(0);
        match self.packets {
            None => self.read_file(offset, buffer),
            Some(packets) => self.read_packets(packets, offset, buffer),
        }
    }

    fn read_file(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<()> {
        let there = self.file_bytes.saturating_sub(offset).min(buffer.len() as u64) as usize;
        if there > 0 {
            self.file.seek(SeekFrom::Start(offset))?;
            self.file.read_exact(&mut buffer[..there])?;
        }
        Ok(())
    }

    /// Number of packet `index` of the file, and its count of bytes before.
    fn header(&mut self, index: u64) -> io::Result<Option<(u64, u64)>> {
        if (index * PACKET_BYTES).saturating_add(HEADER_BYTES) >= self.file_bytes {
            return Ok(None);
        }
        let mut header = [0u8; HEADER_BYTES as usize];
        self.read_file(index * PACKET_BYTES, &mut header)?;
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b));
        Ok(Some((number(&header[..4]), number(&header[4..]))))
    }

    fn find_packets(&mut self) -> io::Result<Option<Packets>> {
        let count = self.file_bytes.div_ceil(PACKET_BYTES);
        let Some((first_number, begins)) = self.header(0)? else { return Ok(None) };
        if count < 2 || begins % DATA_BYTES != 0 {
            return Ok(None);
        }
        let follows = |number: u64, at: u64| {
            let steps = number.wrapping_sub(first_number);
            at.checked_sub(begins) == steps.checked_mul(DATA_BYTES) && steps < 1 << 32
        };
        let mut last = (first_number, begins);
        for index in (1..count.min(LOOKED_AT)).chain([count - 1]) {
            match self.header(index)? {
                Some((number, at)) if follows(number, at) && number > first_number && number >= last.0 => {
                    last = (number, at)
                }
                None if index == count - 1 => {}
                _ => return Ok(None),
            }
        }
        // The last packet may be cut or hold less.
        let in_last = (self.file_bytes - (count - 1) * PACKET_BYTES).saturating_sub(HEADER_BYTES);
        let bytes = last.1 - begins + in_last;
        // A count of bytes far beyond the file's size is no capture with a few losses.
        Ok((bytes <= self.file_bytes.saturating_mul(4)).then_some(Packets { begins, count, bytes }))
    }

    fn read_packets(&mut self, packets: Packets, offset: u64, buffer: &mut [u8]) -> io::Result<()> {
        let end = offset + buffer.len() as u64;
        let mut index = self.packet_before(packets, offset)?;
        while let Some((_, at)) = self.header(index)?.filter(|_| index < packets.count) {
            let start = at.saturating_sub(packets.begins);
            if start >= end {
                break;
            }
            let held = (self.file_bytes - index * PACKET_BYTES - HEADER_BYTES).min(DATA_BYTES);
            let (from, to) = (start.max(offset), (start + held).min(end));
            if from < to {
                let place = (from - offset) as usize..(to - offset) as usize;
                let in_file = index * PACKET_BYTES + HEADER_BYTES + (from - start);
                let Some(part) = buffer.get_mut(place) else { break };
                self.file.seek(SeekFrom::Start(in_file))?;
                self.file.read_exact(part)?;
            }
            index += 1;
        }
        Ok(())
    }

    /// The last packet of the file that begins at `offset` or before it.
    fn packet_before(&mut self, packets: Packets, offset: u64) -> io::Result<u64> {
        let (mut low, mut high) = (0, packets.count.min(offset / DATA_BYTES + 1));
        while low + 1 < high {
            let middle = low.midpoint(high);
            let begins = self.header(middle)?.map_or(u64::MAX, |(_, at)| at.saturating_sub(packets.begins));
            if begins <= offset { low = middle } else { high = middle }
        }
        Ok(low)
    }
}
