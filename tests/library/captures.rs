//! Raw captures, written by the physics of a stretch receiver: each is opened as it is, and its echo stands at the true place.

use crate::prelude::*;
use apertura::recording::{FrameLoops, raw};

const C: f64 = 299_792_458.0;

/// A radar's chirps: start in GHz, slope in MHz/us, samples, rate in ksps.
#[derive(Clone, Copy)]
struct Chirps {
    start: f64,
    slope: f64,
    samples: usize,
    rate: f64,
}

const ADC_US: f64 = 6.0;
const IDLE_US: f64 = 30.0;
const RAMP_US: f64 = 60.0;

impl Chirps {
    fn frequency_hz(&self, sample: usize) -> f64 {
        self.start * 1e9 + self.slope * 1e12 * (ADC_US * 1e-6 + sample as f64 / (self.rate * 1e3))
    }

    fn bin_metres(&self) -> f64 {
        C / (2.0 * self.slope.abs() * 1e12 * self.samples as f64 / (self.rate * 1e3))
    }
}

const RISING: Chirps = Chirps { start: 77.0, slope: 60.0, samples: 128, rate: 4000.0 };
const FALLING: Chirps = Chirps { start: 81.0, slope: -60.0, samples: 128, rate: 4000.0 };

/// Place and speed of an echo, metres and metres a second; the speed is positive where it goes away.
#[derive(Clone, Copy)]
struct Echo {
    x: f64,
    y: f64,
    speed: f64,
}

const STILL: Echo = Echo { x: 1.1, y: 2.3, speed: 0.0 };

/// `[loops][transmitters][receivers][samples]` of one echo over a little noise; transmitters stand two wavelengths apart.
fn samples(chirps: &Chirps, echo: Echo, transmitters: usize, loops: usize) -> Vec<Vec<Vec<Vec<Complex64>>>> {
    let half_wave = C / chirps.frequency_hz(chirps.samples / 2) / 2.0;
    let middle = (4.0 * (transmitters as f64 - 1.0) + 3.0) / 4.0;
    let mut state = 11u32;
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        10.0 * (f64::from(state >> 16) / 65536.0 - 0.5)
    };
    let range = echo.x.hypot(echo.y);
    let mut one = |turn: usize, t: usize, r: usize, n: usize| {
        let grown = 1.0 + echo.speed * (turn * transmitters + t) as f64 * (IDLE_US + RAMP_US) * 1e-6 / range;
        let (x, y) = (echo.x * grown, echo.y * grown);
        let way = |place: f64| (x - (place - middle) * half_wave).hypot(y);
        let path = way(4.0 * t as f64) + way(r as f64);
        Complex64::from_polar(400.0, TAU * chirps.frequency_hz(n) * path / C) + Complex64::new(noise(), noise())
    };
    (0..loops)
        .map(|l| {
            (0..transmitters)
                .map(|t| (0..4).map(|r| (0..chirps.samples).map(|n| one(l, t, r, n)).collect()).collect())
                .collect()
        })
        .collect()
}

fn two_lanes(chirps: impl IntoIterator<Item = Vec<Vec<Complex64>>>) -> Vec<u8> {
    let rows: Vec<Complex64> = chirps.into_iter().flatten().flatten().collect();
    let part = |v: f64| (v.round() as i16).to_le_bytes();
    rows.chunks(2)
        .flat_map(|b| b.iter().map(|v| part(v.re)).chain(b.iter().map(|v| part(v.im))).collect::<Vec<_>>())
        .flatten()
        .collect()
}

fn cfg(chirps: &Chirps, masks: &[u32], loops: usize, more: &str) -> String {
    let Chirps { start, slope, samples, rate } = chirps;
    let all = masks.iter().fold(0, |a, b| a | b);
    let mut text = format!(
        "channelCfg 15 {all} 0\nadcCfg 2 1\nprofileCfg 0 {start} {IDLE_US} {ADC_US} {RAMP_US} 0 0 {slope} 1 {samples} {rate} 0 0 30\n"
    );
    for (n, mask) in masks.iter().enumerate() {
        text += &format!("chirpCfg {n} {n} 0 0 0 0 0 {mask}\n");
    }
    format!("{text}frameCfg 0 {} {loops} 0 100 1 0\n{more}", masks.len() - 1)
}

fn folder(bytes: &[u8], cfg: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("c.bin"), bytes).unwrap();
    fs::write(folder.path().join("c.cfg"), cfg).unwrap();
    folder
}

fn opened(bytes: &[u8], cfg: &str) -> Recording {
    raw::open(&folder(bytes, cfg).path().join("c.bin"), None).unwrap()
}

fn assert_found(recording: &Recording, chirps: &Chirps, echo: Echo) {
    let method = apertura::methods::by_name("iaa").unwrap();
    let request = Request { noise: NoisePrior::UNKNOWN, ..Request::default() };
    let (_, found) = reconstruct_and_find(method.as_ref(), &recording.radar, &recording.two_ends(), &request).unwrap();
    let range = echo.x.hypot(echo.y);
    let first = found.first().unwrap_or_else(|| panic!("nothing found: {:?}", recording.doubts));
    assert!((first.range_metres - range).abs() < chirps.bin_metres(), "{first:?}, {:?}", recording.doubts);
    assert!(
        (first.cos_theta - echo.x / range).abs() < 0.03,
        "{first:?} for {}, {:?}",
        echo.x / range,
        recording.doubts
    );
}

#[test]
fn rising_with_falling_chirps_give_the_place() {
    for chirps in [RISING, FALLING] {
        let bytes = two_lanes(samples(&chirps, STILL, 2, 8).into_iter().flatten());
        assert_found(&opened(&bytes, &cfg(&chirps, &[1, 4], 8, "")), &chirps, STILL);
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
fn motion_between_transmitters_is_taken_out() {
    // 5 m/s, and 12 m/s that the loops alone fold to another velocity: 180 us turn it 1.1 times.
    for speed in [5.0, 12.0] {
        let echo = Echo { speed, ..STILL };
        let bytes = two_lanes(samples(&RISING, echo, 2, 32).into_iter().flatten());
        assert_found(&opened(&bytes, &cfg(&RISING, &[1, 4], 32, "")), &RISING, echo);
    }
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
        let bytes = two_lanes(samples(&chirps, echo, 2, 32).into_iter().flatten());
        let folder = folder(&bytes, &cfg(&chirps, &[1, 4], 32, ""));
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
