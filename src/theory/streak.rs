//! The streak of a near reflector: each element sees it in its own direction and at its own range.
//!
//! Nearer than [`crate::radar::Radar::far_field_metres`] the waves are curved over the array. An element at `x` contributes to the
//! cell of the direction and range seen from there (stationary phase; J. W. Goodman, "Introduction to Fourier Optics", on chirps), so the
//! blob is smeared along a path of such cells.

use super::blob::path;
use super::{Blob, MapPlace, Response};
use crate::maps::{Aperture, Spectrum};
use crate::radar::{Decibels, Radar};
use crate::scene::Reflector;
use std::collections::{BTreeMap, BTreeSet};

const STREAK_POINTS: usize = 65;

/// Extent of one reflector's streak.
#[derive(Debug, Clone, PartialEq)]
pub struct Streak {
    /// The cells to which the elements contribute, from the first to the last.
    pub path: Vec<MapPlace>,
    /// From the peak to nearer and to farther ranges, the bins over which cells joined to it stay above the level.
    pub bins: [usize; 2],
    /// From the peak to lower and to higher columns, the columns over which such cells stay above the level.
    pub columns: [usize; 2],
}

impl Streak {
    /// The streak of `reflector` on the map of `aperture`, down to `below` the peak; `None` for one without an echo.
    pub fn of(radar: &Radar, reflector: &Reflector, aperture: Aperture, below: Decibels) -> Option<Streak> {
        let blob = Blob::of(radar, reflector, aperture)?;
        let response = Response::new(radar, reflector, aperture);
        let spectrum = Spectrum::new(radar.elements);
        let mut rows = BTreeMap::new();
        let cell = |bin: usize, column: usize| {
            let row = rows.entry(bin).or_insert_with(|| response.row(bin as f64).magnitudes(&spectrum));
            row[column]
        };
        let level = blob.magnitude / 10f64.powf(below.amplitude_decades());
        let [bins, columns] = extent(blob.peak, [radar.samples, radar.elements], level, cell);
        Some(Streak { path: path(radar, reflector, aperture, STREAK_POINTS), bins, columns })
    }
}

/// Reach, down and up each of two dimensions, of the cells above `level` that are joined to `peak` around a map of `size`.
fn extent(peak: MapPlace, size: [usize; 2], level: f64, mut cell: impl FnMut(usize, usize) -> f64) -> [[usize; 2]; 2] {
    let start = [peak.bin, peak.column].map(|v| v.round() as i64);
    let mut seen = BTreeSet::from([[0i64, 0]]);
    let mut open = vec![[0i64, 0]];
    let mut reach = [[0i64; 2]; 2];
    while let Some(at) = open.pop() {
        for (reach, at) in reach.iter_mut().zip(at) {
            *reach = [reach[0].max(-at), reach[1].max(at)];
        }
        for (by_bin, by_column) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)] {
            let next = [at[0] + by_bin, at[1] + by_column];
            // No farther than once around the map.
            let inside = next.iter().zip(size).all(|(v, size)| 2 * v.unsigned_abs() as usize <= size);
            let wrapped = |i: usize| (start[i] + next[i]).rem_euclid(size[i] as i64) as usize;
            if inside && !seen.contains(&next) && cell(wrapped(0), wrapped(1)) > level {
                seen.insert(next);
                open.push(next);
            }
        }
    }
    reach.map(|[down, up]| [down as usize, up as usize])
}

#[cfg(test)]
mod tests {
    use super::super::blob::tests::{any_place_of_any_radar, at, simulated};
    use super::*;
    use crate::radar::End;
    use proptest::prelude::*;

    /// As an independent program measured it: 153, 75, 39 and 23 columns 20 dB down at 5, 10, 20 and 35 m ahead.
    #[test]
    fn streaks_are_as_long_as_measured() {
        let radar = Radar::default();
        for (range, columns) in [(5.0, 153), (10.0, 75), (20.0, 39), (35.0, 23)] {
            let streak = Streak::of(&radar, &at(range, 0.0), Aperture::Full, Decibels(20.0)).unwrap();
            let total = streak.columns[0] + streak.columns[1] + 1;
            assert!(total.abs_diff(columns) <= 4, "{range} m: {total}");
        }
        let aside = Streak::of(&radar, &at(20.0, 0.9), Aperture::Full, Decibels(20.0)).unwrap();
        assert!(aside.bins[0].max(aside.bins[1]) > 8, "ranges differ by 24 bins between the ends: {aside:?}");
        let path = aside.path.last().unwrap().offset_to(&aside.path[0], &radar);
        assert!((path.0.abs() - 24.0).abs() < 1.0, "{path:?}");
        let end = Streak::of(&radar, &at(5.0, 0.0), Aperture::End(End::First), Decibels(20.0)).unwrap();
        assert!(end.path.last().unwrap().offset_to(&end.path[0], &radar).1.abs() < 3.0, "twelve elements see a point");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]

        #[test]
        fn streaks_reach_as_far_as_on_the_map((radar, reflector) in any_place_of_any_radar()) {
            for aperture in [Aperture::Full, Aperture::End(End::Last)] {
                let map = simulated(&radar, &reflector, aperture);
                let blob = Blob::of(&radar, &reflector, aperture).unwrap();
                let level = blob.magnitude / 10.0;
                let seen = extent(blob.peak, [radar.samples, radar.elements], level, |bin, column| map[[bin, column]]);
                let streak = Streak::of(&radar, &reflector, aperture, Decibels(20.0)).unwrap();
                prop_assert_eq!([streak.bins, streak.columns], seen);
            }
        }
    }
}
