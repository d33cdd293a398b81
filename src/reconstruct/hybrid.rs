//! Detect, refine, draw; and cell by cell, where the samples are not explained by what was found, another method fills in.

use super::answer::{Reconstruction, Request};
use super::error::ReconstructError;
use super::family::Family;
use super::reconstructor::{About, Reconstructor, Weights};
use super::search::{Expected, Found, Settings, find, find_from};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use crate::signal::TwoEnds;
use ndarray::{Array2, Zip};
use std::sync::{Arc, Mutex, PoisonError};

/// [`super::search::Nomp`] with a fallback for what it can't take apart, or not in time.
#[derive(Clone)]
pub struct Hybrid {
    fallback: Arc<dyn Reconstructor>,
    settings: Settings,
    map_parts: [f32; 2],
}

impl Hybrid {
    /// With the method that fills in.
    pub fn new(fallback: Arc<dyn Reconstructor>) -> Self {
        Hybrid { fallback, settings: Settings::default(), map_parts: MAP_PARTS }
    }

    /// The same with other limits to the search.
    pub fn with_settings(self, settings: Settings) -> Self {
        Hybrid { settings, ..self }
    }

    /// The same with other limits to the part of a map that is unexplained: the fallback's map takes over from the first to the second.
    pub fn with_map_parts(self, map_parts: [f32; 2]) -> Self {
        Hybrid { map_parts, ..self }
    }

    /// The map of what was found, with what is in doubt filled in.
    fn filled_in(
        &self,
        found: &Found,
        radar: &Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        let expected = found.expected(radar, request);
        // Nothing fills in on a radar that the fallback doesn't know.
        if found.complete || self.fallback.check_array(radar).is_err() {
            return Ok(found.as_drawn(expected.map, Some(expected.least_eta)));
        }
        let filled = self.fallback.reconstruct(radar, ends, request)?;
        let least_eta = filled.least_eta.unwrap_or(0.0).max(expected.least_eta);
        let cells = found.unexplained_cells(radar, ends, &expected);
        let unexplained = Unexplained::new(cells, found.energy_left() as f32, self.map_parts);
        let filled_map = unexplained.on_one_scale(&expected.map, filled.lambda);
        let lambda = unexplained.blended(&expected.map, &filled_map);
        Ok(Reconstruction { eta: unexplained.eta_given(filled.eta), ..found.as_drawn(lambda, Some(least_eta)) })
    }

    fn about_itself() -> About {
        About {
            name: "hybrid",
            description: "draws the exact map of the objects it finds; cells that they don't explain are filled in by another method",
            told: super::search::TOLD,
            eta: super::search::ETA,
        }
    }
}

impl Reconstructor for Hybrid {
    fn family(&self) -> Family {
        Family::Search
    }

    fn about(&self) -> About {
        Hybrid::about_itself()
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        super::search::no_snapshot(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let found = find(radar, ends, request, &self.settings)?;
        self.filled_in(&found, radar, ends, request)
    }

    fn weights(&self) -> Option<Weights> {
        self.fallback.weights()
    }

    fn following(&self) -> Option<Arc<dyn Reconstructor>> {
        Some(Arc::new(Following { hybrid: self.clone(), last: Mutex::new(None) }))
    }
}

/// A [`Hybrid`] that keeps its last answer, and starts from it where it may. Answers that it followed agree with those of the hybrid
/// within the floor, and depend on what came before in their last digits: figures that are printed come from answers from scratch.
struct Following {
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

    fn knows_pairs(&self) -> bool {
        self.hybrid.knows_pairs()
    }

