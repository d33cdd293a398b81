//! Radars of training scenes: the same for all, or a random one for each.

use super::grid::{COLUMNS, END_ELEMENTS, ROWS};
use crate::network::domain::{Domain, RadarLimits, migration_bins};
use crate::radar::{Convention, LinkBudget, Radar, WindowFunction};
use crate::scene::generate::Purpose;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The radars of the scenes.
#[derive(Debug, Clone, PartialEq)]
pub enum Radars {
    /// The same radar for all scenes.
    Fixed(Box<Radar>),
    /// A random radar for each scene, within [`DRAWN_LIMITS`].
    Random,
}

/// Radars that the live network can be trained for.
pub const DRAWN_LIMITS: RadarLimits = RadarLimits {
    elements: COLUMNS,
    end_elements: END_ELEMENTS,
    samples: ROWS,
    carrier_hz: [20e9, 100e9],
    bandwidth_hz: [0.1e9, 6e9],
    max_relative_bandwidth: 0.08,
    max_migration_bins: 64.0,
    relative_spacing: [0.8, 1.2],
    half_power_width_degrees: [40.0, 150.0],
    windows: Vec::new(),
};

/// Part of the random radars that are that of table 3.1.
const THESIS_SHARE: f64 = 0.25;
/// Parts of the other random radars with the spacing of a filled array, with a Hann window, and with an element's pattern.
const FILLED_SHARE: f64 = 0.5;
const HANN_SHARE: f64 = 0.5;
const PATTERN_SHARE: f64 = 0.2;
/// Part of the other random radars with uniform migration. Of the rest, with bandwidths uniform in the logarithm, 4 % migrate over more than 40 bins.
const UNIFORM_MIGRATION_SHARE: f64 = 0.5;

impl Default for Radars {
    fn default() -> Self {
        Radars::Fixed(Box::default())
    }
}

