//! Run times of scenes of bodies: three maps from scratch and while one body is dragged, in bare transforms of the same run.
//!
//! The scenes are the preset "Street of things" and growing crowds of walls, boxes, posts and triangles. A dragged body moves by a centimetre
//! before every update, as under the mouse, so that its shadow changes too.

use super::front::{Front, MapConvention};
use super::times::{bare_ms, quantile};
use crate::engine::{Engine, EngineFrame, EngineStage, MapRequest, StageOutcome};
use crate::platform::Instant;
use crate::radar::Radar;
use crate::scene::presets::Preset;
use crate::scene::{Block, Object, Point, Polygon, Post, Scene, SceneError, Wall};
use crate::signal::simd::Simd;
use serde::Serialize;

/// Updates before the timed ones, since the first moves of a drag take the body out of the sum at rest.
const WARM_UP_UPDATES: usize = 3;
/// Measured time after which no further repeat begins, milliseconds: crowds take seconds a map.
const MAX_MEASURED_MS: f64 = 4000.0;
/// Distance that a dragged body moves from one update to the next, metres.
const STEP_METRES: f64 = 0.01;

/// A scene to be measured; its first object is dragged.
#[derive(Debug, Clone)]
pub struct BodyCase {
    pub name: String,
    pub scene: Scene,
}

impl BodyCase {
    /// The preset "Street of things": two cars, three walls and four posts. `None` in a build without it.
    pub fn street() -> Option<BodyCase> {
        let scene = Preset::by_id("street-of-things")?.load().ok()?.scene;
        Some(BodyCase { name: "street".to_owned(), scene })
    }

    /// `count` bodies of all kinds, at most 2013, a metre apart before the array, each half a metre wide.
    pub fn crowd(count: usize) -> BodyCase {
        let place = |i: usize| [(i * 37 % 61) as f64 - 30.0, (i * 53 % 33) as f64 + 2.4];
        let body = |i: usize| {
            let ([x, y], angle) = (place(i), (i * 29 % 180) as f64);
            match i % 4 {
                0 => Object::Box(Block::new([x, y], [0.5, 0.25], angle)),
                1 => Object::Wall(Wall::new(x, y, 0.5, angle)),
                2 => Object::Post(Post::new(x, y, 0.1)),
                _ => Object::Polygon(Polygon::new(vec![[x, y], [x + 0.4, y + 0.1], [x + 0.1, y + 0.4]])),
            }
        };
        BodyCase {
            name: "crowd".to_owned(),
            scene: Scene { objects: (0..count).map(body).collect(), ..Scene::default() },
        }
    }

    /// The same number of points at the same places as [`BodyCase::crowd`], for comparison with bodies.
    pub fn points(count: usize) -> BodyCase {
        let as_point = |object: Object| {
            let [x, y] = object.centre_metres();
            Object::Point(Point::new(x, y))
        };
        let objects = BodyCase::crowd(count).scene.objects.into_iter().map(as_point).collect();
        BodyCase { name: "points".to_owned(), scene: Scene { objects, ..Scene::default() } }
    }
}

/// Times of the cases; the bare transform ran between them.
pub type BodyTimes = Front<BodyRow>;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyRow {
    pub scene: String,
    pub objects: usize,
    /// Most echoes of the scene that an element receives.
    pub echoes: usize,
    #[serde(flatten)]
    pub convention: MapConvention,
    /// Median time of three maps of a scene that is new to the engine, milliseconds.
    pub scratch_ms: f64,
    /// Median time of three maps after the first object moved by a centimetre, milliseconds.
    pub drag_ms: f64,
    /// The engine's report of the signal stage for the last of those moves.
    pub computed: String,
}

