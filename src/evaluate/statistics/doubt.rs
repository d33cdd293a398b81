//! The area under the ROC curve of doubt as a predictor of failures, the rows with the largest squared errors.

use crate::evaluate::rows::Row;

/// Failures are the rows with the largest squared errors, one of so many, unless a limit is given.
pub const ONE_OF: usize = 10;

/// Area under the ROC curve of a score that separates failures from other rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RocArea {
    /// Probability that a failure has a larger score than another row; equal scores count half (Mann and Whitney). At 0.5 the score is no better
    /// than chance, at 1 every failure has a larger score than every other row.
    pub area: f64,
    /// Standard error of the area (DeLong, DeLong and Clarke-Pearson, Biometrics 44, 1988); `None` with fewer than two failures or two others.
    pub standard_error: Option<f64>,
}

impl RocArea {
    /// The area of pairs of a score and whether its row is a failure; `None` where all are failures, or none. Scores are finite.
    pub fn of(scores: &[(f64, bool)]) -> Option<RocArea> {
        let of = |wanted: bool| scores.iter().filter(move |(_, failed)| *failed == wanted).map(|(score, _)| *score);
        let (failures, others): (Vec<f64>, Vec<f64>) = (sorted(of(true)), sorted(of(false)));
        if failures.is_empty() || others.is_empty() {
            return None;
        }
        let above: Vec<f64> = failures.iter().map(|score| part_below(&others, *score)).collect();
        let below: Vec<f64> = others.iter().map(|score| part_below(&failures, *score)).collect();
        let area = above.iter().sum::<f64>() / above.len() as f64;
        let standard_error = variance_of_mean(&above).zip(variance_of_mean(&below)).map(|(a, b)| (a + b).sqrt());
        Some(RocArea { area, standard_error })
    }
}

fn sorted(scores: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut scores: Vec<f64> = scores.collect();
    scores.sort_by(f64::total_cmp);
    scores
}

/// Part of the `sorted` scores that are smaller than `score`; equal ones count half.
fn part_below(sorted: &[f64], score: f64) -> f64 {
    let smaller = sorted.partition_point(|other| *other < score);
    let not_larger = sorted.partition_point(|other| *other <= score);
    0.5 * (smaller + not_larger) as f64 / sorted.len() as f64
}

fn variance_of_mean(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (values.len() > 1).then(|| squares / (n - 1.0) / n)
}

/// Area under the ROC curve of one method's doubt as a predictor of its failures.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct DoubtArea {
    /// Rows with a doubt.
    pub rows: usize,
    /// Failures among them.
    pub failures: usize,
    /// Rows with at least this squared error are failures.
    pub least_squared_error: f64,
    /// [`RocArea::area`]; `None` where every row is a failure, or none.
    pub area: Option<f64>,
    /// [`RocArea::standard_error`].
    pub standard_error: Option<f64>,
}

impl DoubtArea {
    /// The area of the rows of one method. Failures are the tenth with the largest squared errors, rounded down, and those that equal the
    /// smallest of them; or, where `limit` is given, all rows with at least that squared error. `None` where no row has a doubt, and without a
    /// limit for fewer than [`ONE_OF`] rows, which have no tenth.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a Row>, limit: Option<f64>) -> Option<DoubtArea> {
        let said: Vec<(f64, f64)> = rows.into_iter().filter_map(|row| Some((row.doubt?, row.squared_error))).collect();
        let mut errors = sorted(said.iter().map(|(_, error)| *error));
        errors.reverse();
        let tenth = (errors.len() / ONE_OF).checked_sub(1).and_then(|last| errors.get(last).copied());
        let least_squared_error = limit.or(tenth).filter(|_| !said.is_empty())?;
        let scores: Vec<(f64, bool)> =
            said.iter().map(|(doubt, error)| (*doubt, *error >= least_squared_error)).collect();
        let failures = scores.iter().filter(|(_, failed)| *failed).count();
        let found = RocArea::of(&scores);
        let (area, standard_error) = (found.map(|found| found.area), found.and_then(|found| found.standard_error));
        Some(DoubtArea { rows: scores.len(), failures, least_squared_error, area, standard_error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::rows::tests::row;

    fn rows(pairs: &[(f64, f64)]) -> Vec<Row> {
        let of = |(i, (doubt, squared_error)): (usize, &(f64, f64))| Row {
            doubt: Some(*doubt),
            squared_error: *squared_error,
            ..row("1", i as u32, "live")
        };
        pairs.iter().enumerate().map(of).collect()
    }

    /// Failures 3, 2; others 2, 1, 0: of six pairs five are in order and one is a tie.
    const SCORES: [(f64, bool); 5] = [(3.0, true), (2.0, true), (2.0, false), (1.0, false), (0.0, false)];

    #[test]
    fn the_standard_error_is_that_computed_by_hand() {
        // Failures have 1 and 2.5/3 of the others below, the others 0.25, 0 and 0 of the failures.
        let by_hand = (1.0f64 / 144.0 + 1.0 / 144.0).sqrt();
        let found = RocArea::of(&SCORES).unwrap();
        assert!((found.standard_error.unwrap() - by_hand).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn scores_of_one_kind_have_no_area() {
        assert_eq!((RocArea::of(&[(1.0, true)]), RocArea::of(&[(1.0, false)]), RocArea::of(&[])), (None, None, None));
    }

    #[test]
    fn an_area_is_that_of_counting_every_pair() {
        let scores: Vec<(f64, bool)> = (0..200u32).map(|i| (f64::from(i * 37 % 23), i * 53 % 7 == 0)).collect();
        let (mut ordered, mut pairs) = (0.0, 0.0);
        for (failure, _) in scores.iter().filter(|(_, failed)| *failed) {
            for (other, _) in scores.iter().filter(|(_, failed)| !*failed) {
                pairs += 1.0;
                ordered += if failure > other { 1.0 } else { 0.5 * f64::from(u8::from(failure == other)) };
            }
        }
        assert!((RocArea::of(&scores).unwrap().area - ordered / pairs).abs() < 1e-12);
    }

    #[test]
    fn rows_without_doubt_are_left_out() {
        let mut rows = rows(&(0..10).map(|i| (f64::from(i), f64::from(i))).collect::<Vec<_>>());
        rows[0].doubt = None;
        assert_eq!(DoubtArea::of(&rows, None), None, "nine rows have no tenth");
        assert_eq!(DoubtArea::of(&rows, Some(5.0)).map(|a| (a.failures, a.rows)), Some((5, 9)));
        rows.iter_mut().for_each(|row| row.doubt = None);
        assert_eq!(DoubtArea::of(&rows, Some(5.0)), None);
    }
}
