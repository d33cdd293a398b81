//! The number of rows of samples after which rows are the same again: the rows of a loop.

use crate::recording::analytic::{all_analytic, centre};
use ndarray::{Array2, s};
use num_complex::Complex64;

/// Periods that are tried, in rows: receivers of one, two or three transmitters in turn; and in chirps for receivers that stand sample by sample.
const PERIODS: [usize; 9] = [1, 2, 3, 4, 6, 8, 9, 12, 16];
const CHIRPS: [usize; 7] = [1, 2, 3, 4, 6, 9, 12];
const MOST_ROWS: usize = 512;
/// Least steadiness of a period, as a part of the steadiest's; least likeness, as a part of the most alike's; and least likeness of any. Of 335
/// captures made at random the period was right in 295, by the likeness alone in 244.
const STEADY: f64 = 0.999;
const REPEATS: f64 = 0.5;
const LEAST_ALIKE: f64 = 0.3;
/// Another period is likely too in two cases. Rows at no multiple of the found period are unsteady by at most the first factor more, and more alike
/// than the second number; or rows at a multiple are unsteady by the third factor less. Of 209 periods of captures made at random these doubt 15
/// right ones and all 12 wrong ones.
const LESS_STEADY_TIMES: f64 = 60.0;
const MIN_ALIKE_RATIO: f64 = 0.1;
const STEADIER_TIMES: f64 = 5.0;

pub(super) struct Period {
    pub rows: usize,
    /// Another period that is almost as likely.
    pub next: Option<usize>,
}

/// Period of the rows: rows so far apart differ by one constant phase, which a moving echo turns. `None` where no usual count fits.
/// Rows are of `mixed` receivers sample by sample.
pub(super) fn period(rows: &Array2<Complex64>, mixed: usize, is_real: bool) -> Option<Period> {
    let mut centred = rows.slice(s![..rows.nrows().min(MOST_ROWS), ..]).to_owned();
    if is_real {
        // Real samples have no phase that turns.
        centred = all_analytic(centred.view(), centred.ncols().div_ceil(2));
    }
    centre(&mut centred);
    let power: Vec<f64> = centred.outer_iter().map(|row| row.iter().map(Complex64::norm_sqr).sum()).collect();
    // Likeness of all rows `lag` apart.
    let alike = |lag: usize| {
        let (mut sum, mut moduli, mut all) = (Complex64::default(), 0.0, f64::MIN_POSITIVE);
        for (a, b) in (0..centred.nrows() - lag).map(|n| (n, n + lag)) {
            let product: Complex64 = centred.row(a).iter().zip(centred.row(b)).map(|(a, b)| a * b.conj()).sum();
            sum += product;
            moduli += product.norm();
            all += (power[a] * power[b]).sqrt();
        }
        Likeness { rows: lag, alike: sum.norm() / all, steady: sum.norm() / moduli.max(f64::MIN_POSITIVE) }
    };
    let usual = if mixed == 1 { &PERIODS[..] } else { &CHIRPS[..] };
    let lags = usual.iter().map(|count| count * mixed).filter(|lag| 2 * lag <= centred.nrows());
    let all: Vec<Likeness> = lags.map(alike).collect();
    let most = all.iter().map(|lag| lag.alike).fold(0.0, f64::max);
    let steadiest = all.iter().map(|lag| lag.steady).fold(0.0, f64::max);
    // Rows that are all the same have one receiver, which tells no direction: that is another choice at most.
    let can_be = |lag: &&Likeness| lag.rows > 1 && most >= LEAST_ALIKE;
    let repeats = |lag: &&Likeness| lag.steady >= STEADY * steadiest && lag.alike >= REPEATS * most;
    let found = all.iter().filter(can_be).find(repeats)?;
    Some(Period { rows: found.rows, next: other_period(found, &all) })
}

/// Likeness of rows that stand `rows` apart: the part of their power that correlates, `alike`, and the part of the correlation that has one phase,
/// `steady`.
struct Likeness {
    rows: usize,
    alike: f64,
    steady: f64,
}

/// The period that is almost as likely as the one found. Where rows at no multiple of it turn hardly less alike, it is the common divisor of both;
/// where rows at a multiple turn more alike, it is that multiple.
fn other_period(found: &Likeness, all: &[Likeness]) -> Option<usize> {
    let unsteady = |lag: &&Likeness| 1.0 - lag.steady;
    let least = |a: &&Likeness, b: &&Likeness| unsteady(a).total_cmp(&unsteady(b));
    let (multiples, others): (Vec<_>, Vec<_>) = all.iter().partition(|lag| lag.rows.is_multiple_of(found.rows));
    let other = others.into_iter().filter(|lag| lag.alike > MIN_ALIKE_RATIO).min_by(least);
    if let Some(other) = other.filter(|lag| unsteady(lag) <= LESS_STEADY_TIMES * unsteady(&found)) {
        return Some(common_divisor(other.rows, found.rows));
    }
    let multiple = multiples.into_iter().min_by(least);
    multiple.filter(|lag| STEADIER_TIMES * unsteady(lag) < unsteady(&found)).map(|lag| lag.rows)
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}
