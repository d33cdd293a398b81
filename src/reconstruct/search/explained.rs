//! The residual in each cell of the drawn map, by the ends' maps of the residual.
//!
//! A log map shows weak reflectors too. So the residual is compared with the drawn map in each cell, not with the strongest.

use super::draw::Expected;
use super::finish::Found;
use super::propose::end_beams::{beam_count, beam_noise_power, beam_of_cos, end_beams};
use super::propose::view::View;
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis};
use num_complex::Complex64;
use rayon::prelude::*;

/// Range bins and beams to each side over which powers are averaged.
const MEAN_SIDE_CELLS: usize = 2;

/// Power of a residual, over that of its noise, up to which it counts as noise. White noise, averaged so, exceeds it in one cell of 300 at most.
pub const NOISE_MARGIN: f64 = 3.0;

/// Least power of a residual, over that of the strongest cell, for a finite logarithm.
const MIN_RESIDUAL_RATIO: f64 = 1e-36;

/// Neighbouring columns of the map that share a beam of the ends.
const COLUMNS_PER_LOOKUP: usize = 4;

impl Found {
    /// Power of the residual over the power of the drawn map in each cell, decades, `[range bins, columns]`: the smaller one of the two ends. `ends` are
    /// the searched samples, `expected` is the map of the objects found in them.
    pub fn residual_decades(&self, radar: &Radar, ends: &TwoEnds, expected: &Expected) -> Array2<f32> {
        let samples: Vec<Complex64> = ends.flat().iter().map(|v| v * self.scale).collect();
        let beams = beam_count(radar);
        let powers = |flat: &[Complex64]| end_beams(radar, flat, beams).map(|b| moving_mean(&b.mapv(|v| v.norm_sqr())));
        let (all, residual) = rayon::join(|| powers(&samples), || powers(&self.drawn_residual));
        let noise = NOISE_MARGIN * beam_noise_power(radar, self.noise_variance);
        let drawn = &expected.map.lambda;
        let decades = (2.0 * expected.decades) as f32;
        let cos_of = |column: usize| radar.cos_of_column(column as f64);
        let stronger =
            |best: ((usize, usize), f32), (at, v): ((usize, usize), &f32)| if *v > best.1 { (at, *v) } else { best };
        let (peak_bin, peak_column) = drawn.indexed_iter().fold(((0, 0), f32::NEG_INFINITY), stronger).0;
        let views = End::BOTH.map(|end| View::of(radar, end));
        let cell_of = |view: &View, bin: usize, cos: f64| {
            let (range, cos) = (radar.range_of_bin_metres(bin as f64), cos.clamp(-1.0, 1.0));
            let (range, cos) = view.range_and_cos([range * cos, range * (1.0 - cos * cos).sqrt()], 1e-6);
            [beam_of_cos(cos, beams), radar.bin_of_range(range).round() as usize % radar.samples]
        };
        let peak = [0, 1].map(|end: usize| all[end][cell_of(&views[end], peak_bin, cos_of(peak_column))]);
        let mut over = Array2::zeros((radar.samples, radar.elements));
        over.axis_iter_mut(Axis(0)).into_par_iter().enumerate().for_each(|(bin, mut row)| {
            for first in (0..radar.elements).step_by(COLUMNS_PER_LOOKUP) {
                let cos = cos_of(first + COLUMNS_PER_LOOKUP / 2);
                let of_end = |end: usize| {
                    let residual = (residual[end][cell_of(&views[end], bin, cos)] - noise).max(0.0);
                    residual / peak[end].max(f64::MIN_POSITIVE)
                };
                let ratio =
                    of_end(0).min(of_end(1)).clamp(MIN_RESIDUAL_RATIO, MIN_RESIDUAL_RATIO.recip()).log10() as f32;
                for column in first..(first + COLUMNS_PER_LOOKUP).min(radar.elements) {
                    row[column] = ratio - decades * (drawn[[bin, column]] - 1.0);
                }
            }
        });
        over
    }
}

/// Moving mean over [`MEAN_SIDE_CELLS`], `[beam, range bin]`. Range bins wrap, beams don't.
fn moving_mean(powers: &Array2<f64>) -> Array2<f64> {
    let (beams, bins) = powers.dim();
    let width = (2 * MEAN_SIDE_CELLS + 1) as f64;
    let over_bins = Array2::from_shape_fn((beams, bins), |(beam, bin)| {
        (0..=2 * MEAN_SIDE_CELLS).map(|i| powers[[beam, (bin + bins + i - MEAN_SIDE_CELLS) % bins]]).sum::<f64>()
            / width
    });
    Array2::from_shape_fn((beams, bins), |(beam, bin)| {
        let near = beam.saturating_sub(MEAN_SIDE_CELLS)..=(beam + MEAN_SIDE_CELLS).min(beams - 1);
        let count = near.clone().count() as f64;
        near.map(|b| over_bins[[b, bin]]).sum::<f64>() / count
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::DecibelMilliwatts;
    use crate::reconstruct::Request;
    use crate::reconstruct::search::{Settings, find};
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn noise_seldom_exceeds_its_margin() {
        let radar = Radar::default();
        let floor = Floor::Level(DecibelMilliwatts(-20.0));
        let flat = simulate(&radar, &Scene::default(), floor, 1).unwrap().two_ends(&radar).flat();
        let beams = end_beams(&radar, &flat, beam_count(&radar));
        let level = NOISE_MARGIN * beam_noise_power(&radar, DecibelMilliwatts(-20.0).watts());
        for of_end in beams.map(|b| moving_mean(&b.mapv(|v| v.norm_sqr()))) {
            let above = of_end.iter().filter(|power| **power > level).count() as f64 / of_end.len() as f64;
            assert!(above < 1.0 / 300.0, "{above}");
        }
    }

    #[test]
    fn only_what_was_found_is_explained() {
        let radar = Radar::default();
        let scene = Scene::of_points([(3.0, 11.0), (-9.0, 20.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let mut found = find(&radar, &ends, &Request::default(), &Settings::default()).unwrap();
        let expected = found.expected(&radar, &Request::default());
        let left = found.residual_decades(&radar, &ends, &expected);
        assert!(left.iter().all(|decades| *decades < -1.0), "{left:?}");
        // Without the far reflector in the answer, its own surroundings are unexplained and the near one's are not.
        let far = Scene::of_points([(-9.0, 20.0)]);
        let missing = simulate(&radar, &far, Floor::Exact, 0).unwrap().two_ends(&radar).flat();
        found.drawn_residual.iter_mut().zip(&missing).for_each(|(r, m)| *r += m * found.scale);
        let near = found.atoms.iter().position(|atom| atom.position_metres(0.0)[0] > 0.0).unwrap();
        found.atoms = vec![found.atoms[near]];
        found.reflectivities = vec![found.reflectivities[near]];
        let expected = found.expected(&radar, &Request::default());
        let left = found.residual_decades(&radar, &ends, &expected);
        let cell = |x: f64, y: f64| {
            let at = radar.polar_of(x, y);
            [radar.bin_of_range(at.range_metres) as usize, radar.column_of_cos(at.cos_theta) as usize]
        };
        assert!(left[cell(-9.0, 20.0)] > 0.0 && left[cell(3.0, 11.0)] < -3.0);
    }
}
