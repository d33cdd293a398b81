//! Counts, sizes and byte offsets of a capture, and its number of whole frames.

use super::table::Capture;
use crate::recording::Fault;
use crate::recording::axes::ChirpChoice;
use crate::recording::layout::{Layout, PartOrder};
use crate::recording::numbers::{MAX_NUMBERS, bounded_count};
use crate::recording::profile::RadarProfile;
use std::fmt::Display;

/// Most samples of a frame that are read; later loops are left out.
const MAX_FRAME_NUMBERS: usize = 1 << 23;
/// Largest count or header length of a capture.
const MAX_COUNT: usize = 1 << 16;

#[derive(Debug, Clone, PartialEq)]
/// Counts of a capture, and the bytes of the file that are read.
pub(in crate::recording) struct CapturePlan {
    pub layout: Layout,
    /// Samples of a chirp in the file.
    pub samples: usize,
    pub receivers: usize,
    pub chirps: usize,
    /// Loops that are read, of `all_loops` in a frame.
    pub loops: usize,
    /// Byte of the file at which the loops begin.
    pub start: u64,
    /// Number of whole frames in the file.
    pub frames: u64,
    pub all_loops: usize,
    pub notes: Vec<String>,
}

impl CapturePlan {
    pub fn new(capture: &Capture, profile: Option<&RadarProfile>, bytes: u64) -> Result<CapturePlan, Fault> {
        let layout = layout(capture)?;
        let [samples, receivers, chirps, all_loops] = counts(capture, profile)?;
        let lanes = layout.part_order.group();
        let numbers = bounded_count(&[chirps, receivers, samples])
            .ok_or_else(|| Fault::Data(format!("a loop holds more than {MAX_NUMBERS} numbers")))?;
        if !(samples * receivers).is_multiple_of(lanes) {
            let message =
                format!("{receivers} receivers of {samples} samples don't fill {lanes} lanes; expected a multiple");
            return Err(Fault::Data(message));
        }
        let header = layout.header_bytes.min(MAX_COUNT) as u64;
        let chirp_numbers = (samples * receivers) as u64;
        let size = |numbers: u64| numbers * layout.part_order.bytes() as u64 + numbers / chirp_numbers.max(1) * header;
        let loop_bytes = size(numbers as u64);
        let frame_numbers = profile.map_or(0, |p| p.frame_numbers as u64).max(numbers as u64 * all_loops as u64);
        let before = size(profile.map_or(0, |p| p.numbers_before as u64));
        let frame_bytes = size(frame_numbers);
        let mut plan = CapturePlan {
            layout,
            samples,
            receivers,
            chirps,
            loops: 0,
            start: 0,
            frames: bytes / frame_bytes,
            all_loops,
            notes: Vec::new(),
        };
        plan.select_loops(capture, bytes, [loop_bytes, frame_bytes, before])?;
        plan.note_size(bytes, frame_bytes, profile.map_or(0, |p| p.frames));
        if let ChirpChoice::Number(number) = capture.loop_choice
            && number >= plan.loops
        {
            return Err(unfit("loop", format!("is {number}"), &format!("0 to {}", plan.loops.saturating_sub(1))));
        }
        Ok(plan)
    }

    /// Selects the loops that are read of the chosen frame. `sizes` are bytes of a loop, of a frame, and of the sub-frames before.
    fn select_loops(&mut self, capture: &Capture, bytes: u64, sizes: [u64; 3]) -> Result<(), Fault> {
        let [loop_bytes, frame_bytes, before] = sizes;
        let file_loops = bytes.saturating_sub(before) / loop_bytes.max(1);
        if file_loops == 0 {
            let CapturePlan { chirps, receivers, samples, .. } = *self;
            let expected = before + loop_bytes;
            return Err(Fault::Data(format!(
                "has {bytes} bytes; expected at least {expected}: a loop has {chirps} chirps of {receivers} receivers and {samples} samples"
            )));
        }
        if capture.frame as u64 >= self.frames.max(1) {
            let last = self.frames.saturating_sub(1);
            let expected = format!("0 to {last}, the file holds {} frames", self.frames);
            return Err(unfit("frame", format!("is {}", capture.frame), &expected));
        }
        self.start = before + capture.frame as u64 * frame_bytes;
        let whole = if self.frames == 0 { file_loops.min(self.all_loops as u64) as usize } else { self.all_loops };
        let max_loops = MAX_FRAME_NUMBERS / (self.samples * self.receivers * self.chirps).max(1);
        self.loops = whole.min(max_loops.max(1));
        if self.loops < whole {
            self.notes.push(format!(
                "A frame has {whole} loops, more than are held at once: the first {} are read.",
                self.loops
            ));
        }
        Ok(())
    }

