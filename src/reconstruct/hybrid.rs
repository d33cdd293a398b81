//! Detect, refine, draw; and cell by cell, where the samples are not explained by what was found, another method fills in.

use super::answer::{Reconstruction, Request};
use super::error::ReconstructError;
use super::nomp::{Found, Settings, find, find_from};
use super::reconstructor::{About, Reconstructor};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use crate::signal::TwoEnds;
use ndarray::{Array2, Zip};
use std::sync::{Arc, Mutex, PoisonError};

/// [`super::nomp::Nomp`] with a fallback for what it can't take apart, or not in time.
#[derive(Clone)]
pub struct Hybrid {
    fallback: Arc<dyn Reconstructor>,
    settings: Settings,
}

impl Hybrid {
    /// With the method that fills in.
    pub fn new(fallback: Arc<dyn Reconstructor>) -> Self {
        Hybrid { fallback, settings: Settings::default() }
    }

    /// The same with other limits to the search.
    pub fn with_settings(self, settings: Settings) -> Self {
        Hybrid { settings, ..self }
    }

    /// The same, starting each search from the last answer.
    pub fn following(self) -> Following {
        Following { hybrid: self, last: Mutex::new(None) }
    }

    /// The map of what was found, with what is in doubt filled in.
    fn filled_in(
        &self,
        found: &Found,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        let mut drawn = found.reconstruction(radar, request);
        // Nothing fills in on a radar that the fallback doesn't know.
        if found.complete || self.fallback.check_radar(radar).is_err() {
            return Ok(drawn);
        }
        let filled = self.fallback.reconstruct(radar, ends, request)?.lambda;
        drawn.lambda = blended(&drawn.lambda, &filled, &found.unexplained_cells(radar, ends));
        Ok(drawn)
    }

    fn about_itself() -> About {
        About {
            name: "hybrid",
            description: "draws the exact map of the objects it finds; cells that they don't explain are filled in by another method",
            told: super::nomp::TOLD,
            eta: super::nomp::ETA,
        }
    }
}

impl Reconstructor for Hybrid {
    fn about(&self) -> About {
        Hybrid::about_itself()
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        super::nomp::no_snapshot(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let found = find(radar, ends, request, &self.settings)?;
        self.filled_in(&found, radar, ends, request)
    }
}

/// A [`Hybrid`] that keeps its last answer and starts from it: for samples that change a little at a time, as while something is
/// dragged. Answers agree with those of the hybrid within the floor, and depend on what came before in their last digits, so that
/// printed figures come from the hybrid itself.
pub struct Following {
    hybrid: Hybrid,
    last: Mutex<Option<(Radar, Arc<Found>)>>,
}

impl Reconstructor for Following {
    fn about(&self) -> About {
        Hybrid::about_itself()
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        self.hybrid.check_radar(radar)
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        // The lock is held for a copy only: whoever waits for it while it computes may be the one it waits for.
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let settings = &self.hybrid.settings;
        let found = match last.filter(|(of, _)| of == radar) {
            Some((_, last)) => find_from(&last, radar, ends, request, settings)?,
            None => find(radar, ends, request, settings)?,
        };
        let found = Arc::new(found);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some((radar.clone(), found.clone()));
        self.hybrid.filled_in(&found, radar, ends, request)
    }
}

/// Part of a cell's power that is unexplained, in decades, and the weight of the fallback there; a straight line between them. By
/// `examples/choose_eta.rs`: where the two disagree, the part of the way from the drawn map to the fallback's that leaves least.
const WEIGHTS: [[f32; 2]; 2] = [[-0.8, 0.0], [-0.15, 1.0]];

/// Weight of the fallback, 0 to 1, where this part of a cell's power is unexplained.
fn weight(unexplained: f32) -> f32 {
    let decades = unexplained.max(1e-9).log10();
    let after = WEIGHTS.partition_point(|[at, _]| *at <= decades);
    if after == 0 {
        return WEIGHTS[0][1];
    }
    let Some([next, high]) = WEIGHTS.get(after) else { return WEIGHTS[WEIGHTS.len() - 1][1] };
    let [at, low] = WEIGHTS[after - 1];
    low + (high - low) * (decades - at) / (next - at)
}

/// From `drawn`, where all is explained, to `filled`, where nothing is. Both are Lambda of one scene, from the floor to the strongest cell.
fn blended(drawn: &RangeAngleMap, filled: &RangeAngleMap, unexplained: &Array2<f32>) -> RangeAngleMap {
    let mut lambda = drawn.lambda.clone();
    Zip::from(&mut lambda)
        .and(&filled.lambda)
        .and(unexplained)
        .par_for_each(|out, filled, part| *out += weight(*part) * (filled - *out));
    RangeAngleMap { lambda }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::{Baseline, nomp::Nomp};
    use crate::scene::{GaussianCluster, Object, Scene};
    use crate::signal::{Floor, simulate};

    fn ends_of(radar: &Radar, scene: &Scene) -> TwoEnds {
        simulate(radar, scene, Floor::Thesis, 0).unwrap().two_ends(radar)
    }

    #[test]
    fn an_explained_scene_needs_no_fallback() {
        let radar = Radar::default();
        let ends = ends_of(&radar, &Scene::of_points([(3.0, 11.0), (-9.0, 20.0)]));
        let request = Request::default();
        let hybrid = Hybrid::new(Arc::new(Baseline)).reconstruct(&radar, &ends, &request).unwrap();
        assert_eq!(hybrid, Nomp::default().reconstruct(&radar, &ends, &request).unwrap());
        assert_eq!(hybrid.reflectors.len(), 2);
    }

    #[test]
    fn an_unexplained_scene_is_filled_in() {
        let radar = Radar::default();
        let cluster = GaussianCluster {
            x_metres: 2.0,
            y_metres: 15.0,
            x_std_metres: 3.0,
            y_std_metres: 3.0,
            count: 150,
            seed: 1,
            reflectivity: 1.0,
        };
        let scene = Scene { objects: vec![Object::Gaussian(cluster)], ..Scene::default() };
        let ends = ends_of(&radar, &scene);
        let request = Request::default();
        // One point can't explain a cloud: over the cloud the map is the fallback's, and nowhere beyond both.
        let few = Settings { most_atoms: 1, ..Settings::default() };
        let hybrid = Hybrid::new(Arc::new(Baseline)).with_settings(few).reconstruct(&radar, &ends, &request).unwrap();
        let fallback = Baseline.reconstruct(&radar, &ends, &request).unwrap().lambda;
        let nomp = Nomp::with_settings(few).reconstruct(&radar, &ends, &request).unwrap().lambda;
        let cells = || hybrid.lambda.lambda.iter().zip(fallback.lambda.iter().zip(&nomp.lambda));
        assert!(cells().all(|(h, (f, n))| *h >= f.min(*n) - 1e-6 && *h <= f.max(*n) + 1e-6));
        let taken = cells().filter(|(h, (f, _))| h == f).count();
        assert!(taken > 1000, "{taken} cells are the fallback's");
    }

    #[test]
    fn weight_grows_with_what_is_unexplained() {
        assert_eq!((weight(0.0), weight(1.0)), (WEIGHTS[0][1], WEIGHTS[WEIGHTS.len() - 1][1]));
        let all: Vec<f32> = (0..=100).map(|i| weight(i as f32 / 100.0)).collect();
        assert!(all.windows(2).all(|w| w[0] <= w[1]), "{all:?}");
    }
}
