//! The lines of a `.cfg`: commands with their numbers, without comments and prompts.

use crate::recording::Fault;
use std::fmt::Display;

/// Most chirps in a loop and loops in a frame: more than the hardware has.
pub(super) const MAX_CHIRPS: usize = 512;
pub(super) const MAX_LOOPS: usize = 65536;

/// Largest number of a quantity, in the unit of its command (GHz, ksps): beyond any radar.
const MAX_NUMBER: f64 = 1e9;

/// A command with its numbers.
#[derive(Debug, Clone)]
pub(super) struct ConfigLine<'a> {
    /// Number of the line in the text, from 1.
    pub number: usize,
    pub command: &'a str,
    /// The numbers after the command, up to the first word that is no number.
    pub values: Vec<f64>,
    /// The first word that is no number.
    non_number: Option<&'a str>,
}

impl ConfigLine<'_> {
    pub fn fault(&self, message: impl Display) -> Fault {
        at_line(self.number, &format!("{}: {message}", self.command))
    }

    /// Number `index` of the command; `name` is its name in the error.
    pub fn real(&self, index: usize, name: &str) -> Result<f64, Fault> {
        let missing = || match self.non_number {
            Some(word) => self.fault(format!("\"{word}\" is no number; expected {name} as number {}", index + 1)),
            None => self.fault(format!("has {} numbers; expected {name} as number {}", self.values.len(), index + 1)),
        };
        self.values.get(index).copied().ok_or_else(missing)
    }

    /// A number above 0, at most [`MAX_NUMBER`].
    pub fn positive(&self, index: usize, name: &str) -> Result<f64, Fault> {
        let value = self.real(index, name)?;
        if value > 0.0 && value <= MAX_NUMBER {
            Ok(value)
        } else {
            Err(self.fault(format!("{name} is {value}; expected a number above 0, and at most {MAX_NUMBER:e}")))
        }
    }

    /// A finite number other than 0.
    pub fn not_zero(&self, index: usize, name: &str) -> Result<f64, Fault> {
        let value = self.real(index, name)?;
        if value.is_finite() && value != 0.0 {
            Ok(value)
        } else {
            Err(self.fault(format!("{name} is {value}; expected a number other than 0")))
        }
    }

    /// A whole number from 0 to `max`.
    pub fn count(&self, index: usize, name: &str, max: usize) -> Result<usize, Fault> {
        let value = self.real(index, name)?;
        if value.fract() == 0.0 && (0.0..=max as f64).contains(&value) {
            return Ok(value as usize);
        }
        Err(self.fault(format!("{name} is {value}; expected a whole number up to {max}")))
    }

    /// A whole number from 0 to `max` that may be missing.
    pub fn optional_count(&self, index: usize, max: usize) -> Option<usize> {
        self.count(index, "", max).ok()
    }
}

/// Decodes the text of a `.cfg`: UTF-8, UTF-16 with a byte order mark, or one byte a character, where only comments have others than ASCII.
pub fn config_text(bytes: &[u8]) -> String {
    let wide = |of: fn([u8; 2]) -> u16, rest: &[u8]| {
        let units: Vec<u16> = rest.chunks_exact(2).map(|b| of([b[0], b[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => wide(u16::from_le_bytes, rest),
        [0xfe, 0xff, rest @ ..] => wide(u16::from_be_bytes, rest),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest).into_owned(),
        _ => String::from_utf8_lossy(bytes).into_owned(),
    }
}

/// The command of a line with its numbers, without comments and the prompt of a terminal; `None` without a command.
fn parse_line(number: usize, text: &str) -> Option<ConfigLine<'_>> {
    let text = ["%", "#", "//"].iter().fold(text, |rest, sign| rest.split(sign).next().unwrap_or(rest));
    // A prompt such as "mmwDemo:/>" ends with the last ">".
    let text = text.rsplit('>').next().unwrap_or(text);
    let mut words = text.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"')).filter(|w| !w.is_empty());
    let command = words.next().filter(|w| w.starts_with(|c: char| c.is_ascii_alphabetic()))?;
    let (mut values, mut non_number) = (Vec::new(), None);
    for word in words {
        match word.parse::<f64>() {
            Ok(value) => values.push(value),
            Err(_) => {
                non_number = Some(word);
                break;
            }
        }
    }
    Some(ConfigLine { number, command, values, non_number })
}

/// Every command of the text, in order. Lines end with LF, CR or CR LF.
pub(super) fn config_lines(text: &str) -> impl Iterator<Item = ConfigLine<'_>> {
    let text = text.trim_start_matches('\u{feff}');
    let mut number = 0;
    let mut after_cr = false;
    text.split_inclusive(['\n', '\r']).filter_map(move |part| {
        let joins = after_cr && part == "\n";
        after_cr = part.ends_with('\r');
        if joins {
            return None;
        }
        number += 1;
        parse_line(number, part)
    })
}

/// Refuses texts of other dialects, and names the dialect.
pub(super) fn check_dialect(text: &str) -> Result<(), Fault> {
    let start = text.trim_start_matches('\u{feff}').trim_start();
    if start.starts_with('{') {
        let studio = start.contains("mmWaveDevices") || start.contains("rfConfig") || start.contains("mmwaveDevices");
        let (name, helps) = if studio {
            ("mmWave Studio's JSON", "the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg in a .cfg")
        } else {
            ("JSON", "a .cfg with profileCfg, channelCfg, chirpCfg and frameCfg")
        };
        return Err(dialect_error(name, helps));
    }
    let has = |word: &str| config_lines(text).any(|parse_line| parse_line.command == word);
    if has("chirpComnCfg") || has("chirpTimingCfg") {
        let helps = "a recording's TOML with carrier_hz, bandwidth_hz and samples, which say the same";
        return Err(dialect_error("the xWRL radars' (chirpComnCfg, chirpTimingCfg)", helps));
    }
    if start.starts_with("<?xml") || start.starts_with('<') {
        return Err(dialect_error("XML", "a .cfg with profileCfg and frameCfg"));
    }
    if start.contains("ar1.ProfileConfig") || start.contains("ar1.ChirpConfig") {
        let helps = "a .cfg with the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg";
        return Err(dialect_error("a Lua script of mmWave Studio (ar1.ProfileConfig)", helps));
    }
    Ok(())
}

fn dialect_error(name: &str, helps: &str) -> Fault {
    Fault::Data(format!("is a text of another dialect, {name}, which is not read; what would help is {helps}"))
}

pub(super) fn missing(command: &str) -> Fault {
    Fault::Data(format!("has no line \"{command}\"; expected profileCfg, channelCfg, chirpCfg and frameCfg"))
}

/// The error of a line, counted from 1.
pub(super) fn at_line(parse_line: usize, message: &str) -> Fault {
    Fault::Data(format!("line {parse_line}: {message}"))
}
