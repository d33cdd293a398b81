//! Small dense systems that may be nearly singular.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use num_complex::Complex64;

/// Solver of a positive semi-definite system, scaled to unit diagonal, with a ridge of rounding size.
pub struct Ridge {
    factor: Option<Llt<Complex64>>,
    scale: Vec<f64>,
}

impl Ridge {
    /// Factors `matrix` with `ridge` times its diagonal added, or with the smallest ridge that makes it positive definite.
    pub fn new(matrix: &Mat<Complex64>, ridge: f64) -> Self {
        let n = matrix.nrows();
        let scale: Vec<f64> =
            (0..n).map(|i| if matrix[(i, i)].re > 0.0 { matrix[(i, i)].re.sqrt().recip() } else { 0.0 }).collect();
        let factor = [1e-14, 1e-11, 1e-8, 1e-4].iter().find_map(|rounding| {
            let ridge = ridge.max(*rounding);
            let scaled =
                Mat::from_fn(n, n, |i, j| matrix[(i, j)] * (scale[i] * scale[j]) + if i == j { ridge } else { 0.0 });
            scaled.llt(Side::Lower).ok()
        });
        Ridge { factor, scale }
    }

    /// The solution, or zeros for a system that has none.
    pub fn solve(&self, rhs: &Mat<Complex64>) -> Mat<Complex64> {
        let Some(factor) = &self.factor else { return Mat::zeros(rhs.nrows(), rhs.ncols()) };
        let scaled = Mat::from_fn(rhs.nrows(), rhs.ncols(), |i, j| rhs[(i, j)] * self.scale[i]);
        let x = factor.solve(&scaled);
        Mat::from_fn(rhs.nrows(), rhs.ncols(), |i, j| x[(i, j)] * self.scale[i])
    }
}

/// Solution of `(H + damping diag H) step = gradient`, or `None` where H is not positive definite.
pub fn damped_step(hessian: &Mat<f64>, gradient: &[f64], damping: f64) -> Option<Vec<f64>> {
    let n = gradient.len();
    let scale: Vec<f64> = (0..n).map(|i| hessian[(i, i)].abs().max(f64::MIN_POSITIVE).sqrt().recip()).collect();
    let scaled =
        Mat::from_fn(n, n, |i, j| hessian[(i, j)] * scale[i] * scale[j] + if i == j { damping + 1e-14 } else { 0.0 });
    let rhs = Mat::from_fn(n, 1, |i, _| gradient[i] * scale[i]);
    let step = scaled.llt(Side::Lower).ok()?.solve(&rhs);
    let step: Vec<f64> = (0..n).map(|i| step[(i, 0)] * scale[i]).collect();
    step.iter().all(|s| s.is_finite()).then_some(step)
}
