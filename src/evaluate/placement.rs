//! Position error of the Newton search on one reflector, compared with the Cramer-Rao bound.

use crate::bounds::{cramer_rao, noise_variance};
use crate::radar::{Decibels, End, Layout, Radar};
use crate::reconstruct::search::{Settings, find};
use crate::reconstruct::{NoisePrior, ReconstructError, Request};
use crate::scene::Reflector;
use crate::signal::exact;
use crate::signal::floor::add_noise_from;
use crate::task::Task;

/// Position errors of one reflector over independent draws of thermal noise.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Placement {
    /// Signal-to-noise ratio a sample, dB, averaged over the samples of both ends.
    pub snr_db: f64,
    /// Cramer-Rao bound on the root of the mean squared distance from the reflector, metres.
    pub bound_metres: f64,
    /// Root of the mean squared distance found, metres; over the draws that found one object. NaN where none did.
    pub error_metres: f64,
    /// The same without the draws in [`Placement::off_by_a_tooth`].
    pub near_error_metres: f64,
    /// Draws of noise.
    pub trials: u64,
    /// Draws in which not exactly one object was found.
    pub miscounted: u64,
    /// Draws that placed the reflector on another tooth of the comb of ambiguities: more than ten bounds away.
    pub off_by_a_tooth: u64,
}

impl Placement {
    /// Error over bound.
    pub fn ratio(&self) -> f64 {
        self.error_metres / self.bound_metres
    }
}

/// Places `reflector` from the two ends in `trials` draws of thermal noise of `snr`.
/// # Errors
/// [`ReconstructError::Unusable`] where the reflector has no bound (it lies on the array's axis, or has no echo);
/// [`ReconstructError::Cancelled`] through `task`.
pub fn placement(
    radar: &Radar,
    reflector: Reflector,
    snr: Decibels,
    trials: u64,
    task: &Task,
) -> Result<Placement, ReconstructError> {
    let layout = Layout::two_ends(radar);
    let variance = noise_variance(radar, &layout, &reflector, snr);
    let bounds = cramer_rao(radar, &layout, &[reflector], variance)
        .map_err(|e| ReconstructError::Unusable { method: "nomp", reason: e.to_string() })?;
    let bound_metres = bounds[0].position_metres();
    let clean = exact::beat_signal(radar, &[reflector]).two_ends(radar);
    let request = Request { noise: NoisePrior::UNKNOWN, task: task.clone(), ..Request::default() };
    let mut squares = Vec::new();
    for trial in 0..trials {
        let (mut noisy, seed) = (clean.clone(), noise_seed(snr, trial));
        for (end, samples) in [(End::First, &mut noisy.first), (End::Last, &mut noisy.last)] {
            add_noise_from(samples, radar.end_range(end).start, &vec![variance; radar.elements], seed);
        }
        let found = find(radar, &noisy, &request, &Settings::default())?;
        if let [atom] = found.atoms[..] {
            let [x, y] = atom.position_metres(0.0);
            squares.push((x - reflector.x_metres).powi(2) + (y - reflector.y_metres.abs()).powi(2));
        }
    }
    let near: Vec<f64> = squares.iter().copied().filter(|s| *s < (10.0 * bound_metres).powi(2)).collect();
    let root_mean = |squares: &[f64]| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    Ok(Placement {
        snr_db: snr.0,
        bound_metres,
        error_metres: root_mean(&squares),
        near_error_metres: root_mean(&near),
        trials,
        miscounted: trials - squares.len() as u64,
        off_by_a_tooth: (squares.len() - near.len()) as u64,
    })
}

/// Seed of a draw of noise. Another at every ratio, so that the errors at two ratios are independent.
fn noise_seed(snr: Decibels, trial: u64) -> u64 {
    // Thousandths of a decibel from below: no two ratios of a table meet.
    let step = (1e3 * (snr.0 + 1e6)).round() as u64;
    (step << 24).wrapping_add(trial)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(snr: f64, trials: u64) -> Placement {
        let reflector = Reflector { x_metres: 5.0, y_metres: 18.0, reflectivity: 1.0 };
        placement(&Radar::default(), reflector, Decibels(snr), trials, &Task::default()).unwrap()
    }

    #[test]
    fn one_reflector_is_placed_as_well_as_the_bound_allows() {
        // Both coordinates of 2 x 40 draws: the root mean square is known to 6 %.
        let squares = [20.0, 40.0].map(|snr| {
            let p = placed(snr, 40);
            assert!(p.miscounted == 0 && p.off_by_a_tooth == 0, "{p:?}");
            p.ratio().powi(2)
        });
        let ratio = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        assert!((0.82..1.18).contains(&ratio), "error / bound is {ratio}");
        assert_ne!(squares[0], squares[1], "the draws at two ratios are independent");
    }

    #[test]
    fn no_two_draws_of_noise_are_the_same() {
        let seeds = [-15.0, 0.0, 0.5, 20.0].map(|snr| [0, 1, 199].map(|trial| noise_seed(Decibels(snr), trial)));
        let all: std::collections::BTreeSet<u64> = seeds.into_iter().flatten().collect();
        assert_eq!(all.len(), 12);
    }
}
