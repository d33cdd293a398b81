//! The question before a scene is written to a file that can't hold all of it, or that another program changed.

use crate::app::state::{Command, DocumentCommand, Doubt, SaveAnswer, SaveQuestion};
use eframe::egui::{Context, Id, Modal, Ui};

pub fn show(ctx: &Context, question: Option<&SaveQuestion>) -> Vec<Command> {
    let Some(question) = question else { return Vec::new() };
    let modal = Modal::new(Id::unique("save question")).show(ctx, |ui| draw(ui, question));
    let answer = modal.inner.or(modal.should_close().then_some(SaveAnswer::Cancel));
    answer.map(|v| Command::Document(DocumentCommand::AnswerSave(v))).into_iter().collect()
}

fn draw(ui: &mut Ui, question: &SaveQuestion) -> Option<SaveAnswer> {
    ui.set_width(360.0);
    let name = question.path.file_name().unwrap_or(question.path.as_os_str()).to_string_lossy();
    let [elsewhere, tip, anyway] = match &question.doubt {
        Doubt::Losses(losses) => {
            ui.strong(format!("{name} can't hold all of this scene"));
            ui.label("These changes would be lost:");
            for loss in losses {
                ui.label(format!("•  {loss}"));
            }
            ui.label("The scene on screen keeps everything; what of it is unsaved stays unsaved.");
            ["Save as TOML", "A file beside it that holds everything", "Save anyway"]
        }
        Doubt::Changed => {
            ui.strong(format!("{name} has changed"));
            ui.label("Another window or another program has written to it since it was opened or saved here.");
            ["Save as…", "Another file; this one stays as it is", "Replace it"]
        }
    };
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let elsewhere = ui.button(elsewhere).on_hover_text(tip);
        if ui.memory(|m| m.focused().is_none()) {
            elsewhere.request_focus();
        }
        let anyway = ui.button(anyway);
        let cancel = ui.button("Cancel");
        let answers = [(elsewhere, SaveAnswer::Elsewhere), (anyway, SaveAnswer::Anyway), (cancel, SaveAnswer::Cancel)];
        answers.into_iter().find(|(button, _)| button.clicked()).map(|(_, answer)| answer)
    })
    .inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable};
    use eframe::egui::Key;

    fn asked() -> Harness<'static, Vec<Command>> {
        let losses = ["its radar", "one line or cluster, which becomes 40 points"].map(str::to_owned).to_vec();
        let question = SaveQuestion { path: "/there/walls.npz".into(), doubt: Doubt::Losses(losses) };
        let mut question = seen::asking([800.0, 600.0], move |ui| show(ui.ctx(), Some(&question)));
        question.run();
        question
    }

    #[test]
    fn every_loss_is_listed() {
        let question = asked();
        for said in ["walls.npz", "its radar", "which becomes 40 points"] {
            assert!(question.query_by_label_contains(said).is_some(), "{said}");
        }
    }

    #[test]
    fn every_button_and_key_answers() {
        type Input = fn(&mut Harness<'static, Vec<Command>>);
        let cases: [(Input, SaveAnswer); 5] = [
            (|q| q.get_by_label("Save anyway").click(), SaveAnswer::Anyway),
            (|q| q.get_by_label("Save as TOML").click(), SaveAnswer::Elsewhere),
            (|q| q.get_by_label("Cancel").click(), SaveAnswer::Cancel),
            (|q| q.key_press(Key::Escape), SaveAnswer::Cancel),
            (|q| q.key_press(Key::Enter), SaveAnswer::Elsewhere),
        ];
        for (given, answer) in cases {
            let mut question = asked();
            assert!(question.state().is_empty(), "nothing happens by itself");
            given(&mut question);
            question.step();
            assert_eq!(question.state(), &[Command::Document(DocumentCommand::AnswerSave(answer))]);
        }
    }
}
