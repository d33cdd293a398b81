//! The noise floor of a map. A map normalised by its minimum shows its floor as much as its peaks, so no function has a default floor.
//!
//! A level in dBm needs a convention for the power of a sample. Without a link budget `|y|^2` counts as watts: a sample `y` of one reflector
//! has amplitude `P_out sigma / R^2` (`P_out` in watts, `R` in metres) and level `10 log10(|y|^2 / 1 mW)`. Sigma 1 at 20 m and 100 W give
//! amplitude 0.25, +18 dBm, which is no power of a receiver. With a link budget ([`crate::radar::budget`]) a level is one at the receiver.

use super::path::{PairBlocks, plain_path};
use super::samples::BeatSignal;
use super::simd::{Kernel, LANES_F64, Lanes, Simd};
use crate::radar::{DecibelMilliwatts, Decibels, Radar};
use crate::scattering::{PathEcho, Sources};
use crate::scene::Reflector;
use ndarray::Array2;
use num_complex::Complex64;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The noise floor of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Floor {
    /// The rounding noise of the thesis' f64 program: the floor of its tables.
    #[default]
    Thesis,
    /// No noise: the formula to the precision of f64.
    Exact,
    /// Thermal noise at this signal-to-noise ratio, measured per sample over the whole array.
    Snr(Decibels),
    /// Thermal noise of this level a sample, for any scene. The [module](self) defines the level of a sample.
    #[serde(rename = "dbm")]
    Level(DecibelMilliwatts),
    /// Receiver noise `k T B F` by the radar's link budget, or [`LinkBudget::default`](crate::radar::LinkBudget) without one.
    Thermal,
}

/// Signal-to-noise ratios that a floor may have, dB.
pub const SNR_RANGE_DECIBELS: std::ops::RangeInclusive<f64> = -100.0..=300.0;
/// Levels that a floor may have, dBm.
pub const LEVEL_RANGE_DBM: std::ops::RangeInclusive<f64> = -300.0..=200.0;

impl Floor {
    /// Variance of the floor's noise where its level does not depend on the scene.
    pub fn level_variance(self, radar: &Radar) -> Option<f64> {
        match self {
            Floor::Level(level) if radar.budget.is_none() => Some(level.watts()),
            Floor::Level(level) => Some(level.watts() / radar.receiver_watts()),
            Floor::Thermal => Some(radar.receiver_noise().watts() / radar.receiver_watts()),
            Floor::Thesis | Floor::Exact | Floor::Snr(_) => None,
        }
    }

    pub fn has_level(self) -> bool {
        matches!(self, Floor::Level(_) | Floor::Thermal)
    }

    /// SNR of a scene over this floor, per sample over the whole array; `None` where the floor is no thermal noise, or nothing reflects.
    pub fn snr<'a>(self, radar: &Radar, sources: impl Into<Sources<'a>>) -> Option<Decibels> {
        let sources = sources.into();
        let reflects = !sources.scatterers.is_empty() || sources.points.iter().any(|r| r.reflectivity != 0.0);
        match self {
            Floor::Thesis | Floor::Exact => None,
            Floor::Snr(snr) => Some(snr).filter(|_| reflects),
            Floor::Level(_) | Floor::Thermal => snr_over(radar, sources, self.level_variance(radar)?),
        }
    }
}

impl FromStr for Floor {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let number = |text: &str, allowed: std::ops::RangeInclusive<f64>| {
            text.parse::<f64>().ok().filter(|number| allowed.contains(number))
        };
        let floor = match (s, s.split_once('=')) {
            ("thesis", _) => Some(Floor::Thesis),
            ("exact", _) => Some(Floor::Exact),
            ("thermal", _) => Some(Floor::Thermal),
            (_, Some(("snr", db))) => number(db, SNR_RANGE_DECIBELS).map(|db| Floor::Snr(Decibels(db))),
            (_, Some(("dbm", level))) => {
                number(level, LEVEL_RANGE_DBM).map(|level| Floor::Level(DecibelMilliwatts(level)))
            }
            _ => None,
        };
        floor.ok_or_else(|| {
            format!(
                "unknown floor \"{s}\"; expected thesis, exact, thermal, snr=DB with DB between -100 and 300, or dbm=LEVEL with LEVEL between -300 and 200"
            )
        })
    }
}

