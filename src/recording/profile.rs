//! The `.cfg` that sets a TI radar up over its command line ("mmWave SDK User Guide", configuration file format).

use crate::radar::Radar;

/// What a `.cfg` says of the radar and of the data it sends.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarProfile {
    /// Frequency at the start of the ramp, hertz.
    pub start_hz: f64,
    /// Slope of the ramp, hertz a second.
    pub slope_hz_per_second: f64,
    /// From the start of the ramp to the first sample, seconds.
    pub sampling_delay_seconds: f64,
    /// Complex samples a second.
    pub samples_per_second: f64,
    /// Samples of a chirp.
    pub samples: usize,
    /// Receivers that are on.
    pub receivers: usize,
    /// Transmitters that each chirp of a loop sends with, as bits.
    pub chirp_transmitters: Vec<u32>,
    /// Loops of a frame.
    pub loops: usize,
    /// Frames; 0 where they go on until stopped.
    pub frames: usize,
}

/// Why a `.cfg` could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ProfileError {
    /// A line can't be understood.
    #[error("line {line}: {message}")]
    Line {
        /// Which line, from 1.
        line: usize,
        /// What is wrong and what was expected.
        message: String,
    },
    /// A command is missing.
    #[error("has no line \"{0}\"; expected profileCfg, channelCfg, chirpCfg and frameCfg")]
    Missing(&'static str),
    /// A frame uses a chirp that no line defines.
    #[error("frameCfg uses chirp {0}, which no chirpCfg defines")]
    UndefinedChirp(usize),
}

/// Most chirps in a loop, samples in a chirp and loops in a frame that the hardware knows, with room to spare.
const MOST_CHIRPS: usize = 512;
const MOST_SAMPLES: usize = 65536;
const MOST_LOOPS: usize = 65536;

/// Numbers of one command, and where it stands.
struct Line<'a> {
    number: usize,
    command: &'a str,
    values: Vec<f64>,
}

impl Line<'_> {
    fn fault(&self, message: String) -> ProfileError {
        ProfileError::Line { line: self.number, message: format!("{}: {message}", self.command) }
    }

    /// Number `index` of the command.
    fn real(&self, index: usize, name: &str) -> Result<f64, ProfileError> {
        let missing =
            || self.fault(format!("has {} numbers; expected {name} as number {}", self.values.len(), index + 1));
        self.values.get(index).copied().ok_or_else(missing)
    }

    fn positive(&self, index: usize, name: &str) -> Result<f64, ProfileError> {
        let value = self.real(index, name)?;
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(self.fault(format!("{name} is {value}; expected a number above 0")))
        }
    }

    fn count(&self, index: usize, name: &str, most: usize) -> Result<usize, ProfileError> {
        let value = self.real(index, name)?;
        if value.fract() == 0.0 && (0.0..=most as f64).contains(&value) {
            return Ok(value as usize);
        }
        Err(self.fault(format!("{name} is {value}; expected a whole number up to {most}")))
    }
}

/// The commands that matter, as they stand in the file.
struct Commands<'a> {
    profile: Option<Line<'a>>,
    channels: Option<Line<'a>>,
    frame: Option<Line<'a>>,
    /// Transmitters of each chirp that is defined.
    chirps: Vec<Option<u32>>,
}

impl<'a> Commands<'a> {
    fn read(text: &'a str) -> Result<Self, ProfileError> {
        let (mut profile, mut channels, mut frame) = (None, None, None);
        let mut chirps: Vec<Option<u32>> = vec![None; MOST_CHIRPS];
        for (number, text) in (1..).zip(text.lines()) {
            let mut words = text.split_whitespace();
            let Some(command) = words.next().filter(|w| !w.starts_with(['%', '#'])) else { continue };
            if !["profileCfg", "channelCfg", "chirpCfg", "frameCfg", "adcCfg", "advFrameCfg", "subFrameCfg"]
                .contains(&command)
            {
                continue;
            }
            let values =
                words.map(|w| w.parse::<f64>().map_err(|_| (w, number))).collect::<Result<Vec<f64>, _>>().map_err(
                    |(word, line)| ProfileError::Line { line, message: format!("{command}: \"{word}\" is no number") },
                )?;
            let line = Line { number, command, values };
            let twice =
                || line.fault("stands twice; expected one profile, one set of channels and one frame".to_owned());
            match command {
                "profileCfg" if profile.is_some() => return Err(twice()),
                "channelCfg" if channels.is_some() => return Err(twice()),
                "frameCfg" if frame.is_some() => return Err(twice()),
                "profileCfg" => profile = Some(line),
                "channelCfg" => channels = Some(line),
                "frameCfg" => frame = Some(line),
                "chirpCfg" => define_chirps(&line, &mut chirps)?,
                "adcCfg" => check_samples(&line)?,
                _ => return Err(line.fault("advanced frames are not read; expected frameCfg".to_owned())),
            }
        }
        Ok(Commands { profile, channels, frame, chirps })
    }
}

