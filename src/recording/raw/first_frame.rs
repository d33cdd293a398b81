//! The first frame of a capture: figures on it that its layout doesn't tell.

use super::boards::{self, Board};
use crate::recording::capture::{Capture, Frame, Plan};
use crate::recording::layout::stream::Stream;
use crate::recording::profile::RadarProfile;
use ndarray::{Array1, Array2, ArrayView1, Axis};
use num_complex::Complex64;
use std::f64::consts::PI;
use std::io::{Read, Seek};

/// Directions in which a beam is looked for: half of the beam of 54 half wavelengths apart.
const DIRECTIONS: i32 = 128;
/// Least part of all power in one beam of the receivers from left to right for which they stand so in the file, and least ratio to the beam by chips:
/// chips that are not calibrated make no such beam in any order.
const WHOLE_BEAM: f64 = 0.9;
const MORE_BEAM: f64 = 1.03;

/// Figures on the first frame.
#[derive(Default)]
pub(super) struct FirstFrame {
    /// Power of the constant part over that of the rest, decibels, where it stands out.
    pub constant_db: Option<f64>,
    /// Number of whole frames in the file.
    pub frames: u64,
    /// The first chirp, `[receivers, samples]`.
    chirp: Array2<Complex64>,
}

impl FirstFrame {
    /// Reads the frame as `capture` says. Without a readable frame all figures are empty.
    pub fn read<R: Read + Seek>(
        stream: &mut Stream<R>,
        capture: &Capture,
        profile: Option<&RadarProfile>,
    ) -> FirstFrame {
        let Ok(plan) = Plan::new(capture, profile, stream.bytes()) else { return FirstFrame::default() };
        let Ok(Frame { samples, quality }) = Frame::read(stream, capture, &plan) else {
            return FirstFrame { frames: plan.frames, ..FirstFrame::default() };
        };
        let constant_db = quality.tells_constant().then_some(quality.constant_db);
        let chirp = samples.index_axis(Axis(0), 0).index_axis(Axis(0), 0).to_owned();
        FirstFrame { constant_db, frames: plan.frames, chirp }
    }

    /// The cascade whose receivers stand in the order of the file: as its chips count them, or from the left.
    pub fn cascade(&self) -> &'static Board {
        let by_chip = &boards::BY_CHIP;
        let Some(from_left) = boards::by_name(by_chip.name) else { return by_chip };
        let beam = self.beam(from_left);
        if beam > WHOLE_BEAM && beam > MORE_BEAM * self.beam(by_chip) { from_left } else { by_chip }
    }

    /// Part of the power, without the constant part, in the strongest beam of receivers that stand as on the board.
    fn beam(&self, board: &Board) -> f64 {
        let mean = |row: ArrayView1<'_, Complex64>| row.sum() / row.len().max(1) as f64;
        let centred: Vec<_> = self.chirp.outer_iter().map(|row| row.mapv(|v| v - mean(row))).collect();
        let power = |row: &Array1<Complex64>| row.iter().map(Complex64::norm_sqr).sum::<f64>();
        let all = centred.iter().map(power).sum::<f64>() * centred.len() as f64;
        let towards = |step: i32| {
            let cosine = f64::from(step) / f64::from(DIRECTIONS);
            let mut sum = Array1::zeros(self.chirp.ncols());
            for (row, place) in centred.iter().zip(board.receivers) {
                sum.scaled_add(Complex64::from_polar(1.0, PI * place * cosine), row);
            }
            power(&sum)
        };
        (-DIRECTIONS..=DIRECTIONS).map(towards).fold(0.0, f64::max) / all.max(f64::MIN_POSITIVE)
    }
}
