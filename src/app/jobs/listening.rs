//! The newest frame of a capture card as a recording, and the number of dropped frames.
//!
//! One thread takes packets, another reads frames as recordings. One frame can wait between the two, and one recording between the second and the window. A
//! newer frame replaces a waiting one.

use crate::app::state::{CardPlan, LiveFrame};
use crate::platform::{self, lock};
use crate::recording::card::{Card, CardSummary, FrameResponse};
use crate::recording::packets::CardFrame;
use crate::recording::raw::{self, boards};
use crate::recording::{Origin, Recording, RecordingError};
use eframe::egui::Context;
use std::io;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

/// Number of attempts to open a port that this program listened to a moment ago, and the time between two attempts.
const BIND_TRIES: u32 = 20;
const BIND_INTERVAL: Duration = Duration::from_millis(50);

pub struct Listening {
    wake: Context,
    running: Option<Running>,
    is_first: bool,
    summary: CardSummary,
    /// Frames that came between two calls of `poll` and were not the newest.
    passed_over: u64,
}

struct Running {
    plan: CardPlan,
    shared: Arc<Between>,
    recordings: Receiver<Result<Recording, String>>,
}

/// State shared by the threads and the window.
#[derive(Default)]
struct Between {
    held: Mutex<Waiting>,
    /// Notified of a frame and of the end.
    changed: Condvar,
}

#[derive(Default)]
struct Waiting {
    newest: Option<CardFrame>,
    summary: CardSummary,
    is_over: bool,
    failed: Option<String>,
}

impl Listening {
    /// Listens to no port yet; `wake` draws another frame of the window when the card's frame came.
    pub fn new(wake: Context) -> Self {
        Listening { wake, running: None, is_first: true, summary: CardSummary::default(), passed_over: 0 }
    }

    /// Begins to listen and ends any earlier listening. Returns the port.
    ///
    /// # Errors
    /// A sentence about the error in the `.cfg`, or about the port that is taken.
    pub fn begin(&mut self, plan: CardPlan) -> Result<u16, String> {
        let tries = if self.running.is_some() { BIND_TRIES } else { 0 };
        self.stop();
        let frame_bytes = raw::frame_bytes(&plan.config).map_err(|e| e.to_string())?;
        let failed = |e: io::Error| format!("UDP port {} can't be listened to: {e}", plan.port);
        let wanted = plan.port;
        let listen = move || Card::listen(wanted, frame_bytes);
        // The thread that has the port frees it soon; the new thread waits for that, not the window.
        let card = listen().map(Some).or_else(|e| if tries > 0 { Ok(None) } else { Err(e) }).map_err(failed)?;
        let port = card.as_ref().map_or(Ok(wanted), Card::port).map_err(failed)?;
        let shared = Arc::new(Between::default());
        let (sender, recordings) = sync_channel(1);
        let (of_card, wake) = (shared.clone(), platform::waker(&self.wake));
        let card = move || match card {
            Some(card) => Ok(card),
            None => (0..tries).fold(listen(), |card, _| {
                card.or_else(|_| {
                    std::thread::sleep(BIND_INTERVAL);
                    listen()
                })
            }),
        };
        platform::spawn("card", move || receive(card, &of_card, wake)).map_err(failed)?;
        let (of_frames, wake, read) = (shared.clone(), platform::waker(&self.wake), plan.clone());
        platform::spawn("card's frames", move || read_frames(&of_frames, &read, &sender, wake)).map_err(failed)?;
        (self.is_first, self.summary, self.passed_over) = (true, CardSummary::default(), 0);
        self.running = Some(Running { plan: CardPlan { port, ..plan }, shared, recordings });
        Ok(port)
    }

    pub fn stop(&mut self) {
        if let Some(running) = self.running.take() {
            running.shared.end(None);
        }
    }

    /// Port, `.cfg` and board in use, while listening.
    pub fn plan(&self) -> Option<&CardPlan> {
        self.running.as_ref().map(|running| &running.plan)
    }

    /// Counts of packets and frames since listening began.
    pub fn summary(&self) -> CardSummary {
        CardSummary { dropped: self.summary.dropped + self.passed_over, ..self.summary }
    }

