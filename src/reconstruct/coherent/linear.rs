//! The linear algebra of one iteration, laid out so that it can be compiled for wide vectors: element after element, one lane a
//! steering vector.

use crate::signal::simd::{Kernel, Simd};
use num_complex::Complex64;

/// Sums that run side by side.
const LANES: usize = 8;

/// Steering vectors as the rows of elements: `[elements, vectors]`, vectors padded to whole lanes by vectors of zeros.
#[derive(Debug, Clone)]
pub(super) struct Steering {
    elements: usize,
    padded: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Steering {
    /// From the value of vector `k` in element `n`.
    pub fn new(elements: usize, vectors: usize, value: impl Fn(usize, usize) -> Complex64) -> Self {
        let padded = vectors.div_ceil(LANES) * LANES;
        let mut steering =
            Steering { elements, padded, re: vec![0.0; elements * padded], im: vec![0.0; elements * padded] };
        for n in 0..elements {
            for k in 0..vectors {
                let v = value(n, k);
                steering.re[n * padded + k] = v.re;
                steering.im[n * padded + k] = v.im;
            }
        }
        steering
    }
}

/// What the covariance `R = sum_k power_k a_k a_k^H + noise` makes of the samples z.
#[derive(Debug, Clone)]
pub(super) struct Explained {
    /// `|a_k^H R^-1 z|^2`, one a vector; zeros behind them.
    pub matched: Vec<f64>,
    /// `a_k^H R^-1 a_k`.
    pub held: Vec<f64>,
}

/// One iteration's work; `None` where the covariance is not positive definite.
pub(super) fn explained(steering: &Steering, powers: &[f64], noise: f64, z: &[Complex64]) -> Option<Explained> {
    let mut padded = powers.to_vec();
    padded.resize(steering.padded, 0.0);
    Simd::best().run(Iteration { steering, powers: &padded, noise, z })
}

struct Iteration<'a> {
    steering: &'a Steering,
    powers: &'a [f64],
    noise: f64,
    z: &'a [Complex64],
}

impl Kernel for Iteration<'_> {
    type Output = Option<Explained>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let mut factor = self.covariance();
        cholesky(&mut factor, self.steering.elements)?;
        Some(self.whitened(&factor))
    }
}

impl Iteration<'_> {
    /// The covariance's lower triangle, row after row of a full matrix.
    #[inline(always)]
    fn covariance(&self) -> Vec<Complex64> {
        let Steering { elements, padded, re, im } = self.steering;
        let (elements, padded) = (*elements, *padded);
        let mut out = vec![Complex64::default(); elements * elements];
        let (mut weighted_re, mut weighted_im) = (vec![0.0; padded], vec![0.0; padded]);
        for i in 0..elements {
            let own = i * padded..(i + 1) * padded;
            for (k, (a, b)) in re[own.clone()].iter().zip(&im[own]).enumerate() {
                weighted_re[k] = a * self.powers[k];
                weighted_im[k] = b * self.powers[k];
            }
            for j in 0..=i {
                let other = j * padded..(j + 1) * padded;
                let (c, d) = (&re[other.clone()], &im[other]);
                let (mut sum_re, mut sum_im) = ([0.0; LANES], [0.0; LANES]);
                let chunks = weighted_re.chunks_exact(LANES).zip(weighted_im.chunks_exact(LANES));
                for ((a, b), (c, d)) in chunks.zip(c.chunks_exact(LANES).zip(d.chunks_exact(LANES))) {
                    for l in 0..LANES {
                        sum_re[l] += a[l] * c[l] + b[l] * d[l];
                        sum_im[l] += b[l] * c[l] - a[l] * d[l];
                    }
                }
                out[i * elements + j] = Complex64::new(sum_re.iter().sum(), sum_im.iter().sum());
            }
            out[i * elements + i] += self.noise;
        }
        out
    }

    /// `L^-1` applied to all steering vectors and to the samples, and what follows from them.
    #[inline(always)]
    fn whitened(&self, factor: &[Complex64]) -> Explained {
        let Steering { elements, padded, re, im } = self.steering;
        let (elements, padded) = (*elements, *padded);
        let (mut re, mut im) = (re.clone(), im.clone());
        let mut z = self.z.to_vec();
        let mut held = vec![0.0; padded];
        let (mut matched_re, mut matched_im) = (vec![0.0; padded], vec![0.0; padded]);
        for i in 0..elements {
            let (done_re, rest_re) = re.split_at_mut(i * padded);
            let (done_im, rest_im) = im.split_at_mut(i * padded);
            let (row_re, row_im) = (&mut rest_re[..padded], &mut rest_im[..padded]);
            for j in 0..i {
                let l = factor[i * elements + j];
                let (other_re, other_im) =
                    (&done_re[j * padded..(j + 1) * padded], &done_im[j * padded..(j + 1) * padded]);
                for k in 0..padded {
                    row_re[k] -= l.re * other_re[k] - l.im * other_im[k];
                    row_im[k] -= l.re * other_im[k] + l.im * other_re[k];
                }
                let other = z[j];
                z[i] -= l * other;
            }
            let scale = 1.0 / factor[i * elements + i].re;
            z[i] *= scale;
            let y = z[i];
            for k in 0..padded {
                let (a, b) = (row_re[k] * scale, row_im[k] * scale);
                (row_re[k], row_im[k]) = (a, b);
                held[k] += a * a + b * b;
                matched_re[k] += a * y.re + b * y.im;
                matched_im[k] += a * y.im - b * y.re;
            }
        }
        let matched = matched_re.iter().zip(&matched_im).map(|(a, b)| a * a + b * b).collect();
        Explained { matched, held }
    }
}

