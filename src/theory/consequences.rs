//! Quantities that follow from a radar's constants alone.

use super::WindowPattern;
use crate::radar::{Decibels, Radar};

const HALF_POWER: Decibels = Decibels(3.010_299_956_639_812);

/// The consequences of one radar's constants (thesis table 3.1 and section 2.2).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Consequences {
    /// Distance between neighbouring range bins, `c / 2B`.
    pub range_bin_metres: f64,
    /// Range at which bins wrap around, `N_r c / 2B`.
    pub max_range_metres: f64,
    /// Half-power width of a blob over range under the window, in metres; `None` for a window that does not resolve range.
    pub range_width_metres: Option<f64>,
    /// Half-power beam width of the whole array.
    pub full_beam: BeamWidth,
    /// Half-power beam width of one end.
    pub end_beam: BeamWidth,
    /// Columns from a blob to its first grating lobe: one turn from element to element, the map's width at any spacing.
    pub grating_columns: f64,
    /// The same in cos(theta): below 2 some directions have a grating lobe (M. I. Skolnik, "Introduction to Radar Systems", on arrays).
    pub grating_cos: f64,
    /// Columns between cos(theta) = -1 and 1: fewer than the map has where elements stand close together.
    pub visible_columns: f64,
    /// Distance beyond which waves are plane over the whole array, in metres ([`Radar::far_field_metres`]).
    pub full_far_field_metres: f64,
    /// `full_far_field_metres` for one end, its elements taken for antennas that send and hear ([`Radar::plane_beyond_metres`]).
    pub end_far_field_metres: f64,
    /// Largest change of range across the whole array, bins: beyond one, blobs off broadside migrate. A common transmitter would halve it.
    pub migration_bins: f64,
    /// Cosine at which a blob stands over the true one ([`Radar::squint`]).
    pub squint_factor: f64,
}

/// Half-power width of a beam at broadside.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct BeamWidth {
    /// In columns of the map; all of them if the aperture receives every direction equally.
    pub columns: f64,
    /// In cos(theta), at most 2.
    pub cos_theta: f64,
    /// In radians around broadside, at most pi.
    pub radians: f64,
}

impl BeamWidth {
    fn new(radar: &Radar, elements: usize) -> Self {
        let all = radar.elements as f64;
        let bins = WindowPattern::new(radar.window, elements).main_lobe_bins(HALF_POWER);
        let columns = bins.map_or(all, |bins| bins * all / elements as f64);
        let cos_theta = (columns / all * radar.fold_period_cos()).min(2.0);
        BeamWidth { columns, cos_theta, radians: 2.0 * (cos_theta / 2.0).asin() }
    }
}

impl Consequences {
    /// The consequences of `radar`, which must be valid ([`Radar::validate`]).
    pub fn of(radar: &Radar) -> Consequences {
        let bin = radar.range_resolution_metres();
        let end_aperture = (radar.end_elements as f64 - 1.0) * radar.element_spacing_metres;
        Consequences {
            range_bin_metres: bin,
            max_range_metres: radar.max_range_metres(),
            range_width_metres: WindowPattern::new(radar.window, radar.samples)
                .main_lobe_bins(HALF_POWER)
                .map(|w| w * bin),
            full_beam: BeamWidth::new(radar, radar.elements),
            end_beam: BeamWidth::new(radar, radar.end_elements),
            grating_columns: radar.elements as f64,
            grating_cos: radar.fold_period_cos(),
            visible_columns: (2.0 / radar.fold_period_cos() * radar.elements as f64).min(radar.elements as f64),
            full_far_field_metres: radar.far_field_metres(),
            end_far_field_metres: radar.plane_beyond_metres(end_aperture),
            migration_bins: radar.aperture_metres() / bin,
            squint_factor: radar.squint(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Blob;
    use super::super::blob::tests::any_place_of_any_radar;
    use super::*;
    use crate::maps::Aperture;
    use crate::radar::End;
    use crate::scene::Reflector;
    use proptest::prelude::*;

    #[test]
    fn table_3_1() {
        let c = Consequences::of(&Radar::default());
        assert!((c.range_bin_metres - 0.07495).abs() < 1e-5 && (c.max_range_metres - 38.37).abs() < 0.01);
        assert!((c.full_far_field_metres - 2037.0).abs() < 5.0 && (c.end_far_field_metres - 0.2356).abs() < 1e-3);
        // 1.44 bins of a Hann window: 1.44 columns for the whole array, and 1.44 * 1024 / 12 * 12 / 11 for an end whose outer two weigh nothing.
        assert!((c.full_beam.columns - 1.44).abs() < 0.01, "{c:?}");
        assert!((c.end_beam.columns - 134.0).abs() < 2.0, "{c:?}");
        assert!((c.grating_cos - 2.053).abs() < 1e-3 && c.grating_columns == 1024.0);
        assert!((c.migration_bins - 26.6).abs() < 0.1);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        /// Far ahead of the array, blobs are as wide as the constants say, within half a cell over both sides.
        #[test]
        fn far_blobs_are_as_wide_as_the_beam((radar, _) in any_place_of_any_radar()) {
            let c = Consequences::of(&radar);
            let y_metres = 50.0 * c.full_far_field_metres.max(c.max_range_metres);
            for (aperture, beam) in [(Aperture::Full, c.full_beam), (Aperture::End(End::First), c.end_beam)] {
                let x_metres = if aperture == Aperture::Full { 0.0 } else { radar.end_centre_metres(End::First) };
                let blob = Blob::of(&radar, &Reflector { x_metres, y_metres, reflectivity: 1.0 }, aperture).unwrap();
                let columns: f64 = blob.columns.iter().sum();
                prop_assert!((columns - beam.columns).abs() <= 0.5, "{aperture:?}: {blob:?}, {beam:?}");
                let bins: f64 = blob.bins.iter().sum();
                let width = c.range_width_metres.unwrap() / c.range_bin_metres;
                prop_assert!((bins - width).abs() <= 0.5, "{bins} for {width}");
            }
        }
    }
}
