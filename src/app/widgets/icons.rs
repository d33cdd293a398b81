//! Small drawn buttons.

use eframe::egui::{self, Ui};

/// What is drawn on the button.
pub enum Icon {
    /// A rectangle.
    Maximise,
    /// A cross.
    Close,
}

/// A small drawn button with a name for tooltips and screen readers.
pub fn icon(ui: &mut Ui, icon: Icon, name: &str) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(18.0), egui::Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 3.0, visuals.bg_fill);
    }
    let r = rect.shrink(5.0);
    let stroke = egui::Stroke::new(1.2, visuals.fg_stroke.color);
    match icon {
        Icon::Maximise => {
            ui.painter().rect_stroke(r, 1.0, stroke, egui::StrokeKind::Middle);
        }
        Icon::Close => {
            ui.painter().line_segment([r.left_top(), r.right_bottom()], stroke);
            ui.painter().line_segment([r.right_top(), r.left_bottom()], stroke);
        }
    }
    response.on_hover_text(name)
}
