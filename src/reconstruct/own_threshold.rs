//! A threshold computed from a map and its expected error, for any floor and normalisation.
//!
//! P_D is of the cells whose true Lambda exceeds 0.9, P_FA of the others ([`Metrics`](crate::evaluate::Metrics)). An exact map would need a threshold of
//! 0.9. A map with errors needs a lower one, so that cells which are too dark in it are detected. Its false alarms bound the threshold from below.

use crate::maps::RangeAngleMap;

/// Lambda beyond which a cell of the target counts as an object (thesis section 4.2).
const TARGET_ETA: f32 = 0.9;

/// Largest part of the map's cells at or below [`TARGET_ETA`] that exceed the threshold: a little below the 1 % of P_FA that is the aim.
const MAX_FALSE_ALARM_PART: f64 = 0.0092;

/// Lambda of the cells near [`TARGET_ETA`] whose doubt lowers the threshold.
const DOUBT_LAMBDAS: std::ops::Range<f32> = 0.75..0.95;

/// Part of those cells whose doubt is smaller than the threshold's distance from [`TARGET_ETA`].
const COVERED_PART: f64 = 0.9;

/// Largest threshold, that of an exact map.
const MAX_ETA: f32 = 0.896;

/// Steps of Lambda in the histograms of quantiles.
const HISTOGRAM_STEPS: usize = 4096;

/// The threshold on the Lambda of `answer`, `[range bins, columns]`, rounded to three decimals. `doubt` is the bound, in Lambda, below which nine of ten
/// errors are. `examples/experts.rs` prints the resulting rates.
pub(crate) fn own_threshold(answer: &RangeAngleMap, doubt: Option<&RangeAngleMap>) -> f32 {
    let below =
        quantile(answer.lambda.iter().copied().filter(|v| *v <= TARGET_ETA), 1.0 - MAX_FALSE_ALARM_PART).unwrap_or(0.0);
    let doubtful = doubt.map(|doubt| {
        let near = answer.lambda.iter().zip(&doubt.lambda).filter(|(v, _)| DOUBT_LAMBDAS.contains(*v));
        TARGET_ETA - quantile(near.map(|(_, doubt)| *doubt), COVERED_PART).unwrap_or(0.0)
    });
    let eta = doubtful.unwrap_or(0.0).max(below).min(MAX_ETA);
    (eta * 1e3).round() / 1e3
}

/// The quantile at `part` of `values`, which are 0 to 1; `None` without any.
fn quantile(values: impl Iterator<Item = f32>, part: f64) -> Option<f32> {
    let mut counts = [0u32; HISTOGRAM_STEPS + 1];
    let mut total = 0u32;
    for value in values {
        counts[(value.clamp(0.0, 1.0) * HISTOGRAM_STEPS as f32) as usize] += 1;
        total += 1;
    }
    let rank = (part * f64::from(total)).ceil() as u32;
    let mut sum = 0;
    let step = counts.iter().position(|count| {
        sum += count;
        sum >= rank
    })?;
    (total > 0).then(|| (step as f32 + 1.0).min(HISTOGRAM_STEPS as f32) / HISTOGRAM_STEPS as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    fn map(of: impl Fn(usize) -> f32) -> RangeAngleMap {
        RangeAngleMap { lambda: Array2::from_shape_fn((100, 100), |(i, j)| of(100 * i + j)) }
    }

    #[test]
    fn a_quantile_is_within_a_step() {
        let all = || (0..1000).map(|i| i as f32 / 1000.0);
        for part in [0.1, 0.5, 0.99] {
            let found = quantile(all(), part).unwrap();
            assert!((found - part as f32).abs() < 2e-3, "{part}: {found}");
        }
        assert_eq!(quantile(std::iter::empty(), 0.5), None);
    }

    #[test]
    fn few_cells_below_the_target_exceed_it() {
        let even = map(|i| i as f32 / 10_000.0);
        let eta = own_threshold(&even, None);
        let alarms = even.lambda.iter().filter(|v| **v <= TARGET_ETA && **v > eta).count() as f64 / 9000.0;
        assert!((0.007..=0.0095).contains(&alarms), "{alarms} at {eta}");
    }

    #[test]
    fn doubt_lowers_it_and_alarms_bound_how_far() {
        // One bright cell in a thousand over a dark map, and cells between.
        let few = map(|i| match i % 1000 {
            0 => 0.95,
            1 | 501 => 0.8,
            _ => 0.1,
        });
        let with = |doubt: f32| own_threshold(&few, Some(&map(|_| doubt)));
        assert_eq!((with(0.0), with(0.05)), (MAX_ETA, 0.85));
        let bright = map(|i| i as f32 / 10_000.0);
        assert_eq!(own_threshold(&bright, Some(&map(|_| 0.5))), own_threshold(&bright, None));
    }
}
