//! The `.cfg` that sets a TI radar up over its command line ("mmWave SDK User Guide", configuration file format).
//!
//! `lines` finds the commands and names texts of other dialects, `commands` keeps those that are read and reads the frames.

mod commands;
pub(super) mod lines;
#[cfg(test)]
pub(super) mod tests;

use super::Fault;
use commands::{ChirpLine, Commands, Frame, frames};
use lines::{Line, at_line, check_dialect, missing};
use num_complex::Complex64;

/// The radar and the data format that a `.cfg` sets.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RadarProfile {
    /// Frequency at the start of the ramp, hertz.
    pub start_hz: f64,
    /// Slope of the ramp, hertz a second; below 0 where it falls.
    pub slope_hz_per_second: f64,
    /// From the start of the ramp to the first sample, seconds.
    pub sampling_delay_seconds: f64,
    /// Samples a second.
    pub samples_per_second: f64,
    /// Samples of a chirp, as the converter takes them.
    pub samples: usize,
    /// Whether the converter takes real samples (`adcCfg`'s format 0).
    pub real: bool,
    /// Receivers that are on, by number from 0.
    pub receiver_numbers: Vec<usize>,
    /// Receivers that are on.
    pub receivers: usize,
    /// Transmitters that each chirp of a loop sends with, as bits.
    pub chirp_transmitters: Vec<u32>,
    /// From the beginning of a chirp to that of the next, seconds.
    pub chirp_interval_seconds: f64,
    /// Loops of a frame.
    pub loops: usize,
    /// Frames; 0 where they go on until stopped.
    pub frames: usize,
    /// Q before I (`adcbufCfg`), where it says so.
    pub q_first: Option<bool>,
    /// Receivers sample by sample (`adcbufCfg`), where it says so.
    pub interleaved: Option<bool>,
    /// Whether each chirp begins with a header (`lvdsStreamCfg`).
    pub headers: bool,
    /// Whether the two chirps of a loop are sent by both transmitters, S1 + S2 and then S1 - S2 (`bpmCfg`).
    pub both_transmitters: bool,
    /// Bias of the ranges, metres: measured ranges are too long by it (`compRangeBiasAndRxChanPhase`).
    pub range_bias_metres: f64,
    /// Factors of the channels, transmitter by transmitter; empty where nothing is said.
    pub channel_factors: Vec<Complex64>,
    /// Places of the virtual elements in half wavelengths, across and up (`antGeometry0`, `antGeometry1`); empty where nothing is said.
    pub element_places: [Vec<f64>; 2],
    /// Samples of all receivers and chirps of the sub-frames that come first in every frame.
    pub numbers_before: usize,
    /// Samples of a whole frame, all sub-frames.
    pub frame_numbers: usize,
    /// Sentences on choices between several values of the text.
    pub notes: Vec<String>,
}

/// Bytes of the header before each chirp, where `lvdsStreamCfg` asks for one.
const CHIRP_HEADER_BYTES: usize = 64;

pub(super) const CHIP_RECEIVERS: usize = 4;

/// Most samples in a chirp that the hardware knows, with room to spare.
const MOST_SAMPLES: usize = 65536;

/// Largest bias that is believed, metres.
const MOST_BIAS_METRES: f64 = 1000.0;

impl RadarProfile {
    /// Reads a `.cfg`: profileCfg, channelCfg, chirpCfg and a frame are needed, other commands where they stand there.
    ///
    /// # Errors
    /// [`Fault`] names the line, the command and what was expected, or the dialect.
    pub fn parse(text: &str) -> Result<RadarProfile, Fault> {
        RadarProfile::of_sub_frame(text, None)
    }

    /// Bytes of a frame as a capture card sends it, 16 bits to a number, headers of chirps counted; `None` where it is larger than 1 GiB.
    pub fn frame_bytes(&self) -> Option<usize> {
        let chirp = self.samples.checked_mul(self.receivers)?;
        let headers =
            if self.headers { self.frame_numbers.checked_div(chirp)?.checked_mul(CHIRP_HEADER_BYTES)? } else { 0 };
        let bytes = self.frame_numbers.checked_mul(if self.real { 2 } else { 4 })?.checked_add(headers)?;
        Some(bytes).filter(|bytes| (1..=1 << 30).contains(bytes))
    }

