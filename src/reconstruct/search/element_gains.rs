//! Complex gains of the ends' elements.

use crate::radar::Radar;
use crate::reconstruct::attempt::Proposal;
use crate::signal::TwoEnds;
use num_complex::Complex64;

/// Complex gains of the elements, `[2 * end elements]`, those of the first end first.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementGains(pub(super) Vec<Complex64>);

impl ElementGains {
    /// Gains of equal elements.
    pub fn ones(radar: &Radar) -> Self {
        ElementGains(vec![Complex64::ONE; 2 * radar.end_elements])
    }

    /// The samples of equal elements: `ends` divided by the gains.
    pub fn taken_from(&self, ends: &TwoEnds) -> TwoEnds {
        let mut corrected = ends.clone();
        let channels = corrected.first.outer_iter_mut().chain(corrected.last.outer_iter_mut());
        for (mut channel, gain) in channels.zip(&self.0) {
            let inverse = gain.inv();
            channel.mapv_inplace(|v| v * inverse);
        }
        corrected
    }

    /// Root of the mean square of the differences from 1.
    pub fn deviation(&self) -> f64 {
        (self.0.iter().map(|g| (g - 1.0).norm_sqr()).sum::<f64>() / self.0.len() as f64).sqrt()
    }

    /// The gains for the record of attempts.
    pub fn tried(&self) -> Proposal {
        let rms = |of: fn(&Complex64) -> f64| {
            (self.0.iter().map(|g| of(g).powi(2)).sum::<f64>() / self.0.len() as f64).sqrt()
        };
        Proposal::Gains { decibels: rms(|g| 20.0 * g.norm().log10()), degrees: rms(|g| g.arg().to_degrees()) }
    }

    /// The gains with a geometric mean of 1 and, if `without_slope`, without the offset and the slope of phase along each end.
    pub fn normalised(mut self, without_slope: bool) -> Self {
        let mean_log = self.0.iter().map(|g| g.norm().ln()).sum::<f64>() / self.0.len() as f64;
        let common = Complex64::from_polar(mean_log.exp(), self.0.iter().sum::<Complex64>().arg());
        self.0.iter_mut().for_each(|g| *g /= common);
        if without_slope {
            let half = self.0.len() / 2;
            self.0.chunks_mut(half).for_each(subtract_phase_line);
        }
        self
    }
}

/// Subtracts the regression line of the phases along an end.
fn subtract_phase_line(gains: &mut [Complex64]) {
    let n = gains.len() as f64;
    let middle = (n - 1.0) / 2.0;
    let offset = gains.iter().map(|g| g.arg()).sum::<f64>() / n;
    let [along, square] = gains.iter().enumerate().fold([0.0; 2], |[along, square], (i, g)| {
        let at = i as f64 - middle;
        [along + at * g.arg(), square + at * at]
    });
    let slope = if square > 0.0 { along / square } else { 0.0 };
    for (i, g) in gains.iter_mut().enumerate() {
        *g *= Complex64::cis(-(offset + slope * (i as f64 - middle)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_and_a_slope_of_phase_are_a_place() {
        let mut end: Vec<Complex64> = (0..12).map(|i| Complex64::cis(0.1 + 0.02 * f64::from(i))).collect();
        subtract_phase_line(&mut end);
        assert!(end.iter().all(|g| (g - 1.0).norm() < 1e-12), "{end:?}");
    }
}
