//! Neighbouring points of a column of the coarse grid, added a few at a time with the phases that a line there predicts.

use super::phased::{AddedUp, Heard, PhasedBeams, Row, added_up};
use crate::signal::simd::{Kernel, Simd};

/// Points added with their phases before magnitudes are taken.
pub const BLOCK: usize = 5;

/// Blocks of which one is looked at in a [`glance`].
pub const GLANCED: usize = 3;

/// What each of the first `count` reflectors of a row would have left at an end.
pub fn heard_along(beams: &PhasedBeams, end: usize, row: Row, count: usize) -> Vec<Heard> {
    let mut heard = vec![Heard::default(); count];
    Simd::chosen().run(Column { beams, end, row, every: 1, heard: &mut heard });
    heard
}

/// A block by itself.
#[derive(Debug, Clone, Copy)]
pub struct Block {
    /// Square of its gain's magnitude.
    pub power: f64,
    /// Sum of its points' squared amplitudes.
    pub weight: f64,
}

/// Every [`GLANCED`]th block of the first `points` of a row, none of which overlap.
pub fn glance(beams: &PhasedBeams, end: usize, row: Row, points: usize) -> Vec<Block> {
    let mut heard = vec![Heard::default(); points / (GLANCED * BLOCK) * BLOCK];
    Simd::chosen().run(Column { beams, end, row, every: GLANCED, heard: &mut heard });
    let block = |points: &[Heard]| {
        let AddedUp { sum, weight, .. } = added_up(points);
        Block { power: sum.norm_sqr() / (weight * weight), weight }
    };
    heard.chunks_exact(BLOCK).map(block).collect()
}

/// What a column of reflectors would have left at one end.
struct Column<'a> {
    beams: &'a PhasedBeams,
    end: usize,
    row: Row,
    /// One block in so many.
    every: usize,
    heard: &'a mut [Heard],
}

impl Kernel for Column<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let number = |n: usize| (n / BLOCK * self.every * BLOCK + n % BLOCK) as f64;
        self.beams.listen_to::<FMA>(self.end, &self.row, number, self.heard);
    }
}

/// Blocks of neighbouring points in one column of the grid as one end sees them, one for every first point.
pub struct Blocks {
    /// Magnitude of each block's gain.
    pub gain: Vec<f64>,
    /// Running sums of gain and weight (sum of squared amplitudes) in steps of [`BLOCK`] points.
    running: Vec<[f64; 2]>,
}

impl Blocks {
    /// Of the first `points` of `row`.
    pub fn new(beams: &PhasedBeams, end: usize, row: Row, points: usize) -> Self {
        let many = points.saturating_sub(BLOCK) + 1;
        let mut gain = vec![0.0; many];
        let mut running = vec![[0.0; 2]; many];
        let echoes = heard_along(beams, end, row, points.max(BLOCK));
        Simd::chosen().run(FillBlocks { echoes: &echoes, gain: &mut gain, running: &mut running });
        Blocks { gain, running }
    }

    /// Sum of gains and of weights of `count` blocks, one behind the other from point `start`.
    pub fn totals(&self, start: usize, count: usize) -> [f64; 2] {
        let last = self.running[start + (count - 1) * BLOCK];
        let before = if start >= BLOCK { self.running[start - BLOCK] } else { [0.0; 2] };
        [last[0] - before[0], last[1] - before[1]]
    }
}

/// The blocks of what a column of points would have left.
struct FillBlocks<'a> {
    echoes: &'a [Heard],
    gain: &'a mut [f64],
    running: &'a mut [[f64; 2]],
}

impl Kernel for FillBlocks<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let FillBlocks { echoes, gain, running } = self;
        let mut sums = vec![[0.0; 3]; echoes.len() + 1];
        let mut sum = [0.0; 3];
        for (echo, at) in echoes.iter().zip(&mut sums[1..]) {
            sum = [sum[0] + echo.weighted.re, sum[1] + echo.weighted.im, sum[2] + echo.weight];
            *at = sum;
        }
        for (i, (gain, both)) in gain.iter_mut().zip(running.iter_mut()).enumerate() {
            let (first, last) = (sums[i], sums[i + BLOCK]);
            let [re, im, weight] = [0, 1, 2].map(|k| last[k] - first[k]);
            *gain = (re * re + im * im).sqrt() / weight;
            *both = [*gain, weight];
        }
        for i in BLOCK..running.len() {
            let before = running[i - BLOCK];
            running[i] = [running[i][0] + before[0], running[i][1] + before[1]];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::signal::floor::unit_noise;
    use num_complex::Complex64;

    #[test]
    fn a_glance_is_every_third_block() {
        let radar = Radar::default();
        let samples: Vec<Complex64> = unit_noise(5, 0).take(2 * radar.end_elements * radar.samples).collect();
        let beams = PhasedBeams::new(&radar, &samples);
        let row = Row { first_metres: [-3.0, 5.0], step_metres: [0.0, 0.1] };
        let all = Blocks::new(&beams, 1, row, 100);
        let some = glance(&beams, 1, row, 100);
        assert_eq!(some.len(), 6);
        for (i, block) in some.iter().enumerate() {
            let start = i * GLANCED * BLOCK;
            let gain = all.gain[start];
            assert!((block.power - gain * gain).abs() < 1e-9 * gain * gain, "{i}: {} {gain}", block.power);
            assert!((block.weight - all.totals(start, 1)[1]).abs() < 1e-9 * block.weight);
        }
    }
}
