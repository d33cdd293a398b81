//! Texts in the place of a map's picture, where there is none or where it is hidden.

use crate::app::state::{Command, ViewCommand};
use crate::app::widgets::{Inks, press};
use eframe::egui::text::LayoutJob;
use eframe::egui::{self, Align, Painter, Rect, Ui, vec2};

/// Reason for a missing picture.
pub struct Problem<'a> {
    pub reason: &'a str,
    /// Name of a method that works instead.
    pub instead: Option<&'static str>,
}

/// Draws the text in the place of a missing picture, and the button of a method that works.
pub fn empty(ui: &mut Ui, painter: &Painter, rect: Rect, error: Option<&Problem<'_>>, asked: &mut Vec<Command>) {
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    let text = error.map_or("computing…", |e| e.reason);
    let place = Rect::from_center_size(rect.center(), vec2((rect.width() - 16.0).max(40.0), 76.0));
    ui.scope_builder(egui::UiBuilder::new().max_rect(place), |ui| {
        ui.vertical_centered(|ui| {
            ui.add(egui::Label::new(egui::RichText::new(text).size(12.0).weak()).wrap().selectable(false));
            if let Some(instead) = error.and_then(|e| e.instead) {
                let tip = "A method that works here";
                press(ui, format!("Use {instead}"), tip, ViewCommand::Method(instead), asked);
            }
        });
    });
}

/// Draws the text of a hidden map, at its top since many peaks are in the middle. A map that waits for a click stands out.
pub fn veil(painter: &Painter, rect: Rect, is_clicked: bool, visuals: &egui::Visuals) {
    let (text, ink, size) = match is_clicked {
        true => ("Click where you expect it", Inks::of(visuals).selected, 16.0),
        false => ("Hidden until you have predicted.", visuals.weak_text_color(), 13.0),
    };
    let font = egui::FontId::proportional(size);
    let mut job = LayoutJob::simple(text.to_owned(), font, ink, (rect.width() - 8.0).max(40.0));
    job.halign = Align::Center;
    painter.galley(rect.center_top() + vec2(0.0, 10.0), painter.layout_job(job), ink);
    if is_clicked {
        painter.rect_stroke(rect.shrink(1.0), 0.0, egui::Stroke::new(2.0, ink), egui::StrokeKind::Inside);
    }
}
