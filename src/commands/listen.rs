//! `apertura listen`: frames of a capture card as they arrive over the network.

use super::input::{load_board, print_doubts};
use super::{CommandError, print};
use crate::reconstruct::found::reconstruct_and_find;
use crate::reconstruct::{IAA, NoisePrior, Request};
use crate::recording::packets::{CardFrame, PacketCounts, Packets};
use crate::recording::{Origin, raw};
use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};
use std::net::{Ipv4Addr, UdpSocket};
use std::path::PathBuf;
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

/// Listen to a capture card: its packets become frames, and of each the strongest echo is printed
///
/// PORT is the one of this machine that the card sends to (4098 for most). Packets are put in order again; those that are lost are zeros, and told.
/// A frame that arrives while two others wait to be looked at is dropped and counted: the card is never kept waiting, and memory stays bounded.
/// --log writes what the card sent, without the packets' headers, as a capture that `apertura import` reads.
///
/// It ends after --frames, or after --silence seconds without a packet, or with Ctrl-C.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// UDP port of this machine
    port: u16,

    /// The .cfg that set the radar up
    #[arg(long, value_name = "CFG")]
    config: PathBuf,

    /// The board that measures [default: as the transmitters of the .cfg make likely]
    #[arg(long, value_name = "xWR1642|xWR1443|xWR1843|xWR6843ISK|cascade")]
    board: Option<String>,

    /// Capture to write
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,

    /// End after so many frames
    #[arg(long, value_name = "N")]
    frames: Option<u64>,

    /// End after so many seconds without a packet
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u32).range(1..=86_400))]
    silence: Option<u32>,
}

/// Frames that wait to be looked at.
const WAITING: usize = 2;
/// Longest packet, bytes.
const PACKET_BYTES: usize = 1 << 16;
/// How often the end of a silence is looked for.
const PATIENCE: Duration = Duration::from_millis(100);

impl Args {
    /// Receives and tells until it is to end.
    pub fn run(self) -> Result<(), CommandError> {
        let board = self.board.as_deref().map(load_board).transpose()?;
        let frame_bytes = raw::frame_bytes(&self.config).map_err(CommandError::failed)?;
        let port = |source| CommandError::Usage(format!("port {}: {source}", self.port));
        let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, self.port)).map_err(port)?;
        let log = self
            .log
            .as_ref()
            .map(|path| File::create(path).map_err(|source| CommandError::File { path: path.clone(), source }));
        let log = log.transpose()?;
        print(&format!("listening on port {}, {frame_bytes} bytes a frame", self.port))?;
        let silence = self.silence.map(|s| Duration::from_secs(s.into()));
        let (sender, frames) = sync_channel(WAITING);
        let receiver = Receiver { socket, frame_bytes, log, most: self.frames, silence };
        let thread = std::thread::Builder::new().name("card".to_owned()).spawn(move || receiver.run(&sender));
        let thread = thread.map_err(|e| CommandError::Usage(format!("no thread: {e}")))?;
        let mut origin: Option<Origin> = None;
        for frame in frames {
            if origin.is_none() {
                let imported = raw::of_frame(frame.bytes.clone(), &self.config, board).map_err(CommandError::failed)?;
                imported.origin.sentences.iter().try_for_each(|sentence| print(sentence))?;
                print_doubts(&self.config, &imported.origin.doubts);
                origin = Some(imported.origin);
            }
            if let Some(origin) = &origin {
                print(&told(origin, &frame)?)?;
            }
        }
        let ended = thread.join().unwrap_or_else(|_| Err(io::Error::other("the receiving thread ended early")));
        print(&ended.map_err(|e| CommandError::Usage(format!("port {}: {e}", self.port)))?.sentence())
    }
}

/// A line on a frame: its strongest echo, and what it lacks.
fn told(origin: &Origin, frame: &CardFrame) -> Result<String, CommandError> {
    let recording = origin.recording_of(&frame.bytes).map_err(CommandError::failed)?;
    let request = Request { noise: NoisePrior::UNKNOWN, ..Request::default() };
    let found = reconstruct_and_find(&IAA, &recording.radar, &recording.two_ends(), &request);
    let echo = match found.as_ref().map(|(_, found)| found.first()) {
        Ok(Some(echo)) => format!("{:.2} m, cos θ {:.3}", echo.range_metres, echo.cos_theta),
        Ok(None) => "no echo".to_owned(),
        Err(error) => error.to_string(),
    };
    let lost = if frame.lost_bytes > 0 { format!(", {} bytes lost", frame.lost_bytes) } else { String::new() };
    Ok(format!("frame {}: {echo}{lost}", frame.number))
}

