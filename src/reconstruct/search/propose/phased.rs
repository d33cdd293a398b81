//! Complex beams of both ends over range, and the echoes of a row of reflectors in them.
//!
//! A row's echoes are interpolated in the beams at the reflectors' places and summed coherently. This is far cheaper than a fit to the samples, and
//! accurate enough to choose the rows for such a fit.

use super::end_beams::{beam_of_cos, end_beams};
use super::view::View;
use crate::radar::{End, Radar};
use crate::signal::simd::{Kernel, LANES_F64 as W, Lanes, Simd, phasor};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Number of beams of each end. They are so dense that the nearest one is used without interpolation.
const BEAM_COUNT: usize = 96;

/// Least range of a reflector, metres. A nearer one is treated as if at this range.
const MIN_RANGE_METRES: f64 = 0.05;

/// Beams of both ends. Their phases are referred to the middle of the chirp and of the end, so that they vary slowly with range and angle.
pub struct PhasedBeams {
    /// Complex amplitudes of each end, at index `beam * bins + range bin`.
    beams: [Vec<Complex64>; 2],
    pub views: [View; 2],
    bins: usize,
    bins_per_metre: f64,
    /// Phase of an echo in the middle of the chirp for each metre of range, turns.
    pub turns_per_metre: f64,
}

/// A row of reflectors: places at equal steps along a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// The first place (x, y), metres.
    pub first_metres: [f64; 2],
    /// Step from one place to the next (x, y), metres.
    pub step_metres: [f64; 2],
}

/// A reflector's echo at an end. The phase of its range is taken out.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReflectorEcho {
    /// The beam's value times the amplitude `1/R^2` of a reflector of gain 1.
    pub weighted: Complex64,
    /// Square of that amplitude.
    pub weight: f64,
}

/// Power of the strongest beam in each range bin, for each end.
pub struct PeakPowers([Vec<f64>; 2]);

/// Power of the beams at a place. Each figure is the smaller one of the two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacePower {
    /// Power of the beam towards the place over that of the strongest beam in the same range bin, 0 to 1.
    pub part: f64,
    /// Power of that beam times the fourth power of the range: the same for equal reflectors at all ranges.
    pub compensated_power: f64,
}

impl Row {
    /// Place number `i` from 0, (x, y) in metres.
    #[inline(always)]
    pub fn place_metres(&self, i: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.first_metres[axis] + i * self.step_metres[axis])
    }
}

