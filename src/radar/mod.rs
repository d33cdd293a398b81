//! The radar: every constant of the thesis' table 3.1 as one validated value.
//!
//! No other code in the crate has a carrier, a bandwidth or an element count: change the [`Radar`] and the whole pipeline follows.

mod across;
mod antennas;
pub mod budget;
mod chirps;
mod convention;
mod element_list;
mod elements;
mod layout;
mod layout_kind;
mod memory;
mod pair;
mod polar;
pub mod presets;
mod said;
mod squint;
mod units;
mod wave;
mod window;

pub use across::MIN_FINE_COLUMNS;
pub use antennas::Antennas;
pub use budget::{LinkBudget, LinkFigures, Pattern};
pub use convention::Convention;
pub use elements::{BuiltArray, ElementError, Tolerances};
pub use layout::{Layout, check_layout};
pub use layout_kind::{LayoutKind, ranges};
pub use memory::MAX_MEMORY_BYTES;
pub use pair::Pair;
pub use polar::Polar;
pub use units::{Bytes, DecibelMilliwatts, Decibels, capitalised, counted};
pub use window::{WindowFunction, chirp_window, hann, hann_at};

use serde::{Deserialize, Serialize};
use std::ops::{Range, RangeInclusive};

/// Speed of light in vacuum, metres per second.
pub const SPEED_OF_LIGHT: f64 = 299_792_458.0;

/// Duration of a chirp where a text gives none, seconds: 512 samples at 20 MHz.
pub const CHIRP_SECONDS: f64 = 25.6e-6;

/// Range of each constant of a radar, in its unit: products and squares stay finite, so that no sample is NaN.
const CONSTANT_RANGE: RangeInclusive<f64> = 1e-30..=1e30;

/// Least carrier, hertz: a smaller number is meant in another unit.
const MIN_CARRIER_HZ: f64 = 1e6;

/// Most bandwidth over the carrier. Ultra-wideband radars have up to 3, and radars that look into the ground up to 6.
const MAX_RELATIVE_BANDWIDTH: f64 = 10.0;

/// Most chirps that a radar may send one after another.
pub const MAX_CHIRPS: usize = 4096;

/// Dependence of the carrier's phase on the distance to a reflector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Carrier {
    /// `exp(-j 2 pi R / lambda)`: that of [`Convention::Thesis`], unambiguous over all of cos(theta) with half-wavelength spacing.
    #[default]
    OneWay,
    /// `exp(+j 4 pi R / lambda)`, equation 3.1 as printed: carrier and beat with one sign. At half-wavelength spacing two directions share a column.
    TwoWay,
}

impl Carrier {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Carrier::OneWay => "one-way",
            Carrier::TwoWay => "two-way",
        }
    }

    /// Carrier turns for each wavelength of distance, signed: the `s q` of equation 3.1 (-1 or +2).
    pub fn turns_per_wavelength(self) -> f64 {
        match self {
            Carrier::OneWay => -1.0,
            Carrier::TwoWay => 2.0,
        }
    }
}

/// One of the two ends of the array that a sparse sensor keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum End {
    /// The first elements, at the most negative x ("input 0").
    First,
    /// The last elements, at the most positive x ("input 1").
    Last,
}

impl End {
    /// Both ends, in the order of the thesis' inputs.
    pub const BOTH: [End; 2] = [End::First, End::Last];
}

