//! The colours of a map and what they stand for.

use crate::app::state::MapKind;
use crate::app::widgets::axes;
use crate::app::widgets::textures::colour_table;
use crate::picture::ColourMap;
use eframe::egui::{Align2, Mesh, Painter, Rect, Shape, Stroke, Ui, pos2};

/// Draws it right of a map.
pub fn draw(ui: &Ui, painter: &Painter, rect: Rect, kind: MapKind, colours: ColourMap) {
    let (table, low, high) = match kind {
        MapKind::Difference => (colour_table(ColourMap::Diverging), -1.0, 1.0),
        _ => (colour_table(colours), 0.0, 1.0),
    };
    let mut mesh = Mesh::default();
    let steps = 32;
    for i in 0..=steps {
        let part = i as f32 / steps as f32;
        let y = rect.bottom() - part * rect.height();
        let colour = table[(part * 255.0) as usize];
        mesh.colored_vertex(pos2(rect.left(), y), colour);
        mesh.colored_vertex(pos2(rect.right(), y), colour);
        if i > 0 {
            let v = 2 * i as u32;
            mesh.add_triangle(v - 2, v - 1, v);
            mesh.add_triangle(v - 1, v, v + 1);
        }
    }
    painter.add(Shape::mesh(mesh));
    let ink = ui.visuals().weak_text_color();
    for value in axes::ticks(low, high, (rect.height() / 40.0).min(5.0)) {
        let part = ((value - low) / (high - low)) as f32;
        let y = rect.bottom() - part * rect.height();
        painter.hline(rect.right()..=rect.right() + 2.0, y, Stroke::new(1.0, ink));
        axes::text(painter, pos2(rect.right() + 4.0, y), Align2::LEFT_CENTER, &axes::tick_text(value, 0.1), ink);
    }
    let title = if kind == MapKind::Difference { "ΔΛ" } else { "Λ" };
    axes::text(painter, pos2(rect.center().x, rect.bottom() + 16.0), Align2::CENTER_TOP, title, ink);
}
