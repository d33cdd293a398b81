//! What the first frame of a capture tells beside its layout.

use super::boards::{self, Board};
use crate::recording::capture::{Capture, Frame, Plan};
use crate::recording::layout::stream::Stream;
use crate::recording::profile::RadarProfile;
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use std::f64::consts::PI;
use std::io::{Read, Seek};

/// Directions in which a beam is looked for: half of the beam of 54 half wavelengths apart.
const DIRECTIONS: i32 = 128;
/// The receivers of a cascade stand from left to right in the file where a beam of them is so many times stronger than by chips.
const MORE_BEAM: f64 = 1.2;

/// What the first frame tells.
#[derive(Default)]
pub(super) struct FirstFrame {
    /// How far the constant part stands above all else, decibels, where it does.
    pub constant_db: Option<f64>,
    /// How many whole frames there are.
    pub frames: u64,
    /// The first chirp, `[receivers, samples]`.
    chirp: Array2<Complex64>,
}

impl FirstFrame {
    /// Reads it as `capture` says; what can't be read tells nothing.
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
        match boards::by_name(by_chip.name) {
            Some(from_left) if self.beam(from_left) > MORE_BEAM * self.beam(by_chip) => from_left,
            _ => by_chip,
        }
    }

    /// Power of the strongest beam of receivers that stand as on the board.
    fn beam(&self, board: &Board) -> f64 {
        let mean = |row: ndarray::ArrayView1<'_, Complex64>| row.sum() / row.len().max(1) as f64;
        let centred: Vec<_> = self.chirp.outer_iter().map(|row| row.mapv(|v| v - mean(row))).collect();
        let power = |step: i32| {
            let cosine = f64::from(step) / f64::from(DIRECTIONS);
            let mut sum = ndarray::Array1::zeros(self.chirp.ncols());
            for (row, place) in centred.iter().zip(board.receivers) {
                sum.scaled_add(Complex64::from_polar(1.0, PI * place * cosine), row);
            }
            sum.iter().map(Complex64::norm_sqr).sum::<f64>()
        };
        (-DIRECTIONS..=DIRECTIONS).map(power).fold(0.0, f64::max)
    }
}
