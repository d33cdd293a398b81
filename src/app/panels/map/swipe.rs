//! Another map over the right part of a map, and the edge between the two.

use super::blank::Problem;
use super::frame::{Cells, Frame};
use crate::app::state::{Command, ViewCommand};
use crate::app::widgets::theme::{Inks, MARK, MARK_EDGE};
use eframe::egui::{
    self, Align2, Color32, CursorIcon, EventFilter, FontId, Key, Modifiers, Painter, Rect, Response, Sense, Stroke,
    TextureId, Ui, pos2, vec2,
};

/// How far from the edge the pointer takes hold of it, points.
const GRIP: f32 = 7.0;

/// What an arrow key moves the edge by, as a part of the map's width; with Shift ten times as far.
const STEP: f32 = 0.01;

/// The map right of the edge.
pub struct Over<'a> {
    /// Its picture, if there is one.
    pub texture: Option<TextureId>,
    /// Whether that is of an earlier scene.
    pub stale: bool,
    /// Why there is none.
    pub error: Option<Problem<'a>>,
    /// The numbers behind the picture.
    pub cells: Option<Cells<'a>>,
    /// Where the edge is, as a part of the map's width on screen.
    pub edge: f32,
}

impl<'a> Over<'a> {
    fn edge_in(&self, rect: Rect) -> f32 {
        rect.left() + self.edge * rect.width()
    }

    /// The numbers at a place on screen: those right of the edge, or those of the map beneath.
    pub fn cells_at<'b>(&'b self, rect: Rect, x: f32, beneath: Option<&'b Cells<'a>>) -> Option<&'b Cells<'a>> {
        if x > self.edge_in(rect) { self.cells.as_ref() } else { beneath }
    }

    /// Draws the map right of the edge.
    pub fn draw(&self, ui: &Ui, inner: &Painter, frame: Frame<'_>) {
        let (rect, view) = (frame.rect, frame.view);
        let right = Rect::from_min_max(pos2(self.edge_in(rect), rect.top()), rect.max);
        let painter = inner.with_clip_rect(right.intersect(inner.clip_rect()));
        match self.texture {
            Some(texture) => {
                let uv = Rect::from_min_max(pos2(view.low.x, view.high.y), pos2(view.high.x, view.low.y));
                let tint = if self.stale { Color32::from_gray(120) } else { Color32::WHITE };
                painter.rect_filled(right, 0.0, Inks::of(ui.visuals()).beyond);
                painter.image(texture, rect, uv, tint);
            }
            None => {
                painter.rect_filled(right, 0.0, ui.visuals().extreme_bg_color);
                let reason = self.error.as_ref().map_or("computing…", |e| e.reason);
                let (font, ink) = (FontId::proportional(12.0), ui.visuals().weak_text_color());
                let text = painter.layout(reason.to_owned(), font, ink, (right.width() - 16.0).max(40.0));
                let at = Align2::CENTER_CENTER.anchor_size(right.center(), text.size()).min;
                painter.galley(at, text, ink);
            }
        }
    }

    /// Draws the edge, which is dragged by the pointer and moved by arrow keys.
    pub fn handle(&self, ui: &Ui, painter: &Painter, rect: Rect, asked: &mut Vec<Command>) {
        let x = self.edge_in(rect);
        let place = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
        let response = ui.interact(place, ui.scope_id().with("edge"), Sense::click_and_drag());
        let label = "Edge between two maps";
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(self.edge), label));
        let pointed = response.interact_pointer_pos().filter(|_| response.dragged());
        let dragged = pointed.map(|at| (at.x - rect.left()) / rect.width().max(1.0));
        let moved = dragged.or_else(|| steps(&response).map(|steps| self.edge + steps as f32 * STEP));
        asked.extend(moved.map(|v| Command::View(ViewCommand::Swipe(v))));
        for (width, colour) in [(4.0, MARK_EDGE), (2.0, MARK)] {
            painter.vline(x, rect.y_range(), Stroke::new(width, colour));
        }
        let grip = Rect::from_center_size(pos2(x, rect.center().y), vec2(10.0, 26.0));
        painter.rect(grip, 4.0, MARK, Stroke::new(1.5, MARK_EDGE), egui::StrokeKind::Outside);
        response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    }
}

/// Steps to the right that arrow keys ask for while the edge has the focus.
fn steps(response: &Response) -> Option<i32> {
    if !response.has_focus() {
        return None;
    }
    let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
    response.ctx.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
    let steps = response.ctx.input_mut(|input| {
        let mut steps = 0;
        for (modifiers, by) in [(Modifiers::SHIFT, 10), (Modifiers::NONE, 1)] {
            let mut pressed = |key| input.count_and_consume_key(modifiers, key) as i32;
            steps += by * (pressed(Key::ArrowRight) - pressed(Key::ArrowLeft));
        }
        steps
    });
    (steps != 0).then_some(steps)
}
