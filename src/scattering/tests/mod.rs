//! The formulas against vectors, quadrature and series, and laws that hold for any scene.

mod hiding;
mod laws;
mod reference;
mod references;

use super::*;
use crate::radar::Radar;
use crate::scene::{Object, Scene};

const SAMPLES: [usize; 5] = [0, 100, 255, 400, 511];

fn samples(radar: &Radar, echoes: &[PathEcho]) -> Vec<Complex64> {
    let sample = |n: &usize| {
        let kappa = reference::radians_per_metre(radar, *n as f64);
        echoes.iter().map(|e| e.amplitude * Complex64::cis(-kappa * e.range_metres)).sum()
    };
    SAMPLES.iter().map(sample).collect()
}

fn worst(found: &[Complex64], expected: &[Complex64]) -> f64 {
    let peak = expected.iter().map(|v| v.norm()).fold(0.0, f64::max);
    found.iter().zip(expected).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / peak
}

fn heard(radar: &Radar, objects: &[Object], antennas: &AntennaPlaces) -> Vec<PathEcho> {
    let scene = Scene { objects: objects.to_vec(), ..Scene::default() };
    let mut out = Vec::new();
    for one in ObjectWithOccluders::all(radar, &scene) {
        one.scatterer(radar).echoes(antennas, &mut out);
    }
    out
}

fn largest_step(of: impl Fn(f64) -> Vec<Complex64>, from: f64, steps: u32) -> f64 {
    let (mut worst, mut peak) = (0.0f64, 0.0f64);
    let mut before: Option<Vec<Complex64>> = None;
    for i in 0..steps {
        let now = of(from + 1e-4 * f64::from(i));
        peak = now.iter().map(|v| v.norm()).fold(peak, f64::max);
        if let Some(before) = before {
            worst = before.iter().zip(&now).map(|(a, b)| (a - b).norm()).fold(worst, f64::max);
        }
        before = Some(now);
    }
    worst / peak
}

/// Echoes at the middle of the chirp, each freed of the phase of a way that many share.
fn at_range(echoes: &[PathEcho], kappa: f64, range: f64) -> Vec<Complex64> {
    vec![echoes.iter().map(|e| e.amplitude * Complex64::cis(-kappa * (e.range_metres - range))).sum()]
}
