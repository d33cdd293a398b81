//! A capture card on the network: packets to a port of this machine are assembled to frames. Not in a browser, which has no ports.

use super::packets::{CardFrame, FrameAssembler, PacketCounts};
use crate::platform::Instant;
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::net::{Ipv4Addr, UdpSocket};
use std::time::Duration;

/// The port that most capture cards send to.
pub const USUAL_PORT: u16 = 4098;

/// The caller's response to a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameResponse {
    /// The frame is processed.
    Taken,
    /// This frame, or an earlier one that waited, is not processed, since another was still being processed.
    Dropped,
    /// Reception ends.
    Ended,
}

/// Counts of frames and packets so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CardSummary {
    /// Frames received, dropped ones included.
    pub frames: u64,
    /// Frames received but not processed.
    pub dropped: u64,
    /// Counts of packets.
    pub packets: PacketCounts,
}

impl CardSummary {
    /// All counts as a sentence.
    pub fn sentence(&self) -> String {
        let PacketCounts { packets, malformed, late, lost_bytes, lost_frames, restarts } = self.packets;
        format!(
            "{} frames of {packets} packets; dropped, since the one before was still looked at: {}; bytes lost: {lost_bytes}; frames lost: \
             {lost_frames}; packets late or twice: {late}; no packets of a card: {malformed}; times the card began anew: {restarts}",
            self.frames, self.dropped
        )
    }
}

/// A socket on which a capture card's packets arrive, and the limits of reception.
#[derive(Debug)]
pub struct Card {
    socket: UdpSocket,
    /// Bytes of a frame.
    pub frame_bytes: usize,
    /// File to which every frame is written, with zeros for lost bytes.
    pub log: Option<File>,
    /// Frames after which reception ends.
    pub max_frames: Option<u64>,
    /// Time without a packet after which reception ends.
    pub silence: Option<Duration>,
}