/// Lower Cholesky factor of a Hermitian matrix's lower triangle, in place; `None` where it is not positive definite.
#[inline(always)]
fn cholesky(a: &mut [Complex64], n: usize) -> Option<()> {
    for i in 0..n {
        for j in 0..=i {
            let mut sum = a[i * n + j];
            for k in 0..j {
                sum -= a[i * n + k] * a[j * n + k].conj();
            }
            if i > j {
                a[i * n + j] = sum / a[j * n + j].re;
            } else if sum.re > 0.0 && sum.re.is_finite() {
                a[i * n + i] = Complex64::from(sum.re.sqrt());
            } else {
                return None;
            }
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;
    use faer::linalg::solvers::Solve;

    #[test]
    fn the_iteration_is_what_its_definition_says() {
        let (elements, vectors) = (5, 11);
        let value = |n: usize, k: usize| Complex64::from_polar(1.0 + 0.1 * n as f64, (n * k) as f64 * 0.7 + 0.3);
        let steering = Steering::new(elements, vectors, value);
        let powers: Vec<f64> = (0..vectors).map(|k| 0.2 + (k % 4) as f64).collect();
        let z: Vec<Complex64> = (0..elements).map(|n| Complex64::new(n as f64 - 1.0, 0.5 * n as f64)).collect();
        let noise = 0.3;
        let got = explained(&steering, &powers, noise, &z).unwrap();
        let covariance = Mat::from_fn(elements, elements, |i, j| {
            let sum: Complex64 = (0..vectors).map(|k| value(i, k) * value(j, k).conj() * powers[k]).sum();
            sum + if i == j { noise } else { 0.0 }
        });
        let right = Mat::from_fn(elements, vectors + 1, |n, k| if k < vectors { value(n, k) } else { z[n] });
        let solved = covariance.partial_piv_lu().solve(&right);
        for k in 0..vectors {
            let with =
                |column: usize| -> Complex64 { (0..elements).map(|n| value(n, k).conj() * solved[(n, column)]).sum() };
            assert!((got.held[k] / with(k).re - 1.0).abs() < 1e-12, "{k}");
            assert!((got.matched[k] / with(vectors).norm_sqr() - 1.0).abs() < 1e-11, "{k}");
        }
        assert!(explained(&steering, &vec![0.0; vectors], 0.0, &z).is_none(), "nothing explains anything");
    }
}
