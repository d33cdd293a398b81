//! The comparison of two methods on the same scenes.

use crate::evaluate::Estimate;
use crate::evaluate::rows::Row;
use crate::radar::counted;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::HashMap;

/// Number of bootstrap samples of the scenes for the interval.
pub const RESAMPLES: usize = 2000;

/// Most scenes for the bootstrap's interval. With more, the mean is nearly normal, and drawing would take longer than a frame of the window.
pub const MAX_RESAMPLED_SCENES: usize = 5000;

/// Distance of the ends of an interval of 95 % from the mean, in standard deviations of a normal distribution.
const NORMAL_95: f64 = 1.96;

/// The comparison of two methods on the scenes that both were tried on.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Paired {
    /// Scenes that both were tried on.
    pub scenes: usize,
    /// Mean over these scenes of the first method's squared error less the second's.
    #[serde(rename = "squared_error_difference")]
    pub difference: f64,
    /// Interval of 95 % of that mean: the paired percentile bootstrap over scenes (Efron and Tibshirani, An Introduction to the Bootstrap,
    /// 1993, chapter 13), or the normal one for more than [`MAX_RESAMPLED_SCENES`] scenes.
    #[serde(rename = "interval_95")]
    pub interval: [f64; 2],
    /// Scenes in which the first finds every object and the second does not.
    pub first_alone: usize,
    /// Scenes in which the second finds every object and the first does not.
    pub second_alone: usize,
    /// Probability of counts as uneven as these two, or more, if neither method were better: McNemar's exact test, two-sided.
    #[serde(rename = "mcnemar_p")]
    pub p_value: f64,
}

impl Paired {
    /// The comparison of the rows of two methods; `None` where they share no scene. The same rows give the same interval.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>, first: &str, second: &str) -> Option<Paired> {
        let mut scenes: HashMap<_, [Option<&Row>; 2]> = HashMap::new();
        let mut order = Vec::new();
        for row in rows {
            let slot = match &*row.method {
                method if method == first => 0,
                method if method == second => 1,
                _ => continue,
            };
            let key = (&*row.set, row.seed, row.index);
            scenes.entry(key).or_insert_with(|| {
                order.push(key);
                [None; 2]
            })[slot] = Some(row);
        }
        let both = |key| scenes.get(key).and_then(|[a, b]| Option::zip(*a, *b));
        let pairs: Vec<(&Row, &Row)> = order.iter().filter_map(both).collect();
        if pairs.is_empty() {
            return None;
        }
        let differences: Vec<f64> = pairs.iter().map(|(a, b)| a.squared_error - b.squared_error).collect();
        let alone = |is: fn(bool, bool) -> bool| pairs.iter().filter(|(a, b)| is(finds_all(a), finds_all(b))).count();
        let [first_alone, second_alone] = [alone(|a, b| a && !b), alone(|a, b| b && !a)];
        Some(Paired {
            scenes: pairs.len(),
            difference: Estimate::of(&differences).mean,
            interval: interval(&differences),
            first_alone,
            second_alone,
            p_value: fair_coin(first_alone, second_alone),
        })
    }

    /// The comparison in words, with the methods' names.
    pub fn sentence(&self, first: &str, second: &str) -> String {
        let Paired { scenes, difference, interval: [low, high], first_alone, second_alone, p_value } = self;
        let [scenes, alone] = [scenes, first_alone].map(|count| counted(*count, "scene", "scenes"));
        format!(
            "SE of {first} less that of {second}: {difference:+.1}, 95 % interval {low:+.1} to {high:+.1} ({scenes}). Every object found, \
             none merged or on a wrong tooth, by {first} alone: {alone}, by {second} alone: {second_alone} (McNemar p = {})",
            p_text(*p_value)
        )
    }
}

/// Two-sided probability that a fair coin falls as unevenly as `a` against `b`, or more: the exact McNemar test (McNemar, Psychometrika
/// 1947), in logarithms, so that large counts don't overflow. 1 for no throw.
fn fair_coin(a: usize, b: usize) -> f64 {
    let n = a + b;
    let mut factorials = vec![0.0; n + 1];
    (1..=n).for_each(|k| factorials[k] = factorials[k - 1] + (k as f64).ln());
    let ways = |k: usize| factorials[n] - factorials[k] - factorials[n - k];
    let all = n as f64 * std::f64::consts::LN_2;
    let tail: f64 = (0..=a.min(b)).map(|k| (ways(k) - all).exp()).sum();
    (2.0 * tail).min(1.0)
}

