//! Raw captures: each is opened as it is, and its echo stands at the true place.

use crate::made_captures::*;
use crate::prelude::*;
use apertura::recording::{FrameLoops, raw};

const FALLING: Chirps = Chirps { start: 81.0, slope: -60.0, samples: 128, rate: 4000.0 };

impl Chirps {
    fn bin_metres(&self) -> f64 {
        C / (2.0 * self.slope.abs() * 1e12 * self.samples as f64 / (self.rate * 1e3))
    }
}

fn folder(bytes: &[u8], cfg: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("c.bin"), bytes).unwrap();
    fs::write(folder.path().join("c.cfg"), cfg).unwrap();
    folder
}

/// The file of a frame of two transmitters in turn.
fn frame(chirps: &Chirps, echo: Echo, loops: usize) -> Vec<u8> {
    two_lanes(samples(chirps, echo, 2, loops).into_iter().flatten())
}

fn opened(bytes: &[u8], cfg: &str) -> Recording {
    raw::open(&folder(bytes, cfg).path().join("c.bin"), None).unwrap()
}

fn assert_found(recording: &Recording, chirps: &Chirps, echo: Echo) {
    let found = found_by("iaa", &recording.radar, &recording.two_ends());
    let range = echo.x.hypot(echo.y);
    let first = found.first().unwrap_or_else(|| panic!("nothing found: {:?}", recording.doubts));
    assert!((first.range_metres - range).abs() < chirps.bin_metres(), "{first:?}, {:?}", recording.doubts);
    let off = first.cos_theta - echo.x / range;
    assert!(off.abs() < 0.03, "{first:?}: {off} off, {:?}", recording.doubts);
}

#[test]
fn rising_with_falling_chirps_give_the_place_at_any_speed() {
    // The loops alone fold 12 m/s to another velocity: 180 us turn it 1.1 times.
    for (chirps, speed, loops) in [(RISING, 0.0, 8), (FALLING, 0.0, 8), (RISING, 5.0, 32), (RISING, 12.0, 32)] {
        let echo = Echo { speed, ..STILL };
        let recording = opened(&frame(&chirps, echo, loops), &cfg(&chirps, &[1, 4], loops, ""));
        assert_found(&recording, &chirps, echo);
    }
}

#[test]
fn four_elements_of_one_transmitter_are_enough() {
    let bytes = two_lanes(samples(&RISING, STILL, 1, 8).into_iter().flatten());
    let recording = opened(&bytes, &cfg(&RISING, &[1], 8, ""));
    assert_eq!((recording.radar.elements, recording.radar.end_elements), (4, 2));
    assert_found(&recording, &RISING, STILL);
}

#[test]
fn transmitters_that_send_both_are_told_apart() {
    let both = samples(&RISING, STILL, 2, 16).into_iter().flat_map(|turn| {
        let mix = |sign: f64| -> Vec<Vec<Complex64>> {
            let rows = turn[0].iter().zip(&turn[1]);
            rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + sign * b).collect()).collect()
        };
        [mix(1.0), mix(-1.0)]
    });
    let recording = opened(&two_lanes(both), &cfg(&RISING, &[3, 3], 16, "bpmCfg -1 1 0 1\n"));
    assert!(recording.doubts.iter().any(|d| d.contains("bpmCfg")), "{:?}", recording.doubts);
    assert_found(&recording, &RISING, STILL);
}

#[test]
fn turned_receivers_with_a_range_bias_are_corrected() {
    let mut turned = samples(&RISING, STILL, 2, 8);
    let bias = 0.5;
    for row in turned.iter_mut().flatten().flat_map(|chirp| chirp.iter_mut().enumerate()) {
        let sign = if row.0 % 2 == 1 { -1.0 } else { 1.0 };
        for (n, v) in row.1.iter_mut().enumerate() {
            *v *= Complex64::from_polar(sign, TAU * RISING.frequency_hz(n) * 2.0 * bias / C);
        }
    }
    let more = format!("compRangeBiasAndRxChanPhase {bias} {}\n", ["1 0 -1 0"; 6].join(" "));
    let bytes = two_lanes(turned.into_iter().flatten());
    assert_found(&opened(&bytes, &cfg(&RISING, &[1, 4], 8, &more)), &RISING, STILL);
}

#[test]
fn real_samples_give_the_place() {
    let rows = samples(&RISING, STILL, 2, 8).into_iter().flatten().flatten().flatten();
    let bytes: Vec<u8> = rows.flat_map(|v| (v.re.round() as i16).to_le_bytes()).collect();
    let text = cfg(&RISING, &[1, 4], 8, "").replace("adcCfg 2 1", "adcCfg 2 0");
    let recording = opened(&bytes, &text);
    assert_eq!(recording.radar.samples, 64);
    assert_found(&recording, &RISING, STILL);
}

#[test]
fn range_with_velocity_of_a_capture_stand_in_its_map() {
    for (chirps, speed) in [(RISING, 3.0), (FALLING, 3.0), (FALLING, -2.0)] {
        let echo = Echo { speed, ..STILL };
        let folder = folder(&frame(&chirps, echo, 32), &cfg(&chirps, &[1, 4], 32, ""));
        let recording = raw::open(&folder.path().join("c.bin"), None).unwrap();
        let FrameLoops { radar, samples, knows_interval } = recording.origin.unwrap().loops().unwrap();
        assert!(knows_interval);
        let map = apertura::maps::doppler::RangeDopplerMap::of(&radar, samples);
        let (bin, column) = map.peak();
        assert!((radar.range_of_bin_metres(bin as f64) - echo.x.hypot(echo.y)).abs() < chirps.bin_metres(), "{bin}");
        let velocity = radar.velocity_of_column_metres_per_second(column as f64);
        assert!((velocity - speed).abs() < radar.velocity_resolution_metres_per_second(), "{velocity}");
    }
}