    fn weights(&self) -> Option<Weights> {
        self.hybrid.weights()
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        // The lock is held for a copy only: whoever waits for it while it computes may be the one it waits for.
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let settings = &self.hybrid.settings;
        let found = match last.filter(|(of, _)| request.may_follow && of == radar) {
            Some((_, last)) => find_from(&last, radar, ends, request, settings)?,
            None => find(radar, ends, request, settings)?,
        };
        let found = Arc::new(found);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some((radar.clone(), found.clone()));
        self.hybrid.filled_in(&found, radar, ends, request)
    }
}

/// Parts of a cell's power that are unexplained, in decades: up to the first the drawn map stays as it is, from the second on the fallback
/// has all the weight that it gets in the scene. By `examples/choose_eta.rs weights`, as the next two.
const CELL_DECADES: [f32; 2] = [-4.0, -0.3];

/// Parts of a scene's energy that are left, in decades, between which the fallback's weight grows from [`LEAST_WEIGHT`] to 1: what makes
/// up for nearly all of a scene draws a map that is as good as the fallback's, and what leaves much of it a worse one.
const SCENE_DECADES: [f32; 2] = [-3.0, -1.5];

/// Weight of the fallback where little of the scene's energy is left. The two maps err in different ways: their mean is better than either.
const LEAST_WEIGHT: f32 = 0.7;

/// Parts of a map's cells that are mostly unexplained, between which the fallback's map takes over in all cells, and on its own scale. Where
/// little energy is left and yet most cells are unexplained, the scene is not made of what the search looks for: rough bodies, for instance.
/// By `examples/choose_eta.rs takeover`.
const MAP_PARTS: [f32; 2] = [0.7, 0.9];

/// A cell is mostly unexplained where more than this part of its power is.
const MOSTLY: f32 = 0.5;

/// Cells beyond which a difference between the maps is believed to be one of scale.
const CELLS_TO_BELIEVE: f64 = 5000.0;

/// Part of a cell's power that is unexplained from which on the cell says nothing about the scales.
const SAYS_NOTHING: f32 = 0.1;

/// How far between two parts another one is, on the scale of decades: 0 to 1.
fn between([low, high]: [f32; 2], part: f32) -> f32 {
    ((part.max(1e-9).log10() - low) / (high - low)).clamp(0.0, 1.0)
}

/// Most weight that the fallback gets where this part of the scene's energy is left.
fn most_weight(energy_left: f32) -> f32 {
    LEAST_WEIGHT + (1.0 - LEAST_WEIGHT) * between(SCENE_DECADES, energy_left)
}

/// How much of a scene the search left unexplained.
pub struct Unexplained {
    /// How far each cell of the map is unexplained, 0 to 1: `[range bins, columns]`.
    cells: Array2<f32>,
    /// Part of the scene's energy that is left.
    energy_left: f32,
    /// How far the fallback's map takes over in all cells: 0 to 1.
    taken_over: f32,
}

impl Unexplained {
    /// Of these cells and this part of the scene's energy. The fallback's map takes over in all cells where the part of them that is mostly
    /// unexplained grows from the first of `map_parts` to the second.
    fn new(cells: Array2<f32>, energy_left: f32, map_parts: [f32; 2]) -> Self {
        let part = cells.iter().filter(|part| **part > MOSTLY).count() as f32 / cells.len() as f32;
        let [low, high] = map_parts;
        Unexplained { cells, energy_left, taken_over: ((part - low) / (high - low)).clamp(0.0, 1.0) }
    }

    /// What `found` leaves unexplained where its own map is `expected`; `ends` are the samples that were searched.
    pub fn by(found: &Found, radar: &Radar, ends: &TwoEnds, expected: &Expected) -> Self {
        Unexplained::new(found.unexplained_cells(radar, ends, expected), found.energy_left() as f32, MAP_PARTS)
    }

    /// How far each cell of the map is unexplained, 0 to 1: `[range bins, columns]`.
    pub fn cells(&self) -> &Array2<f32> {
        &self.cells
    }

    /// The threshold of a map that the fallback has taken over, in part or whole, given its own; none where the search's own threshold holds.
    fn eta_given(&self, fallback: Option<f32>) -> Option<f32> {
        let eta = |fallback| super::search::ETA + self.taken_over * (fallback - super::search::ETA);
        fallback.filter(|_| self.taken_over > 0.0).map(eta)
    }

    /// From `drawn`, where all is explained, towards `filled`, where nothing is. Both are Lambda of one scene on one scale.
    fn blended(&self, drawn: &RangeAngleMap, filled: &RangeAngleMap) -> RangeAngleMap {
        let least = self.taken_over;
        let most = most_weight(self.energy_left).max(least);
        let mut lambda = drawn.lambda.clone();
        Zip::from(&mut lambda)
            .and(&filled.lambda)
            .and(&self.cells)
            .par_for_each(|out, filled, part| *out += most * between(CELL_DECADES, *part).max(least) * (filled - *out));
        RangeAngleMap { lambda }
    }

