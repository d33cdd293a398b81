//! Scenes apart from all training and tuning: a test of how well choices generalise. No code is shared with other generators, which may change.

use crate::scene::{Object, Point};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

type Place = [f64; 2];

/// A kind of scene for tests alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Beyond {
    /// 1 to 3 walls of 10 to 100 points at 0.4 to 4 range bins: jittered, bent and broken as it comes, and up to 2 points.
    Walls,
    /// Two straight walls that cross, each with steps of its own.
    Crossing,
    /// 1 to 3 clusters of 10 to 100 points within an ellipse, along a ring, in a square or along two sides of it, with Rayleigh amplitudes.
    Clusters,
    /// 3 to 8 points whose echoes are up to 60 dB apart.
    Faint,
    /// 3 to 8 points within one range bin, and up to 2 elsewhere.
    Ring,
    /// 10 to 300 points anywhere, uniform in decibels from -20 to 0 dB.
    Many,
}

impl Beyond {
    /// Every kind.
    pub const ALL: [Beyond; 6] =
        [Beyond::Walls, Beyond::Crossing, Beyond::Clusters, Beyond::Faint, Beyond::Ring, Beyond::Many];

    /// The name on the command line, and the objects of such a scene.
    pub(super) fn entry(self) -> (&'static str, &'static str) {
        match self {
            Beyond::Walls => ("beyond-walls", "walls at any step, jittered, bent and broken"),
            Beyond::Crossing => ("beyond-crossing", "two walls that cross"),
            Beyond::Clusters => ("beyond-clusters", "clusters of any shape"),
            Beyond::Faint => ("beyond-faint", "points up to 60 dB apart"),
            Beyond::Ring => ("beyond-ring", "points within one range bin"),
            Beyond::Many => ("beyond-many", "10 to 300 points"),
        }
    }
}

/// Points of a wall or a cluster, steps along a wall in range bins, and points of a crowd.
const GROUP_POINTS: Range<f64> = 10.0..101.0;
const STEP_BINS: Range<f64> = 0.4..4.0;
const CROWD_POINTS: Range<f64> = 10.0..301.0;
/// Nearest and farthest range of a place, metres and part of the maximum range.
const NEAREST_METRES: f64 = 2.0;
const MAX_RANGE_PART: f64 = 0.93;
/// Least sine of the angle to the array's axis.
const MIN_AXIS_SINE: f64 = 0.1;
/// Most that a step of a jittered wall is off, and most turn of a bent wall from its one end to the other.
const MAX_JITTER: f64 = 0.4;
const MAX_TURN_RADIANS: f64 = 1.2;
/// Places that are tried for a wall or a cluster before one that leaves the field in part is taken.
const MAX_PLACE_TRIES: usize = 40;

#[derive(Debug, Clone, Copy)]
pub(super) struct BeyondField {
    pub max_range_metres: f64,
    pub bin_metres: f64,
}

impl BeyondField {
    /// The objects of a scene; at least one.
    pub fn objects(&self, kind: Beyond, rng: &mut ChaCha8Rng) -> Vec<Object> {
        let points = match kind {
            Beyond::Walls => {
                let mut points = self.groups(rng, BeyondField::wall);
                points.extend((0..rng.random_range(0..=2)).map(|_| echo(self.place(rng), 1.0)));
                points
            }
            Beyond::Crossing => self.crossing(rng),
            Beyond::Clusters => self.groups(rng, BeyondField::cluster),
            Beyond::Faint => {
                let decibels = |i: i32, rng: &mut ChaCha8Rng| if i == 0 { 0.0 } else { rng.random_range(-60.0..0.0) };
                (0..rng.random_range(3..=8)).map(|i| echo(self.place(rng), amplitude(decibels(i, rng)))).collect()
            }
            Beyond::Ring => self.ring(rng),
            Beyond::Many => {
                let count = log_uniform(CROWD_POINTS, rng) as usize;
                (0..count).map(|_| echo(self.place(rng), amplitude(rng.random_range(-20.0..0.0)))).collect()
            }
        };
        points.into_iter().map(Object::Point).collect()
    }

