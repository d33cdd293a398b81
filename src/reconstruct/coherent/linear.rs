//! The linear algebra of one iteration, with a steering vector in each lane.
//!
//! It is in f32, with the factor of the covariance in f64: the least noise is far above the rounding of both.

use crate::signal::simd::{ComplexLanes, Kernel, LANES_F32, Lanes, Simd};
use num_complex::Complex64;

/// Steering vectors in one lane group.
pub(super) const W: usize = LANES_F32;

/// Lanes of a group, which are computed together: enough to hide the latency of an addition.
const GROUP_LANES: usize = 4;

/// Rows and columns of the covariance that are kept in registers.
const TILE: (usize, usize) = (2, 4);

/// One element of `W` steering vectors.
pub(super) type Lane = ComplexLanes<f32, W>;

/// One element of neighbouring steering vectors.
type Group = [Lane; GROUP_LANES];

/// Steering vectors, padded to whole groups with zeros.
#[derive(Debug, Clone)]
pub(super) struct Steering {
    elements: usize,
    /// `[group][element]`.
    values: Vec<Group>,
}

impl Steering {
    /// `lanes * W` vectors of `elements` elements, all zero.
    pub fn zero(elements: usize, lanes: usize) -> Self {
        Steering { elements, values: vec![[Lane::zero(); GROUP_LANES]; elements * lanes.div_ceil(GROUP_LANES)] }
    }

    /// Number of vectors, the padding included.
    pub fn vectors(&self) -> usize {
        self.values.len() / self.elements.max(1) * GROUP_LANES * W
    }

    /// `element` of the vectors from `lane * W` on.
    #[inline(always)]
    pub fn lane_mut(&mut self, element: usize, lane: usize) -> &mut Lane {
        &mut self.values[lane / GROUP_LANES * self.elements + element][lane % GROUP_LANES]
    }
}

/// Figures of the samples z under the covariance `R = sum_k power_k a_k a_k^H + noise`, `[vectors]`.
#[derive(Debug, Clone)]
pub(super) struct Whitened {
    /// `|a_k^H R^-1 z|^2`.
    pub matched: Vec<f32>,
    /// `a_k^H R^-1 a_k`.
    pub norm: Vec<f32>,
}

/// One iteration; `None` where the covariance is not positive definite. `powers` has one value a vector, the padding included.
pub(super) fn whitened(steering: &Steering, powers: &[f32], noise: f64, z: &[Complex64]) -> Option<Whitened> {
    Simd::chosen().run(Iteration { steering, powers, noise, z })
}

struct Iteration<'a> {
    steering: &'a Steering,
    powers: &'a [f32],
    noise: f64,
    z: &'a [Complex64],
}

impl Kernel for Iteration<'_> {
    type Output = Option<Whitened>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let mut factor = self.covariance::<FMA>();
        cholesky(&mut factor, self.steering.elements)?;
        Some(self.whitened::<FMA>(&factor))
    }
}

