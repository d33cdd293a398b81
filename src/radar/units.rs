//! Quantities with their unit in the type.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A power ratio in decibels.
#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Decibels(pub f64);

impl Decibels {
    /// The ratio of powers: `10^(dB/10)`.
    pub fn power_ratio(self) -> f64 {
        10f64.powf(self.0 / 10.0)
    }

    /// Decades of *amplitude*: dB / 20.
    pub fn amplitude_decades(self) -> f64 {
        self.0 / 20.0
    }
}

impl fmt::Display for Decibels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} dB", self.0)
    }
}

/// A power in decibels over a milliwatt.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct DecibelMilliwatts(pub f64);

impl DecibelMilliwatts {
    /// The level of a power in watts: `10 log10(watts / 1 mW)`.
    pub fn of_watts(watts: f64) -> Self {
        DecibelMilliwatts(10.0 * watts.log10() + 30.0)
    }

    /// The power in watts.
    pub fn watts(self) -> f64 {
        10f64.powf((self.0 - 30.0) / 10.0)
    }
}

impl fmt::Display for DecibelMilliwatts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} dBm", self.0)
    }
}

/// An amount of memory in bytes, printed with a prefix: "4.0 GiB".
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bytes(pub u64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mut size, mut unit) = (self.0 as f64, "bytes");
        for larger in ["KiB", "MiB", "GiB", "TiB", "PiB", "EiB"] {
            if size < 1024.0 {
                break;
            }
            (size, unit) = (size / 1024.0, larger);
        }
        if unit == "bytes" { write!(f, "{} bytes", self.0) } else { write!(f, "{size:.1} {unit}") }
    }
}

/// A number with the noun it counts: "1 scene", "12 scenes".
pub fn counted<N: fmt::Display + PartialEq + From<u8>>(number: N, one: &str, many: &str) -> String {
    let noun = if number == N::from(1) { one } else { many };
    format!("{number} {noun}")
}

/// The text with its first letter upper-case.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_plural() {
        let told = [0u32, 1, 2].map(|n| counted(n, "step", "steps"));
        assert_eq!(told, ["0 steps", "1 step", "2 steps"]);
    }

    #[test]
    fn zero_decibel_milliwatts_are_a_milliwatt() {
        assert!((DecibelMilliwatts(0.0).watts() / 1e-3 - 1.0).abs() < 1e-12);
        assert!((DecibelMilliwatts::of_watts(1.0).0 - 30.0).abs() < 1e-12);
        assert!((DecibelMilliwatts::of_watts(DecibelMilliwatts(-73.5).watts()).0 + 73.5).abs() < 1e-12);
        assert_eq!(DecibelMilliwatts(-20.0).to_string(), "-20 dBm");
    }

    #[test]
    fn amounts_of_memory_are_readable() {
        let told = [0, 1023, 1024, 1 << 30].map(|n| Bytes(n).to_string());
        assert_eq!(told, ["0 bytes", "1023 bytes", "1.0 KiB", "1.0 GiB"]);
    }
}