    /// `filled` moved to the scale of `drawn`: each knows the weakest and the strongest cell in its own way, and where nearly all is explained
    /// the two should be one. Where few cells are, or much of the scene's energy is left, it stays nearly as it is: what lacks a strong object
    /// has no scale. Nor has a map of which most is unexplained.
    pub fn on_one_scale(&self, drawn: &RangeAngleMap, filled: RangeAngleMap) -> RangeAngleMap {
        let (mut sum, mut cells) = (0.0, 0.0);
        for ((drawn, filled), part) in drawn.lambda.iter().zip(&filled.lambda).zip(&self.cells) {
            let weight = f64::from((1.0 - part / SAYS_NOTHING).max(0.0));
            sum += weight * f64::from(filled - drawn);
            cells += weight;
        }
        let believed = (1.0 - between(SCENE_DECADES, self.energy_left)) * (1.0 - self.taken_over);
        let brighter = believed * (sum / (cells + CELLS_TO_BELIEVE)) as f32;
        RangeAngleMap { lambda: filled.lambda.mapv_into(|v| (v - brighter).clamp(0.0, 1.0)) }
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
        let cluster = GaussianCluster { seed: 1, ..GaussianCluster::new([2.0, 15.0], [3.0, 3.0], 150) };
        let scene = Scene { objects: vec![Object::Gaussian(cluster)], ..Scene::default() };
        let ends = ends_of(&radar, &scene);
        let request = Request::default();
        // One point can't explain a cloud: over the cloud the map is the fallback's, and elsewhere it takes over as far as the cloud fills the map.
        let few = Settings { most_atoms: 1, ..Settings::default() };
        let hybrid = Hybrid::new(Arc::new(Baseline)).with_settings(few).reconstruct(&radar, &ends, &request).unwrap();
        let found = find(&radar, &ends, &request, &few).unwrap();
        let unexplained = Unexplained::by(&found, &radar, &ends, &found.expected(&radar, &request));
        let drawn = Nomp::with_settings(few).reconstruct(&radar, &ends, &request).unwrap().lambda;
        let fallback = Baseline.reconstruct(&radar, &ends, &request).unwrap().lambda;
        let fallback = unexplained.on_one_scale(&drawn, fallback);
        let least = unexplained.taken_over;
        let mut taken = 0;
        for (i, (h, part)) in hybrid.lambda.lambda.iter().zip(&unexplained.cells).enumerate() {
            let [drawn, fallback] = [&drawn, &fallback].map(|m| m.lambda.as_slice().unwrap()[i]);
            assert!(*h >= drawn.min(fallback) - 1e-6 && *h <= drawn.max(fallback) + 1e-6);
            assert!(*part > 1e-4 || (h - drawn).abs() <= least * (fallback - drawn).abs() + 1e-6);
            taken += u32::from(*part > 0.2 && (h - fallback).abs() < 1e-6);
        }
        assert!(taken > 1000, "{taken} cells are the fallback's");
    }

    #[test]
    fn weight_grows_with_what_is_unexplained_in_the_cell_and_in_the_scene() {
        let parts: Vec<f32> = (0..=1000).map(|i| i as f32 / 1000.0).collect();
        for of in [most_weight, |part| between(CELL_DECADES, part)] {
            assert!(parts.windows(2).all(|w| of(w[0]) <= of(w[1])));
        }
        assert_eq!((most_weight(0.0), most_weight(1.0)), (LEAST_WEIGHT, 1.0));
        assert_eq!((between(CELL_DECADES, 0.0), between(CELL_DECADES, 1.0)), (0.0, 1.0));
    }

    #[test]
    fn the_fallback_takes_over_a_map_of_which_most_is_unexplained_with_its_scale_and_threshold() {
        let [drawn, filled] = [0.2, 0.6].map(|v| RangeAngleMap { lambda: Array2::from_elem((10, 10), v) });
        // So many of a hundred cells are unexplained.
        let unexplained = |cells: usize| {
            let cells = Array2::from_shape_fn((10, 10), |(i, j)| f32::from(u8::from(10 * i + j < cells)));
            Unexplained::new(cells, 0.0, [0.7, 0.9])
        };
        let answer = |cells| unexplained(cells).blended(&drawn, &filled).lambda;
        assert_eq!(answer(95), filled.lambda);
        let few = answer(50);
        assert_eq!(few[[9, 9]], 0.2);
        assert!((few[[0, 0]] - (0.2 + 0.4 * LEAST_WEIGHT)).abs() < 1e-6);
        let of_a_part = answer(80)[[9, 9]];
        assert!(
            (of_a_part - (0.2 + 0.4 * LEAST_WEIGHT / 2.0)).abs() < 1e-5,
            "{of_a_part} where nothing is unexplained"
        );
        assert_eq!(unexplained(50).eta_given(Some(0.75)), None);
        assert!((unexplained(95).eta_given(Some(0.75)).unwrap() - 0.75).abs() < 1e-6);
        assert_eq!(unexplained(95).eta_given(None), None);
    }

    #[test]
    fn maps_that_differ_in_scale_alone_are_one_where_all_is_explained() {
        let drawn =
            RangeAngleMap { lambda: Array2::from_shape_fn((512, 1024), |(i, j)| ((i * j) % 83) as f32 / 100.0) };
        let brighter = RangeAngleMap { lambda: drawn.lambda.mapv(|v| v + 0.05) };
        let largest = |unexplained: f32| {
            let cells = Array2::from_elem(drawn.lambda.dim(), unexplained);
            let moved = Unexplained::new(cells, 0.0, MAP_PARTS).on_one_scale(&drawn, brighter.clone());
            moved.lambda.iter().zip(&drawn.lambda).map(|(m, d)| (m - d).abs()).fold(0.0, f32::max)
        };
        assert!(largest(0.0) < 1e-3, "{}", largest(0.0));
        assert!((largest(0.5) - 0.05).abs() < 1e-6, "nothing is known: it stays");
    }
}
