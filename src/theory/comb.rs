//! The comb of two ends that listen together: directions between which their phases can't decide.

use super::squint::mid_chirp_turns_per_metre;
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
    1.0 / (mid_chirp_turns_per_metre(radar).abs() * place.range_metres * (last - first))
}

/// Directions, as cos(theta) in [-1, 1] from the lowest, of the teeth up to `count` on either side of a reflector at `place`, itself not
/// counted: where both ends together hear much the same.
pub fn comb_teeth(radar: &Radar, place: Polar, count: usize) -> Vec<f64> {
    let spacing = tooth_spacing_cos(radar, place);
    let count = count as i64;
    let tooth = |i: i64| place.cos_theta + i as f64 * spacing;
    (-count..=count).filter(|i| *i != 0).map(tooth).filter(|cos| cos.abs() <= 1.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::ambiguity;
    use crate::radar::Layout;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]

        /// Teeth stand where the echoes of the two ends are most alike, within a tenth of their distance.
        #[test]
        fn teeth_stand_where_echoes_are_alike(cos_theta in -0.9..0.9f64, range_metres in 6.0..36.0f64) {
            let radar = Radar { samples: 128, ..Radar::default() };
            let place = Polar { range_metres, cos_theta };
            let spacing = tooth_spacing_cos(&radar, place);
            for tooth in comb_teeth(&radar, place, 3) {
                let around: Vec<f64> = (-40..=40).map(|i| tooth + f64::from(i) / 80.0 * spacing).collect();
                let found = ambiguity(&radar, &Layout::two_ends(&radar), place, &[range_metres], &around).likeness;
                let highest = (0..around.len()).max_by(|a, b| found[[0, *a]].total_cmp(&found[[0, *b]])).unwrap();
                prop_assert!((around[highest] - tooth).abs() < 0.1 * spacing, "{tooth}: {}", around[highest]);
            }
        }
    }

    #[test]
    fn table_3_1_has_one_tooth_about_every_column() {
        let radar = Radar::default();
        let column = 2.0 / radar.elements as f64;
        let spacing = tooth_spacing_cos(&radar, Polar { range_metres: 20.0, cos_theta: 0.0 });
        assert!((spacing / column - 1.04).abs() < 0.005, "{}", spacing / column);
        assert_eq!(
            comb_teeth(&radar, Polar { range_metres: 20.0, cos_theta: 1.0 }, 2).len(),
            2,
            "none beyond end-fire"
        );
    }
}
