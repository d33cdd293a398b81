//! Many random edits through the incremental engine: where they end, and what they leave in memory.

use crate::engine::{Engine, MapRequest};
use crate::files::memory::resident_bytes;
use crate::maps::tolerance::tolerance_for;
use crate::radar::Radar;
use crate::scene::{Line, Object, Point, Scene, SceneError};
use crate::signal::plan::amplitude_bound;
use rand::{RngExt, SeedableRng};
use serde::Serialize;

/// Compared with a fresh engine so often over a run, at least.
const COMPARISONS: usize = 20;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EditReport {
    pub edits: usize,
    /// Largest difference from an engine that starts afresh, over the run: of range cells, relative to a cell in which all echoes of the
    /// scene agree. Tolerances are relative to the same.
    pub worst_difference: f64,
    /// What the difference may be: both engines' own error, and the half of it that the one may gather before it starts afresh itself.
    pub most_difference: f64,
    /// Bytes in the engine's caches after the first twentieth of the edits.
    pub cache_bytes_early: usize,
    /// Bytes in the engine's caches in the end.
    pub cache_bytes: usize,
    /// Resident bytes of the process after the first twentieth, where the system tells.
    pub resident_bytes_early: Option<u64>,
    /// Resident bytes of the process in the end.
    pub resident_bytes: Option<u64>,
}

fn random_object(rng: &mut impl RngExt) -> Object {
    let mut at = |span: f64| (rng.random::<f64>() - 0.5) * span;
    let (x_metres, y_metres) = (at(4.0), 1.5 + at(2.0));
    let reflectivity = 10f64.powf(at(8.0));
    if at(1.0) < 0.35 {
        Object::Point(Point { reflectivity, ..Point::new(x_metres, y_metres) })
    } else {
        Object::Line(Line { reflectivity, ..Line::vertical(x_metres, y_metres, 0.1, 5) })
    }
}

/// Adds, removes, replaces, reorders and moves objects at random (`seed`), in the conventions of `wanted`.
/// # Errors
/// [`SceneError`] when a random object happens to lie on an element.
pub fn random_edits(radar: &Radar, wanted: &MapRequest, edits: usize, seed: u64) -> Result<EditReport, SceneError> {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let mut engine = Engine::new(radar.clone());
    let mut scene = Scene { objects: (0..12).map(|_| random_object(&mut rng)).collect(), ..Scene::default() };
    let every = edits.div_ceil(COMPARISONS).max(1);
    let mut report = EditReport {
        edits,
        worst_difference: 0.0,
        most_difference: 2.5 * tolerance_for(wanted.floor, wanted.normalisation),
        cache_bytes_early: 0,
        cache_bytes: 0,
        resident_bytes_early: None,
        resident_bytes: None,
    };
    for edit in 1..=edits {
        let at = rng.random_range(0..scene.objects.len());
        match rng.random_range(0..10) {
            0 if scene.objects.len() < 30 => scene.objects.push(random_object(&mut rng)),
            1 if scene.objects.len() > 3 => drop(scene.objects.remove(at)),
            2 => scene.objects.swap(0, at),
            3 => scene.objects[at] = random_object(&mut rng),
            _ => scene.objects[at].translate(rng.random::<f64>() * 0.1 - 0.05, rng.random::<f64>() * 0.1 - 0.05),
        }
        engine.update(&scene, wanted)?;
        if edit % every == 0 {
            let mut fresh = Engine::new(radar.clone());
            fresh.update(&scene, wanted)?;
            let difference = difference(radar, &engine, &fresh, &scene).unwrap_or(f64::INFINITY);
            report.worst_difference = report.worst_difference.max(difference);
            (report.cache_bytes, report.resident_bytes) = (engine.cache_bytes(), resident_bytes());
            if edit == every {
                (report.cache_bytes_early, report.resident_bytes_early) = (report.cache_bytes, report.resident_bytes);
            }
        }
    }
    Ok(report)
}

fn difference(radar: &Radar, engine: &Engine, fresh: &Engine, scene: &Scene) -> Option<f64> {
    let weights: f64 = radar.window.weights(radar.samples).iter().sum();
    let together = amplitude_bound(radar, &scene.reflectors()) * weights / (radar.samples as f64).sqrt();
    let mut worst = 0.0f64;
    for element in 0..radar.elements {
        for (a, b) in engine.range_profile(element)?.iter().zip(fresh.range_profile(element)?) {
            worst = worst.max((a - b).norm());
        }
    }
    Some(worst / together.max(f64::MIN_POSITIVE))
}