    fn groups(&self, rng: &mut ChaCha8Rng, draw: fn(&Self, &mut ChaCha8Rng) -> Vec<Point>) -> Vec<Point> {
        let of_field = |rng: &mut ChaCha8Rng| {
            let mut points = Vec::new();
            for _ in 0..MAX_PLACE_TRIES {
                points = draw(self, rng);
                let drawn = points.len();
                points.retain(|p| self.holds([p.x_metres, p.y_metres]));
                if points.len() == drawn {
                    break;
                }
            }
            points
        };
        let mut points: Vec<Point> = (0..rng.random_range(1..=3)).flat_map(|_| of_field(rng)).collect();
        if points.is_empty() {
            points.push(echo(self.place(rng), 1.0));
        }
        points
    }

    fn wall(&self, rng: &mut ChaCha8Rng) -> Vec<Point> {
        let count = log_uniform(GROUP_POINTS, rng) as usize;
        let step = self.bin_metres * log_uniform(STEP_BINS, rng);
        let jitter = if rng.random() { 0.0 } else { rng.random_range(0.0..MAX_JITTER) };
        let turn = if rng.random() { 0.0 } else { rng.random_range(-MAX_TURN_RADIANS..MAX_TURN_RADIANS) };
        let broken = rng.random::<f64>() < 0.4;
        let gap = (rng.random_range(0..count), count / 5);
        let ([mut x, mut y], mut angle) = (self.place(rng), rng.random_range(0.0..PI));
        let mut points = Vec::new();
        for i in 0..count {
            if !(broken && (gap.0..gap.0 + gap.1).contains(&i)) {
                points.push(echo([x, y], 1.0));
            }
            let length = step * (1.0 + jitter * rng.random_range(-1.0..1.0));
            (x, y) = (x + length * angle.cos(), y + length * angle.sin());
            angle += turn / count as f64;
        }
        points
    }

    fn crossing(&self, rng: &mut ChaCha8Rng) -> Vec<Point> {
        let [x, y] = self.place(rng);
        let first = rng.random_range(0.0..PI);
        let mut points = Vec::new();
        for angle in [first, first + rng.random_range(0.3..PI - 0.3)] {
            let count = log_uniform(GROUP_POINTS, rng) as usize;
            let step = self.bin_metres * log_uniform(STEP_BINS, rng);
            let before = rng.random_range(0.2..0.8) * count as f64;
            let at = |i: usize| (i as f64 - before) * step;
            points.extend((0..count).map(|i| echo([x + at(i) * angle.cos(), y + at(i) * angle.sin()], 1.0)));
        }
        points.retain(|p| self.holds([p.x_metres, p.y_metres]));
        if points.is_empty() {
            points.push(echo([x, y], 1.0));
        }
        points
    }

    fn cluster(&self, rng: &mut ChaCha8Rng) -> Vec<Point> {
        let [x, y] = self.place(rng);
        let [long, wide] = [0, 1].map(|_| log_uniform(0.2..3.0, rng));
        let (turn, shape) = (TAU * rng.random::<f64>(), rng.random_range(0..4));
        let count = log_uniform(GROUP_POINTS, rng) as usize;
        let point = |_| {
            let angle = TAU * rng.random::<f64>();
            let mut side = || rng.random_range(-1.0..1.0f64);
            let [u, v] = match shape {
                0 => {
                    let radius = f64::abs(side()).sqrt();
                    [radius * angle.cos(), radius * angle.sin()]
                }
                1 => [angle.cos(), angle.sin()],
                2 => [side(), side()],
                _ if side() < 0.0 => [side(), -1.0],
                _ => [-1.0, side()],
            };
            let [u, v] = [long * u, wide * v];
            let place = [x + u * turn.cos() - v * turn.sin(), y + u * turn.sin() + v * turn.cos()];
            let [a, b]: [f64; 2] = [0, 1].map(|_| StandardNormal.sample(rng));
            echo(place, a.hypot(b).max(0.01))
        };
        (0..count).map(point).collect()
    }

