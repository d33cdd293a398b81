//! The link budget: how strong an echo is received, over how much noise, by the radar equation.
//!
//! An object of radar cross section `sigma` at range `R` is received with
//!
//! ```text
//! P_r = P_t G^2 lambda^2 sigma / ((4 pi)^3 R^4)
//! ```
//!
//! over noise of `k T B F`, where `B` is the complex sampling rate ([`Radar::sample_rate_hz`]) and `T` is 290 K. `G` is the
//! boresight gain of one element, for transmission and reception; [`Pattern`] gives other directions.
//! (M. I. Skolnik, *Introduction to Radar Systems*, chapter 1.)
//!
//! Samples are not watts. By default a point of reflectivity `g` has the amplitude `P_out g / R^2` ([`Radar::transmit_power_watts`]), which
//! falls with range like the radar equation. With a budget, reflectivity 1 is a cross section of 1 square metre (`sigma = g^2`), and a sample
//! `y` stands for `|y|^2 P_1 / P_out^2` watts, where `P_1` is the power received from 1 square metre at 1 m. A budget changes samples only by
//! the element pattern and by floors given in watts.

use super::{DecibelMilliwatts, Decibels, Radar, RadarError};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Boltzmann's constant, joules a kelvin.
pub const BOLTZMANN: f64 = 1.380_649e-23;
/// Temperature that noise figures refer to, kelvin (IEEE).
pub const NOISE_TEMPERATURE_KELVIN: f64 = 290.0;
/// SNR at which a single pulse detects a steady target with P_D 0.9 and P_FA 1e-6 (Skolnik, figure 2.6: 13.2 dB).
pub const DETECTION_SNR: Decibels = Decibels(13.0);

/// Figures of the radar equation beside the radar's other constants.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LinkBudget {
    /// Power that a transmitter sends, dBm.
    pub transmit_power_dbm: f64,
    /// Boresight gain of an element, dBi, for transmission and reception.
    pub antenna_gain_dbi: f64,
    /// Noise figure of a receiver, dB.
    pub noise_figure_db: f64,
    /// Half-power beam width of an element, degrees; `None` for isotropic elements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_power_width_degrees: Option<f64>,
}

impl Default for LinkBudget {
    fn default() -> Self {
        LinkBudget {
            transmit_power_dbm: 12.0,
            antenna_gain_dbi: 10.0,
            noise_figure_db: 12.0,
            half_power_width_degrees: None,
        }
    }
}

impl LinkBudget {
    /// Checks every number.
    /// # Errors
    /// [`RadarError`] names the first invalid number, the values allowed, and the reason.
    pub fn validate(&self) -> Result<(), RadarError> {
        let width = self.half_power_width_degrees.unwrap_or(90.0);
        for (field, value, is_usable, expected) in [
            (
                "transmit_power_dbm",
                self.transmit_power_dbm,
                (-100.0..=150.0).contains(&self.transmit_power_dbm),
                "-100 to 150 dBm: every decibel of it is one of SNR",
            ),
            (
                "antenna_gain_dbi",
                self.antenna_gain_dbi,
                (-50.0..=100.0).contains(&self.antenna_gain_dbi),
                "-50 to 100 dBi: every decibel of it is two of SNR, one on the way there and one on the way back",
            ),
            (
                "noise_figure_db",
                self.noise_figure_db,
                (0.0..=100.0).contains(&self.noise_figure_db),
                "0 to 100 dB: a receiver adds noise, and below 0 it would take some away",
            ),
            (
                "half_power_width_degrees",
                width,
                (MIN_WIDTH_DEGREES..180.0).contains(&width),
                "0.001 to below 180 degrees, or no such key for isotropic elements: an element of width 0 would see nothing",
            ),
        ] {
            if !is_usable {
                let told = format!(".{field} is {value}; expected {expected}");
                return Err(RadarError { field: "budget", told });
            }
        }
        Ok(())
    }

    /// The pattern of an element; `None` where it is isotropic.
    pub fn pattern(&self) -> Option<Pattern> {
        self.half_power_width_degrees.map(Pattern::of_half_power_width)
    }
}

/// One-way power pattern of an element: `cos^n` of the angle off broadside, the same behind the array as before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pattern {
    exponent: f64,
}

/// Smallest width of an element's pattern: the cosine of half of a much smaller one rounds to 1, whose pattern is NaN.
const MIN_WIDTH_DEGREES: f64 = 1e-3;

/// Lower bound of a one-way amplitude, -100 dB: no direction is silent.
const MIN_ONE_WAY_AMPLITUDE: f64 = 1e-5;

impl Pattern {
    /// The pattern that leaves half of the power at half of this angle to either side, degrees.
    pub fn of_half_power_width(degrees: f64) -> Self {
        Pattern { exponent: 0.5f64.ln() / (degrees / 2.0).to_radians().cos().ln() }
    }

    /// The exponent `n` of the cosine.
    pub fn exponent(self) -> f64 {
        self.exponent
    }

