//! Messages over the right of the status bar, where they cover no panel: the latest, then the earlier ones. They can be closed, and vanish after a time.

use crate::app::state::{Notice, Notices};
use crate::app::widgets::{Icon, icon};
use eframe::egui::{self, Align2, Area, Context, Frame, Id, Margin, Order, Pos2, Stroke, vec2};

/// Room for what stands beside a message's text: its sign, its number and its button, with the frame, points.
const BUTTON_ROOM_POINTS: f32 = 130.0;

/// Seconds for which a message stays: long enough to read an error and act on it.
const INFO_SECONDS: f64 = 6.0;
const ERROR_SECONDS: f64 = 20.0;

/// Draws the latest message and drops expired ones. The time of an earlier one begins once it is drawn.
pub fn show(ctx: &Context, notices: &mut Notices) {
    let messages = &mut notices.list;
    let count = messages.len();
    let Some(message) = messages.last_mut() else { return };
    let now = ctx.input(|i| i.time);
    let pointer = ctx.input(|i| i.pointer.hover_pos());
    let width = ctx.content_rect().width();
    let drawn = Area::new(Id::unique("messages"))
        .order(Order::Foreground)
        .anchor(Align2::RIGHT_BOTTOM, vec2(0.0, 0.0))
        .interactable(true)
        .show(ctx, |ui| {
            ui.set_max_width(width);
            draw(ui, message, count, width - BUTTON_ROOM_POINTS)
        });
    let seconds = if message.is_error { ERROR_SECONDS } else { INFO_SECONDS };
    let until = message.until.get_or_insert(now + seconds);
    if pointer.is_some_and(|p: Pos2| drawn.response.rect.contains(p)) {
        // A message under the pointer stays.
        *until = until.max(now + 2.0);
    }
    let closed = drawn.inner.then_some(message.number);
    messages.retain(|m| closed != Some(m.number) && m.until.is_none_or(|until| until > now));
    if !messages.is_empty() && messages.len() < count {
        ctx.request_repaint();
    }
    if let Some(next) = messages.iter().filter_map(|m| m.until).min_by(f64::total_cmp) {
        ctx.request_repaint_after_secs((next - now).max(0.0) as f32);
    }
}

/// Draws a message, the first of `count`, whose text is at most `room` points wide. Returns whether it was closed.
fn draw(ui: &mut egui::Ui, message: &Notice, count: usize, room: f32) -> bool {
    let visuals = ui.visuals();
    let (sign, colour) = if message.is_error { ("!", visuals.error_fg_color) } else { ("i", visuals.hyperlink_color) };
    let frame = Frame::new().fill(visuals.window_fill).stroke(Stroke::new(1.0, colour)).corner_radius(4.0);
    let row = |ui: &mut egui::Ui| {
        ui.label(egui::RichText::new(sign).strong().color(colour));
        ui.scope(|ui| {
            ui.set_max_width(room);
            ui.add(egui::Label::new(&message.text).wrap());
        });
        if count > 1 {
            ui.weak(format!("1 of {count}"));
        }
        icon(ui, Icon::Close, "Close this message").clicked()
    };
    frame.inner_margin(Margin::symmetric(8, 1)).show(ui, |ui| ui.horizontal(row).inner).inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    const BAR_POINTS: f32 = 26.0;

    const LONG: &str = "The unsaved scene of the last session is back. Save it (Ctrl+S) to keep it.";

    fn window(size: [f32; 2]) -> Harness<'static, Notices> {
        let mut notices = Notices::default();
        notices.info("earlier");
        notices.error(LONG);
        Harness::builder().with_size(size).build_ui_state(|ui, notices: &mut Notices| show(ui.ctx(), notices), notices)
    }

    #[test]
    fn a_message_stays_within_the_status_bar() {
        for size in [[1440.0, 900.0], [1024.0, 640.0]] {
            let mut window = window(size);
            window.run_steps(3);
            let close = window.get_by_label("Close this message").rect();
            let texts = seen::texts(window.output());
            let top = texts.iter().map(|t| t.rect.top()).fold(close.top(), f32::min);
            assert!(top > size[1] - BAR_POINTS, "{top} of {size:?}: {texts:?}");
            seen::assert_readable(window.output());
        }
    }

    #[test]
    fn earlier_messages_follow_the_latest() {
        let mut window = window([1024.0, 640.0]);
        window.run_steps(3);
        assert!(window.reads(LONG) && window.reads("1 of 2") && !window.reads("earlier"));
        assert_eq!(window.state().list[0].until, None, "its time has not begun");
        window.clicks(&["Close this message"]);
        assert!(window.reads("earlier") && !window.reads(LONG));
        window.clicks(&["Close this message"]);
        assert!(window.state().list.is_empty());
    }
}
