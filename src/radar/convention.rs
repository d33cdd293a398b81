//! The two conventions: how an echo's phase follows its path, and the spacing of elements that belongs to it.
//!
//! | convention | phase of sample `n` of an echo at range `R` | filled spacing |
//! |---|---|---|
//! | [`Convention::Thesis`] | `-2 pi f R / c + 2 pi n B / N (2 R / c)` | half a wavelength of the carrier |
//! | [`Convention::Physical`] | `+2 pi (f + n B / N) (2 R / c)` | a quarter of a wavelength in the middle of the chirp |
//!
//! `R` is half the path from the transmitter over the reflector to the receiver. A physical radar measures the second one up to one sign
//! for all samples. The first one is `-2 pi (f/2 - n B / N) (2 R / c)`: up to that sign, the second one for a carrier `f/2` and a chirp
//! that falls by `B`. So the thesis' radar is a physical one that sends and hears at 38.5 GHz, falls to 36.5 GHz, and has its elements a
//! quarter of a wavelength (1.947 mm) apart; `tests/library/which_radar.rs` holds the two to each other, sample by sample.
//!
//! Both follow from [`Carrier`]: the signed turns of the carrier for each wavelength of range. Samples depend on the convention by these alone.

use super::{Carrier, Radar, SPEED_OF_LIGHT};
use serde::{Deserialize, Serialize};

/// The convention of a radar's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Convention {
    /// The thesis': carrier one way with minus, beat both ways with plus. It reproduces the thesis' tables.
    Thesis,
    /// The physical one, for a chirp that rises from the carrier: carrier and beat both ways with one sign.
    Physical,
}

impl Convention {
    /// Both conventions, the thesis' first.
    pub const ALL: [Convention; 2] = [Convention::Thesis, Convention::Physical];

    /// Its name, as files and the command line have it.
    pub fn name(self) -> &'static str {
        match self {
            Convention::Thesis => "thesis",
            Convention::Physical => "physical",
        }
    }

    /// The convention called `name`.
    pub fn by_name(name: &str) -> Option<Self> {
        Convention::ALL.into_iter().find(|c| c.name() == name)
    }

    /// Dependence of the carrier's phase on the distance.
    pub fn carrier(self) -> Carrier {
        match self {
            Convention::Thesis => Carrier::OneWay,
            Convention::Physical => Carrier::TwoWay,
        }
    }

    /// Distance in metres between neighbouring elements at which every direction has a column of its own, and no column is left over.
    pub fn filled_spacing_metres(self, carrier_hz: f64, bandwidth_hz: f64) -> f64 {
        match self {
            Convention::Thesis => SPEED_OF_LIGHT / carrier_hz / 2.0,
            Convention::Physical => SPEED_OF_LIGHT / (carrier_hz + bandwidth_hz / 2.0) / 4.0,
        }
    }
}

impl From<Carrier> for Convention {
    fn from(carrier: Carrier) -> Self {
        match carrier {
            Carrier::OneWay => Convention::Thesis,
            Carrier::TwoWay => Convention::Physical,
        }
    }
}

impl Radar {
    /// The convention of the radar's samples, at any spacing of its elements.
    pub fn convention(&self) -> Convention {
        self.carrier.into()
    }

    /// The spacing that belongs to the radar's convention, metres.
    pub fn filled_spacing_metres(&self) -> f64 {
        self.convention().filled_spacing_metres(self.carrier_hz, self.bandwidth_hz)
    }

    /// The same radar in another convention, its elements filled for it.
    pub fn in_convention(self, convention: Convention) -> Self {
        let element_spacing_metres = convention.filled_spacing_metres(self.carrier_hz, self.bandwidth_hz);
        Radar { carrier: convention.carrier(), ..self }.with_spacing(element_spacing_metres)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_has_one_column_in_the_physical_convention() {
        let radar = Radar::default().in_convention(Convention::Physical);
        assert_eq!(radar.carrier, Carrier::TwoWay);
        let period = radar.fold_period_cos();
        assert!((2.0..2.0 + 1e-3).contains(&period), "cos(theta) repeats after {period}");
        // In the table's own spacing half of the directions share columns with others.
        let as_spaced = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        assert!(as_spaced.fold_period_cos() < 1.0);
    }
}
