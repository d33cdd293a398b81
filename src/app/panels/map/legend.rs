//! Legend of a map: fills in the place of the bar of colours, and marks in rows above, where there is room.

use super::kinds::{Kinds, Sign};
use crate::app::widgets::{axes, theme};
use crate::picture::CellVerdict;
use eframe::egui::{self, Align2, Color32, Painter, Rect, Sense, Stroke, StrokeKind, Ui, Vec2, pos2, vec2};

const ROW_HEIGHT_POINTS: f32 = 18.0;

/// Most rows: more would leave too little of the map.
const MAX_LEGEND_ROWS: usize = 2;

/// Height of a panel up to which there is no room for marks or a caption above the map, points.
pub const MIN_PANEL_HEIGHT_POINTS: f32 = 150.0;

/// Height reserved for marks above every map in a panel `panel_height` points high.
pub fn reserved(panel_height: f32) -> f32 {
    if panel_height > MIN_PANEL_HEIGHT_POINTS { MAX_LEGEND_ROWS as f32 * ROW_HEIGHT_POINTS } else { 0.0 }
}

/// Width of a mark; gaps between a mark and its name, and between entries, points.
const MARK_WIDTH_POINTS: f32 = 14.0;
const MARK_GAPS_POINTS: [f32; 2] = [5.0, 12.0];

/// Side of a fill's square; gaps left of it, between it and its name, and between two fills, points.
const SQUARE_SIDE_POINTS: f32 = 12.0;
const SQUARE_GAPS_POINTS: [f32; 3] = [8.0, 5.0, 8.0];

/// A fill and its name, drawn one word a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    inside: Color32,
    around: Color32,
    name: &'static str,
}

impl Fill {
    /// Fills of hits, false alarms and misses.
    pub fn detections(dark: bool) -> Vec<Fill> {
        let colour = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
        let fill = |kind: CellVerdict| Fill {
            inside: colour(kind.fill(dark)),
            around: colour(kind.outline(dark)),
            name: kind.name(),
        };
        CellVerdict::VISIBLE_VERDICTS.map(fill).to_vec()
    }

    /// Fills of cells above a threshold and below it.
    pub fn mask(dark: bool) -> Vec<Fill> {
        let [below, above] = theme::mask(dark);
        [(above, "above"), (below, "below")]
            .map(|(inside, name)| Fill { inside, around: Color32::from_gray(128), name })
            .to_vec()
    }
}

/// Draws fills right of `map`, and marks above it unless these need more than two rows of `width` points.
pub fn draw(ui: &Ui, painter: &Painter, map: Rect, fills: &[Fill], kinds: Option<&Kinds<'_>>, width: f32) {
    let (mut left, mut row) = (0.0, 0);
    let mut marks: Vec<(Sign, String, Vec2)> = Vec::new();
    for (sign, count) in kinds.map(Kinds::counts).unwrap_or_default() {
        let name = sign.counted(count);
        let needed = MARK_WIDTH_POINTS + MARK_GAPS_POINTS[0] + axes::width(painter, &name);
        if left > 0.0 && left + needed > width {
            (left, row) = (0.0, row + 1);
        }
        marks.push((sign, name, vec2(left, row as f32 * ROW_HEIGHT_POINTS)));
        left += needed + MARK_GAPS_POINTS[1];
    }
    if row >= MAX_LEGEND_ROWS {
        marks.clear();
    }
    let at = map.left_top() - vec2(0.0, (row + 1) as f32 * ROW_HEIGHT_POINTS + 4.0);
    let (ink, is_current) = (ui.visuals().text_color(), kinds.is_some_and(|kinds| kinds.current));
    for (sign, name, by) in &marks {
        let from = at + *by;
        let middle = from + vec2(MARK_WIDTH_POINTS / 2.0, ROW_HEIGHT_POINTS / 2.0);
        painter.rect_filled(Rect::from_center_size(middle, vec2(18.0, 16.0)), 3.0, Color32::from_gray(70));
        sign.draw(painter, middle, vec2(1.0, 0.0), is_current);
        axes::text(
            painter,
            pos2(from.x + MARK_WIDTH_POINTS + MARK_GAPS_POINTS[0], middle.y),
            Align2::LEFT_CENTER,
            name,
            ink,
        );
    }
    let mut top = map.top();
    for Fill { inside, around, name } in fills {
        let square = Rect::from_min_size(
            pos2(map.right() + SQUARE_GAPS_POINTS[0], top + 1.0),
            vec2(SQUARE_SIDE_POINTS, SQUARE_SIDE_POINTS),
        );
        painter.rect(square, 0.0, *inside, Stroke::new(1.5, *around), StrokeKind::Outside);
        let lines = name.replace(' ', "\n");
        let text =
            axes::text(painter, pos2(square.right() + SQUARE_GAPS_POINTS[1], top), Align2::LEFT_TOP, &lines, ink);
        top = text.bottom().max(square.bottom()) + SQUARE_GAPS_POINTS[2];
    }
    // For screen readers.
    let names: Vec<&str> =
        fills.iter().map(|fill| fill.name).chain(marks.iter().map(|(_, name, _)| name.as_str())).collect();
    if !names.is_empty() {
        let rect = Rect::from_min_size(map.right_top(), vec2(MARK_WIDTH_POINTS, SQUARE_SIDE_POINTS));
        let response = ui.interact(rect, ui.scope_id().with("legend"), Sense::hover());
        let label = format!("Legend: {}", names.join(", "));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &label));
    }
}
