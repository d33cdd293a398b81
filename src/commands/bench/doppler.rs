//! One object dragged while the range-Doppler panel is open: three maps and the map of 128 chirps after every move.

use crate::commands::CommandError;
use crate::engine::{Engine, MapRequest};
use crate::maps::doppler::range_doppler;
use crate::radar::Radar;
use crate::scene::Scene;
use serde::Serialize;
use std::time::Instant;

const CHIRPS: usize = 128;
const POINTS: [usize; 2] = [10, 100];
const MOVES: usize = 20;
const WARM_UP: usize = 2;

#[derive(Debug, Serialize)]
pub struct DopplerRow {
    points: usize,
    chirps: usize,
    moves: usize,
    median_ms: f64,
    worst_ms: f64,
}

impl DopplerRow {
    pub fn line(&self) -> String {
        format!(
            "dragging one of {:>3} moving points, {} chirps: {:.1} ms from the move to the range-Doppler map and three maps \
             ({:.0} a second), {:.1} ms at worst of {}",
            self.points,
            self.chirps,
            self.median_ms,
            1e3 / self.median_ms,
            self.worst_ms,
            self.moves
        )
    }
}

fn moving(points: usize) -> Scene {
    let mut scene = Scene::of_points((0..points).map(|i| {
        let part = (i as f64 + 0.5) / points as f64;
        (20.0 * (part * 7.0).sin(), 5.0 + 25.0 * part)
    }));
    for (i, object) in scene.objects.iter_mut().enumerate() {
        let turns = i as f64 / points as f64;
        let [x, y] = object.velocity_mut();
        (*x, *y) = (2.0 * turns, 20.0 * turns - 9.0);
    }
    scene
}

pub fn measure() -> Result<Vec<DopplerRow>, CommandError> {
    POINTS.into_iter().map(drag).collect()
}

fn drag(points: usize) -> Result<DopplerRow, CommandError> {
    let radar = Radar { chirps: CHIRPS, ..Radar::default() };
    let wanted = MapRequest::default();
    let (mut engine, mut scene) = (Engine::new(radar.clone()), moving(points));
    let mut times = Vec::new();
    for step in 0..WARM_UP + MOVES {
        if let Some(object) = scene.objects.first_mut() {
            object.translate(0.01, 0.005);
        }
        let begin = Instant::now();
        engine.update(&scene, &wanted).map_err(CommandError::failed)?;
        let map = range_doppler(&radar, &scene, wanted.floor, scene.noise_seed).map_err(CommandError::failed)?;
        std::hint::black_box(map.log_magnitude().normalise(wanted.normalisation));
        if step >= WARM_UP {
            times.push(1e3 * begin.elapsed().as_secs_f64());
        }
    }
    times.sort_by(f64::total_cmp);
    let [median_ms, worst_ms] = [MOVES / 2, MOVES - 1].map(|i| times[i]);
    Ok(DopplerRow { points, chirps: CHIRPS, moves: MOVES, median_ms, worst_ms })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_moves() {
        assert!(moving(10).objects.iter().all(|o| o.is_moving()));
    }

    #[test]
    fn every_drag_is_timed() {
        for row in measure().unwrap() {
            assert!(row.median_ms > 0.0 && row.median_ms <= row.worst_ms, "{row:?}");
            assert!(row.line().contains("128 chirps"));
        }
    }
}
