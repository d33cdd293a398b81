//! What the live network is shown: tensors made of the raw samples of the two ends.
//!
//! Twelve elements resolve about twelve angles, so nothing here is finer than 256 columns. Each end's picture is drawn from that
//! end; the same reflector lies up to 27 range bins apart in the two, so both are also *registered*: gathered onto the grid
//! that the array's centre sees. On the fine grid an end is shown by its Capon spectrum, row by row: with next to no noise it tells
//! apart reflectors that the end's own beam cannot.
//!
//! Everything is measured relative to the mean power of the samples (the *gain*): a louder receiver gives the same tensors.

use super::floors::{measured_floor, rounding_floor};
use crate::maps::channels_range_transform;
use crate::network::trained_for::check_radar;
use crate::radar::{End, Radar, hann};
use crate::reconstruct::{ReconstructError, check_ends};
use crate::signal::TwoEnds;
use ndarray::{Array2, ArrayView2, Axis};
use num_complex::{Complex32, Complex64};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Range rows of every tensor.
pub const ROWS: usize = 512;
/// Columns of the map.
pub const COLUMNS: usize = 1024;
/// Columns of the fine features.
pub const FINE: usize = 256;
/// Columns of the coarse features.
pub const COARSE: usize = 64;
/// Channels of the fine features.
pub const FINE_CHANNELS: usize = 4;
/// Channels of the coarse features.
pub const COARSE_CHANNELS: usize = 10;
/// Channels of the row features.
pub const ROW_CHANNELS: usize = 6;
/// Scalars beside the pictures.
pub const SCALARS: usize = 2;

/// Elements of an end.
const ELEMENTS: usize = 12;
/// Elements of a subarray of the Capon spectrum; five of them slide over an end, forwards and backwards.
const SUBARRAY: usize = 8;
/// Diagonal loading of the covariance, relative to its mean diagonal.
const LOADING: f64 = 1e-5;

/// Fewest rows that one processor takes at a time.
const LEAST_ROWS: usize = 32;

/// The tensors of one scene, row-major.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveInput {
    /// `[4, 512, 256]` decades: the Capon spectra of both ends where they agree (minimum) and where either speaks (maximum) on the
    /// centre's grid, and where they agree as the first and as the last end sees it.
    pub fine: Vec<f32>,
    /// `[10, 512, 64]`: log-magnitude of each end's beams, the same registered, for each end cosine and sine of the phase step
    /// from the row before, and cosine and sine of twice the phase between the registered ends.
    pub coarse: Vec<f32>,
    /// `[6, 512]`: for each end real and imaginary part of the mean phase step between elements, then each end's power in decades.
    pub rows: Vec<f32>,
    /// Two estimates of the noise floor in decades: from the rounding that the thesis' samples carry, and as measured.
    pub scalars: [f32; SCALARS],
    /// Half the log10 of the samples' mean power: what the decades above are relative to.
    pub gain: f64,
}

/// A bilinear look-up of one polar grid in another: four cells and their weights.
#[derive(Debug, Clone, Copy)]
struct Tap {
    cells: [u32; 4],
    weights: [f32; 4],
}

/// Makes [`LiveInput`]s; holds the tables that depend on the radar alone.
#[derive(Debug)]
pub struct FeatureExtractor {
    radar: Radar,
    /// Fine grid: centre from either end, first from last, last from first.
    fine_centre: [Vec<Tap>; 2],
    fine_other: [Vec<Tap>; 2],
    coarse_centre: [Vec<Tap>; 2],
    /// `[512, 64]`: what makes the phase of a reflector's cells one and the same, see [`even_phases`].
    even: Vec<Complex64>,
    /// `[elements, 64]`: windowed steering vectors.
    beams: Array2<Complex64>,
    /// `[subarray, 256]` cosines and sines of the lag phases.
    lag_cos: Array2<f32>,
    lag_sin: Array2<f32>,
}

impl FeatureExtractor {
    /// Tables for `radar`.
    ///
    /// # Errors
    /// [`ReconstructError::Unusable`] unless it has 512 samples, 1024 elements half a wavelength apart and ends of 12, which the
    /// network was trained for.
    pub fn new(radar: &Radar) -> Result<Self, ReconstructError> {
        check_radar("live", radar)?;
        let ends = End::BOTH.map(|end| radar.end_centre_metres(end));
        let table = |columns, from: f64, to: f64| registration(radar, columns, from, to);
        Ok(FeatureExtractor {
            fine_centre: ends.map(|x| table(FINE, 0.0, x)),
            fine_other: [table(FINE, ends[0], ends[1]), table(FINE, ends[1], ends[0])],
            coarse_centre: ends.map(|x| table(COARSE, 0.0, x)),
            even: even_phases(),
            beams: beams(),
            lag_cos: Array2::from_shape_fn((SUBARRAY, FINE), |(d, k)| (PI * d as f64 * cosine(k, FINE)).cos() as f32),
            lag_sin: Array2::from_shape_fn((SUBARRAY, FINE), |(d, k)| (PI * d as f64 * cosine(k, FINE)).sin() as f32),
            radar: radar.clone(),
        })
    }

