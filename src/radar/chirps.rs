//! Velocities from a sequence of chirps.
//!
//! From chirp to chirp the phase of an echo turns by its [wave number](Radar::turns_per_metre) times the change of its range. In the
//! middle of the chirp, where windows weigh most, the wave number is `kappa = s q / lambda + 1 / (2 dR)` turns a metre. In the physical
//! convention that is two turns a wavelength of the frequency in the middle of the chirp: velocities up to `lambda / (4 Tc)` have a
//! column of their own. The thesis' carrier counts the way once and with minus: there it is `lambda / (2 Tc)`, lambda that of `f - B`.

use super::Radar;

impl Radar {
    /// The same radar sending a single chirp. The samples of that chirp are the same, to the bit.
    pub fn of_one_chirp(&self) -> Radar {
        let Radar { chirps, chirp_interval_seconds, .. } = Radar::default();
        Radar { chirps, chirp_interval_seconds, ..self.clone() }
    }

    /// Sets the duration of a chirp; where the next would begin before its end, it begins at its end.
    pub fn set_chirp_seconds(&mut self, seconds: f64) {
        self.chirp_seconds = seconds;
        self.chirp_interval_seconds = self.chirp_interval_seconds.max(seconds);
    }

    /// Velocities below this one, towards the radar or away, have a column of their own: `1 / (2 |kappa| Tc)`, metres a second.
    pub fn unambiguous_velocity_metres_per_second(&self) -> f64 {
        0.5 / (self.middle_turns_per_metre().abs() * self.chirp_interval_seconds)
    }

    /// Difference of velocity from one column of a range-Doppler map to the next: `1 / (|kappa| M Tc)` for `M` chirps, metres a second.
    pub fn velocity_resolution_metres_per_second(&self) -> f64 {
        2.0 * self.unambiguous_velocity_metres_per_second() / self.chirps as f64
    }

    /// The velocity at which a range-Doppler map shows a radial velocity: folded into -v up to but not including v, the unambiguous one.
    pub fn apparent_velocity_metres_per_second(&self, velocity_metres_per_second: f64) -> f64 {
        let most = self.unambiguous_velocity_metres_per_second();
        (velocity_metres_per_second + most).rem_euclid(2.0 * most) - most
    }

    /// Radial velocity at a column of a range-Doppler map, metres a second: 0 in column `M / 2`, growing to the right.
    pub fn velocity_of_column_metres_per_second(&self, column: f64) -> f64 {
        (column - (self.chirps / 2) as f64) * self.velocity_resolution_metres_per_second()
    }

    /// Shift of an echo along the range by a radial velocity within a chirp, metres: the phase turns `kappa v T` times more while the beat is
    /// counted, each a range bin. In the physical convention this is `v f T / B`, `f` that of the middle of the chirp.
    pub fn doppler_range_shift_metres(&self, velocity_metres_per_second: f64) -> f64 {
        let turns = self.middle_turns_per_metre() * velocity_metres_per_second * self.chirp_seconds;
        self.range_of_bin_metres(turns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Carrier, SPEED_OF_LIGHT};

    fn physical() -> Radar {
        Radar { carrier: Carrier::TwoWay, chirps: 128, samples: 4096, elements: 64, ..Radar::default() }
    }

    #[test]
    fn velocities_are_those_of_the_textbooks() {
        let radar = physical();
        // lambda / (4 Tc) and lambda / (2 M Tc) at 78 GHz, the middle of the chirp; half a sample of 4096 is 3e-6 of it.
        let lambda = SPEED_OF_LIGHT / 78e9;
        let most = radar.unambiguous_velocity_metres_per_second();
        assert!((most / (lambda / (4.0 * 25.6e-6)) - 1.0).abs() < 1e-5, "{most}");
        let step = radar.velocity_resolution_metres_per_second();
        assert!((step / (lambda / (2.0 * 128.0 * 25.6e-6)) - 1.0).abs() < 1e-5, "{step}");
        let shift = radar.doppler_range_shift_metres(20.0);
        assert!((shift / (20.0 * 78e9 * 25.6e-6 / 2e9) - 1.0).abs() < 1e-5, "{shift}");
        let thesis = Radar { carrier: Carrier::OneWay, ..radar };
        let most = thesis.unambiguous_velocity_metres_per_second();
        assert!((most / (SPEED_OF_LIGHT / 75e9 / (2.0 * 25.6e-6)) - 1.0).abs() < 1e-4, "{most}");
    }

    #[test]
    fn velocities_fold_at_the_unambiguous_one() {
        let radar = physical();
        let most = radar.unambiguous_velocity_metres_per_second();
        for (velocity, apparent) in [(0.3 * most, 0.3), (1.2 * most, -0.8), (-1.5 * most, 0.5), (4.1 * most, 0.1)] {
            assert!((radar.apparent_velocity_metres_per_second(velocity) / most - apparent).abs() < 1e-12);
        }
        let edge = radar.velocity_of_column_metres_per_second(0.0);
        let holds = (edge / most + 1.0).abs() < 1e-12;
        assert!(holds, "the first column is that of the unambiguous velocity towards the radar");
        assert_eq!(radar.velocity_of_column_metres_per_second(64.0), 0.0);
    }

    #[test]
    fn chirps_without_sense_are_named() {
        for (radar, part) in [
            (Radar { chirps: 0, ..Radar::default() }, "radar.chirps is 0; it must be between 1 and 4096"),
            (Radar { chirps: usize::MAX, ..Radar::default() }, "radar.chirps"),
            (Radar { chirp_interval_seconds: f64::NAN, ..Radar::default() }, "chirp_interval_seconds is NaN"),
            (Radar { chirp_interval_seconds: 0.0, ..Radar::default() }, "above 0"),
            (Radar { chirps: 2, chirp_seconds: 1e-3, ..Radar::default() }, "at least chirp_seconds, which is 0.001"),
            (Radar { chirps: 4096, samples: 65536, elements: 6, end_elements: 3, ..Radar::default() }, "4096 chirps"),
        ] {
            let told = radar.validate().unwrap_err().to_string();
            assert!(told.contains(part), "{told}");
        }
    }
}
