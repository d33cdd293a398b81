//! Small dense systems of equations that may be nearly singular.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};
use num_complex::Complex64;

/// Cholesky solver of a positive semi-definite Hermitian system. The matrix is scaled to unit diagonal, and a ridge is added to it.
pub struct RidgeSolver {
    /// The Cholesky factor; `None` where no ridge made the matrix positive definite.
    factor: Option<Llt<Complex64>>,
    /// Inverse square roots of the diagonal.
    scale: Vec<f64>,
}

impl RidgeSolver {
    /// Factors `matrix` `[n, n]` with `ridge` times its diagonal added, raised to 1e-14, 1e-11, 1e-8 or 1e-4 until it is positive definite.
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
        RidgeSolver { factor, scale }
    }

    /// The solution for the right-hand sides `rhs`; both are `[n, right-hand sides]`. Zeros where no ridge made the matrix positive definite.
    pub fn solve(&self, rhs: &Mat<Complex64>) -> Mat<Complex64> {
        let Some(factor) = &self.factor else { return Mat::zeros(rhs.nrows(), rhs.ncols()) };
        let scaled = Mat::from_fn(rhs.nrows(), rhs.ncols(), |i, j| rhs[(i, j)] * self.scale[i]);
        let x = factor.solve(&scaled);
        Mat::from_fn(rhs.nrows(), rhs.ncols(), |i, j| x[(i, j)] * self.scale[i])
    }
}

/// The Levenberg-Marquardt step: the solution of `(H + damping diag H) step = gradient`, for `H`, `[n, n]`, and `gradient`, `[n]`. `None` where the
/// damped matrix is not positive definite or the step is not finite.
/// Marquardt, J. SIAM 11 (1963) 431.
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
