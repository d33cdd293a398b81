//! The bounds of a search.

use crate::radar::Radar;

/// Bounds on time and memory, and on the significance of objects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Most atoms of one scene.
    pub max_atoms: usize,
    /// A place must stand this far above the noise of the residual, as a ratio of powers. Noise alone reaches about 7.
    pub min_prominence: f64,
    /// Rounds of refinement once all atoms are there.
    pub rounds: usize,
    /// Price of a gain's energy, over the unexplained part of its neighbourhood: it keeps inexact atoms from large gains that cancel.
    pub gain_price: f64,
    /// Work granted to the search: about ten microseconds a unit, counted and not timed.
    pub max_work: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { max_atoms: 150, min_prominence: 14.0, rounds: 6, gain_price: 0.3, max_work: 40_000 }
    }
}

/// Energy that an echo must explain, over what noise gives to one gain, as a ratio: four numbers an echo at the natural logarithm of the count
/// of samples each, twice the Bayesian criterion, since the best of many thousand places is taken.
pub fn min_echo_energy_ratio(radar: &Radar) -> f64 {
    4.0 * ((2 * radar.end_elements * radar.samples) as f64).ln()
}
