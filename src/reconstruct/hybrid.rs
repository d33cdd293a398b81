//! The method `hybrid`: the average of a search's map and a network's, weighted in each cell.

use super::error::Result;
use super::judge::stretch_to_common_scale;
use super::own_threshold::own_threshold;
use super::search::{Found, Settings, find, find_from};
use super::{Family, MethodInfo, Reconstruction, Reconstructor, Request, Weights, blended, network_weight};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{Decibels, Radar};
use crate::signal::TwoEnds;
use std::sync::{Arc, Mutex, PoisonError};

/// [`super::search::Nomp`] with a network for scenes that the search can't explain, or not within its budget.
#[derive(Clone)]
pub struct Hybrid {
    network: Arc<dyn Reconstructor>,
    settings: Settings,
    /// The last result, for a method that starts from it. The last digits then depend on the samples before: printed figures are from scratch.
    last: Option<Arc<Mutex<LastFound>>>,
}

type LastFound = Option<(Radar, Arc<Found>)>;

impl Hybrid {
    pub fn new(network: Arc<dyn Reconstructor>) -> Self {
        Hybrid { network, settings: Settings::default(), last: None }
    }

    pub fn with_settings(self, settings: Settings) -> Self {
        Hybrid { settings, ..self }
    }

    /// The average of the map of the objects in `found` and the network's map ([`network_weight`]).
    fn judged(&self, found: &Found, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        // A residual of rounding alone proves the objects; white noise may hide missing ones.
        let is_certain = found.is_complete && !request.noise.is_white();
        if is_certain || found.atoms.is_empty() || self.network.check_array(radar).is_err() {
            return Ok(found.reconstruction(radar, request));
        }
        let corrected = found.element_gains.as_ref().map(|gains| gains.taken_from(ends));
        let ends = corrected.as_ref().unwrap_or(ends);
        // A dynamic range begins at the peak of the averaged map, so the average is taken on a scale that cuts off nothing.
        let shown = Shown::of(request.normalisation);
        let whole = Request { normalisation: shown.whole, ..request.clone() };
        let (mut expected, mut network) =
            (found.expected(radar, &whole), self.network.reconstruct(radar, ends, &whole)?);
        let residual = found.residual_decades(radar, ends, &expected);
        let mut least_etas = [expected.least_eta, network.least_eta.unwrap_or(0.0)];
        // A dynamic range is exact, and cuts off most cells in which noise hides objects.
        let is_hidden = request.noise.is_white() && shown.part == 1.0;
        if is_hidden {
            least_etas = stretch_to_common_scale([&mut expected.map, &mut network.lambda], least_etas);
        }
        let doubt = network.doubt.as_ref();
        let weight = network_weight(&expected.map, &network.lambda, doubt, &residual, shown.part, is_hidden);
        let mut lambda = blended(expected.map, &network.lambda, &weight);
        let least_eta = shown.cut(&mut lambda, least_etas[0].max(least_etas[1]));
        let eta = own_threshold(&lambda, network.doubt.map(|doubt| shown.doubt(doubt)).as_ref());
        Ok(Reconstruction { eta: Some(eta), ..found.as_drawn(radar, lambda, Some(least_eta)) })
    }
}

impl Reconstructor for Hybrid {
    fn family(&self) -> Family {
        Family::Search
    }

    fn info(&self) -> MethodInfo {
        MethodInfo {
            name: "hybrid",
            description: "draws the exact map of the objects it finds; in cells that they don't explain it believes a network more",
            prior_knowledge: "the same as nomp; and by its network, the training scenes of live",
            eta: super::search::ETA,
        }
    }

