//! The coarse features: each end's beams, the same registered on the polar grid around the array's centre, and their phases.

use super::grid::{COARSE_CHANNELS, COARSE_COLUMNS, MIN_ROWS, cosine};
use super::registration::Registration;
use crate::radar::{End, Radar, hann};
use crate::signal::simd::powers::logarithm;
use crate::signal::simd::{Kernel, Simd};
use ndarray::Array2;
use num_complex::{Complex32, Complex64};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Tables of the coarse features of one radar.
#[derive(Debug)]
pub(super) struct Coarse {
    rows: usize,
    centre: [Registration<COARSE_COLUMNS>; 2],
    /// Factors that give all cells of one reflector the same phase, `[rows, 64]`: see [`phase_references`].
    references: Vec<Complex64>,
    /// Windowed steering vectors, `[elements, 64]`.
    beams: Array2<Complex64>,
}

/// The beams of one end, `[rows, 64]`.
#[derive(Debug)]
struct BeamMap {
    /// log10 amplitude.
    magnitude: Vec<f32>,
    /// Phase, as numbers of amplitude 1.
    phase: Vec<Complex32>,
    /// Values times [`Coarse::references`], relative to the strongest amplitude.
    centred: Vec<Complex32>,
}

impl Coarse {
    pub(super) fn new(radar: &Radar) -> Self {
        let centre = End::BOTH.map(|end| Registration::new(radar, 0.0, radar.end_centre_metres(end)));
        Coarse { rows: radar.samples, centre, references: phase_references(radar), beams: beams(radar) }
    }

    /// The channels `[COARSE_CHANNELS, rows, 64]` of the range profiles of both ends, `[rows, elements]`: both ends' magnitudes, the same on the centre's
    /// grid, cosine and sine of each end's phase step from row to row, and those of twice the phase between the ends.
    pub(super) fn features(&self, profiles: &[Array2<Complex64>; 2]) -> Vec<f32> {
        let [first, last] = profiles;
        let (first, last) = rayon::join(|| self.beam_map(first), || self.beam_map(last));
        let both = [first, last];
        let plane = self.rows * COARSE_COLUMNS;
        let mut coarse = vec![0.0; COARSE_CHANNELS * plane];
        let (magnitudes, rest) = coarse.split_at_mut(2 * plane);
        let (registered, rest) = rest.split_at_mut(2 * plane);
        let (steps, between) = rest.split_at_mut(4 * plane);
        for (e, map) in both.iter().enumerate() {
            let part = e * plane..(e + 1) * plane;
            magnitudes[part.clone()].copy_from_slice(&map.magnitude);
            rows_of(&mut registered[part]).for_each(|(row, to)| {
                to.iter_mut().zip(self.centre[e].row(&map.magnitude, row)).for_each(|(to, v)| *to = v);
            });
            let (cosines, sines) = steps[2 * e * plane..2 * (e + 1) * plane].split_at_mut(plane);
            rows_of(cosines).zip(rows_of(sines)).for_each(|((row, cosines), (_, sines))| {
                let of = |row: usize| &map.phase[row * COARSE_COLUMNS..(row + 1) * COARSE_COLUMNS];
                let before = of((row + self.rows - 1) % self.rows);
                let steps = of(row).iter().zip(before).map(|(here, before)| here * before.conj());
                cosines
                    .iter_mut()
                    .zip(sines)
                    .zip(steps)
                    .for_each(|((cos, sin), step)| (*cos, *sin) = (step.re, step.im));
            });
        }
        self.fill_phase_between(&both, between);
        coarse
    }

    fn beam_map(&self, profiles: &Array2<Complex64>) -> BeamMap {
        let beams = profiles.dot(&self.beams).into_raw_vec_and_offset().0;
        let scale = beams.iter().map(|v| v.norm_sqr()).fold(1e-300, f64::max).sqrt().recip();
        let plane = self.rows * COARSE_COLUMNS;
        let zeros = || vec![Complex32::default(); plane];
        let mut map = BeamMap { magnitude: vec![0.0; plane], phase: zeros(), centred: zeros() };
        Simd::chosen().run(SplitBeams { beams: &beams, references: &self.references, scale, map: &mut map });
        map
    }

