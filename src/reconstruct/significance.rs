//! The absolute test of every threshold: a level that noise alone reaches is no detection.
//!
//! A threshold at a fixed distance below the map's peak alarms on noise, whose peak is noise too. So every answer is compared with the noise
//! that is measured in the samples, in two ways, and both only raise the threshold:
//!
//! * Of the samples: where no cell of either end's own range-angle map exceeds the level that the largest of so many cells of white noise
//!   exceeds with probability [`FALSE_ALARM_PROBABILITY`], they hold noise alone, and the answer's threshold is 1, which no cell exceeds. This is independent of
//!   the method: it holds for pseudo-spectra and networks as for maps of power.
//! * Of the map: a method that knows the level of noise in its map gives it ([`Reconstruction::least_eta`]), and no threshold lies lower.

use super::answer::Reconstruction;
use crate::maps::{LambdaScale, channels_range_transform};
use crate::radar::{End, Radar};
use crate::signal::TwoEnds;
use crate::signal::simd::Simd;
use num_complex::Complex64;

/// Probability that a map of noise alone has a cell above the level.
const FALSE_ALARM_PROBABILITY: f64 = 1e-6;

/// Threshold that no cell exceeds.
pub(super) const UNREACHABLE_ETA: f32 = 1.0;

/// Ratio of the strongest of `cells` noise cells to their mean, exceeded with probability [`FALSE_ALARM_PROBABILITY`]: powers of complex normal noise are exponential.
fn times_the_mean(cells: usize) -> f64 {
    (cells.max(1) as f64 / FALSE_ALARM_PROBABILITY).ln()
}

/// Mean square of a noise cell of the whole array's map for noise of variance 1 a sample.
pub(super) fn cell_noise(radar: &Radar) -> f64 {
    let mean = |n: usize| radar.window.weights(n).iter().map(|w| w * w).sum::<f64>() / n as f64;
    mean(radar.samples) * mean(radar.elements)
}

/// Decades of amplitude that a cell of the whole array's map of noise of this variance a sample exceeds with probability [`FALSE_ALARM_PROBABILITY`] only.
fn noise_decades(radar: &Radar, noise_variance: f64) -> f64 {
    decades_above_cells(noise_variance * cell_noise(radar), radar.samples * radar.elements)
}

/// Decades of amplitude that a map exceeds with probability [`FALSE_ALARM_PROBABILITY`] only, whose noise cells have this mean power.
pub(super) fn decades_above_cells(cell_noise: f64, cells: usize) -> f64 {
    0.5 * (cell_noise * times_the_mean(cells)).max(f64::MIN_POSITIVE).log10()
}

/// Decades from the mean of the logarithm of `cells` noise cells to the level that one of them exceeds with probability [`FALSE_ALARM_PROBABILITY`] only. The
/// mean of log10 |n| lies 0.125 decades below the root mean square of complex normal n.
#[cfg(feature = "live")]
pub(crate) fn level_above_mean_decades(cells: usize) -> f64 {
    decades_above_cells(1.0, cells) + 0.125
}

/// [`Reconstruction::least_eta`] of a map of the whole array with this scale over noise of this variance a sample.
pub(crate) fn least_eta(radar: &Radar, noise_variance: f64, scale: LambdaScale) -> f32 {
    scale.lambda(noise_decades(radar, noise_variance)) as f32
}

