//! `apertura bench --live`: times of the live network's forward pass, sparse and dense, and of the features before it.

use crate::commands::{CommandError, print, print_json};
use crate::evaluate::upper_median;
use crate::network;
use crate::network::live::engine::LiveScratch;
use crate::network::live::features::FeatureExtractor;
use crate::radar::{Radar, counted};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::{Floor, simulate};
use serde::Serialize;
use std::time::Instant;

const SCENES: u32 = 15;

#[derive(Debug, Serialize)]
struct Pass {
    threads: usize,
    scenes: u32,
    features_milliseconds: f64,
    /// Time of the network as it ships: cells without effect on a scene's map are left out.
    forward_milliseconds: f64,
    /// Time of the network with no cells left out: as much work as in any other runtime.
    dense_forward_milliseconds: f64,
}

pub fn run(json: bool) -> Result<(), CommandError> {
    let pass = measure(SCENES)?;
    if json {
        return print_json(&pass);
    }
    let Pass { threads, scenes, features_milliseconds, forward_milliseconds, dense_forward_milliseconds } = pass;
    print(&format!(
        "live on {}, medians of {}: {features_milliseconds:.1} ms features; {forward_milliseconds:.1} ms the network, \
         {dense_forward_milliseconds:.1} ms with nothing left out",
        counted(threads, "thread", "threads"),
        counted(scenes, "scene of set 2", "scenes of set 2")
    ))
}

fn measure(scenes: u32) -> Result<Pass, CommandError> {
    let live = network::live().ok_or_else(|| CommandError("the live network's weights can't be used".into()))?;
    let radar = Radar::default();
    let extractor = FeatureExtractor::new(&radar)?;
    let generator = Generator::new(&radar, Reading::Program, Purpose::Test, 0);
    let mut scratch = LiveScratch::default();
    let mut times = [const { Vec::new() }; 3];
    // The first scene warms up, and isn't counted.
    for number in 0..=scenes {
        let scene = generator.scene(Kind::Set2, number);
        let signal = simulate(&radar, &scene, Floor::Thesis, scene.noise_seed)?;
        let ends = signal.two_ends(&radar);
        let start = Instant::now();
        let input = extractor.extract(&ends)?;
        let features = start.elapsed();
        let start = Instant::now();
        let _map = live.engine().forward(&input, &mut scratch);
        let forward = start.elapsed();
        let start = Instant::now();
        let _map = live.engine().forward_whole(&input, &mut scratch);
        let dense = start.elapsed();
        if number > 0 {
            times.iter_mut().zip([features, forward, dense]).for_each(|(t, d)| t.push(1e3 * d.as_secs_f64()));
        }
    }
    let [features_milliseconds, forward_milliseconds, dense_forward_milliseconds] =
        times.map(|times| upper_median(times).unwrap_or_default());
    let threads = rayon::current_num_threads();
    Ok(Pass { threads, scenes, features_milliseconds, forward_milliseconds, dense_forward_milliseconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_a_pass_takes_time() {
        let pass = measure(1).unwrap();
        assert!(pass.features_milliseconds > 0.0 && pass.forward_milliseconds > 0.0, "{pass:?}");
        assert!(pass.dense_forward_milliseconds > 0.0, "{pass:?}");
    }
}
