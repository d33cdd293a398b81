//! Probabilities of counts, exact and in logarithms, so that large counts don't overflow.

/// Logarithms of the factorials of 0 to `most`.
pub struct Factorials(Vec<f64>);

impl Factorials {
    pub fn up_to(most: usize) -> Factorials {
        let mut logs = Vec::with_capacity(most + 1);
        let mut sum = 0.0;
        logs.push(sum);
        for n in 1..=most {
            sum += (n as f64).ln();
            logs.push(sum);
        }
        Factorials(logs)
    }

    /// Logarithm of the number of ways to choose `k` of `n`, where `k` is at most `n`.
    fn ways(&self, n: usize, k: usize) -> f64 {
        self.0[n] - self.0[k] - self.0[n - k]
    }

    /// Two-sided probability that a fair coin falls as unevenly as `a` against `b`, or more: the exact McNemar test (McNemar, Psychometrika
    /// 1947). 1 for no throw.
    pub fn fair_coin(&self, a: usize, b: usize) -> f64 {
        let n = a + b;
        let all = n as f64 * std::f64::consts::LN_2;
        let tail: f64 = (0..=a.min(b)).map(|k| (self.ways(n, k) - all).exp()).sum();
        (2.0 * tail).min(1.0)
    }

    /// Probability that of `drawn` rows, drawn without a choice from `all` of which `bad` are bad, `hit` or more are bad: Fisher's exact
    /// test, one-sided (Fisher, 1935).
    pub fn at_least(&self, hit: usize, drawn: usize, bad: usize, all: usize) -> f64 {
        let total = self.ways(all, drawn);
        let possible = hit.max(drawn.saturating_sub(all - bad))..=drawn.min(bad);
        let tail: f64 = possible.map(|k| (self.ways(bad, k) + self.ways(all - bad, drawn - k) - total).exp()).sum();
        tail.min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coin_is_as_uneven_as_counted_by_hand() {
        let factorials = Factorials::up_to(10_000);
        // 2 (1 + 10 + 45) of 1024.
        assert!((factorials.fair_coin(2, 8) - 112.0 / 1024.0).abs() < 1e-12);
        assert_eq!((factorials.fair_coin(0, 0), factorials.fair_coin(5, 5)), (1.0, 1.0));
        assert!(factorials.fair_coin(4000, 6000) < 1e-80);
    }

    #[test]
    fn the_tea_lady_guesses_as_often_as_fisher_says() {
        let factorials = Factorials::up_to(8);
        // All four of eight cups: 1 of 70; three or more: 17 of 70.
        assert!((factorials.at_least(4, 4, 4, 8) - 1.0 / 70.0).abs() < 1e-12);
        assert!((factorials.at_least(3, 4, 4, 8) - 17.0 / 70.0).abs() < 1e-12);
        assert!((factorials.at_least(0, 4, 4, 8) - 1.0).abs() < 1e-12);
        // Where seven of eight are bad, one of two drawn is.
        assert!((factorials.at_least(1, 2, 7, 8) - 1.0).abs() < 1e-12);
    }
}
