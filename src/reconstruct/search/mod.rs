//! Newtonized orthogonal matching pursuit in (x, y), with the exact near-field model of all samples of both ends.
//!
//! After Mamandipoor, Ramasamy and Madhow, "Newtonized Orthogonal Matching Pursuit: Frequency Estimation Over the Continuum" (2016):
//! detect the strongest cell of the residual, refine its place by Newton steps, then refine all objects together, and repeat. The exact simulator
//! draws the map of the objects. `ladder` lists the steps of the search.
//!
//! | file | content |
//! |---|---|
//! | `find` | the whole search, from samples to objects |
//! | `ladder` | the steps of the search in their order |
//! | `rungs` | the function of each step |
//! | `state` | the input and the state of a search |
//! | `propose` | sources of candidates, one a file |
//! | `begin` | the test of candidates for rows against the samples |
//! | `on_row` | the test for points on a row |
//! | `rows` | rows, one after another |
//! | `row_ends` | the ends of a row |
//! | `grow` | points at peaks of the residual |
//! | `trace` | the record of attempts |
//! | `prune` | the removal of needless atoms |
//! | `relax` | the number of echoes in a group of neighbours, over noise |
//! | `settings` | the limits of a search |
//! | `follow` | an answer from the last one, where little changed |
//! | `calibrate` | the estimate of the elements' gains |
//! | `element_gains` | the gain of each element |
//! | `finish` | one gain for both ends, reflectivities |
//! | `explained` | the residual in each cell of the map |
//! | `draw` | the expected map of the objects |
//! | `over_noise` | the expectation of a log map's cell over noise |

mod begin;
mod calibrate;
mod draw;
mod element_gains;
mod explained;
mod find;
mod finish;
mod follow;
mod grow;
mod ladder;
#[cfg(test)]
mod noise_tests;
mod on_row;
mod over_noise;
mod propose;
mod prune;
mod relax;
mod row_ends;
mod rows;
mod rungs;
mod settings;
mod state;
#[cfg(test)]
mod tests;
mod trace;
#[cfg(test)]
mod trace_tests;
#[cfg(test)]
mod tracking_tests;

pub use super::fit::Atom;
pub(super) use calibrate::MAX_ROUNDING_RESIDUAL_PART;
pub use draw::Expected;
pub use element_gains::ElementGains;
pub use find::{find, find_from};
pub use finish::Found;
pub use ladder::{LADDER, Rung};
pub(super) use propose::peaks::Detector;
pub(super) use prune::{MIN_DISTANCE_BINS, MIN_ENERGY_RATIO};
pub use settings::Settings;
pub(super) use state::Search;
pub(super) use trace::Trace;
pub use trace::{CALIBRATION, FOLLOWING, MAX_ATTEMPTS, ORDERING};

use super::answer::{Reconstruction, Request};
use super::error::ReconstructError;
use super::family::Family;
use super::own_threshold::own_threshold;
use super::prior::NoisePrior;
use super::reconstructor::{MethodInfo, Reconstructor};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use crate::scene::Reflector;
use crate::signal::TwoEnds;
use draw::{Noise, expected_lambda, expected_noise};

/// Threshold on Lambda for maps of found objects, chosen on validation scenes.
pub(super) const ETA: f32 = 0.896;

/// Energy that an atom explains over the residual in its range bins, decades, for a confidence of 0.5; and decades of odds for each further decade.
/// Fitted to validation scenes (`examples/experts.rs --confidence`).
const EVEN_ODDS_DECADES: f64 = 0.8;
const CONFIDENCE_SLOPE: f64 = 0.8;

/// The same energy, decades, for a confidence of 0.9; and the largest reflectivity of a listed object below that confidence, or beyond the maximum
/// range in an incomplete list, over the largest of the others. Far places have weak echoes, so a ghost there can be large.
const CERTAIN_DECADES: f64 = 2.0;
const MAX_OVER_CERTAIN: f64 = 2.0;

/// The method `nomp`: objects from the raw samples, and the exact map of them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nomp {
    settings: Settings,
}

impl Nomp {
    pub fn with_settings(settings: Settings) -> Self {
        Nomp { settings }
    }
}

/// The reason why a search can't work on chirps of one sample; `None` for more samples.
pub(super) fn no_snapshot(radar: &Radar) -> Option<String> {
    let reason = "a snapshot has no ranges to search; it needs two samples or more";
    (radar.samples < 2).then(|| reason.to_owned())
}

