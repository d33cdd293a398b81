//! Newtonized orthogonal matching pursuit in (x, y), with the exact near-field model of all samples of both ends.
//!
//! After Mamandipoor, Ramasamy and Madhow, "Newtonized Orthogonal Matching Pursuit: Frequency Estimation Over the Continuum" (2016):
//! detect the strongest cell of the residual, move it to its best place by Newton steps, then move everything found so far together,
//! and repeat. The exact simulator draws the map of what was found.
//!
//! | file | what it is |
//! |---|---|
//! | `atom` | the dictionary: one reflector, or a line of them |
//! | `sensor` | what an atom leaves in the samples, and its derivatives |
//! | `beams` | each end's plain beams |
//! | `detect` | strongest cell of a residual, both ends registered |
//! | `lines` | lines that a residual may hold |
//! | `place` | one more atom at its best place |
//! | `fit` | Levenberg-Marquardt on positions, gains projected out |
//! | `search` | the greedy loop and its second thoughts |
//! | `finish` | one gain for both ends, reflectivities |
//! | `draw` | expected map of the objects found |

mod atom;
mod beams;
mod detect;
mod draw;
mod finish;
mod fit;
mod lines;
mod place;
mod search;
mod sensor;
#[cfg(test)]
mod tests;

pub use atom::Atom;
pub use finish::Found;
pub use search::{Settings, find};

use super::answer::{Reconstruction, Request};
use super::error::ReconstructError;
use super::reconstructor::{About, Reconstructor};
use crate::radar::Radar;
use crate::signal::{Floor, TwoEnds};
use draw::{Noise, Weighted, expected_lambda};

/// Threshold for the maps of found objects, chosen on validation scenes.
pub(super) const ETA: f32 = 0.885;

/// What the search knows beside the samples.
pub(super) const TOLD: &str = "that a scene holds single reflectors or lines of them along y, the spacings and counts of the lines \
    that the tables' scenes are made of, the kind of floor beneath the samples, and how the thesis' program rounds";

/// Detect, refine, draw: objects from the raw samples, and the exact map of them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nomp {
    settings: Settings,
}

impl Nomp {
    /// With other limits than the default ones.
    pub fn with_settings(settings: Settings) -> Self {
        Nomp { settings }
    }
}

/// Why a search for places can't work on a single sample, where it is one.
pub(super) fn no_snapshot(radar: &Radar) -> Option<String> {
    let why = "a snapshot has no ranges to search; it needs two samples or more";
    (radar.samples < 2).then(|| why.to_owned())
}

impl Reconstructor for Nomp {
    fn about(&self) -> About {
        About {
            name: "nomp",
            description: "finds reflectors and lines by Newton steps on the raw samples, then draws their exact map",
            told: TOLD,
            eta: ETA,
        }
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        no_snapshot(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let found = find(radar, ends, request, &self.settings)?;
        Ok(found.reconstruction(radar, request))
    }
}

impl Found {
    /// The map of what was found, over the floor that `request` names.
    pub fn reconstruction(&self, radar: &Radar, request: &Request) -> Reconstruction {
        if self.atoms.is_empty() {
            return Reconstruction::silence(radar);
        }
        let objects: Vec<Weighted> = self
            .atoms
            .iter()
            .zip(&self.reflectivities)
            .map(|(&atom, &reflectivity)| Weighted { atom, reflectivity })
            .collect();
        let noise = match request.floor {
            Floor::Thesis => Noise::Rounding,
            Floor::Exact => Noise::Variance(self.sample_power * f64::EPSILON.powi(2) / 4.0),
            Floor::Snr(_) => Noise::Variance(self.residual_variance),
        };
        let lambda = expected_lambda(radar, &objects, noise, request);
        let reflectors = objects.iter().flat_map(|o| o.atom.object(o.reflectivity / self.scale).reflectors()).collect();
        Reconstruction { lambda, reflectors }
    }
}
