//! Ranges and sectors with energy at both ends.

use super::ends::Ends;
use super::sectors::{Sector, Sectors, end_beam_cos};
use crate::radar::Radar;
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::polar::row_ranges_metres;
use crate::reconstruct::profiles::range_response;
use crate::signal::simd::{Kernel, Simd};
use crate::task::Task;
use num_complex::Complex64;
use rayon::prelude::*;

/// Number of searched ranges in each range bin.
const RANGES_PER_BIN: usize = 4;

/// Least power of a place over the noise of a beam.
const MIN_PLACE_OVER_NOISE: f64 = 10.0;

/// Least power of a place over that of the strongest direction at its range. A weaker place may be a side lobe of an end.
const MIN_DIRECTION_PART: f64 = 0.05;

/// Margin of the power of range side lobes over the window's response.
const SIDE_LOBE_MARGIN: f64 = 8.0;

/// Least power of a place over the strongest. Weaker ones may be residuals of it, and are found by a later search.
const MIN_PLACE_PART: f64 = 1e-4;

const MAX_PLACES: usize = 512;

/// A range and a sector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Range of the strongest echo, metres.
    pub range_metres: f64,
    pub sector: Sector,
    /// Power at the weaker end.
    pub power: f64,
}

/// Both ends' beams over one sector, steered relative to its middle.
struct Beams {
    /// Conjugate phases, one beam after another.
    weights: Vec<Vec<Complex64>>,
}

impl Beams {
    /// Beams that cover a sector without a gap.
    fn new(radar: &Radar, ends: &Ends, half_width_cos: f64) -> Self {
        let count = (4.0 * half_width_cos / end_beam_cos(radar)).ceil().max(1.0);
        let step = |i: usize| (2 * i + 1) as f64 * half_width_cos / count - half_width_cos;
        let weights = |i: usize| ends.x_metres.iter().map(|x| ends.profiles.phase(x * step(i))).collect();
        Beams { weights: (0..count as usize).map(weights).collect() }
    }

    /// Power of the strongest beam, each counted at its weaker end.
    fn power(&self, snapshot: &[Complex64], first_count: usize) -> f64 {
        let of = |weights: &Vec<Complex64>| {
            let beam = |part: std::ops::Range<usize>| {
                let count = part.len() as f64;
                let sum: Complex64 = snapshot[part.clone()].iter().zip(&weights[part]).map(|(h, w)| h * w).sum();
                sum.norm_sqr() / (count * count)
            };
            beam(0..first_count).min(beam(first_count..snapshot.len()))
        };
        self.weights.iter().map(of).fold(0.0, f64::max)
    }
}

/// Kernel of the powers of one direction at the weaker end, over range.
struct RangePowers<'a> {
    radar: &'a Radar,
    ends: &'a Ends,
    beams: &'a Beams,
    middle_cos: f64,
}

impl Kernel for RangePowers<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Vec<f64> {
        let mut powers = vec![0.0; ranges(self.radar)];
        let mut snapshot = vec![Complex64::default(); self.ends.len()];
        for (i, power) in powers.iter_mut().enumerate().skip(1) {
            let range = self.radar.range_of_bin_metres(i as f64 / RANGES_PER_BIN as f64);
            self.ends.fill_snapshot::<FMA>(range, self.middle_cos, &mut snapshot);
            *power = self.beams.power(&snapshot, self.ends.first_count);
        }
        powers
    }
}

/// Number of ranges that are searched, from range 0 to a bin beyond the last.
fn ranges(radar: &Radar) -> usize {
    RANGES_PER_BIN * (radar.samples + 1)
}