fn holds_echo(radar: &Radar, ends: &TwoEnds, noise_variance: f64) -> bool {
    // Twice as many columns as elements: between two columns an echo loses little.
    let columns = 2 * radar.end_elements.next_power_of_two();
    let least = times_the_mean(2 * radar.samples * columns);
    let fft = Simd::chosen().forward_fft(columns);
    let window = radar.window.weights(radar.end_elements);
    let mean_square = |weights: &[f64]| weights.iter().map(|w| w * w).sum::<f64>() / weights.len().max(1) as f64;
    let profile_variance = noise_variance * mean_square(&radar.window.weights(radar.samples));
    let mut row = vec![Complex64::default(); columns];
    let mut scratch = vec![Complex64::default(); fft.get_inplace_scratch_len()];
    for end in End::BOTH {
        let channels = ends.end(end);
        // Elements without samples add no noise.
        let heard = channels.outer_iter().map(|c| c.iter().any(|v| v.norm_sqr() > 0.0));
        let gain: f64 = heard.zip(&window).filter(|(heard, _)| *heard).map(|(_, w)| w * w).sum();
        let level = least * gain * profile_variance;
        for snapshot in channels_range_transform(radar, channels.view()).profiles.columns() {
            row.fill(Complex64::default());
            row.iter_mut().zip(snapshot.iter().zip(&window)).for_each(|(v, (p, w))| *v = p * w);
            fft.process_with_scratch(&mut row, &mut scratch);
            if row.iter().any(|v| v.norm_sqr() > level) {
                return true;
            }
        }
    }
    false
}

/// `found` in `ends` with a threshold raised above the noise; `own_eta` is the method's own. A flat answer without reflectors has no detection,
/// also where the samples hold more than noise: no threshold separates its cells.
pub(super) fn tested(
    radar: &Radar,
    ends: &TwoEnds,
    noise_variance: f64,
    own_eta: f32,
    mut found: Reconstruction,
) -> Reconstruction {
    let found_nothing = found.reflectors.is_empty() && is_flat(&found);
    if found_nothing || !holds_echo(radar, ends, noise_variance) {
        found.eta = Some(UNREACHABLE_ETA);
        return found;
    }
    let eta = found.eta.unwrap_or(own_eta);
    if let Some(least) = found.least_eta.filter(|least| *least > eta) {
        found.eta = Some(least);
    }
    found
}

fn is_flat(found: &Reconstruction) -> bool {
    let mut cells = found.lambda.lambda.iter();
    let first = cells.next();
    cells.all(|cell| Some(cell) == first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{DecibelMilliwatts, Decibels};
    use crate::reconstruct::noise_model::ends_noise_variance;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    fn holds(radar: &Radar, scene: &Scene, floor: Floor, seed: u64) -> bool {
        let ends = simulate(radar, scene, floor, seed).unwrap().two_ends(radar);
        holds_echo(radar, &ends, ends_noise_variance(radar, &ends, floor.into()))
    }

    #[test]
    fn noise_alone_holds_no_echo() {
        let radar = Radar::default();
        let small = Radar { elements: 64, samples: 128, end_elements: 4, ..Radar::default() };
        for seed in 0..40 {
            for (radar, dbm) in [(&radar, -20.0), (&small, 50.0)] {
                let floor = Floor::Level(DecibelMilliwatts(dbm));
                assert!(!holds(radar, &Scene::default(), floor, seed), "{floor}, seed {seed}");
            }
        }
    }

    #[test]
    fn an_echo_is_held_down_to_15_decibels_beneath_the_noise() {
        let radar = Radar::default();
        for seed in 0..20 {
            let angle = 0.3 + 0.12 * seed as f64;
            let range = 5.0 + 1.5 * seed as f64;
            let scene = Scene::of_points([(range * angle.cos(), range * angle.sin())]);
            for floor in [Floor::Snr(Decibels(-15.0)), Floor::Snr(Decibels(40.0)), Floor::Thesis, Floor::Exact] {
                assert!(holds(&radar, &scene, floor, seed), "{floor}, seed {seed}");
            }
        }
    }

    #[test]
    fn the_strongest_of_all_noise_cells_lies_under_the_level() {
        let radar = Radar::default();
        let floor = Floor::Level(DecibelMilliwatts(-20.0));
        for seed in 0..4 {
            let signal = simulate(&radar, &Scene::default(), floor, seed).unwrap();
            let strongest = crate::maps::LogMaps::of_signal(&radar, &signal).full.max();
            let level = noise_decades(&radar, DecibelMilliwatts(-20.0).watts());
            assert!((level - 0.25..level).contains(&strongest), "{strongest} of {level} decades");
        }
    }
}
