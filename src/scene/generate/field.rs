//! Random scenes of the named kinds beside the thesis' sets.

use super::Kind;
use crate::scene::{GaussianCluster, Line, Object, Point};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

const NEAREST_METRES: f64 = 2.0;
const MAX_RANGE_PART: f64 = 0.95;
const AXIS_MARGIN_DEGREES: f64 = 5.0;
/// Least number of points in two rows.
const MIN_FENCE_POINTS: usize = 40;

#[derive(Debug, Clone, Copy)]
pub(super) struct PlacementField {
    pub max_range_metres: f64,
    pub bin_metres: f64,
}

impl PlacementField {
    /// The objects of a scene of `kind`, one of [`Kind::VARIED_KINDS`] or [`Kind::IRREGULAR_KINDS`]; none for the others.
    pub fn objects(&self, kind: Kind, rng: &mut ChaCha8Rng) -> Vec<Object> {
        let mut objects: Vec<Object> = match kind {
            Kind::Clusters => (0..rng.random_range(1..=3)).map(|_| self.cluster(rng)).collect(),
            Kind::Walls => (0..rng.random_range(1..=3))
                .map(|_| {
                    let direction = rng.random_range(0.0..360.0);
                    self.line(direction, self.spacing(rng, 3.0), 20..=100, rng)
                })
                .collect(),
            Kind::Spacings => {
                (0..rng.random_range(1..=3)).map(|_| self.line(90.0, self.other_spacing(rng), 20..=100, rng)).collect()
            }
            Kind::Corner => {
                let mut objects = self.corner(rng);
                objects.push(self.cluster(rng));
                objects
            }
            Kind::Crowd => (0..rng.random_range(12..=40)).map(|_| self.point(1.0, rng)).collect(),
            Kind::Dynamic => (0..5)
                .map(|i| {
                    let decibels = if i == 0 { 0.0 } else { rng.random_range(-40.0..0.0) };
                    self.point(10f64.powf(decibels / 20.0), rng)
                })
                .collect(),
            Kind::Near => (0..rng.random_range(1..=3)).map(|_| near_point(rng)).collect(),
            Kind::Fences => self.fences(rng),
            Kind::Rain => (0..rng.random_range(1..=4)).map(|_| self.point(1.0, rng)).collect(),
            _ => Vec::new(),
        };
        let points = match kind {
            Kind::Clusters | Kind::Walls | Kind::Spacings => rng.random_range(1..=3),
            Kind::Corner => 1,
            Kind::Fences => rng.random_range(0..=3),
            _ => 0,
        };
        objects.extend((0..points).map(|_| self.point(1.0, rng)));
        if kind == Kind::Rain {
            objects.extend((0..rng.random_range(60..=240)).map(|_| self.weak_point(rng)));
        }
        objects
    }

    fn place(&self, rng: &mut ChaCha8Rng) -> [f64; 2] {
        polar(rng.random_range(NEAREST_METRES..MAX_RANGE_PART * self.max_range_metres), AXIS_MARGIN_DEGREES, rng)
    }

    fn point(&self, reflectivity: f64, rng: &mut ChaCha8Rng) -> Object {
        let [x_metres, y_metres] = self.place(rng);
        Object::Point(Point { reflectivity, ..Point::new(x_metres, y_metres) })
    }

    fn weak_point(&self, rng: &mut ChaCha8Rng) -> Object {
        self.point(10f64.powf(rng.random_range(-40.0..-10.0) / 20.0), rng)
    }