impl Iteration<'_> {
    /// The covariance's lower triangle, row after row of a full matrix.
    #[inline(always)]
    fn covariance<const FMA: bool>(&self) -> Vec<Complex64> {
        let n = self.steering.elements;
        let powers: Vec<Lanes<f32, W>> =
            self.powers.chunks_exact(W).map(|p| Lanes(std::array::from_fn(|i| p[i]))).collect();
        let mut out = vec![Complex64::default(); n * n];
        for i in (0..n).step_by(TILE.0) {
            for j in (0..n.min(i + TILE.0)).step_by(TILE.1) {
                let sums = self.tile::<FMA>(&powers, i, j);
                for (a, sums) in sums.iter().enumerate() {
                    for (b, sum) in sums.iter().enumerate() {
                        if i + a < n && j + b <= i + a {
                            let total = |lanes: &[f32; W]| lanes.iter().map(|v| f64::from(*v)).sum::<f64>();
                            out[(i + a) * n + j + b] = Complex64::new(total(&sum.re.0), total(&sum.im.0));
                        }
                    }
                }
            }
            for k in i..n.min(i + TILE.0) {
                out[k * n + k] += self.noise;
            }
        }
        out
    }

    /// Rows from `i` and columns from `j` of the covariance without noise, with one sum a lane.
    #[inline(always)]
    #[allow(clippy::needless_range_loop)] // constant bounds keep the tile in registers
    fn tile<const FMA: bool>(&self, powers: &[Lanes<f32, W>], i: usize, j: usize) -> [[Lane; TILE.1]; TILE.0] {
        let n = self.steering.elements;
        let rows: [usize; TILE.0] = std::array::from_fn(|a| (i + a).min(n - 1));
        let columns: [usize; TILE.1] = std::array::from_fn(|b| (j + b).min(n - 1));
        let mut sums = [[Lane::zero(); TILE.1]; TILE.0];
        for (group, powers) in self.steering.values.chunks_exact(n).zip(powers.chunks_exact(GROUP_LANES)) {
            for l in 0..GROUP_LANES {
                let left: [Lane; TILE.0] = std::array::from_fn(|a| group[rows[a]][l].scaled(powers[l]));
                for b in 0..TILE.1 {
                    let right = group[columns[b]][l];
                    let right = Lane { re: right.re, im: -right.im };
                    for a in 0..TILE.0 {
                        sums[a][b] = sums[a][b].plus_product::<FMA>(left[a], right);
                    }
                }
            }
        }
        sums
    }

    /// `L^-1` applied to all steering vectors and to the samples, and the figures of [`Whitened`].
    #[inline(always)]
    #[allow(clippy::needless_range_loop)] // constant bounds keep the rows in registers
    fn whitened<const FMA: bool>(&self, factor: &[Complex64]) -> Whitened {
        let n = self.steering.elements;
        let mut z = self.z.to_vec();
        for i in 0..n {
            let known: Complex64 = (0..i).map(|j| factor[i * n + j] * z[j]).sum();
            z[i] = (z[i] - known) / factor[i * n + i].re;
        }
        let splat = |v: Complex64| Lane { re: Lanes::splat(v.re as f32), im: Lanes::splat(v.im as f32) };
        let size = self.steering.vectors();
        let mut out = Whitened { matched: Vec::with_capacity(size), norm: Vec::with_capacity(size) };
        let mut rows = vec![[Lane::zero(); GROUP_LANES]; n];
        for group in self.steering.values.chunks_exact(n) {
            let mut norm = [Lanes::splat(0.0); GROUP_LANES];
            let mut matched = [Lane::zero(); GROUP_LANES];
            for i in 0..n {
                let mut row = group[i];
                for j in 0..i {
                    let l = splat(-factor[i * n + j]);
                    for b in 0..GROUP_LANES {
                        row[b] = row[b].plus_product::<FMA>(l, rows[j][b]);
                    }
                }
                let scale = Lanes::splat((1.0 / factor[i * n + i].re) as f32);
                let y = splat(z[i]);
                for b in 0..GROUP_LANES {
                    let value = row[b].scaled(scale);
                    norm[b] = value.re.mul_add::<FMA>(value.re, value.im.mul_add::<FMA>(value.im, norm[b]));
                    let conjugate = Lane { re: value.re, im: -value.im };
                    matched[b] = matched[b].plus_product::<FMA>(conjugate, y);
                    rows[i][b] = value;
                }
            }
            for b in 0..GROUP_LANES {
                let matched = matched[b];
                out.matched.extend((matched.re * matched.re + matched.im * matched.im).0);
                out.norm.extend(norm[b].0);
            }
        }
        out
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
        let (elements, vectors) = (5, 21);
        let value = |n: usize, k: usize| Complex64::from_polar(1.0 + 0.1 * n as f64, (n * k) as f64 * 0.7 + 0.3);
        let mut steering = Steering::zero(elements, 2);
        for n in 0..elements {
            for k in 0..vectors {
                let lane = steering.lane_mut(n, k / W);
                (lane.re.0[k % W], lane.im.0[k % W]) = (value(n, k).re as f32, value(n, k).im as f32);
            }
        }
        let mut powers: Vec<f32> = (0..vectors).map(|k| 0.2 + (k % 4) as f32).collect();
        powers.resize(steering.vectors(), 0.0);
        let z: Vec<Complex64> = (0..elements).map(|n| Complex64::new(n as f64 - 1.0, 0.5 * n as f64)).collect();
        let noise = 0.3;
        let got = whitened(&steering, &powers, noise, &z).unwrap();
        let covariance = Mat::from_fn(elements, elements, |i, j| {
            let sum: Complex64 = (0..vectors).map(|k| value(i, k) * value(j, k).conj() * f64::from(powers[k])).sum();
            sum + if i == j { noise } else { 0.0 }
        });
        let right = Mat::from_fn(elements, vectors + 1, |n, k| if k < vectors { value(n, k) } else { z[n] });
        let solved = covariance.partial_piv_lu().solve(&right);
        for k in 0..vectors {
            let with =
                |column: usize| -> Complex64 { (0..elements).map(|n| value(n, k).conj() * solved[(n, column)]).sum() };
            assert!((f64::from(got.norm[k]) / with(k).re - 1.0).abs() < 1e-4, "{k}");
            let matched = with(vectors).norm_sqr();
            assert!((f64::from(got.matched[k]) - matched).abs() < 1e-4 * (matched + 1.0), "{k}");
        }
        assert_eq!((got.norm[vectors], got.matched[vectors]), (0.0, 0.0), "padding");
        let nothing = vec![0.0; steering.vectors()];
        assert!(whitened(&steering, &nothing, 0.0, &z).is_none(), "nothing explains anything");
    }
}