/// Measures three maps of every case, each at most `repeats` times and over both conventions. `on_row` is called with each row.
/// # Errors
/// [`SceneError`] when the radar can't see a scene.
pub fn measure(
    radar: &Radar,
    cases: &[BodyCase],
    repeats: usize,
    mut on_row: impl FnMut(&BodyRow),
) -> Result<BodyTimes, SceneError> {
    let repeats = repeats.max(1);
    let (mut bare, mut rows) = (vec![bare_ms(repeats.max(9))], Vec::new());
    for case in cases {
        for convention in MapConvention::BOTH {
            let row = measured(radar, case, convention, repeats)?;
            on_row(&row);
            rows.push(row);
            // Other load on the machine slows this transform and the maps alike.
            bare.push(bare_ms(3));
        }
    }
    let (threads, simd) = (rayon::current_num_threads(), Simd::chosen());
    Ok(BodyTimes { bare_fft_ms: quantile(&mut bare, 0.5), threads, simd, rows })
}

fn measured(radar: &Radar, case: &BodyCase, convention: MapConvention, repeats: usize) -> Result<BodyRow, SceneError> {
    let MapConvention { floor, normalisation } = convention;
    let wanted = MapRequest { floor, normalisation, ends: false, ..MapRequest::default() };
    let mut engine = Engine::new(radar.clone());
    let mut scene = case.scene.clone();
    let timed = |engine: &mut Engine, scene: &Scene| -> Result<(f64, EngineFrame), SceneError> {
        let start = Instant::now();
        let frame = engine.update(scene, &wanted)?;
        Ok((1e3 * start.elapsed().as_secs_f64(), frame))
    };
    // The first update fills the tables that are kept from scene to scene, such as the floor's noise.
    timed(&mut engine, &scene)?;
    let mut scratch = Vec::new();
    while scratch.len() < repeats && scratch.iter().sum::<f64>() < MAX_MEASURED_MS {
        engine.forget();
        scratch.push(timed(&mut engine, &scene)?.0);
    }
    let (mut drag, mut computed) = (Vec::new(), String::new());
    let mut step = 0;
    while drag.len() < repeats && drag.iter().sum::<f64>() < MAX_MEASURED_MS {
        if let Some(object) = scene.objects.first_mut() {
            object.translate(STEP_METRES, 0.0);
        }
        let (took, frame) = timed(&mut engine, &scene)?;
        if step >= WARM_UP_UPDATES {
            drag.push(took);
        }
        step += 1;
        computed = said(&frame);
    }
    Ok(BodyRow {
        scene: case.name.clone(),
        objects: case.scene.objects.len(),
        echoes: case.scene.echo_count(),
        convention,
        scratch_ms: quantile(&mut scratch, 0.5),
        drag_ms: quantile(&mut drag, 0.5),
        computed,
    })
}

fn said(frame: &EngineFrame) -> String {
    let signal = frame.report.stages.iter().find(|stage| stage.stage == EngineStage::Signal);
    match signal.map(|stage| &stage.outcome) {
        Some(StageOutcome::Computed(what)) => what.clone(),
        Some(StageOutcome::Skipped(why)) => (*why).to_owned(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_is_timed_over_both_conventions() {
        let radar = Radar { elements: 64, samples: 64, end_elements: 4, bandwidth_hz: 2.5e8, ..Radar::default() };
        let cases = [BodyCase::street().unwrap(), BodyCase::crowd(8), BodyCase::points(8)];
        let mut seen = 0;
        let times = measure(&radar, &cases, 2, |_| seen += 1).unwrap();
        assert_eq!((times.rows.len(), seen), (6, 6));
        assert!(times.bare_fft_ms > 0.0);
        for row in &times.rows {
            assert!(row.scratch_ms > 0.0 && row.drag_ms > 0.0, "{row:?}");
            assert!(row.computed.contains(" of "), "a drag leaves something as it was: {row:?}");
        }
        assert_eq!([0, 2].map(|i| (times.rows[i].objects, times.rows[i].echoes)), [(9, 29), (8, 36)]);
    }

    #[test]
    fn no_two_bodies_of_a_crowd_stand_at_one_place() {
        let radar = Radar::default();
        let crowd = BodyCase::crowd(1000);
        crowd.scene.validate(&radar).unwrap();
        let mut places: Vec<_> =
            crowd.scene.objects.iter().map(|o| o.centre_metres().map(|v| (v * 10.0).round() as i64)).collect();
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), 1000);
    }
}
