//! Overlays of a map: true and found reflectors, beam width, and the cell under the pointer with its value.

use super::frame::{Cells, Frame, Marked};
use super::outline::{hull, outline};
use crate::app::state::{Cursor, Projection, Units};
use crate::app::widgets::{MARK, MARK_EDGE, MARK_SELECTED, axes, cross, direction, edged, with_unit};
use crate::interact::Selection;
use crate::maps::RangeAngleMap;
use crate::picture::finer;
use crate::scene::{Object, Reflector, Scene};
use eframe::egui::{Align2, Color32, Painter, Pos2, Shape, Stroke, Vec2, pos2, vec2};

pub const MAX_MARKED_REFLECTORS: usize = 4000;

const RING_RADIUS_POINTS: f32 = 6.0;

/// Shortest beam that is drawn, points, and half the height of the marks at its ends.
const MIN_BEAM_POINTS: f32 = 12.0;
const HALF_TICK_POINTS: Vec2 = vec2(0.0, 4.0);

/// Largest distance of the pointer from a ring to show the true direction, points.
const RING_REACH_POINTS: f32 = 9.0;

/// Draws the reflectors that the method found, as crosses; paler where they are those of an `old` scene.
pub fn found(painter: &Painter, frame: Frame<'_>, found: &[Reflector], old: bool) {
    let strength = if old { 0.35 } else { 1.0 };
    for r in found.iter().take(MAX_MARKED_REFLECTORS) {
        for (width, colour) in [(2.6, MARK_EDGE), (1.3, Color32::from_rgb(120, 255, 150))] {
            cross(painter, frame.blob(r), Vec2::splat(4.0), Stroke::new(width, colour.gamma_multiply(strength)));
        }
    }
}

/// Draws the map of one range bin as a line: Lambda over directions.
pub fn line(painter: &Painter, frame: Frame<'_>, map: &RangeAngleMap, ink: Color32) {
    let cells = frame.radar.left_to_right(&map.lambda);
    let fine = finer(frame.radar, cells);
    let cells = fine.as_ref().map_or(cells, |fine| fine.view());
    let across = |n: usize| (n as f32 + 0.5) / cells.ncols() as f32;
    let point = |(n, lambda): (usize, &f32)| frame.view.to_screen(frame.rect, pos2(across(n), *lambda));
    painter.add(Shape::line(cells.iter().enumerate().map(point).collect(), Stroke::new(1.6, ink)));
}

/// Draws the beam width of the map's elements, within which echoes are not resolved, as a bar in a corner; none where it is too narrow or too wide.
pub fn beam(painter: &Painter, frame: Frame<'_>, columns: f64) {
    let part = columns as f32 / frame.radar.elements as f32;
    let length = part * frame.rect.width() / (frame.view.high.x - frame.view.low.x);
    if !(MIN_BEAM_POINTS..frame.rect.width() - 80.0).contains(&length) {
        return;
    }
    let from = frame.rect.left_top() + vec2(10.0, 14.0);
    let to = from + vec2(length, 0.0);
    let ticks = [[from, to], [from, from], [to, to]]
        .map(|[a, b]| if a == b { [a - HALF_TICK_POINTS, b + HALF_TICK_POINTS] } else { [a, b] });
    edged([3.0, 1.4], MARK, |stroke| ticks.map(|ends| painter.line_segment(ends, stroke)));
    axes::text_on_patch(painter, to + vec2(8.0, 0.0), Align2::LEFT_CENTER, "beam");
}

/// Draws true reflectors at their places in the map, as rings or as outlines of lines. The ring under the `pointer` shows the true direction.
pub fn marks(painter: &Painter, frame: Frame<'_>, objects: &[Marked], pointer: Option<Pos2>) {
    let mut left = MAX_MARKED_REFLECTORS;
    let mut nearest: Option<(&Reflector, f32)> = None;
    for object in objects {
        let reflectors = &object.reflectors[..object.reflectors.len().min(left)];
        left -= reflectors.len();
        let blobs: Vec<Pos2> = reflectors.iter().map(|r| frame.blob(r)).collect();
        for ring in rings(object, &blobs, frame.rect.height(), 0.0) {
            edged([2.5, 1.2], MARK, |stroke| painter.add(ring.shape(stroke)));
        }
        for (reflector, at) in reflectors.iter().zip(blobs) {
            let distance = pointer.map_or(f32::INFINITY, |p| p.distance(at));
            if distance < nearest.map_or(RING_REACH_POINTS, |(_, d)| d) {
                nearest = Some((reflector, distance));
            }
        }
    }
    if let Some((reflector, _)) = nearest {
        true_direction(painter, frame, reflector);
    }
}

