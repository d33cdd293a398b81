//! Distributions of strengths and steps, and curves through the field, for the world's scenes.

use crate::scene::shape::direction;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal};
use std::ops::Range;

pub(super) const MAX_DYNAMIC_DECIBELS: f64 = 60.0;

pub(super) type GroundPlace = [f64; 2];

/// Distribution of the relative strengths in a group of points.
#[derive(Debug, Clone, Copy)]
pub(super) enum Strengths {
    Equal,
    Rayleigh,
    LogNormal { deviation_decibels: f64 },
    FewStrong { share: f64, weak_decibels: f64 },
    Uniform { range_decibels: f64 },
}

impl Strengths {
    pub(super) fn random(rng: &mut ChaCha8Rng) -> Self {
        match rng.random_range(0..6) {
            0 | 1 => Strengths::Equal,
            2 => Strengths::Rayleigh,
            3 => Strengths::LogNormal { deviation_decibels: rng.random_range(1.0..12.0) },
            4 => Strengths::FewStrong {
                share: log_uniform(0.01..0.3, rng),
                weak_decibels: rng.random_range(-40.0..-10.0),
            },
            _ => Strengths::Uniform { range_decibels: rng.random_range(3.0..MAX_DYNAMIC_DECIBELS) },
        }
    }

    pub(super) fn decibels(self, rng: &mut ChaCha8Rng) -> f64 {
        let normal = |rng: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(rng) };
        match self {
            Strengths::Equal => 0.0,
            Strengths::Rayleigh => {
                let power: f64 = Exp1.sample(rng);
                10.0 * power.max(1e-6).log10()
            }
            Strengths::LogNormal { deviation_decibels } => deviation_decibels * normal(rng),
            Strengths::FewStrong { share, .. } if rng.random::<f64>() < share => 0.0,
            Strengths::FewStrong { weak_decibels, .. } => weak_decibels + 3.0 * normal(rng),
            Strengths::Uniform { range_decibels } => -range_decibels * rng.random::<f64>(),
        }
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Steps {
    Equal,
    Jittered(f64),
    /// Exponential: the points are a Poisson process.
    Poisson,
}

impl Steps {
    pub(super) fn random(rng: &mut ChaCha8Rng) -> Self {
        match rng.random_range(0..3) {
            0 => Steps::Equal,
            1 => Steps::Jittered(rng.random_range(0.02..0.5)),
            _ => Steps::Poisson,
        }
    }

    pub(super) fn next(self, rng: &mut ChaCha8Rng) -> f64 {
        match self {
            Steps::Equal => 1.0,
            Steps::Jittered(part) => 1.0 + rng.random_range(-part..part),
            Steps::Poisson => Exp1.sample(rng),
        }
    }
}

/// A curve through the field: straight, an arc, or with a bend.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    start: GroundPlace,
    heading_degrees: f64,
    degrees_per_metre: f64,
    /// Distance after which the curve bends, metres, and the angle of the bend, degrees.
    bend: Option<[f64; 2]>,
}

impl Track {
    pub(super) fn random(start: GroundPlace, length_metres: f64, rng: &mut ChaCha8Rng) -> Self {
        // Most structures along a road lead nearly straight ahead.
        let heading_degrees = match rng.random_range(0..10) {
            0..=2 => 90.0,
            3..=5 => 90.0 + rng.random_range(-20.0..20.0),
            _ => rng.random_range(0.0..360.0),
        };
        let (mut degrees_per_metre, mut bend) = (0.0, None);
        match rng.random_range(0..10) {
            0..=4 => {}
            5..=7 => degrees_per_metre = rng.random_range(-270.0..270.0) / length_metres,
            _ => bend = Some([length_metres * rng.random_range(0.2..0.8), rng.random_range(-120.0..120.0)]),
        }
        Track { start, heading_degrees, degrees_per_metre, bend }
    }

    /// Points after these steps, `side_metres` to the left of the curve.
    pub(super) fn points(&self, steps_metres: impl IntoIterator<Item = f64>, side_metres: f64) -> Vec<GroundPlace> {
        let ([mut x, mut y], mut gone) = (self.start, 0.0);
        let step = |length: f64| {
            let turned = self.bend.filter(|[after, _]| gone > *after).map_or(0.0, |[_, degrees]| degrees);
            let [cos, sin] = direction(self.heading_degrees + self.degrees_per_metre * gone + turned);
            let place = [x - side_metres * sin, y + side_metres * cos];
            (x, y, gone) = (x + length * cos, y + length * sin, gone + length);
            place
        };
        steps_metres.into_iter().map(step).collect()
    }
}

pub(super) fn log_uniform(range: Range<f64>, rng: &mut ChaCha8Rng) -> f64 {
    range.start * (range.end / range.start).powf(rng.random())
}