    fn check_radar(&self, radar: &Radar) -> Result<()> {
        super::search::no_snapshot(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn reads_eta(&self) -> bool {
        true
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        let Some(memory) = &self.last else {
            return self.judged(&find(radar, ends, request, &self.settings)?, radar, ends, request);
        };
        // The lock is held for a copy only: the computation may wait for a thread that waits for the lock.
        let last = memory.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let found = match last.filter(|(of, _)| request.may_follow && of == radar) {
            Some((_, last)) => find_from(&last, radar, ends, request, &self.settings)?,
            None => find(radar, ends, request, &self.settings)?,
        };
        let found = Arc::new(found);
        *memory.lock().unwrap_or_else(PoisonError::into_inner) = Some((radar.clone(), found.clone()));
        self.judged(&found, radar, ends, request)
    }

    fn weights(&self, radar: &Radar) -> Option<Weights> {
        self.network.weights(radar)
    }

    fn following(&self) -> Option<Arc<dyn Reconstructor>> {
        Some(Arc::new(Hybrid { last: Some(Arc::default()), ..self.clone() }))
    }
}

/// A dynamic range that cuts off no cell: rounding in f64 is some 320 dB below the peak.
const WHOLE_RANGE: Decibels = Decibels(400.0);

/// A requested normalisation as the upper part of one that cuts off nothing.
#[derive(Debug, Clone, Copy)]
struct Shown {
    /// The one that cuts off nothing.
    whole: Normalisation,
    /// The requested part of it, 0 to 1.
    part: f32,
}

impl Shown {
    fn of(requested: Normalisation) -> Self {
        match requested {
            Normalisation::MinMax => Shown { whole: requested, part: 1.0 },
            Normalisation::DynamicRange(range) => {
                Shown { whole: Normalisation::DynamicRange(WHOLE_RANGE), part: (range.0 / WHOLE_RANGE.0) as f32 }
            }
        }
    }

    /// Converts a map of the whole range to Lambda of the part below its peak; returns `eta` on that scale.
    fn cut(self, map: &mut RangeAngleMap, eta: f32) -> f32 {
        if self.whole == Normalisation::MinMax {
            return eta;
        }
        let peak = map.lambda.iter().fold(0.0f32, |max, v| max.max(*v));
        let of = |v: f32| (1.0 - (peak - v) / self.part).clamp(0.0, 1.0);
        map.lambda.par_mapv_inplace(of);
        of(eta)
    }

    /// `doubt` on the scale of the shown part.
    fn doubt(self, mut doubt: RangeAngleMap) -> RangeAngleMap {
        doubt.lambda.par_mapv_inplace(|v| (v / self.part).min(1.0));
        doubt
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::{Baseline, search::Nomp};
    use crate::scene::{GaussianCluster, Object, Scene};
    use crate::signal::{Floor, simulate};

    fn ends_of(radar: &Radar, scene: &Scene) -> TwoEnds {
        simulate(radar, scene, Floor::Thesis, 0).unwrap().two_ends(radar)
    }

    #[test]
    fn an_explained_scene_needs_no_network() {
        let radar = Radar::default();
        let ends = ends_of(&radar, &Scene::of_points([(3.0, 11.0), (-9.0, 20.0)]));
        let request = Request::default();
        let hybrid = Hybrid::new(Arc::new(Baseline)).reconstruct(&radar, &ends, &request).unwrap();
        assert_eq!(hybrid, Nomp::default().reconstruct(&radar, &ends, &request).unwrap());
        assert_eq!(hybrid.reflectors.len(), 2);
    }

    #[test]
    fn every_cell_lies_between_both_experts_maps() {
        let radar = Radar::default();
        let cluster = GaussianCluster { seed: 1, ..GaussianCluster::new([2.0, 15.0], [3.0, 3.0], 150) };
        let scene = Scene { objects: vec![Object::Gaussian(cluster)], ..Scene::default() };
        let ends = ends_of(&radar, &scene);
        let request = Request::default();
        // One point can't explain a cloud.
        let few = Settings { max_atoms: 1, ..Settings::default() };
        let hybrid = Hybrid::new(Arc::new(Baseline)).with_settings(few).reconstruct(&radar, &ends, &request).unwrap();
        let drawn = Nomp::with_settings(few).reconstruct(&radar, &ends, &request).unwrap().lambda;
        let network = Baseline.reconstruct(&radar, &ends, &request).unwrap().lambda;
        let mut taken = 0;
        for ((h, drawn), network) in hybrid.lambda.lambda.iter().zip(&drawn.lambda).zip(&network.lambda) {
            assert!(*h >= drawn.min(*network) - 1e-6 && *h <= drawn.max(*network) + 1e-6);
            taken += usize::from((h - network).abs() < 1e-6);
        }
        assert!(taken > hybrid.lambda.lambda.len() / 2, "{taken} cells are the network's");
    }
}
