//! Bodies sorted by place, so that those near a polygon are found without testing all of them.

use super::geometry::V;

/// A margin above the rounding of any distance in a scene, metres.
const SURELY_METRES: f64 = 1e-6;

/// Discs in strips along x, one above the other; in each they are sorted by x.
#[derive(Debug, Clone, Default)]
pub(super) struct Strips {
    strips: Vec<Strip>,
}

#[derive(Debug, Clone)]
struct Strip {
    /// Lowest and highest centre, y in metres.
    span: [f64; 2],
    /// Radius of the largest disc, metres.
    largest: f64,
    /// x of every centre in metres, and the disc's number.
    discs: Vec<(f64, usize)>,
}

impl Strips {
    /// Discs by centre and radius in metres. The n-th is number n.
    pub fn new(discs: impl Iterator<Item = (V, f64)>) -> Self {
        let mut all: Vec<(V, f64, usize)> = discs.zip(0..).map(|((centre, radius), n)| (centre, radius, n)).collect();
        all.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
        let each = (all.len() as f64).sqrt().ceil() as usize;
        let strip = |of: &[(V, f64, usize)]| {
            let y = |at: Option<&(V, f64, usize)>| at.map_or(0.0, |(centre, ..)| centre.1);
            let mut discs: Vec<(f64, usize)> = of.iter().map(|(centre, _, n)| (centre.0, *n)).collect();
            discs.sort_by(|a, b| a.0.total_cmp(&b.0));
            let largest = of.iter().map(|(_, radius, _)| *radius).fold(0.0, f64::max);
            Strip { span: [y(of.first()), y(of.last())], largest, discs }
        };
        Strips { strips: all.chunks(each.max(1)).map(strip).collect() }
    }

    /// Every disc that comes nearer than `margin` metres to a convex polygon, and some that don't; lowest number first.
    pub fn near(&self, polygon: &[V], margin: f64) -> Vec<usize> {
        let mut found = Vec::new();
        for strip in &self.strips {
            let reach = margin + strip.largest + SURELY_METRES;
            let [low, high] = strip.span;
            let Some([left, right]) = span_between(polygon, [low - reach, high + reach]) else { continue };
            let from = strip.discs.partition_point(|(x, _)| *x < left - reach);
            found.extend(strip.discs[from..].iter().take_while(|(x, _)| *x <= right + reach).map(|(_, n)| *n));
        }
        found.sort_unstable();
        found
    }
}

/// Least and greatest x of a convex polygon where its y lies within `[low, high]`; `None` where it never does.
fn span_between(polygon: &[V], [low, high]: [f64; 2]) -> Option<[f64; 2]> {
    let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut meet = |x: f64| (left, right) = (left.min(x), right.max(x));
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        if a.1 >= low && a.1 <= high {
            meet(a.0);
        }
        for level in [low, high] {
            if (a.1 < level) != (b.1 < level) {
                meet(a.0 + (level - a.1) / (b.1 - a.1) * (b.0 - a.0));
            }
        }
    }
    (left <= right).then_some([left, right])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn distance(p: V, a: V, b: V) -> f64 {
        let (way, to) = (b - a, p - a);
        let part = (to.dot(way) / way.dot(way)).clamp(0.0, 1.0);
        (to - way * part).norm()
    }

    proptest! {
        #[test]
        fn what_is_near_is_found(
            places in prop::collection::vec((-30.0..30.0f64, 0.5..35.0f64, 0.0..3.0f64), 0..60),
            (x, y, margin) in (-30.0..30.0f64, 1.0..35.0f64, 0.0..2.0f64),
        ) {
            let triangle = [V(-1.0, 0.0), V(1.0, 0.0), V(x, y)];
            let is_inside = |p: V| {
                let sides = [0, 1, 2].map(|i| (triangle[(i + 1) % 3] - triangle[i]).cross(p - triangle[i]));
                sides.iter().all(|s| *s >= 0.0)
            };
            let strips = Strips::new(places.iter().map(|(x, y, r)| (V(*x, *y), *r)));
            let found = strips.near(&triangle, margin);
            for (n, (u, v, radius)) in places.iter().enumerate() {
                let p = V(*u, *v);
                let away = (0..3).map(|i| distance(p, triangle[i], triangle[(i + 1) % 3])).fold(f64::INFINITY, f64::min);
                let away = if is_inside(p) { 0.0 } else { away };
                prop_assert!(away >= margin + radius || found.contains(&n), "{n} at {away}");
            }
            prop_assert!(found.is_sorted());
        }
    }

    #[test]
    fn of_a_large_field_few_are_asked() {
        let field = (0..10_000).map(|i| (V(f64::from(i % 100) - 50.0, f64::from(i / 100)), 0.2));
        let found = Strips::new(field).near(&[V(-1.0, 0.0), V(1.0, 0.0), V(20.0, 80.0)], 0.5);
        // The triangle has 80 square metres, and is up to 90 metres long.
        assert!(found.len() > 160 && found.len() < 600, "{}", found.len());
    }
}
