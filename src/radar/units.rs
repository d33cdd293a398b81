//! Quantities whose unit a bare number would hide.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A power ratio in decibels.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
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

/// An amount of memory in bytes, printed as a person reads it: "4.0 GiB".
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_plural() {
        let told = [0u32, 1, 2].map(|n| counted(n, "step", "steps"));
        assert_eq!(told, ["0 steps", "1 step", "2 steps"]);
        assert_eq!(counted(1usize, "try", "tries"), "1 try");
    }

    #[test]
    fn amounts_of_memory_are_readable() {
        let told = [0, 1023, 1024, 1 << 30].map(|n| Bytes(n).to_string());
        assert_eq!(told, ["0 bytes", "1023 bytes", "1.0 KiB", "1.0 GiB"]);
    }
}