    /// [`RadarProfile::parse`] for one sub-frame of an advanced frame, from 0; the first where none is said.
    ///
    /// # Errors
    /// As [`RadarProfile::parse`].
    pub fn of_sub_frame(text: &str, sub_frame: Option<usize>) -> Result<RadarProfile, Fault> {
        check_dialect(text)?;
        let commands = Commands::read(text)?;
        if commands.profiles.is_empty() {
            return Err(missing("profileCfg"));
        }
        let channels = commands.last("channelCfg").ok_or_else(|| missing("channelCfg"))?;
        let mask = channels.count(0, "the mask of receivers", 0xffff)?;
        if mask == 0 {
            return Err(channels.fault("no receiver is on"));
        }
        let receiver_numbers: Vec<usize> = bits(mask as u32).collect();
        let all = frames(&commands)?;
        let found = all.len();
        let chosen = sub_frame.unwrap_or(0);
        let frame = all.get(chosen).ok_or_else(|| {
            let last = found - 1;
            Fault::Data(format!("has {found} sub-frames; expected recording.capture.sub_frame = 0 to {last}"))
        })?;
        let parts = all.iter().map(|frame| Part::of(&commands, frame)).collect::<Result<Vec<_>, _>>()?;
        let numbers: Vec<usize> =
            parts.iter().map(|p| p.numbers(receiver_numbers.len())).collect::<Option<_>>().unwrap_or_default();
        let part = &parts[chosen];
        let mut profile = part.profile(frame, receiver_numbers)?;
        profile.numbers_before = numbers.iter().take(chosen).sum();
        profile.frame_numbers = numbers.iter().sum();
        profile.notes.extend((found > 1).then(|| {
            format!(
                "The .cfg has {found} sub-frames: number {chosen} is read (recording.capture.sub_frame names another)."
            )
        }));
        profile.notes.extend(part.note.clone());
        profile.said_of_data(&commands)?;
        Ok(profile)
    }

    /// The transmitter of each chirp of a loop, after those that send together are told apart: of several at once the first.
    pub fn senders(&self) -> Vec<usize> {
        match (self.both_transmitters, self.chirp_transmitters.first()) {
            (true, Some(mask)) => bits(*mask).collect(),
            _ => self.chirp_transmitters.iter().map(|mask| mask.trailing_zeros() as usize).collect(),
        }
    }

    /// The profile of so many chips of a cascade that were all set up alike. A text that names more receivers than a chip has names them all.
    pub fn on_chips(mut self, chips: usize) -> RadarProfile {
        if chips > 1 && self.receivers <= CHIP_RECEIVERS {
            self.receivers *= chips;
            self.receiver_numbers = (0..self.receivers).collect();
            self.numbers_before *= chips;
            self.frame_numbers *= chips;
        }
        self
    }

    /// Takes the commands on the data format and on corrections.
    fn said_of_data(&mut self, commands: &Commands<'_>) -> Result<(), Fault> {
        if let Some(adc) = commands.last("adcCfg") {
            adc.count(0, "the number of bits", 2)?;
            self.real = adc.count(1, "the format", 3)? == 0;
        }
        if let Some(buffer) = commands.last("adcbufCfg") {
            // The first SDKs had no sub-frames to name.
            let first = usize::from(buffer.values.len() != 4);
            self.q_first = buffer.may_count(first + 1, 1).map(|v| v == 1);
            self.interleaved = buffer.may_count(first + 2, 1).map(|v| v == 0);
        }
        self.headers = commands.last("lvdsStreamCfg").is_some_and(|s| s.may_count(1, 1) == Some(1));
        self.both_transmitters = commands.both.iter().any(|b| b.may_count(1, 1) == Some(1))
            && self.chirp_transmitters.len() == 2
            && self.chirp_transmitters.iter().all(|m| m.count_ones() == 2 && *m == self.chirp_transmitters[0]);
        if let Some(phases) = commands.last("compRangeBiasAndRxChanPhase") {
            let bias = phases.real(0, "the range bias in metres")?;
            if bias.is_nan() || bias.abs() > MOST_BIAS_METRES {
                return Err(phases.fault(format!("the range bias is {bias}; expected metres")));
            }
            self.range_bias_metres = bias;
            self.channel_factors = phases.values[1..]
                .chunks_exact(2)
                .map(|v| Complex64::new(v[0], v[1]))
                .filter(|v| v.is_finite())
                .collect();
        }
        self.element_places = ["antGeometry0", "antGeometry1"].map(|command| {
            let values = commands.last(command).into_iter().flat_map(|line| &line.values);
            values.copied().filter(|v| v.is_finite()).collect()
        });
        Ok(())
    }

    /// Bandwidth that the samples span, hertz.
    pub fn bandwidth_hz(&self) -> f64 {
        self.slope_hz_per_second.abs() * self.samples as f64 / self.samples_per_second
    }

    /// Frequency at the middle of the samples, hertz: the one that directions follow.
    pub fn carrier_hz(&self) -> f64 {
        let middle_seconds = self.sampling_delay_seconds + self.samples as f64 / self.samples_per_second / 2.0;
        self.start_hz + self.slope_hz_per_second * middle_seconds
    }

