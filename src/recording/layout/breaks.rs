//! Breaks of a stream of samples: the beginnings of rows, which linear prediction from the samples before does not foretell.

use super::evidence::OF_LEVEL;
use super::spectrum::ROUNDING;
use num_complex::Complex64;

/// Number of numbers before each that it is predicted from.
const ORDER: usize = 12;
/// Least ratio of the residuals at a shorter row's other beginnings to those elsewhere for which the shorter length is the right one.
const DIVIDES: f64 = 1.4;
/// Least such ratio for which the shorter length may be the right one.
const ALMOST_DIVIDES: f64 = 1.1;
/// Largest such ratio for which the longer length is the right one.
const WHOLE: f64 = 1.15;

/// Residuals of linear prediction along the numbers: sums of their squares from the first number on.
pub(super) struct Breaks {
    sums: Vec<f64>,
    /// Numbers behind a break that are predicted across it.
    edge: usize,
}

impl Breaks {
    /// Residuals of prediction from the [`ORDER`] numbers before, `stride` apart, by least squares.
    pub fn of(numbers: &[Complex64], stride: usize) -> Breaks {
        let mean = numbers.iter().sum::<Complex64>() / numbers.len().max(1) as f64;
        let centred: Vec<Complex64> = numbers.iter().map(|v| v - mean).collect();
        let edge = ORDER * stride;
        let windows = || centred.windows(edge + 1);
        let mut normal = [[Complex64::default(); ORDER + 1]; ORDER];
        for window in windows() {
            for n in 0..ORDER {
                let before = window[n * stride].conj();
                normal[n].iter_mut().zip(window.iter().step_by(stride)).for_each(|(sum, b)| *sum += before * b);
            }
        }
        let ridge = 1e-6 * (0..ORDER).map(|n| normal[n][n].re).sum::<f64>() / ORDER as f64;
        (0..ORDER).for_each(|n| normal[n][n] += ridge.max(f64::MIN_POSITIVE));
        let weights = solved(normal);
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

    /// Sum of the residuals at the beginnings of rows of `length` for which `counts` holds, and the number of residuals.
    fn first(&self, length: usize, counts: impl Fn(usize) -> bool) -> (f64, f64) {
        let edge = self.edge.min(length / 4);
        let rows = (1..self.numbers() / length).filter(|row| counts(*row)).map(|row| row * length);
        rows.fold((0.0, 0.0), |(sum, count), at| (sum + self.sums[at + edge] - self.sums[at], count + edge as f64))
    }

    /// The likelihood of two variances, at beginnings of rows and elsewhere, over that of the samples alone, as a spectrum's level counts.
    pub fn gain(&self, length: usize) -> f64 {
        if self.numbers() < 3 * length {
            return f64::MIN;
        }
        let (first, count) = self.first(length, |_| true);
        let end = self.numbers() / length * length;
        let all = self.sums[end] - self.sums[length];
        let part = count / (end - length) as f64;
        let variance = |sum: f64, part: f64| (sum / ((end - length) as f64 * part) + ROUNDING).ln();
        -OF_LEVEL * (part * variance(first, part) + (1.0 - part) * variance(all - first, 1.0 - part))
    }

    /// Ratio of the residuals at the beginnings of rows of `length`, those that begin no row of `longer` numbers, to the residuals elsewhere in the
    /// rows.
    fn broken_within(&self, length: usize, longer: usize) -> f64 {
        if self.numbers() < 3 * length {
            return 0.0;
        }
        let (first, count) = self.first(length, |row| !row.is_multiple_of(longer / length));
        let (edges, in_edges) = self.first(length, |_| true);
        let all = self.sums[self.numbers() / length * length] - self.sums[length];
        let elsewhere = (self.numbers() / length * length - length) as f64 - in_edges;
        // Rounding alone leaves residuals of this size.
        first / count.max(1.0) / ((all - edges) / elsewhere.max(1.0) + 0.2)
    }

    /// The length of rows of which `length` is a part: where the others of its beginnings are not broken, it is none of its own.
    pub fn whole(&self, length: usize, lengths: &[usize]) -> usize {
        let mut longer =
            lengths.iter().copied().filter(|l| *l > length && l.is_multiple_of(length) && self.numbers() >= 3 * l);
        longer.find(|l| l / length <= 4 && self.broken_within(length, *l) < WHOLE).unwrap_or(length)
    }

    /// A part of this length that may be a row by itself.
    pub fn almost_divided(&self, length: usize, lengths: &[usize]) -> Option<usize> {
        self.most_broken(length, lengths).filter(|(ratio, _)| *ratio > ALMOST_DIVIDES).map(|(_, l)| l)
    }

    /// The part of this length at whose beginnings the residuals are largest, behind their ratio.
    fn most_broken(&self, length: usize, lengths: &[usize]) -> Option<(f64, usize)> {
        let shorter = lengths.iter().copied().filter(|l| *l < length && length.is_multiple_of(*l));
        shorter.map(|l| (self.broken_within(l, length), l)).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The length of rows of which `longest` is several. Where an echo goes on almost unbroken from receiver to receiver, most large residuals stand
    /// at the beginnings of loops.
    pub fn divided(&self, longest: usize, lengths: &[usize]) -> usize {
        let mut length = longest;
        while let Some((_, shorter)) = self.most_broken(length, lengths).filter(|(ratio, _)| *ratio > DIVIDES) {
            length = shorter;
        }
        length
    }
}

/// The solution of a positive definite system whose right side stands in its last column.
fn solved(mut system: [[Complex64; ORDER + 1]; ORDER]) -> [Complex64; ORDER] {
    for pivot in 0..ORDER {
        let top = system[pivot];
        for (_, row) in system.iter_mut().enumerate().filter(|(n, _)| *n != pivot) {
            let factor = row[pivot] / top[pivot];
            row.iter_mut().zip(top).for_each(|(v, t)| *v -= factor * t);
        }
    }
    std::array::from_fn(|n| system[n][ORDER] / system[n][n])
}
