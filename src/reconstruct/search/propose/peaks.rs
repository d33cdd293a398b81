//! Peaks of a residual on a polar grid around the array's centre. The power in a cell is the product of the magnitudes of both ends' beams, each at the
//! range and direction of the cell from that end.
//!
//! Amplitudes are not added, since the phase between the ends changes with each column of the full map. A peak of one end alone is a ghost.

use super::end_beams::{beam_count, beam_of_cos, end_beams};
use super::view::View;
use crate::radar::{End, Radar};
use crate::reconstruct::fit::BinSpans;
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Columns of the grid for each element of an end.
const COLUMNS_PER_ELEMENT: usize = 10;

/// Least distance in range of two peaks of one search: the residual of the stronger one may be the nearer one.
const MIN_PEAK_DISTANCE_BINS: usize = 8;

/// Range bins beside spans that count as within.
const SPAN_MARGIN_BINS: f64 = 1.0;

/// The grid of a radar.
pub struct Detector {
    radar: Radar,
    /// Centre (x, y) of each cell, metres, `[range bins * columns]`, up to twice the maximum range.
    places_metres: Vec<[f64; 2]>,
    /// Number `beam * range bins + range bin` of each cell at each end.
    cells: [Vec<u32>; 2],
}

/// The detector of the last radar: the radar seldom changes.
static LAST_DETECTOR: Mutex<Option<Arc<Detector>>> = Mutex::new(None);

impl Detector {
    /// The detector of `radar`.
    pub fn of(radar: &Radar) -> Arc<Detector> {
        let last = LAST_DETECTOR.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(detector) = last.filter(|detector| detector.radar == *radar) {
            return detector;
        }
        let detector = Arc::new(Detector::new(radar));
        *LAST_DETECTOR.lock().unwrap_or_else(PoisonError::into_inner) = Some(detector.clone());
        detector
    }

    fn new(radar: &Radar) -> Self {
        let (beams, columns) = (beam_count(radar), COLUMNS_PER_ELEMENT * radar.end_elements);
        let (bins, bin_metres) = (radar.samples, radar.range_resolution_metres());
        let place = |i: usize| {
            let range = (i / columns) as f64 * bin_metres;
            let cos = ((i % columns) as f64 + 0.5) / columns as f64 * 2.0 - 1.0;
            [range * cos, range * (1.0 - cos * cos).sqrt()]
        };
        let places_metres: Vec<[f64; 2]> = (0..2 * bins * columns).map(place).collect();
        let cells = End::BOTH.map(|end| {
            let view = View::of(radar, end);
            let cell = |place: &[f64; 2]| {
                let (range, cos) = view.range_and_cos(*place, 1e-9);
                let row = (range / bin_metres).round() as usize % bins;
                (beam_of_cos(cos, beams) * bins + row) as u32
            };
            places_metres.iter().map(cell).collect()
        });
        Detector { radar: radar.clone(), places_metres, cells }
    }

    /// Range bin of cell `i` at an end.
    fn bin(&self, end: usize, i: u32) -> usize {
        self.cells[end][i as usize] as usize % self.radar.samples
    }

    /// At most `max_peaks` places (x, y; metres) whose power exceeds `min_power`, the strongest first, without those that may be side lobes of stronger
    /// ones. `residual` is channel by channel, `[channels * samples]`, without a window.
    pub fn peaks(&self, residual: &[Complex64], min_power: f64, max_peaks: usize) -> Vec<[f64; 2]> {
        let powers = self.powers(residual);
        let strong = |i: u32| Some((powers.of(i), i)).filter(|(p, _)| f64::from(*p) > min_power);
        let mut strong: Vec<(f32, u32)> = self.cells().filter_map(strong).collect();
        let mut found = Vec::new();
        let mut next = strongest(strong.iter().copied());
        while let Some((power, i)) = next {
            let power = f64::from(power);
            found.push(self.places_metres[i as usize]);
            if found.len() == max_peaks {
                break;
            }
            let [first, last] = [0, 1].map(|end| self.side_lobes(self.bin(end, i)));
            let lobe = |i: u32| first[self.bin(0, i)] * last[self.bin(1, i)];
            strong.retain(|&(other, i)| f64::from(other) > power * lobe(i));
            next = strongest(strong.iter().copied());
        }
        found
    }

