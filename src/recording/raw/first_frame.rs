//! The first frame of a capture: the constant part, and the order of a cascade's chips.

use super::boards::{self, Board};
use crate::recording::capture::{Capture, CapturePlan, Frame};
use crate::recording::layout::stream::CaptureStream;
use crate::recording::profile::RadarProfile;
use ndarray::{Array1, Array2, ArrayView1, Axis};
use num_complex::Complex64;
use std::f64::consts::PI;
use std::io::{Read, Seek};

/// Number of directions on each side in which the power of a beam is computed. Their distance is about half the width of a beam of 54 half wavelengths.
const MAX_DIRECTION: i32 = 128;
/// Least part of the power in one beam of receivers in order from the left, and least ratio to that of receivers in the chips' order, for the order from
/// the left. Without calibration no order has such a beam.
const MIN_BEAM_PART: f64 = 0.9;
const MIN_BEAM_RATIO: f64 = 1.03;

/// Figures on the first frame.
#[derive(Default)]
pub(super) struct FirstFrame {
    /// Power of the constant part relative to the rest, decibels; `None` below 0.
    pub constant_db: Option<f64>,
    /// Number of whole frames in the file.
    pub frames: u64,
    /// The first chirp, `[receivers, samples]`.
    chirp: Array2<Complex64>,
}

impl FirstFrame {
    /// Reads the first frame by the layout in `capture`. All figures are empty where that fails.
    pub fn read<R: Read + Seek>(
        stream: &mut CaptureStream<R>,
        capture: &Capture,
        profile: Option<&RadarProfile>,
    ) -> FirstFrame {
        let Ok(plan) = CapturePlan::new(capture, profile, stream.bytes()) else { return FirstFrame::default() };
        let Ok(Frame { samples, quality }) = Frame::read(stream, capture, &plan) else {
            return FirstFrame { frames: plan.frames, ..FirstFrame::default() };
        };
        let constant_db = quality.has_strong_constant().then_some(quality.constant_db);
        let chirp = samples.index_axis(Axis(0), 0).index_axis(Axis(0), 0).to_owned();
        FirstFrame { constant_db, frames: plan.frames, chirp }
    }

    /// The cascade with its receivers in the order of the file: from the left, or chip by chip.
    pub fn cascade(&self) -> &'static Board {
        let by_chip = &boards::BY_CHIP;
        let Some(from_left) = boards::by_name(by_chip.name) else { return by_chip };
        let beam = self.beam(from_left);
        if beam > MIN_BEAM_PART && beam > MIN_BEAM_RATIO * self.beam(by_chip) { from_left } else { by_chip }
    }

    /// Part of the power in the strongest beam, for receivers in the order of the board. The constant part is subtracted.
    fn beam(&self, board: &Board) -> f64 {
        let mean = |row: ArrayView1<'_, Complex64>| row.sum() / row.len().max(1) as f64;
        let centred: Vec<_> = self.chirp.outer_iter().map(|row| row.mapv(|v| v - mean(row))).collect();
        let power = |row: &Array1<Complex64>| row.iter().map(Complex64::norm_sqr).sum::<f64>();
        let all = centred.iter().map(power).sum::<f64>() * centred.len() as f64;
        let beam_power = |step: i32| {
            let cosine = f64::from(step) / f64::from(MAX_DIRECTION);
            let mut sum = Array1::zeros(self.chirp.ncols());
            for (row, place) in centred.iter().zip(board.receivers) {
                sum.scaled_add(Complex64::from_polar(1.0, PI * place * cosine), row);
            }
            power(&sum)
        };
        (-MAX_DIRECTION..=MAX_DIRECTION).map(beam_power).fold(0.0, f64::max) / all.max(f64::MIN_POSITIVE)
    }
}
