//! Messages in the corner below scene and settings, which cover no map. They wrap, can be read aloud and closed, and vanish after a time.

use crate::app::state::{Notice, Notices};
use crate::app::widgets::{Icon, icon};
use eframe::egui::{self, Align2, Area, Context, Frame, Id, Order, Pos2, vec2};

const WIDTH: f32 = 380.0;

/// Seconds for which a message stays: long enough to read an error and act on it.
const INFO_SECONDS: f64 = 6.0;
const ERROR_SECONDS: f64 = 20.0;

/// Draws the messages and drops expired ones.
pub fn show(ctx: &Context, notices: &mut Notices) {
    let messages = &mut notices.list;
    if messages.is_empty() {
        return;
    }
    let now = ctx.input(|i| i.time);
    let pointer = ctx.input(|i| i.pointer.hover_pos());
    let width = WIDTH.min(ctx.content_rect().width() - 40.0);
    let mut closed = Vec::new();
    let mut hovered = false;
    Area::new(Id::unique("messages"))
        .order(Order::Foreground)
        .anchor(Align2::LEFT_BOTTOM, vec2(12.0, -36.0))
        .interactable(true)
        .show(ctx, |ui| {
            ui.set_max_width(width);
            for message in messages.iter() {
                let drawn = Frame::popup(ui.style()).show(ui, |ui| draw(ui, message, width));
                if drawn.inner {
                    closed.push(message.number);
                }
                hovered |= pointer.is_some_and(|p: Pos2| drawn.response.rect.contains(p));
            }
        });
    for message in messages.iter_mut() {
        let seconds = if message.is_error { ERROR_SECONDS } else { INFO_SECONDS };
        let until = message.until.get_or_insert(now + seconds);
        if hovered {
            // A message under the pointer stays.
            *until = until.max(now + 2.0);
        }
    }
    messages.retain(|m| !closed.contains(&m.number) && m.until.is_none_or(|until| until > now));
    if let Some(next) = messages.iter().filter_map(|m| m.until).min_by(f64::total_cmp) {
        ctx.request_repaint_after_secs((next - now).max(0.0) as f32);
    }
}

fn draw(ui: &mut egui::Ui, message: &Notice, width: f32) -> bool {
    let visuals = ui.visuals();
    let (sign, colour) = if message.is_error { ("!", visuals.error_fg_color) } else { ("i", visuals.hyperlink_color) };
    ui.horizontal_top(|ui| {
        ui.set_width(width - 24.0);
        ui.label(egui::RichText::new(sign).strong().color(colour));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Min), |ui| {
            let closed = icon(ui, Icon::Close, "Close this message").clicked();
            ui.with_layout(egui::Layout::top_down(egui::Align::Min), |ui| {
                ui.add(egui::Label::new(&message.text).wrap());
            });
            closed
        })
        .inner
    })
    .inner
}
