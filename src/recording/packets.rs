//! Frames from the packets of a capture card: in order again, with zeros for lost packets, in bounded memory.
//!
//! A packet has 4 bytes of number, 6 of the count of bytes before it, and the data ("DCA1000EVM Data Capture Card", SPRUIJ4).

use std::collections::VecDeque;

/// Bytes before the data of a packet.
const HEADER_BYTES: usize = 10;
/// Longest data of a packet.
const MOST_DATA_BYTES: usize = 1 << 16;
/// Frames that may be open at once: packets of the next arrive before the last of this one.
const OPEN: usize = 2;
/// Number of bytes beyond a frame that end it, though some of it is missing: packets may be out of order by as much.
const REORDERED_BYTES: u64 = 64 * 1456;
/// Number of frames beyond the last from which a count of bytes is that of another capture.
const MOST_SKIPPED: u64 = 4096;

/// A frame of the capture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CardFrame {
    /// Its number, by the count of bytes.
    pub number: u64,
    /// Its bytes; those that are lost are zeros.
    pub bytes: Vec<u8>,
    /// Number of lost bytes.
    pub lost_bytes: u64,
}

/// Counts of packets, of losses and of new beginnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PacketCounts {
    /// Packets that were taken.
    pub packets: u64,
    /// Packets that are not a card's: shorter than the header, or longer than any.
    pub strange: u64,
    /// Packets of frames that were given away already, and packets that came twice.
    pub late: u64,
    /// Bytes of frames that were given away with zeros in their place.
    pub lost_bytes: u64,
    /// Frames of which no packet came.
    pub lost_frames: u64,
    /// Times that the count of bytes began anew.
    pub restarts: u64,
}

struct Open {
    frame: CardFrame,
    /// Parts that arrived, as ranges of bytes that don't touch, in order.
    parts: Vec<(usize, usize)>,
}

/// Puts packets together.
pub struct Packets {
    frame_bytes: usize,
    open: VecDeque<Open>,
    /// The frame after the last that was given away, once there was one.
    next: Option<u64>,
    counts: PacketCounts,
}

impl Packets {
    /// Packets of frames of `frame_bytes` bytes, at least one.
    pub fn new(frame_bytes: usize) -> Self {
        Packets { frame_bytes: frame_bytes.max(1), open: VecDeque::new(), next: None, counts: PacketCounts::default() }
    }

    /// Counts so far.
    pub fn counts(&self) -> PacketCounts {
        self.counts
    }

    /// Takes a packet, and returns the frames that are whole now or given up.
    pub fn take(&mut self, packet: &[u8]) -> Vec<CardFrame> {
        let Some((header, data)) = packet.split_at_checked(HEADER_BYTES).filter(|(_, d)| d.len() <= MOST_DATA_BYTES)
        else {
            self.counts.strange += 1;
            return Vec::new();
        };
        self.counts.packets += 1;
        let at = header[4..].iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b));
        let mut done = Vec::new();
        let number = at / self.frame_bytes as u64;
        let last = self.open.back().map(|open| open.frame.number).or(self.next);
        let begins_anew = at == 0 && (self.next.is_some() || last.is_some_and(|last| last > 0));
        if begins_anew || last.is_some_and(|last| number > last.saturating_add(MOST_SKIPPED)) {
            self.counts.restarts += 1;
            done.extend(self.finish());
            self.next = None;
        }
        let into = at % self.frame_bytes as u64;
        if self.next.is_none() && self.open.is_empty() && into > REORDERED_BYTES {
            // Packets before this one were never listened to: the next frame is the first.
            self.next = Some(number + 1);
        }
        self.place(at, data, &mut done);
        let behind = at.saturating_add(data.len() as u64).saturating_sub(REORDERED_BYTES);
        while let Some(first) = self.open.front() {
            let is_whole = first.parts.as_slice() == [(0, self.frame_bytes)];
            let end = (first.frame.number + 1) * self.frame_bytes as u64;
            if !is_whole && behind < end {
                break;
            }
            done.extend(self.give());
        }
        done
    }

    /// Gives the open frames away as they are.
    pub fn finish(&mut self) -> Vec<CardFrame> {
        std::iter::from_fn(|| self.give()).collect()
    }

    /// Puts data from byte `at` of the capture on into the frames that it belongs to.
    fn place(&mut self, at: u64, data: &[u8], done: &mut Vec<CardFrame>) {
        let (mut at, mut data) = (at, data);
        while !data.is_empty() {
            let size = self.frame_bytes as u64;
            let (number, offset) = (at / size, (at % size) as usize);
            let (part, rest) = data.split_at(data.len().min(self.frame_bytes - offset));
            if self.next.is_some_and(|next| number < next) {
                self.counts.late += 1;
            } else {
                self.put(number, offset, part, done);
            }
            (at, data) = (at + part.len() as u64, rest);
        }
    }

    fn put(&mut self, number: u64, offset: usize, part: &[u8], done: &mut Vec<CardFrame>) {
        let index = self.open.partition_point(|open| open.frame.number < number);
        if self.open.get(index).is_none_or(|open| open.frame.number != number) {
            let bytes = vec![0; self.frame_bytes];
            let frame = CardFrame { number, bytes, lost_bytes: 0 };
            self.open.insert(index, Open { frame, parts: Vec::new() });
        }
        let Some(open) = self.open.get_mut(index) else { return };
        open.frame.bytes[offset..offset + part.len()].copy_from_slice(part);
        if !join(&mut open.parts, (offset, offset + part.len())) {
            self.counts.late += 1;
        }
        while self.open.len() > OPEN {
            done.extend(self.give());
        }
    }

    /// The first open frame, with what is missing counted.
    fn give(&mut self) -> Option<CardFrame> {
        let Open { mut frame, parts } = self.open.pop_front()?;
        let there: usize = parts.iter().map(|(from, to)| to - from).sum();
        frame.lost_bytes = (self.frame_bytes - there) as u64;
        self.counts.lost_bytes += frame.lost_bytes;
        self.counts.lost_frames += self.next.map_or(0, |next| frame.number.saturating_sub(next));
        self.next = Some(frame.number + 1);
        Some(frame)
    }
}

