//! Breaks in a sequence of samples: at the beginnings of rows, linear prediction from the samples before fails.

use super::evidence::LEVEL_LOG_ODDS;
use super::spectrum::ROUNDING_POWER;
use num_complex::Complex64;

/// Number of earlier numbers that each is predicted from.
const PREDICTION_ORDER: usize = 12;
/// Least ratio of the residuals at the beginnings of shorter rows to those elsewhere for which the shorter length is used.
const MIN_DIVIDING_RATIO: f64 = 1.4;
/// Least such ratio for which the shorter length is possible.
const MIN_POSSIBLE_RATIO: f64 = 1.1;
/// Largest such ratio for which the longer length is used.
const MAX_WHOLE_RATIO: f64 = 1.15;

/// Residuals of linear prediction along the numbers.
pub(super) struct Breaks {
    /// Sums of the squared residuals from the first number up to each.
    sums: Vec<f64>,
    /// Numbers after a break that are predicted across it.
    edge: usize,
}

impl Breaks {
    /// Residuals of prediction from [`PREDICTION_ORDER`] earlier numbers, `stride` apart, with weights by least squares.
    pub fn of(numbers: &[Complex64], stride: usize) -> Breaks {
        let mean = numbers.iter().sum::<Complex64>() / numbers.len().max(1) as f64;
        let centred: Vec<Complex64> = numbers.iter().map(|v| v - mean).collect();
        let edge = PREDICTION_ORDER * stride;
        let windows = || centred.windows(edge + 1);
        let mut normal = [[Complex64::default(); PREDICTION_ORDER + 1]; PREDICTION_ORDER];
        for window in windows() {
            for n in 0..PREDICTION_ORDER {
                let before = window[n * stride].conj();
                normal[n].iter_mut().zip(window.iter().step_by(stride)).for_each(|(sum, b)| *sum += before * b);
            }
        }
        let ridge = 1e-6 * (0..PREDICTION_ORDER).map(|n| normal[n][n].re).sum::<f64>() / PREDICTION_ORDER as f64;
        (0..PREDICTION_ORDER).for_each(|n| normal[n][n] += ridge.max(f64::MIN_POSITIVE));
        let weights = solve(normal);
        let predicted =
            |window: &[Complex64]| window.iter().step_by(stride).zip(weights).map(|(v, w)| v * w).sum::<Complex64>();
        let mut sums = vec![0.0; edge.min(numbers.len()) + 1];
        let mut sum = 0.0;
        for window in windows() {
            sum += (window[edge] - predicted(window)).norm_sqr();
            sums.push(sum);
        }
        Breaks { sums, edge }
    }

    fn numbers(&self) -> usize {
        self.sums.len() - 1
    }

    /// Sum of the squared residuals at the beginnings of the rows of `length` numbers that `counts` selects, and their number.
    fn residuals_at_rows(&self, length: usize, counts: impl Fn(usize) -> bool) -> (f64, f64) {
        let edge = self.edge.min(length / 4);
        let rows = (1..self.numbers() / length).filter(|row| counts(*row)).map(|row| row * length);
        rows.fold((0.0, 0.0), |(sum, count), at| (sum + self.sums[at + edge] - self.sums[at], count + edge as f64))
    }

    /// Log-odds of rows of `length`: the likelihood of residuals with one variance at the beginnings of rows and another elsewhere.
    pub fn gain(&self, length: usize) -> f64 {
        if self.numbers() < 3 * length {
            return f64::MIN;
        }
        let (at_rows, count) = self.residuals_at_rows(length, |_| true);
        let end = self.numbers() / length * length;
        let all = self.sums[end] - self.sums[length];
        let part = count / (end - length) as f64;
        let variance = |sum: f64, part: f64| (sum / ((end - length) as f64 * part) + ROUNDING_POWER).ln();
        -LEVEL_LOG_ODDS * (part * variance(at_rows, part) + (1.0 - part) * variance(all - at_rows, 1.0 - part))
    }

    /// Ratio of the mean squared residuals at the beginnings of rows of `length` that begin no row of `longer` numbers, to those elsewhere.
    fn residual_ratio(&self, length: usize, longer: usize) -> f64 {
        if self.numbers() < 3 * length {
            return 0.0;
        }
        let (at_rows, count) = self.residuals_at_rows(length, |row| !row.is_multiple_of(longer / length));
        let (edges, in_edges) = self.residuals_at_rows(length, |_| true);
        let all = self.sums[self.numbers() / length * length] - self.sums[length];
        let elsewhere = (self.numbers() / length * length - length) as f64 - in_edges;
        // 0.2: about the squared residuals of rounding to whole numbers.
        at_rows / count.max(1.0) / ((all - edges) / elsewhere.max(1.0) + 0.2)
    }

    /// The multiple of `length` in `lengths`, up to 4 times, at whose inner beginnings prediction does not fail; `length` where there is none.
    pub fn whole(&self, length: usize, lengths: &[usize]) -> usize {
        let mut longer =
            lengths.iter().copied().filter(|l| *l > length && l.is_multiple_of(length) && self.numbers() >= 3 * l);
        longer.find(|l| l / length <= 4 && self.residual_ratio(length, *l) < MAX_WHOLE_RATIO).unwrap_or(length)
    }

    /// The divisor of `length` in `lengths` that is a possible length of rows.
    pub fn almost_divided(&self, length: usize, lengths: &[usize]) -> Option<usize> {
        self.most_broken(length, lengths).filter(|(ratio, _)| *ratio > MIN_POSSIBLE_RATIO).map(|(_, l)| l)
    }

    /// The ratio of residuals, and the divisor of `length` in `lengths` with the largest.
    fn most_broken(&self, length: usize, lengths: &[usize]) -> Option<(f64, usize)> {
        let shorter = lengths.iter().copied().filter(|l| *l < length && length.is_multiple_of(*l));
        shorter.map(|l| (self.residual_ratio(l, length), l)).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The length of rows, a divisor of `longest`, which is a loop where an echo's phase is almost continuous from receiver to receiver.
    pub fn divided(&self, longest: usize, lengths: &[usize]) -> usize {
        let mut length = longest;
        while let Some((_, shorter)) =
            self.most_broken(length, lengths).filter(|(ratio, _)| *ratio > MIN_DIVIDING_RATIO)
        {
            length = shorter;
        }
        length
    }
}

/// The solution of a positive definite system with its right side in the last column.
fn solve(mut system: [[Complex64; PREDICTION_ORDER + 1]; PREDICTION_ORDER]) -> [Complex64; PREDICTION_ORDER] {
    for pivot in 0..PREDICTION_ORDER {
        let top = system[pivot];
        for (_, row) in system.iter_mut().enumerate().filter(|(n, _)| *n != pivot) {
            let factor = row[pivot] / top[pivot];
            row.iter_mut().zip(top).for_each(|(v, t)| *v -= factor * t);
        }
    }
    std::array::from_fn(|n| system[n][PREDICTION_ORDER] / system[n][n])
}
