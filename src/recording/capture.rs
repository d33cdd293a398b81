//! Raw captures: what the samples of a TI radar look like in the file that its capture card (DCA1000) writes.
//!
//! Little-endian int16, chirp after chirp. The radar's lanes send real and imaginary parts in blocks: as many real parts as there
//! are lanes, then as many imaginary parts ("Mmwave Radar Device ADC Raw Data Capture", SWRA581).

use super::numbers::{MAX_NUMBERS, bounded_count};
use super::profile::RadarProfile;
use ndarray::{Array3, s};
use num_complex::Complex64;
use serde::Deserialize;
use std::io::{self, Read, Seek, SeekFrom};

/// How a capture is laid out, and which part of it is looked at.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// Name of the `.cfg`, beside the TOML.
    pub config: String,
    /// Lanes of the radar: 2 (xWR16xx, 18xx, 68xx) or 4 (xWR12xx, 14xx).
    pub lanes: usize,
    /// How the receivers follow one another.
    pub receivers: ReceiverOrder,
    /// Which chirps of a loop form the line of elements, in this order; all where there is only one.
    pub chirps: Option<Vec<usize>>,
    /// Which frame, from 0.
    #[serde(default)]
    pub frame: usize,
    /// Which loop of the frame, from 0.
    #[serde(default, rename = "loop")]
    pub loop_number: usize,
}

/// How the receivers of a chirp follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReceiverOrder {
    /// All samples of one, then all of the next; a block holds samples of one receiver.
    OneAfterAnother,
    /// Sample by sample; a block holds one sample of as many receivers as there are lanes.
    Interleaved,
}

/// Why a capture could not be read.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// The system could not read.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// No radar has so many lanes.
    #[error("recording.capture.lanes is {0}; expected 2 or 4")]
    Lanes(usize),
    /// Samples or receivers don't fill the lanes.
    #[error("{count} {what} don't fill {lanes} lanes; expected a multiple")]
    Unfilled {
        /// "samples" or "receivers".
        what: &'static str,
        /// How many there are.
        count: usize,
        /// Lanes.
        lanes: usize,
    },
    /// The chirps were not said, or are none of the loop's.
    #[error(
        "recording.capture.chirps is {found}; expected some of 0 to {last}, each once: the chirps of a loop that form the line of elements, in order"
    )]
    Chirps {
        /// What was said.
        found: String,
        /// Last chirp of the loop.
        last: usize,
    },
    /// There is no such loop.
    #[error("recording.capture.loop is {asked}; expected 0 to {last}", last = loops - 1)]
    NoLoop {
        /// The loop asked for.
        asked: usize,
        /// Loops of a frame.
        loops: usize,
    },
    /// The file's size contradicts the `.cfg`.
    #[error(
        "has {bytes} bytes; expected {expected}: a frame has {chirps} chirps of {receivers} receivers and {samples} samples of 4 bytes"
    )]
    Size {
        /// Size found.
        bytes: u64,
        /// What would fit.
        expected: String,
        /// Chirps of a frame.
        chirps: usize,
        /// Receivers.
        receivers: usize,
        /// Samples of a chirp.
        samples: usize,
    },
    /// There is no such frame.
    #[error("recording.capture.frame is {asked}; expected 0 to {last}, the file holds {frames} frames", last = frames.saturating_sub(1))]
    NoFrame {
        /// The frame asked for.
        asked: usize,
        /// Whole frames of the file.
        frames: u64,
    },
    /// More numbers than are read.
    #[error("a loop holds more than {MAX_NUMBERS} numbers")]
    TooLarge,
}