impl Reconstructor for Nomp {
    fn family(&self) -> Family {
        Family::Search
    }

    fn info(&self) -> MethodInfo {
        MethodInfo {
            name: "nomp",
            description: "finds reflectors and lines by Newton steps on the raw samples, then draws their exact map",
            prior_knowledge: "that a scene holds single reflectors or straight rows of equal ones at equal steps; that rows often run \
                along or across the array's axis; the kind of floor beneath the samples, and how the thesis' program rounds; \
                by about how much elements are off, where they are",
            eta: ETA,
        }
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        no_snapshot(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let found = find(radar, ends, request, &self.settings)?;
        Ok(found.reconstruction(radar, request))
    }
}

impl Found {
    /// The expected map of the objects over the floor of `request`. Its threshold is computed from the map where objects may be missing.
    pub fn reconstruction(&self, radar: &Radar, request: &Request) -> Reconstruction {
        let expected = self.expected(radar, request);
        let is_certain = self.is_complete && !request.noise.is_white();
        let eta = (!is_certain).then(|| own_threshold(&expected.map, None));
        Reconstruction { eta, ..self.as_drawn(radar, expected.map, Some(expected.least_eta)) }
    }

    /// The objects with the map `lambda`, in which noise alone doesn't exceed `least_eta`.
    pub fn as_drawn(&self, radar: &Radar, lambda: RangeAngleMap, least_eta: Option<f32>) -> Reconstruction {
        let max_range_metres = radar.max_range_metres();
        let is_in_range = |(reflector, _): &(Reflector, f64)| {
            self.is_complete || reflector.x_metres.hypot(reflector.y_metres) < max_range_metres
        };
        let is_certain = |object: &(Reflector, f64)| object.1 >= confidence_at(CERTAIN_DECADES) && is_in_range(object);
        let size = |(reflector, _): &(Reflector, f64)| reflector.reflectivity.abs();
        let objects: Vec<(Reflector, f64)> = self.reflectors(self.scale).zip(self.confidences()).collect();
        let largest_where = |is_counted: &dyn Fn(&(Reflector, f64)) -> bool| {
            objects.iter().filter(|object| is_counted(object)).map(size).reduce(f64::max)
        };
        let largest = largest_where(&is_certain).or_else(|| largest_where(&is_in_range)).unwrap_or(f64::INFINITY);
        let listed =
            objects.into_iter().filter(|object| is_certain(object) || size(object) <= MAX_OVER_CERTAIN * largest);
        let (reflectors, confidences) = listed.unzip();
        Reconstruction { lambda, reflectors, confidences, eta: None, least_eta, doubt: None, trace: self.trace.clone() }
    }

    /// The expected map of the objects, or of white noise without any.
    pub fn expected(&self, radar: &Radar, request: &Request) -> Expected {
        if self.atoms.is_empty() {
            return expected_noise(radar, request.normalisation);
        }
        let noise = match request.noise {
            NoisePrior::Rounding if self.is_complete => Noise::Rounding,
            // The rounding of an incomplete list is too small, so that the measured one is used.
            NoisePrior::Rounding => Noise::RoundingScaled(self.noise_variance),
            NoisePrior::Nothing => Noise::Variance(self.sample_power * f64::EPSILON.powi(2) / 4.0),
            NoisePrior::White { .. } if self.is_complete => Noise::Variance(self.residual_variance),
            NoisePrior::White { .. } => Noise::Variance(self.noise_variance),
        };
        expected_lambda(radar, self.reflectors(1.0), noise, request)
    }

    /// Probability that each reflector is real ([`confidence_at`]).
    fn confidences(&self) -> Vec<f64> {
        let of_atom =
            |(atom, needed): (&Atom, &f64)| std::iter::repeat_n(confidence_at(*needed), atom.reflector_count());
        self.atoms.iter().zip(&self.needed_decades).flat_map(of_atom).collect()
    }

    /// The reflectors of all objects, for samples divided by `scale`.
    fn reflectors(&self, scale: f64) -> impl Iterator<Item = Reflector> {
        let atoms = self.atoms.iter().zip(&self.reflectivities);
        atoms.flat_map(move |(atom, reflectivity)| atom.reflectors(reflectivity / scale))
    }
}

/// Probability that an object is real, by the decades of [`Found::needed_decades`].
fn confidence_at(needed_decades: f64) -> f64 {
    let odds = 10f64.powf(CONFIDENCE_SLOPE * (needed_decades - EVEN_ODDS_DECADES));
    odds / (1.0 + odds)
}
