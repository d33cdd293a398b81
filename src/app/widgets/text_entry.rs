//! A field for a text that is read as a whole once its entry ends.

use eframe::egui::{Id, TextEdit, Ui};

/// Maximum length of an entry, characters.
const MAX_CHARACTERS: usize = 100_000;

/// An entry that has not been accepted.
#[derive(Clone)]
struct Typed {
    /// The text that the field showed before. Another one drops the entry.
    over: String,
    text: String,
    /// Reason why the entry is refused.
    problem: Option<String>,
}

/// A field of `width` points after its name. It shows `shown` until another text is typed. Once that entry ends, `read` makes its value or refuses it;
/// a refused entry stays, and [`entry_problem`] says why.
pub fn text_entry<T>(
    ui: &mut Ui,
    id: Id,
    (name, tooltip): (&str, &str),
    (shown, width): (String, f32),
    is_free: bool,
    read: impl FnOnce(&str) -> Result<T, String>,
) -> Option<T> {
    let typed = ui.data(|d| d.get_temp::<Typed>(id)).filter(|typed| typed.over == shown);
    let (mut text, mut problem) = typed.map_or_else(|| (shown.clone(), None), |typed| (typed.text, typed.problem));
    let label = ui.label(name).on_hover_text(tooltip);
    let edit = TextEdit::singleline(&mut text).char_limit(MAX_CHARACTERS).desired_width(width);
    let response = ui.add_enabled(is_free, edit).labelled_by(label.id);
    if response.changed() {
        problem = None;
    }
    let mut taken = None;
    if response.lost_focus() && text != shown {
        match read(&text) {
            Ok(value) => taken = Some(value),
            Err(why) => problem = Some(why),
        }
    }
    ui.data_mut(|d| match taken.is_none() && text != shown {
        true => _ = d.insert_temp(id, Typed { over: shown, text, problem }),
        false => d.remove::<Typed>(id),
    });
    taken
}

/// Writes why an entry is refused, if one is.
pub fn entry_problem(ui: &mut Ui, id: Id) {
    if let Some(problem) = ui.data(|d| d.get_temp::<Typed>(id)).and_then(|typed| typed.problem) {
        ui.colored_label(ui.visuals().error_fg_color, problem);
    }
}
