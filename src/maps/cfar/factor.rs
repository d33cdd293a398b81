//! The factor between measured noise and threshold, for noise of exponentially distributed power.

/// Factor over the mean of `training` cells: `alpha = N (P^(-1/N) - 1)` (Finn and Johnson 1968).
pub fn averaging_factor(training: usize, false_alarm: f64) -> f64 {
    let n = training as f64;
    n * (-false_alarm.ln() / n).exp_m1()
}

/// Factor over the training cell of rank `rank`, from 1, of `training`: the solution T of
/// `P = prod_{i = 0}^{rank - 1} (N - i) / (N - i + T)` (Rohling 1983, equation 37).
pub fn ordered_factor(training: usize, rank: usize, false_alarm: f64) -> f64 {
    let wanted = -false_alarm.ln();
    let terms = || (0..rank).map(|i| (training - i) as f64);
    let mut factor = 0.0f64;
    for _ in 0..200 {
        let value: f64 = terms().map(|n| (factor / n).ln_1p()).sum();
        let slope: f64 = terms().map(|n| (n + factor).recip()).sum();
        let step = (wanted - value) / slope;
        factor += step;
        if step.abs() <= 1e-15 * factor {
            break;
        }
    }
    factor
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_training_cell_needs_the_odds_of_no_false_alarm() {
        // Of two exponential powers one exceeds the other T times with probability 1 / (1 + T).
        for rate in [0.5, 0.1, 1e-6, 1e-12] {
            let odds = 1.0 / rate - 1.0;
            assert!((averaging_factor(1, rate) / odds - 1.0).abs() < 1e-12, "{rate}");
            assert!((ordered_factor(1, 1, rate) / odds - 1.0).abs() < 1e-12, "{rate}");
        }
    }

    #[test]
    fn many_training_cells_need_the_factor_of_known_noise() {
        // Known noise of mean 1 exceeds -ln P with probability P.
        let known = -1e-4f64.ln();
        assert!((averaging_factor(1_000_000, 1e-4) / known - 1.0).abs() < 1e-5);
        // The cell of rank 3/4 of many is at ln 4 times the mean.
        let ordered = ordered_factor(100_000, 75_000, 1e-4) * 4f64.ln();
        assert!((ordered / known - 1.0).abs() < 1e-3, "{ordered} {known}");
    }

    #[test]
    fn the_ordered_factor_solves_its_product() {
        for (n, rank, rate) in [(16, 12, 1e-6), (24, 18, 1e-3), (540, 405, 1e-4), (2, 2, 0.9)] {
            let factor = ordered_factor(n, rank, rate);
            let product: f64 = (0..rank).map(|i| (n - i) as f64).map(|n| n / (n + factor)).product();
            assert!((product / rate - 1.0).abs() < 1e-10, "{n} {rank}: {product} of {rate}");
        }
    }
}