    /// Amplitude of one way, relative to straight ahead: `cos^(n / 2)` of the angle off broadside.
    pub fn amplitude(self, cos_off_broadside: f64) -> f64 {
        cos_off_broadside.abs().powf(self.exponent / 2.0).max(MIN_ONE_WAY_AMPLITUDE)
    }

    /// [`Pattern::amplitude`] from an antenna at (x, y) to a place, metres.
    pub fn amplitude_between(self, [from_x, from_y]: [f64; 2], [x, y]: [f64; 2]) -> f64 {
        let (across, ahead) = (x - from_x, y - from_y);
        self.amplitude(ahead / across.hypot(ahead))
    }

    /// Relative change of [`Pattern::amplitude`] for the change `of_log_cos` of the cosine's logarithm.
    pub fn relative_change(self, of_log_cos: f64) -> f64 {
        self.exponent / 2.0 * of_log_cos
    }
}

/// An echo by the radar equation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LinkFigures {
    /// Level of the echo at one element.
    #[serde(rename = "received_dbm")]
    pub received: DecibelMilliwatts,
    /// Level of one receiver's noise in a sample.
    #[serde(rename = "noise_dbm")]
    pub noise: DecibelMilliwatts,
    /// SNR of a sample.
    #[serde(rename = "sample_snr_db")]
    pub sample: Decibels,
    /// SNR in its bin of a range profile.
    #[serde(rename = "range_snr_db")]
    pub range: Decibels,
    /// SNR by one end, where its elements add in phase.
    #[serde(rename = "end_snr_db")]
    pub end: Decibels,
    /// SNR by the whole array, where its elements add in phase: in the far field ([`Radar::far_field_metres`]), or focused.
    #[serde(rename = "array_snr_db")]
    pub array: Decibels,
}

/// SNR that a transform over `count` points gains under these weights: `(sum w)^2 / sum w^2`.
fn gain(weights: &[f64]) -> Decibels {
    let (sum, squares) = weights.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
    Decibels(10.0 * (sum * sum / squares).log10())
}

impl Radar {
    /// The radar's link budget, or [`LinkBudget::default`] where it has none.
    pub fn budget_or_usual(&self) -> LinkBudget {
        self.budget.unwrap_or_default()
    }

    /// The pattern of its elements; `None` where they are isotropic, as without a budget.
    pub fn pattern(&self) -> Option<Pattern> {
        self.budget.and_then(|budget| budget.pattern())
    }

    /// Level at which an element receives an object straight ahead.
    pub fn received(&self, cross_section_dbsm: f64, range_metres: f64) -> DecibelMilliwatts {
        let budget = self.budget_or_usual();
        let spread = 30.0 * (4.0 * PI).log10() + 40.0 * range_metres.log10() - 20.0 * self.wavelength_metres().log10();
        DecibelMilliwatts(budget.transmit_power_dbm + 2.0 * budget.antenna_gain_dbi + cross_section_dbsm - spread)
    }

    /// Level of a receiver's own noise in a sample: `k T B F`.
    pub fn receiver_noise(&self) -> DecibelMilliwatts {
        let cold = DecibelMilliwatts::of_watts(BOLTZMANN * NOISE_TEMPERATURE_KELVIN * self.sample_rate_hz());
        DecibelMilliwatts(cold.0 + self.budget_or_usual().noise_figure_db)
    }

    /// Watts at a receiver for each unit of a sample's squared magnitude, by the budget or the usual one.
    pub fn receiver_watts(&self) -> f64 {
        self.received(0.0, 1.0).watts() / self.transmit_power_watts.powi(2)
    }

    /// SNR that the transform over range gains.
    pub fn range_gain(&self) -> Decibels {
        gain(&self.window.weights(self.samples))
    }

    /// SNR that the transform over this many elements gains.
    pub fn angle_gain(&self, elements: usize) -> Decibels {
        gain(&self.window.weights(elements))
    }

    /// The echo of an object at a range and an angle off broadside (cosine). Losses between cells, and of near-field maps without focus, are left out.
    pub fn link(&self, cross_section_dbsm: f64, range_metres: f64, cos_off_broadside: f64) -> LinkFigures {
        let pattern = self.pattern().map_or(0.0, |p| 40.0 * p.amplitude(cos_off_broadside).log10());
        let received = DecibelMilliwatts(self.received(cross_section_dbsm, range_metres).0 + pattern);
        let noise = self.receiver_noise();
        let sample = received.0 - noise.0;
        let range = sample + self.range_gain().0;
        let [end, array] = [self.end_elements, self.elements].map(|n| Decibels(range + self.angle_gain(n).0));
        LinkFigures { received, noise, sample: Decibels(sample), range: Decibels(range), end, array }
    }
}

/// Range at which an SNR has fallen to `least`, where it is `snr` at `range_metres`: it falls by 40 dB a decade.
pub fn range_of_snr_metres(least: Decibels, snr: Decibels, range_metres: f64) -> f64 {
    range_metres * 10f64.powf((snr.0 - least.0) / 40.0)
}

/// Radar cross section of a point of this reflectivity, in decibels over 1 square metre: `20 log10 |g|`.
pub fn cross_section_dbsm(reflectivity: f64) -> f64 {
    20.0 * reflectivity.abs().log10()
}