impl Capture {
    /// Reads one loop: `[chirps, receivers, samples]`. Nothing else of the file is read.
    ///
    /// # Errors
    /// [`CaptureError`] where the layout, the `.cfg` and the file don't fit each other.
    pub fn read(&self, mut file: impl Read + Seek, profile: &RadarProfile) -> Result<Array3<Complex64>, CaptureError> {
        self.check_lanes(profile)?;
        let chosen = self.chosen_chirps(profile)?;
        let (chirps, receivers, samples) = (profile.chirp_transmitters.len(), profile.receivers, profile.samples);
        let numbers = bounded_count(&[chirps, receivers, samples]).ok_or(CaptureError::TooLarge)?;
        let loop_bytes = 4 * numbers as u64;
        self.check_size(file.seek(SeekFrom::End(0))?, loop_bytes, profile)?;
        let start = (self.frame as u64 * profile.loops as u64 + self.loop_number as u64) * loop_bytes;
        file.seek(SeekFrom::Start(start))?;
        let mut bytes = vec![0; loop_bytes as usize];
        file.read_exact(&mut bytes)?;
        let words: Vec<f64> = bytes.chunks_exact(2).map(|b| f64::from(i16::from_le_bytes([b[0], b[1]]))).collect();
        // A block is `lanes` real parts and then `lanes` imaginary parts.
        let value = |number: usize| {
            let (block, lane) = (number / self.lanes, number % self.lanes);
            let at = 2 * self.lanes * block + lane;
            Complex64::new(words[at], words[at + self.lanes])
        };
        let numbered = |chirp: usize, receiver: usize, sample: usize| {
            let within = match self.receivers {
                ReceiverOrder::OneAfterAnother => receiver * samples + sample,
                ReceiverOrder::Interleaved => sample * receivers + receiver,
            };
            value(chirp * receivers * samples + within)
        };
        let mut out = Array3::zeros((chosen.len(), receivers, samples));
        for (place, chirp) in chosen.into_iter().enumerate() {
            let mut line = out.slice_mut(s![place, .., ..]);
            line.indexed_iter_mut().for_each(|((receiver, sample), v)| *v = numbered(chirp, receiver, sample));
        }
        Ok(out)
    }

    fn check_lanes(&self, profile: &RadarProfile) -> Result<(), CaptureError> {
        if ![2, 4].contains(&self.lanes) {
            return Err(CaptureError::Lanes(self.lanes));
        }
        let (what, count) = match self.receivers {
            ReceiverOrder::OneAfterAnother => ("samples", profile.samples),
            ReceiverOrder::Interleaved => ("receivers", profile.receivers),
        };
        let fills = count.is_multiple_of(self.lanes);
        if fills { Ok(()) } else { Err(CaptureError::Unfilled { what, count, lanes: self.lanes }) }
    }

    /// The chirps that form the line of elements.
    fn chosen_chirps(&self, profile: &RadarProfile) -> Result<Vec<usize>, CaptureError> {
        let last = profile.chirp_transmitters.len() - 1;
        match &self.chirps {
            None if last == 0 => Ok(vec![0]),
            None => Err(CaptureError::Chirps { found: "missing".to_owned(), last }),
            Some(chirps) => {
                let mut sorted = chirps.clone();
                sorted.sort_unstable();
                sorted.dedup();
                let good = !sorted.is_empty() && sorted.len() == chirps.len() && sorted.iter().all(|c| *c <= last);
                if good { Ok(chirps.clone()) } else { Err(CaptureError::Chirps { found: format!("{chirps:?}"), last }) }
            }
        }
    }