/// Takes packets off the network.
struct Receiver {
    socket: UdpSocket,
    frame_bytes: usize,
    log: Option<File>,
    /// Frames after which it ends.
    most: Option<u64>,
    silence: Option<Duration>,
}

/// What came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Summary {
    frames: u64,
    dropped: u64,
    packets: PacketCounts,
}

impl Summary {
    fn sentence(&self) -> String {
        let PacketCounts { packets, strange, late, lost_bytes, lost_frames, restarts } = self.packets;
        format!(
            "{} frames of {packets} packets; dropped, since the one before was still looked at: {}; bytes lost: {lost_bytes}; frames lost: \
             {lost_frames}; packets late or twice: {late}; no packets of a card: {strange}; times the card began anew: {restarts}",
            self.frames, self.dropped
        )
    }
}

impl Receiver {
    /// Receives until it is to end, or until the other side of `frames` is gone.
    fn run(mut self, frames: &SyncSender<CardFrame>) -> io::Result<Summary> {
        self.socket.set_read_timeout(Some(PATIENCE))?;
        let mut packets = Packets::new(self.frame_bytes);
        let mut summary = Summary::default();
        let mut buffer = vec![0; PACKET_BYTES];
        let mut heard = Instant::now();
        loop {
            let done = match self.socket.recv(&mut buffer) {
                Ok(length) => {
                    heard = Instant::now();
                    packets.take(&buffer[..length])
                }
                Err(e) if [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&e.kind()) => Vec::new(),
                Err(e) => return Err(e),
            };
            let is_silent = self.silence.is_some_and(|silence| heard.elapsed() > silence);
            let rest = if is_silent { packets.finish() } else { Vec::new() };
            for frame in done.into_iter().chain(rest) {
                self.write(&frame)?;
                summary.frames += 1;
                match frames.try_send(frame) {
                    Ok(()) => {}
                    Err(TrySendError::Full(_)) => summary.dropped += 1,
                    Err(TrySendError::Disconnected(_)) => return Ok(summary),
                }
            }
            summary.packets = packets.counts();
            if is_silent || self.most.is_some_and(|most| summary.frames >= most) {
                return Ok(summary);
            }
        }
    }

    /// Writes a frame at its place in the log: what is lost stays zeros.
    fn write(&mut self, frame: &CardFrame) -> io::Result<()> {
        let Some(log) = &mut self.log else { return Ok(()) };
        log.seek(SeekFrom::Start(frame.number * self.frame_bytes as u64))?;
        log.write_all(&frame.bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: usize = 40_000;
    const DATA: usize = 1456;

    fn sent(bytes: &[u8]) -> Vec<Vec<u8>> {
        let packet = |(n, data): (usize, &[u8])| {
            [&(n as u32 + 1).to_le_bytes(), &((n * DATA) as u64).to_le_bytes()[..6], data].concat()
        };
        bytes.chunks(DATA).enumerate().map(packet).collect()
    }

    #[test]
    fn a_replay_with_losses_and_a_pause_is_logged() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.bin");
        let bytes: Vec<u8> = (0..5 * FRAME).map(|n| (n % 250 + 1) as u8).collect();
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let to = socket.local_addr().unwrap();
        let mut packets = sent(&bytes);
        packets.swap(3, 7);
        packets.swap(60, 62);
        // The 41st packet is lost: it lies within the second frame.
        packets.remove(40);
        let replay = std::thread::spawn(move || {
            let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
            for (n, packet) in packets.iter().enumerate() {
                socket.send_to(packet, to).unwrap();
                std::thread::sleep(if n == 70 { Duration::from_millis(400) } else { Duration::from_micros(300) });
            }
        });
        let log = Some(File::create(&path).unwrap());
        let receiver = Receiver { socket, frame_bytes: FRAME, log, most: None, silence: Some(Duration::from_secs(1)) };
        // Two frames wait; the others are dropped, since none is taken.
        let (sender, frames) = sync_channel(WAITING);
        let summary = receiver.run(&sender).unwrap();
        replay.join().unwrap();
        drop(sender);
        assert_eq!((summary.frames, summary.dropped, summary.packets.lost_bytes), (5, 3, DATA as u64));
        assert_eq!(frames.iter().map(|f| (f.number, f.lost_bytes)).collect::<Vec<_>>(), [(0, 0), (1, DATA as u64)]);
        let mut expected = bytes;
        expected[40 * DATA..41 * DATA].fill(0);
        assert!(std::fs::read(path).unwrap() == expected);
        assert!(summary.sentence().starts_with("5 frames of 137 packets"), "{}", summary.sentence());
    }
}
