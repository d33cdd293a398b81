//! A folder's entries on screen, to choose a file or to name a new one.

use crate::app::jobs::Question;
use crate::app::state::Purpose;
use crate::files::ends_in;
use crate::platform::fs;
use eframe::egui::{self, Button, Context, Id, Key, Label, Modifiers, RichText, ScrollArea, TextEdit, Ui};
use std::path::{Path, PathBuf};

const MAX_LISTED: usize = 5000;

struct Entry {
    name: String,
    is_folder: bool,
}

/// The user's decision in the dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    Chosen(PathBuf),
    Cancelled,
}

/// The folder on screen and the text of the fields.
pub struct Browser {
    pub purpose: Purpose,
    folder: PathBuf,
    typed: String,
    name: String,
    /// Proposed name, for an empty field.
    usual: String,
    /// Whether hidden files and those of other kinds are listed.
    all: bool,
    entries: Vec<Entry>,
    problem: Option<String>,
    /// Whether the name's field was given the focus, so that a name can be typed at once.
    was_focused: bool,
}

impl Browser {
    /// Shows the question's folder, or the working directory.
    pub fn new(question: &Question) -> Self {
        let start = question.folder.clone().or_else(|| std::env::current_dir().ok());
        let (purpose, folder) = (question.purpose, start.unwrap_or_else(|| PathBuf::from("/")));
        let (name, usual) = (question.name.clone(), question.name.clone());
        let typed = folder.display().to_string();
        let (all, entries, problem, was_focused) = (false, Vec::new(), None, false);
        let mut browser = Browser { purpose, folder, typed, name, usual, all, entries, problem, was_focused };
        browser.list();
        browser
    }

    /// Goes to a folder; where it can't be read, stays and tells the problem.
    fn enter(&mut self, folder: PathBuf) {
        let before = std::mem::replace(&mut self.folder, folder);
        if !self.list() {
            self.folder = before;
        }
        self.typed = self.folder.display().to_string();
    }

    /// Reads the folder's entries; false where it can't be read.
    fn list(&mut self) -> bool {
        let read = match fs::read_dir(&self.folder) {
            Ok(read) => read,
            Err(error) => {
                self.problem = Some(format!("{}: {error}", self.folder.display()));
                return false;
            }
        };
        let endings = self.purpose.facts().endings;
        let listed = |entry: fs::DirEntry| {
            let path = entry.path();
            let (name, is_folder) = (entry.file_name().to_string_lossy().into_owned(), fs::is_dir(&path));
            let fits = self.all || (!name.starts_with('.') && (is_folder || ends_in(&path, endings)));
            fits.then_some(Entry { name, is_folder })
        };
        let mut entries: Vec<Entry> = read.filter_map(Result::ok).filter_map(listed).take(MAX_LISTED).collect();
        entries.sort_by_cached_key(|entry| (!entry.is_folder, entry.name.to_lowercase()));
        (self.entries, self.problem) = (entries, None);
        true
    }

    /// Draws the dialog; returns the user's decision once made.
    pub fn show(&mut self, ctx: &Context) -> Option<Answer> {
        let mut answer = None;
        let window = egui::Window::new(self.purpose.facts().title).id(Id::unique("file dialog")).collapsible(false);
        let size = ctx.content_rect().size();
        let window = window.default_size([480.0f32.min(size.x - 40.0), 380.0f32.min(size.y - 80.0)]);
        window.pivot(egui::Align2::CENTER_CENTER).default_pos(ctx.content_rect().center()).show(ctx, |ui| {
            self.place(ui);
            egui::Panel::bottom("file dialog foot").show_separator_line(false).show(ui, |ui| answer = self.foot(ui));
            let chosen = self.entries(ui);
            answer = answer.take().or(chosen);
        });
        let escaped = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
        answer.or(escaped.then_some(Answer::Cancelled))
    }