    /// The tensors of the samples of two ends.
    ///
    /// # Errors
    /// [`ReconstructError`] on samples of the wrong shape or not finite, and on silence.
    pub fn extract(&self, ends: &TwoEnds) -> Result<LiveInput, ReconstructError> {
        check_ends(&self.radar, ends)?;
        let samples = 2.0 * (ELEMENTS * ROWS) as f64;
        let power = ends.first.iter().chain(&ends.last).map(|v| v.norm_sqr()).sum::<f64>() / samples;
        if power == 0.0 {
            return Err(ReconstructError::Unusable {
                method: "live",
                reason: "the samples are silent; put a reflector into the scene".into(),
            });
        }
        let scale = power.sqrt().recip();
        let ends = End::BOTH.map(|end| ends.end(end).mapv(|v| v * scale));
        let profiles: [Array2<Complex64>; 2] =
            ends.each_ref().map(|e| channels_range_transform(&self.radar, e.view()).profiles.reversed_axes());

        let capon = profiles.each_ref().map(|p| self.capon(p.view()));
        let mut fine = vec![0.0; FINE_CHANNELS * ROWS * FINE];
        self.fill_fine(&capon, &mut fine);
        let mut coarse = vec![0.0; COARSE_CHANNELS * ROWS * COARSE];
        self.fill_coarse(&profiles, &mut coarse);
        Ok(LiveInput {
            fine,
            coarse,
            rows: row_features(&profiles),
            scalars: [rounding_floor(&self.radar, &profiles), measured_floor(&self.radar, &ends)],
            gain: 0.5 * power.log10(),
        })
    }

    /// log10 amplitude `[512, 256]` of the Capon spectrum of each row of `z` `[512, 12]`, forward-backward smoothed
    /// (Pillai and Kwon 1989).
    fn capon(&self, z: ArrayView2<'_, Complex64>) -> Vec<f32> {
        let mut out = vec![0.0f32; ROWS * FINE];
        out.par_chunks_mut(FINE).enumerate().for_each(|(row, out)| {
            let mut elements = [Complex64::default(); ELEMENTS];
            elements.iter_mut().zip(z.row(row)).for_each(|(e, v)| *e = *v);
            let (power, lags) = inverse_lags(&elements);
            let (re, im) = (lags.map(|c| c.re as f32), lags.map(|c| c.im as f32));
            out.fill(0.0);
            for d in 0..SUBARRAY {
                let (cos, sin) = (self.lag_cos.row(d), self.lag_sin.row(d));
                for ((o, c), s) in out.iter_mut().zip(cos).zip(sin) {
                    *o += re[d] * c - im[d] * s;
                }
            }
            let decades = power.max(1e-300).log10() as f32;
            out.iter_mut().for_each(|o| *o = 0.5 * (decades - o.max(1e-6).log10()));
        });
        out
    }

    fn fill_fine(&self, capon: &[Vec<f32>; 2], fine: &mut [f32]) {
        let (agree, rest) = fine.split_at_mut(ROWS * FINE);
        let (either, rest) = rest.split_at_mut(ROWS * FINE);
        let (first, last) = rest.split_at_mut(ROWS * FINE);
        let rows = |v: &[Tap], row: usize| -> std::ops::Range<usize> {
            debug_assert_eq!(v.len(), ROWS * FINE);
            row * FINE..(row + 1) * FINE
        };
        agree
            .par_chunks_mut(FINE)
            .zip(either.par_chunks_mut(FINE))
            .zip(first.par_chunks_mut(FINE).zip(last.par_chunks_mut(FINE)))
            .enumerate()
            .for_each(|(row, ((agree, either), (first, last)))| {
                let at = rows(&self.fine_centre[0], row);
                for k in 0..FINE {
                    let i = at.start + k;
                    let a = look_up(&capon[0], &self.fine_centre[0][i]);
                    let b = look_up(&capon[1], &self.fine_centre[1][i]);
                    agree[k] = a.min(b);
                    either[k] = a.max(b);
                    first[k] = capon[0][i].min(look_up(&capon[1], &self.fine_other[0][i]));
                    last[k] = capon[1][i].min(look_up(&capon[0], &self.fine_other[1][i]));
                }
            });
    }