impl fmt::Display for Floor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Floor::Thesis => f.write_str("thesis"),
            Floor::Exact => f.write_str("exact"),
            Floor::Thermal => f.write_str("thermal"),
            Floor::Snr(db) => write!(f, "snr={}", db.0),
            Floor::Level(level) => write!(f, "dbm={}", level.0),
        }
    }
}

/// Variance of white complex noise with the power of the thesis' rounding, for each element: the sum over reflectors of
/// `amplitude^2 * ulp(2 pi |s q| R / lambda)^2 / 12`, since the rounding of a phase is uniform within one ulp.
pub fn thesis_noise_variance<'a>(radar: &Radar, sources: impl Into<Sources<'a>>) -> Vec<f64> {
    powers(radar, sources.into(), THESIS_ROUNDING_FACTOR, Some(thesis_radians_per_metre(radar)))
}

/// Variance of an echo's rounding relative to its power times the squared ulp of its phase.
const THESIS_ROUNDING_FACTOR: f64 = 1.0 / 12.0;

fn thesis_radians_per_metre(radar: &Radar) -> f64 {
    radar.carrier_radians_per_metre().abs()
}

/// Variance of the rounding of an echo of this power at this range, as in [`thesis_noise_variance`].
pub fn thesis_noise_of_echo(radar: &Radar, power: f64, range_metres: f64) -> f64 {
    power * THESIS_ROUNDING_FACTOR * ulp(thesis_radians_per_metre(radar) * range_metres).powi(2)
}

/// Variance of thermal noise at `snr`, the same for every element: the sum of the reflectors' powers, averaged over the array, over the ratio.
pub fn snr_noise_variance<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, snr: Decibels) -> Vec<f64> {
    vec![mean_power(radar, sources.into()) / snr.power_ratio(); radar.elements]
}

/// Signal-to-noise ratio of `reflectors` over noise of `variance` a sample, over the whole array; `None` where nothing reflects.
pub fn snr_over<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, variance: f64) -> Option<Decibels> {
    let ratio = mean_power(radar, sources.into()) / variance;
    (ratio > 0.0).then(|| Decibels(10.0 * ratio.log10()))
}

/// Noise variance of `floor` for each element, if there is any.
pub fn noise_variance<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, floor: Floor) -> Option<Vec<f64>> {
    let sources = sources.into();
    match floor {
        Floor::Exact => None,
        Floor::Thesis => Some(thesis_noise_variance(radar, sources)),
        Floor::Snr(snr) => Some(snr_noise_variance(radar, sources, snr)),
        Floor::Level(_) | Floor::Thermal => Some(vec![floor.level_variance(radar)?; radar.elements]),
    }
}

/// Sum of the reflectors' powers, averaged over the array: `|y|^2` of a sample without interference between echoes.
fn mean_power(radar: &Radar, sources: Sources<'_>) -> f64 {
    let power = powers(radar, sources, 1.0, None);
    power.iter().sum::<f64>() / radar.elements.max(1) as f64
}

