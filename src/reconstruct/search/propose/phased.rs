//! Beams of both ends with their phases, and the echoes of rows of reflectors in them.
//!
//! A row's echoes are looked up in the beams at their places and added with their phases: this is far cheaper than computing samples, and good
//! enough to choose the rows for that.

use super::end_beams::{beam_of_cos, end_beams};
use super::view::View;
use crate::radar::{End, Radar};
use crate::signal::simd::{Kernel, LANES_F64 as W, Lanes, Simd, phasor};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Beams formed by each end: fine enough to take the nearest.
const BEAMS: usize = 96;

/// Least distance of a row's place, metres; nearer places count as this far.
const NEAREST_METRES: f64 = 0.05;

/// Beams of both ends, referred to the middle of the chirp and of the end so that they vary slowly with range and angle.
pub struct PhasedBeams {
    /// `[beam * bins + range bin]` for each end.
    beams: [Vec<Complex64>; 2],
    /// The view of each end.
    pub views: [View; 2],
    bins: usize,
    bins_per_metre: f64,
    /// Phase of an echo at the middle of the chirp, turns a metre.
    pub turns_per_metre: f64,
    /// Sign of a wrap: referred to the middle of the chirp, the rows of an even number of samples change sign with every wrap.
    wrap_sign: f64,
}

/// Places at equal steps along a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The first place (x, y), metres.
    pub first_metres: [f64; 2],
    /// Step from one place to the next (x, y), metres.
    pub step_metres: [f64; 2],
}

/// A reflector's echo at an end, without its phase.
#[derive(Debug, Clone, Copy, Default)]
pub struct Heard {
    /// Value times the amplitude 1/R^2.
    pub weighted: Complex64,
    /// Square of the amplitude.
    pub weight: f64,
}

/// Power of the strongest beam of every range bin at each end.
pub struct Strongest([Vec<f64>; 2]);