    fn ring(&self, rng: &mut ChaCha8Rng) -> Vec<Point> {
        let range = rng.random_range(NEAREST_METRES..MAX_RANGE_PART * self.max_range_metres);
        let most = (1.0 - MIN_AXIS_SINE * MIN_AXIS_SINE).sqrt();
        let at = |rng: &mut ChaCha8Rng| {
            let range = range + self.bin_metres * rng.random_range(-0.5..0.5);
            let cos: f64 = rng.random_range(-most..most);
            echo([range * cos, range * (1.0 - cos * cos).sqrt()], 1.0)
        };
        let mut points: Vec<Point> = (0..rng.random_range(3..=8)).map(|_| at(rng)).collect();
        points.extend((0..rng.random_range(0..=2)).map(|_| echo(self.place(rng), 1.0)));
        points
    }

    fn place(&self, rng: &mut ChaCha8Rng) -> Place {
        let range = rng.random_range(NEAREST_METRES..MAX_RANGE_PART * self.max_range_metres);
        let margin = MIN_AXIS_SINE.asin();
        let angle = rng.random_range(margin..PI - margin);
        [range * angle.cos(), range * angle.sin()]
    }

    fn holds(&self, [x, y]: Place) -> bool {
        let range = x.hypot(y);
        (NEAREST_METRES..=MAX_RANGE_PART * self.max_range_metres).contains(&range) && y >= MIN_AXIS_SINE * range
    }
}

fn echo([x, y]: Place, reflectivity: f64) -> Point {
    Point { reflectivity, ..Point::new(x, y) }
}

fn amplitude(decibels: f64) -> f64 {
    10f64.powf(decibels / 20.0)
}

fn log_uniform(range: Range<f64>, rng: &mut ChaCha8Rng) -> f64 {
    rng.random_range(range.start.ln()..range.end.ln()).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Radar;
    use crate::scene::Scene;
    use crate::scene::generate::{Generator, Kind, Purpose, Reading};

    fn scenes(kind: Beyond, count: u32) -> Vec<Scene> {
        let generator = Generator::new(&Radar::default(), Reading::Program, Purpose::Test, 12_000);
        (0..count).map(|number| generator.scene(Kind::Beyond(kind), number)).collect()
    }

    #[test]
    fn every_scene_is_valid_and_of_its_size() {
        for (kind, most) in Beyond::ALL.into_iter().zip([302, 200, 300, 8, 10, 300]) {
            for (number, scene) in scenes(kind, 200).iter().enumerate() {
                scene.validate(&Radar::default()).unwrap_or_else(|e| panic!("{kind:?} {number}: {e}"));
                let count = scene.reflector_count();
                assert!((1..=most).contains(&count), "{kind:?} {number}: {count}");
            }
        }
    }

    #[test]
    fn points_of_a_ring_share_a_range_bin() {
        let bin = Radar::default().range_resolution_metres();
        for scene in scenes(Beyond::Ring, 50) {
            let ranges: Vec<f64> = scene.reflectors().iter().take(3).map(|r| r.x_metres.hypot(r.y_metres)).collect();
            let spread = ranges.iter().fold(0.0, |a: f64, r| a.max(r - ranges[0]).max(ranges[0] - r));
            assert!(spread <= bin, "{spread} m");
        }
    }

    #[test]
    fn faint_echoes_reach_40_decibels_below_the_strongest() {
        let of = |scene: &Scene| {
            let all: Vec<f64> = scene.reflectors().iter().map(|r| 20.0 * r.reflectivity.log10()).collect();
            all.iter().fold(0.0, |a: f64, d| a.min(*d))
        };
        let spreads: Vec<f64> = scenes(Beyond::Faint, 100).iter().map(of).collect();
        assert!(spreads.iter().all(|d| (-60.0..=0.0).contains(d)));
        assert!(spreads.iter().filter(|d| **d < -40.0).count() > 30);
    }
}