/// A frequency-modulated continuous-wave radar with a uniform line array on the x axis, centred on x = 0 (thesis table 3.1).
///
/// The fields are public and unchecked; call [`Radar::validate`] on a value that came from outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "said::Said", into = "said::Said")]
pub struct Radar {
    /// Transmit power P_out in watts; a reflector's amplitude is `power * reflectivity / R^2`.
    pub transmit_power_watts: f64,
    /// Swept bandwidth B in hertz.
    pub bandwidth_hz: f64,
    /// Carrier frequency f in hertz.
    pub carrier_hz: f64,
    /// Distance between neighbouring elements in metres.
    pub element_spacing_metres: f64,
    /// Elements of the whole array, N_a; also the number of angle columns of every map.
    pub elements: usize,
    /// Elements of each of the two ends.
    pub end_elements: usize,
    /// Samples of one chirp, N_r; also the number of range bins of every map.
    pub samples: usize,
    /// Time that the samples of a chirp span, in seconds: they are taken at `samples / chirp_seconds` hertz. Echoes at rest don't depend on
    /// it, since a beat turns `2 R B / c` times in a chirp of any length; table 3.1 says none, and [`CHIRP_SECONDS`] stands for it.
    pub chirp_seconds: f64,
    /// Dependence of the carrier's phase on the distance.
    pub carrier: Carrier,
    /// Weights of the samples and of the elements in the two transforms that make a map.
    pub window: WindowFunction,
    /// Transmitters apart from receivers, else `None`: set by [`Radar::with_antennas`], which keeps elements and spacing those of the pairs.
    pub antennas: Option<Antennas>,
    /// Whether maps, not samples, focus elements off the line towards each column's direction ([`crate::maps::focus`]); else they count as on it.
    pub focus_off_line: bool,
    /// Chirps that are sent one after another: 1 as in the thesis. A map of ranges and directions is made of the first.
    pub chirps: usize,
    /// Time from the beginning of a chirp to that of the next, seconds: at least [`Radar::chirp_seconds`] where there are several.
    pub chirp_interval_seconds: f64,
    /// Figures of the radar equation ([`budget`]); `None` in the thesis' convention, where levels are those of samples and elements are isotropic.
    pub budget: Option<LinkBudget>,
}

/// A fault of a [`Radar`], with the value found and the values allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("radar.{field}{told}")]
pub struct RadarError {
    field: &'static str,
    told: String,
}

impl RadarError {
    /// Name of the field that is wrong.
    pub fn field(&self) -> &'static str {
        self.field
    }
}

impl Radar {
    /// Checks every field.
    /// # Errors
    /// [`RadarError`] names the first field that is not from 1e-30 to 1e30, a carrier below 1 MHz, more bandwidth than ten carriers, or a count out of range
    /// (1 to 65536 samples, 2 to 65536 elements, each end between 1 element and half the array, 1 to 4096 chirps), elements or a spacing
    /// other than those that the pairs of antennas make, a budget that can't be, or counts that together ask for more than
    /// [`MAX_MEMORY_BYTES`].
    pub fn validate(&self) -> Result<(), RadarError> {
        for (field, value) in [
            ("transmit_power_watts", self.transmit_power_watts),
            ("bandwidth_hz", self.bandwidth_hz),
            ("carrier_hz", self.carrier_hz),
            ("chirp_seconds", self.chirp_seconds),
            ("element_spacing_metres", self.element_spacing_metres),
            ("chirp_interval_seconds", self.chirp_interval_seconds),
        ] {
            if !CONSTANT_RANGE.contains(&value) {
                let (least, most) = (CONSTANT_RANGE.start(), CONSTANT_RANGE.end());
                let told = format!(" is {value:?}; it must be a number above 0, from {least:e} to {most:e}");
                return Err(RadarError { field, told });
            }
        }
        self.check_frequencies()?;
        for (field, value, min, max) in [
            ("samples", self.samples, 1, 65536),
            ("elements", self.elements, 2, 65536),
            ("end_elements", self.end_elements, 1, self.most_end_elements()),
            ("chirps", self.chirps, 1, MAX_CHIRPS),
        ] {
            if !(min..=max).contains(&value) {
                let told = format!(" is {value}; it must be between {min} and {max}");
                return Err(RadarError { field, told });
            }
        }
        let (interval, chirp) = (self.chirp_interval_seconds, self.chirp_seconds);
        if self.chirps > 1 && interval < chirp {
            let told = format!(" is {interval}; it must be at least chirp_seconds, which is {chirp}");
            return Err(RadarError { field: "chirp_interval_seconds", told });
        }
        self.check_pairs()?;
        self.budget.map_or(Ok(()), |budget| budget.validate())?;
        self.check_memory()
    }

    fn check_frequencies(&self) -> Result<(), RadarError> {
        let Radar { carrier_hz, bandwidth_hz, .. } = *self;
        if carrier_hz < MIN_CARRIER_HZ {
            let told = format!(" is {carrier_hz:?}; it must be at least {MIN_CARRIER_HZ:e}, in hertz: 77 GHz is 77e9");
            return Err(RadarError { field: "carrier_hz", told });
        }
        // A snapshot has no bandwidth.
        if self.samples > 1 && bandwidth_hz > MAX_RELATIVE_BANDWIDTH * carrier_hz {
            let told = format!(
                " is {bandwidth_hz:?}; it must be at most {MAX_RELATIVE_BANDWIDTH} times carrier_hz, which is {carrier_hz:?}: both are in hertz"
            );
            return Err(RadarError { field: "bandwidth_hz", told });
        }
        Ok(())
    }

