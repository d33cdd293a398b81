//! The Capon spectrum of every range row of one end, with forward-backward spatial smoothing (Pillai and Kwon 1989).

use super::grid::{FINE_COLUMNS, cosine};
use crate::signal::simd::powers::logarithm;
use crate::signal::simd::{ComplexLanes, Kernel, LANES_F64, Lanes, Simd};
use ndarray::ArrayView2;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Numbers of elements of a subarray, largest first. The largest that has at most two thirds of an end's elements is used: 8 of 12.
const SUBARRAY_ELEMENTS: [usize; 5] = [16, 8, 4, 2, 1];
/// Diagonal loading of the covariance, relative to its mean diagonal.
const RELATIVE_LOADING: f64 = 1e-5;

/// The steering phases of an end's subarrays.
#[derive(Debug)]
pub(super) struct Capon {
    /// Cosines and sines of the phase of each lag, `[subarray elements][256]`.
    lags: Vec<[Vec<f32>; 2]>,
}

const ROWS_AT_ONCE: usize = LANES_F64;
type Numbers = Lanes<f64, ROWS_AT_ONCE>;
type Complexes = ComplexLanes<f64, ROWS_AT_ONCE>;

impl Capon {
    pub(super) fn new(elements: usize) -> Self {
        let subarray = SUBARRAY_ELEMENTS.into_iter().find(|n| 3 * n <= 2 * elements).unwrap_or(1);
        let phases = |lag: usize| (0..FINE_COLUMNS).map(move |k| PI * lag as f64 * cosine(k, FINE_COLUMNS));
        let of = |lag| [phases(lag).map(|p| p.cos() as f32).collect(), phases(lag).map(|p| p.sin() as f32).collect()];
        Capon { lags: (0..subarray).map(of).collect() }
    }

    /// The spectrum of each row of the range profiles `z` `[rows, elements]`: log10 amplitude, `[rows, 256]`.
    pub(super) fn decades(&self, z: ArrayView2<'_, Complex64>) -> Vec<f32> {
        let (rows, elements) = z.dim();
        let mut out = vec![0.0f32; rows * FINE_COLUMNS];
        out.par_chunks_mut(ROWS_AT_ONCE * FINE_COLUMNS).enumerate().for_each(|(chunk, out)| {
            let mut samples = vec![Complexes::zero(); elements];
            for (lane, row) in (chunk * ROWS_AT_ONCE..rows).take(ROWS_AT_ONCE).enumerate() {
                for (element, v) in samples.iter_mut().zip(z.row(row)) {
                    (element.re.0[lane], element.im.0[lane]) = (v.re, v.im);
                }
            }
            match self.lags.len() {
                16 => self.run::<16>(&samples, out),
                8 => self.run::<8>(&samples, out),
                4 => self.run::<4>(&samples, out),
                2 => self.run::<2>(&samples, out),
                _ => self.run::<1>(&samples, out),
            }
        });
        out
    }

    fn run<const N: usize>(&self, elements: &[Complexes], out: &mut [f32]) {
        Simd::chosen().run(Spectra::<N> { lags: &self.lags, elements, out });
    }
}

struct Spectra<'a, const N: usize> {
    lags: &'a [[Vec<f32>; 2]],
    elements: &'a [Complexes],
    out: &'a mut [f32],
}

impl<const N: usize> Kernel for Spectra<'_, N> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let (power, lags) = inverse_lags::<FMA, N>(self.elements);
        for (lane, out) in self.out.chunks_exact_mut(FINE_COLUMNS).enumerate() {
            out.fill(0.0);
            for (lag, [cos, sin]) in lags.iter().zip(self.lags) {
                let (re, im) = (lag.re.0[lane] as f32, lag.im.0[lane] as f32);
                for ((o, c), s) in out.iter_mut().zip(cos).zip(sin) {
                    *o += re * c - im * s;
                }
            }
            let decades = power.0[lane].max(1e-300).log10() as f32;
            out.iter_mut().for_each(|o| *o = 0.5 * (decades - logarithm(o.max(1e-6))));
        }
    }
}

/// Mean power of each row's elements, and the sums along the diagonals of the inverse of its smoothed, loaded covariance R relative to that
/// power. Those off the main diagonal are doubled: they are the coefficients of `a(u)^H R^-1 a(u)`.
#[allow(clippy::needless_range_loop, reason = "indices as in the textbook's matrices")]
#[inline(always)]
fn inverse_lags<const FMA: bool, const N: usize>(z: &[Complexes]) -> (Numbers, [Complexes; N]) {
    const ZERO: Complexes = Complexes { re: Lanes([0.0; ROWS_AT_ONCE]), im: Lanes([0.0; ROWS_AT_ONCE]) };
    let mut covariance = [[ZERO; N]; N];
    let subarrays = z.len() - N + 1;
    for start in 0..subarrays {
        let x = &z[start..start + N];
        for i in 0..N {
            for j in 0..=i {
                covariance[i][j] = covariance[i][j].plus_product::<FMA>(x[i], x[j].conj());
                covariance[i][j] = covariance[i][j].plus_product::<FMA>(x[N - 1 - i].conj(), x[N - 1 - j]);
            }
        }
    }
    let mut trace = ZERO.re;
    for i in 0..N {
        trace = trace + covariance[i][i].re;
    }
    // The covariance of a row of zeros is the loading alone.
    let scale = trace.map(|v| if v > 0.0 { N as f64 / v } else { 0.0 });
    // The Cholesky factor L of R, and M = L^-1, both with real diagonals (`inverse` is that of M): R^-1 = M^H M.
    let mut factor = [[ZERO; N]; N];
    let mut inverse = [Numbers::splat(0.0); N];
    for i in 0..N {
        for j in 0..=i {
            let mut v = covariance[i][j].scaled(scale);
            for k in 0..j {
                v = v - factor[i][k].times::<FMA>(factor[j][k].conj());
            }
            if i == j {
                inverse[i] = (v.re + Numbers::splat(RELATIVE_LOADING)).map(|v| v.max(1e-12).sqrt().recip());
            } else {
                factor[i][j] = v.scaled(inverse[j]);
            }
        }
    }
    let mut inverse_factor = [[ZERO; N]; N];
    for i in 0..N {
        inverse_factor[i][i].re = inverse[i];
        for j in 0..i {
            let mut sum = ZERO;
            for k in j..i {
                sum = sum.plus_product::<FMA>(factor[i][k], inverse_factor[k][j]);
            }
            inverse_factor[i][j] = sum.scaled(-inverse[i]);
        }
    }
    let mut lags = [ZERO; N];
    for (d, lag) in lags.iter_mut().enumerate() {
        // M is zero above its diagonal.
        for row in d..N {
            for i in 0..=row - d {
                *lag = lag.plus_product::<FMA>(inverse_factor[row][i].conj(), inverse_factor[row][i + d]);
            }
        }
        if d > 0 {
            *lag = lag.scaled(Numbers::splat(2.0));
        }
    }
    (trace.map(|v| v / (N * 2 * subarrays) as f64), lags)
}