enum Ring {
    Circle(Pos2, f32),
    Outline(Vec<Pos2>),
}

impl Ring {
    fn shape(&self, stroke: Stroke) -> Shape {
        match self {
            Ring::Circle(at, radius) => Shape::circle_stroke(*at, *radius, stroke),
            Ring::Outline(points) => Shape::closed_line(points.clone(), stroke),
        }
    }
}

/// A ring around each reflector; around a line whose rings would run together, one outline. A line that wraps around the end of the ranges
/// has two pieces: without wrapping, no neighbours are `height` apart. All shapes are `wider` than usual by so many points.
fn rings(object: &Marked, blobs: &[Pos2], height: f32, wider: f32) -> Vec<Ring> {
    let radius = wider + if object.reflectors.len() > 20 && !object.is_line { 2.5 } else { RING_RADIUS_POINTS };
    let fused = |pair: &[Pos2]| pair[0].distance(pair[1]) < 2.0 * radius;
    if !object.is_line || !blobs.windows(2).all(|pair| fused(pair) || pair[0].distance(pair[1]) > height / 2.0) {
        return blobs.iter().map(|at| Ring::Circle(*at, radius)).collect();
    }
    let pieces = blobs.chunk_by(|a, b| a.distance(*b) <= height / 2.0);
    pieces.map(|piece| Ring::Outline(outline(piece, radius))).collect()
}

/// Draws one outline around the blobs of each selected object, so that its echoes stay in sight, and a line as the curve on which its blobs lie.
pub fn selected(painter: &Painter, frame: Frame<'_>, scene: &Scene, selection: &Selection) {
    let mut left = MAX_MARKED_REFLECTORS;
    for object in selection.iter().filter_map(|i| scene.objects.get(i)) {
        let reflectors: Vec<Reflector> = object.marks().into_iter().take(left).collect();
        left -= reflectors.len();
        if let (Object::Line(_), [first, .., last]) = (object, reflectors.as_slice()) {
            curve(painter, frame, first, last);
            continue;
        }
        let blobs: Vec<Pos2> = reflectors.iter().map(|r| frame.blob(r)).collect();
        let marked = Marked { reflectors, is_line: false };
        let outlines = match blobs.len() {
            0..3 => rings(&marked, &blobs, frame.rect.height(), 2.0),
            _ => around(blobs, frame.rect.height()),
        };
        for ring in outlines {
            edged([3.0, 1.6], MARK_SELECTED, |stroke| painter.add(ring.shape(stroke)));
        }
    }
}

const CURVE_POINTS: usize = 96;

/// Draws the straight line between two reflectors as the map shows it, with a dot at each end; in pieces where it wraps around the end of the ranges.
fn curve(painter: &Painter, frame: Frame<'_>, first: &Reflector, last: &Reflector) {
    let along = |i: usize| {
        let part = i as f64 / CURVE_POINTS as f64;
        let between = |a: f64, b: f64| a + part * (b - a);
        let [x_metres, y_metres] = [between(first.x_metres, last.x_metres), between(first.y_metres, last.y_metres)];
        frame.blob(&Reflector { x_metres, y_metres, ..*first })
    };
    let path: Vec<Pos2> = (0..=CURVE_POINTS).map(along).collect();
    edged([4.0, 1.8], MARK_SELECTED, |stroke| {
        for piece in path.chunk_by(|a, b| a.distance(*b) <= frame.rect.height() / 2.0) {
            painter.add(Shape::line(piece.to_vec(), stroke));
        }
        for end in [path[0], path[CURVE_POINTS]] {
            painter.circle_filled(end, 1.6 + stroke.width / 2.0, stroke.color);
        }
    });
}

/// One outline around a cluster's blobs; two where it wraps around the end of the ranges.
fn around(mut blobs: Vec<Pos2>, height: f32) -> Vec<Ring> {
    blobs.sort_by(|a, b| a.y.total_cmp(&b.y));
    let pieces = blobs.chunk_by(|a, b| b.y - a.y <= height / 2.0);
    pieces.map(|piece| Ring::Outline(hull(piece, RING_RADIUS_POINTS + 2.0))).collect()
}

/// Draws a line from a ring to its place without the beam's squint, with both directions.
fn true_direction(painter: &Painter, frame: Frame<'_>, reflector: &Reflector) {
    let (from, to) = (frame.blob(reflector), frame.true_direction(reflector));
    edged([3.0, 1.4], MARK, |stroke| {
        painter.line_segment([from, to], stroke);
        painter.circle_filled(to, 1.0 + stroke.width, stroke.color);
    });
    let seen = frame.radar.polar_of(reflector.x_metres - frame.centre_x_metres, reflector.y_metres);
    let blob = frame.radar.blob_of(frame.centre_x_metres, reflector.x_metres, reflector.y_metres);
    let text = format!("stands at {}\nseen at {}", direction(seen.cos_theta, 1), direction(blob.cos_theta, 1));
    axes::text_on_patch(painter, frame.upper_left(8.0), Align2::LEFT_TOP, &text);
}