    /// A radar that was told how many frames to send leaves whole ones; one that was stopped may leave a part.
    fn check_size(&self, bytes: u64, loop_bytes: u64, profile: &RadarProfile) -> Result<(), CaptureError> {
        if self.loop_number >= profile.loops {
            return Err(CaptureError::NoLoop { asked: self.loop_number, loops: profile.loops });
        }
        let frame_bytes = loop_bytes * profile.loops as u64;
        let whole = frame_bytes * profile.frames as u64;
        let fits = if profile.frames == 0 { bytes >= frame_bytes } else { bytes == whole };
        if !fits {
            let expected = match profile.frames {
                0 => format!("at least {frame_bytes}"),
                frames => format!("{whole} for {frames} frames"),
            };
            let chirps = profile.loops * profile.chirp_transmitters.len();
            let RadarProfile { receivers, samples, .. } = *profile;
            return Err(CaptureError::Size { bytes, expected, chirps, receivers, samples });
        }
        let frames = bytes / frame_bytes;
        if self.frame as u64 >= frames {
            return Err(CaptureError::NoFrame { asked: self.frame, frames });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::profile::tests::CFG;
    use super::*;
    use proptest::prelude::*;
    use std::io::Cursor;

    fn profile() -> RadarProfile {
        RadarProfile::parse(CFG).unwrap()
    }

    fn capture(lanes: usize, receivers: ReceiverOrder) -> Capture {
        Capture { config: String::new(), lanes, receivers, chirps: Some(vec![0, 1]), frame: 0, loop_number: 0 }
    }

    /// The number that stands for a sample in the written files.
    fn expected(turn: usize, chirp: usize, receiver: usize, sample: usize) -> Complex64 {
        let code = (1000 * turn + 100 * chirp + 10 * receiver + sample) as f64;
        Complex64::new(code, -code - 1.0)
    }

    /// `loops` loops as the lanes send them, written out by the words of the capture card's documentation.
    fn file(loops: usize, lanes: usize, receivers: ReceiverOrder) -> Vec<u8> {
        let mut stream = Vec::new();
        for turn in 0..loops {
            for chirp in 0..2 {
                match receivers {
                    ReceiverOrder::OneAfterAnother => {
                        (0..4).for_each(|r| (0..8).for_each(|s| stream.push(expected(turn, chirp, r, s))));
                    }
                    ReceiverOrder::Interleaved => {
                        (0..8).for_each(|s| (0..4).for_each(|r| stream.push(expected(turn, chirp, r, s))));
                    }
                }
            }
        }
        let part = |v: f64| (v as i16).to_le_bytes();
        let block = |b: &[Complex64]| -> Vec<u8> {
            b.iter().flat_map(|v| part(v.re)).chain(b.iter().flat_map(|v| part(v.im))).collect()
        };
        stream.chunks_exact(lanes).flat_map(block).collect()
    }

    #[test]
    fn every_layout_gives_every_sample_its_place() {
        for lanes in [2, 4] {
            for order in [ReceiverOrder::OneAfterAnother, ReceiverOrder::Interleaved] {
                let layout = Capture { frame: 1, loop_number: 1, ..capture(lanes, order) };
                let found = layout.read(Cursor::new(file(4, lanes, order)), &profile()).unwrap();
                assert_eq!(found.dim(), (2, 4, 8));
                for ((chirp, receiver, sample), v) in found.indexed_iter() {
                    assert_eq!(*v, expected(3, chirp, receiver, sample), "{lanes} lanes, {order:?}");
                }
            }
        }
        let order = ReceiverOrder::OneAfterAnother;
        let turned = Capture { chirps: Some(vec![1]), ..capture(2, order) };
        let found = turned.read(Cursor::new(file(2, 2, order)), &profile()).unwrap();
        assert_eq!((found.dim(), found[[0, 2, 5]]), ((1, 4, 8), expected(0, 1, 2, 5)));
    }

    #[test]
    fn two_lanes_stand_as_the_documentation_prints_them() {
        let words: Vec<i16> = file(1, 2, ReceiverOrder::OneAfterAnother)
            .chunks_exact(2)
            .map(|b| i16::from_le_bytes([b[0], b[1]]))
            .collect();
        assert_eq!(words[..8], [0, 1, -1, -2, 2, 3, -3, -4], "I0 I1 Q0 Q1 I2 I3 Q2 Q3");
    }

    #[test]
    fn contradictions_are_told() {
        let order = ReceiverOrder::OneAfterAnother;
        let whole = file(2, 2, order);
        let message = |capture: Capture, profile: &RadarProfile, bytes: &[u8]| {
            capture.read(Cursor::new(bytes), profile).unwrap_err().to_string()
        };
        let usual = || capture(2, order);
        for (changed, part) in [
            (Capture { lanes: 3, ..usual() }, "2 or 4"),
            (Capture { chirps: None, ..usual() }, "chirps is missing; expected some of 0 to 1"),
            (Capture { chirps: Some(vec![0, 0]), ..usual() }, "each once"),
            (Capture { chirps: Some(vec![2]), ..usual() }, "0 to 1"),
            (Capture { frame: 1, ..usual() }, "frame is 1; expected 0 to 0"),
            (Capture { loop_number: 2, ..usual() }, "loop is 2; expected 0 to 1"),
        ] {
            let message = message(changed, &profile(), &whole);
            assert!(message.contains(part), "{message}");
        }
        assert!(message(usual(), &profile(), &whole[..100]).contains("at least 512: a frame has 4 chirps of 4"));
        let three = RadarProfile { frames: 3, ..profile() };
        assert!(message(usual(), &three, &whole).contains("1536 for 3 frames"));
        let odd = RadarProfile { samples: 7, ..profile() };
        assert!(message(usual(), &odd, &whole).contains("7 samples don't fill 2 lanes"));
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..1200), frame in 0usize..9) {
            let layout = Capture { frame, ..capture(2, ReceiverOrder::OneAfterAnother) };
            if let Ok(found) = layout.read(Cursor::new(&bytes), &profile()) {
                prop_assert!(found.len() * 4 <= bytes.len());
            }
        }
    }
}