/// Adds a range to ranges that don't touch; false where all of it was there.
fn join(parts: &mut Vec<(usize, usize)>, (from, to): (usize, usize)) -> bool {
    if parts.iter().any(|(a, b)| *a <= from && to <= *b) {
        return false;
    }
    let first = parts.partition_point(|(_, end)| *end < from);
    let last = parts.partition_point(|(start, _)| *start <= to);
    let touched = &parts[first..last];
    let joined = touched.iter().fold((from, to), |(a, b), (start, end)| (a.min(*start), b.max(*end)));
    parts.splice(first..last, [joined]);
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DATA: usize = 100;

    fn packet(index: usize, bytes: &[u8]) -> Vec<u8> {
        let at = index * DATA;
        let data = &bytes[at..(at + DATA).min(bytes.len())];
        [&(index as u32 + 1).to_le_bytes(), &(at as u64).to_le_bytes()[..6], data].concat()
    }

    fn capture(frames: usize, size: usize) -> Vec<u8> {
        (0..frames * size).map(|n| (n * 7 % 251 + 1) as u8).collect()
    }

    fn all(packets: &mut Packets, sent: impl IntoIterator<Item = Vec<u8>>) -> Vec<CardFrame> {
        let mut frames: Vec<CardFrame> = sent.into_iter().flat_map(|p| packets.take(&p)).collect();
        frames.extend(packets.finish());
        frames
    }

    #[test]
    fn packets_in_any_near_order_make_the_same_frames() {
        let bytes = capture(3, 950);
        let mut order: Vec<usize> = (0..29).collect();
        order.swap(3, 5);
        order.swap(9, 10);
        order.swap(18, 21);
        order.insert(14, 12);
        let mut packets = Packets::new(950);
        let frames = all(&mut packets, order.into_iter().map(|n| packet(n, &bytes)));
        let joined: Vec<u8> = frames.iter().flat_map(|f| f.bytes.clone()).collect();
        assert!(frames.len() == 3 && joined == bytes && frames.iter().all(|f| f.lost_bytes == 0));
        assert_eq!((packets.counts().packets, packets.counts().lost_bytes), (30, 0));
    }

    #[test]
    fn lost_packets_are_zeros_and_told() {
        let bytes = capture(4, 1000);
        let mut packets = Packets::new(1000);
        let kept = (0..40).filter(|n| *n != 12 && !(20..30).contains(n));
        let frames = all(&mut packets, kept.map(|n| packet(n, &bytes)));
        let told: Vec<(u64, u64)> = frames.iter().map(|f| (f.number, f.lost_bytes)).collect();
        assert_eq!(told, [(0, 0), (1, 100), (3, 0)]);
        assert!(frames[1].bytes[200..300].iter().all(|b| *b == 0) && frames[1].bytes[300] != 0);
        assert_eq!((packets.counts().lost_bytes, packets.counts().lost_frames), (100, 1));
    }

    #[test]
    fn a_card_that_starts_again_starts_again() {
        let bytes = capture(2, 300);
        let mut packets = Packets::new(300);
        let twice = (0..6).chain(0..6).map(|n| packet(n, &bytes));
        let frames = all(&mut packets, twice);
        assert_eq!(frames.iter().map(|f| f.number).collect::<Vec<_>>(), [0, 1, 0, 1]);
        assert_eq!((packets.counts().restarts, packets.take(&[1, 2, 3]).len(), packets.counts().strange), (1, 0, 1));
    }

    proptest! {
        #[test]
        fn any_packets_take_bounded_memory(sent in prop::collection::vec((any::<u64>(), 0usize..3000), 0..40)) {
            let mut packets = Packets::new(2000);
            for (at, length) in sent {
                let at = at >> (at % 48);
                let packet = [&[0; 4], &at.to_le_bytes()[..6], vec![1; length].as_slice()].concat();
                for frame in packets.take(&packet) {
                    prop_assert_eq!(frame.bytes.len(), 2000);
                }
                prop_assert!(packets.open.len() <= OPEN);
            }
        }
    }
}
