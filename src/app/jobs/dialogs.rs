//! File dialogs of the system, off the UI thread. The chosen file comes back as a command. Where the system has no dialogs, the window shows its own.

use crate::app::state::{Command, DocumentCommand, Purpose, PurposeFacts, RowsCommand};
use crate::platform::{self, FileQuestion, Instant};
use eframe::egui::DroppedFile;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// Least time for which a dialog is on screen: no user closes one sooner.
const MIN_DIALOG_TIME: Duration = Duration::from_millis(250);

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    pub purpose: Purpose,
    /// The folder that the dialog begins in.
    pub folder: Option<PathBuf>,
    /// Name of the file where the user chooses no other.
    pub name: String,
}

impl Question {
    /// A question with the usual name, in the folder of `document` where it has one.
    pub fn beside(purpose: Purpose, document: Option<&Path>) -> Question {
        let stem = document.and_then(Path::file_stem).filter(|_| purpose == Purpose::SaveScene);
        let name = match stem {
            Some(stem) => format!("{}.toml", stem.to_string_lossy()),
            None => purpose.facts().name.to_owned(),
        };
        let folder = document.and_then(Path::parent).filter(|p| !p.as_os_str().is_empty()).map(Path::to_path_buf);
        Question { purpose, folder, name }
    }

    fn at(purpose: Purpose, path: &Path) -> Question {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        Question { purpose, folder: path.parent().map(Path::to_path_buf), name }
    }

    fn for_the_system(&self) -> FileQuestion {
        let PurposeFacts { title, kind, endings, .. } = self.purpose.facts();
        FileQuestion {
            title: title.to_owned(),
            kind: kind.to_owned(),
            endings: endings.iter().map(|e| (*e).to_owned()).collect(),
            folder: self.folder.clone(),
            name: self.name.clone(),
            reads: self.purpose.reads(),
        }
    }
}

/// Opens a dialog of the system. The reply comes later, with `None` where the dialog was closed without a file or could not be shown.
type System = Arc<dyn Fn(FileQuestion, Reply) -> std::io::Result<()>>;

type Reply = Box<dyn FnOnce(Option<PathBuf>) + Send>;

enum Answer {
    Chosen(Command),
    /// A question that the window asks once more.
    Again(Question),
    NotShown(Question),
    Unreadable(String),
}

/// File dialogs on threads of their own: a window that waits for one would look dead.
pub struct Dialogs {
    /// The system's dialog; `None` where the system has none.
    system: Option<System>,
    answers: (Sender<Answer>, Receiver<Answer>),
    unanswered: Option<Question>,
    /// Message for the first question that the window's own dialog asks.
    apology: Option<&'static str>,
    told: Option<&'static str>,
}

/// Message where the system has no dialogs, shown once.
const NO_DIALOG_MESSAGE: &str = "This system shows no file dialog (no portal, no zenity), so the window shows its own.";

impl Dialogs {
    /// Dialogs of the system, as long as it shows any.
    pub fn of_the_system() -> Self {
        let [bus, runtime, path] = ["DBUS_SESSION_BUS_ADDRESS", "XDG_RUNTIME_DIR", "PATH"].map(std::env::var_os);
        match cfg!(not(target_os = "linux")) || may_have_dialogs(bus, runtime, path) {
            true => Dialogs::by(Some(Arc::new(platform::choose_file))),
            false => Dialogs { apology: Some(NO_DIALOG_MESSAGE), ..Dialogs::by(None) },
        }
    }

    pub fn of_the_window() -> Self {
        Dialogs::by(None)
    }

    fn by(system: Option<System>) -> Self {
        Dialogs { system, answers: channel(), unanswered: None, apology: None, told: None }
    }

    /// Asks the user for a file; [`Dialogs::poll`] returns the command later.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn ask(&mut self, question: Question, wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<()> {
        let Some(system) = self.system.clone() else {
            self.unanswered = Some(question);
            self.told = self.apology.take();
            return Ok(());
        };
        let answers = self.answers.0.clone();
        let began = Instant::now();
        let asked = question.for_the_system();
        let reply = move |path: Option<PathBuf>| {
            let answer = match path.map(|path| (question.purpose.destination(path.clone()), path)) {
                Some((Err(why), _)) => Answer::Unreadable(why),
                // The system asked about another name, so the window asks about this one.
                Some((Ok(path), chosen)) if path != chosen && platform::fs::exists(&path) => {
                    Answer::Again(Question::at(question.purpose, &path))
                }
                Some((Ok(path), _)) => Answer::Chosen(question.purpose.command(path)),
                None if began.elapsed() < MIN_DIALOG_TIME => Answer::NotShown(question),
                None => return,
            };
            // The window may be gone by now.
            let _closed = answers.send(answer);
            wake();
        };
        system(asked, Box::new(reply))
    }

    /// The commands of files chosen since the last call, messages about unreadable files, and a message where the system turns out to have no dialogs.
    pub fn poll(&mut self) -> (Vec<Command>, Vec<String>, Option<&'static str>) {
        let (mut chosen, mut problems, mut told) = (Vec::new(), Vec::new(), self.told.take());
        while let Ok(answer) = self.answers.1.try_recv() {
            match answer {
                Answer::Chosen(command) => chosen.push(command),
                Answer::Unreadable(problem) => problems.push(problem),
                Answer::Again(question) => self.unanswered = Some(question),
                Answer::NotShown(question) => {
                    self.unanswered = Some(question);
                    if self.system.take().is_some() {
                        told = Some(NO_DIALOG_MESSAGE);
                    }
                }
            }
        }
        (chosen, problems, told)
    }

    /// Opens a file dropped on the window; [`Dialogs::poll`] returns the command, at once or later.
    pub fn open_dropped(&self, file: &Arc<dyn DroppedFile + Send + Sync>, wake: impl Fn() + 'static) {
        let answers = self.answers.0.clone();
        let name = file.path().display().to_string();
        platform::dropped(file, move |read| {
            let answer = match read {
                Ok(path) => Answer::Chosen(command_of_dropped(path)),
                Err(why) => Answer::Unreadable(format!("{name} can't be read: {why}")),
            };
            // The window may be gone by now.
            let _closed = answers.send(answer);
            wake();
        });
    }

    /// A question for the window's own dialog.
    pub fn take_unanswered(&mut self) -> Option<Question> {
        self.unanswered.take()
    }
}

