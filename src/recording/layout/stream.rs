//! The data bytes of a capture, read by seeking, without headers of network packets and with zeros for lost packets.

use std::io::{self, Read, Seek, SeekFrom};

/// Bytes of a packet: 4 of its number, 6 of the number of data bytes before it, then the data.
pub const PACKET_BYTES: u64 = HEADER_BYTES + DATA_BYTES;

/// Bytes before the data of a packet.
const HEADER_BYTES: u64 = 10;
const DATA_BYTES: u64 = 1456;

/// Number of packets at the beginning of a file whose headers are checked.
const CHECKED_PACKETS: u64 = 16;

/// The data bytes of a capture's file, which may hold network packets.
#[derive(Debug)]
pub struct CaptureStream<R> {
    file: R,
    file_bytes: u64,
    packets: Option<PacketSequence>,
}

#[derive(Debug, Clone, Copy)]
struct PacketSequence {
    /// Number of data bytes before the first packet, by its header.
    first_byte: u64,
    /// Number of packets in the file.
    count: u64,
    /// Bytes of data in all packets of the capture, lost ones included.
    bytes: u64,
}

impl<R: Read + Seek> CaptureStream<R> {
    /// The data of `file`, which holds packets where the headers at its beginning fit.
    /// # Errors
    /// The error of the read or the seek.
    pub fn new(mut file: R) -> io::Result<Self> {
        let file_bytes = file.seek(SeekFrom::End(0))?;
        let mut stream = CaptureStream { file, file_bytes, packets: None };
        stream.packets = stream.find_packets()?;
        Ok(stream)
    }

    /// The bytes of `file`, even if it holds packets.
    /// # Errors
    /// The error of the seek.
    pub fn plain(mut file: R) -> io::Result<Self> {
        let file_bytes = file.seek(SeekFrom::End(0))?;
        Ok(CaptureStream { file, file_bytes, packets: None })
    }

    /// Whether the file holds packets.
    pub fn has_packets(&self) -> bool {
        self.packets.is_some()
    }

    /// Number of data bytes, lost ones included.
    pub fn bytes(&self) -> u64 {
        self.packets.map_or(self.file_bytes, |p| p.bytes)
    }

    /// Number of lost packets.
    pub fn lost_packets(&self) -> u64 {
        self.packets.map_or(0, |p| p.bytes.div_ceil(DATA_BYTES).saturating_sub(p.count))
    }

    /// Reads `buffer.len()` data bytes from `offset` on. Lost packets and bytes after the end are zeros.
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

    /// Header of packet `index` of the file: its number and the number of data bytes before it. `None` after the last packet.
    fn header(&mut self, index: u64) -> io::Result<Option<(u64, u64)>> {
        if (index * PACKET_BYTES).saturating_add(HEADER_BYTES) >= self.file_bytes {
            return Ok(None);
        }
        let mut header = [0u8; HEADER_BYTES as usize];
        self.read_file(index * PACKET_BYTES, &mut header)?;
        let number = |bytes: &[u8]| bytes.iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b));
        Ok(Some((number(&header[..4]), number(&header[4..]))))
    }

    fn find_packets(&mut self) -> io::Result<Option<PacketSequence>> {
        let count = self.file_bytes.div_ceil(PACKET_BYTES);
        let Some((first_number, first_byte)) = self.header(0)? else { return Ok(None) };
        if count < 2 || first_byte % DATA_BYTES != 0 {
            return Ok(None);
        }
        let follows = |number: u64, at: u64| {
            let steps = number.wrapping_sub(first_number);
            at.checked_sub(first_byte) == steps.checked_mul(DATA_BYTES) && steps < 1 << 32
        };
        let mut last = (first_number, first_byte);
        for index in (1..count.min(CHECKED_PACKETS)).chain([count - 1]) {
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
        let bytes = last.1 - first_byte + in_last;
        // A capture with most packets lost is more likely no file of packets.
        Ok((bytes <= self.file_bytes.saturating_mul(4)).then_some(PacketSequence { first_byte, count, bytes }))
    }

    fn read_packets(&mut self, packets: PacketSequence, offset: u64, buffer: &mut [u8]) -> io::Result<()> {
        let end = offset + buffer.len() as u64;
        let mut index = self.packet_before(packets, offset)?;
        while let Some((_, at)) = self.header(index)?.filter(|_| index < packets.count) {
            let start = at.saturating_sub(packets.first_byte);
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
    fn packet_before(&mut self, packets: PacketSequence, offset: u64) -> io::Result<u64> {
        let (mut low, mut high) = (0, packets.count.min(offset / DATA_BYTES + 1));
        while low + 1 < high {
            let middle = low.midpoint(high);
            let begins = self.header(middle)?.map_or(u64::MAX, |(_, at)| at.saturating_sub(packets.first_byte));
            if begins <= offset { low = middle } else { high = middle }
        }
        Ok(low)
    }
}
