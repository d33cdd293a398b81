//! The strip of elements side by side, for clicks and drags.

use crate::app::state::State;
use crate::app::widgets::{Inks, cross, keep_arrows, signed};
use crate::radar::{BuiltArray, ElementError, End, Radar};
use eframe::egui::{
    self, Color32, Key, Modifiers, Painter, PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, pos2, vec2,
};

/// Least phase that is drawn as a dot; rounding leaves less after a calibration.
const MIN_DRAWN_PHASE_DEGREES: f64 = 0.05;

/// Displacement of an element per point of a drag, millimetres.
const MILLIMETRES_PER_POINT: f64 = 0.05;

/// Most points by which an element is drawn above or below the line.
const MAX_OFFSET_POINTS: f32 = 16.0;

/// Largest distance from an element's place, millimetres.
pub(super) const MAX_DISPLACEMENT_MILLIMETRES: f64 = 1000.0;

struct Strip<'a> {
    radar: &'a Radar,
    elements: &'a BuiltArray,
    /// Numbers of the layout's elements; `None` for the two ends.
    heard: Option<Vec<usize>>,
    rect: Rect,
}

/// Draws the strip. `chosen` is the element whose numbers are drawn. Returns a changed element and its errors.
pub(super) fn show(ui: &mut Ui, state: &State, chosen: &mut usize) -> Option<(usize, ElementError)> {
    let (radar, elements) = (state.radar(), state.elements());
    let heard = state.settings.layout.as_ref().and_then(|layout| layout.numbers(radar).ok());
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 58.0), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Elements"));
    let strip = Strip { radar, elements, heard, rect };
    strip.draw(ui, *chosen);
    let changed = strip.switched(&response, chosen).or_else(|| strip.moved(&response, chosen));
    if response.has_focus() {
        keep_arrows(&response, [true, false]);
        let steps = |key| ui.input_mut(|i| i.count_and_consume_key(Modifiers::NONE, key));
        let (right, left) = (steps(Key::ArrowRight), steps(Key::ArrowLeft));
        *chosen = (*chosen + right).saturating_sub(left).min(radar.elements - 1);
    }
    if let Some(tip) = response.hover_pos().map(|pos| strip.tip(pos.x)) {
        response.on_hover_text_at_pointer(tip);
    }
    changed
}

impl Strip<'_> {
    fn at(&self, n: usize) -> f32 {
        self.rect.left() + (n as f32 + 0.5) / self.radar.elements as f32 * self.rect.width()
    }

    fn under(&self, x: f32) -> usize {
        let count = self.radar.elements;
        (((x - self.rect.left()) / self.rect.width() * count as f32).max(0.0) as usize).min(count - 1)
    }

    /// Draws the elements side by side: a dead one in red, the gain as the height of the bar, the phase as the place of the dot.
    fn draw(&self, ui: &Ui, chosen: usize) {
        let inks = Inks::of(ui.visuals());
        let painter = ui.painter().with_clip_rect(self.rect);
        painter.rect_filled(self.rect, 3.0, inks.ground);
        let [first, last] = End::BOTH.map(|end| self.radar.end_range(end));
        // Bars closer than a pixel overlap: those of elements in use lie over the others.
        let lies_over = |n: &usize| match &self.heard {
            Some(heard) => heard.contains(n),
            None => first.contains(n) || last.contains(n),
        };
        let mut all: Vec<usize> = (0..self.radar.elements).collect();
        all.sort_by_key(&lies_over);
        for n in all {
            let ink = match lies_over(&n) {
                false => inks.array,
                true if self.heard.is_none() && !first.contains(&n) => inks.ends[1],
                true => inks.ends[0],
            };
            match self.elements.element(n) {
                error if error.dead => {
                    let stroke = Stroke::new(1.5, ui.visuals().error_fg_color);
                    cross(&painter, self.place(n), vec2(3.0, 8.0), stroke);
                }
                error => self.bar(&painter, n, error, ink, inks.selected),
            }
        }
        painter.vline(self.at(chosen), self.rect.y_range(), Stroke::new(1.0, inks.selected));
    }

    fn width(&self) -> f32 {
        (self.rect.width() / self.radar.elements as f32 * 0.7).clamp(1.0, 10.0)
    }

    /// Drawn place of element `n`: shifted by its errors along the array and forward, as far as the strip has room.
    fn place(&self, n: usize) -> Pos2 {
        let error = self.elements.element(n);
        let along = (error.position_millimetres * 1e-3 / self.radar.element_spacing_metres) as f32 * self.width();
        let up = (error.forward_millimetres / MILLIMETRES_PER_POINT) as f32;
        pos2(self.at(n) + along, self.rect.center().y - up.clamp(-MAX_OFFSET_POINTS, MAX_OFFSET_POINTS))
    }

    fn bar(&self, painter: &Painter, n: usize, error: ElementError, ink: Color32, dot: Color32) {
        let place = self.place(n);
        let half = (9.0 + error.gain.0 as f32 * 2.0).clamp(2.0, 24.0);
        painter.rect_filled(Rect::from_center_size(place, vec2(self.width(), 2.0 * half)), 1.0, ink);
        if error.phase_degrees.abs() >= MIN_DRAWN_PHASE_DEGREES {
            let up = (error.phase_degrees / 180.0) as f32 * 24.0;
            painter.circle_filled(place - vec2(0.0, up), 2.0, dot);
        }
    }

    fn switched(&self, response: &Response, chosen: &mut usize) -> Option<(usize, ElementError)> {
        if !response.clicked() {
            return None;
        }
        // The space bar clicks, too, wherever the pointer is.
        let pointer = response.interact_pointer_pos().filter(|_| response.clicked_by(PointerButton::Primary));
        *chosen = pointer.map_or(*chosen, |pos| self.under(pos.x));
        let error = self.elements.element(*chosen);
        Some((*chosen, ElementError { dead: !error.dead, ..error }))
    }

    /// The element under the beginning of a drag, moved along the array by a sideways drag and towards the scene by an upward one.
    fn moved(&self, response: &Response, chosen: &mut usize) -> Option<(usize, ElementError)> {
        if response.drag_started_by(PointerButton::Primary) {
            // By then the pointer may have left the element that it was pressed on.
            let pressed = response.ctx.input(|i| i.pointer.press_origin());
            *chosen = pressed.map_or(*chosen, |pos| self.under(pos.x));
        }
        let moved = response.drag_delta();
        if !response.dragged_by(PointerButton::Primary) || moved == Vec2::ZERO {
            return None;
        }
        let by = |from: f64, points: f32| {
            (from + f64::from(points) * MILLIMETRES_PER_POINT)
                .clamp(-MAX_DISPLACEMENT_MILLIMETRES, MAX_DISPLACEMENT_MILLIMETRES)
        };
        let error = self.elements.element(*chosen);
        let position_millimetres = by(error.position_millimetres, moved.x);
        let forward_millimetres = by(error.forward_millimetres, -moved.y);
        Some((*chosen, ElementError { position_millimetres, forward_millimetres, ..error }))
    }

    fn tip(&self, x: f32) -> String {
        let n = self.under(x);
        let e = self.elements.element(n);
        let gain_and_phase = || format!("{} dB, {}°", signed(e.gain.0, 2), signed(e.phase_degrees, 1));
        let state = if e.dead { "dead".to_owned() } else { gain_and_phase() };
        let [along, forward] = [e.position_millimetres, e.forward_millimetres].map(|offset| signed(offset, 2));
        format!("element {n}: {state}, {along} mm along, {forward} mm forward\nclick: dead or alive; drag: move")
    }
}
