//! The lines of a `.cfg`: commands with their numbers, out of the text around them.

use crate::recording::Fault;
use std::fmt::Display;

/// Most chirps in a loop and loops in a frame that the hardware knows, with room to spare.
pub(super) const MOST_CHIRPS: usize = 512;
pub(super) const MOST_LOOPS: usize = 65536;

/// Numbers of one command, and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Line<'a> {
    /// Number of the line in the text, from 1.
    pub number: usize,
    pub command: &'a str,
    /// The numbers behind the command, up to the first word that is no number.
    pub values: Vec<f64>,
    /// The first word that is no number.
    bad: Option<&'a str>,
}

impl Line<'_> {
    pub fn fault(&self, message: impl Display) -> Fault {
        at_line(self.number, &format!("{}: {message}", self.command))
    }

    pub fn real(&self, index: usize, name: &str) -> Result<f64, Fault> {
        let missing = || match self.bad {
            Some(word) => self.fault(format!("\"{word}\" is no number; expected {name} as number {}", index + 1)),
            None => self.fault(format!("has {} numbers; expected {name} as number {}", self.values.len(), index + 1)),
        };
        self.values.get(index).copied().ok_or_else(missing)
    }

    /// A number above 0.
    pub fn positive(&self, index: usize, name: &str) -> Result<f64, Fault> {
        let value = self.real(index, name)?;
        if value.is_finite() && value > 0.0 {
            Ok(value)
        } else {
            Err(self.fault(format!("{name} is {value}; expected a number above 0")))
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

    /// A whole number from 0 to `most`.
    pub fn count(&self, index: usize, name: &str, most: usize) -> Result<usize, Fault> {
        let value = self.real(index, name)?;
        if value.fract() == 0.0 && (0.0..=most as f64).contains(&value) {
            return Ok(value as usize);
        }
        Err(self.fault(format!("{name} is {value}; expected a whole number up to {most}")))
    }

    /// A whole number that may be missing.
    pub fn may_count(&self, index: usize, most: usize) -> Option<usize> {
        self.count(index, "", most).ok()
    }
}

/// The text of a `.cfg` in any encoding: UTF-8, UTF-16 with its mark, or one byte a character, of which only comments have others
/// than ASCII.
pub fn text_of(bytes: &[u8]) -> String {
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

/// The command and its numbers, where the line has one: comments and what a terminal writes before a command are left out.
fn line(number: usize, text: &str) -> Option<Line<'_>> {
    let text = ["%", "#", "//"].iter().fold(text, |rest, sign| rest.split(sign).next().unwrap_or(rest));
    // A prompt such as "mmwDemo:/>" ends with the last ">".
    let text = text.rsplit('>').next().unwrap_or(text);
    let mut words = text.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"')).filter(|w| !w.is_empty());
    let command = words.next().filter(|w| w.starts_with(|c: char| c.is_ascii_alphabetic()))?;
    let (mut values, mut bad) = (Vec::new(), None);
    for word in words {
        match word.parse::<f64>() {
            Ok(value) => values.push(value),
            Err(_) => {
                bad = Some(word);
                break;
            }
        }
    }
    Some(Line { number, command, values, bad })
}

/// Every command of the text, in order. Lines end with LF, CR or both.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
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
        line(number, part)
    })
}

/// Refuses a text of another dialect by its name.
pub(super) fn check_dialect(text: &str) -> Result<(), Fault> {
    let start = text.trim_start_matches('\u{feff}').trim_start();
    if start.starts_with('{') {
        let studio = start.contains("mmWaveDevices") || start.contains("rfConfig") || start.contains("mmwaveDevices");
        let (name, helps) = if studio {
            ("mmWave Studio's JSON", "the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg in a .cfg")
        } else {
            ("JSON", "a .cfg with profileCfg, channelCfg, chirpCfg and frameCfg")
        };
        return Err(dialect(name, helps));
    }
    let has = |word: &str| lines(text).any(|line| line.command == word);
    if has("chirpComnCfg") || has("chirpTimingCfg") {
        let helps = "a recording's TOML with carrier_hz, bandwidth_hz and samples, which say the same";
        return Err(dialect("the xWRL radars' (chirpComnCfg, chirpTimingCfg)", helps));
    }
    if start.starts_with("<?xml") || start.starts_with('<') {
        return Err(dialect("XML", "a .cfg with profileCfg and frameCfg"));
    }
    if start.contains("ar1.ProfileConfig") || start.contains("ar1.ChirpConfig") {
        let helps = "a .cfg with the same numbers as profileCfg, channelCfg, chirpCfg and frameCfg";
        return Err(dialect("a Lua script of mmWave Studio (ar1.ProfileConfig)", helps));
    }
    Ok(())
}

fn dialect(name: &str, helps: &str) -> Fault {
    Fault::Data(format!("is a text of another dialect, {name}, which is not read; what would help is {helps}"))
}

pub(super) fn missing(command: &str) -> Fault {
    Fault::Data(format!("has no line \"{command}\"; expected profileCfg, channelCfg, chirpCfg and frameCfg"))
}

/// The error of a line, counted from 1.
pub(super) fn at_line(line: usize, message: &str) -> Fault {
    Fault::Data(format!("line {line}: {message}"))
}
