//! Small drawn buttons, and marks that are readable over any picture.

use super::theme::{MARK, MARK_EDGE};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, pos2, vec2};

/// The picture on a drawn button.
pub enum Icon {
    Maximise,
    Close,
    /// Half a disc with a ring and a spoke, for Cartesian maps.
    Fan,
    /// A rectangle with lines, for range-angle maps.
    Grid,
}

/// A small drawn button with a name for tooltips and screen readers.
pub fn icon(ui: &mut Ui, icon: Icon, name: &str) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(18.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 3.0, visuals.bg_fill);
    }
    let stroke = Stroke::new(1.2, visuals.fg_stroke.color);
    draw(ui.painter(), rect.shrink(5.0), icon, stroke);
    response.on_hover_text(name)
}

pub fn over_picture(ui: &mut Ui, rect: Rect, icon: Icon, name: &str) -> Response {
    let response = ui.interact(rect, ui.scope_id().with(name), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let is_met = response.hovered() || response.has_focus();
    ui.painter().rect_filled(rect, 4.0, if is_met { egui::Color32::from_gray(60) } else { MARK_EDGE });
    draw(ui.painter(), rect.shrink2(vec2(5.0, 5.0)), icon, Stroke::new(1.3, MARK));
    response.on_hover_text(name)
}

fn draw(painter: &Painter, r: Rect, icon: Icon, stroke: Stroke) {
    match icon {
        Icon::Maximise => _ = painter.rect_stroke(r, 1.0, stroke, egui::StrokeKind::Middle),
        Icon::Close => cross(painter, r.center(), r.size() / 2.0, stroke),
        Icon::Fan => {
            let (middle, radius) = (pos2(r.center().x, r.bottom()), r.width() / 2.0);
            let on = |i: usize| (std::f32::consts::PI * i as f32 / 12.0).sin_cos();
            for part in [0.5, 1.0] {
                let arc = (0..=12).map(|i| middle + part * radius * vec2(on(i).1, -on(i).0));
                painter.add(Shape::line(arc.collect(), stroke));
            }
            painter.hline(r.x_range(), r.bottom(), stroke);
            painter.vline(middle.x, middle.y - radius..=middle.y, stroke);
        }
        Icon::Grid => {
            painter.rect_stroke(r, 0.0, stroke, egui::StrokeKind::Middle);
            painter.hline(r.x_range(), r.center().y, stroke);
            painter.vline(r.center().x, r.y_range(), stroke);
        }
    }
}

/// Draws twice: in a wide dark stroke, and over it in `colour`. `widths` are those of both strokes, points.
pub fn edged<T>(widths: [f32; 2], colour: Color32, mut draw: impl FnMut(Stroke) -> T) {
    for (width, colour) in widths.into_iter().zip([MARK_EDGE, colour]) {
        draw(Stroke::new(width, colour));
    }
}

/// Draws both diagonals of a box around a place; `half` is half its size, points.
pub fn cross(painter: &Painter, at: Pos2, half: Vec2, stroke: Stroke) {
    for half in [half, vec2(half.x, -half.y)] {
        painter.line_segment([at - half, at + half], stroke);
    }
}
