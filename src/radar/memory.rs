//! The memory that a radar's maps need: a small scene file can ask for gigabytes.

use super::{Bytes, Radar, RadarError};

/// Most bytes of memory that the signal and the maps of one radar may ask for: 4 GiB, some 17 million cells.
pub const MAX_MEMORY_BYTES: u64 = 4 << 30;

/// Peak bytes per cell of a map (element x sample): complex f64 signal, profiles and maps, decades, Lambda, and the largest method's work space.
const BYTES_PER_CELL: u64 = 256;

/// Bytes for each pair of elements of an end: methods that whiten or look for subspaces hold complex matrices of that size.
const BYTES_PER_END_PAIR: u64 = 256;

/// Bytes for each sample of each of several chirps: the complex samples of a range-Doppler map's 8 elements, their profiles, and the map.
const BYTES_PER_CHIRP_SAMPLE: u64 = 18 * 16;

impl Radar {
    pub(super) fn chirp_bytes(&self) -> u64 {
        let all = |n: usize| (n as u64).saturating_mul(self.samples as u64).saturating_mul(BYTES_PER_CHIRP_SAMPLE);
        if self.chirps > 1 { all(self.chirps) } else { 0 }
    }

    /// Upper bound on the bytes for signal and maps of this radar, in any command or method but networks (`tests/library/memory.rs`).
    pub fn memory_bytes(&self) -> u64 {
        let [elements, samples, end] = [self.elements, self.samples, self.end_elements].map(|n| n as u64);
        let cells = elements.saturating_mul(samples).saturating_mul(BYTES_PER_CELL);
        let ends = end.saturating_mul(end).saturating_mul(BYTES_PER_END_PAIR);
        cells.saturating_add(ends).saturating_add(self.chirp_bytes())
    }

    pub(super) fn check_memory(&self) -> Result<(), RadarError> {
        let Radar { elements, samples, end_elements, chirps, .. } = *self;
        let (bytes, most) = (Bytes(self.chirp_bytes()), Bytes(MAX_MEMORY_BYTES / 2));
        if bytes > most {
            let map = format!("a range-Doppler map of {chirps} chirps by {samples} samples");
            let told = format!(" asks for too much memory: {map} needs {bytes}; at most {most} can be had");
            return Err(RadarError { field: "chirps", told });
        }
        let (bytes, most) = (Bytes(self.memory_bytes()), Bytes(MAX_MEMORY_BYTES));
        if bytes <= most {
            return Ok(());
        }
        let field = if elements >= samples { "elements" } else { "samples" };
        let of = format!("{elements} elements by {samples} samples with ends of {end_elements}");
        let told = format!(" asks for too much memory: {of} need {bytes}; at most {most} can be had");
        Err(RadarError { field, told })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_error_gives_the_bytes_with_the_bound() {
        let large = Radar { elements: 65536, samples: 65536, ..Radar::default() };
        let message = large.validate().unwrap_err().to_string();
        for part in ["65536 elements", "65536 samples", "1.0 TiB", "4.0 GiB"] {
            assert!(message.contains(part), "{message}");
        }
        let wide_ends = Radar { elements: 65536, end_elements: 32768, samples: 4, ..Radar::default() };
        assert!(wide_ends.validate().unwrap_err().to_string().contains("ends of 32768"));
        Radar { elements: 4096, samples: 4095, ..Radar::default() }.validate().unwrap();
    }

    proptest! {
        #[test]
        fn no_count_overflows(elements in 0usize.., samples in 0usize.., end_elements in 0usize..) {
            let radar = Radar { elements, samples, end_elements, ..Radar::default() };
            let _any = radar.memory_bytes();
            prop_assert!(radar.validate().is_err() || radar.memory_bytes() <= MAX_MEMORY_BYTES);
        }
    }
}