    /// The newest frame since the last call, if any, and the reason why listening ended, if it did.
    pub fn poll(&mut self) -> (Option<LiveFrame>, Option<String>) {
        let Some(running) = &self.running else { return (None, None) };
        let failed = match running.shared.held.try_lock() {
            Ok(mut held) => {
                self.summary = held.summary;
                held.failed.take()
            }
            Err(_) => None,
        };
        let mut frame: Option<LiveFrame> = None;
        let mut failed = failed.map(|e| format!("UDP port {} is not listened to any more: {e}", running.plan.port));
        for read in running.recordings.try_iter() {
            match read {
                Ok(recording) => {
                    let config = running.plan.config.clone();
                    let recording = Arc::new(recording).into();
                    let is_first = std::mem::take(&mut self.is_first);
                    let before = frame.replace(LiveFrame { recording, config, is_first });
                    self.passed_over += u64::from(before.is_some());
                }
                Err(error) => failed = Some(format!("A frame of the capture card can't be read: {error}")),
            }
        }
        if failed.is_some() {
            self.stop();
        }
        (frame, failed)
    }
}

impl Drop for Listening {
    fn drop(&mut self) {
        self.stop();
    }
}

impl Between {
    /// Ends both threads.
    fn end(&self, failed: Option<String>) {
        let mut held = lock(&self.held);
        held.is_over = true;
        held.failed = held.failed.take().or(failed);
        self.changed.notify_all();
    }

    /// Waits for the newest frame; `None` at the end.
    fn next(&self) -> Option<CardFrame> {
        let held = lock(&self.held);
        let waits = |held: &mut Waiting| held.newest.is_none() && !held.is_over;
        let mut held = self.changed.wait_while(held, waits).unwrap_or_else(PoisonError::into_inner);
        if held.is_over { None } else { held.newest.take() }
    }
}

/// Takes packets until the end. The newest frame waits; a frame that it replaces is dropped.
fn receive(card: impl FnOnce() -> io::Result<Card>, shared: &Between, wake: impl Fn()) {
    let hand = |frame: CardFrame| {
        let before = lock(&shared.held).newest.replace(frame);
        shared.changed.notify_all();
        wake();
        if before.is_some() { FrameResponse::Dropped } else { FrameResponse::Taken }
    };
    let goes_on = |summary: &CardSummary| {
        let mut held = lock(&shared.held);
        held.summary = *summary;
        !held.is_over
    };
    if let Err(error) = card().and_then(|card| card.run(hand, goes_on)) {
        shared.end(Some(error.to_string()));
        wake();
    }
}

/// Reads frames as recordings until the end; waits until the window has taken the last.
fn read_frames(shared: &Between, plan: &CardPlan, sender: &SyncSender<Result<Recording, String>>, wake: impl Fn()) {
    let mut origin = None;
    while let Some(frame) = shared.next() {
        let recording = read(&mut origin, frame, plan).map_err(|e| e.to_string());
        let is_wrong = recording.is_err();
        if sender.send(recording).is_err() || is_wrong {
            break;
        }
        wake();
    }
    wake();
}

/// A frame as a recording, in the layout of the first frame.
fn read(origin: &mut Option<Origin>, frame: CardFrame, plan: &CardPlan) -> Result<Recording, RecordingError> {
    let of_first = match origin {
        Some(of_first) => of_first,
        None => {
            let board = plan.board.and_then(boards::by_name);
            origin.insert(raw::of_frame(frame.bytes.clone(), &plan.config, board)?.origin)
        }
    };
    let mut recording = of_first.recording_of(&frame.bytes)?;
    recording.name = format!("frame {}", frame.number);
    if frame.lost_bytes > 0 {
        recording.doubts.push(format!("{} bytes of frame {} were lost and are zeros.", frame.lost_bytes, frame.number));
    }
    // A frame has no file to read another way.
    let mut shown = of_first.clone();
    shown.offers.truncate(1);
    shown.offers.iter_mut().for_each(|offer| offer.power.clear());
    recording.origin = Some(Arc::new(shown));
    Ok(recording)
}

