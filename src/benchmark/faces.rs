//! Run time against error of a face's samples: three echoes in closed form, the same with the change of their amplitudes over the sweep, and
//! quadrature of physical optics in coarser and finer panels.

use super::times::quantile;
use crate::platform::Instant;
use crate::radar::Radar;
use crate::scattering::{AntennaPlaces, PathEcho, Scatterer, reference};
use crate::scene::{Object, Wall};
use num_complex::Complex64;
use serde::Serialize;
use std::fmt;

/// Elements and samples that are compared are so many apart.
const JUDGED_STRIDE: usize = 16;
const REPEATS: usize = 5;
/// Phase over a panel of the quadrature that errors are told against, radians; the rule has 8 points a panel.
const FINEST_RADIANS: f64 = 1.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FaceFormula {
    /// A glint and two ends, of constant amplitudes: what the program does.
    ClosedForm,
    /// The same with amplitudes that change over the sweep.
    Tilted,
    /// Quadrature whose panels span this phase of the way there and back, radians.
    Quadrature(f64),
}

impl FaceFormula {
    pub const ALL: [FaceFormula; 5] = [
        FaceFormula::ClosedForm,
        FaceFormula::Tilted,
        FaceFormula::Quadrature(20.0),
        FaceFormula::Quadrature(16.0),
        FaceFormula::Quadrature(8.0),
    ];
}

impl fmt::Display for FaceFormula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FaceFormula::ClosedForm => f.pad("three echoes"),
            FaceFormula::Tilted => f.pad("echoes, tilted"),
            FaceFormula::Quadrature(radians) => f.pad(&format!("quadrature, {radians} rad")),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FaceRow {
    pub face: &'static str,
    /// [`FaceFormula`] as text.
    pub way: String,
    /// Largest error of a sample over the largest sample.
    pub error: f64,
    /// Median time of an element's 32 samples, microseconds.
    pub microseconds: f64,
}

/// Faces with and without a glint, from square to grazing: what they are called, their ends in metres.
const FACES: [(&str, [[f64; 2]; 2]); 5] = [
    ("4 m, foot in the middle, at 10 m", [[-2.0, 10.0], [2.0, 10.0]]),
    ("1 m, foot in the middle, at 1 m", [[-0.5, 1.0], [0.5, 1.0]]),
    ("4 m, foot at an end, at 20 m", [[0.0, 20.0], [4.0, 20.0]]),
    ("6 m beside the foot, at 5 m", [[3.0, 5.0], [9.0, 5.0]]),
    ("10 m along the road, 4 m beside it", [[4.0, 6.0], [4.0, 16.0]]),
];

pub fn measure(radar: &Radar) -> Vec<FaceRow> {
    let samples: Vec<usize> = (0..radar.samples).step_by(JUDGED_STRIDE).collect();
    let elements: Vec<AntennaPlaces> =
        (0..radar.elements).step_by(JUDGED_STRIDE * 4).map(|n| radar.pair(n).into()).collect();
    let mut rows = Vec::new();
    for (face, ends) in FACES {
        let of = |way: FaceFormula| -> Vec<Complex64> {
            elements.iter().flat_map(|antennas| way.samples(radar, ends, antennas, &samples)).collect()
        };
        let exact = of(FaceFormula::Quadrature(FINEST_RADIANS));
        let peak = exact.iter().map(|v| v.norm()).fold(f64::MIN_POSITIVE, f64::max);
        for way in FaceFormula::ALL {
            let (mut times, mut found) = (Vec::new(), Vec::new());
            for _ in 0..REPEATS {
                let start = Instant::now();
                found = of(way);
                times.push(1e6 * start.elapsed().as_secs_f64() / elements.len() as f64);
            }
            let off = found.iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            rows.push(FaceRow {
                face,
                way: way.to_string(),
                error: off / peak,
                microseconds: quantile(&mut times, 0.5),
            });
        }
    }
    rows
}

impl FaceFormula {
    fn samples(
        self,
        radar: &Radar,
        ends: [[f64; 2]; 2],
        antennas: &AntennaPlaces,
        samples: &[usize],
    ) -> Vec<Complex64> {
        if let FaceFormula::Quadrature(radians) = self {
            return reference::face(radar, ends, 1.0, antennas, samples, radians);
        }
        let [a, b] = ends;
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let wall = Wall::new((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0, dx.hypot(dy), dy.atan2(dx).to_degrees());
        let mut echoes = Vec::new();
        Scatterer::new(radar, &Object::Wall(wall), &[]).echoes(antennas, &mut echoes);
        let middle = reference::radians_per_metre(radar, radar.middle_sample()).abs();
        let sample = |n: &usize| {
            let kappa = reference::radians_per_metre(radar, *n as f64);
            let more = if self == FaceFormula::Tilted { kappa.abs() - middle } else { 0.0 };
            let add = |e: &PathEcho| (e.amplitude + e.tilt * more) * Complex64::cis(-kappa * e.range_metres);
            echoes.iter().map(add).sum()
        };
        samples.iter().map(sample).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_terms_are_nearer_to_quadrature_on_every_face() {
        let rows = measure(&Radar { elements: 128, ..Radar::default() });
        assert_eq!(rows.len(), FACES.len() * FaceFormula::ALL.len());
        for row in rows.chunks(FaceFormula::ALL.len()) {
            let [plain, tilted, .., finest] = row else { panic!("one row a way") };
            assert!(plain.error < 0.03 && tilted.error < plain.error, "{plain:?} {tilted:?}");
            assert!(finest.error < 1e-6 && finest.microseconds > tilted.microseconds, "{finest:?}");
        }
    }
}
