//! Room for text in a map, away from blobs and marks.

use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};

/// Distance from a blob that text keeps, points.
const BLOB_DISTANCE_POINTS: f32 = 8.0;
/// Largest part of the map that text covers.
const MAX_TEXT_PART: f32 = 0.25;

/// Place of as many `lines` as fit, and their number: at least one, more in a larger map. All `places` stay in sight, the first (the blob's
/// peak) before the others, and the text covers no more than [`MAX_TEXT_PART`] of the map.
pub fn clear_patch(rect: Rect, places: &[Pos2], lines: &[Vec2]) -> (Rect, usize) {
    let from = places.first().copied().unwrap_or(rect.center());
    let patches = |count: usize| {
        let size = lines[..count].iter().fold(Vec2::ZERO, |s, g| vec2(s.x.max(g.x), s.y + g.y));
        corners(rect, from, size + vec2(10.0, 6.0)).map(|patch| (patch, count))
    };
    let fits = |(patch, _): &(Rect, usize)| {
        patch.area() <= MAX_TEXT_PART * rect.area()
            && !places.iter().any(|p| patch.expand(BLOB_DISTANCE_POINTS).contains(*p))
    };
    let least = patches(lines.len().min(1))[0];
    (1..=lines.len()).rev().flat_map(patches).find(fits).unwrap_or(least)
}

/// Boxes of `size` in the corners of `rect`, the farthest from `from` first. They leave the readout at the top and the button at the bottom free.
fn corners(rect: Rect, from: Pos2, size: Vec2) -> [Rect; 4] {
    let (left, top) = (from.x > rect.center().x, from.y > rect.center().y);
    [(left, top), (!left, top), (left, !top), (!left, !top)].map(|(left, top)| {
        let right = if top { 6.0 } else { 44.0 };
        let x = if left { rect.left() + 6.0 } else { (rect.right() - right - size.x).max(rect.left() + 6.0) };
        let y = if top { rect.top() + 28.0 } else { rect.bottom() - 6.0 - size.y };
        Rect::from_min_size(pos2(x, y), size)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECT: Rect = Rect { min: Pos2::ZERO, max: pos2(1280.0, 640.0) };

    #[test]
    fn the_numbers_leave_a_small_map_in_sight() {
        let small = Rect::from_min_size(Pos2::ZERO, vec2(300.0, 180.0));
        let lines = [vec2(290.0, 14.0); 7];
        let (patch, count) = clear_patch(small, &[small.center()], &lines);
        assert!(count > 1 && patch.area() <= MAX_TEXT_PART * small.area(), "{count} lines at {patch:?}");
        assert!(!patch.expand(BLOB_DISTANCE_POINTS).contains(small.center()));
        let (first, count) = clear_patch(RECT, &[RECT.center()], &lines);
        let (other, again) = clear_patch(RECT, &[RECT.center(), first.center()], &lines);
        assert!([count, again] == [7, 7] && !first.intersects(other), "a taken corner sends them to another");
    }

    #[test]
    fn a_free_corner_is_away_from_the_place() {
        for from in [pos2(320.0, 160.0), pos2(960.0, 160.0), pos2(320.0, 480.0), pos2(960.0, 480.0)] {
            let [corner, ..] = corners(RECT, from, vec2(300.0, 90.0));
            assert!(RECT.contains_rect(corner) && !corner.contains(from), "{corner:?}");
        }
    }
}
