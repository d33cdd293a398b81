//! The commands of a `.cfg` that are read. The last of several equal commands holds, as on the radar's command line.

use super::MOST_CHIRPS;
use super::lines::{Line, lines};
use crate::recording::Fault;
use std::collections::BTreeMap;

/// A chirp of a `chirpCfg`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ChirpLine {
    /// Number of its profile.
    pub profile: usize,
    /// Its transmitters, as bits.
    pub transmitters: u32,
    /// Line of the file that defines the chirp.
    pub line: usize,
    /// The name of its first change of frequency, slope or start that is not 0.
    pub differs: Option<&'static str>,
}

/// The commands that are read, as they stand in the file.
#[derive(Default)]
pub(super) struct Commands<'a> {
    pub profiles: BTreeMap<usize, Line<'a>>,
    pub sub_frames: BTreeMap<usize, Line<'a>>,
    pub both: Vec<Line<'a>>,
    pub chirps: Vec<Option<ChirpLine>>,
    /// The last line of each other command.
    others: BTreeMap<&'a str, Line<'a>>,
}

impl<'a> Commands<'a> {
    pub fn read(text: &'a str) -> Result<Self, Fault> {
        let mut all = Commands { chirps: vec![None; MOST_CHIRPS], ..Commands::default() };
        for line in lines(text) {
            all.take(line)?;
        }
        Ok(all)
    }

    pub fn last(&self, command: &str) -> Option<&Line<'a>> {
        self.others.get(command)
    }

    fn take(&mut self, line: Line<'a>) -> Result<(), Fault> {
        match line.command {
            "flushCfg" => *self = Commands { chirps: vec![None; MOST_CHIRPS], ..Commands::default() },
            "profileCfg" => {
                self.profiles.insert(line.count(0, "the profile's number", MOST_CHIRPS)?, line);
            }
            "subFrameCfg" => {
                self.sub_frames.insert(line.count(0, "the sub-frame's number", 3)?, line);
            }
            "bpmCfg" => self.both.push(line),
            "chirpCfg" => self.define_chirps(&line)?,
            other => _ = self.others.insert(other, line),
        }
        Ok(())
    }

    /// `chirpCfg start end profile dFrequency dSlope dIdle dAdcStart txMask`.
    fn define_chirps(&mut self, line: &Line<'_>) -> Result<(), Fault> {
        let (first, last) =
            (line.count(0, "the first chirp", MOST_CHIRPS - 1)?, line.count(1, "the last chirp", MOST_CHIRPS - 1)?);
        let profile = line.count(2, "the profile's number", MOST_CHIRPS)?;
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