/// Places above the noise that are no side lobes of others, the strongest first. `noise_power` is that of one element's profile.
pub(super) fn places(
    radar: &Radar,
    ends: &Ends,
    sectors: &Sectors,
    noise_power: f64,
    task: &Task,
) -> Result<Vec<Place>, ReconstructError> {
    if ends.first_count == 0 || ends.first_count == ends.len() {
        return Ok(Vec::new()); // one end alone
    }
    if radar.samples == 1 {
        let range_metres = row_ranges_metres(radar)[0];
        return Ok(sectors.all.iter().map(|sector| Place { range_metres, sector: *sector, power: 1.0 }).collect());
    }
    let range = |i: f64| radar.range_of_bin_metres(i / RANGES_PER_BIN as f64);
    let count = ranges(radar);
    let beams = Beams::new(radar, ends, sectors.all.first().map_or(1.0, |s| s.half_width_cos));
    let powers: Vec<Vec<f64>> = sectors
        .all
        .par_iter()
        .map(|sector| {
            task.check()?;
            Ok(Simd::chosen().run(RangePowers { radar, ends, beams: &beams, middle_cos: sector.middle_cos }))
        })
        .collect::<Result<_, ReconstructError>>()?;
    let strongest: Vec<f64> = (0..count).map(|i| powers.iter().map(|powers| powers[i]).fold(0.0, f64::max)).collect();
    let least = side_lobes(&strongest, RANGES_PER_BIN * radar.samples);
    let noise = MIN_PLACE_OVER_NOISE * noise_power / ends.first_count.min(ends.len() - ends.first_count) as f64;
    let mut found = Vec::new();
    for (sector, powers) in sectors.all.iter().zip(&powers) {
        for i in 1..count.saturating_sub(1) {
            let [before, here, after] = [powers[i - 1], powers[i], powers[i + 1]];
            if here > before && here >= after && here > least[i].max(noise) {
                let offset = vertex(before, here, after);
                found.push(Place { range_metres: range(i as f64 + offset), sector: *sector, power: here });
            }
        }
    }
    found.sort_by(|a, b| b.power.total_cmp(&a.power));
    found.truncate(MAX_PLACES);
    let least = found.first().map_or(0.0, |strongest| MIN_PLACE_PART * strongest.power);
    found.retain(|place| place.power > least);
    Ok(found)
}

/// The power at each range above which a place is no side lobe of the `strongest` powers at all ranges. Ranges wrap after `period`.
fn side_lobes(strongest: &[f64], period: usize) -> Vec<f64> {
    let count = strongest.len();
    let envelope: Vec<f64> = (0..=period / 2)
        .map(|i| {
            let bins = i as f64 / RANGES_PER_BIN as f64;
            // Beyond the main lobe the level is that of the side lobes' peaks, which are at half bins.
            let level = range_response(bins.floor() + 0.5);
            if bins < 2.0 { MIN_DIRECTION_PART } else { (level * level * SIDE_LOBE_MARGIN).min(MIN_DIRECTION_PART) }
        })
        .collect();
    let distance = |i: usize, j: usize| {
        let steps = i.abs_diff(j) % period;
        steps.min(period - steps)
    };
    (0..count)
        .into_par_iter()
        .map(|i| strongest.iter().enumerate().map(|(j, power)| power * envelope[distance(i, j)]).fold(0.0, f64::max))
        .collect()
}

/// Place of the vertex of the parabola through three neighbouring values, the middle one the largest: -1/2 to 1/2.
fn vertex(before: f64, here: f64, after: f64) -> f64 {
    let curvature = before - 2.0 * here + after;
    if curvature < 0.0 { (0.5 * (before - after) / curvature).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::noise_model::ends_noise_variance;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};
    use crate::task::Task;

    #[test]
    fn one_reflector_is_looked_for_near_its_range_alone() {
        let radar = Radar { elements: 128, ..Radar::default() };
        let scene = Scene::of_points([(2.0, 9.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let snapshot = Ends::new(&radar, &ends);
        let sectors = Sectors::new(&radar, &snapshot);
        let noise = ends_noise_variance(&radar, &ends, Floor::Thesis.into()) * 1.5 / radar.samples as f64;
        let found = places(&radar, &snapshot, &sectors, noise, &Task::default()).unwrap();
        let range = 2f64.hypot(9.0);
        assert!(!found.is_empty() && found.len() < 4 * sectors.all.len(), "{} places", found.len());
        for place in &found {
            let bins = radar.bin_of_range((place.range_metres - range).abs());
            assert!(bins < 6.0, "{bins} bins off: {place:?}");
        }
    }
}
