//! Raw captures: 16-bit samples as a capture card writes them, in one of several layouts ([`layout`](super::layout)).
//!
//! The layout of TI's card (DCA1000) is that of "Mmwave Radar Device ADC Raw Data Capture" (SWRA581).
//!
//! | file | content |
//! |---|---|
//! | `table` | the table `[recording.capture]` of the TOML |
//! | `plan` | counts, sizes and byte offsets of the file |
//! | `frame` | a frame, `[loops, chirps, receivers, samples]` |
//! | `quality` | zeros of lost packets, saturation, constant parts, real samples |
//! | `doppler` | the strong Doppler cells of each range bin |
//! | `channels` | transmitters that send at once, factors of channels and range bias by the `.cfg` |

mod channels;
mod doppler;
mod frame;
mod plan;
mod quality;
mod table;
#[cfg(test)]
mod tests;

pub(super) use frame::Frame;
pub(super) use plan::CapturePlan;
pub use table::{Capture, Treatment};

use super::Fault;
use super::axes::{ChirpChoice, Join};
use super::layout::stream::CaptureStream;
use super::profile::RadarProfile;
use channels::Channels;
use ndarray::{Array3, Array4};
use num_complex::Complex64;
use quality::Quality;
use std::io::{Read, Seek};

/// Joins the loops of an array, `[loops, transmitters, receivers, samples]`, by the strong Doppler cells of each range bin, and returns a sentence on
/// it. `turns` are the phases of the chosen transmitters' pairs for an echo at a cosine of 1, in turns; fewer than pairs where unknown.
pub(super) fn join_strongest(
    samples: Array4<Complex64>,
    chosen: &[usize],
    turns: &[f64],
) -> (Array3<Complex64>, Option<String>) {
    let (loops, chirps, ..) = samples.dim();
    let frame = Frame { samples, quality: Quality::new(loops * chirps) };
    doppler::strongest(&frame, &Channels::default(), chosen, turns)
}

impl Capture {
    /// Reads the frame: the chosen chirps of a loop, the frame and its plan.
    fn frame(
        &self,
        file: impl Read + Seek,
        profile: Option<&RadarProfile>,
    ) -> Result<(Vec<usize>, Frame, CapturePlan), Fault> {
        let mut stream = CaptureStream::new(file)?;
        let plan = CapturePlan::new(self, profile, stream.bytes())?;
        Ok((plan.chosen_chirps(self)?, Frame::read(&mut stream, self, &plan)?, plan))
    }

    /// Reads the loop or joins the loops of the frame, `[chirps, receivers, samples]`, with sentences on doubts. `turns` are as in [`join_strongest`];
    /// `beat_rises` where an echo's phase rises from sample to sample.
    /// # Errors
    /// [`Fault`] where the layout, the `.cfg` and the file contradict each other.
    pub(super) fn read(
        &self,
        file: impl Read + Seek,
        profile: Option<&RadarProfile>,
        turns: &[f64],
        beat_rises: bool,
    ) -> Result<(Array3<Complex64>, Vec<String>), Fault> {
        let (chosen, frame, plan) = self.frame(file, profile)?;
        let mut notes = plan.notes.clone();
        notes.extend(frame.quality.sentences(&plan, self.constant == Treatment::Out));
        let channels = Channels::new(profile, &plan);
        notes.extend(channels.notes());
        let rows = match self.loop_choice {
            ChirpChoice::Number(turn) => {
                channels.correct_loop(&frame.samples.index_axis(ndarray::Axis(0), turn.min(frame.loops() - 1)))
            }
            ChirpChoice::Joined(Join::Mean) => channels.correct_loop(&frame.mean().view()),
            ChirpChoice::Joined(Join::Strongest) => {
                let (rows, note) = doppler::strongest(&frame, &channels, &chosen, turns);
                notes.extend(note);
                rows
            }
        };
        let mut rows = rows.select(ndarray::Axis(0), &chosen);
        if let Some(taken) = &self.receivers_taken {
            rows = rows.select(ndarray::Axis(1), &plan.chosen_receivers(taken)?);
        }
        if let Some(profile) = profile {
            channels::remove_range_bias(&mut rows, profile, beat_rises);
        }
        Ok((rows, notes))
    }

    /// Reads every loop of the frame, `[loops, elements, samples]`. Elements are the receivers of the chosen chirps.
    pub(super) fn loops(
        &self,
        file: impl Read + Seek,
        profile: Option<&RadarProfile>,
    ) -> Result<Array3<Complex64>, Fault> {
        let (chosen, frame, _) = self.frame(file, profile)?;
        let samples = frame.samples.select(ndarray::Axis(1), &chosen);
        let (loops, chirps, receivers, len) = samples.dim();
        let whole = samples.as_standard_layout().into_owned();
        whole.into_shape_with_order((loops, chirps * receivers, len)).map_err(|e| Fault::Data(e.to_string()))
    }
}