impl Radars {
    /// The radar of scene `index`: a function of `seed`, `purpose` and `index` alone.
    pub fn of(&self, seed: u64, purpose: Purpose, index: u32) -> Radar {
        if let Radars::Fixed(radar) = self {
            return (**radar).clone();
        }
        let mut key = [0u8; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        // No stream of generated scenes or of kinds has the number 5.
        key[8..10].copy_from_slice(&[5, purpose.number()]);
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(index.into());
        if rng.random::<f64>() < THESIS_SHARE { Radar::default() } else { random_radar(&mut rng) }
    }

    /// The domain of a network that is trained on these.
    pub fn domain(&self) -> Domain {
        match self {
            Radars::Fixed(radar) => Domain::Radar(radar.clone()),
            Radars::Random => Domain::Limits(DRAWN_LIMITS),
        }
    }

    /// A radar with the numbers of elements and samples of all of them.
    pub fn shape(&self) -> Radar {
        match self {
            Radars::Fixed(radar) => (**radar).clone(),
            Radars::Random => Radar::default(),
        }
    }

    /// Smallest of the radars' maximum ranges, metres.
    pub fn smallest_max_range_metres(&self) -> f64 {
        match self {
            Radars::Fixed(radar) => radar.max_range_metres(),
            Radars::Random => {
                let [_, bandwidth_hz] = DRAWN_LIMITS.bandwidth_hz;
                Radar { bandwidth_hz, samples: DRAWN_LIMITS.samples, ..Radar::default() }.max_range_metres()
            }
        }
    }
}

fn random_radar(rng: &mut ChaCha8Rng) -> Radar {
    loop {
        let carrier_hz = log_uniform(DRAWN_LIMITS.carrier_hz, rng);
        let [min, max] = DRAWN_LIMITS.bandwidth_hz;
        let bandwidth_hz = log_uniform([min, max.min(DRAWN_LIMITS.max_relative_bandwidth * carrier_hz)], rng);
        let convention = Convention::ALL[rng.random_range(0..2)];
        let [min, max] = DRAWN_LIMITS.relative_spacing;
        let spacing = if rng.random::<f64>() < FILLED_SHARE { 1.0 } else { rng.random_range(min..max) };
        let window = match rng.random::<f64>() < HANN_SHARE {
            true => WindowFunction::Hann,
            false => WindowFunction::ALL[rng.random_range(1..WindowFunction::ALL.len())],
        };
        let [min, max] = DRAWN_LIMITS.half_power_width_degrees;
        let budget = (rng.random::<f64>() < PATTERN_SHARE).then(|| LinkBudget {
            half_power_width_degrees: Some(rng.random_range(min..max)),
            ..LinkBudget::default()
        });
        let radar_of = |bandwidth_hz: f64| {
            let filled =
                Radar { carrier_hz, bandwidth_hz, window, budget, ..Radar::default() }.in_convention(convention);
            Radar { element_spacing_metres: spacing * filled.element_spacing_metres, ..filled }
        };
        let mut radar = radar_of(bandwidth_hz);
        if rng.random::<f64>() < UNIFORM_MIGRATION_SHARE {
            let bins = rng.random_range(0.0..DRAWN_LIMITS.max_migration_bins);
            radar = radar_of(bins / migration_bins(&radar) * bandwidth_hz);
        }
        if Domain::Limits(DRAWN_LIMITS).holds(&radar) {
            return radar;
        }
    }
}

fn log_uniform([min, max]: [f64; 2], rng: &mut ChaCha8Rng) -> f64 {
    min * (max / min).powf(rng.random())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::generate::{Generator, Kind, Reading};

    #[test]
    fn random_radars_cover_their_limits() {
        let radars: Vec<Radar> = (0..2000).map(|i| Radars::Random.of(3, Purpose::Training, i)).collect();
        for radar in &radars {
            radar.validate().unwrap();
            assert!(Domain::Limits(DRAWN_LIMITS).holds(radar), "{radar:?}");
        }
        let share = |is: &dyn Fn(&Radar) -> bool| radars.iter().filter(|r| is(r)).count() as f64 / radars.len() as f64;
        assert!((0.2..0.3).contains(&share(&|r| *r == Radar::default())));
        for (name, part) in [
            ("20 to 30 GHz", share(&|r| r.carrier_hz < 30e9)),
            ("80 to 100 GHz", share(&|r| r.carrier_hz > 80e9)),
            ("less than 200 MHz", share(&|r| r.bandwidth_hz < 2e8)),
            ("more than 3 GHz", share(&|r| r.bandwidth_hz > 3e9)),
            ("the physical convention", share(&|r| r.convention() == Convention::Physical)),
            ("a migration of more than 48 bins", share(&|r| migration_bins(r) > 48.0)),
            ("a pattern", share(&|r| r.pattern().is_some())),
            ("a rectangular window", share(&|r| r.window == WindowFunction::Rectangular)),
            ("wide spacing", share(&|r| r.element_spacing_metres > 1.15 * r.filled_spacing_metres())),
        ] {
            assert!((0.02..0.5).contains(&part), "{name}: {part}");
        }
        let min = radars.iter().map(Radar::max_range_metres).fold(f64::INFINITY, f64::min);
        let least = Radars::Random.smallest_max_range_metres();
        assert!((least..2.0 * least).contains(&min), "{min}");
    }

    #[test]
    fn every_drawn_radar_sees_a_world() {
        for number in 0..200 {
            let radar = Radars::Random.of(3, Purpose::Training, number);
            let scene = Generator::new(&radar, Reading::Program, Purpose::Training, 3).scene(Kind::World, number);
            scene.validate(&radar).unwrap_or_else(|e| panic!("{number}: {e}"));
        }
    }

    #[test]
    fn a_radar_follows_from_seed_purpose_and_number() {
        let of = |seed, purpose| (0..8).map(|i| Radars::Random.of(seed, purpose, i)).collect::<Vec<_>>();
        assert_eq!(of(1, Purpose::Training), of(1, Purpose::Training));
        assert_ne!(of(1, Purpose::Training), of(2, Purpose::Training));
        assert_ne!(of(1, Purpose::Training), of(1, Purpose::Validation));
    }

    #[test]
    fn values_outside_of_limits_are_named() {
        let random_radar = Domain::Limits(DRAWN_LIMITS);
        let of = |carrier_hz: f64, bandwidth_hz: f64, convention| {
            Radar { carrier_hz, bandwidth_hz, ..Radar::default() }.in_convention(convention)
        };
        for radar in [
            Radar::default(),
            of(76e9, 1e9, Convention::Thesis),
            of(24e9, 250e6, Convention::Thesis),
            of(77e9, 4e9, Convention::Physical),
        ] {
            assert_eq!(random_radar.check("live", &radar), Ok(()));
        }
        let told = |radar: Radar| random_radar.check("live", &radar).unwrap_err().to_string();
        let low = told(of(10e9, 1.5e9, Convention::Thesis));
        assert!(low.contains("trained for 20 to 100 GHz of carrier, at most 8 % of the carrier as bandwidth"), "{low}");
        assert!(low.contains("this radar has 10.0000 GHz of carrier, 15.0000 % of the carrier"), "{low}");
        let wide = told(Radar { element_spacing_metres: 4e-3, bandwidth_hz: 4e9, ..Radar::default() });
        assert!(wide.contains("at most 64 range bins from end to end, 0.8 to 1.2 of the filled spacing"), "{wide}");
        let short = told(Radar { samples: 256, ..Radar::default() });
        assert!(short.contains("for 512 samples; this radar has 256 samples"), "{short}");
    }
}