    fn check_pairs(&self) -> Result<(), RadarError> {
        let Some(antennas) = &self.antennas else { return Ok(()) };
        let (transmitters, receivers) = (antennas.transmitter_x_metres().len(), antennas.receiver_x_metres().len());
        let (spacing, pairs) = (antennas.spacing_metres(), antennas.pairs().len() as f64);
        for (field, value, expected) in [
            ("elements", self.elements as f64, pairs),
            ("element_spacing_metres", self.element_spacing_metres, spacing),
        ] {
            if (value / expected - 1.0).abs() > 1e-9 {
                let of = format!("its {transmitters} transmitters and {receivers} receivers");
                return Err(RadarError { field, told: format!(" is {value}; {of} make {expected}") });
            }
        }
        Ok(())
    }

    /// Most elements of an end: half of all. Of three the middle one may be in both, since the outer two alone fold directions.
    pub fn most_end_elements(&self) -> usize {
        if self.elements == 3 { 2 } else { self.elements / 2 }
    }

    /// Carrier wavelength lambda = c / f in metres.
    pub fn wavelength_metres(&self) -> f64 {
        SPEED_OF_LIGHT / self.carrier_hz
    }

    /// Range resolution c / 2B in metres: the distance between neighbouring range bins.
    pub fn range_resolution_metres(&self) -> f64 {
        SPEED_OF_LIGHT / (2.0 * self.bandwidth_hz)
    }

    /// Range at which the range bins wrap around, in metres (38.4 m for table 3.1).
    pub fn max_range_metres(&self) -> f64 {
        self.samples as f64 * self.range_resolution_metres()
    }

    /// Samples a second of each receiver, hertz.
    pub fn sample_rate_hz(&self) -> f64 {
        self.samples as f64 / self.chirp_seconds
    }

    /// Position of element `n` on the x axis in metres, the array being centred on x = 0.
    pub fn element_x_metres(&self, n: usize) -> f64 {
        (n as f64 - (self.elements as f64 - 1.0) / 2.0) * self.element_spacing_metres
    }

    /// Distance between the first and the last element in metres.
    pub fn aperture_metres(&self) -> f64 {
        (self.elements as f64 - 1.0) * self.element_spacing_metres
    }

    /// Indices of the elements that belong to one end.
    pub fn end_range(&self, end: End) -> Range<usize> {
        match end {
            End::First => 0..self.end_elements,
            End::Last => self.elements - self.end_elements..self.elements,
        }
    }

    /// Centre of one end on the x axis, in metres.
    pub fn end_centre_metres(&self, end: End) -> f64 {
        let r = self.end_range(end);
        (self.element_x_metres(r.start) + self.element_x_metres(r.end - 1)) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_beyond_all_radars_are_named() {
        let usual = Radar::default();
        for (radar, part) in [
            (Radar { carrier_hz: 1e308, ..usual.clone() }, "radar.carrier_hz is 1e308; it must be a number above 0"),
            (Radar { carrier_hz: 1e-308, ..usual.clone() }, "radar.carrier_hz is 1e-308"),
            (Radar { bandwidth_hz: 1e308, ..usual.clone() }, "from 1e-30 to 1e30"),
            (Radar { transmit_power_watts: f64::INFINITY, ..usual.clone() }, "transmit_power_watts is inf"),
            (Radar { carrier_hz: 77.0, ..usual.clone() }, "carrier_hz is 77.0; it must be at least 1e6, in hertz"),
            (Radar { bandwidth_hz: 1e12, ..usual.clone() }, "at most 10 times carrier_hz, which is 77000000000.0"),
            (Radar { element_spacing_metres: 1e300, ..usual }, "element_spacing_metres is 1e300"),
        ] {
            let told = radar.validate().unwrap_err().to_string();
            assert!(told.contains(part), "{told}");
        }
    }

    #[test]
    fn wide_bands_and_low_carriers_are_allowed() {
        for (carrier_hz, bandwidth_hz, samples) in
            [(3.1e9, 7.5e9, 512), (5e8, 2.5e9, 512), (1e6, 1e6, 64), (4e7, 2e9, 1)]
        {
            let radar = Radar { carrier_hz, bandwidth_hz, samples, ..Radar::default() };
            assert_eq!(radar.validate(), Ok(()), "{carrier_hz} Hz, {bandwidth_hz} Hz");
        }
    }
}
