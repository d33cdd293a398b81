//! Run times of the window's most frequent computations, on one thread. The native program and the page run the same ones, and
//! `scripts/measure-page` compares them.

use super::times::quantile;
use crate::engine::{Engine, MapRequest};
use crate::methods;
use crate::platform::Instant;
use crate::radar::Radar;
use crate::reconstruct::Request;
use crate::scene::Scene;
use crate::signal::{Floor, simulate};
use std::f64::consts::TAU;

const REPEATS: usize = 7;

const WARM_UP_RUNS: usize = 2;

const REFLECTOR_COUNTS: [usize; 2] = [10, 300];

const DRAG_METRES: f64 = 0.01;

#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Timed {
    pub name: String,
    pub milliseconds: f64,
}

fn spread(count: usize) -> Scene {
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    Scene::of_points((0..count).map(|i| {
        let (part, range_metres) = ((i as f64 * golden).fract(), 5.0 + 30.0 * (i as f64 + 0.5) / count as f64);
        let angle = TAU * (part - 0.5) / 3.0;
        (range_metres * angle.sin(), range_metres * angle.cos())
    }))
}

fn median(mut work: impl FnMut(usize) -> Result<(), String>) -> Result<f64, String> {
    let mut times = Vec::new();
    for run in 0..WARM_UP_RUNS + REPEATS {
        let began = Instant::now();
        work(run)?;
        times.push(1e3 * began.elapsed().as_secs_f64());
    }
    Ok(quantile(&mut times[WARM_UP_RUNS..], 0.5))
}

/// Three maps of 10 and of 300 reflectors, from scratch and while one is dragged, and the live network, on rayon's threads.
/// # Errors
/// A message where one of them can't be computed.
pub fn measure() -> Result<Vec<Timed>, String> {
    let radar = Radar::default();
    let mut timed = Vec::new();
    for count in REFLECTOR_COUNTS {
        let scene = spread(count);
        let mut moved = scene.clone();
        if let Some(object) = moved.objects.first_mut() {
            object.translate(DRAG_METRES, 0.0);
        }
        let mut engine = Engine::new(radar.clone());
        let wanted = MapRequest { floor: Floor::Exact, ends: false, ..MapRequest::default() };
        let mut update = |scene: &Scene, afresh: bool| {
            if afresh {
                engine.forget();
            }
            engine.update(scene, &wanted).map(|_| ()).map_err(|e| e.to_string())
        };
        let scratch = median(|_| update(&scene, true))?;
        let dragged = median(|run| update(if run % 2 == 0 { &moved } else { &scene }, false))?;
        timed.push(Timed { name: format!("maps of {count} reflectors, from scratch"), milliseconds: scratch });
        timed.push(Timed { name: format!("maps of {count} reflectors, one dragged"), milliseconds: dragged });
    }
    let live = methods::by_name("live").map_err(|e| e.to_string())?;
    let signal = simulate(&radar, &spread(REFLECTOR_COUNTS[0]), Floor::Thesis, 0).map_err(|e| e.to_string())?;
    let ends = signal.two_ends(&radar);
    let milliseconds =
        median(|_| live.reconstruct(&radar, &ends, &Request::default()).map(|_| ()).map_err(|e| e.to_string()))?;
    timed.push(Timed { name: "live".to_owned(), milliseconds });
    Ok(timed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_reflectors_lie_in_range() {
        let radar = Radar::default();
        for count in REFLECTOR_COUNTS {
            let scene = spread(count);
            assert!(scene.validate(&radar).is_ok() && scene.reflector_count() == count);
        }
    }
}
