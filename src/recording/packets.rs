//! Frames from the packets of a capture card: sorted, with zeros for lost packets, in bounded memory.
//!
//! A packet has 4 bytes of its number, 6 of the number of data bytes before it, and the data ("DCA1000EVM Data Capture Card", SPRUIJ4).

use std::collections::VecDeque;

/// Bytes before the data of a packet.
const HEADER_BYTES: usize = 10;
/// Longest data of a packet, bytes.
const MAX_DATA_BYTES: usize = 1 << 16;
/// Most frames that are open at once: packets of the next frame may arrive before the last of this one.
const MAX_OPEN_FRAMES: usize = 2;
/// Distance by which packets may be out of order, bytes: data farther behind the end of an incomplete frame closes it.
const MAX_REORDERED_BYTES: u64 = 64 * 1456;
/// Most frames between two packets of one capture: a packet farther ahead begins another.
const MAX_SKIPPED_FRAMES: u64 = 4096;

/// A frame of the capture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CardFrame {
    /// Index in the capture.
    pub number: u64,
    /// Data, with zeros in place of lost bytes.
    pub bytes: Vec<u8>,
    /// Number of lost bytes.
    pub lost_bytes: u64,
}

/// Counts of packets, losses and restarts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PacketCounts {
    /// Packets of a card.
    pub packets: u64,
    /// Packets that are shorter than the header or too long.
    pub malformed: u64,
    /// Packets of frames that were closed already, and packets received twice.
    pub late: u64,
    /// Missing bytes of closed frames.
    pub lost_bytes: u64,
    /// Frames without any packet.
    pub lost_frames: u64,
    /// Beginnings of another capture.
    pub restarts: u64,
}

struct OpenFrame {
    frame: CardFrame,
    /// Received ranges of bytes, sorted, with gaps between them.
    parts: Vec<(usize, usize)>,
}

/// Assembles packets to frames.
pub struct FrameAssembler {
    frame_bytes: usize,
    open: VecDeque<OpenFrame>,
    /// Number of the frame after the last closed one; `None` before the first.
    next: Option<u64>,
    counts: PacketCounts,
}

impl FrameAssembler {
    /// An assembler of frames of `frame_bytes` bytes; 0 is taken as 1.
    pub fn new(frame_bytes: usize) -> Self {
        FrameAssembler {
            frame_bytes: frame_bytes.max(1),
            open: VecDeque::new(),
            next: None,
            counts: PacketCounts::default(),
        }
    }

    /// Counts of the packets so far.
    pub fn counts(&self) -> PacketCounts {
        self.counts
    }

    /// Adds a packet, and returns the frames that it closes, complete or not.
    pub fn take(&mut self, packet: &[u8]) -> Vec<CardFrame> {
        let Some((header, data)) = packet.split_at_checked(HEADER_BYTES).filter(|(_, d)| d.len() <= MAX_DATA_BYTES)
        else {
            self.counts.malformed += 1;
            return Vec::new();
        };
        self.counts.packets += 1;
        let at = header[4..].iter().rev().fold(0u64, |n, b| n << 8 | u64::from(*b));
        let mut done = Vec::new();
        let number = at / self.frame_bytes as u64;
        let last = self.open.back().map(|open| open.frame.number).or(self.next);
        let begins_anew = at == 0 && (self.next.is_some() || last.is_some_and(|last| last > 0));
        if begins_anew || last.is_some_and(|last| number > last.saturating_add(MAX_SKIPPED_FRAMES)) {
            self.counts.restarts += 1;
            done.extend(self.finish());
            self.next = None;
        }
        let into = at % self.frame_bytes as u64;
        if self.next.is_none() && self.open.is_empty() && into > MAX_REORDERED_BYTES {
            // Reception began within this frame: the next one is the first.
            self.next = Some(number + 1);
        }
        self.add_data(at, data, &mut done);
        let settled_bytes = at.saturating_add(data.len() as u64).saturating_sub(MAX_REORDERED_BYTES);
        while let Some(first) = self.open.front() {
            let is_whole = first.parts.as_slice() == [(0, self.frame_bytes)];
            let end = (first.frame.number + 1) * self.frame_bytes as u64;
            if !is_whole && settled_bytes < end {
                break;
            }
            done.extend(self.close_first());
        }
        done
    }

    /// Closes and returns all open frames.
    pub fn finish(&mut self) -> Vec<CardFrame> {
        std::iter::from_fn(|| self.close_first()).collect()
    }

