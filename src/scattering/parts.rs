//! A closed outline as convex parts: cut from inner corners, along lines to other corners.

use super::geometry::{V, crosses};
use crate::scene::shape::inner_corners;

/// Convex parts of a counter-clockwise outline, (x, y) in metres; the outline itself where it is convex.
pub fn convex_parts(outline: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut open = vec![outline.to_vec()];
    let mut parts = Vec::new();
    while let Some(outline) = open.pop() {
        match cut(&outline) {
            Some([a, b]) => open.extend([a, b]),
            None => parts.push(outline),
        }
    }
    parts
}

/// The two halves of an outline that isn't convex, cut so that fewest inner corners are left.
fn cut(outline: &[[f64; 2]]) -> Option<[Vec<[f64; 2]>; 2]> {
    let corner = *inner_corners(outline).first()?;
    let count = outline.len();
    let halves =
        (2..count - 1).map(|step| (corner + step) % count).filter(|to| is_inside(outline, corner, *to)).map(|to| {
            let (low, high) = (corner.min(to), corner.max(to));
            let rest = outline[high..].iter().chain(&outline[..=low]).copied();
            [outline[low..=high].to_vec(), rest.collect()]
        });
    halves.min_by_key(|halves| halves.iter().map(|h| inner_corners(h).len()).sum::<usize>())
}

/// Whether the line from corner `a` to corner `b` runs inside.
fn is_inside(outline: &[[f64; 2]], a: usize, b: usize) -> bool {
    let count = outline.len();
    let at = |i: usize| V::from(outline[i % count]);
    let (from, to) = (at(a), at(b));
    // The angle at `from`, between the two edges that meet there, counted through the inside.
    let (after, before) = (at(a + 1) - from, at(a + count - 1) - from);
    let way = to - from;
    let turn = |v: V| {
        let angle = after.cross(v).atan2(after.dot(v));
        if angle <= 0.0 { angle + std::f64::consts::TAU } else { angle }
    };
    turn(way) < turn(before) && (0..count).all(|i| !crosses(from, to, at(i), at(i + 1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Shape;

    fn area(outline: &[[f64; 2]]) -> f64 {
        let next = outline.iter().cycle().skip(1);
        outline.iter().zip(next).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0).sum()
    }

    #[test]
    fn the_parts_of_an_outline_are_convex() {
        let ell = vec![[0.0, 5.0], [3.0, 5.0], [3.0, 6.0], [1.0, 6.0], [1.0, 9.0], [0.0, 9.0]];
        let cup = vec![[0.0, 5.0], [4.0, 5.0], [4.0, 8.0], [3.0, 8.0], [3.0, 6.0], [1.0, 6.0], [1.0, 8.0], [0.0, 8.0]];
        let star: Vec<[f64; 2]> = (0..10)
            .map(|i| {
                let (sin, cos) = (f64::from(i) * std::f64::consts::PI / 5.0).sin_cos();
                let radius = if i % 2 == 0 { 2.0 } else { 0.8 };
                [radius * cos, 10.0 + radius * sin]
            })
            .collect();
        for (outline, most) in [(&ell, 2), (&cup, 3), (&star, 6)] {
            let parts = convex_parts(outline);
            assert!(parts.len() <= most && parts.iter().all(|p| inner_corners(p).is_empty()), "{parts:?}");
            let total: f64 = parts.iter().map(|p| area(p)).sum();
            assert!((total - area(outline)).abs() < 1e-9, "{total} {}", area(outline));
            let whole = Shape::Outline(outline.clone());
            for part in &parts {
                let centre = [0, 1].map(|i| part.iter().map(|c| c[i]).sum::<f64>() / part.len() as f64);
                assert!(whole.contains(centre), "{part:?}");
            }
        }
        let square = vec![[0.0, 5.0], [1.0, 5.0], [1.0, 6.0], [0.0, 6.0]];
        assert_eq!(convex_parts(&square), [square]);
    }
}
