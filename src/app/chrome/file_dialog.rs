//! A file dialog in the window, for systems without one.

use super::file_browser::{Answer, Browser};
use crate::app::jobs::Question;
use crate::app::state::{Command, Purpose};
use crate::platform::fs;
use eframe::egui::{Context, Id, Modal, Ui};
use std::path::{Path, PathBuf};

/// The open dialog or question, if any.
#[derive(Default)]
pub struct FileDialogMemory {
    dialog: Option<Browser>,
    /// The folder of the file that was chosen last, for questions without a folder.
    folder: Option<PathBuf>,
    replace: Option<(Purpose, PathBuf)>,
}

impl FileDialogMemory {
    pub fn is_open(&self) -> bool {
        self.dialog.is_some() || self.replace.is_some()
    }

    pub fn ask(&mut self, question: Question) {
        let folder = question.folder.clone().or_else(|| self.folder.clone());
        self.dialog = Some(Browser::new(&Question { folder, ..question }));
    }

    fn choose(&mut self, purpose: Purpose, path: PathBuf) -> Option<Command> {
        if purpose.reads() || !fs::exists(&path) {
            return Some(purpose.command(path));
        }
        self.replace = Some((purpose, path));
        None
    }
}

pub fn show(ctx: &Context, memory: &mut FileDialogMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    if let Some(browser) = &mut memory.dialog
        && let Some(answer) = browser.show(ctx)
    {
        let purpose = browser.purpose;
        memory.dialog = None;
        if let Answer::Chosen(path) = answer {
            memory.folder = path.parent().map(Path::to_path_buf);
            asked.extend(memory.choose(purpose, path));
        }
    }
    if let Some((purpose, path)) = memory.replace.clone() {
        let answer = Modal::new(Id::unique("replace")).show(ctx, |ui| replace(ui, &path));
        let answer = answer.inner.or(answer.should_close().then_some(false));
        match answer {
            Some(true) => asked.push(purpose.command(path)),
            Some(false) => {}
            None => return asked,
        }
        memory.replace = None;
    }
    asked
}

fn replace(ui: &mut Ui, path: &Path) -> Option<bool> {
    ui.set_width(320.0);
    ui.strong("Replace the file?");
    ui.label(format!("{} is there already.", path.display()));
    ui.horizontal(|ui| {
        let keep = ui.button("Keep it").clicked().then_some(false);
        keep.or(ui.button("Replace").clicked().then_some(true))
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{DocumentCommand, ExportCommand};
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    fn panel(question: Question) -> Harness<'static, (FileDialogMemory, Vec<Command>)> {
        let mut memory = FileDialogMemory::default();
        memory.ask(question);
        let mut dialog = seen::asking_with([700.0, 500.0], memory, |ui, memory| show(ui.ctx(), memory));
        dialog.run_steps(3);
        dialog
    }

    #[test]
    fn a_file_that_is_there_is_replaced_only_when_asked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, "").unwrap();
        let question = Question::beside(Purpose::SaveScene, Some(&path));
        for (answer, asked) in
            [("Keep it", vec![]), ("Replace", vec![Command::Document(DocumentCommand::SaveTo(path.clone()))])]
        {
            let mut dialog = panel(question.clone());
            dialog.clicks(&["Save"]);
            assert!(dialog.state().1.is_empty(), "not yet");
            dialog.clicks(&[answer]);
            assert_eq!(dialog.state().1, asked);
            assert!(!dialog.state().0.is_open());
        }
    }

    #[test]
    fn a_name_without_an_ending_does_not_replace_a_file() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("maps.npz"), "").unwrap();
        let question = Question { name: "maps".to_owned(), ..Question::beside(Purpose::ExportMaps, None) };
        let mut dialog = panel(Question { folder: Some(folder.path().to_path_buf()), ..question });
        dialog.clicks(&["Save"]);
        assert!(dialog.state().1.is_empty() && dialog.state().0.is_open());
        let _asked = dialog.get_by_label("Replace");
    }

    #[test]
    fn the_next_question_begins_in_the_last_folder() {
        let folder = tempfile::tempdir().unwrap();
        let question = Question::beside(Purpose::ExportMaps, Some(&folder.path().join("scene.toml")));
        let mut dialog = panel(question);
        dialog.clicks(&["Save"]);
        dialog.state_mut().0.ask(Question::beside(Purpose::ExportMaps, None));
        dialog.run_steps(2);
        dialog.clicks(&["Save"]);
        let maps = || Command::Export(ExportCommand::MapsTo(folder.path().join("maps.npz")));
        assert_eq!(dialog.state().1, [maps(), maps()]);
    }
}