    fn place(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let label = ui.label("Folder");
            let up = ui.add_enabled(self.folder.parent().is_some(), Button::new("Up"));
            if up.on_hover_text("To the folder that this one is in").clicked()
                && let Some(parent) = self.folder.parent().map(Path::to_path_buf)
            {
                self.enter(parent);
            }
            let field =
                ui.add(TextEdit::singleline(&mut self.typed).desired_width(f32::INFINITY)).labelled_by(label.id);
            if field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter)) {
                self.enter(PathBuf::from(self.typed.trim()));
            }
        });
        if let Some(problem) = &self.problem {
            ui.add(Label::new(RichText::new(problem).color(ui.visuals().error_fg_color)).wrap());
        }
    }

    /// The folder's entries: a click goes into a folder or takes a file's name, a double click takes the file.
    fn entries(&mut self, ui: &mut Ui) -> Option<Answer> {
        let (mut into, mut chosen) = (None, None);
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            for entry in &self.entries {
                let text = if entry.is_folder { format!("{}/", entry.name) } else { entry.name.clone() };
                let response = ui.selectable_label(!entry.is_folder && entry.name == self.name, text);
                if response.clicked() && entry.is_folder {
                    into = Some(self.folder.join(&entry.name));
                } else if response.clicked() {
                    self.name.clone_from(&entry.name);
                }
                if response.double_clicked() && !entry.is_folder {
                    chosen = Some(Answer::Chosen(self.folder.join(&entry.name)));
                }
            }
            if self.entries.is_empty() {
                ui.weak("No matching files.");
            }
        });
        into.into_iter().for_each(|folder| self.enter(folder));
        chosen
    }

    fn foot(&mut self, ui: &mut Ui) -> Option<Answer> {
        let mut done = false;
        let mut answer = None;
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            let label = ui.label("Name");
            let field = ui.add(TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY)).labelled_by(label.id);
            done = field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
            if !std::mem::replace(&mut self.was_focused, true) {
                field.request_focus();
            }
        });
        ui.horizontal(|ui| {
            let verb = if self.purpose.reads() { "Open" } else { "Save" };
            let named = !self.name.trim().is_empty();
            done |= ui.add_enabled(named, Button::new(verb)).clicked();
            if ui.button("Cancel").clicked() {
                answer = Some(Answer::Cancelled);
            }
            let tip = "Hidden files and those of other kinds, too";
            if ui.checkbox(&mut self.all, "All files").on_hover_text(tip).changed() {
                self.list();
            }
            if !self.purpose.reads() && ui.button("New folder").clicked() {
                self.make_folder();
            }
            done &= named;
        });
        answer.or_else(|| done.then(|| self.choose()).flatten())
    }

    /// Enters a typed folder or chooses a typed file. A file to be read must exist.
    fn choose(&mut self) -> Option<Answer> {
        let path = self.folder.join(self.name.trim());
        if fs::is_dir(&path) {
            self.name.clone_from(&self.usual);
            self.enter(path);
            return None;
        }
        if self.purpose.reads() && !fs::exists(&path) {
            (self.problem, self.was_focused) = (Some(format!("{} is not there.", path.display())), false);
            return None;
        }
        match self.purpose.destination(path) {
            Ok(path) => Some(Answer::Chosen(path)),
            Err(problem) => {
                (self.problem, self.was_focused) = (Some(problem), false);
                None
            }
        }
    }

    fn make_folder(&mut self) {
        let path = self.folder.join("New folder");
        match fs::create_dir(&path) {
            Ok(()) => self.enter(path),
            Err(error) => self.problem = Some(format!("{}: {error}", path.display())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    fn panel(purpose: Purpose, folder: &Path) -> Harness<'static, (Browser, Vec<Answer>)> {
        let browser = Browser::new(&Question { purpose, folder: Some(folder.to_path_buf()), name: String::new() });
        let mut panel = seen::asking_with([700.0, 500.0], browser, |ui, browser| browser.show(ui.ctx()));
        panel.run_steps(3);
        panel
    }

    /// The dialog in a folder `walls`, and the folder above it.
    fn in_walls() -> (Harness<'static, (Browser, Vec<Answer>)>, tempfile::TempDir) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("walls")).unwrap();
        for name in ["walls/a.toml", "walls/notes.txt", "walls/.hidden.toml"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let mut dialog = panel(Purpose::Open, folder.path());
        seen::assert_readable(dialog.output());
        dialog.clicks(&["walls/"]);
        (dialog, folder)
    }

    #[test]
    fn a_folder_lists_files_of_the_kind_and_leads_up() {
        let (mut dialog, _folder) = in_walls();
        assert!(dialog.query_by_label("notes.txt").is_none() && dialog.query_by_label(".hidden.toml").is_none());
        dialog.clicks(&["All files"]);
        let _listed = (dialog.get_by_label("notes.txt"), dialog.get_by_label("a.toml"));
        dialog.clicks(&["Up"]);
        let _above = dialog.get_by_label("walls/");
    }

    #[test]
    fn a_name_that_can_not_be_taken_is_told() {
        for (purpose, name, button, told) in [
            (Purpose::Open, "missing.toml", "Open", "missing.toml is not there"),
            (Purpose::ExportPicture, "window.jpg", "Save", "expected .png or .svg"),
        ] {
            let folder = tempfile::tempdir().unwrap();
            let mut dialog = panel(purpose, folder.path());
            // The name's field has the focus.
            dialog.event(egui::Event::Text(name.to_owned()));
            dialog.run_steps(2);
            dialog.clicks(&[button]);
            assert!(dialog.state().1.is_empty());
            let _told = dialog.get_by_label_contains(told);
        }
    }

    #[test]
    fn a_file_is_chosen_before_it_is_opened() {
        let (mut dialog, folder) = in_walls();
        dialog.clicks(&["a.toml"]);
        assert!(dialog.state().1.is_empty(), "chosen, not opened");
        dialog.clicks(&["Open"]);
        assert_eq!(dialog.state().1, [Answer::Chosen(folder.path().join("walls/a.toml"))]);
        dialog.presses(&[Key::Escape]);
        assert_eq!(dialog.state().1.last(), Some(&Answer::Cancelled));
    }

    #[test]
    fn a_folder_that_can_not_be_read_is_not_entered() {
        let folder = tempfile::tempdir().unwrap();
        let mut dialog = panel(Purpose::Open, folder.path());
        dialog.clicks(&["Name", "Folder"]);
        dialog.event(egui::Event::Text("/nowhere".to_owned()));
        dialog.presses(&[Key::Enter]);
        assert_eq!(dialog.state().0.folder, folder.path());
    }
}
