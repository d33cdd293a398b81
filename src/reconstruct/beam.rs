//! The beam of both ends together, between the columns of a map.

use crate::maps::channels_range_transform;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis, concatenate};
use num_complex::Complex64;
use std::f64::consts::TAU;

const STEPS: i32 = 48;

pub(super) struct Beam<'a> {
    radar: &'a Radar,
    elements: Vec<usize>,
    profiles: Array2<Complex64>,
}

impl<'a> Beam<'a> {
    pub fn new(radar: &'a Radar, ends: &TwoEnds) -> Self {
        let elements = End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).collect();
        let rows = concatenate(Axis(0), &[ends.first.view(), ends.last.view()]).unwrap_or_else(|_| ends.first.clone());
        Beam { radar, elements, profiles: channels_range_transform(radar, rows.view()).profiles }
    }

    /// The cosine within `within` of `about` from which the power at this range is largest, all elements added in phase; and that power.
    pub fn strongest_near(&self, range_metres: f64, about: f64, within: f64) -> (f64, f64) {
        let bin = self.radar.bin_of_range(range_metres).round().rem_euclid(self.radar.samples as f64) as usize;
        let cosine = |step: i32| (about + within * f64::from(step) / f64::from(STEPS)).clamp(-1.0, 1.0);
        let power = |step: i32| self.power(bin, range_metres, cosine(step));
        // The nearest of equal cosines: silence keeps `about`.
        let (step, power) = (1..=STEPS).flat_map(|n| [n, -n]).fold((0, power(0)), |best, step| {
            let found = power(step);
            if found > best.1 { (step, found) } else { best }
        });
        (cosine(step), power)
    }

    fn power(&self, bin: usize, range_metres: f64, cosine: f64) -> f64 {
        let (x, y) = (range_metres * cosine, range_metres * (1.0 - cosine * cosine).max(0.0).sqrt());
        let turns = self.radar.middle_turns_per_metre();
        let heard = self.elements.iter().zip(self.profiles.outer_iter()).map(|(element, profile)| {
            let ways = self.radar.pair(*element).places_metres().map(|[px, py]| (x - px).hypot(y - py));
            let longer = (ways[0] + ways[1]) / 2.0 - range_metres;
            profile.get(bin).copied().unwrap_or_default() * Complex64::from_polar(1.0, -TAU * turns * longer)
        });
        heard.sum::<Complex64>().norm_sqr()
    }
}