fn command_of_dropped(path: PathBuf) -> Command {
    match crate::files::ends_in(&path, &["csv"]) {
        true => Command::Rows(RowsCommand::OpenTable(path)),
        false => Command::Document(DocumentCommand::OpenPath(path)),
    }
}

/// Whether the system can show a dialog: a portal is reached over the session's bus, and `zenity` is a program. Without either, the system's answer comes too
/// late to tell it from a closed dialog.
fn may_have_dialogs(bus: Option<OsString>, runtime: Option<OsString>, path: Option<OsString>) -> bool {
    let has_bus = bus.is_some_and(|b| !b.is_empty()) || runtime.is_some_and(|r| Path::new(&r).join("bus").exists());
    has_bus || path.is_some_and(|p| std::env::split_paths(&p).any(|folder| folder.join("zenity").exists()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(dialogs: &mut Dialogs, question: Question) -> (Vec<Command>, Option<&'static str>) {
        let (wake, woken) = channel();
        dialogs.ask(question, move || wake.send(()).unwrap()).unwrap();
        // A closed dialog of the system calls no `wake`, and one of the window need not.
        let _closed = woken.recv_timeout(Duration::from_secs(2));
        let (chosen, _, told) = dialogs.poll();
        (chosen, told)
    }

    #[test]
    fn a_system_shows_dialogs_by_a_bus_or_zenity() {
        let folder = tempfile::tempdir().unwrap();
        let there = || Some(folder.path().as_os_str().to_owned());
        assert!(!may_have_dialogs(None, None, None) && !may_have_dialogs(Some("".into()), there(), there()));
        assert!(may_have_dialogs(Some("unix:path=/bus".into()), None, None));
        std::fs::write(folder.path().join("zenity"), "").unwrap();
        assert!(may_have_dialogs(None, None, there()));
        std::fs::write(folder.path().join("bus"), "").unwrap();
        assert!(may_have_dialogs(None, there(), None));
    }

    #[test]
    fn a_system_without_dialogs_is_told_once() {
        let mut dialogs = Dialogs { apology: Some(NO_DIALOG_MESSAGE), ..Dialogs::by(None) };
        for told in [Some(NO_DIALOG_MESSAGE), None] {
            dialogs.ask(Question::beside(Purpose::Open, None), || ()).unwrap();
            assert_eq!(dialogs.poll(), (Vec::new(), Vec::new(), told), "told once");
            assert!(dialogs.take_unanswered().is_some());
        }
    }

    #[test]
    fn a_dialog_begins_with_name_and_folder_of_the_file() {
        let path = Path::new("/scenes/a.npz");
        let named = |purpose, path| Question::beside(purpose, path).name;
        assert_eq!(named(Purpose::SaveScene, Some(path)), "a.toml");
        assert_eq!(named(Purpose::ExportMaps, Some(path)), "maps.npz");
        assert_eq!(named(Purpose::SaveScene, None), "scene.toml");
        assert_eq!(named(Purpose::SaveScene, Some(Path::new("chip-8-overlay.toml"))), "chip-8-overlay.toml");
        let folder = |path: &str| Question::beside(Purpose::Open, Some(Path::new(path))).folder;
        assert_eq!(folder("/scenes/a.npz").as_deref(), Some(Path::new("/scenes")));
        assert_eq!(folder("chip-8-overlay.toml"), None);
    }

    #[test]
    fn where_the_system_shows_no_dialog_the_window_asks() {
        let mut dialogs = Dialogs::by(Some(Arc::new(|_, reply| {
            reply(None);
            Ok(())
        })));
        for (purpose, told) in [(Purpose::Open, Some(NO_DIALOG_MESSAGE)), (Purpose::SaveScene, None)] {
            let question = || Question::beside(purpose, Some(Path::new("/scenes/a.npz")));
            assert_eq!(answer(&mut dialogs, question()), (Vec::new(), told), "told once");
            assert_eq!(dialogs.take_unanswered(), Some(question()));
        }
        assert_eq!(dialogs.take_unanswered(), None);
    }

    /// Commands, message and question that follow where the user closes every dialog except the one for a scene to open.
    fn answered(purpose: Purpose) -> (Vec<Command>, Option<&'static str>, Option<Question>) {
        let slow: System = Arc::new(|question, reply| {
            std::thread::sleep(MIN_DIALOG_TIME + Duration::from_millis(50));
            reply((question.title == Purpose::Open.facts().title).then(|| PathBuf::from("a.toml")));
            Ok(())
        });
        let mut dialogs = Dialogs::by(Some(slow));
        let (chosen, told) = answer(&mut dialogs, Question::beside(purpose, None));
        (chosen, told, dialogs.take_unanswered())
    }

    #[test]
    fn a_chosen_scene_is_opened_and_a_closed_dialog_is_no_failure() {
        let chosen = vec![Command::Document(DocumentCommand::OpenPath("a.toml".into()))];
        assert_eq!(answered(Purpose::Open).0, chosen);
        assert_eq!(answered(Purpose::ExportMaps), (Vec::new(), None, None));
    }
}
