//! The Capon spectrum of every range row of one end, forward-backward smoothed (Pillai and Kwon 1989): with next to no noise it tells apart
//! reflectors that the end's own beam cannot.

use super::grid::{ELEMENTS, FINE, ROWS, cosine};
use crate::signal::simd::powers::logarithm;
use crate::signal::simd::{ComplexLanes, Kernel, LANES_F64, Lanes, Simd};
use ndarray::ArrayView2;
use num_complex::Complex64;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Elements of a subarray; five of them slide over an end, forwards and backwards.
const SUBARRAY: usize = 8;
const SLIDES: usize = ELEMENTS - SUBARRAY + 1;
/// Diagonal loading of the covariance, relative to its mean diagonal.
const LOADING: f64 = 1e-5;

/// The phases of the spectrum's columns.
#[derive(Debug)]
pub(super) struct Capon {
    /// `[subarray][256]` cosines and sines of the lag phases.
    lags: [[Vec<f32>; 2]; SUBARRAY],
}

/// Rows that are worked on side by side.
const ROWS_AT_ONCE: usize = LANES_F64;
type Numbers = Lanes<f64, ROWS_AT_ONCE>;
type Complexes = ComplexLanes<f64, ROWS_AT_ONCE>;

impl Capon {
    pub(super) fn new() -> Self {
        let phases = |lag: usize| (0..FINE).map(move |k| PI * lag as f64 * cosine(k, FINE));
        let lags = std::array::from_fn(|lag| {
            [phases(lag).map(|p| p.cos() as f32).collect(), phases(lag).map(|p| p.sin() as f32).collect()]
        });
        Capon { lags }
    }

    /// log10 amplitude `[512, 256]` of the spectrum of each row of `z` `[512, 12]`.
    pub(super) fn decades(&self, z: ArrayView2<'_, Complex64>) -> Vec<f32> {
        let mut out = vec![0.0f32; ROWS * FINE];
        let simd = Simd::chosen();
        out.par_chunks_mut(ROWS_AT_ONCE * FINE).enumerate().for_each(|(chunk, out)| {
            let mut elements = [Complexes::zero(); ELEMENTS];
            for lane in 0..ROWS_AT_ONCE {
                for (element, v) in elements.iter_mut().zip(z.row(chunk * ROWS_AT_ONCE + lane)) {
                    (element.re.0[lane], element.im.0[lane]) = (v.re, v.im);
                }
            }
            simd.run(Spectra { lags: &self.lags, elements: &elements, out });
        });
        out
    }
}

/// The spectra of [`ROWS_AT_ONCE`] rows.
struct Spectra<'a> {
    lags: &'a [[Vec<f32>; 2]; SUBARRAY],
    elements: &'a [Complexes; ELEMENTS],
    out: &'a mut [f32],
}

impl Kernel for Spectra<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let (power, lags) = inverse_lags::<FMA>(self.elements);
        for (lane, out) in self.out.chunks_exact_mut(FINE).enumerate() {
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

/// Mean power of each row's elements, and the sums along the diagonals of the inverse of its smoothed, loaded covariance (relative
/// to that power); those off the main diagonal doubled. They are the coefficients of `a(u)^H R^-1 a(u)`.
#[allow(clippy::needless_range_loop, reason = "indices as in the textbook's matrices")]
#[inline(always)]
fn inverse_lags<const FMA: bool>(z: &[Complexes; ELEMENTS]) -> (Numbers, [Complexes; SUBARRAY]) {
    const N: usize = SUBARRAY;
    const ZERO: Complexes = Complexes { re: Lanes([0.0; ROWS_AT_ONCE]), im: Lanes([0.0; ROWS_AT_ONCE]) };
    let mut cov = [[ZERO; N]; N];
    for start in 0..SLIDES {
        let x = &z[start..start + N];
        for i in 0..N {
            for j in 0..=i {
                cov[i][j] = cov[i][j].plus_product::<FMA>(x[i], x[j].conj());
                cov[i][j] = cov[i][j].plus_product::<FMA>(x[N - 1 - i].conj(), x[N - 1 - j]);
            }
        }
    }
    let mut trace = ZERO.re;
    for i in 0..N {
        trace = trace + cov[i][i].re;
    }
    // A silent row's covariance is the loading alone.
    let scale = trace.map(|v| if v > 0.0 { N as f64 / v } else { 0.0 });
    // Cholesky factor L of the loaded covariance, whose diagonal is real, then M = L^-1; R^-1 = M^H M.
    let mut l = [[ZERO; N]; N];
    let mut inverse = [Numbers::splat(0.0); N];
    for i in 0..N {
        for j in 0..=i {
            let mut v = cov[i][j].scaled(scale);
            for k in 0..j {
                v = v - l[i][k].times::<FMA>(l[j][k].conj());
            }
            if i == j {
                inverse[i] = (v.re + Numbers::splat(LOADING)).map(|v| v.max(1e-12).sqrt().recip());
            } else {
                l[i][j] = v.scaled(inverse[j]);
            }
        }
    }
    let mut m = [[ZERO; N]; N];
    for i in 0..N {
        m[i][i].re = inverse[i];
        for j in 0..i {
            let mut sum = ZERO;
            for k in j..i {
                sum = sum.plus_product::<FMA>(l[i][k], m[k][j]);
            }
            m[i][j] = sum.scaled(-inverse[i]);
        }
    }
    let mut lags = [ZERO; N];
    for (d, lag) in lags.iter_mut().enumerate() {
        // Below its diagonal alone M is not zero.
        for row in d..N {
            for i in 0..=row - d {
                *lag = lag.plus_product::<FMA>(m[row][i].conj(), m[row][i + d]);
            }
        }
        if d > 0 {
            *lag = lag.scaled(Numbers::splat(2.0));
        }
    }
    (trace.map(|v| v / (N * 2 * SLIDES) as f64), lags)
}