    /// Time that the samples span, seconds.
    pub fn chirp_seconds(&self) -> f64 {
        self.samples as f64 / self.samples_per_second
    }

    /// Samples of a chirp as a recording has them: of real ones half as many complex ones, which hold the same.
    pub fn complex_samples(&self) -> usize {
        if self.real { self.samples.div_ceil(2) } else { self.samples }
    }

    /// Whether the frequency rises from sample to sample.
    pub fn rises(&self) -> bool {
        self.slope_hz_per_second > 0.0
    }
}

/// Numbers of the bits of a mask that are set.
pub(super) fn bits(mask: u32) -> impl Iterator<Item = usize> {
    (0..32).filter(move |bit| mask >> bit & 1 == 1)
}

/// The chirps of one frame, with the profile they share.
struct Part<'a> {
    profile: &'a Line<'a>,
    transmitters: Vec<u32>,
    loops: usize,
    note: Option<String>,
}

impl<'a> Part<'a> {
    fn of(commands: &'a Commands<'a>, frame: &Frame) -> Result<Self, Fault> {
        let mut chirps = Vec::new();
        for n in frame.first..=frame.last {
            let chirp = commands.chirps[n]
                .ok_or_else(|| Fault::Data(format!("frameCfg uses chirp {n}, which no chirpCfg defines")))?;
            if let Some(differs) = chirp.differs {
                let message = format!("chirpCfg: {differs} is not 0; expected chirps that are all alike");
                return Err(at_line(chirp.line, &message));
            }
            chirps.push(chirp);
        }
        let line = |number: usize| {
            commands
                .profiles
                .get(&number)
                .or_else(|| commands.profiles.values().next().filter(|_| commands.profiles.len() == 1))
        };
        let line = |chirp: &ChirpLine| line(chirp.profile).ok_or_else(|| missing("profileCfg"));
        let first = line(&chirps[0])?;
        for chirp in &chirps[1..] {
            let other = line(chirp)?;
            // The profile's own number differs; powers, phases, the transmitter's start and gains (5, 6, 8, 11 on) may.
            // Bits are compared, since NaN equals nothing. NaN is refused where it is read.
            let same = |i: usize| other.values.get(i).map(|v| v.to_bits()) == first.values.get(i).map(|v| v.to_bits());
            if ![1, 2, 3, 4, 7, 9, 10].into_iter().all(same) {
                let message = "the chirps of a frame follow profiles that differ; expected one profile for all of them";
                return Err(at_line(chirp.line, message));
            }
        }
        let used: std::collections::BTreeSet<usize> = chirps.iter().map(|c| c.profile).collect();
        let note =
            (used.len() > 1).then(|| format!("The .cfg has {} profiles that are alike: they are one.", used.len()));
        let transmitters = chirps.iter().map(|c| c.transmitters).collect();
        Ok(Part { profile: first, transmitters, loops: frame.loops, note })
    }

    /// Samples of all receivers of a frame; `None` where there are too many.
    fn numbers(&self, receivers: usize) -> Option<usize> {
        let samples = self.profile.count(9, "", MOST_SAMPLES).ok()?;
        samples.checked_mul(receivers)?.checked_mul(self.transmitters.len())?.checked_mul(self.loops)
    }

    /// `profileCfg id start idle adc-start ramp-end power phase slope tx-start samples rate ...`.
    fn profile(&self, frame: &Frame, receiver_numbers: Vec<usize>) -> Result<RadarProfile, Fault> {
        let line = self.profile;
        let samples = line.count(9, "the number of samples", MOST_SAMPLES)?;
        if frame.loops == 0 || samples == 0 {
            return Err(at_line(frame.line, "a frame without loops or samples holds nothing"));
        }
        let (idle, ramp) = (line.real(2, "the idle time in us")?, line.real(4, "the ramp's end in us")?);
        let mut profile = RadarProfile {
            start_hz: 1e9 * line.positive(1, "the start frequency in GHz")?,
            sampling_delay_seconds: 1e-6 * line.real(3, "the ADC's start time in us")?,
            slope_hz_per_second: 1e12 * line.not_zero(7, "the slope in MHz/us")?,
            samples_per_second: 1e3 * line.positive(10, "the sampling rate in ksps")?,
            samples,
            receivers: receiver_numbers.len(),
            receiver_numbers,
            chirp_transmitters: self.transmitters.clone(),
            loops: frame.loops,
            frames: frame.frames,
            ..RadarProfile::default()
        };
        // A ramp that ends before its samples do is a slip of the text: chirps can't overlap.
        profile.chirp_interval_seconds = (1e-6 * (idle + ramp)).max(profile.chirp_seconds());
        Ok(profile)
    }
}
