//! What hatches and marks on a map stand for: rows above it, where there is room for them.

use super::kinds::{Kinds, Sign};
use crate::app::widgets::axes;
use crate::picture::Detection;
use eframe::egui::{self, Align2, Color32, Mesh, Painter, Pos2, Rect, Sense, Shape, Ui, pos2, vec2};

/// Height of a row, points.
const ROW: f32 = 18.0;

/// Most rows: more would leave too little of the map.
const ROWS: usize = 2;

/// Width of a swatch, what is between it and its name, and what is between entries, points.
const SWATCH: f32 = 14.0;
const GAPS: [f32; 2] = [5.0, 12.0];

#[derive(Debug, Clone, Copy, PartialEq)]
enum Swatch {
    Cells(Detection),
    Mark(Sign),
}

#[derive(Debug, Clone, PartialEq)]
struct Entry {
    swatch: Swatch,
    name: String,
    /// Left end, and the row.
    at: (f32, usize),
}

/// A legend, laid out.
#[derive(Debug, Default)]
pub struct Legend {
    entries: Vec<Entry>,
    current: bool,
}

impl Legend {
    /// Of detections where the map's cells are `told_apart`, and of marks; nothing where more than two rows of `width` points are needed.
    pub fn new(painter: &Painter, told_apart: bool, kinds: Option<&Kinds<'_>>, width: f32) -> Legend {
        let detections = Detection::SEEN.into_iter().filter(|_| told_apart);
        let detections = detections.map(|kind| (Swatch::Cells(kind), kind.name().to_owned()));
        let counts = kinds.map(Kinds::counts).unwrap_or_default();
        let marks =
            counts.into_iter().map(|(sign, count)| (Swatch::Mark(sign), format!("{count} {}", sign.name(count))));
        let (mut left, mut row) = (0.0, 0);
        let mut entries = Vec::new();
        for (swatch, name) in detections.chain(marks) {
            let needed = SWATCH + GAPS[0] + axes::width(painter, &name);
            if left > 0.0 && left + needed > width {
                (left, row) = (0.0, row + 1);
            }
            entries.push(Entry { swatch, name, at: (left, row) });
            left += needed + GAPS[1];
        }
        if row >= ROWS {
            entries.clear();
        }
        Legend { entries, current: kinds.is_none_or(|kinds| kinds.current) }
    }

    /// What it needs above the map, points.
    pub fn height(&self) -> f32 {
        self.entries.last().map_or(0.0, |entry| (entry.at.1 + 1) as f32 * ROW)
    }

    /// Draws it, its upper left corner `at`.
    pub fn draw(&self, ui: &Ui, painter: &Painter, at: Pos2) {
        for Entry { swatch, name, at: (left, row) } in &self.entries {
            let from = at + vec2(*left, *row as f32 * ROW);
            let middle = from + vec2(SWATCH / 2.0, ROW / 2.0);
            match swatch {
                Swatch::Cells(kind) => hatched(painter, *kind, middle, ui.visuals().dark_mode),
                Swatch::Mark(sign) => {
                    painter.rect_filled(Rect::from_center_size(middle, vec2(18.0, 16.0)), 3.0, Color32::from_gray(70));
                    sign.draw(painter, middle, vec2(1.0, 0.0), self.current);
                }
            }
            let place = pos2(from.x + SWATCH + GAPS[0], middle.y);
            axes::text(painter, place, Align2::LEFT_CENTER, name, ui.visuals().text_color());
        }
        self.label(ui, at);
    }

    /// The same for screen readers.
    fn label(&self, ui: &Ui, at: Pos2) {
        let names: Vec<&str> = self.entries.iter().map(|entry| entry.name.as_str()).collect();
        if !names.is_empty() {
            let rect = Rect::from_min_size(at, vec2(SWATCH, self.height()));
            let response = ui.interact(rect, ui.scope_id().with("legend"), Sense::hover());
            let label = format!("Legend: {}", names.join(", "));
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &label));
        }
    }
}

/// A square of cells of a kind.
fn hatched(painter: &Painter, kind: Detection, middle: Pos2, dark: bool) {
    const DOTS: usize = 12;
    let corner = middle - vec2(DOTS as f32, DOTS as f32) / 2.0;
    let mut mesh = Mesh::default();
    for (x, y) in (0..DOTS).flat_map(|y| (0..DOTS).map(move |x| (x, y))) {
        let [r, g, b] = kind.colour(x, y, dark);
        let dot = Rect::from_min_size(corner + vec2(x as f32, y as f32), vec2(1.0, 1.0));
        mesh.add_colored_rect(dot, Color32::from_rgb(r, g, b));
    }
    painter.add(Shape::mesh(mesh));
    let square = Rect::from_center_size(middle, vec2(DOTS as f32, DOTS as f32));
    painter.rect_stroke(square, 0.0, egui::Stroke::new(1.0, Color32::from_gray(128)), egui::StrokeKind::Outside);
}
