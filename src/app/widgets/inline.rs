//! Text with names of methods and commands in it, written between backticks.

use eframe::egui::text::LayoutJob;
use eframe::egui::{FontId, TextFormat, TextStyle, Ui};

/// The text, so many times as large as others, what stands between backticks in the font of code, without them.
pub fn inline(ui: &Ui, text: &str, times: f32) -> LayoutJob {
    let (visuals, size) = (ui.visuals(), times * TextStyle::Body.resolve(ui.style()).size);
    let plain = TextFormat::simple(FontId::proportional(size), visuals.text_color());
    let mut code = TextFormat::simple(FontId::monospace(0.93 * size), visuals.text_color());
    code.background = visuals.code_bg_color;
    let mut job = LayoutJob::default();
    for (i, piece) in text.split('`').enumerate() {
        job.append(piece, 0.0, if i % 2 == 1 { code.clone() } else { plain.clone() });
    }
    job
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use eframe::egui::FontFamily;
    use egui_kittest::Harness;

    #[test]
    fn no_backtick_is_shown() {
        let text = Harness::builder().build_ui(|ui| {
            let job = inline(ui, "The method `live` draws it, `nomp` searches.", 1.15);
            let code = job.sections.iter().filter(|s| s.format.font_id.family == FontFamily::Monospace);
            assert_eq!(code.count(), 2);
            ui.label(job);
        });
        assert_eq!(seen::texts(text.output())[0].text, "The method live draws it, nomp searches.");
    }
}
