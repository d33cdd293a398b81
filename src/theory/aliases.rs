//! Aliases: ranges wrap at the last bin, and directions fold when elements are more than half a wavelength apart.

use crate::radar::{Polar, Radar};

/// The other directions, as cos(theta) in [-1, 1] from the lowest, whose blobs stand in the same column as that of `cos_theta`.
pub fn fold_partners(radar: &Radar, cos_theta: f64) -> Vec<f64> {
    let period = radar.fold_period_cos();
    let first = ((-1.0 - cos_theta) / period).ceil() as i64;
    let last = ((1.0 - cos_theta) / period).floor() as i64;
    (first..=last).filter(|fold| *fold != 0).map(|fold| cos_theta + fold as f64 * period).collect()
}

/// The other places, up to `farthest_metres`, that stand in the same range bin and direction: whole maximum ranges nearer or farther.
/// An echo from there is weaker by the square of the distance.
pub fn wrap_partners(radar: &Radar, place: Polar, farthest_metres: f64) -> Vec<Polar> {
    let period = radar.max_range_metres();
    let first = place.range_metres.rem_euclid(period);
    let count = ((farthest_metres - first) / period).floor().max(-1.0) as i64;
    let at = |i: i64| Polar { range_metres: first + i as f64 * period, ..place };
    let other = |p: &Polar| (p.range_metres - place.range_metres).abs() > period / 2.0 && p.range_metres > 0.0;
    (0..=count).map(at).filter(other).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Blob;
    use super::super::blob::tests::{any_place_of_any_radar, at};
    use super::*;
    use crate::maps::Aperture;
    use crate::radar::{Carrier, End};
    use crate::scene::Reflector;
    use proptest::prelude::*;

    #[test]
    fn only_the_two_way_carrier_folds_at_half_a_wavelength() {
        let radar = Radar::default();
        assert!(fold_partners(&radar, 0.9).is_empty());
        let two_way = Radar { carrier: Carrier::TwoWay, ..radar.clone() };
        let partners = fold_partners(&two_way, 0.25);
        assert!(partners.len() == 1 && (partners[0] + 0.737).abs() < 1e-3, "{partners:?}");
        let wide = Radar { element_spacing_metres: 2.0 * radar.element_spacing_metres, ..radar.clone() };
        assert_eq!(fold_partners(&wide, 0.1).len(), 1);
        let here = Polar { range_metres: 5.0, cos_theta: 0.3 };
        let partners = wrap_partners(&radar, here, 100.0);
        assert_eq!(partners.len(), 2);
        assert!((partners[0].range_metres - 5.0 - radar.max_range_metres()).abs() < 1e-9);
        assert!(wrap_partners(&radar, here, 1.0).is_empty());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        /// Reflectors that are said to share a cell do, within half a cell of one end's map, where ranges don't migrate.
        #[test]
        fn partners_share_the_cell((radar, reflector) in any_place_of_any_radar()) {
            let end = Aperture::End(End::First);
            let blob = |r: &Reflector| Blob::of(&radar, r, end).unwrap();
            let x = radar.end_centre_metres(End::First);
            let local = radar.polar_of(reflector.x_metres - x, reflector.y_metres.abs());
            let moved = |polar: Polar| { let r = at(polar.range_metres, polar.cos_theta); Reflector { x_metres: r.x_metres + x, ..r } };
            // Far out, so that waves are plane over the end.
            let far = Polar { range_metres: local.range_metres + 40.0 * radar.max_range_metres(), ..local };
            let (here, columns) = (blob(&moved(far)).peak, blob(&moved(far)).columns);
            // Where one weight is all of the window, every direction is alike.
            prop_assume!(columns[0] < radar.elements as f64 / 2.0);
            for cos_theta in fold_partners(&radar, far.cos_theta) {
                let (bins, columns) = blob(&moved(Polar { cos_theta, ..far })).peak.offset_to(&here, &radar);
                prop_assert!(bins.abs() <= 0.5 && columns.abs() <= 0.5, "{cos_theta}: {bins}, {columns}");
            }
            let farthest = far.range_metres + 2.5 * radar.max_range_metres();
            let partners = wrap_partners(&radar, far, farthest);
            prop_assert!(partners.len() == 42 || partners.len() == 43, "{} partners", partners.len());
            prop_assert!(partners.iter().all(|p| (p.range_metres - far.range_metres).abs() > 0.9 * radar.max_range_metres()));
            for partner in &partners[partners.len() - 4..] {
                let (bins, columns) = blob(&moved(*partner)).peak.offset_to(&here, &radar);
                prop_assert!(bins.abs() <= 0.5 && columns.abs() <= 0.5, "{partner:?}: {bins}, {columns}");
            }
        }
    }
}
