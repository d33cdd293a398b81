//! Peaks of a map: the echoes of methods whose result is a map alone.

use ndarray::ArrayView2;

/// A local maximum of a map, refined by a parabola through its neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Range bin, fractional.
    pub range_bin: f64,
    /// Column, fractional.
    pub column: f64,
    /// Value at the vertex of the parabola, in the map's unit.
    pub value: f64,
}

/// Local maxima of `map`, `[range bins, columns]`, within `span` of the strongest, in the map's unit: the strongest first, at most `max_count`.
///
/// Bins and columns wrap around, as those of a transform. A plateau has one peak, and a flat map none. The place is most accurate in a map of decades,
/// since the logarithm of a main lobe is close to a parabola.
pub fn peaks(map: ArrayView2<'_, f64>, span: f64, max_count: usize) -> Vec<Peak> {
    let (bins, columns) = map.dim();
    let extremes = |(low, high): (f64, f64), v: &f64| (low.min(*v), high.max(*v));
    let (lowest, highest) = map.iter().fold((f64::INFINITY, f64::NEG_INFINITY), extremes);
    let threshold = (highest - span).max(lowest);
    let around = |i: usize, step: usize, len: usize| (i + len + step - 1) % len;
    let mut found: Vec<Peak> = Vec::new();
    for ((bin, column), value) in map.indexed_iter().filter(|(_, v)| **v >= threshold && **v > lowest) {
        // Of equal neighbours the first is the peak: it exceeds those before it, and is not below those after it.
        let is_peak = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).all(|(i, j)| {
            let at = (around(bin, i, bins), around(column, j, columns));
            at == (bin, column) || map[at] < *value || (map[at] == *value && at > (bin, column))
        });
        if is_peak {
            let (over_range, raised) = parabola([0, 1, 2].map(|i| map[(around(bin, i, bins), column)]));
            let (over_angle, more) = parabola([0, 1, 2].map(|j| map[(bin, around(column, j, columns))]));
            found.push(Peak {
                range_bin: bin as f64 + if bins > 2 { over_range } else { 0.0 },
                column: column as f64 + if columns > 2 { over_angle } else { 0.0 },
                value: value + if bins > 2 { raised } else { 0.0 } + if columns > 2 { more } else { 0.0 },
            });
        }
    }
    found.sort_by(|a, b| b.value.total_cmp(&a.value));
    found.truncate(max_count);
    found
}

/// Vertex of the parabola through three neighbours: its distance from the middle one, and its height above that.
fn parabola([before, middle, after]: [f64; 3]) -> (f64, f64) {
    let bend = before - 2.0 * middle + after;
    if bend >= 0.0 || !bend.is_finite() {
        return (0.0, 0.0);
    }
    let offset = (0.5 * (before - after) / bend).clamp(-0.5, 0.5);
    (offset, -0.25 * (before - after) * offset)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;
    use proptest::prelude::*;

    fn lobes(places: [(f64, f64); 2], lower: f64) -> Array2<f64> {
        let near = |d: f64, len: f64| (d + len * 1.5).rem_euclid(len) - len / 2.0;
        Array2::from_shape_fn((32, 48), |(bin, column)| {
            let lobe = |(b, c): (f64, f64)| {
                -0.1 * near(bin as f64 - b, 32.0).powi(2) - 0.05 * near(column as f64 - c, 48.0).powi(2)
            };
            lobe(places[0]).max(lobe(places[1]) - lower)
        })
    }

    #[test]
    fn peaks_are_found_between_cells() {
        let map = lobes([(7.3, 20.8), (31.6, 47.7)], 1.0);
        let found = peaks(map.view(), 1.5, 9);
        assert_eq!(found.len(), 2);
        for (peak, (bin, column, value)) in found.iter().zip([(7.3, 20.8, 0.0), (31.6, 47.7, -1.0)]) {
            let near = |a: f64, b: f64, len: f64| ((a - b + len * 1.5).rem_euclid(len) - len / 2.0).abs() < 1e-9;
            assert!(near(peak.range_bin, bin, 32.0) && near(peak.column, column, 48.0), "{peak:?}");
            assert!((peak.value - value).abs() < 1e-9, "{peak:?}");
        }
        assert_eq!(peaks(map.view(), 0.5, 9).len(), 1, "the lower one is out of the span");
        assert_eq!(peaks(map.view(), 1.5, 1).len(), 1);
    }

    #[test]
    fn a_plateau_has_one_peak() {
        assert_eq!(peaks(Array2::zeros((4, 4)).view(), 1.0, 9), []);
        let mut map = Array2::zeros((4, 6));
        map[[1, 2]] = 1.0;
        map[[1, 3]] = 1.0;
        assert_eq!(peaks(map.view(), 0.5, 9).len(), 1);
        let row = Array2::from_shape_vec((1, 5), vec![0.0, 1.0, 3.0, 2.0, 0.0]).unwrap();
        let found = peaks(row.view(), 0.5, 9);
        assert_eq!((found.len(), found[0].range_bin), (1, 0.0), "a snapshot is one row");
        assert!((found[0].column - 2.0 - 1.0 / 6.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_strongest_cell_is_always_among_them(values in proptest::collection::vec(-5.0f64..5.0, 60)) {
            let map = Array2::from_shape_vec((6, 10), values).unwrap();
            let strongest = map.iter().copied().fold(f64::MIN, f64::max);
            let found = peaks(map.view(), 100.0, 60);
            prop_assert!(found[0].value >= strongest && found.windows(2).all(|w| w[0].value >= w[1].value));
        }
    }
}