/// Draws the cell under the pointer, in any panel, and its value in this map.
pub fn cursor(painter: &Painter, frame: Frame<'_>, cursor: &Cursor, cells: Option<&Cells<'_>>, units: Units) {
    let Some((bin, column)) = cursor.cell(frame.radar) else { return };
    let (rect, at, gap) = (frame.rect, frame.cursor(cursor), 7.0);
    for stroke in [Stroke::new(2.6, Color32::from_black_alpha(110)), Stroke::new(1.0, MARK)] {
        if frame.projection == Projection::RangeAngle {
            painter.hline(rect.left()..=at.x - gap, at.y, stroke);
            painter.hline(at.x + gap..=rect.right(), at.y, stroke);
            painter.vline(at.x, rect.top()..=at.y - gap, stroke);
            painter.vline(at.x, at.y + gap..=rect.bottom(), stroke);
        }
        painter.circle_stroke(at, gap, stroke);
    }
    if let Some(text) = cells.and_then(|cells| value_text(cells, units, bin, column)) {
        let (corner, align) = frame.far_corner(at, 8.0);
        axes::text_on_patch(painter, corner, align, &text);
    }
}

/// Text of a cell's value in Lambda and in decibels relative to the peak, in the chosen units first.
fn value_text(cells: &Cells<'_>, units: Units, bin: usize, column: usize) -> Option<String> {
    let (lambda, decibels) = cells.texts(bin, column)?;
    let [of_lambda, of_decibels] = if cells.minus.is_some() { ["ΔΛ", "Δ "] } else { ["Λ", ""] };
    let lambda = format!("{of_lambda} {lambda}");
    let Some(decibels) = decibels else { return Some(lambda) };
    let decibels = format!("{of_decibels}{}", with_unit(&decibels));
    Some(match units {
        Units::Lambda => format!("{lambda}  ({decibels})"),
        Units::Decibels => format!("{decibels}  ({lambda})"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::MapView;
    use crate::app::widgets::seen::{self, Harness};
    use crate::maps::{LambdaScale, RangeAngleMap};
    use crate::radar::Radar;
    use crate::scene::Line;
    use eframe::egui::{FullOutput, Rect};
    use ndarray::array;

    #[test]
    fn values_are_told_in_the_chosen_unit_with_the_other_beside() {
        let map = RangeAngleMap { lambda: array![[1.0f32, 0.5], [0.0, 0.25]] };
        let cells = |peak, floor| Cells { map: &map, minus: None, scale: Some(LambdaScale { peak, floor }) };
        let value_text = |cells: &Cells<'_>, bin, column| value_text(cells, Units::Lambda, bin, column);
        assert_eq!(value_text(&cells(5.0, 0.0), 0, 1).unwrap(), "Λ 0.500  (−50.0 dB)");
        assert_eq!(value_text(&cells(5.0, 0.0), 0, 0).unwrap(), "Λ 1.000  (0.0 dB)");
        assert_eq!(value_text(&cells(0.0, 0.0), 1, 0).unwrap(), "Λ 0.000  (no echo)", "silence");
        let difference = Cells { map: &map, minus: Some(&map), scale: None };
        assert_eq!(value_text(&difference, 1, 1).unwrap(), "ΔΛ ±0.000");
        let other = RangeAngleMap { lambda: array![[0.75f32]] };
        let difference = Cells { minus: Some(&other), ..cells(5.0, 0.0) };
        assert_eq!(value_text(&difference, 0, 0).unwrap(), "ΔΛ +0.250  (Δ +25.0 dB)");
        let map = RangeAngleMap { lambda: array![[1.0f32, 0.1]] };
        // The span of a map whose least cell is a rounding error of f64: the cell of Λ 0.1 is at -281.5 dB.
        let cells = Cells { map: &map, minus: None, scale: Some(LambdaScale { peak: 1.6, floor: 1.6 - 281.5 / 18.0 }) };
        let told = [0, 1].map(|column| super::value_text(&cells, Units::Decibels, 0, column).unwrap());
        assert_eq!(told, ["0.0 dB  (Λ 1.000)", "≤ −200 dB  (Λ 0.100)"]);
    }

    fn five(step: f32) -> Vec<Pos2> {
        (0..5).map(|i| Pos2::new(step * i as f32, 50.0)).collect()
    }

    /// Number of rings and outlines that mark an object whose reflectors have these five blobs.
    fn count(is_line: bool, blobs: &[Pos2]) -> usize {
        let reflector = Reflector { x_metres: 0.0, y_metres: 1.0, reflectivity: 1.0 };
        rings(&Marked { reflectors: vec![reflector; 5], is_line }, blobs, 100.0, 0.0).len()
    }

    #[test]
    fn what_wraps_has_two_outlines_and_what_is_apart_has_rings() {
        let mut wrapped = five(4.0);
        wrapped[3..].iter_mut().for_each(|at| at.y -= 90.0);
        let counts = [(true, five(4.0)), (true, wrapped), (true, five(14.0)), (false, five(4.0))];
        assert_eq!(counts.map(|(is_line, blobs)| count(is_line, &blobs)), [1, 2, 5, 5]);
        let mut cluster: Vec<Pos2> = (0..40).map(|i| Pos2::new((i * 7 % 23) as f32, (i * 5 % 17) as f32)).collect();
        assert_eq!(around(cluster.clone(), 300.0).len(), 1);
        cluster[..20].iter_mut().for_each(|at| at.y += 280.0);
        assert_eq!(around(cluster, 300.0).len(), 2);
    }

    /// Shapes drawn for a selected wall, with the pointer away from it or on its nearest blob.
    fn wall(is_under_the_pointer: bool) -> FullOutput {
        let (radar, wall) = (Radar::default(), Object::Line(Line::vertical(-0.832 * 20.0, 0.5548 * 20.0, 0.1, 40)));
        let objects = [Marked { reflectors: wall.reflectors(), is_line: true }];
        let scene = Scene { objects: vec![wall], ..Scene::default() };
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(1024.0, 512.0));
        let (view, projection) = (MapView::default(), Projection::RangeAngle);
        let frame = Frame::of(rect, view, &radar, projection, 0.0);
        let blob = frame.blob(&objects[0].reflectors[0]);
        let panel = Harness::builder().with_size(rect.size()).build_ui(|ui| {
            marks(ui.painter(), frame, &objects, is_under_the_pointer.then_some(blob));
            selected(ui.painter(), frame, &scene, &Selection::of([0]));
        });
        panel.output().clone()
    }

    #[test]
    fn only_a_ring_under_the_pointer_tells_the_true_direction() {
        let told = |drawn: FullOutput| seen::texts(&drawn).into_iter().find(|t| t.text.starts_with("stands at"));
        assert!(told(wall(false)).is_none());
        let told = told(wall(true)).unwrap();
        let directions = "stands at −56.3° · cos θ −0.832\nseen at −54.1° · cos θ −0.81";
        assert!(told.text.starts_with(directions), "{}", told.text);
    }

    #[test]
    fn a_selected_wall_is_marked_by_outlines_with_a_curve() {
        let away = wall(false);
        // Two outlines of the wall, and its curve with a dot at each end, each in two colours.
        let count = |is: fn(&Shape) -> bool| away.shapes.iter().filter(|s| is(&s.shape)).count();
        let [paths, dots] = [count(|s| matches!(s, Shape::Path(_))), count(|s| matches!(s, Shape::Circle(_)))];
        assert_eq!([paths, dots], [4, 4], "{:?}", away.shapes);
    }

    #[test]
    fn a_selected_line_is_drawn_as_the_curve_that_its_blobs_lie_on() {
        let (radar, wall) = (Radar::default(), Object::Line(Line::vertical(6.0, 8.0, 0.2, 60)));
        let scene = Scene { objects: vec![wall], ..Scene::default() };
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
        let bend = |projection| {
            let frame = Frame::of(rect, MapView::default(), &radar, projection, 0.0);
            let panel = Harness::builder().with_size(rect.size()).build_ui(|ui| {
                selected(ui.painter(), frame, &scene, &Selection::of([0]));
            });
            let shapes = &panel.output().shapes;
            let mut paths = shapes.iter().filter_map(|s| if let Shape::Path(p) = &s.shape { Some(p) } else { None });
            let path = paths.next_back().expect("a curve").points.clone();
            for r in scene.objects[0].reflectors() {
                let off = path.iter().map(|p| p.distance(frame.blob(&r))).fold(f32::INFINITY, f32::min);
                assert!(off < 3.0, "{projection:?}: a blob is {off} points from the curve");
            }
            // Distance of the curve's middle from the straight line between its ends.
            let (first, last) = (path[0], path[path.len() - 1]);
            (path[path.len() / 2] - first).dot((last - first).normalized().rot90()).abs()
        };
        let [bent, straight] = [Projection::RangeAngle, Projection::Cartesian].map(bend);
        assert!(bent > 5.0 && straight < 1.5, "{bent} and {straight} points");
    }
}