    /// The place (x, y; metres) of the largest power in `spans` and their margins.
    pub fn strongest_within(&self, residual: &[Complex64], spans: &BinSpans) -> Option<[f64; 2]> {
        let powers = self.powers(residual);
        let bins = self.radar.samples;
        let is_within = |end: usize, bin: u32| {
            let (low, high) = spans[end];
            (f64::from(bin) - low + SPAN_MARGIN_BINS).rem_euclid(bins as f64) <= high - low + 2.0 * SPAN_MARGIN_BINS
        };
        let near = |end: usize| (0..bins as u32).map(|bin| is_within(end, bin)).collect::<Vec<bool>>();
        let [first, last] = [0, 1].map(near);
        let is_near = |i: &u32| first[self.bin(0, *i)] && last[self.bin(1, *i)];
        let cells: Vec<(f32, u32)> = self.cells().filter(is_near).map(|i| (powers.of(i), i)).collect();
        strongest(cells.into_iter()).map(|(_, i)| self.places_metres[i as usize])
    }

    fn cells(&self) -> impl IndexedParallelIterator<Item = u32> {
        (0..self.places_metres.len() as u32).into_par_iter()
    }

    fn powers(&self, residual: &[Complex64]) -> Powers<'_> {
        let magnitudes = end_beams(&self.radar, residual, beam_count(&self.radar))
            .map(|beams| beams.into_par_iter().map(|v| v.norm_sqr().sqrt() as f32).collect());
        Powers { cells: &self.cells, magnitudes }
    }

    /// Bound of the amplitude, in each range bin of an end, of a reflector in range bin `own`, over its amplitude there.
    fn side_lobes(&self, own: usize) -> Vec<f64> {
        let bins = self.radar.samples;
        let lobe = |other: usize| {
            let distance = own.abs_diff(other);
            let distance = distance.min(bins - distance);
            // The side lobes of the Hann window, with a margin.
            if distance <= MIN_PEAK_DISTANCE_BINS { f64::INFINITY } else { 4.0 / (distance as f64 - 1.0).powi(3) }
        };
        (0..bins).map(lobe).collect()
    }
}

/// Magnitudes of both ends' beams.
struct Powers<'a> {
    cells: &'a [Vec<u32>; 2],
    magnitudes: [Vec<f32>; 2],
}

impl Powers<'_> {
    /// Power in cell `i`.
    fn of(&self, i: u32) -> f32 {
        let [first, last] = [0, 1].map(|end| self.magnitudes[end][self.cells[end][i as usize] as usize]);
        first * last
    }
}

/// The strongest cell, the first of equal ones.
fn strongest(cells: impl Iterator<Item = (f32, u32)>) -> Option<(f32, u32)> {
    cells.reduce(|a, b| if b.0 > a.0 { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn what_stands_out_is_the_highest_peak() {
        let radar = Radar::default();
        let scene = Scene::of_points([(3.0, 11.0), (-9.0, 20.0)]);
        let flat = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
        let detector = Detector::of(&radar);
        let found = detector.peaks(&flat, 0.0, 2);
        let [first, second] = found[..] else { panic!("{found:?}") };
        assert!((first[0] - 3.0).hypot(first[1] - 11.0) < 0.3, "{first:?}");
        assert!((second[0] + 9.0).hypot(second[1] - 20.0) < 0.5, "{second:?}");
        let powers = detector.powers(&flat);
        let highest = detector.cells().map(|i| f64::from(powers.of(i))).reduce(|| 0.0, f64::max);
        assert_eq!(detector.peaks(&flat, 0.999 * highest, 1), [first]);
        assert!(detector.peaks(&flat, 1.001 * highest, 1).is_empty());
    }
}