impl RadarProfile {
    /// Reads a `.cfg`: profileCfg, channelCfg, chirpCfg and frameCfg are needed, adcCfg is checked, others are left alone.
    ///
    /// # Errors
    /// [`ProfileError`] names the line, the command and what was expected.
    pub fn parse(text: &str) -> Result<RadarProfile, ProfileError> {
        let Commands { profile, channels, frame, chirps } = Commands::read(text)?;
        let profile = profile.ok_or(ProfileError::Missing("profileCfg"))?;
        let channels = channels.ok_or(ProfileError::Missing("channelCfg"))?;
        let frame = frame.ok_or(ProfileError::Missing("frameCfg"))?;
        let (first, last) =
            (frame.count(0, "the first chirp", MOST_CHIRPS - 1)?, frame.count(1, "the last chirp", MOST_CHIRPS - 1)?);
        if last < first {
            return Err(frame.fault(format!("its chirps run from {first} to {last}; expected them in rising order")));
        }
        let used = first..=last;
        let chirp_transmitters =
            used.map(|n| chirps[n].ok_or(ProfileError::UndefinedChirp(n))).collect::<Result<_, _>>()?;
        let receivers = channels.count(0, "the mask of receivers", 0xffff)?.count_ones() as usize;
        if receivers == 0 {
            return Err(channels.fault("no receiver is on".to_owned()));
        }
        let loops = frame.count(2, "the number of loops", MOST_LOOPS)?;
        let samples = profile.count(9, "the number of samples", MOST_SAMPLES)?;
        if loops == 0 || samples == 0 {
            return Err(ProfileError::Line {
                line: frame.number,
                message: "a frame without loops or samples holds nothing".to_owned(),
            });
        }
        Ok(RadarProfile {
            start_hz: 1e9 * profile.positive(1, "the start frequency in GHz")?,
            sampling_delay_seconds: 1e-6 * profile.real(3, "the ADC's start time in us")?,
            slope_hz_per_second: 1e12 * profile.positive(7, "the slope in MHz/us")?,
            samples_per_second: 1e3 * profile.positive(10, "the sampling rate in ksps")?,
            samples,
            receivers,
            chirp_transmitters,
            loops,
            frames: frame.count(3, "the number of frames", 1 << 24)?,
        })
    }

