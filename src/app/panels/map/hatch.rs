//! Hatches over hits, misses and false alarms, where a cell is large enough on screen: the kinds differ without any colour.

use super::frame::Frame;
use crate::evaluate::verdict::Ghost;
use crate::maps::RangeAngleMap;
use crate::picture::CellVerdict;
use crate::theory::MapPlace;
use eframe::egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

/// The least height of a cell that hatches are drawn in, points.
const MIN_CELL_POINTS: f32 = 4.0;

/// Margin around the drawn cell of a ghost, points: a column of a whole map is narrower than a pixel.
const GHOST_MARGIN_POINTS: f32 = 0.75;

const LINE_DISTANCE_POINTS: f32 = 7.0;

/// Maps and thresholds that separate hits, misses and false alarms.
#[derive(Clone, Copy)]
pub struct ToldApart<'a> {
    /// Lambda of the output, or a detector's result for the output.
    pub output: &'a RangeAngleMap,
    pub target: &'a RangeAngleMap,
    pub etas: [f32; 2],
    /// Blobs of the output where the scene has nothing, once the output is judged.
    pub ghosts: &'a [Ghost],
}

impl ToldApart<'_> {
    /// Verdict on the cell at a place on screen.
    fn at(&self, frame: Frame<'_>, pos: Pos2) -> CellVerdict {
        let (radar, polar) = (frame.radar, frame.polar(pos));
        let bin = radar.bin_of_range(polar.range_metres).round();
        let column = (radar.column_of_cos(polar.cos_theta).round() as usize) % radar.elements.max(1);
        if !(bin >= 0.0 && bin < radar.samples as f64) {
            return CellVerdict::Nothing;
        }
        let cell = (bin as usize, column);
        let above = |map: &RangeAngleMap, eta: f32| map.lambda.get(cell).is_some_and(|v| *v > eta);
        let is_ghost = || self.ghosts.iter().any(|ghost| ghost.cells.contains(&[cell.0, cell.1]));
        match CellVerdict::of(above(self.target, self.etas[1]), above(self.output, self.etas[0])) {
            CellVerdict::FalseAlarm if !is_ghost() => CellVerdict::Rim,
            kind => kind,
        }
    }

    fn fill(&self, painter: &Painter, frame: Frame<'_>, dark: bool) {
        let [r, g, b] = CellVerdict::FalseAlarm.fill(dark);
        let mut mesh = Mesh::default();
        for &[bin, column] in self.ghosts.iter().flat_map(|ghost| &ghost.cells) {
            let corner = |up: f64, across: f64| {
                frame.cell(MapPlace { bin: (bin as f64 + up).max(0.0), column: column as f64 + across })
            };
            let corners = [corner(-0.5, -0.5), corner(-0.5, 0.5), corner(0.5, 0.5), corner(0.5, -0.5)];
            // The first and the last column touch each other across the whole map.
            if corners.iter().any(|corner| corner.distance(corners[0]) > 0.5 * frame.rect.width()) {
                continue;
            }
            let first = mesh.vertices.len() as u32;
            let middle = corner(0.0, 0.0);
            for corner in corners {
                let seen = corner + GHOST_MARGIN_POINTS * (corner - middle).normalized();
                mesh.colored_vertex(seen, Color32::from_rgb(r, g, b));
            }
            mesh.add_triangle(first, first + 1, first + 2);
            mesh.add_triangle(first, first + 2, first + 3);
        }
        painter.add(mesh);
    }

    /// Draws ghosts and hatches over the visible part of the map: misses lean to the right, false alarms to the left, hits have none.
    pub fn draw(&self, painter: &Painter, frame: Frame<'_>, dark: bool) {
        self.fill(painter, frame, dark);
        let rect = frame.rect.intersect(painter.clip_rect());
        if frame.cell_height() < MIN_CELL_POINTS {
            return;
        }
        let [across, up] = [rect.width(), rect.height()].map(|side| (side / LINE_DISTANCE_POINTS).ceil() as usize);
        // The grid stays in place on screen, so that lines of neighbouring cells meet.
        let squares = (0..up).flat_map(|row| (0..across).map(move |column| (row, column)));
        let lines = squares.filter_map(|(row, column)| {
            let square = Rect::from_min_size(
                rect.min + LINE_DISTANCE_POINTS * vec2(column as f32, row as f32),
                vec2(LINE_DISTANCE_POINTS, LINE_DISTANCE_POINTS),
            );
            let kind = self.at(frame, square.center());
            let ends = match kind {
                CellVerdict::Miss => [square.left_bottom(), square.right_top()],
                CellVerdict::FalseAlarm => [square.left_top(), pos2(square.right(), square.bottom())],
                CellVerdict::Hit | CellVerdict::Rim | CellVerdict::Nothing => return None,
            };
            let [r, g, b] = kind.outline(dark);
            Some(Shape::line_segment(ends, Stroke::new(1.2, Color32::from_rgb(r, g, b))))
        });
        painter.extend(lines.collect::<Vec<_>>());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{MapView, Projection};
    use crate::app::widgets::seen::Harness;
    use crate::radar::Radar;
    use eframe::egui::Ui;
    use ndarray::Array2;

    /// Lines drawn over a map whose upper half is missed, seen as a whole or zoomed in.
    fn lines(view: MapView) -> usize {
        let radar = Radar::default();
        let map = |lambda| RangeAngleMap { lambda: Array2::from_elem((radar.samples, radar.elements), lambda) };
        let (output, mut target) = (map(0.0f32), map(0.0));
        target.lambda.slice_mut(ndarray::s![radar.samples / 2.., ..]).fill(1.0);
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 200.0));
        let harness = Harness::builder().with_size(rect.size()).build_ui(|ui: &mut Ui| {
            let frame = Frame::of(rect, view, &radar, Projection::RangeAngle, 0.0);
            let told_apart = ToldApart { output: &output, target: &target, etas: [0.5, 0.9], ghosts: &[] };
            told_apart.draw(ui.painter(), frame, true);
        });
        harness.output().shapes.iter().filter(|s| matches!(s.shape, Shape::LineSegment { .. })).count()
    }

    /// A small part of the map, from the part `low` of its height upwards.
    fn zoomed(low: f32) -> MapView {
        MapView { low: pos2(0.4, low), high: pos2(0.43, low + 0.04) }
    }

    #[test]
    fn hatches_are_drawn_where_cells_are_large_and_missed() {
        assert_eq!([lines(MapView::default()), lines(zoomed(0.2))], [0, 0]);
        assert!(lines(zoomed(0.7)) > 1000);
    }
}
