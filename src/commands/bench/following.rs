//! `apertura bench --methods`: one of twenty points dragged, every answer following the last where the method can.

use crate::commands::CommandError;
use crate::methods;
use crate::radar::{Radar, counted};
use crate::reconstruct::Request;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::scene::{Object, Scene};
use crate::signal::{Floor, simulate};
use serde::Serialize;
use std::time::Instant;

const METHOD: &str = "hybrid";

const POINTS: usize = 20;

/// Moves of one of them in each scene.
pub const MOVES: u32 = 10;

const STEP_METRES: [f64; 2] = [0.04, 0.02];

#[derive(Debug, Serialize)]
pub struct Followed {
    method: &'static str,
    points: usize,
    scenes: u32,
    moves: usize,
    median_milliseconds: f64,
    most_milliseconds: f64,
    worst_milliseconds: f64,
}

impl Followed {
    pub fn line(&self) -> String {
        let Followed { method, points, scenes, moves, .. } = self;
        format!(
            "{method}, one of {points} points dragged: {:.0} ms a move, {:.0} ms in nine of ten, {:.0} ms at worst ({}, {})",
            self.median_milliseconds,
            self.most_milliseconds,
            self.worst_milliseconds,
            counted(*moves, "move", "moves"),
            counted(*scenes, "scene", "scenes")
        )
    }
}

/// Drags a point in `count` test scenes of a crowd, less those points that are too many; a new draw of the floor at every move.
/// # Errors
/// [`CommandError`] where the method fails.
pub fn measure(count: u32, on_map: impl Fn()) -> Result<Followed, CommandError> {
    let radar = Radar::default();
    let generator = Generator::new(&radar, Reading::Program, Purpose::Test, 0);
    let scenes = (0..).map(|number| generator.scene(Kind::Crowd, number)).filter(|s| s.objects.len() >= POINTS);
    let request = Request { may_follow: true, ..Request::default() };
    let mut times = Vec::new();
    for mut scene in scenes.take(count as usize) {
        scene.objects.truncate(POINTS);
        let method = methods::by_name(METHOD).map_err(CommandError::failed)?;
        let method = method.following().unwrap_or(method);
        let ask = |scene: &Scene, seed: u64| {
            let signal = simulate(&radar, scene, Floor::Thesis, seed).map_err(CommandError::failed)?;
            let ends = signal.two_ends(&radar);
            let start = Instant::now();
            method.reconstruct(&radar, &ends, &request).map_err(CommandError::failed)?;
            Ok::<f64, CommandError>(1e3 * start.elapsed().as_secs_f64())
        };
        ask(&scene, 0)?;
        for seed in 1..=u64::from(MOVES) {
            if let Some(Object::Point(point)) = scene.objects.first_mut() {
                point.x_metres += STEP_METRES[0];
                point.y_metres += STEP_METRES[1];
            }
            times.push(ask(&scene, seed)?);
            on_map();
        }
    }
    times.sort_by(f64::total_cmp);
    let part = |of: f64| times.get((of * times.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    Ok(Followed {
        method: METHOD,
        points: POINTS,
        scenes: count,
        moves: times.len(),
        median_milliseconds: part(0.5),
        most_milliseconds: part(0.9),
        worst_milliseconds: times.last().copied().unwrap_or(f64::NAN),
    })
}