fn p_text(p: f64) -> String {
    match p {
        p if p < 1e-4 => "below 0.0001".to_owned(),
        p if p < 0.01 => format!("{p:.4}"),
        p => format!("{p:.2}"),
    }
}

fn finds_all(row: &Row) -> bool {
    row.missed == 0 && row.merged.unwrap_or(0) == 0 && row.wrong_tooth.unwrap_or(0) == 0
}

fn interval(values: &[f64]) -> [f64; 2] {
    if values.len() > MAX_RESAMPLED_SCENES {
        let Estimate { mean, standard_error, .. } = Estimate::of(values);
        return [-1.0, 1.0].map(|side| mean + side * NORMAL_95 * standard_error);
    }
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let n = values.len();
    let mut means: Vec<f64> =
        (0..RESAMPLES).map(|_| (0..n).map(|_| values[rng.random_range(0..n)]).sum::<f64>() / n as f64).collect();
    means.sort_by(f64::total_cmp);
    // Number of resampled means outside the interval on either side.
    let outside = RESAMPLES / 40;
    [means[outside], means[RESAMPLES - 1 - outside]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::rows::tests::row;
    use rand_distr::{Distribution, Normal};

    fn of(index: u32, method: &str, squared_error: f64, missed: usize) -> Row {
        Row { squared_error, missed, merged: None, ..row("1", index, method) }
    }

    #[test]
    fn only_scenes_that_both_have_count() {
        let rows = [of(0, "a", 5.0, 0), of(1, "a", 9.0, 0), of(1, "b", 4.0, 1), of(2, "b", 1.0, 0), of(1, "c", 0.0, 0)];
        let paired = Paired::of(&rows, "a", "b").unwrap();
        assert_eq!((paired.scenes, paired.difference, paired.interval), (1, 5.0, [5.0, 5.0]));
        assert_eq!((paired.first_alone, paired.second_alone, paired.p_value), (1, 0, 1.0));
        assert_eq!((Paired::of(&rows, "a", "d"), Paired::of(&rows, "b", "a").unwrap().difference), (None, -5.0));
    }

    #[test]
    fn a_merged_object_is_not_found() {
        let merged = Row { merged: Some(1), ..of(0, "b", 1.0, 0) };
        let paired = Paired::of(&[of(0, "a", 1.0, 0), merged], "a", "b").unwrap();
        assert_eq!((paired.first_alone, paired.second_alone), (1, 0));
        let told = paired.sentence("a", "b");
        let counts = "none merged or on a wrong tooth, by a alone: 1 scene, by b alone: 0 (McNemar p = 1.00)";
        assert!(told.contains("(1 scene). Every object found, ") && told.ends_with(counts), "{told}");
    }

    /// The true mean lies within the interval as often as claimed: of 400 samples of 60 scenes in 380, give or take 4.4. The bootstrap's
    /// intervals are a little narrow for so few scenes.
    #[test]
    fn the_interval_holds_the_mean_in_95_of_100_samples() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let normal = Normal::new(3.0, 10.0).unwrap();
        let holds = |values: Vec<f64>| {
            let [low, high] = interval(&values);
            low < 3.0 && 3.0 < high
        };
        let held = (0..400).filter(|_| holds((0..60).map(|_| normal.sample(&mut rng)).collect())).count();
        assert!((361..=393).contains(&held), "{held} of 400");
    }

    #[test]
    fn many_scenes_have_nearly_the_same_interval_either_way() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let normal = Normal::new(0.0, 1.0).unwrap();
        let values: Vec<f64> = (0..=MAX_RESAMPLED_SCENES).map(|_| normal.sample(&mut rng)).collect();
        let [of_all, of_fewer] = [interval(&values), interval(&values[1..])];
        let width = |[low, high]: [f64; 2]| high - low;
        assert!((width(of_all) / width(of_fewer) - 1.0).abs() < 0.06, "{of_all:?}, {of_fewer:?}");
    }

    #[test]
    fn a_coin_is_as_uneven_as_counted_by_hand() {
        // 2 (1 + 10 + 45) of 1024.
        assert!((fair_coin(2, 8) - 112.0 / 1024.0).abs() < 1e-12);
        assert_eq!((fair_coin(0, 0), fair_coin(5, 5)), (1.0, 1.0));
        assert!(fair_coin(4000, 6000) < 1e-80);
    }

    #[test]
    fn probabilities_are_told_in_two_digits() {
        assert_eq!([0.25, 0.0031, 1e-9, 1.0].map(p_text), ["0.25", "0.0031", "below 0.0001", "1.00"]);
    }
}