/// For each element, the sum over reflectors of `factor * amplitude^2`, times `ulp(radians)^2` where radians per metre are given.
fn powers(radar: &Radar, sources: Sources<'_>, factor: f64, radians_per_metre: Option<f64>) -> Vec<f64> {
    let reflectors = sources.points;
    let mut out = vec![0.0; radar.elements];
    out.par_chunks_mut(LANES_F64).enumerate().for_each(|(block, out)| {
        let first_element = block * LANES_F64;
        let block = Simd::chosen().run(BlockPowers { radar, reflectors, factor, radians_per_metre, first_element });
        out.iter_mut().zip(block.0).for_each(|(out, power)| *out = power);
    });
    if !sources.scatterers.is_empty() {
        out.par_iter_mut().enumerate().for_each_init(Vec::new, |echoes, (n, out)| {
            sources.scattered(radar.pair(n), echoes);
            let power = |echo: &PathEcho| {
                let rounding = radians_per_metre.map_or(1.0, |rate| ulp(rate * echo.range_metres).powi(2));
                echo.amplitude.norm_sqr() * rounding
            };
            *out += factor * echoes.iter().map(power).sum::<f64>();
        });
    }
    out
}

struct BlockPowers<'a> {
    radar: &'a Radar,
    reflectors: &'a [Reflector],
    factor: f64,
    radians_per_metre: Option<f64>,
    first_element: usize,
}

impl Kernel for BlockPowers<'_> {
    type Output = Lanes<f64, LANES_F64>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let pairs = PairBlocks::new(|i| self.radar.pair(self.first_element + i));
        let mut total = Lanes::splat(0.0);
        for r in self.reflectors {
            let [range, mut amplitude] = plain_path(self.radar, &pairs, r);
            if let Some(rate) = self.radians_per_metre {
                amplitude = amplitude * range.map(|range| ulp(rate * range));
            }
            total = total + amplitude * amplitude;
        }
        total * Lanes::splat(self.factor)
    }
}

/// White complex noise of unit variance for one element.
pub fn unit_noise(seed: u64, element: usize) -> impl Iterator<Item = Complex64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(element as u64);
    let scale = std::f64::consts::FRAC_1_SQRT_2;
    std::iter::from_fn(move || {
        let re: f64 = StandardNormal.sample(&mut rng);
        let im: f64 = StandardNormal.sample(&mut rng);
        Some(Complex64::new(re * scale, im * scale))
    })
}

/// Adds white complex noise of the given variance for each element.
pub fn add_noise(signal: &mut BeatSignal, variance: &[f64], seed: u64) {
    add_noise_from(&mut signal.samples, 0, variance, seed);
}

/// Adds white complex noise to `samples`, `[elements, samples]`, of elements `first_element` and following; one variance an element.
pub fn add_noise_from(samples: &mut Array2<Complex64>, first_element: usize, variance: &[f64], seed: u64) {
    samples.outer_iter_mut().into_par_iter().zip(variance).enumerate().for_each(|(n, (mut row, variance))| {
        let deviation = variance.sqrt();
        for (sample, noise) in row.iter_mut().zip(unit_noise(seed, first_element + n)) {
            *sample += noise * deviation;
        }
    });
}