    /// Fills `planes` with cosine and sine of twice the phase between the two ends' maps, both registered on the centre's grid. All cells of a reflector
    /// have the same value. The phase is doubled because side lobes change their sign.
    fn fill_phase_between(&self, both: &[BeamMap; 2], planes: &mut [f32]) {
        let (cosines, sines) = planes.split_at_mut(self.rows * COARSE_COLUMNS);
        rows_of(cosines).zip(rows_of(sines)).for_each(|((row, cosines), (_, sines))| {
            let [first, last] = [0, 1].map(|e| self.centre[e].row(&both[e].centred, row));
            for ((cos, sin), (a, b)) in cosines.iter_mut().zip(sines).zip(first.zip(last)) {
                let wide = |v: Complex32| Complex64::new(v.re.into(), v.im.into());
                let cross = wide(a) * wide(b).conj();
                let phase = cross * (cross.norm_sqr().sqrt() + 1e-300).recip();
                let twice = phase * phase;
                (*cos, *sin) = (twice.re as f32, twice.im as f32);
            }
        });
    }
}

/// The rows of a plane `[rows, 64]`, in parallel.
fn rows_of(plane: &mut [f32]) -> impl IndexedParallelIterator<Item = (usize, &mut [f32])> {
    plane.par_chunks_mut(COARSE_COLUMNS).with_min_len(MIN_ROWS).enumerate()
}

/// Kernel that fills a [`BeamMap`] from the beams' values.
struct SplitBeams<'a> {
    beams: &'a [Complex64],
    references: &'a [Complex64],
    scale: f64,
    map: &'a mut BeamMap,
}

impl Kernel for SplitBeams<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let narrow = |v: Complex64| Complex32::new(v.re as f32, v.im as f32);
        let BeamMap { magnitude, phase, centred } = self.map;
        let cells = self.beams.iter().zip(self.references);
        for (((v, factor), magnitude), (phase, centred)) in cells.zip(magnitude).zip(phase.iter_mut().zip(centred)) {
            let power = v.norm_sqr();
            *magnitude = 0.5 * logarithm((power as f32).max(MIN_POWER));
            *phase = narrow(v * (power.sqrt() + 1e-300).recip());
            *centred = narrow(v * factor * self.scale);
        }
    }
}

/// A power below that of the samples' rounding and above the smallest f32.
const MIN_POWER: f32 = 1e-36;

/// Factors `[rows, 64]` that refer a map's phases to the middle of the chirp and of the end: then the phase is constant over one reflector's
/// main lobe. The middle is half an element off, for which the phase is the same at cos(theta) = -1 and 1, where the columns wrap around.
fn phase_references(radar: &Radar) -> Vec<Complex64> {
    let (rows, elements) = (radar.samples, radar.end_elements);
    let row = |r: usize| PI * (rows - 1) as f64 / rows as f64 * r as f64;
    let column = |k: usize| PI * (elements / 2) as f64 * cosine(k, COARSE_COLUMNS);
    (0..rows * COARSE_COLUMNS)
        .map(|i| Complex64::from_polar(1.0, row(i / COARSE_COLUMNS) + column(i % COARSE_COLUMNS)))
        .collect()
}

/// Steering vectors of 64 beams under a Hann window, `[end elements, 64]`, scaled as the transform of the whole array.
fn beams(radar: &Radar) -> Array2<Complex64> {
    let window = hann(radar.end_elements);
    let scale = (radar.elements as f64).sqrt();
    Array2::from_shape_fn((radar.end_elements, COARSE_COLUMNS), |(m, k)| {
        Complex64::from_polar(window[m] / scale, -PI * m as f64 * cosine(k, COARSE_COLUMNS))
    })
}
