//! `apertura bench --methods`: how much of the live network's side lobes in range a scene needs, and what leaving out the rest costs.

use crate::commands::CommandError;
use crate::evaluate::trial::Trial;
use crate::maps::{LambdaScale, Normalisation};
use crate::network;
use crate::network::live::LiveMethod;
use crate::network::live::engine::Decades;
use crate::radar::{Radar, counted};
use crate::reconstruct::Request;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::Floor;
use serde::Serialize;
use std::time::Instant;

const KINDS: [Kind; 2] = [Kind::Points(10), Kind::Mixed(4)];

#[derive(Debug, Serialize)]
pub struct LeftOut {
    kind: Kind,
    scenes: u32,
    computed: f64,
    largest_error: f32,
    median_milliseconds: f64,
    whole_median_milliseconds: f64,
}

impl LeftOut {
    pub fn line(&self) -> String {
        format!(
            "live, {}: {:.0} % of side lobes in range computed, {:.1} ms for {:.1} with all of them, Lambda at most {:.0e} off ({})",
            self.kind,
            100.0 * self.computed,
            self.median_milliseconds,
            self.whole_median_milliseconds,
            self.largest_error,
            counted(self.scenes, "scene", "scenes")
        )
    }
}

/// Compares on `count` test scenes of each kind; nothing where the live network can't be read.
/// # Errors
/// [`CommandError`] where the network fails.
pub fn measure(count: u32) -> Result<Vec<LeftOut>, CommandError> {
    let Some(live) = network::live() else { return Ok(Vec::new()) };
    KINDS.into_iter().map(|kind| of_kind(&live, kind, count)).collect()
}

fn of_kind(live: &LiveMethod, kind: Kind, count: u32) -> Result<LeftOut, CommandError> {
    let (radar, request) = (Radar::default(), Request::default());
    let generator = Generator::new(&radar, Reading::Program, Purpose::Test, 0);
    let mut left_out = LeftOut {
        kind,
        scenes: count,
        computed: 0.0,
        largest_error: 0.0,
        median_milliseconds: 0.0,
        whole_median_milliseconds: 0.0,
    };
    let mut times = [Vec::new(), Vec::new()];
    for number in 0..count {
        let scene = generator.scene(kind, number);
        let trial = Trial::new(&radar, &scene, Floor::Thesis, request.normalisation).map_err(CommandError::failed)?;
        let mut timed = |at: usize, whole: bool| {
            let start = Instant::now();
            let decades =
                if whole { live.decades_whole(&radar, &trial.ends) } else { live.decades(&radar, &trial.ends) };
            times[at].push(start.elapsed().as_secs_f64() * 1e3);
            decades.map_err(CommandError::failed)
        };
        // By turns, as the second one finds the samples at hand.
        let (part, whole) = if number % 2 == 0 {
            (timed(0, false)?, timed(1, true)?)
        } else {
            let whole = timed(1, true)?;
            (timed(0, false)?, whole)
        };
        left_out.computed += f64::from(part.computed) / f64::from(count);
        left_out.largest_error = left_out.largest_error.max(distance(&part, &whole, request.normalisation));
    }
    times.iter_mut().for_each(|times| times.sort_by(f64::total_cmp));
    [left_out.median_milliseconds, left_out.whole_median_milliseconds] = times.each_ref().map(|t| t[t.len() / 2]);
    Ok(left_out)
}

fn distance(a: &Decades, b: &Decades, normalisation: Normalisation) -> f32 {
    let peak = |map: &[f32]| map.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let [of_a, of_b] = [a, b].map(|d| LambdaScale::new(d.minimum.into(), peak(&d.map).into(), normalisation));
    let cells = a.map.iter().zip(&b.map);
    cells.map(|(a, b)| (of_a.lambda((*a).into()) - of_b.lambda((*b).into())).abs() as f32).fold(0.0, f32::max)
}
