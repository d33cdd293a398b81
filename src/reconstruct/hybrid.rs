//! Detect, refine, draw; and where the samples are not explained by what was found, another method fills in.

use super::answer::{Reconstruction, Request};
use super::error::ReconstructError;
use super::nomp::{Settings, find};
use super::reconstructor::{About, Reconstructor};
use crate::radar::Radar;
use crate::signal::TwoEnds;
use std::sync::Arc;

/// [`super::nomp::Nomp`] with a fallback for scenes that are not a handful of points and lines.
#[derive(Clone)]
pub struct Hybrid {
    fallback: Arc<dyn Reconstructor>,
    settings: Settings,
}

impl Hybrid {
    /// Part of the samples' energy that may be left unexplained before the fallback is asked; by examples/choose_eta.rs.
    pub const MOST_UNEXPLAINED: f64 = 0.03;

    /// With the method that fills in.
    pub fn new(fallback: Arc<dyn Reconstructor>) -> Self {
        Hybrid { fallback, settings: Settings::default() }
    }
}

impl Reconstructor for Hybrid {
    fn about(&self) -> About {
        About {
            name: "hybrid",
            description: "draws the exact map of the objects it finds; what they don't explain is filled in by another method",
            told: super::nomp::TOLD,
            eta: super::nomp::ETA,
        }
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        super::nomp::no_snapshot(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let found = find(radar, ends, request, &self.settings)?;
        let mut drawn = found.reconstruction(radar, request);
        if !found.complete && found.unexplained > Hybrid::MOST_UNEXPLAINED {
            // The objects found stay in the picture: they are sharper than anything the fallback draws.
            let filled = self.fallback.reconstruct(radar, ends, request)?.lambda;
            drawn.lambda.lambda.zip_mut_with(&filled.lambda, |drawn, filled| *drawn = drawn.max(*filled));
        }
        Ok(drawn)
    }
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
        let hybrid = Hybrid::new(Arc::new(Baseline)).reconstruct(&radar, &ends, &request).unwrap();
        let fallback = Baseline.reconstruct(&radar, &ends, &request).unwrap();
        assert!(hybrid.lambda.lambda.iter().zip(&fallback.lambda.lambda).all(|(h, f)| h >= f));
    }
}
