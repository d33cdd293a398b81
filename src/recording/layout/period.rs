//! The period of the rows of samples: the number of rows in a loop.

use crate::recording::analytic::{analytic_lanes, subtract_mean};
use ndarray::{Array2, s};
use num_complex::Complex64;

/// Periods that are tried: in rows, for the receivers of one to three transmitters in turn; in chirps, for interleaved receivers.
const ROW_PERIODS: [usize; 9] = [1, 2, 3, 4, 6, 8, 9, 12, 16];
const CHIRP_PERIODS: [usize; 7] = [1, 2, 3, 4, 6, 9, 12];
/// Most rows that are compared.
const MAX_ROWS: usize = 512;
/// Least steadiness ([`Likeness`]) of the period relative to the steadiest, least likeness relative to the largest, and least largest likeness. Of 335
/// captures made at random the period was right in 295, by the likeness alone in 244.
const MIN_STEADINESS_RATIO: f64 = 0.999;
const MIN_LIKENESS_RATIO: f64 = 0.5;
const MIN_LIKENESS: f64 = 0.3;
/// Another period is likely too in two cases. Lags that are no multiple of the period have at most the first factor times its unsteadiness and more than
/// the second likeness; or a multiple has less than its unsteadiness over the third factor. Of 209 periods of captures made at random these doubt 15
/// right ones and all 12 wrong ones.
const MAX_UNSTEADINESS_RATIO: f64 = 60.0;
const MIN_OTHER_LIKENESS: f64 = 0.1;
const MIN_STEADIER_RATIO: f64 = 5.0;

pub(super) struct Period {
    pub rows: usize,
    /// Another period that is almost as likely.
    pub next: Option<usize>,
}

/// Period of rows of `interleaved` receivers: rows so far apart differ by a constant phase, that of a moving echo. `None` where none fits.
pub(super) fn period(rows: &Array2<Complex64>, interleaved: usize, is_real: bool) -> Option<Period> {
    let mut centred = rows.slice(s![..rows.nrows().min(MAX_ROWS), ..]).to_owned();
    if is_real {
        // The phase of a moving echo changes in analytic signals alone.
        centred = analytic_lanes(centred.view(), centred.ncols().div_ceil(2));
    }
    subtract_mean(&mut centred);
    let power: Vec<f64> = centred.outer_iter().map(|row| row.iter().map(Complex64::norm_sqr).sum()).collect();
    let likeness = |lag: usize| {
        let (mut sum, mut moduli, mut all) = (Complex64::default(), 0.0, f64::MIN_POSITIVE);
        for (a, b) in (0..centred.nrows() - lag).map(|n| (n, n + lag)) {
            let product: Complex64 = centred.row(a).iter().zip(centred.row(b)).map(|(a, b)| a * b.conj()).sum();
            sum += product;
            moduli += product.norm();
            all += (power[a] * power[b]).sqrt();
        }
        Likeness { rows: lag, alike: sum.norm() / all, steady: sum.norm() / moduli.max(f64::MIN_POSITIVE) }
    };
    let usual = if interleaved == 1 { &ROW_PERIODS[..] } else { &CHIRP_PERIODS[..] };
    let lags = usual.iter().map(|count| count * interleaved).filter(|lag| 2 * lag <= centred.nrows());
    let all: Vec<Likeness> = lags.map(likeness).collect();
    let most = all.iter().map(|lag| lag.alike).fold(0.0, f64::max);
    let steadiest = all.iter().map(|lag| lag.steady).fold(0.0, f64::max);
    // Period 1 stands for one receiver, which has no directions: it is another choice at most.
    let can_be = |lag: &&Likeness| lag.rows > 1 && most >= MIN_LIKENESS;
    let repeats =
        |lag: &&Likeness| lag.steady >= MIN_STEADINESS_RATIO * steadiest && lag.alike >= MIN_LIKENESS_RATIO * most;
    let found = all.iter().filter(can_be).find(repeats)?;
    Some(Period { rows: found.rows, next: other_period(found, &all) })
}

/// Likeness of rows `rows` apart: the part `alike` of their power that correlates, and the part `steady` of that with one phase.
struct Likeness {
    rows: usize,
    alike: f64,
    steady: f64,
}

/// Another period that is almost as likely as the one found: its common divisor with another lag, or a multiple.
fn other_period(found: &Likeness, all: &[Likeness]) -> Option<usize> {
    let unsteady = |lag: &&Likeness| 1.0 - lag.steady;
    let by_unsteadiness = |a: &&Likeness, b: &&Likeness| unsteady(a).total_cmp(&unsteady(b));
    let (multiples, others): (Vec<_>, Vec<_>) = all.iter().partition(|lag| lag.rows.is_multiple_of(found.rows));
    let other = others.into_iter().filter(|lag| lag.alike > MIN_OTHER_LIKENESS).min_by(by_unsteadiness);
    if let Some(other) = other.filter(|lag| unsteady(lag) <= MAX_UNSTEADINESS_RATIO * unsteady(&found)) {
        return Some(common_divisor(other.rows, found.rows));
    }
    let multiple = multiples.into_iter().min_by(by_unsteadiness);
    multiple.filter(|lag| MIN_STEADIER_RATIO * unsteady(lag) < unsteady(&found)).map(|lag| lag.rows)
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}
