//! Statistics of repeated time measurements.

use super::BareTransform;

pub(super) fn bare_ms(repeats: usize) -> f64 {
    let mut transform = BareTransform::default();
    let mut times: Vec<f64> = (0..repeats + 2).map(|_| 1e3 * transform.run().as_secs_f64()).collect();
    quantile(&mut times[2..], 0.5)
}

/// The quantile of `times` below which the part `part` lies; 0 for none. Sorts `times`.
pub(super) fn quantile(times: &mut [f64], part: f64) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get((times.len().saturating_sub(1) as f64 * part).round() as usize).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantiles_of_known_times_are_theirs() {
        let mut times = [4.0, 1.0, 3.0, 2.0, 50.0];
        assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(|part| quantile(&mut times, part)), [1.0, 2.0, 3.0, 4.0, 50.0]);
        assert_eq!(quantile(&mut [], 0.5), 0.0);
    }
}
