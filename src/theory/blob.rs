//! The blob of one reflector: its peak, its half-power widths, its first side lobes.

use super::MapPlace;
use super::response::{Response, ResponseRow};
use super::squint::cell_seen_from;
use crate::maps::{Aperture, Spectrum};
use crate::radar::{Decibels, Radar};
use crate::scene::Reflector;

const FINE_PARTS: usize = 8;
/// Steps per bin in the search of the peak.
const STEPS_PER_BIN: f64 = 4.0;
const GOLDEN_SECTION: f64 = 0.381_966_011_250_105_1;

/// Weakest side lobe that is reported: weaker ones lie below every floor but the exact one.
pub const MIN_LOBE: Decibels = Decibels(-100.0);

/// The blob of one reflector on the map of one aperture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blob {
    pub peak: MapPlace,
    /// Magnitude of the peak, as on the complex map.
    pub magnitude: f64,
    /// From the peak to either side, the columns over which it stays above half power; half the map where it never falls so low.
    pub columns: [f64; 2],
    /// From the peak to nearer and farther ranges, the bins over which it stays above half power.
    pub bins: [f64; 2],
    /// The first side lobe at lower and at higher columns in the peak's row, where there is one above [`MIN_LOBE`].
    pub side_lobes: [Option<SideLobe>; 2],
}

/// A side lobe in the row of a blob's peak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideLobe {
    /// Columns from the peak, always positive.
    pub columns: f64,
    /// Height relative to the peak, below 0.
    pub level: Decibels,
}

struct Profile {
    /// Magnitudes, the highest first, rising columns, all around the map.
    cells: Vec<f64>,
    column: f64,
}

impl Profile {
    fn new(row: &ResponseRow, spectrum: &Spectrum, columns: usize) -> Self {
        let mut cells = row.magnitudes(spectrum);
        let highest = (0..cells.len()).max_by(|a, b| cells[*a].total_cmp(&cells[*b])).unwrap_or(0);
        cells.rotate_left(highest);
        Profile { column: highest as f64 * columns as f64 / cells.len().max(1) as f64, cells }
    }

    fn at(&self, step: usize, upward: bool) -> f64 {
        let len = self.cells.len();
        self.cells[if upward { step % len } else { (len - step % len) % len }]
    }

    /// Fine steps to half power on one side.
    fn half_power(&self, upward: bool) -> f64 {
        let level = self.cells[0] * std::f64::consts::FRAC_1_SQRT_2;
        let half = self.cells.len() / 2;
        match (1..half).find(|step| self.at(*step, upward) < level) {
            Some(step) => {
                let (above, below) = (self.at(step - 1, upward), self.at(step, upward));
                step as f64 - (level - below) / (above - below)
            }
            None => half as f64,
        }
    }

    /// Fine steps to, and height of, one side's first side lobe, beyond the first valley below half power: higher valleys are near-field ripples.
    fn side_lobe(&self, upward: bool) -> Option<(f64, f64)> {
        let half = self.cells.len() / 2;
        let at = |step: usize| self.at(step, upward);
        let valley = (1..half).find(|step| at(step + 1) > at(*step))?;
        let peak = (valley + 1..half).find(|step| at(step + 1) < at(*step))?;
        let level = self.cells[0] * std::f64::consts::FRAC_1_SQRT_2;
        (at(valley) < level).then(|| (peak as f64, at(peak)))
    }
}

