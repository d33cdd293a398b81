//! `apertura listen`: frames of a capture card as they arrive over the network.

use super::input::{load_board, print_doubts};
use super::{CommandError, print};
use crate::reconstruct::found::reconstruct_and_find;
use crate::reconstruct::{IAA, NoisePrior, Request};
use crate::recording::card::{Card, FrameResponse};
use crate::recording::packets::CardFrame;
use crate::recording::{Origin, raw};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{TrySendError, sync_channel};
use std::time::Duration;

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

    /// Capture to write; no file with content is written over
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
const MAX_WAITING_FRAMES: usize = 2;

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let board = self.board.as_deref().map(load_board).transpose()?;
        let frame_bytes = raw::frame_bytes(&self.config)?;
        let failed = |source: io::Error| CommandError(format!("port {}: {source}", self.port));
        let mut card = Card::listen(self.port, frame_bytes).map_err(failed)?;
        card.log = self.log.as_deref().map(begin_log).transpose()?;
        card.max_frames = self.frames;
        card.silence = self.silence.map(|s| Duration::from_secs(s.into()));
        print(&format!("listening on port {}, {frame_bytes} bytes a frame", self.port))?;
        let (sender, frames) = sync_channel(MAX_WAITING_FRAMES);
        let hand = move |frame| match sender.try_send(frame) {
            Ok(()) => FrameResponse::Taken,
            Err(TrySendError::Full(_)) => FrameResponse::Dropped,
            Err(TrySendError::Disconnected(_)) => FrameResponse::Ended,
        };
        let thread = std::thread::Builder::new().name("card".to_owned()).spawn(move || card.run(hand, |_| true));
        let thread = thread.map_err(|e| CommandError(format!("no thread: {e}")))?;
        let mut origin: Option<Origin> = None;
        for frame in frames {
            if origin.is_none() {
                let imported = raw::of_frame(frame.bytes.clone(), &self.config, board)?;
                imported.origin.sentences.iter().try_for_each(|sentence| print(sentence))?;
                print_doubts(&self.config, &imported.origin.doubts);
                origin = Some(imported.origin);
            }
            if let Some(origin) = &origin {
                print(&told(origin, &frame)?)?;
            }
        }
        let ended = thread.join().unwrap_or_else(|_| Err(io::Error::other("the receiving thread ended early")));
        print(&ended.map_err(failed)?.sentence())
    }
}

/// Begins a log, but not over an earlier one: a measurement can't be made again.
fn begin_log(path: &Path) -> Result<File, CommandError> {
    if std::fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() > 0) {
        return Err(CommandError::on(path)("is there already; expected a new name for the log"));
    }
    File::create(path).map_err(CommandError::on(path))
}

/// A line on a frame: its strongest echo, and its lost bytes.
fn told(origin: &Origin, frame: &CardFrame) -> Result<String, CommandError> {
    let recording = origin.recording_of(&frame.bytes)?;
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
