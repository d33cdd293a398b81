//! Beams of both ends with their phases, and what rows of reflectors would have left in them.
//!
//! A row's echoes are looked up in the beams where they would stand and added with the phases they would have: far cheaper than to
//! write out samples, and good enough to tell which rows are worth that.

use super::end_beams::{beam_of_cos, end_beams};
use crate::radar::{End, Radar};
use crate::signal::simd::{LANES_F64, Lanes, phasor};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Beams formed by each end: fine enough to take the nearest.
pub const BEAMS: usize = 96;

/// Nearest that a place of a row counts as, metres.
const NEAREST_METRES: f64 = 0.05;

const W: usize = LANES_F64;

/// Beams of both ends, referred to the middle of the chirp and of the end so that they vary slowly with range and angle.
pub struct PhasedBeams {
    /// `[beam * bins + range bin]` for each end.
    pub beams: [Vec<Complex64>; 2],
    /// Where the middle of each end stands on the array's axis, metres.
    pub centres_metres: [f64; 2],
    pub bins: usize,
    pub bins_per_metre: f64,
    /// Phase of an echo at the middle of the chirp, turns a metre.
    pub turns_per_metre: f64,
    /// Referred to the middle of the chirp, the rows of an even number of samples change sign with every wrap.
    wrap_sign: f64,
}

/// Places at equal steps along a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The first place (x, y), metres.
    pub first_metres: [f64; 2],
    /// From one place to the next (x, y), metres.
    pub step_metres: [f64; 2],
}

/// What a reflector would have left at an end, its phase taken off.
#[derive(Debug, Clone, Copy, Default)]
pub struct Heard {
    /// Value times the amplitude 1/R^2.
    pub weighted: Complex64,
    /// Square of the amplitude.
    pub weight: f64,
}

impl Row {
    /// Place number `i`, (x, y) in metres.
    #[inline(always)]
    pub fn place_metres(&self, i: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.first_metres[axis] + i * self.step_metres[axis])
    }
}

impl PhasedBeams {
    /// Forms the beams of `residual` (all samples of both ends, not windowed).
    pub fn new(radar: &Radar, residual: &[Complex64]) -> Self {
        let bins = radar.samples;
        let middle = (bins as f64 - 1.0) / 2.0;
        let shift: Vec<Complex64> =
            (0..bins).map(|bin| Complex64::cis(TAU * (bin as f64 * middle / bins as f64).fract())).collect();
        let beams = end_beams(radar, residual, BEAMS).map(|mut beams| {
            beams.outer_iter_mut().for_each(|mut row| row.iter_mut().zip(&shift).for_each(|(b, shift)| *b *= shift));
            beams.into_raw_vec_and_offset().0
        });
        PhasedBeams {
            beams,
            centres_metres: End::BOTH.map(|e| radar.end_centre_metres(e)),
            bins,
            bins_per_metre: 1.0 / radar.range_resolution_metres(),
            turns_per_metre: radar.carrier.turns_per_wavelength() / radar.wavelength_metres()
                + middle / radar.max_range_metres(),
            wrap_sign: if bins.is_multiple_of(2) { -1.0 } else { 1.0 },
        }
    }

    /// Energy of all elements' profiles in each range bin of an end, summed up to it: one entry more than there are bins.
    pub fn running_energy(&self, end: usize) -> Vec<f64> {
        let mut running = vec![0.0; self.bins + 1];
        for beam in self.beams[end].chunks_exact(self.bins) {
            // By Parseval's theorem, as the beams are evenly spaced.
            running[1..].iter_mut().zip(beam).for_each(|(sum, v)| *sum += v.norm_sqr() / BEAMS as f64);
        }
        for bin in 0..self.bins {
            running[bin + 1] += running[bin];
        }
        running
    }

    /// What each reflector of `row`, one for each of `heard`, would have left at an end.
    #[inline(always)]
    pub fn listen<const FMA: bool>(&self, end: usize, row: &Row, heard: &mut [Heard]) {
        let PhasedBeams { bins, bins_per_metre, turns_per_metre, wrap_sign, .. } = *self;
        let [x, y] = row.first_metres;
        let [step_x, step_y] = row.step_metres;
        let from = x - self.centres_metres[end];
        for (block, heard) in heard.chunks_mut(W).enumerate() {
            let i = Lanes::<f64, W>(std::array::from_fn(|lane| (block * W + lane) as f64));
            let dx = i * Lanes::splat(step_x) + Lanes::splat(from);
            let y = i * Lanes::splat(step_y) + Lanes::splat(y);
            let range = (dx * dx + y * y).sqrt().map(|r| if r > NEAREST_METRES { r } else { NEAREST_METRES });
            let phase = phasor::<f64, W, FMA>(range * Lanes::splat(-turns_per_metre));
            let amplitude = range.map(|r| 1.0 / (r * r));
            for (lane, heard) in heard.iter_mut().enumerate() {
                let beam = &self.beams[end][beam_of_cos(dx.0[lane] / range.0[lane], BEAMS) * bins..][..bins];
                let at = range.0[lane] * bins_per_metre;
                let (low, part) = (at as usize, at.fract());
                // Neighbouring rows differ by half a turn (the middle of the chirp): `new` already took that off.
                let row = |k: usize| if k < bins { beam[k] } else { wrapped(beam, k, wrap_sign) };
                let value = row(low) * (1.0 - part) + row(low + 1) * part;
                let amplitude = amplitude.0[lane];
                let phase = Complex64::new(phase.re.0[lane], phase.im.0[lane]);
                *heard = Heard { weighted: value * phase * amplitude, weight: amplitude * amplitude };
            }
        }
    }
}

/// Row `k` of a beam beyond its last.
#[cold]
fn wrapped(beam: &[Complex64], k: usize, wrap_sign: f64) -> Complex64 {
    let value = beam[k % beam.len()];
    if (k / beam.len()) % 2 == 1 { value * wrap_sign } else { value }
}