/// Whether a recording is a frame of a card listened to with this `.cfg`.
pub fn is_live(recording: &Recording, config: &Path) -> bool {
    recording.origin.as_ref().is_some_and(|origin| origin.data == raw::frame_path(config))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::platform::Instant;
    use crate::recording::card::tests::{replay, sent};

    /// 64 samples, four receivers, one transmitter, eight loops: 8 KiB a frame.
    const CFG: &str = "channelCfg 15 1 0\nadcCfg 2 1\nprofileCfg 0 77 10 6 60 0 0 50 1 64 4000 0 0 30\nchirpCfg 0 0 0 0 0 0 0 1\n\
                       frameCfg 0 0 8 0 100 1 0\n";
    const FRAME_BYTES: usize = 64 * 4 * 8 * 4;

    /// Frames of one echo, whose bin is ten more than the frame's number.
    fn frames(count: usize) -> Vec<u8> {
        let sample = |n: usize| {
            let (frame, place) = (n / (FRAME_BYTES / 4), n % 64);
            let turns = (10 + frame) as f64 * place as f64 / 64.0;
            let (im, re) = (std::f64::consts::TAU * turns).sin_cos();
            [(2000.0 * re) as i16, (2000.0 * im) as i16]
        };
        (0..count * FRAME_BYTES / 4).flat_map(sample).flat_map(i16::to_le_bytes).collect()
    }

    fn plan(folder: &Path, port: u16) -> CardPlan {
        let config = folder.join("a.cfg");
        std::fs::write(&config, CFG).unwrap();
        CardPlan { port, config, board: None }
    }

    /// The frames polled until `is_done` or for five seconds.
    fn polled(listening: &mut Listening, is_done: impl Fn(&Listening, &[LiveFrame]) -> bool) -> Vec<LiveFrame> {
        let (began, mut frames) = (Instant::now(), Vec::new());
        while !is_done(listening, &frames) && began.elapsed() < Duration::from_secs(5) {
            let (frame, failed) = listening.poll();
            assert_eq!(failed, None);
            frames.extend(frame);
            std::thread::sleep(Duration::from_millis(2));
        }
        frames
    }

    #[test]
    fn frames_of_a_replay_are_shown_as_they_come() {
        let folder = tempfile::tempdir().unwrap();
        let mut listening = Listening::new(Context::default());
        let port = listening.begin(plan(folder.path(), 0)).unwrap();
        let mut packets = sent(&frames(20));
        packets.swap(1, 2);
        // The 13th packet is lost: it lies within the third frame.
        packets.remove(12);
        let replay = replay(packets, port, Duration::from_millis(5), usize::MAX);
        let shown = polled(&mut listening, |l, _| l.summary().frames >= 19 && l.summary().packets.packets >= 112);
        replay.join().unwrap();
        let first = shown.first().unwrap();
        assert!(first.is_first && is_live(&first.recording, &first.config));
        assert!(first.recording.name.starts_with("frame "), "{}", first.recording.name);
        assert_eq!(first.recording.radar.samples, 64);
        assert!(shown[1..].iter().all(|frame| !frame.is_first));
        let doubted = shown.iter().any(|f| f.recording.doubts.iter().any(|d| d.contains("1456 bytes of frame 2")));
        assert!(doubted || listening.summary().dropped > 0, "{:?}", listening.summary());
        // A machine that is busy with other work may lose more.
        assert!(listening.summary().packets.lost_bytes >= 1456, "{:?}", listening.summary());
        listening.stop();
        assert!(listening.plan().is_none() && listening.poll() == (None, None));
    }

    #[test]
    fn a_window_that_is_busy_drops_frames_and_counts_them() {
        let folder = tempfile::tempdir().unwrap();
        let mut listening = Listening::new(Context::default());
        let port = listening.begin(plan(folder.path(), 0)).unwrap();
        // The socket holds half of the packets, should the receiver wait for a processor; the pause lets it take them.
        replay(sent(&frames(20)), port, Duration::from_micros(300), 56).join().unwrap();
        // Meanwhile the window took no frame: one recording waits for it, one for room in the channel, one to be read.
        std::thread::sleep(Duration::from_millis(300));
        let shown = polled(&mut listening, |_, shown| shown.last().is_some_and(|f| f.recording.name != "frame 0"));
        let summary = listening.summary();
        assert!(shown.len() <= 3 && summary.frames >= 19, "{summary:?}");
        assert!((summary.frames - 4..=summary.frames - 1).contains(&summary.dropped), "{summary:?}");
    }

    #[test]
    fn a_port_that_another_has_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let other = std::net::UdpSocket::bind((std::net::Ipv4Addr::UNSPECIFIED, 0)).unwrap();
        let port = other.local_addr().unwrap().port();
        let mut listening = Listening::new(Context::default());
        let refused = listening.begin(plan(folder.path(), port)).unwrap_err();
        assert!(refused.starts_with(&format!("UDP port {port} can't be listened to: ")), "{refused}");
        let missing = CardPlan { port: 0, config: folder.path().join("none.cfg"), board: None };
        assert!(listening.begin(missing).unwrap_err().contains("none.cfg"));
    }
}
