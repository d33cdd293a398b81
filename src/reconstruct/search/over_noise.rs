//! Expectation of a log map's cell over white noise.

use std::f64::consts::{EULER_GAMMA, LN_10};
use std::sync::LazyLock;

/// Largest power of a cell over noise at which the noise changes the mean of the logarithm.
const MAX_NOISY_POWER_RATIO: f64 = 40.0;

/// Largest distance of a cell's amplitude below the noise at which it changes the mean, decades.
const MAX_DEPTH_DECADES: f64 = 3.0;

/// Entries of the table for each decade. Linear interpolation is wrong by at most 1e-6 decades.
const NODES_PER_DECADE: f64 = 1024.0;

/// From [`MAX_DEPTH_DECADES`] below the noise on: increase of a cell's mean, decades, and density of its power near zero over that of noise alone.
static TABLE: LazyLock<Vec<[f32; 2]>> = LazyLock::new(|| {
    let nodes = (NODES_PER_DECADE * (MAX_DEPTH_DECADES + 0.5 * MAX_NOISY_POWER_RATIO.log10())) as usize + 2;
    let node = |i: usize| {
        let decades = i as f64 / NODES_PER_DECADE - MAX_DEPTH_DECADES;
        let ratio = 10f64.powf(2.0 * decades);
        [(0.5 * ln_plus_e1(ratio) / LN_10 - decades) as f32, (-ratio).exp() as f32]
    };
    (0..nodes).map(node).collect()
});

/// White noise in the cells of a map.
#[derive(Debug, Clone, Copy)]
pub struct OverNoise {
    table: &'static [[f32; 2]],
    noise_decades: f32,
}

/// A cell over noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoisyCell {
    /// Mean of the amplitude, decades.
    pub decades: f32,
    /// Density of the power near zero over that of noise alone: the rate at which it is the weakest cell.
    pub zero_density: f32,
}

impl OverNoise {
    /// White noise of the mean power `power` in a cell.
    pub fn new(power: f64) -> Self {
        OverNoise { table: &TABLE, noise_decades: (0.5 * power.log10()) as f32 }
    }

    /// The cell whose amplitude without noise is `decades`.
    #[inline(always)]
    pub fn cell(&self, decades: f32) -> NoisyCell {
        let over = decades - self.noise_decades;
        let at = (over + MAX_DEPTH_DECADES as f32) * NODES_PER_DECADE as f32;
        // A float cast saturates: weaker cells have the first node.
        let node = at as usize;
        let Some(&[[increase, zero_density], [next_increase, next_zero_density]]) =
            self.table.get(node..node + 2).and_then(|n| n.first_chunk())
        else {
            return NoisyCell { decades, zero_density: 0.0 };
        };
        let part = at.fract();
        if at <= 0.0 {
            return NoisyCell { decades: self.noise_decades - MAX_DEPTH_DECADES as f32 + increase, zero_density };
        }
        NoisyCell {
            decades: decades + increase + part * (next_increase - increase),
            zero_density: zero_density + part * (next_zero_density - zero_density),
        }
    }
}

/// `ln x + E1(x)`, E1 the exponential integral: -EULER_GAMMA at 0, ln x far out (Abramowitz and Stegun 5.1.11 and 5.1.22). It is the mean of
/// `ln |Y|^2` for complex Gaussian Y of variance 1 around a mean of power x.
fn ln_plus_e1(x: f64) -> f64 {
    if x < 1.5 {
        let (mut term, mut sum) = (1.0, 0.0);
        for k in 1..24 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        return sum - EULER_GAMMA;
    }
    let mut fraction = 0.0;
    for k in (1..40).rev() {
        let k = f64::from(k);
        fraction = k / (1.0 + k / (x + fraction));
    }
    x.ln() + (-x).exp() / (x + fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_integral_has_its_tabled_values() {
        for (x, e1) in [(0.1, 1.822_923_958), (1.0, 0.219_383_934_4), (2.0, 0.048_900_510_71), (10.0, 4.156_968_93e-6)]
        {
            let found = ln_plus_e1(x) - f64::ln(x);
            assert!((found - e1).abs() < 2e-9, "{x}: {found} {e1}");
        }
        assert!((ln_plus_e1(0.0) + EULER_GAMMA).abs() < 1e-15);
    }

    #[test]
    fn the_table_is_the_mean_logarithm_at_all_levels() {
        let noise = 3e-7;
        for ratio in [0.0, 1e-9, 0.003, 0.7, 5.01, 39.9, 40.1, 1e6] {
            let decades = 0.5 * f64::max(ratio * noise, 1e-40).log10();
            let found = OverNoise::new(noise).cell(decades as f32);
            let mean = if ratio < 600.0 { ln_plus_e1(ratio) } else { ratio.ln() };
            let expected = 0.5 * (noise.log10() + mean / LN_10);
            assert!((f64::from(found.decades) - expected).abs() < 1e-5, "{ratio}: {found:?} {expected}");
            assert!((f64::from(found.zero_density) - (-ratio).exp()).abs() < 1e-5, "{ratio}: {found:?}");
        }
    }
}