impl Blob {
    /// The blob of `reflector` on the map of `aperture`; `None` for one without an echo. The radar must be valid ([`Radar::validate`]).
    pub fn of(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> Option<Blob> {
        let response = Response::new(radar, reflector, aperture);
        let spectrum = Spectrum::new(FINE_PARTS * radar.elements);
        let profile = |bin: f64| Profile::new(&response.row(bin), &spectrum, radar.elements);
        let (first, last) = bins_heard(radar, reflector, aperture);
        let highest = |bin: f64| profile(bin).cells[0];
        let steps = ((last - first) * STEPS_PER_BIN).ceil() as usize;
        let coarse = (0..=steps).map(|i| first + i as f64 / STEPS_PER_BIN);
        let (around, _) = coarse.map(|bin| (bin, highest(bin))).max_by(|a, b| a.1.total_cmp(&b.1))?;
        let bin = maximum(around - 1.0 / STEPS_PER_BIN, around + 1.0 / STEPS_PER_BIN, highest);
        let profile = profile(bin);
        let row = response.row(bin);
        let fine = 1.0 / FINE_PARTS as f64;
        let column = maximum(profile.column - fine, profile.column + fine, |column| row.magnitude(column));
        let magnitude = row.magnitude(column);
        if magnitude.is_nan() || magnitude <= 0.0 {
            return None;
        }
        let sides = [false, true];
        let along_bins = |upward: bool| {
            let sign = if upward { fine } else { -fine };
            let level = magnitude * std::f64::consts::FRAC_1_SQRT_2;
            let steps = radar.samples / 2 * FINE_PARTS;
            let beyond = (1..steps).find(|i| response.magnitude(bin + sign * *i as f64, column) < level);
            beyond.map_or(radar.samples as f64 / 2.0, |i| (i as f64 - 0.5) * fine)
        };
        let side_lobe = |upward: bool| {
            let (steps, height) = profile.side_lobe(upward)?;
            let level = Decibels(20.0 * (height / magnitude).log10());
            (level.0 > MIN_LOBE.0).then_some(SideLobe { columns: steps * fine, level })
        };
        Some(Blob {
            peak: MapPlace {
                bin: bin.rem_euclid(radar.samples as f64),
                column: column.rem_euclid(radar.elements as f64),
            },
            magnitude,
            columns: sides.map(|upward| profile.half_power(upward) * fine),
            bins: sides.map(along_bins),
            side_lobes: sides.map(side_lobe),
        })
    }
}

/// Bins from the nearest to the farthest element of `aperture`, not wrapped.
fn bins_heard(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> (f64, f64) {
    let elements = aperture.channels(radar);
    let bin = |n| radar.bin_of_range(radar.pair(n).range_metres(reflector.x_metres, reflector.y_metres));
    elements.map(bin).fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
}

/// Place of the maximum of `f` between `low` and `high`, by golden sections.
fn maximum(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..14 {
        let (a, b) = (low + GOLDEN_SECTION * (high - low), high - GOLDEN_SECTION * (high - low));
        if f(a) < f(b) { low = a } else { high = b }
    }
    (low + high) / 2.0
}

/// The path of a reflector's blob as the elements of `aperture` hear it: `points` cells, from the first element to the last.
pub(super) fn path(radar: &Radar, reflector: &Reflector, aperture: Aperture, points: usize) -> Vec<MapPlace> {
    let elements = aperture.channels(radar);
    let (left, right) =
        (radar.element_x_metres(elements.start), radar.element_x_metres(elements.end.saturating_sub(1)));
    let at = |i: usize| left + (right - left) * i as f64 / points.saturating_sub(1).max(1) as f64;
    (0..points).map(|i| cell_seen_from(radar, reflector.x_metres, reflector.y_metres, at(i))).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::blob_cell;
    use super::*;
    use crate::maps::{angle_transform, range_transform};
    use crate::radar::{Carrier, End, WindowFunction};
    use crate::signal::exact;
    use ndarray::Array2;
    use num_complex::Complex64;
    use proptest::prelude::*;

    /// Cells of a fine map to a cell of the map.
    const PARTS: usize = 4;

    /// A small valid radar of any kind, and a reflector no nearer than its array is long, ranges beyond the last bin included.
    pub fn any_place_of_any_radar() -> impl Strategy<Value = (Radar, Reflector)> {
        let radar = (24e9..81e9f64, 8.2..9.3f64, 0.25..1.0f64, 16..=80usize, 16..=80usize, 3..=8usize, 0..8usize)
            .prop_map(|(carrier_hz, bandwidth, spacing, elements, samples, end_elements, kind)| Radar {
                carrier_hz,
                bandwidth_hz: 10f64.powf(bandwidth),
                element_spacing_metres: spacing * crate::radar::SPEED_OF_LIGHT / carrier_hz,
                elements,
                samples,
                end_elements,
                carrier: if kind % 2 == 0 { Carrier::OneWay } else { Carrier::TwoWay },
                window: WindowFunction::ALL[kind / 2],
                ..Radar::default()
            });
        (radar, 0.1..1.3f64, -0.95..0.95f64, any::<bool>()).prop_map(|(radar, range, cos, behind)| {
            let range = (range * radar.max_range_metres()).max(radar.aperture_metres());
            let y_metres = range * (1.0 - cos * cos).sqrt() * if behind { -1.0 } else { 1.0 };
            (radar, Reflector { x_metres: range * cos, y_metres, reflectivity: 1.0 })
        })
    }

    pub fn at(range: f64, cos: f64) -> Reflector {
        Reflector { x_metres: range * cos, y_metres: range * (1.0 - cos * cos).max(0.0).sqrt(), reflectivity: 1.0 }
    }

    pub fn simulated(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> Array2<f64> {
        let profiles = range_transform(radar, &exact::beat_signal(radar, &[*reflector]));
        angle_transform(radar, &profiles, aperture).cells.mapv(Complex64::norm)
    }

    /// Magnitudes of the simulated map with [`PARTS`] cells for each of its cells, from the simulated samples alone.
    fn simulated_finely(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> Array2<f64> {
        let signal = exact::beat_signal(radar, &[*reflector]).samples;
        let channels: Vec<usize> = aperture.channels(radar).collect();
        let (over_range, over_angle) = (radar.window.weights(radar.samples), radar.window.weights(channels.len()));
        let (range, angle) = (Spectrum::new(PARTS * radar.samples), Spectrum::new(PARTS * radar.elements));
        let profiles: Vec<Vec<Complex64>> =
            channels.iter().map(|n| range.of(signal.row(*n).iter().zip(&over_range).map(|(v, w)| v * w))).collect();
        let scale = ((radar.samples * radar.elements) as f64).sqrt().recip();
        let mut map = Array2::zeros((range.len(), angle.len()));
        for (bin, mut row) in map.outer_iter_mut().enumerate() {
            let cells = angle.of(profiles.iter().zip(&over_angle).map(|(p, w)| p[bin] * w * scale));
            for (k, v) in cells.iter().enumerate() {
                row[(k + PARTS * (radar.elements / 2)) % angle.len()] = v.norm();
            }
        }
        map
    }

    /// Row and column of the simulated map through any place between its cells, that place first, [`FINE_PARTS`] parts to a cell.
    struct Cross {
        row: Vec<f64>,
        column: Vec<f64>,
    }

    fn simulated_through(radar: &Radar, reflector: &Reflector, aperture: Aperture, at: MapPlace) -> Cross {
        let signal = exact::beat_signal(radar, &[*reflector]).samples;
        let turned = |weights: Vec<f64>, turns: f64| -> Vec<Complex64> {
            let turn = |(n, w): (usize, f64)| w * Complex64::cis(-std::f64::consts::TAU * turns * n as f64);
            weights.into_iter().enumerate().map(turn).collect()
        };
        let channels: Vec<usize> = aperture.channels(radar).collect();
        let middle = (radar.elements / 2) as f64;
        let over_range = turned(radar.window.weights(radar.samples), at.bin / radar.samples as f64);
        let over_angle = turned(radar.window.weights(channels.len()), (at.column - middle) / radar.elements as f64);
        let scale = ((radar.samples * radar.elements) as f64).sqrt().recip();
        let weighted = |m: usize, n: usize| signal[[channels[m], n]] * over_range[n] * over_angle[m] * scale;
        let over_bins = |m: usize| (0..radar.samples).map(|n| weighted(m, n)).sum::<Complex64>();
        let over_channels = |n: usize| (0..channels.len()).map(|m| weighted(m, n)).sum::<Complex64>();
        let magnitudes = |cells: Vec<Complex64>| cells.iter().map(|v| v.norm()).collect();
        Cross {
            row: magnitudes(Spectrum::new(FINE_PARTS * radar.elements).of((0..channels.len()).map(over_bins))),
            column: magnitudes(Spectrum::new(FINE_PARTS * radar.samples).of((0..radar.samples).map(over_channels))),
        }
    }

    struct Around<'a> {
        cells: &'a [f64],
        from: usize,
    }

    impl Around<'_> {
        fn at(&self, steps: i64) -> f64 {
            self.cells[(self.from as i64 + steps).rem_euclid(self.cells.len() as i64) as usize]
        }

        fn half(&self) -> i64 {
            self.cells.len() as i64 / 2
        }

        /// Cells to the first magnitude below `level` on the `side` of the lower (-1) or higher (1) cells.
        fn reach(&self, side: i64, level: f64) -> f64 {
            let beyond = (1..self.half()).find(|i| self.at(side * i) < level);
            beyond.map_or(self.half() as f64, |i| i as f64 - 0.5) / FINE_PARTS as f64
        }

        /// Holds half-power widths to half a cell; of a row level within two percent of half power any place will do.
        fn hold_widths(&self, predicted: [f64; 2]) -> Result<(), TestCaseError> {
            let level = self.at(0) * std::f64::consts::FRAC_1_SQRT_2;
            for (side, predicted) in [-1, 1].into_iter().zip(predicted) {
                let (from, to) = (self.reach(side, 1.02 * level), self.reach(side, 0.98 * level));
                prop_assert!(predicted >= from - 0.5 && predicted <= to + 0.5, "{predicted}, seen {from} to {to}");
            }
            Ok(())
        }

        fn hold_side_lobe(&self, side: i64, lobe: SideLobe) -> Result<(), TestCaseError> {
            let at = |i: i64| self.at(side * i);
            let valley = (1..self.half()).find(|i| at(i + 1) > at(*i));
            let peak = valley.and_then(|valley| (valley + 1..self.half()).find(|i| at(i + 1) < at(*i)));
            let peak = peak.ok_or_else(|| TestCaseError::fail(format!("{lobe:?}, but none seen")))?;
            let level = 20.0 * (at(peak) / at(0)).log10();
            let columns = peak as f64 / FINE_PARTS as f64;
            prop_assert!((columns - lobe.columns).abs() <= 0.5, "{lobe:?}, seen {columns} columns off");
            prop_assert!((level - lobe.level.0).abs() < 0.5, "{lobe:?}, seen {level} dB");
            Ok(())
        }
    }

    fn hold(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> Result<(), TestCaseError> {
        let map = simulated_finely(radar, reflector, aperture);
        let blob = Blob::of(radar, reflector, aperture).expect("it has an echo");
        let ((bin, column), highest) = map.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        let cross = simulated_through(radar, reflector, aperture, blob.peak);
        let there = cross.row[0];
        prop_assert!((blob.magnitude / there - 1.0).abs() < 1e-6, "{blob:?}, seen {there}");
        let seen = MapPlace { bin: bin as f64 / PARTS as f64, column: column as f64 / PARTS as f64 };
        let (bins_off, columns_off) = blob.peak.offset_to(&seen, radar);
        // Of two peaks of the same height either will do.
        let same_height = there > 0.995 * highest;
        prop_assert!(same_height || (bins_off.abs() <= 0.5 && columns_off.abs() <= 0.5), "{blob:?}, seen at {seen:?}");
        prop_assert!((there / highest - 1.0).abs() < 0.05, "{blob:?}, seen {highest}");

        Around { cells: &cross.column, from: 0 }.hold_widths(blob.bins)?;
        // The row in the same fine columns as the prediction, so that both find the same shallow valleys.
        let whole =
            MapPlace { column: (blob.peak.column * FINE_PARTS as f64).round() / FINE_PARTS as f64, ..blob.peak };
        let row = simulated_through(radar, reflector, aperture, whole).row;
        let near = [row.len() - 1, 0, 1];
        let from = near.into_iter().max_by(|a, b| row[*a].total_cmp(&row[*b])).unwrap_or(0);
        let row = Around { cells: &row, from };
        row.hold_widths(blob.columns)?;
        for (side, lobe) in [-1, 1].into_iter().zip(blob.side_lobes) {
            lobe.map_or(Ok(()), |lobe| row.hold_side_lobe(side, lobe))?;
        }
        Ok(())
    }

    /// Three elements under a wide band: the row falls to half power where it is nearly level, and another row falls a column elsewhere.
    #[test]
    fn a_blob_on_a_plateau_is_measured_in_its_own_row() -> Result<(), TestCaseError> {
        let radar = Radar {
            bandwidth_hz: 257_801_216.372_193_84,
            carrier_hz: 24e9,
            element_spacing_metres: 0.011_082_655_188_412_045,
            elements: 32,
            end_elements: 3,
            samples: 26,
            carrier: Carrier::TwoWay,
            window: WindowFunction::Rectangular,
            ..Radar::default()
        };
        let reflector = Reflector::at([-0.836_824_449_514_143_4, 1.323_439_071_373_973_2], 1.0);
        Aperture::ALL.into_iter().try_for_each(|aperture| hold(&radar, &reflector, aperture))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]
        #[test]
        fn blobs_stand_where_the_map_has_them((radar, reflector) in any_place_of_any_radar()) {
            for aperture in Aperture::ALL {
                hold(&radar, &reflector, aperture)?;
            }
        }
    }

    #[test]
    fn the_formula_alone_is_within_a_column_for_table_3_1() {
        let radar = Radar::default();
        for (range, cos) in [(5.0, 0.0), (8.0, 0.5), (12.0, -0.832), (20.0, 0.9), (35.0, -0.3)] {
            let r = at(range, cos);
            for aperture in Aperture::ALL {
                let blob = Blob::of(&radar, &r, aperture).unwrap();
                let (bins, columns) = blob_cell(&radar, r.x_metres, r.y_metres, aperture).offset_to(&blob.peak, &radar);
                assert!(bins.abs() < 0.5 && columns.abs() < 1.0, "{range} m, {cos}, {aperture:?}: {bins} {columns}");
            }
        }
    }

    #[test]
    fn a_ripple_far_beneath_every_floor_is_no_side_lobe() {
        let radar = Radar::default();
        for place in [[0.0, 5.0], [0.0, 10.0], [0.0, 20.0], [4.0, 12.0], [-6.0, 18.0], [8.0, 30.0]] {
            let blob = Blob::of(&radar, &Reflector::at(place, 1.0), Aperture::Full).unwrap();
            for lobe in blob.side_lobes.into_iter().flatten() {
                assert!(lobe.level.0 > -100.0, "{lobe:?} at {place:?}");
            }
        }
    }

    #[test]
    fn what_has_no_echo_has_no_blob() {
        assert_eq!(Blob::of(&Radar::default(), &Reflector::at([1.0, 5.0], 0.0), Aperture::End(End::First)), None);
    }
}
