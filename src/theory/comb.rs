//! The comb of the two ends used together: directions that their phases cannot distinguish.

use crate::radar::{End, Polar, Radar};

/// Change of cos(theta) from one tooth to the next, for a reflector at `place`: one turn more between the middles of both ends.
///
/// `d(R_first - R_last) / d cos = R (x_last / R_last - x_first / R_first)`, in turns of the middle of the chirp.
pub fn tooth_spacing_cos(radar: &Radar, place: Polar) -> f64 {
    let sin = (1.0 - place.cos_theta.powi(2)).max(0.0).sqrt();
    let (x, y) = (place.range_metres * place.cos_theta, place.range_metres * sin);
    let [first, last] = End::BOTH.map(|end| {
        let centre = radar.end_centre_metres(end);
        centre / (x - centre).hypot(y)
    });
    1.0 / (radar.middle_turns_per_metre().abs() * place.range_metres * (last - first))
}

/// Directions, as cos(theta) in [-1, 1] from the lowest, of the teeth up to `count` on either side of a reflector at `place`, itself not
/// counted: where the distances to the middles of both ends differ by whole turns more or less, so that the samples of both ends are nearly the same.
pub fn comb_teeth(radar: &Radar, place: Polar, count: usize) -> Vec<f64> {
    let turn_metres = 1.0 / radar.middle_turns_per_metre().abs();
    let here = ends_difference_metres(radar, place);
    let count = count as i64;
    let others = (-count..=count).filter(|turns| *turns != 0);
    others.filter_map(|turns| direction_of(radar, place.range_metres, here + turns as f64 * turn_metres)).collect()
}

/// Distance of a place from the first end less that from the last, metres: grows with cos(theta) at any range.
fn ends_difference_metres(radar: &Radar, place: Polar) -> f64 {
    let sin = (1.0 - place.cos_theta.powi(2)).max(0.0).sqrt();
    let (x, y) = (place.range_metres * place.cos_theta, place.range_metres * sin);
    let [first, last] = End::BOTH.map(|end| (x - radar.end_centre_metres(end)).hypot(y));
    first - last
}

/// The direction at `range_metres` with this difference of the ends' distances, if any.
fn direction_of(radar: &Radar, range_metres: f64, difference_metres: f64) -> Option<f64> {
    let beyond = |cos_theta: f64| ends_difference_metres(radar, Polar { range_metres, cos_theta }) - difference_metres;
    let (mut low, mut high) = (-1.0, 1.0);
    if beyond(low) > 0.0 || beyond(high) < 0.0 {
        return None;
    }
    for _ in 0..52 {
        let middle = (low + high) / 2.0;
        if beyond(middle) < 0.0 { low = middle } else { high = middle }
    }
    Some((low + high) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::super::blob::tests::any_place_of_any_radar;
    use super::*;
    use crate::bounds::ambiguity;
    use crate::radar::Layout;
    use proptest::prelude::*;

    /// A radar whose ends stand far enough apart to make a comb, and a place ahead of it.
    fn any_place_of_a_sparse_radar() -> impl Strategy<Value = (Radar, Polar)> {
        any_place_of_any_radar().prop_map(|(radar, r)| {
            let radar = Radar { elements: radar.elements.max(4 * radar.end_elements), ..radar };
            let polar = radar.polar_of(r.x_metres, r.y_metres);
            (radar.clone(), Polar { range_metres: polar.range_metres.max(radar.aperture_metres()), ..polar })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]

        /// The echoes of both ends correlate most in the direction of a tooth.
        #[test]
        fn teeth_of_any_radar_stand_within_half_a_column((radar, place) in any_place_of_a_sparse_radar()) {
            let column = radar.fold_period_cos() / radar.elements as f64;
            let spacing = tooth_spacing_cos(&radar, place);
            for tooth in comb_teeth(&radar, place, 1) {
                let around: Vec<f64> = (-60..=60).map(|i| tooth + f64::from(i) / 120.0 * spacing).collect();
                let found = ambiguity(&radar, &Layout::two_ends(&radar), place, &[place.range_metres], &around).likeness;
                let highest = (0..around.len()).max_by(|a, b| found[[0, *a]].total_cmp(&found[[0, *b]])).unwrap_or(0);
                let columns_off = (around[highest] - tooth) / column;
                prop_assert!(columns_off.abs() <= 0.5, "tooth at {tooth} of {place:?}: {columns_off} columns off");
            }
        }
    }
}