    /// Adds a note where the file holds other than whole frames, or other than the `.cfg`'s number of frames; 0 where that is unknown.
    fn note_size(&mut self, bytes: u64, frame_bytes: u64, config_frames: usize) {
        let rest = bytes % frame_bytes;
        let parts = |frames: u64| format!("{frames} whole frame{}", if frames == 1 { "" } else { "s" });
        match self.frames {
            0 => self.notes.push(format!(
                "The file is cut: it holds {bytes} of the {frame_bytes} bytes of a frame, of which {} whole loops are read.",
                self.loops
            )),
            frames if rest > 0 => self.notes.push(format!(
                "The file holds {} and {rest} bytes of another ({:.0} %), which are left out.",
                parts(frames),
                100.0 * rest as f64 / frame_bytes as f64
            )),
            frames if config_frames > 0 && frames != config_frames as u64 => {
                self.notes.push(format!("The file holds {}, not the {config_frames} that the .cfg asks for.", parts(frames)));
            }
            _ => {}
        }
    }

    /// The chirps that form the line of elements.
    pub fn chosen_chirps(&self, capture: &Capture) -> Result<Vec<usize>, Fault> {
        let last = self.chirps - 1;
        let found = match &capture.chirps {
            None if last == 0 => return Ok(vec![0]),
            None => "is missing".to_owned(),
            Some(chirps) if is_choice(chirps, last) => return Ok(chirps.clone()),
            Some(chirps) => format!("is {chirps:?}"),
        };
        let of = "the chirps of a loop that form the line of elements, in order";
        Err(unfit("chirps", found, &format!("some of 0 to {last}, each once: {of}")))
    }

    /// The receivers that form the line of elements: `receivers`, checked.
    pub fn chosen_receivers(&self, receivers: &[usize]) -> Result<Vec<usize>, Fault> {
        if is_choice(receivers, self.receivers - 1) {
            return Ok(receivers.to_vec());
        }
        let expected = "some of the receivers that are on, by place from 0, each once";
        Err(unfit("receivers_taken", format!("is {receivers:?}"), expected))
    }
}

fn unfit(key: &str, found: impl Display, expected: &str) -> Fault {
    Fault::Data(format!("recording.capture.{key} {found}; expected {expected}"))
}

/// Whether the numbers are from 0 to `last`, at least one, each once.
fn is_choice(numbers: &[usize], last: usize) -> bool {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    !sorted.is_empty() && sorted.len() == numbers.len() && sorted.iter().all(|n| *n <= last)
}

fn layout(capture: &Capture) -> Result<Layout, Fault> {
    let part_order = match (capture.part_order, capture.lanes) {
        (Some(part_order), None) => part_order,
        (None, Some(2)) => PartOrder::TwoLanes,
        (None, Some(4)) => PartOrder::FourLanes,
        (None, Some(lanes)) => return Err(unfit("lanes", format!("is {lanes}"), "2 or 4")),
        (None, None) => return Err(unfit("parts", "is missing", "one of lanes and parts")),
        (Some(_), Some(_)) => return Err(unfit("lanes", "stands beside parts", "one of lanes and parts")),
    };
    let Capture { encoding, q_first, receivers, header_bytes, .. } = *capture;
    if header_bytes > MAX_COUNT {
        return Err(unfit("header_bytes", format!("is {header_bytes}"), "at most 65536"));
    }
    Ok(Layout { encoding, part_order, q_first, receivers, header_bytes, packets: false })
}

/// Samples, receivers, chirps of a loop and loops of a frame.
fn counts(capture: &Capture, profile: Option<&RadarProfile>) -> Result<[usize; 4], Fault> {
    let Capture { samples, receiver_count, loop_chirps, loops, .. } = *capture;
    let keys =
        [("samples", samples), ("receiver_count", receiver_count), ("loop_chirps", loop_chirps), ("loops", loops)];
    if let Some(profile) = profile {
        if let Some((key, Some(value))) = keys.into_iter().find(|(_, value)| value.is_some()) {
            return Err(unfit(key, format!("is {value}"), "it not beside a .cfg, which says it"));
        }
        return Ok([profile.samples, profile.receivers, profile.chirp_transmitters.len(), profile.loops]);
    }
    let mut counts = [1; 4];
    for (count, (key, value)) in counts.iter_mut().zip(keys) {
        *count = match value {
            Some(value) if (1..=MAX_COUNT).contains(&value) => value,
            None if ["loop_chirps", "loops"].contains(&key) => 1,
            None => return Err(unfit(key, "is missing", "it where no .cfg says it")),
            Some(value) => return Err(unfit(key, format!("is {value}"), "a number from 1 to 65536")),
        };
    }
    Ok(counts)
}
