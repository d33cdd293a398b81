//! The window of a detector around the cell under the pointer: guard cells, training cells, and the threshold at the cell.

use super::frame::{Cells, Frame};
use crate::app::state::Cursor;
use crate::app::widgets::{MARK, MARK_SELECTED, axes, difference, edged, with_unit};
use crate::maps::cfar::{Cfar, Level};
use eframe::egui::{Painter, Pos2, Shape, pos2};

/// Points along each side of the window: in Cartesian maps sides are curved.
const SIDE_POINTS: usize = 12;

/// Distance of the text below the top of the map, points: below the value of the cell.
const TEXT_OFFSET_POINTS: f32 = 28.0;

/// Least width of a piece beyond an edge, as a part of the map's width; less is a rounding error.
const MIN_PIECE_RATIO: f32 = 1e-4;

pub fn draw(painter: &Painter, frame: Frame<'_>, cursor: &Cursor, cells: Option<&Cells<'_>>, cfar: &Cfar) {
    let Some((bin, column)) = cursor.cell(frame.radar) else { return };
    let map = [frame.radar.samples, frame.radar.elements];
    if cfar.check_map(map).is_err() {
        return;
    }
    let guarded = cfar.guard;
    let all = [guarded[0] + cfar.training[0], guarded[1] + cfar.training[1]];
    for (sides, colour) in [(all, MARK_SELECTED), (guarded, MARK)] {
        for outline in outlines(frame, [bin, column], sides) {
            edged([3.0, 1.4], colour, |stroke| painter.add(Shape::closed_line(outline.clone(), stroke)));
        }
    }
    if let Some(found) = cells.and_then(|cells| level_of(cells, cfar, map, [bin, column])) {
        let (corner, align) = frame.far_corner(frame.cursor(cursor), TEXT_OFFSET_POINTS);
        axes::text_on_patch(painter, corner, align, &told(&found));
    }
}

/// Power, noise and threshold of a detector at one cell of a map.
fn level_of(cells: &Cells<'_>, cfar: &Cfar, map: [usize; 2], cell: [usize; 2]) -> Option<Level> {
    let scale = cells.scale?;
    let decades = 2.0 * (scale.peak - scale.floor).max(0.0);
    let lambda = &cells.map.lambda;
    if lambda.dim() != (map[0], map[1]) {
        return None;
    }
    cfar.level(|cell| 10f64.powf((f64::from(lambda[cell]) - 1.0) * decades), map, cell).ok()
}

fn told(found: &Level) -> String {
    let db = |power: f64| with_unit(&difference(10.0 * (power / found.noise).log10()));
    let verdict = if found.is_detected() { "detected" } else { "not detected" };
    let cells = crate::radar::counted(found.training, "training cell", "training cells");
    format!("{verdict}, {}\nthreshold {}\nover {cells}", db(found.power), db(found.threshold))
}

/// The outline of the cells at most `sides` from a cell; in two pieces where it wraps around the end of the columns.
fn outlines(frame: Frame<'_>, [bin, column]: [usize; 2], sides: [usize; 2]) -> Vec<Vec<Pos2>> {
    let (bins, columns) = (frame.radar.samples as f32, frame.radar.elements as f32);
    let middle = frame.radar.across_of_column(column as f64) as f32;
    let half = (sides[1] as f32 + 0.5) / columns;
    let [bottom, top] = [bin as f32 - sides[0] as f32, (bin + sides[0] + 1) as f32].map(|b| b.clamp(0.0, bins) / bins);
    let [left, right] = [middle - half, middle + half];
    let mut pieces = vec![[left.max(0.0), right.min(1.0)]];
    if left < -MIN_PIECE_RATIO {
        pieces.push([left + 1.0, 1.0]);
    }
    if right > 1.0 + MIN_PIECE_RATIO {
        pieces.push([0.0, right - 1.0]);
    }
    let outline = |[left, right]: [f32; 2]| {
        let corners = [pos2(left, bottom), pos2(right, bottom), pos2(right, top), pos2(left, top)];
        let sides = (0..4).flat_map(move |i| (0..SIDE_POINTS).map(move |k| (corners[i], corners[(i + 1) % 4], k)));
        sides.map(|(from, to, k)| frame.at_fraction(from + (k as f32 / SIDE_POINTS as f32) * (to - from))).collect()
    };
    pieces.into_iter().map(outline).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{MapView, Projection};
    use crate::app::widgets::seen::{self, Harness};
    use crate::maps::{LambdaScale, RangeAngleMap};
    use crate::radar::{Convention, Radar};
    use crate::theory::MapPlace;
    use eframe::egui::{Rect, vec2};

    #[test]
    fn the_window_is_around_its_cell_in_either_convention() {
        for convention in Convention::ALL {
            let radar = Radar { elements: 64, samples: 64, ..Radar::default() }.in_convention(convention);
            let rect = Rect::from_min_size(Pos2::ZERO, vec2(640.0, 640.0));
            let frame = Frame::of(rect, MapView::default(), &radar, Projection::RangeAngle, 0.0);
            let outline = Rect::from_points(&outlines(frame, [20, 10], [2, 3])[0]);
            let cell = frame.cell(MapPlace { bin: 20.0, column: 10.0 });
            let off = outline.center().distance(cell);
            assert!(off < 0.1 && (outline.width() - 70.0).abs() < 0.1, "{convention:?}: {off} points beside {cell}");
        }
    }

    #[test]
    fn the_window_under_the_pointer_is_drawn_with_what_it_finds() {
        let radar = Radar { elements: 64, samples: 64, ..Radar::default() };
        let mut lambda = ndarray::Array2::from_elem((64, 64), 0.5f32);
        lambda[[20, 30]] = 0.9;
        let map = RangeAngleMap { lambda };
        let cells = Cells { map: &map, minus: None, scale: Some(LambdaScale { floor: -3.0, peak: 0.0 }) };
        let cfar = Cfar { guard: [3, 3], training: [6, 12], ..Cfar::default() };
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(640.0, 640.0));
        for (column, outlines) in [(30.0, 4), (2.0, 8)] {
            let drawn = Harness::builder().with_size(rect.size()).build_ui(|ui| {
                let frame = Frame::of(rect, MapView::default(), &radar, Projection::RangeAngle, 0.0);
                let cursor = Cursor::at_cell(&radar, 20.0, column);
                draw(ui.painter(), frame, &cursor, Some(&cells), &cfar);
            });
            let paths = drawn.output().shapes.iter().filter(|s| matches!(s.shape, Shape::Path(_))).count();
            assert_eq!(paths, outlines, "guard and training cells, each in two colours; twice where they wrap around");
            let texts = seen::texts(drawn.output());
            let expected = if column == 30.0 { "detected, +24.0 dB\nthreshold " } else { "not detected, ±0.0 dB" };
            assert!(texts.iter().any(|t| t.text.starts_with(expected)), "{texts:?}");
        }
    }
}
