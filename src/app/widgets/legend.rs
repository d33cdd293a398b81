//! Legend of a chart, in a row of its own and not over the data.

use eframe::egui::{Color32, Rect, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo, vec2};

/// Width of a sign, and its gap to the name, points.
const SIGN_WIDTH_POINTS: f32 = 14.0;
const SIGN_GAP_POINTS: f32 = 4.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sign {
    Line,
    /// A circle, filled or hollow.
    Circle {
        filled: bool,
    },
    /// A square, filled or hollow.
    Square {
        filled: bool,
    },
}

/// One entry of a legend: its sign, the sign's colour, and its name.
pub type Entry = (Sign, Color32, String);

/// Draws the entries, in several rows where one is too short.
pub fn row(ui: &mut Ui, entries: &[Entry]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 12.0;
        for (drawn, colour, name) in entries {
            // Sign and name are one piece, so that no row ends between them.
            let (font, ink) = (TextStyle::Body.resolve(ui.style()), ui.visuals().text_color());
            let galley = ui.painter().layout_no_wrap(name.clone(), font, ink);
            let size = galley.size() + vec2(SIGN_WIDTH_POINTS + SIGN_GAP_POINTS, 0.0);
            let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
            sign(ui, rect.with_max_x(rect.left() + SIGN_WIDTH_POINTS), *drawn, *colour);
            ui.painter().galley(rect.min + vec2(SIGN_WIDTH_POINTS + SIGN_GAP_POINTS, 0.0), galley, ink);
        }
    });
}

fn sign(ui: &Ui, rect: Rect, sign: Sign, colour: Color32) {
    let (painter, stroke) = (ui.painter(), Stroke::new(1.5, colour));
    let fill = |filled: bool| if filled { colour } else { Color32::TRANSPARENT };
    match sign {
        Sign::Line => _ = painter.hline(rect.x_range(), rect.center().y, Stroke::new(2.0, colour)),
        Sign::Circle { filled } => _ = painter.circle(rect.center(), 4.5, fill(filled), stroke),
        Sign::Square { filled } => {
            let square = Rect::from_center_size(rect.center(), vec2(8.0, 8.0));
            painter.rect(square, 0.0, fill(filled), stroke, StrokeKind::Middle);
        }
    }
}