    /// Cosine and sine of twice the phase between the two ends' maps `[512, 64]`, both registered on the centre's grid: one colour for every
    /// cell of a reflector, another for the next reflector. Twice, because side lobes change their sign.
    fn fill_phase_between(&self, both: &[Array2<Complex64>; 2], planes: &mut [f32]) {
        let even = both.each_ref().map(|map| {
            let strongest = map.iter().map(|v| v.norm_sqr()).fold(1e-300, f64::max).sqrt().recip();
            let cell = |(v, factor): (&Complex64, &Complex64)| {
                let v = v * factor * strongest;
                Complex32::new(v.re as f32, v.im as f32)
            };
            map.iter().zip(&self.even).map(cell).collect::<Vec<Complex32>>()
        });
        let (cosines, sines) = planes.split_at_mut(ROWS * COARSE);
        cosines.par_iter_mut().zip(sines.par_iter_mut()).with_min_len(COARSE).enumerate().for_each(
            |(cell, (cos, sin))| {
                let [a, b]: [Complex64; 2] = std::array::from_fn(|e| {
                    let v = look_up_complex(&even[e], &self.coarse_centre[e][cell]);
                    Complex64::new(v.re.into(), v.im.into())
                });
                let cross = a * b.conj();
                let phase = cross / (cross.norm() + 1e-300);
                let twice = phase * phase;
                (*cos, *sin) = (twice.re as f32, twice.im as f32);
            },
        );
    }

    fn fill_coarse(&self, profiles: &[Array2<Complex64>; 2], coarse: &mut [f32]) {
        const PLANE: usize = ROWS * COARSE;
        let both = profiles.each_ref().map(|z| z.dot(&self.beams));
        self.fill_phase_between(&both, &mut coarse[8 * PLANE..]);
        let (magnitudes, rest) = coarse.split_at_mut(2 * PLANE);
        let (registered, rest) = rest.split_at_mut(2 * PLANE);
        let planes = magnitudes.chunks_mut(PLANE).zip(registered.chunks_mut(PLANE)).zip(rest.chunks_mut(2 * PLANE));
        for (e, ((magnitude, registered), steps)) in planes.take(both.len()).enumerate() {
            let beams = &both[e];
            let (cosines, sines) = steps.split_at_mut(PLANE);
            let rows =
                magnitude.par_chunks_mut(COARSE).zip(cosines.par_chunks_mut(COARSE)).zip(sines.par_chunks_mut(COARSE));
            rows.with_min_len(LEAST_ROWS).enumerate().for_each(|(row, ((magnitude, cosines), sines))| {
                let before = (row + ROWS - 1) % ROWS;
                for k in 0..COARSE {
                    let here = beams[[row, k]];
                    magnitude[k] = (here.norm_sqr().sqrt() + 1e-20).log10() as f32;
                    let step = unit(here * beams[[before, k]].conj());
                    (cosines[k], sines[k]) = (step.re, step.im);
                }
            });
            let magnitude = &*magnitude;
            registered.par_iter_mut().with_min_len(LEAST_ROWS * COARSE).enumerate().for_each(|(cell, out)| {
                *out = look_up(magnitude, &self.coarse_centre[e][cell]);
            });
        }
    }
}

/// `[512, 64]` factors that take out of a map's phase what changes from cell to cell within one reflector's blob: the phases of mid-chirp and of
/// (half an element off) the end's middle; the half lets the angle axis close, the phase at cos(theta) = -1 and 1 being the same.
fn even_phases() -> Vec<Complex64> {
    let row = |r: usize| PI * (ROWS - 1) as f64 / ROWS as f64 * r as f64;
    let column = |k: usize| PI * (ELEMENTS / 2) as f64 * cosine(k, COARSE);
    (0..ROWS * COARSE).map(|i| Complex64::from_polar(1.0, row(i / COARSE) + column(i % COARSE))).collect()
}

/// cos(theta) of column `k` of a grid of `columns`.
fn cosine(k: usize, columns: usize) -> f64 {
    let half = (columns / 2) as f64;
    (k as f64 - half) / half
}

fn unit(v: Complex64) -> Complex32 {
    let v = v / (v.norm_sqr().sqrt() + 1e-300);
    Complex32::new(v.re as f32, v.im as f32)
}

/// Hann-windowed steering vectors of 64 beams over 12 elements, scaled as the 1024-column transform.
fn beams() -> Array2<Complex64> {
    let window = hann(ELEMENTS);
    Array2::from_shape_fn((ELEMENTS, COARSE), |(m, k)| {
        Complex64::from_polar(window[m] / (COLUMNS as f64).sqrt(), -PI * m as f64 * cosine(k, COARSE))
    })
}

