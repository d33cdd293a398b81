//! The `.cfg` that sets a TI radar up over its command line ("mmWave SDK User Guide", configuration file format).
//!
//! `lines` parses the commands and refuses other dialects; `commands` sorts them and reads the frames.

mod commands;
pub(super) mod lines;
#[cfg(test)]
pub(super) mod tests;

use super::Fault;
use commands::{ChirpLine, Commands, Frame, frames};
use lines::{ConfigLine, at_line, check_dialect, missing};
use num_complex::Complex64;

/// The radar and the data format that a `.cfg` sets.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RadarProfile {
    /// Frequency at the start of the ramp, hertz.
    pub start_hz: f64,
    /// Slope of the ramp, hertz a second; below 0 where it falls.
    pub slope_hz_per_second: f64,
    /// Time from the start of the ramp to the first sample, seconds.
    pub sampling_delay_seconds: f64,
    /// Samples a second.
    pub samples_per_second: f64,
    /// Samples of a chirp at each receiver, real or complex.
    pub samples: usize,
    /// Whether samples are real (`adcCfg`'s format 0).
    pub real: bool,
    /// Numbers of the receivers that are on, from 0.
    pub receiver_numbers: Vec<usize>,
    /// Number of receivers that are on.
    pub receivers: usize,
    /// Bit mask of the transmitters of each chirp of a loop.
    pub chirp_transmitters: Vec<u32>,
    /// Time from the beginning of a chirp to that of the next, seconds.
    pub chirp_interval_seconds: f64,
    /// Loops of a frame.
    pub loops: usize,
    /// Frames; 0 for no limit.
    pub frames: usize,
    /// Whether Q is before I (`adcbufCfg`); `None` where unknown.
    pub q_first: Option<bool>,
    /// Whether receivers are interleaved sample by sample (`adcbufCfg`); `None` where unknown.
    pub interleaved: Option<bool>,
    /// Whether each chirp begins with a header (`lvdsStreamCfg`).
    pub has_headers: bool,
    /// Whether two transmitters send both chirps of a loop, S1 + S2 and then S1 - S2 (`bpmCfg`).
    pub both_transmitters: bool,
    /// Difference of measured ranges from true ones, metres (`compRangeBiasAndRxChanPhase`).
    pub range_bias_metres: f64,
    /// Factors of the channels, transmitter by transmitter (`compRangeBiasAndRxChanPhase`); empty where unknown.
    pub channel_factors: Vec<Complex64>,
    /// Places of the virtual elements across and up, half wavelengths (`antGeometry0`, `antGeometry1`); empty where unknown.
    pub element_places: [Vec<f64>; 2],
    /// Samples of all receivers and chirps of the sub-frames before this one in every frame.
    pub numbers_before: usize,
    /// Samples of a whole frame, all sub-frames.
    pub frame_numbers: usize,
    /// Notes on choices between several values of the text, a sentence each.
    pub notes: Vec<String>,
}

/// Bytes of the header before each chirp with `lvdsStreamCfg`.
const CHIRP_HEADER_BYTES: usize = 64;

pub(super) const CHIP_RECEIVERS: usize = 4;

/// Most samples in a chirp: more than the hardware has.
const MAX_SAMPLES: usize = 65536;

const MAX_RANGE_BIAS_METRES: f64 = 1000.0;

impl RadarProfile {
    /// Reads a `.cfg`: profileCfg, channelCfg, chirpCfg and a frame are needed, other commands are optional.
    /// # Errors
    /// [`Fault`] names the line, the command and the expected value, or the dialect.
    pub fn parse(text: &str) -> Result<RadarProfile, Fault> {
        RadarProfile::of_sub_frame(text, None)
    }

    /// Bytes of a frame from a capture card, with 16 bits a number and the headers of chirps; `None` above 1 GiB.
    pub fn frame_bytes(&self) -> Option<usize> {
        let chirp = self.samples.checked_mul(self.receivers)?;
        let has_headers =
            if self.has_headers { self.frame_numbers.checked_div(chirp)?.checked_mul(CHIRP_HEADER_BYTES)? } else { 0 };
        let bytes = self.frame_numbers.checked_mul(if self.real { 2 } else { 4 })?.checked_add(has_headers)?;
        Some(bytes).filter(|bytes| (1..=1 << 30).contains(bytes))
    }