    /// Bandwidth that the samples span, hertz.
    pub fn bandwidth_hz(&self) -> f64 {
        self.slope_hz_per_second * self.samples as f64 / self.samples_per_second
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

    /// Writes carrier, bandwidth, samples and their duration into `radar`.
    pub fn set(&self, radar: &mut Radar) {
        radar.carrier_hz = self.carrier_hz();
        radar.bandwidth_hz = self.bandwidth_hz();
        radar.samples = self.samples;
        radar.chirp_seconds = self.chirp_seconds();
    }
}

/// `chirpCfg start end profile dFrequency dSlope dIdle dAdcStart txMask`.
fn define_chirps(line: &Line<'_>, chirps: &mut [Option<u32>]) -> Result<(), ProfileError> {
    let (first, last) =
        (line.count(0, "the first chirp", MOST_CHIRPS - 1)?, line.count(1, "the last chirp", MOST_CHIRPS - 1)?);
    for (index, name) in
        [(3, "the change of frequency"), (4, "the change of slope"), (6, "the change of the ADC's start")]
    {
        let value = line.real(index, name)?;
        if value != 0.0 {
            return Err(line.fault(format!("{name} is {value}; expected chirps that are all alike (0)")));
        }
    }
    let mask = line.count(7, "the mask of transmitters", 0xffff)? as u32;
    chirps.iter_mut().take(last + 1).skip(first).for_each(|c| *c = Some(mask));
    Ok(())
}

/// `adcCfg bits format`: the samples must be whole and complex.
fn check_samples(line: &Line<'_>) -> Result<(), ProfileError> {
    if line.count(0, "the number of bits", 2)? != 2 {
        return Err(line.fault("expected 16 bits (2)".to_owned()));
    }
    if line.count(1, "the format", 3)? == 0 {
        return Err(line.fault("samples are real (0); expected complex ones (1 or 2)".to_owned()));
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Two transmitters, four receivers, eight samples, two loops.
    pub const CFG: &str = "% a small radar
sensorStop
dfeDataOutputMode 1
channelCfg 15 5 0
adcCfg 2 1
profileCfg 0 77 429 7 57.14 0 0 70 1 8 5209 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 2 0 100 1 0
sensorStart
";

    #[test]
    fn a_profile_is_read_in_si_units() {
        let profile = RadarProfile::parse(CFG).unwrap();
        assert_eq!((profile.samples, profile.receivers, profile.loops, profile.frames), (8, 4, 2, 0));
        assert_eq!(profile.chirp_transmitters, [1, 4]);
        assert!((profile.bandwidth_hz() - 70e12 * 8.0 / 5.209e6).abs() < 1.0);
        let middle = 77e9 + 70e12 * (7e-6 + 4.0 / 5.209e6);
        assert!((profile.carrier_hz() - middle).abs() < 1.0);
    }

    #[test]
    fn faults_name_line_with_command() {
        let with = |from: &str, to: &str| RadarProfile::parse(&CFG.replace(from, to)).unwrap_err().to_string();
        for (from, to, parts) in [
            ("frameCfg 0 1 2 0 100 1 0\n", "", ["\"frameCfg\"", "expected profileCfg"]),
            ("profileCfg 0 77", "profileCfg 0 x", ["line 6", "\"x\" is no number"]),
            (" 8 5209 0 0 30", "", ["line 6: profileCfg", "the number of samples as number 10"]),
            (" 8 5209", " 8.5 5209", ["line 6", "8.5"]),
            (" 8 5209", " 1e99 5209", ["line 6", "up to 65536"]),
            ("0 77 429", "0 nan 429", ["start frequency", "above 0"]),
            ("adcCfg 2 1", "adcCfg 2 0", ["line 5", "complex"]),
            ("adcCfg 2 1", "adcCfg 1 1", ["line 5", "16 bits"]),
            ("chirpCfg 1 1 0 0", "chirpCfg 1 1 0 5", ["line 8", "the change of frequency is 5"]),
            ("frameCfg 0 1", "frameCfg 0 2", ["chirp 2", "no chirpCfg"]),
            ("frameCfg 0 1", "frameCfg 1 0", ["line 9", "rising"]),
            ("channelCfg 15", "channelCfg 0", ["line 4", "no receiver"]),
            ("sensorStart", "channelCfg 15 5 0", ["line 10", "twice"]),
            ("sensorStart", "advFrameCfg 2 0", ["line 10", "advanced"]),
        ] {
            let message = with(from, to);
            assert!(parts.iter().all(|p| message.contains(p)), "{from} -> {to}: {message}");
        }
    }

    proptest! {
        #[test]
        fn mutated_text_is_read_or_refused(at in 0usize..CFG.len(), character in "\\PC", cut in 0usize..40) {
            let mut text = CFG.to_owned();
            text.replace_range(at..=at, &character);
            text.truncate(text.floor_char_boundary(text.len() - cut));
            if let Ok(profile) = RadarProfile::parse(&text) {
                prop_assert!(profile.samples <= MOST_SAMPLES && profile.chirp_transmitters.len() <= MOST_CHIRPS);
            }
        }
    }
}