impl PhasedBeams {
    /// Forms the beams of `residual`: the samples of both ends, channel by channel, without a window.
    pub fn new(radar: &Radar, residual: &[Complex64]) -> Self {
        let bins = radar.samples;
        let middle = (bins as f64 - 1.0) / 2.0;
        let shift: Vec<Complex64> =
            (0..bins).map(|bin| Complex64::cis(TAU * (bin as f64 * middle / bins as f64).fract())).collect();
        let beams = end_beams(radar, residual, BEAM_COUNT).map(|mut beams| {
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
        }
    }

    pub fn peak_powers(&self) -> PeakPowers {
        PeakPowers(self.beams.each_ref().map(|beams| {
            let mut peak = vec![0.0f64; self.bins];
            for beam in beams.chunks_exact(self.bins) {
                peak.iter_mut().zip(beam).for_each(|(peak, v)| *peak = peak.max(v.norm_sqr()));
            }
            peak
        }))
    }

    /// The power of the beams at a place (x, y), metres.
    pub fn place_power(&self, peak_powers: &PeakPowers, place_metres: [f64; 2]) -> PlacePower {
        let of_end = |end: usize| {
            let (range, cos) = self.views[end].range_and_cos(place_metres, MIN_RANGE_METRES);
            let bin = (range * self.bins_per_metre).round() as usize % self.bins;
            let own = self.beams[end][beam_of_cos(cos, BEAM_COUNT) * self.bins + bin].norm_sqr();
            let peak = peak_powers.0[end][bin].max(f64::MIN_POSITIVE);
            PlacePower { part: own / peak, compensated_power: peak * range.powi(4) }
        };
        let (a, b) = (of_end(0), of_end(1));
        PlacePower { part: a.part.min(b.part), compensated_power: a.compensated_power.min(b.compensated_power) }
    }

    /// The unambiguous range, metres.
    pub fn max_range_metres(&self) -> f64 {
        self.bins as f64 / self.bins_per_metre
    }

    pub fn bin_metres(&self) -> f64 {
        self.bins_per_metre.recip()
    }

    /// Coherent part, 0 to 1, of the beams' power at each row's places: that of `count` reflectors of one gain; 0 for a row behind the array.
    pub fn coherent_parts(&self, rows: &[Row], count: usize) -> Vec<f64> {
        Simd::chosen().run(CoherentParts { beams: self, rows, count })
    }

    /// [`Self::coherent_parts`] of one row, with a reflector for each entry of the buffer `echoes`. Each end has its own gain.
    #[inline(always)]
    fn coherent_part<const FMA: bool>(&self, row: &Row, echoes: &mut [ReflectorEcho]) -> f64 {
        if row.place_metres((echoes.len() - 1) as f64)[1] <= 0.0 {
            return 0.0;
        }
        let (mut coherent, mut total) = (0.0, 0.0);
        for end in 0..self.beams.len() {
            self.reflector_echoes::<FMA>(end, row, echoes);
            let RowSums { sum, weight, power } = row_sums(echoes);
            (coherent, total) = (coherent + sum.norm_sqr() / weight, total + power);
        }
        coherent / f64::max(total, f64::MIN_POSITIVE)
    }

    /// Writes the echoes of the first reflectors of `row` at an end (0 or 1) into `echoes`, one for each entry.
    #[inline(always)]
    pub fn reflector_echoes<const FMA: bool>(&self, end: usize, row: &Row, echoes: &mut [ReflectorEcho]) {
        let PhasedBeams { bins, bins_per_metre, turns_per_metre, .. } = *self;
        let [x, y] = row.first_metres;
        let [step_x, step_y] = row.step_metres;
        let view = &self.views[end];
        let from = x - view.centre_metres;
        for (block, echoes) in echoes.chunks_mut(W).enumerate() {
            let i = Lanes::<f64, W>(std::array::from_fn(|lane| (block * W + lane) as f64));
            let dx = i * Lanes::splat(step_x) + Lanes::splat(from);
            let y = i * Lanes::splat(step_y) + Lanes::splat(y);
            let range = view.range_metres(dx, y).map(|r| if r > MIN_RANGE_METRES { r } else { MIN_RANGE_METRES });
            let phase = phasor::<f64, W, FMA>(range * Lanes::splat(-turns_per_metre));
            let inverse = range.map(f64::recip);
            let (cos, at, amplitude) =
                (view.cos_theta(dx, y, inverse), range * Lanes::splat(bins_per_metre), inverse * inverse);
            for (lane, echoes) in echoes.iter_mut().enumerate() {
                let beam = &self.beams[end][beam_of_cos(cos.0[lane], BEAM_COUNT) * bins..][..bins];
                let low = at.0[lane] as usize;
                let part = at.0[lane] - low as f64;
                // Linear interpolation over range. `new` has removed the half turn between neighbouring range bins.
                let at_bin = |k: usize| if k < bins { beam[k] } else { wrapped(beam, k) };
                let value = at_bin(low) * (1.0 - part) + at_bin(low + 1) * part;
                let amplitude = amplitude.0[lane];
                let phase = Complex64::new(phase.re.0[lane], phase.im.0[lane]);
                *echoes = ReflectorEcho { weighted: value * phase * amplitude, weight: amplitude * amplitude };
            }
        }
    }
}

struct CoherentParts<'a> {
    beams: &'a PhasedBeams,
    rows: &'a [Row],
    count: usize,
}

impl Kernel for CoherentParts<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let mut echoes = vec![ReflectorEcho::default(); self.count];
        let mut parts = Vec::with_capacity(self.rows.len());
        for row in self.rows {
            parts.push(self.beams.coherent_part::<FMA>(row, &mut echoes));
        }
        parts
    }
}

/// Sums over the echoes of a row at an end.
pub struct RowSums {
    /// Sum of the weighted values.
    pub sum: Complex64,
    /// Sum of the weights. `|sum|^2 / weight` is the power that a row of one gain explains.
    pub weight: f64,
    /// Sum of the beams' powers at all reflectors.
    pub power: f64,
}

/// The sums over the echoes of a row at an end.
#[inline(always)]
pub fn row_sums(echoes: &[ReflectorEcho]) -> RowSums {
    let mut out = RowSums { sum: Complex64::default(), weight: 0.0, power: 0.0 };
    for echo in echoes {
        out.sum += echo.weighted;
        out.weight += echo.weight;
        out.power += echo.weighted.norm_sqr() / echo.weight;
    }
    out
}

/// Range bin `k` of a beam, beyond the last one. With phases referred to the middle of the chirp an even number of samples turns the beam at each wrap.
#[cold]
fn wrapped(beam: &[Complex64], k: usize) -> Complex64 {
    let value = beam[k % beam.len()];
    if (k / beam.len()) % 2 == 1 && beam.len().is_multiple_of(2) { -value } else { value }
}