    /// Copies data from byte `at` of the capture on into its frames. `done` gets the frames that are closed.
    fn add_data(&mut self, at: u64, data: &[u8], done: &mut Vec<CardFrame>) {
        let (mut at, mut data) = (at, data);
        while !data.is_empty() {
            let size = self.frame_bytes as u64;
            let (number, offset) = (at / size, (at % size) as usize);
            let (part, rest) = data.split_at(data.len().min(self.frame_bytes - offset));
            if self.next.is_some_and(|next| number < next) {
                self.counts.late += 1;
            } else {
                self.add_part(number, offset, part, done);
            }
            (at, data) = (at + part.len() as u64, rest);
        }
    }

    fn add_part(&mut self, number: u64, offset: usize, part: &[u8], done: &mut Vec<CardFrame>) {
        let index = self.open.partition_point(|open| open.frame.number < number);
        if self.open.get(index).is_none_or(|open| open.frame.number != number) {
            let bytes = vec![0; self.frame_bytes];
            let frame = CardFrame { number, bytes, lost_bytes: 0 };
            self.open.insert(index, OpenFrame { frame, parts: Vec::new() });
        }
        let Some(open) = self.open.get_mut(index) else { return };
        open.frame.bytes[offset..offset + part.len()].copy_from_slice(part);
        if !join(&mut open.parts, (offset, offset + part.len())) {
            self.counts.late += 1;
        }
        while self.open.len() > MAX_OPEN_FRAMES {
            done.extend(self.close_first());
        }
    }

    /// Closes the first open frame, and counts its missing bytes and the missing frames before it.
    fn close_first(&mut self) -> Option<CardFrame> {
        let OpenFrame { mut frame, parts } = self.open.pop_front()?;
        let received: usize = parts.iter().map(|(from, to)| to - from).sum();
        frame.lost_bytes = (self.frame_bytes - received) as u64;
        self.counts.lost_bytes += frame.lost_bytes;
        self.counts.lost_frames += self.next.map_or(0, |next| frame.number.saturating_sub(next));
        self.next = Some(frame.number + 1);
        Some(frame)
    }
}

/// Adds a range to sorted ranges with gaps between them; false where they contain it already.
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

    fn all(assembler: &mut FrameAssembler, sent: impl IntoIterator<Item = Vec<u8>>) -> Vec<CardFrame> {
        let mut frames: Vec<CardFrame> = sent.into_iter().flat_map(|p| assembler.take(&p)).collect();
        frames.extend(assembler.finish());
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
        let mut assembler = FrameAssembler::new(950);
        let frames = all(&mut assembler, order.into_iter().map(|n| packet(n, &bytes)));
        let joined: Vec<u8> = frames.iter().flat_map(|f| f.bytes.clone()).collect();
        assert!(frames.len() == 3 && joined == bytes && frames.iter().all(|f| f.lost_bytes == 0));
        assert_eq!((assembler.counts().packets, assembler.counts().lost_bytes), (30, 0));
    }

    #[test]
    fn lost_packets_are_zeros_and_counted() {
        let bytes = capture(4, 1000);
        let mut assembler = FrameAssembler::new(1000);
        let kept = (0..40).filter(|n| *n != 12 && !(20..30).contains(n));
        let frames = all(&mut assembler, kept.map(|n| packet(n, &bytes)));
        let told: Vec<(u64, u64)> = frames.iter().map(|f| (f.number, f.lost_bytes)).collect();
        assert_eq!(told, [(0, 0), (1, 100), (3, 0)]);
        assert!(frames[1].bytes[200..300].iter().all(|b| *b == 0) && frames[1].bytes[300] != 0);
        assert_eq!((assembler.counts().lost_bytes, assembler.counts().lost_frames), (100, 1));
    }

    #[test]
    fn a_restarted_card_begins_at_frame_0() {
        let bytes = capture(2, 300);
        let mut assembler = FrameAssembler::new(300);
        let twice = (0..6).chain(0..6).map(|n| packet(n, &bytes));
        let frames = all(&mut assembler, twice);
        assert_eq!(frames.iter().map(|f| f.number).collect::<Vec<_>>(), [0, 1, 0, 1]);
        assert!(assembler.take(&[1, 2, 3]).is_empty());
        assert_eq!((assembler.counts().restarts, assembler.counts().malformed), (1, 1));
    }

    proptest! {
        #[test]
        fn any_packets_take_bounded_memory(sent in prop::collection::vec((any::<u64>(), 0usize..3000), 0..40)) {
            let mut assembler = FrameAssembler::new(2000);
            for (at, length) in sent {
                let at = at >> (at % 48);
                let packet = [&[0; 4], &at.to_le_bytes()[..6], vec![1; length].as_slice()].concat();
                for frame in assembler.take(&packet) {
                    prop_assert_eq!(frame.bytes.len(), 2000);
                }
                prop_assert!(assembler.open.len() <= MAX_OPEN_FRAMES);
            }
        }
    }
}