    /// Two parallel rows of points in the field, on either side of a way that leads ahead or up to 20 degrees to the side.
    fn fences(&self, rng: &mut ChaCha8Rng) -> Vec<Object> {
        loop {
            let direction = (90.0 + rng.random_range(-20.0..20.0f64)).to_radians();
            let [along, across] = [[direction.cos(), direction.sin()], [direction.sin(), -direction.cos()]];
            let (left, width) = (-rng.random_range(1.5..12.0), rng.random_range(3.0..16.0));
            let (start, end) =
                (rng.random_range(2.0..12.0), rng.random_range(18.0..MAX_RANGE_PART * self.max_range_metres));
            let step = rng.random_range(0.1..0.6);
            let row = |side: f64, rng: &mut ChaCha8Rng| {
                let (mut at, mut places) = (start, Vec::new());
                while at < end {
                    places.push([0, 1].map(|axis| side * across[axis] + at * along[axis]));
                    at += step * (1.0 + rng.random_range(-0.45..0.45));
                }
                places
            };
            let mut places = row(left, rng);
            places.extend(row(left + width, rng));
            places.retain(|place| self.holds(*place));
            if places.len() >= MIN_FENCE_POINTS {
                return places.into_iter().map(|[x, y]| Object::Point(Point::new(x, y))).collect();
            }
        }
    }

    fn cluster(&self, rng: &mut ChaCha8Rng) -> Object {
        let [x_metres, y_metres] = self.place(rng);
        let std = [rng.random_range(0.2..1.0), rng.random_range(0.2..1.0)];
        let cluster = GaussianCluster::new([x_metres, y_metres], std, rng.random_range(15..=40));
        Object::Gaussian(GaussianCluster { seed: rng.random(), ..cluster })
    }

    fn spacing(&self, rng: &mut ChaCha8Rng, most_bins: f64) -> f64 {
        rng.random_range(0.5..most_bins) * self.bin_metres
    }

    /// A spacing that the thesis' lines don't have, by 0.1 bins or more.
    fn other_spacing(&self, rng: &mut ChaCha8Rng) -> f64 {
        loop {
            let bins: f64 = rng.random_range(0.5..3.0);
            if (bins - 1.0).abs() >= 0.1 && (bins - 1.5).abs() >= 0.1 {
                return bins * self.bin_metres;
            }
        }
    }

    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        y >= NEAREST_METRES * AXIS_MARGIN_DEGREES.to_radians().sin()
            && (NEAREST_METRES..=MAX_RANGE_PART * self.max_range_metres).contains(&x.hypot(y))
    }

    /// A line whose two ends lie in the field. Where 100 starts in a row leave its end outside, it gets shorter.
    fn line(
        &self,
        direction_degrees: f64,
        spacing_metres: f64,
        counts: RangeInclusive<usize>,
        rng: &mut ChaCha8Rng,
    ) -> Object {
        let least = *counts.start();
        let mut count = rng.random_range(counts);
        loop {
            for _ in 0..100 {
                let [x_metres, y_start_metres] = self.place(rng);
                let line =
                    Line { direction_degrees, ..Line::vertical(x_metres, y_start_metres, spacing_metres, count) };
                if count <= least || self.holds(line.end_metres()) {
                    return Object::Line(line);
                }
            }
            count = least.max(count / 2);
        }
    }

    fn corner(&self, rng: &mut ChaCha8Rng) -> Vec<Object> {
        loop {
            let first = self.line(rng.random_range(0.0..360.0), self.spacing(rng, 2.0), 20..=80, rng);
            let Object::Line(first) = first else { continue };
            let direction_degrees = (first.direction_degrees + 90.0) % 360.0;
            let (spacing_metres, count) = (self.spacing(rng, 2.0), rng.random_range(20..=80));
            let second = Line { direction_degrees, spacing_metres, count, ..first.clone() };
            if self.holds(first.end_metres()) && self.holds(second.end_metres()) {
                return vec![Object::Line(first), Object::Line(second)];
            }
        }
    }
}

fn near_point(rng: &mut ChaCha8Rng) -> Object {
    let range = 0.3 * (8.0f64 / 0.3).powf(rng.random());
    let [x, y] = polar(range, 15.0, rng);
    Object::Point(Point::new(x, y))
}

/// A place at this range, at a uniform angle that keeps `margin_degrees` from the array's axis.
fn polar(range_metres: f64, margin_degrees: f64, rng: &mut ChaCha8Rng) -> [f64; 2] {
    let margin = margin_degrees.to_radians();
    let angle = rng.random_range(margin..PI - margin);
    [range_metres * angle.cos(), range_metres * angle.sin()]
}
