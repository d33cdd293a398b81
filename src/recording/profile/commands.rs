//! The commands of a `.cfg`, and the frames that they set: one frame, or several sub-frames.
//!
//! The last of several equal commands counts, as on the radar's command line.

use super::lines::{ConfigLine, MAX_CHIRPS, MAX_LOOPS, config_lines, missing};
use crate::recording::Fault;
use std::collections::BTreeMap;

/// A chirp by `chirpCfg`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ChirpLine {
    /// Number of the profile.
    pub profile: usize,
    /// Bit mask of the transmitters.
    pub transmitters: u32,
    pub line: usize,
    /// Name of its first change of frequency, slope or start that is not 0.
    pub differs: Option<&'static str>,
}

/// The commands of a file: `profileCfg` and `subFrameCfg` by number, each `bpmCfg`, and the chirp of each number.
#[derive(Default)]
pub(super) struct Commands<'a> {
    pub profiles: BTreeMap<usize, ConfigLine<'a>>,
    pub sub_frames: BTreeMap<usize, ConfigLine<'a>>,
    pub bpm_lines: Vec<ConfigLine<'a>>,
    pub chirps: Vec<Option<ChirpLine>>,
    /// The last line of each other command.
    others: BTreeMap<&'a str, ConfigLine<'a>>,
}

impl<'a> Commands<'a> {
    pub fn read(text: &'a str) -> Result<Self, Fault> {
        let mut all = Commands { chirps: vec![None; MAX_CHIRPS], ..Commands::default() };
        for line in config_lines(text) {
            all.take(line)?;
        }
        Ok(all)
    }

    /// The last line of a command other than those with a field.
    pub fn last(&self, command: &str) -> Option<&ConfigLine<'a>> {
        self.others.get(command)
    }

    fn take(&mut self, line: ConfigLine<'a>) -> Result<(), Fault> {
        match line.command {
            "flushCfg" => *self = Commands { chirps: vec![None; MAX_CHIRPS], ..Commands::default() },
            "profileCfg" => {
                self.profiles.insert(line.count(0, "the profile's number", MAX_CHIRPS)?, line);
            }
            "subFrameCfg" => {
                self.sub_frames.insert(line.count(0, "the sub-frame's number", 3)?, line);
            }
            "bpmCfg" => self.bpm_lines.push(line),
            "chirpCfg" => self.define_chirps(&line)?,
            other => _ = self.others.insert(other, line),
        }
        Ok(())
    }

    /// `chirpCfg start end profile dFrequency dSlope dIdle dAdcStart txMask`.
    fn define_chirps(&mut self, line: &ConfigLine<'_>) -> Result<(), Fault> {
        let (first, last) =
            (line.count(0, "the first chirp", MAX_CHIRPS - 1)?, line.count(1, "the last chirp", MAX_CHIRPS - 1)?);
        let profile = line.count(2, "the profile's number", MAX_CHIRPS)?;
        let mut differs = None;
        for (index, name) in
            [(3, "the change of frequency"), (4, "the change of slope"), (6, "the change of the ADC's start")]
        {
            if line.real(index, name)? != 0.0 {
                differs = differs.or(Some(name));
            }
        }
        let transmitters = line.count(7, "the mask of transmitters", 0xffff)? as u32;
        let chirp = ChirpLine { profile, transmitters, line: line.number, differs };
        self.chirps.iter_mut().take(last + 1).skip(first).for_each(|c| *c = Some(chirp));
        Ok(())
    }
}

/// A frame or a sub-frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    /// Numbers of the first and the last chirp.
    pub first: usize,
    pub last: usize,
    pub loops: usize,
    /// Number of frames; 0 for no limit.
    pub frames: usize,
    pub line: usize,
}

/// The frame of the text, or its sub-frames in order.
pub(super) fn frames(commands: &Commands<'_>) -> Result<Vec<Frame>, Fault> {
    match (commands.last("frameCfg"), commands.last("advFrameCfg")) {
        (Some(frame), None) => Ok(vec![frame_of(frame)?]),
        (_, Some(advanced)) => {
            let count = advanced.count(0, "the number of sub-frames", 4)?;
            let frames = advanced.count(2, "the number of frames", 1 << 24)?;
            let sub_frames: Vec<Frame> = commands
                .sub_frames
                .values()
                .take(count)
                .map(|line| sub_frame_of(line, frames))
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
fn frame_of(line: &ConfigLine<'_>) -> Result<Frame, Fault> {
    let (first, last) =
        (line.count(0, "the first chirp", MAX_CHIRPS - 1)?, line.count(1, "the last chirp", MAX_CHIRPS - 1)?);
    if last < first {
        return Err(line.fault(format!("its chirps run from {first} to {last}; expected them in rising order")));
    }
    let loops = line.count(2, "the number of loops", MAX_LOOPS)?;
    let frames = line.count(3, "the number of frames", 1 << 24)?;
    Ok(Frame { first, last, loops, frames, line: line.number })
}

/// `subFrameCfg number force first chirps loops period offset bursts burst-loops period`.
fn sub_frame_of(line: &ConfigLine<'_>, frames: usize) -> Result<Frame, Fault> {
    let first = line.count(2, "the first chirp", MAX_CHIRPS - 1)?;
    let chirps = line.count(3, "the number of chirps", MAX_CHIRPS - first)?;
    if chirps == 0 {
        return Err(line.fault("has no chirps"));
    }
    let loops = line.count(4, "the number of loops", MAX_LOOPS)?;
    let bursts =
        line.optional_count(7, MAX_LOOPS).unwrap_or(1).max(1) * line.optional_count(8, MAX_LOOPS).unwrap_or(1).max(1);
    let loops = loops.saturating_mul(bursts).min(MAX_LOOPS);
    Ok(Frame { first, last: first + chirps - 1, loops, frames, line: line.number })
}