/// Reflectivity of a point of this radar cross section.
pub fn reflectivity_of(cross_section_dbsm: f64) -> f64 {
    10f64.powf(cross_section_dbsm / 20.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radar(budget: LinkBudget) -> Radar {
        Radar { budget: Some(budget), ..Radar::default() }
    }

    #[test]
    fn a_budget_by_hand() {
        let radar = radar(LinkBudget::default());
        // 12 dBm and 10 dBi at 77 GHz, 10 square metres at 50 m, in watts.
        let (sent, gain, wavelength) = (15.848_931_92e-3, 10.0, 299_792_458.0 / 77e9);
        let four_pi: f64 = 12.566_370_614;
        let received = sent * gain * gain * wavelength * wavelength * 10.0 / (four_pi.powi(3) * 50f64.powi(4));
        // 20 MHz at 290 K, 12 dB.
        let noise = 1.380_649e-23 * 290.0 * 512.0 / 25.6e-6 * 15.848_931_92;
        let link = radar.link(10.0, 50.0, 1.0);
        assert!((link.received.watts() / received - 1.0).abs() < 1e-7, "{link:?}");
        assert!((link.noise.watts() / noise - 1.0).abs() < 1e-7, "{link:?}");
        assert!((link.noise.0 + 88.97).abs() < 0.01, "-174 dBm a hertz, 73 dB of bandwidth, 12 dB: {link:?}");
        assert!((link.sample.0 - 10.0 * (received / noise).log10()).abs() < 1e-6);
        // Hann loses 10 log10 1.5 of the gain of the number of points.
        assert!((link.range.0 - link.sample.0 - 10.0 * (512.0f64 / 1.5).log10()).abs() < 0.02, "{link:?}");
        assert!((link.array.0 - link.range.0 - 10.0 * (1024.0f64 / 1.5).log10()).abs() < 0.02, "{link:?}");
        let falls = range_of_snr_metres(DETECTION_SNR, link.array, 50.0);
        assert!((radar.link(10.0, falls, 1.0).array.0 - 13.0).abs() < 1e-9);
    }

    #[test]
    fn a_pattern_leaves_half_of_the_power_at_half_of_its_width() {
        for degrees in [10.0, 60.0, 120.0, 170.0] {
            let pattern = Pattern::of_half_power_width(degrees);
            let cos = (degrees / 2.0f64).to_radians().cos();
            assert!((pattern.amplitude(cos).powi(2) - 0.5).abs() < 1e-12);
            assert_eq!(pattern.amplitude(1.0), 1.0);
        }
        let cosine = Pattern::of_half_power_width(120.0);
        assert!((cosine.exponent() - 1.0).abs() < 1e-12 && cosine.amplitude(0.0) == MIN_ONE_WAY_AMPLITUDE);
        let wide = LinkBudget { half_power_width_degrees: Some(120.0), ..LinkBudget::default() };
        let lost = radar(wide).link(0.0, 10.0, 0.5).sample.0 - radar(wide).link(0.0, 10.0, 1.0).sample.0;
        assert!((lost - 20.0 * 0.5f64.log10()).abs() < 1e-9, "half there and half back: {lost}");
    }

    #[test]
    fn reflectivity_one_is_a_square_metre() {
        assert_eq!((cross_section_dbsm(1.0), reflectivity_of(0.0)), (0.0, 1.0));
        assert!((reflectivity_of(20.0) - 10.0).abs() < 1e-12 && (cross_section_dbsm(-0.1) + 20.0).abs() < 1e-12);
        let radar = radar(LinkBudget::default());
        // A sample of reflectivity 0.3 at 7 m.
        let sample = radar.transmit_power_watts * 0.3 / 49.0;
        let received = radar.received(cross_section_dbsm(0.3), 7.0).watts();
        assert!((sample * sample * radar.receiver_watts() / received - 1.0).abs() < 1e-9);
    }

    #[test]
    fn bad_numbers_are_told_with_what_is_allowed() {
        let usual = LinkBudget::default();
        let wide = |degrees| LinkBudget { half_power_width_degrees: Some(degrees), ..usual };
        for (budget, told) in [
            (LinkBudget { noise_figure_db: -3.0, ..usual }, "radar.budget.noise_figure_db is -3; expected 0 to 100 dB"),
            (LinkBudget { antenna_gain_dbi: f64::NAN, ..usual }, "antenna_gain_dbi is NaN; expected -50 to 100 dBi"),
            (LinkBudget { transmit_power_dbm: 151.0, ..usual }, "expected -100 to 150 dBm"),
            (wide(0.0), "is 0; expected 0.001 to below 180"),
            (wide(1e-9), "is 0.000000001; expected 0.001 to below 180"),
            (wide(180.5), "is 180.5; expected 0.001 to below 180"),
        ] {
            let error = radar(budget).validate().unwrap_err();
            assert!(error.to_string().contains(told) && error.field() == "budget", "{error}");
        }
        radar(usual).validate().unwrap();
    }
}
