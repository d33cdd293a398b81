//! Radars of training scenes: one, or one drawn for each scene.

use super::grid::{COLUMNS, ELEMENTS, ROWS};
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
    /// A radar drawn for each scene within [`DRAWN_LIMITS`].
    Random,
}

/// Radars that the live network can be trained for.
pub const DRAWN_LIMITS: RadarLimits = RadarLimits {
    elements: COLUMNS,
    end_elements: ELEMENTS,
    samples: ROWS,
    carrier_hz: [20e9, 100e9],
    bandwidth_hz: [0.1e9, 6e9],
    max_relative_bandwidth: 0.08,
    max_migration_bins: 64.0,
    relative_spacing: [0.8, 1.2],
    half_power_width_degrees: [40.0, 150.0],
    windows: Vec::new(),
};

const THESIS_SHARE: f64 = 0.25;
/// Parts of the drawn radars that have the filled spacing, a window of Hann, and a pattern.
const FILLED_SHARE: f64 = 0.5;
const HANN_SHARE: f64 = 0.5;
const PATTERN_SHARE: f64 = 0.2;
/// Part of the drawn radars whose migration is uniform between none and the most; the bandwidth of the others is uniform on a logarithmic scale,
/// and 4 % of them migrate over more than 40 range bins.
const EVEN_MIGRATION_SHARE: f64 = 0.5;

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
        if rng.random::<f64>() < THESIS_SHARE { Radar::default() } else { drawn(&mut rng) }
    }

    /// The radars for which a network is trained by these.
    pub fn domain(&self) -> Domain {
        match self {
            Radars::Fixed(radar) => Domain::Radar(radar.clone()),
            Radars::Random => Domain::Limits(DRAWN_LIMITS),
        }
    }

    /// A radar with the number of elements and samples that all of them have.
    pub fn shape(&self) -> Radar {
        match self {
            Radars::Fixed(radar) => (**radar).clone(),
            Radars::Random => Radar::default(),
        }
    }

    /// Least maximum range of the radars, metres.
    pub fn least_max_range_metres(&self) -> f64 {
        match self {
            Radars::Fixed(radar) => radar.max_range_metres(),
            Radars::Random => {
                let [_, bandwidth_hz] = DRAWN_LIMITS.bandwidth_hz;
                Radar { bandwidth_hz, samples: DRAWN_LIMITS.samples, ..Radar::default() }.max_range_metres()
            }
        }
    }
}

fn drawn(rng: &mut ChaCha8Rng) -> Radar {
    loop {
        let carrier_hz = log_uniform(DRAWN_LIMITS.carrier_hz, rng);
        let [least, most] = DRAWN_LIMITS.bandwidth_hz;
        let bandwidth_hz = log_uniform([least, most.min(DRAWN_LIMITS.max_relative_bandwidth * carrier_hz)], rng);
        let convention = Convention::ALL[rng.random_range(0..2)];
        let [least, most] = DRAWN_LIMITS.relative_spacing;
        let spacing = if rng.random::<f64>() < FILLED_SHARE { 1.0 } else { rng.random_range(least..most) };
        let window = match rng.random::<f64>() < HANN_SHARE {
            true => WindowFunction::Hann,
            false => WindowFunction::ALL[rng.random_range(1..WindowFunction::ALL.len())],
        };
        let [least, most] = DRAWN_LIMITS.half_power_width_degrees;
        let budget = (rng.random::<f64>() < PATTERN_SHARE).then(|| LinkBudget {
            half_power_width_degrees: Some(rng.random_range(least..most)),
            ..LinkBudget::default()
        });
        let radar_of = |bandwidth_hz: f64| {
            let filled =
                Radar { carrier_hz, bandwidth_hz, window, budget, ..Radar::default() }.in_convention(convention);
            Radar { element_spacing_metres: spacing * filled.element_spacing_metres, ..filled }
        };
        let mut radar = radar_of(bandwidth_hz);
        if rng.random::<f64>() < EVEN_MIGRATION_SHARE {
            let bins = rng.random_range(0.0..DRAWN_LIMITS.max_migration_bins);
            radar = radar_of(bins / migration_bins(&radar) * bandwidth_hz);
        }
        if Domain::Limits(DRAWN_LIMITS).holds(&radar) {
            return radar;
        }
    }
}

fn log_uniform([least, most]: [f64; 2], rng: &mut ChaCha8Rng) -> f64 {
    least * (most / least).powf(rng.random())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::generate::{Generator, Kind, Reading};

    #[test]
    fn drawn_radars_lie_within_their_limits_and_cover_them() {
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
        let least = radars.iter().map(Radar::max_range_metres).fold(f64::INFINITY, f64::min);
        assert!(
            least >= Radars::Random.least_max_range_metres() && least < 2.0 * Radars::Random.least_max_range_metres()
        );
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
    fn what_lies_outside_of_limits_is_named() {
        let drawn = Domain::Limits(DRAWN_LIMITS);
        let of = |carrier_hz: f64, bandwidth_hz: f64, convention| {
            Radar { carrier_hz, bandwidth_hz, ..Radar::default() }.in_convention(convention)
        };
        for radar in [
            Radar::default(),
            of(76e9, 1e9, Convention::Thesis),
            of(24e9, 250e6, Convention::Thesis),
            of(77e9, 4e9, Convention::Physical),
        ] {
            assert_eq!(drawn.check("live", &radar), Ok(()));
        }
        let told = |radar: Radar| drawn.check("live", &radar).unwrap_err().to_string();
        let low = told(of(10e9, 1.5e9, Convention::Thesis));
        assert!(low.contains("trained for 20 to 100 GHz of carrier, at most 8 % of the carrier as bandwidth"), "{low}");
        assert!(low.contains("this radar has 10.0000 GHz of carrier, 15.0000 % of the carrier"), "{low}");
        let wide = told(Radar { element_spacing_metres: 4e-3, bandwidth_hz: 4e9, ..Radar::default() });
        assert!(wide.contains("at most 64 range bins from end to end, 0.8 to 1.2 of the filled spacing"), "{wide}");
        assert!(
            told(Radar { samples: 256, ..Radar::default() }).contains("for 512 samples; this radar has 256 samples")
        );
    }
}
