//! Frames of a `.cfg`: one kind of chirps that repeats, or sub-frames of several kinds.

use super::commands::Commands;
use super::lines::Line;
use super::{MOST_CHIRPS, MOST_LOOPS, missing};
use crate::recording::Fault;

/// Chirps that repeat.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    /// Numbers of the first and the last chirp.
    pub first: usize,
    pub last: usize,
    /// Number of times that the chirps repeat in a frame.
    pub loops: usize,
    /// Number of frames that are sent; 0 where they go on until stopped.
    pub frames: usize,
    /// Line of the file that defines the frame.
    pub line: usize,
}

/// The frames of the text: one, or the sub-frames in their order.
pub(super) fn frames(commands: &Commands<'_>) -> Result<Vec<Frame>, Fault> {
    match (commands.last("frameCfg"), commands.last("advFrameCfg")) {
        (Some(frame), None) => Ok(vec![plain(frame)?]),
        (_, Some(advanced)) => {
            let count = advanced.count(0, "the number of sub-frames", 4)?;
            let frames = advanced.count(2, "the number of frames", 1 << 24)?;
            let sub_frames: Vec<Frame> = commands
                .sub_frames
                .values()
                .take(count)
                .map(|line| sub_frame(line, frames))
                .collect::<Result<_, _>>()?;
            if sub_frames.is_empty() || sub_frames.len() < count {
                let found = sub_frames.len();
                return Err(
                    advanced.fault(format!("names {count} sub-frames, but {found} lines \"subFrameCfg\" stand there"))
                );
            }
            Ok(sub_frames)
        }
        (None, None) => Err(missing("frameCfg")),
    }
}

/// `frameCfg first last loops frames period trigger delay`.
fn plain(line: &Line<'_>) -> Result<Frame, Fault> {
    let (first, last) =
        (line.count(0, "the first chirp", MOST_CHIRPS - 1)?, line.count(1, "the last chirp", MOST_CHIRPS - 1)?);
    if last < first {
        return Err(line.fault(format!("its chirps run from {first} to {last}; expected them in rising order")));
    }
    let loops = line.count(2, "the number of loops", MOST_LOOPS)?;
    let frames = line.count(3, "the number of frames", 1 << 24)?;
    Ok(Frame { first, last, loops, frames, line: line.number })
}

/// `subFrameCfg number force first chirps loops period offset bursts burst-loops period`.
fn sub_frame(line: &Line<'_>, frames: usize) -> Result<Frame, Fault> {
    let first = line.count(2, "the first chirp", MOST_CHIRPS - 1)?;
    let chirps = line.count(3, "the number of chirps", MOST_CHIRPS - first)?;
    if chirps == 0 {
        return Err(line.fault("has no chirps"));
    }
    let loops = line.count(4, "the number of loops", MOST_LOOPS)?;
    let bursts = line.may_count(7, MOST_LOOPS).unwrap_or(1).max(1) * line.may_count(8, MOST_LOOPS).unwrap_or(1).max(1);
    let loops = loops.saturating_mul(bursts).min(MOST_LOOPS);
    Ok(Frame { first, last: first + chirps - 1, loops, frames, line: line.number })
}
