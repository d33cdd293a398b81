//! How long the layout of a raw capture takes to find.

use crate::commands::{CommandError, print};
use crate::recording::RadarProfile;
use crate::recording::layout::{Found, find, stream::Stream};
use serde::Serialize;
use std::f64::consts::TAU;
use std::io::Cursor;
use std::time::Instant;

const SAMPLES: usize = 256;
const RECEIVERS: usize = 4;
/// Its size where a `.cfg` says its counts, and where none does, bytes.
const WITH_CONFIG: usize = 1 << 20;
const WITHOUT: usize = 4 << 20;
const TIMES: usize = 5;

/// What sets such a radar up.
const CONFIG: &str = "channelCfg 15 5 0\nadcCfg 2 1\nprofileCfg 0 77 30 6 80 0 0 60 1 256 4000 0 0 30\nchirpCfg 0 0 0 0 0 0 0 1\n\
                      chirpCfg 1 1 0 0 0 0 0 4\nframeCfg 0 1 32 0 100 1 0\n";

#[derive(Debug, Serialize)]
pub struct CaptureRow {
    name: &'static str,
    bytes: usize,
    layouts: usize,
    median_ms: f64,
}

/// Measures both, and prints a line each or one JSON list.
pub fn run(json: bool) -> Result<(), CommandError> {
    let rows = measure()?;
    if json {
        return print(&serde_json::to_string_pretty(&rows).map_err(CommandError::failed)?);
    }
    rows.iter().try_for_each(|row| {
        let CaptureRow { name, bytes, layouts, median_ms } = row;
        print(&format!("{name}: {layouts} layouts of {} MiB in {median_ms:.1} ms", bytes >> 20))
    })
}

fn measure() -> Result<Vec<CaptureRow>, CommandError> {
    let profile = RadarProfile::parse(CONFIG).map_err(CommandError::failed)?;
    let with = timed("with a .cfg", WITH_CONFIG, Some(&profile))?;
    Ok(vec![with, timed("without a .cfg", WITHOUT, None)?])
}

fn timed(name: &'static str, bytes: usize, profile: Option<&RadarProfile>) -> Result<CaptureRow, CommandError> {
    let capture = capture(bytes);
    let (mut times, mut layouts) = (Vec::new(), 0);
    for _ in 0..TIMES {
        let begin = Instant::now();
        let mut stream = Stream::new(Cursor::new(&capture)).map_err(CommandError::failed)?;
        let Found { candidates, .. } = find(&mut stream, profile).map_err(CommandError::failed)?;
        times.push(1e3 * begin.elapsed().as_secs_f64());
        layouts = candidates.len();
    }
    times.sort_by(f64::total_cmp);
    Ok(CaptureRow { name, bytes, layouts, median_ms: times[TIMES / 2] })
}

fn capture(bytes: usize) -> Vec<u8> {
    let mut state = 3u32;
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        16.0 * (f64::from(state >> 16) / 65536.0 - 0.5)
    };
    let mut words = Vec::with_capacity(bytes / 2);
    for pair in 0..bytes / 8 {
        let mut block = [0i16; 4];
        for lane in 0..2 {
            let n = 2 * pair + lane;
            let (sample, receiver) = (n % SAMPLES, n / SAMPLES % RECEIVERS);
            let phase = |bin: f64, across: f64| TAU * (bin * sample as f64 / SAMPLES as f64 + across * receiver as f64);
            let echoes = [(800.0, 20.3, 0.1), (400.0, 47.8, -0.3), (200.0, 90.1, 0.22)];
            let sum = |part: fn(f64) -> f64| {
                echoes.iter().map(|(a, bin, across)| a * part(phase(*bin, *across))).sum::<f64>()
            };
            block[lane] = (sum(f64::cos) + noise()) as i16;
            block[lane + 2] = (sum(f64::sin) + noise()) as i16;
        }
        words.extend(block.into_iter().flat_map(i16::to_le_bytes));
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_searches_find_the_layout_that_was_written() {
        let profile = RadarProfile::parse(CONFIG).unwrap();
        for profile in [Some(&profile), None] {
            let found = find(&mut Stream::new(Cursor::new(capture(WITH_CONFIG))).unwrap(), profile).unwrap();
            let best = found.best();
            assert_eq!(
                (best.layout.parts.name(), best.counts.samples, best.counts.receivers),
                ("two-lanes", SAMPLES, RECEIVERS)
            );
        }
    }
}