/// The beams' power at a place, the smaller of both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Presence {
    /// Power of the beam that looks there, as a part of the strongest beam's in the same range bin.
    pub part: f64,
    /// Power of that strongest beam, scaled over range so that it is constant for one reflectivity.
    pub even_power: f64,
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
            views: End::BOTH.map(|end| View::of(radar, end)),
            bins,
            bins_per_metre: 1.0 / radar.range_resolution_metres(),
            turns_per_metre: radar.carrier.turns_per_wavelength() / radar.wavelength_metres()
                + middle / radar.max_range_metres(),
            wrap_sign: if bins.is_multiple_of(2) { -1.0 } else { 1.0 },
        }
    }

    /// The strongest beams of all range bins.
    pub fn strongest(&self) -> Strongest {
        Strongest(self.beams.each_ref().map(|beams| {
            let mut most = vec![0.0f64; self.bins];
            for beam in beams.chunks_exact(self.bins) {
                most.iter_mut().zip(beam).for_each(|(most, v)| *most = most.max(v.norm_sqr()));
            }
            most
        }))
    }

    /// The beams' power at (x, y), metres.
    pub fn presence(&self, strongest: &Strongest, place_metres: [f64; 2]) -> Presence {
        let of_end = |end: usize| {
            let (range, cos) = self.views[end].of_place(place_metres, NEAREST_METRES);
            let bin = (range * self.bins_per_metre).round() as usize % self.bins;
            let own = self.beams[end][beam_of_cos(cos, BEAMS) * self.bins + bin].norm_sqr();
            let most = strongest.0[end][bin].max(f64::MIN_POSITIVE);
            Presence { part: own / most, even_power: most * range.powi(4) }
        };
        let (a, b) = (of_end(0), of_end(1));
        Presence { part: a.part.min(b.part), even_power: a.even_power.min(b.even_power) }
    }

    /// Range from which on ranges repeat.
    pub fn max_range_metres(&self) -> f64 {
        self.bins as f64 / self.bins_per_metre
    }

    /// Length of a range bin.
    pub fn bin_metres(&self) -> f64 {
        self.bins_per_metre.recip()
    }

    /// Coherent part of the power at the places of each of `rows`, over `count` reflectors of one gain.
    pub fn parts_adding_up(&self, rows: &[Row], count: usize) -> Vec<f64> {
        Simd::chosen().run(PartsAddingUp { beams: self, rows, count })
    }

    /// Coherent part of the power at the places of `row`, one for each of `heard`, under one gain for the row.
    #[inline(always)]
    fn part_adding_up<const FMA: bool>(&self, row: &Row, heard: &mut [Heard]) -> f64 {
        if row.place_metres((heard.len() - 1) as f64)[1] <= 0.0 {
            return 0.0;
        }
        let (mut added, mut all) = (0.0, 0.0);
        for end in 0..self.beams.len() {
            self.listen::<FMA>(end, row, heard);
            let AddedUp { sum, weight, power } = added_up(heard);
            (added, all) = (added + sum.norm_sqr() / weight, all + power);
        }
        added / f64::max(all, f64::MIN_POSITIVE)
    }

    /// Writes the echo of each reflector of `row` at an end, one for each of `heard`.
    #[inline(always)]
    pub fn listen<const FMA: bool>(&self, end: usize, row: &Row, heard: &mut [Heard]) {
        let PhasedBeams { bins, bins_per_metre, turns_per_metre, wrap_sign, .. } = *self;
        let [x, y] = row.first_metres;
        let [step_x, step_y] = row.step_metres;
        let view = &self.views[end];
        let from = x - view.centre_metres;
        for (block, heard) in heard.chunks_mut(W).enumerate() {
            let i = Lanes::<f64, W>(std::array::from_fn(|lane| (block * W + lane) as f64));
            let dx = i * Lanes::splat(step_x) + Lanes::splat(from);
            let y = i * Lanes::splat(step_y) + Lanes::splat(y);
            let range = view.range_metres(dx, y).map(|r| if r > NEAREST_METRES { r } else { NEAREST_METRES });
            let phase = phasor::<f64, W, FMA>(range * Lanes::splat(-turns_per_metre));
            let inverse = range.map(f64::recip);
            let (cos, at, amplitude) =
                (view.cos_theta(dx, y, inverse), range * Lanes::splat(bins_per_metre), inverse * inverse);
            for (lane, heard) in heard.iter_mut().enumerate() {
                let beam = &self.beams[end][beam_of_cos(cos.0[lane], BEAMS) * bins..][..bins];
                let low = at.0[lane] as usize;
                let part = at.0[lane] - low as f64;
                // Neighbouring rows differ by half a turn (the middle of the chirp), which `new` has removed.
                let row = |k: usize| if k < bins { beam[k] } else { wrapped(beam, k, wrap_sign) };
                let value = row(low) * (1.0 - part) + row(low + 1) * part;
                let amplitude = amplitude.0[lane];
                let phase = Complex64::new(phase.re.0[lane], phase.im.0[lane]);
                *heard = Heard { weighted: value * phase * amplitude, weight: amplitude * amplitude };
            }
        }
    }
}

/// Kernel of [`PhasedBeams::parts_adding_up`].
struct PartsAddingUp<'a> {
    beams: &'a PhasedBeams,
    rows: &'a [Row],
    count: usize,
}

impl Kernel for PartsAddingUp<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let mut heard = vec![Heard::default(); self.count];
        let mut parts = Vec::with_capacity(self.rows.len());
        for row in self.rows {
            parts.push(self.beams.part_adding_up::<FMA>(row, &mut heard));
        }
        parts
    }
}

/// Echoes of a row together.
pub struct AddedUp {
    /// Sum of the weighted values.
    pub sum: Complex64,
    /// Sum of the weights. The square of the sum over them is the power of a row of one gain.
    pub weight: f64,
    /// Sum of the powers of all echoes.
    pub power: f64,
}

/// The sums over these echoes.
#[inline(always)]
pub fn added_up(heard: &[Heard]) -> AddedUp {
    let mut out = AddedUp { sum: Complex64::default(), weight: 0.0, power: 0.0 };
    for h in heard {
        out.sum += h.weighted;
        out.weight += h.weight;
        out.power += h.weighted.norm_sqr() / h.weight;
    }
    out
}

/// Row `k` of a beam beyond its last.
#[cold]
fn wrapped(beam: &[Complex64], k: usize, wrap_sign: f64) -> Complex64 {
    let value = beam[k % beam.len()];
    if (k / beam.len()) % 2 == 1 { value * wrap_sign } else { value }
}