    /// [`RadarProfile::parse`] for the sub-frame with this index, the first where it is `None`.
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
        let sub_frames = all.iter().map(|frame| SubFrame::of(&commands, frame)).collect::<Result<Vec<_>, _>>()?;
        let numbers: Vec<usize> =
            sub_frames.iter().map(|p| p.numbers(receiver_numbers.len())).collect::<Option<_>>().unwrap_or_default();
        let chosen_frame = &sub_frames[chosen];
        let mut profile = chosen_frame.profile(frame, receiver_numbers)?;
        profile.numbers_before = numbers.iter().take(chosen).sum();
        profile.frame_numbers = numbers.iter().sum();
        profile.notes.extend((found > 1).then(|| {
            format!(
                "The .cfg has {found} sub-frames: number {chosen} is read (recording.capture.sub_frame names another)."
            )
        }));
        profile.notes.extend(chosen_frame.note.clone());
        profile.read_data_commands(&commands)?;
        Ok(profile)
    }

    /// The transmitter of each chirp of a loop, after the separation of two that send at once; the first of several that can't be separated.
    pub fn senders(&self) -> Vec<usize> {
        match (self.both_transmitters, self.chirp_transmitters.first()) {
            (true, Some(mask)) => bits(*mask).collect(),
            _ => self.chirp_transmitters.iter().map(|mask| mask.trailing_zeros() as usize).collect(),
        }
    }

    /// The profile of a cascade of chips with this profile each. A profile of more receivers than a chip has is that of the whole cascade.
    pub fn on_chips(mut self, chips: usize) -> RadarProfile {
        if chips > 1 && self.receivers <= CHIP_RECEIVERS {
            self.receivers *= chips;
            self.receiver_numbers = (0..self.receivers).collect();
            self.numbers_before *= chips;
            self.frame_numbers *= chips;
        }
        self
    }

    /// Reads the commands on data format, corrections and places of elements.
    fn read_data_commands(&mut self, commands: &Commands<'_>) -> Result<(), Fault> {
        if let Some(adc) = commands.last("adcCfg") {
            adc.count(0, "the number of bits", 2)?;
            self.real = adc.count(1, "the format", 3)? == 0;
        }
        if let Some(buffer) = commands.last("adcbufCfg") {
            // The first SDKs had no number of the sub-frame here.
            let first = usize::from(buffer.values.len() != 4);
            self.q_first = buffer.optional_count(first + 1, 1).map(|v| v == 1);
            self.interleaved = buffer.optional_count(first + 2, 1).map(|v| v == 0);
        }
        self.has_headers = commands.last("lvdsStreamCfg").is_some_and(|s| s.optional_count(1, 1) == Some(1));
        self.both_transmitters = commands.bpm_lines.iter().any(|b| b.optional_count(1, 1) == Some(1))
            && self.chirp_transmitters.len() == 2
            && self.chirp_transmitters.iter().all(|m| m.count_ones() == 2 && *m == self.chirp_transmitters[0]);
        if let Some(phases) = commands.last("compRangeBiasAndRxChanPhase") {
            let bias = phases.real(0, "the range bias in metres")?;
            if bias.is_nan() || bias.abs() > MAX_RANGE_BIAS_METRES {
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

    /// Frequency at the middle of the samples, hertz.
    pub fn carrier_hz(&self) -> f64 {
        let middle_seconds = self.sampling_delay_seconds + self.samples as f64 / self.samples_per_second / 2.0;
        self.start_hz + self.slope_hz_per_second * middle_seconds
    }

    /// Time that the samples span, seconds.
    pub fn chirp_seconds(&self) -> f64 {
        self.samples as f64 / self.samples_per_second
    }

    /// Complex samples of a chirp in a recording: half as many as real ones.
    pub fn complex_samples(&self) -> usize {
        if self.real { self.samples.div_ceil(2) } else { self.samples }
    }

    /// Whether the frequency rises from sample to sample.
    pub fn rises(&self) -> bool {
        self.slope_hz_per_second > 0.0
    }
}

/// Numbers of the set bits of a mask.
pub(super) fn bits(mask: u32) -> impl Iterator<Item = usize> {
    (0..32).filter(move |bit| mask >> bit & 1 == 1)
}

/// The chirps of a frame or sub-frame, with their common profile.
struct SubFrame<'a> {
    profile: &'a ConfigLine<'a>,
    transmitters: Vec<u32>,
    loops: usize,
    note: Option<String>,
}

impl<'a> SubFrame<'a> {
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
            // Values 0 (the profile's number), 5, 6, 8, and 11 on (power, phase, transmitter's start, gains) may differ.
            // Bits are compared, since NaN equals no number. NaN is refused where it is read.
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
        Ok(SubFrame { profile: first, transmitters, loops: frame.loops, note })
    }

    /// Number of samples of all receivers in a frame; `None` where it is too large.
    fn numbers(&self, receivers: usize) -> Option<usize> {
        let samples = self.profile.count(9, "", MAX_SAMPLES).ok()?;
        samples.checked_mul(receivers)?.checked_mul(self.transmitters.len())?.checked_mul(self.loops)
    }

    /// `profileCfg id start idle adc-start ramp-end power phase slope tx-start samples rate ...`.
    fn profile(&self, frame: &Frame, receiver_numbers: Vec<usize>) -> Result<RadarProfile, Fault> {
        let line = self.profile;
        let samples = line.count(9, "the number of samples", MAX_SAMPLES)?;
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
        // A ramp that ends before the last sample is an error of the text: chirps can't overlap.
        profile.chirp_interval_seconds = (1e-6 * (idle + ramp)).max(profile.chirp_seconds());
        Ok(profile)
    }
}