/// Distance from a positive normal `v` to the next f64 above it; 0 for 0.
#[inline(always)]
fn ulp(v: f64) -> f64 {
    const EXPONENT_BITS: u64 = 0x7FF0_0000_0000_0000;
    f64::from_bits(v.to_bits() & EXPONENT_BITS) * f64::EPSILON
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::LinkBudget;

    #[test]
    fn names_round_trip() {
        for name in ["thesis", "exact", "thermal", "snr=20", "snr=-3.5", "dbm=-20", "dbm=17.96"] {
            assert_eq!(name.parse::<Floor>().unwrap().to_string(), name);
        }
        for bad in
            ["", "snr", "snr=", "snr=nan", "snr=1e9", "Thesis", "dbm=-301", "dbm=nan", "dbm", "level=3", "thesis="]
        {
            let told = bad.parse::<Floor>().unwrap_err().to_string();
            assert!(told.contains("between -100 and 300") && told.contains("between -300 and 200"), "{told}");
        }
        assert_eq!((SNR_RANGE_DECIBELS, LEVEL_RANGE_DBM), (-100.0..=300.0, -300.0..=200.0), "as the message says");
    }

    #[test]
    fn a_reflector_at_20_metres_has_a_level_of_18_dbm() {
        let radar = Radar::default();
        let reflectors = [Reflector { x_metres: 0.0, y_metres: 20.0, reflectivity: 1.0 }];
        assert_eq!(radar.transmit_power_watts, 100.0);
        let level = Floor::Level(DecibelMilliwatts(-20.0));
        // The array's outer elements are a little farther away.
        let snr = level.snr(&radar, &reflectors).unwrap().0;
        assert!((snr - 20.0 - 10.0 * (0.0625f64 / 1e-3).log10()).abs() < 0.02, "{snr}");
        assert_eq!(Floor::Snr(Decibels(7.0)).snr(&radar, &reflectors), Some(Decibels(7.0)));
        for floor in [level, Floor::Snr(Decibels(7.0))] {
            assert_eq!(floor.snr(&radar, &[]), None, "{floor}: silence has no ratio");
        }
        assert_eq!(Floor::Thesis.snr(&radar, &reflectors), None);
    }

    #[test]
    fn noise_of_a_level_is_the_same_beneath_every_scene() {
        let radar = Radar::default();
        let floor = Floor::Level(DecibelMilliwatts(-20.0));
        let silence = super::super::simulate(&radar, &crate::scene::Scene::default(), floor, 3).unwrap().samples;
        let power = silence.mapv(|v| v.norm_sqr()).mean().unwrap();
        assert!((power / 1e-5 - 1.0).abs() < 0.01, "{power:e} W, expected -20 dBm");
        let scene = crate::scene::Scene::of_points([(1.0, 20.0)]);
        let heard = super::super::simulate(&radar, &scene, floor, 3).unwrap().samples;
        let echo = super::super::simulate(&radar, &scene, Floor::Exact, 3).unwrap().samples;
        let noise = heard - echo;
        let most = noise.iter().zip(&silence).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(most < 1e-13, "{most:e}");
    }

    #[test]
    fn the_thermal_floor_is_a_level_of_the_receiver() {
        let budget = LinkBudget { noise_figure_db: 15.0, ..Default::default() };
        let radar = Radar { chirp_seconds: 51.2e-6, budget: Some(budget), ..Radar::default() };
        // By hand, in watts: 10 MHz of noise.
        let noise = 1.380_649e-23 * 290.0 * 1e7 * 10f64.powf(1.5);
        let level = Floor::Level(DecibelMilliwatts::of_watts(noise)).level_variance(&radar).unwrap();
        assert!((level / Floor::Thermal.level_variance(&radar).unwrap() - 1.0).abs() < 1e-9);
        let [none, usual] = [None, Some(LinkBudget::default())].map(|budget| Radar { budget, ..Radar::default() });
        assert_eq!(Floor::Thermal.level_variance(&none), Floor::Thermal.level_variance(&usual));
        let told = Some(DecibelMilliwatts(-20.0).watts());
        assert_eq!(Floor::Level(DecibelMilliwatts(-20.0)).level_variance(&none), told);
    }

    #[test]
    fn an_isotropic_budget_changes_no_sample_over_the_thesis_floors() {
        let plain = Radar { elements: 64, samples: 64, ..Radar::default() };
        let budget = Radar { budget: Some(LinkBudget::default()), chirp_seconds: 1e-3, ..plain.clone() };
        let scene = crate::scene::Scene::of_points([(0.4, 2.0), (-1.0, 3.0)]);
        for floor in [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(20.0))] {
            let of = |radar: &Radar| super::super::simulate(radar, &scene, floor, 3).unwrap();
            assert_eq!(of(&plain), of(&budget), "over {floor}");
        }
    }

    #[test]
    fn ulp_is_the_distance_to_the_next_number() {
        for v in [1.0, 1.5, 3.7e4, 0.1, 6.02e23] {
            assert_eq!(ulp(v), v.next_up() - v);
        }
        assert_eq!(ulp(0.0), 0.0);
    }
}
