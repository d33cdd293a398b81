//! The filter: an expression with completion, and a mark where it is wrong.

use crate::evaluate::filter::{Filter, FilterError, complete};
use eframe::egui::text::{CCursor, CharIndex};
use eframe::egui::text_edit::TextEditOutput;
use eframe::egui::{
    self, CompletionPopup, CompletionQuery, Label, RectAlign, RichText, Stroke, Suggestion, TextEdit, Ui, vec2,
};

/// The typed expression, and the filter that it means.
#[derive(Default)]
pub struct FilterMemory {
    pub text: String,
    read: Option<(String, usize)>,
    /// The last valid filter; `None` for all rows.
    pub filter: Option<Filter>,
    error: Option<FilterError>,
}

impl FilterMemory {
    /// Parses the expression, unless it was parsed before.
    fn read(&mut self, methods: &[&str]) {
        let now = (self.text.clone(), methods.len());
        if self.read.as_ref() == Some(&now) {
            return;
        }
        self.read = Some(now);
        let read = match self.text.trim() {
            "" => Ok(None),
            _ => Filter::parse(&self.text, methods).map(Some),
        };
        match read {
            // The rows stay as they were while an expression is unfinished.
            Err(error) => self.error = Some(error),
            Ok(filter) => (self.filter, self.error) = (filter, None),
        }
    }
}

/// Draws the field. Expressions may name `methods`.
pub fn show(ui: &mut Ui, methods: &[&str], memory: &mut FilterMemory) {
    let edit = ui.horizontal(|ui| {
        let label = ui.label("Filter");
        let id = ui.make_persistent_id("filter of rows");
        let edit = TextEdit::singleline(&mut memory.text)
            .hint_text("live.squared_error > 800 & objects >= 4")
            .desired_width(f32::INFINITY);
        let popup = CompletionPopup::new(id).word_boundary(is_boundary).align(RectAlign::BOTTOM_START);
        let edit = popup.show(ui, edit, |query| suggestions(query, methods)).text_edit;
        let _labelled = edit.response.response.clone().labelled_by(label.id);
        edit
    });
    memory.read(methods);
    if let Some(error) = &memory.error {
        mark(ui, &edit.inner, error.column, ui.visuals().error_fg_color);
    }
}

pub fn problem(ui: &mut Ui, memory: &FilterMemory) {
    if let Some(error) = &memory.error {
        ui.add(Label::new(RichText::new(error.to_string()).color(ui.visuals().error_fg_color)).wrap());
    }
}

/// Underlines the character at `column`, counted from 1.
fn mark(ui: &Ui, edit: &TextEditOutput, column: usize, ink: egui::Color32) {
    let at =
        |index: usize| edit.galley.pos_from_cursor(CCursor::new(CharIndex(index))).translate(edit.galley_pos.to_vec2());
    let (from, to) = (at(column.saturating_sub(1)), at(column));
    let painter = ui.painter().with_clip_rect(edit.response.response.rect.expand(4.0));
    let line = from.left()..=to.left().max(from.left() + 6.0);
    painter.hline(line, from.bottom(), Stroke::new(2.0, ink));
    let tip = from.left_bottom();
    let arrow = vec![tip, tip + vec2(-3.5, 5.0), tip + vec2(3.5, 5.0)];
    painter.add(egui::Shape::convex_polygon(arrow, ink, Stroke::NONE));
}

/// Whether a character separates names. A dot does, since another name follows it.
fn is_boundary(c: char) -> bool {
    !(c.is_alphanumeric() || matches!(c, '_' | '-'))
}

/// Completions of the word before the cursor; none for an empty word, so that Enter and Tab keep their meaning.
fn suggestions(query: &CompletionQuery<'_>, methods: &[&str]) -> Vec<Suggestion> {
    let (start, end) = (query.word_range.start.0, query.word_range.end.0);
    let found = complete(query.text, end, methods);
    let after_dot = query.text.chars().nth(end.wrapping_sub(1)) == Some('.');
    if found.start >= end && !after_dot {
        return Vec::new();
    }
    // A number and its minus belong to the word of the field, but not to the name.
    let before: String = query.text.chars().skip(start).take(found.start.saturating_sub(start)).collect();
    found.candidates.into_iter().map(|name| Suggestion::new(format!("{before}{name}")).content(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{Harness, Queryable, User};

    fn field() -> Harness<'static, FilterMemory> {
        let draw = |ui: &mut Ui, memory: &mut FilterMemory| {
            show(ui, &["live", "nomp"], memory);
            problem(ui, memory);
        };
        Harness::builder().with_size([500.0, 300.0]).build_ui_state(draw, FilterMemory::default())
    }

    fn write(field: &mut Harness<'_, FilterMemory>, text: &str) {
        field.get_by_label("Filter").focus();
        field.step();
        field.get_by_label("Filter").type_text(text);
        field.run_steps(3);
    }

    #[test]
    fn names_are_completed() {
        let mut field = field();
        write(&mut field, "nomp.squ");
        field.presses(&[egui::Key::Enter]);
        assert_eq!(field.state().text, "nomp.squared_error");
        assert!(field.state().filter.is_none() && field.state().error.is_some(), "it is no expression yet");
    }

    #[test]
    fn an_expression_is_read_when_typed_and_a_mistake_pointed_at() {
        let mut field = field();
        write(&mut field, "nomp.objects > 3");
        assert!(field.state().error.is_none());
        let filter = Filter::parse("nomp.objects > 3", &["live", "nomp"]).unwrap();
        assert_eq!(field.state().filter.as_ref(), Some(&filter));
        write(&mut field, " & objcts = 2");
        assert_eq!(field.state().filter.as_ref(), Some(&filter), "the last filter stays");
        let _told = field.get_by_label_contains("column 20:");
    }
}