impl Card {
    /// Listens on `port` of every address of this machine, or on a free one for 0.
    /// # Errors
    /// An error of the socket: another program may have the port.
    pub fn listen(port: u16, frame_bytes: usize) -> io::Result<Card> {
        let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, port))?;
        // `run` calls `goes_on` at least this often.
        socket.set_read_timeout(Some(Duration::from_millis(100)))?;
        Ok(Card { socket, frame_bytes, log: None, max_frames: None, silence: None })
    }

    /// The port that it listens on.
    /// # Errors
    /// An error of the socket.
    pub fn port(&self) -> io::Result<u16> {
        self.socket.local_addr().map(|address| address.port())
    }

    /// Receives packets until a limit is reached, or `take_frame` (each frame) or `goes_on` (the counts, ten times a second or more) ends it.
    /// # Errors
    /// An error of the socket or of the log file.
    pub fn run(
        mut self,
        mut take_frame: impl FnMut(CardFrame) -> FrameResponse,
        mut goes_on: impl FnMut(&CardSummary) -> bool,
    ) -> io::Result<CardSummary> {
        let mut assembler = FrameAssembler::new(self.frame_bytes);
        let mut summary = CardSummary::default();
        // No UDP packet is longer.
        let mut buffer = vec![0; 1 << 16];
        let mut last_packet = Instant::now();
        loop {
            let done = match self.socket.recv(&mut buffer) {
                Ok(length) => {
                    last_packet = Instant::now();
                    assembler.take(&buffer[..length])
                }
                Err(e) if [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&e.kind()) => Vec::new(),
                Err(e) => return Err(e),
            };
            let is_silent = self.silence.is_some_and(|silence| last_packet.elapsed() > silence);
            let rest = if is_silent { assembler.finish() } else { Vec::new() };
            for frame in done.into_iter().chain(rest) {
                self.write(&frame)?;
                summary.frames += 1;
                match take_frame(frame) {
                    FrameResponse::Taken => {}
                    FrameResponse::Dropped => summary.dropped += 1,
                    FrameResponse::Ended => return Ok(summary),
                }
            }
            summary.packets = assembler.counts();
            let is_enough = self.max_frames.is_some_and(|max| summary.frames >= max);
            if is_silent || is_enough || !goes_on(&summary) {
                return Ok(summary);
            }
        }
    }

    fn write(&mut self, frame: &CardFrame) -> io::Result<()> {
        let Some(log) = &mut self.log else { return Ok(()) };
        log.seek(SeekFrom::Start(frame.number * self.frame_bytes as u64))?;
        log.write_all(&frame.bytes)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    const FRAME_BYTES: usize = 40_000;
    const DATA_BYTES: usize = 1456;

    /// Packets of the card with `bytes` as their data.
    pub fn sent(bytes: &[u8]) -> Vec<Vec<u8>> {
        let packet = |(n, data): (usize, &[u8])| {
            [&(n as u32 + 1).to_le_bytes(), &((n * DATA_BYTES) as u64).to_le_bytes()[..6], data].concat()
        };
        bytes.chunks(DATA_BYTES).enumerate().map(packet).collect()
    }

    /// Sends packets to a port of this machine at intervals of `apart`, with a pause before packet `pause_at`.
    pub fn replay(packets: Vec<Vec<u8>>, port: u16, apart: Duration, pause_at: usize) -> std::thread::JoinHandle<()> {
        std::thread::spawn(move || {
            let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
            for (n, packet) in packets.iter().enumerate() {
                std::thread::sleep(if n == pause_at { Duration::from_millis(400) } else { apart });
                socket.send_to(packet, (Ipv4Addr::LOCALHOST, port)).unwrap();
            }
        })
    }

    #[test]
    fn a_replay_with_losses_and_a_pause_is_logged() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.bin");
        let bytes: Vec<u8> = (0..5 * FRAME_BYTES).map(|n| (n % 250 + 1) as u8).collect();
        let mut card = Card::listen(0, FRAME_BYTES).unwrap();
        card.log = Some(File::create(&path).unwrap());
        card.silence = Some(Duration::from_secs(60));
        card.max_frames = Some(5);
        let mut packets = sent(&bytes);
        packets.swap(3, 7);
        packets.swap(60, 62);
        // The 41st packet is lost: it lies within the second frame.
        packets.remove(40);
        let port = card.port().unwrap();
        // Each packet waits until the one before was taken: a machine that is busy with other work loses none.
        let (taken_one, wait) = std::sync::mpsc::channel();
        let replay = std::thread::spawn(move || {
            let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
            for (n, packet) in packets.iter().enumerate() {
                std::thread::sleep(Duration::from_millis(if n == 70 { 400 } else { 0 }));
                socket.send_to(packet, (Ipv4Addr::LOCALHOST, port)).unwrap();
                wait.recv_timeout(Duration::from_secs(60)).ok();
            }
        });
        let mut taken = Vec::new();
        // Two frames are processed; the others are dropped.
        let take = |frame: CardFrame| {
            taken.push((frame.number, frame.lost_bytes));
            if taken.len() > 2 { FrameResponse::Dropped } else { FrameResponse::Taken }
        };
        let goes_on = |_: &CardSummary| {
            taken_one.send(()).ok();
            true
        };
        let summary = card.run(take, goes_on).unwrap();
        drop(taken_one);
        replay.join().unwrap();
        assert_eq!((summary.frames, summary.dropped, summary.packets.lost_bytes), (5, 3, DATA_BYTES as u64));
        assert_eq!(taken[..2], [(0, 0), (1, DATA_BYTES as u64)]);
        let mut expected = bytes;
        expected[40 * DATA_BYTES..41 * DATA_BYTES].fill(0);
        assert!(std::fs::read(path).unwrap() == expected);
        assert!(summary.sentence().starts_with("5 frames of 137 packets"), "{}", summary.sentence());
    }
}
