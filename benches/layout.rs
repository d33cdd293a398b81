//! Times of the search for a capture's layout, beside a transform of as much: `cargo bench --bench layout`.
//!
//! With the counts of a `.cfg` 1 MB is to take at most 0.06 s on two cores; without one 4 MB at most 2 s.

use apertura::maps::channels_range_transform;
use apertura::radar::Radar;
use apertura::recording::RadarProfile;
use apertura::recording::layout::{find, stream::CaptureStream};
use ndarray::Array2;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::io::Cursor;
use std::time::Instant;

const SAMPLES: usize = 256;
const RUNS: usize = 7;

/// A `.cfg` of four receivers, 256 samples and 64 chirps a frame.
const CONFIG: &str = "channelCfg 15 1 0\nadcCfg 2 1\nadcbufCfg -1 0 0 1 1\nprofileCfg 0 77 7 7 58 0 0 68 1 256 5500 0 0 30\n\
                      chirpCfg 0 0 0 0 0 0 0 1\nframeCfg 0 0 64 0 100 1 0\n";

/// Samples of two echoes over noise, receiver after receiver.
fn samples(count: usize) -> Vec<Complex64> {
    let mut state = 7u32;
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 16) / 2048.0 - 16.0
    };
    let echo = |n: usize, bin: f64, power: f64| {
        let (sample, receiver) = ((n % SAMPLES) as f64, (n / SAMPLES % 4) as f64);
        Complex64::from_polar(power, TAU * (bin * sample / SAMPLES as f64 + 0.013 * bin * receiver))
    };
    (0..count).map(|n| echo(n, 31.4, 900.0) + echo(n, 77.7, 300.0) + Complex64::new(noise(), noise())).collect()
}

/// The shortest of several runs, seconds.
fn shortest(mut work: impl FnMut()) -> f64 {
    let run = |_| {
        let started = Instant::now();
        work();
        started.elapsed().as_secs_f64()
    };
    (0..RUNS).map(run).fold(f64::INFINITY, f64::min)
}

fn main() {
    let profile = RadarProfile::parse(CONFIG).expect("a .cfg of this file");
    for (megabytes, profile, most) in [(1, Some(&profile), 0.06), (4, None, 2.0)] {
        let numbers = samples(megabytes << 18);
        let bytes: Vec<u8> =
            numbers.iter().flat_map(|v| [v.re as i16, v.im as i16]).flat_map(i16::to_le_bytes).collect();
        let mut stream = CaptureStream::new(Cursor::new(bytes)).expect("bytes in memory");
        let search = shortest(|| assert!(find(&mut stream, profile).is_ok()));
        let radar = Radar { samples: SAMPLES, ..Radar::default() };
        let rows = Array2::from_shape_vec((numbers.len() / SAMPLES, SAMPLES), numbers).expect("whole rows");
        let transform =
            shortest(|| assert!(channels_range_transform(&radar, rows.view()).profiles.len() == rows.len()));
        let with = if profile.is_some() { "with" } else { "without" };
        println!(
            "{megabytes} MB {with} a .cfg: {search:.3} s (at most {most} s), {:.0} times a transform of the same samples ({transform:.4} s)",
            search / transform
        );
    }
}
