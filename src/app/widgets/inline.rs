//! Text with names of methods and commands between backticks, and of panels between asterisks.

use eframe::egui::text::LayoutJob;
use eframe::egui::{FontId, RichText, TextFormat, TextStyle, Ui};

/// Size of enlarged text, to be read first, relative to the rest.
pub const LARGE_TEXT_RATIO: f32 = 1.15;

pub fn large(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).size(LARGE_TEXT_RATIO * TextStyle::Body.resolve(ui.style()).size)
}

/// The text at `times` the normal size, without line breaks inside paragraphs. Words between backticks are in the font of code, words between asterisks in the
/// colour of strong text. Backticks and asterisks are left out.
pub fn inline(ui: &Ui, text: &str, times: f32) -> LayoutJob {
    let (visuals, size) = (ui.visuals(), times * TextStyle::Body.resolve(ui.style()).size);
    let plain = TextFormat::simple(FontId::proportional(size), visuals.text_color());
    let strong = TextFormat::simple(FontId::proportional(size), visuals.strong_text_color());
    let mut code = TextFormat::simple(FontId::monospace(0.93 * size), visuals.text_color());
    code.background = visuals.code_bg_color;
    let mut job = LayoutJob::default();
    for (i, piece) in text.trim().split('`').enumerate() {
        if i % 2 == 1 {
            job.append(piece, 0.0, code.clone());
            continue;
        }
        // Each paragraph on one line.
        let mut rest = piece.split("\n\n").map(|text| text.replace('\n', " ")).collect::<Vec<_>>().join("\n\n");
        while let Some((before, words, after)) = emphasis(&rest) {
            job.append(before, 0.0, plain.clone());
            job.append(words, 0.0, strong.clone());
            rest = after.to_owned();
        }
        job.append(&rest, 0.0, plain.clone());
    }
    job
}

/// The text before the first words between asterisks, those words, and the text behind them. `2 * 3` has no such words.
fn emphasis(text: &str) -> Option<(&str, &str, &str)> {
    let mut stars = text.match_indices('*').map(|(at, _)| at);
    let opens = |at: &usize| text[at + 1..].starts_with(|c: char| !c.is_whitespace() && c != '*');
    let begin = stars.find(opens)?;
    let end = stars.find(|at| !text[..*at].ends_with(char::is_whitespace))?;
    Some((&text[..begin], &text[begin + 1..end], &text[end + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness};
    use eframe::egui::FontFamily;

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

    #[test]
    fn words_between_asterisks_stand_out_in_paragraphs_of_one_line() {
        let text = Harness::builder().build_ui(|ui| {
            let job = inline(ui, "\nThe panel *Range-Doppler*\n(Y) shows 2 * 3 cells.\n\nChoose *OS*.\n", 1.15);
            let strong = job.sections.iter().filter(|s| s.format.color == ui.visuals().strong_text_color());
            let strong: Vec<&str> = strong.map(|s| &job.text[s.byte_range.start.0..s.byte_range.end.0]).collect();
            assert_eq!(strong, ["Range-Doppler", "OS"]);
            ui.label(job);
        });
        let expected = "The panel Range-Doppler (Y) shows 2 * 3 cells.\n\nChoose OS.";
        assert_eq!(seen::texts(text.output())[0].text, expected);
    }
}