/// For each cell of the polar grid around x = `from`, where it lies on the polar grid around x = `to`.
fn registration(radar: &Radar, columns: usize, from: f64, to: f64) -> Vec<Tap> {
    let bin = radar.range_resolution_metres();
    let cell = |i: usize| {
        let (r, u) = ((i / columns) as f64 * bin, cosine(i % columns, columns));
        let dx = r * u + from - to;
        let distance = (dx * dx + r * r * (1.0 - u * u)).sqrt();
        let u = if distance > 0.0 { dx / distance } else { 0.0 };
        let row = (distance / bin).min((ROWS - 1) as f64);
        let column = u * (columns / 2) as f64 + (columns / 2) as f64;
        let (r0, c0) = ((row.floor() as usize).min(ROWS - 2), column.floor());
        let (fr, fc) = ((row - r0 as f64) as f32, (column - c0) as f32);
        let c0 = c0.rem_euclid(columns as f64) as usize;
        let c1 = (c0 + 1) % columns;
        Tap {
            cells: [(r0, c0), (r0, c1), (r0 + 1, c0), (r0 + 1, c1)].map(|(r, c)| (r * columns + c) as u32),
            weights: [(1.0 - fr) * (1.0 - fc), (1.0 - fr) * fc, fr * (1.0 - fc), fr * fc],
        }
    };
    (0..ROWS * columns).map(cell).collect()
}

#[inline]
fn look_up(plane: &[f32], tap: &Tap) -> f32 {
    tap.cells.iter().zip(tap.weights).map(|(&i, w)| plane[i as usize] * w).sum()
}

#[inline]
fn look_up_complex(plane: &[Complex32], tap: &Tap) -> Complex32 {
    tap.cells.iter().zip(tap.weights).map(|(&i, w)| plane[i as usize] * w).sum()
}

/// Mean power of a row's elements, and the sums along the diagonals of the inverse of its smoothed, loaded covariance (relative
/// to that power); those off the main diagonal doubled. They are the coefficients of `a(u)^H R^-1 a(u)`.
#[allow(clippy::needless_range_loop, reason = "indices as in the textbook's matrices")]
fn inverse_lags(z: &[Complex64; ELEMENTS]) -> (f64, [Complex64; SUBARRAY]) {
    const N: usize = SUBARRAY;
    const SLIDES: usize = ELEMENTS - N + 1;
    let mut cov = [[Complex64::default(); N]; N];
    for start in 0..SLIDES {
        let x = &z[start..start + N];
        for i in 0..N {
            for j in 0..=i {
                cov[i][j] += x[i] * x[j].conj() + x[N - 1 - i].conj() * x[N - 1 - j];
            }
        }
    }
    let power = cov.iter().enumerate().map(|(i, r)| r[i].re).sum::<f64>() / (N * 2 * SLIDES) as f64;
    if power == 0.0 {
        let mut lags = [Complex64::default(); N];
        lags[0] = Complex64::new(N as f64 / LOADING, 0.0);
        return (0.0, lags);
    }
    let scale = (power * (2 * SLIDES) as f64).recip();
    // Cholesky factor L of the loaded covariance, then M = L^-1; R^-1 = M^H M.
    let mut l = [[Complex64::default(); N]; N];
    for i in 0..N {
        for j in 0..=i {
            let mut v = cov[i][j] * scale;
            if i == j {
                v += LOADING;
            }
            for k in 0..j {
                v -= l[i][k] * l[j][k].conj();
            }
            l[i][j] = if i == j { Complex64::new(v.re.max(1e-12).sqrt(), 0.0) } else { v / l[j][j].re };
        }
    }
    let mut m = [[Complex64::default(); N]; N];
    for i in 0..N {
        m[i][i] = Complex64::new(l[i][i].re.recip(), 0.0);
        for j in 0..i {
            let sum: Complex64 = (j..i).map(|k| l[i][k] * m[k][j]).sum();
            m[i][j] = -sum / l[i][i].re;
        }
    }
    let mut lags = [Complex64::default(); N];
    for (d, lag) in lags.iter_mut().enumerate() {
        for row in &m {
            *lag += (0..N - d).map(|i| row[i].conj() * row[i + d]).sum::<Complex64>();
        }
        if d > 0 {
            *lag *= 2.0;
        }
    }
    (power, lags)
}

fn row_features(profiles: &[Array2<Complex64>; 2]) -> Vec<f32> {
    let mut out = vec![0.0; ROW_CHANNELS * ROWS];
    for (e, z) in profiles.iter().enumerate() {
        for (row, z) in z.axis_iter(Axis(0)).enumerate() {
            let step: Complex64 = (1..ELEMENTS).map(|n| z[n] * z[n - 1].conj()).sum();
            let power: f64 = z.iter().map(|v| v.norm_sqr()).sum();
            let step = step / (power + 1e-300);
            out[2 * e * ROWS + row] = step.re as f32;
            out[(2 * e + 1) * ROWS + row] = step.im as f32;
            out[(4 + e) * ROWS + row] = (0.5 * (power / ELEMENTS as f64 + 1e-300).log10()) as f32;
        }
    }
    out
}
