//! Raw captures, written by the physics of a stretch receiver.

use num_complex::Complex64;
use std::f64::consts::TAU;

pub const C: f64 = 299_792_458.0;

/// A radar's chirps: start in GHz, slope in MHz/us, samples, rate in ksps.
#[derive(Clone, Copy)]
pub struct Chirps {
    pub start: f64,
    pub slope: f64,
    pub samples: usize,
    pub rate: f64,
}

const ADC_US: f64 = 6.0;
const IDLE_US: f64 = 30.0;
const RAMP_US: f64 = 60.0;

impl Chirps {
    pub fn frequency_hz(&self, sample: usize) -> f64 {
        self.start * 1e9 + self.slope * 1e12 * (ADC_US * 1e-6 + sample as f64 / (self.rate * 1e3))
    }
}

pub const RISING: Chirps = Chirps { start: 77.0, slope: 60.0, samples: 128, rate: 4000.0 };

/// Place and speed of an echo, metres and metres a second; the speed is positive where it goes away.
#[derive(Clone, Copy)]
pub struct Echo {
    pub x: f64,
    pub y: f64,
    pub speed: f64,
}

pub const STILL: Echo = Echo { x: 1.1, y: 2.3, speed: 0.0 };

/// `[loops][transmitters][receivers][samples]` of one echo over a little noise; transmitters stand two wavelengths apart.
pub fn samples(chirps: &Chirps, echo: Echo, transmitters: usize, loops: usize) -> Vec<Vec<Vec<Vec<Complex64>>>> {
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

pub fn two_lanes(chirps: impl IntoIterator<Item = Vec<Vec<Complex64>>>) -> Vec<u8> {
    let rows: Vec<Complex64> = chirps.into_iter().flatten().flatten().collect();
    let part = |v: f64| (v.round() as i16).to_le_bytes();
    rows.chunks(2)
        .flat_map(|b| b.iter().map(|v| part(v.re)).chain(b.iter().map(|v| part(v.im))).collect::<Vec<_>>())
        .flatten()
        .collect()
}

pub fn cfg(chirps: &Chirps, masks: &[u32], loops: usize, more: &str) -> String {
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
