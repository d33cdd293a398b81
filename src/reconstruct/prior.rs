//! The knowledge of the noise that a method is given.

use crate::maps::Normalisation;
use crate::maps::tolerance::tolerance_for;
use crate::radar::Decibels;
use crate::signal::Floor;
use std::fmt;
use std::str::FromStr;

/// The knowledge of the noise beneath the samples that a method is given. A simulator knows its [`Floor`]; a recording has at most this.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum NoisePrior {
    /// The rounding of the thesis' f64 program, which follows the echoes.
    #[default]
    Rounding,
    /// No noise at all.
    Nothing,
    /// White complex noise, and the root of its mean square in a sample, in the samples' unit; `None` where it is unknown and methods measure it.
    White { sigma: Option<f64> },
}

impl From<Floor> for NoisePrior {
    fn from(floor: Floor) -> Self {
        match floor {
            Floor::Thesis => NoisePrior::Rounding,
            Floor::Exact => NoisePrior::Nothing,
            Floor::Snr(_) | Floor::Level(_) | Floor::Thermal => NoisePrior::UNKNOWN,
        }
    }
}

impl FromStr for NoisePrior {
    type Err = String;

    /// Reads the text of [`Display`](fmt::Display), and the name of a floor.
    fn from_str(s: &str) -> Result<Self, String> {
        let sigma = |text: &str| text.parse::<f64>().ok().filter(|sigma| sigma.is_finite() && *sigma > 0.0);
        let prior = match s.split_once('=') {
            _ if s == "white" => Some(NoisePrior::UNKNOWN),
            Some(("white", text)) => sigma(text).map(|sigma| NoisePrior::White { sigma: Some(sigma) }),
            _ => s.parse::<Floor>().ok().map(NoisePrior::from),
        };
        prior.ok_or_else(|| {
            format!(
                "unknown noise \"{s}\"; expected white, white=SIGMA with SIGMA above 0, or a floor: thesis, exact, thermal, snr=DB or dbm=LEVEL"
            )
        })
    }
}

impl fmt::Display for NoisePrior {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoisePrior::Rounding => f.write_str("thesis"),
            NoisePrior::Nothing => f.write_str("exact"),
            NoisePrior::White { sigma: None } => f.write_str("white"),
            NoisePrior::White { sigma: Some(sigma) } => write!(f, "white={sigma}"),
        }
    }
}

impl NoisePrior {
    /// White noise of a level that must be measured, as beneath every recording.
    pub const UNKNOWN: NoisePrior = NoisePrior::White { sigma: None };

    /// Whether the noise is white.
    pub fn is_white(self) -> bool {
        matches!(self, NoisePrior::White { .. })
    }

    /// Variance of a sample's noise, where it is known.
    pub fn variance(self) -> Option<f64> {
        match self {
            NoisePrior::White { sigma: Some(sigma) } => Some(sigma * sigma),
            _ => None,
        }
    }

    /// The prior for samples multiplied by `gain`.
    pub fn scaled(self, gain: f64) -> Self {
        match self {
            NoisePrior::White { sigma } => NoisePrior::White { sigma: sigma.map(|sigma| sigma * gain) },
            other => other,
        }
    }

    /// Error of the samples that no map over this noise shows, over the amplitudes' sum; `snr` is that of the echoes over measured white noise.
    pub(crate) fn tolerance(self, normalisation: Normalisation, snr: Option<Decibels>) -> f64 {
        let floor = match self {
            NoisePrior::Rounding => Floor::Thesis,
            NoisePrior::Nothing => Floor::Exact,
            // A measured ratio is off by some tenths of a decibel.
            NoisePrior::White { .. } => Floor::Snr(snr.map_or(Decibels(f64::INFINITY), |snr| Decibels(snr.0.round()))),
        };
        tolerance_for(floor, normalisation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::reconstruct::noise_model::ends_noise_variance;
    use crate::scene::Scene;
    use crate::signal::simulate;

    #[test]
    fn a_known_level_is_believed() {
        let radar = Radar::default();
        let scene = Scene::of_points([(2.0, 10.0)]);
        let ends = simulate(&radar, &scene, Floor::Snr(Decibels(20.0)), 1).unwrap().two_ends(&radar);
        let known = NoisePrior::White { sigma: Some(3.0) };
        assert_eq!(ends_noise_variance(&radar, &ends, known), 9.0);
        assert_eq!(known.scaled(2.0).variance(), Some(36.0));
    }

    #[test]
    fn a_floor_tells_no_more_than_its_kind() {
        assert_eq!(NoisePrior::from(Floor::Thesis), NoisePrior::Rounding);
        assert_eq!(NoisePrior::from(Floor::Exact), NoisePrior::Nothing);
        assert_eq!(NoisePrior::from(Floor::Snr(Decibels(20.0))), NoisePrior::UNKNOWN);
    }

    #[test]
    fn names_round_trip() {
        for name in ["thesis", "exact", "white", "white=0.25"] {
            assert_eq!(name.parse::<NoisePrior>().unwrap().to_string(), name);
        }
        assert_eq!("snr=20".parse(), Ok(NoisePrior::UNKNOWN));
    }

    #[test]
    fn wrong_names_are_told() {
        for wrong in ["", "white=", "white=-1", "white=nan", "snr=nan", "pink"] {
            let told = wrong.parse::<NoisePrior>().unwrap_err().to_string();
            assert!(told.contains(&format!("\"{wrong}\"")) && told.contains("white=SIGMA"), "{told}");
        }
    }

    #[test]
    fn loud_noise_hides_the_rounding_of_single_precision() {
        let of = |prior: NoisePrior, snr| prior.tolerance(Normalisation::MinMax, snr);
        assert_eq!(of(NoisePrior::UNKNOWN, Some(Decibels(40.2))), 1e-6);
        assert!(of(NoisePrior::UNKNOWN, Some(Decibels(60.0))) < 1e-12);
        assert!(of(NoisePrior::UNKNOWN, None) < 1e-12);
        assert!(of(NoisePrior::Nothing, None) < of(NoisePrior::Rounding, None));
    }
}
