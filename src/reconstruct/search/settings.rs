//! The limits of a search.

use crate::radar::Radar;

/// Limits of time and memory, and of the significance of objects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest number of atoms.
    pub max_atoms: usize,
    /// Least power of a peak over the noise of the residual. Noise alone reaches about 7.
    pub min_prominence: f64,
    /// Ridge on gains where all energy around them is unexplained ([`Limits::ridge`](crate::reconstruct::fit::Limits)); in proportion where less is.
    pub gain_price: f64,
    /// Budget of work, in units of about ten microseconds, counted and not timed.
    pub max_work: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { max_atoms: 150, min_prominence: 14.0, gain_price: 0.3, max_work: 40_000 }
    }
}

/// Least energy that an echo explains over the mean energy that one gain explains of noise. Each of its four numbers costs the natural logarithm of
/// the number of samples: twice the Bayesian criterion, since the best of many thousand places is chosen.
pub fn min_echo_energy_ratio(radar: &Radar) -> f64 {
    4.0 * ((2 * radar.end_elements * radar.samples) as f64).ln()
}
