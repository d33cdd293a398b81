//! Raw captures: 16-bit samples as a capture card writes them, one layout or another ([`layout`](super::layout)).
//!
//! The layout of TI's card (DCA1000) is that of "Mmwave Radar Device ADC Raw Data Capture" (SWRA581).
//!
//! | file | what it does |
//! |---|---|
//! | `plan` | what stands where in the file |
//! | `frame` | reads a frame, `[loops, chirps, receivers, samples]` |
//! | `quality` | zeros of lost packets, saturation, constant parts, real samples |
//! | `doppler` | the strongest Doppler cell of each range bin, chirps in time division compensated |
//! | `channels` | transmitters that send together, phases and range bias that a `.cfg` says |

mod channels;
mod doppler;
mod error;
mod frame;
mod plan;
mod quality;
#[cfg(test)]
mod tests;

pub use super::layout::ReceiverOrder;
pub use error::CaptureError;
pub(super) use frame::Frame;
pub(super) use plan::Plan;

use super::layout::stream::Stream;
use super::layout::{Parts, Words};
use super::profile::RadarProfile;
use channels::Channels;
use ndarray::Array3;
use num_complex::Complex64;
use serde::Deserialize;
use std::io::{Read, Seek};

/// How a capture is laid out, and which part of it is looked at.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capture {
    /// Name of the `.cfg`, beside the TOML; without one the counts are said here.
    pub config: Option<String>,
    /// Which sub-frame of an advanced frame, from 0.
    pub sub_frame: Option<usize>,
    /// Files that go on from the first, in order.
    #[serde(default)]
    pub more_files: Vec<String>,
    /// 16 bits to a number.
    #[serde(default)]
    pub words: Words,
    /// Order of real and imaginary parts.
    pub parts: Option<Parts>,
    /// Lanes of the radar in place of `parts`: 2 (xWR16xx, 18xx, 68xx) or 4 (xWR12xx, 14xx).
    pub lanes: Option<usize>,
    /// Imaginary parts come first.
    #[serde(default)]
    pub q_first: bool,
    /// How the receivers follow one another.
    pub receivers: ReceiverOrder,
    /// Bytes before each chirp that are no samples.
    #[serde(default)]
    pub header_bytes: usize,
    /// Without a `.cfg`: samples of a chirp.
    pub samples: Option<usize>,
    /// Without a `.cfg`: receivers.
    pub receiver_count: Option<usize>,
    /// Without a `.cfg`: chirps of a loop, 1 where nothing is said.
    pub loop_chirps: Option<usize>,
    /// Without a `.cfg`: loops of a frame, 1 where nothing is said.
    pub loops: Option<usize>,
    /// Which chirps of a loop form the line of elements, in this order; all where there is only one.
    pub chirps: Option<Vec<usize>>,
    /// Which receivers form it, by place among those that are on; all where nothing is said.
    pub receivers_taken: Option<Vec<usize>>,
    /// Which frame, from 0.
    #[serde(default)]
    pub frame: usize,
    /// Which loop of the frame, or what all of them make.
    #[serde(default, rename = "loop")]
    pub turn: Turn,
    /// The mean of each chirp's samples: leakage and offset.
    #[serde(default)]
    pub constant: Part,
    /// The mean of all loops: what stands still.
    #[serde(default)]
    pub static_clutter: Part,
}

/// Which of a frame's loops are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a loop's number from 0, \"mean\" or \"strongest\"")]
pub enum Turn {
    /// One, from 0.
    Number(usize),
    /// All of them.
    All(Together),
}

impl Default for Turn {
    fn default() -> Self {
        Turn::Number(0)
    }
}

/// What all loops of a frame make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Together {
    /// Their mean: what moves fades.
    Mean,
    /// Of each range bin the strongest Doppler cell, chirps in time division compensated for its velocity.
    Strongest,
}

/// Whether a part of the samples stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// It stays.
    #[default]
    Keep,
    /// It is taken out.
    Out,
}

/// What the samples of a capture mean.
pub(super) struct Meaning<'a> {
    /// The `.cfg`, where there is one.
    pub profile: Option<&'a RadarProfile>,
    /// Turns of phase across the array for each pair at a cosine of 1, transmitter by transmitter; fewer than pairs where unknown.
    pub turns: &'a [f64],
    /// The beat's phase rises from sample to sample.
    pub beat_rises: bool,
}

impl Capture {
    /// Reads what is looked at: `[chirps, receivers, samples]`, and sentences on what is doubtful. No other frame is read.
    ///
    /// # Errors
    /// [`CaptureError`] where the layout, the `.cfg` and the file don't fit each other.
    pub(super) fn read(
        &self,
        file: impl Read + Seek,
        meaning: &Meaning<'_>,
    ) -> Result<(Array3<Complex64>, Vec<String>), CaptureError> {
        let mut stream = Stream::new(file)?;
        let plan = Plan::new(self, meaning.profile, stream.bytes())?;
        let chosen = plan.chosen_chirps(self)?;
        let frame = Frame::read(&mut stream, self, &plan)?;
        let mut notes = plan.notes.clone();
        notes.extend(frame.quality.sentences(&plan, self.constant == Part::Out));
        let channels = Channels::of(meaning.profile, &plan);
        notes.extend(channels.notes());
        let rows = match self.turn {
            Turn::Number(turn) => {
                channels.of_loop(&frame.samples.index_axis(ndarray::Axis(0), turn.min(frame.loops() - 1)))
            }
            Turn::All(Together::Mean) => channels.of_loop(&frame.mean().view()),
            Turn::All(Together::Strongest) => {
                let (rows, note) = doppler::strongest(&frame, &channels, &chosen, meaning.turns);
                notes.extend(note);
                rows
            }
        };
        let mut rows = rows.select(ndarray::Axis(0), &chosen);
        if let Some(taken) = &self.receivers_taken {
            rows = rows.select(ndarray::Axis(1), &plan.taken(taken)?);
        }
        if let Some(profile) = meaning.profile {
            channels::take_off_bias(&mut rows, profile, meaning.beat_rises);
        }
        Ok((rows, notes))
    }

    /// Reads every loop of the frame, `[loops, elements, samples]`: the elements are the chosen chirps' receivers.
    ///
    /// # Errors
    /// As [`Capture::read`].
    pub(super) fn loops(
        &self,
        file: impl Read + Seek,
        profile: Option<&RadarProfile>,
    ) -> Result<Array3<Complex64>, CaptureError> {
        let mut stream = Stream::new(file)?;
        let plan = Plan::new(self, profile, stream.bytes())?;
        let chosen = plan.chosen_chirps(self)?;
        let samples = Frame::read(&mut stream, self, &plan)?.samples.select(ndarray::Axis(1), &chosen);
        let (loops, chirps, receivers, len) = samples.dim();
        let whole = samples.as_standard_layout().into_owned();
        // The same numbers in the same order: the shape can't fail to fit.
        whole.into_shape_with_order((loops, chirps * receivers, len)).map_err(|_| CaptureError::TooLarge)
    }
}
