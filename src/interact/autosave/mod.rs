//! Copies of unsaved documents that outlive a crash or a kill. Every window has its own.
//!
//! ```text
//!   autosave.toml              the document on screen, while it is unsaved
//!   autosave.behind-3.toml     an unsaved one that another took the place of
//!   autosave.lock              held while the window lives
//!   autosave-2.toml, ..        a second window's
//! ```
//!
//! Each is a scene file with a table that says where the document belongs. Files are written on a thread of their own.

mod store;

use super::{Editor, Restored};
use crate::platform::{self, Claim, Instant, fs};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;
use store::{AutosaveStore, StartPlan};

/// Shortest time between two copies: no hand makes two edits in it.
const MIN_COPY_INTERVAL: Duration = Duration::from_millis(250);

/// Most windows that keep copies at once.
const SLOTS: u32 = 64;

type Answer = Result<(), String>;

/// The copies of one window.
pub struct Autosave {
    store: AutosaveStore,
    jobs: Option<Sender<StartPlan>>,
    answers: (Sender<Answer>, Receiver<Answer>),
    pending: usize,
    thread: Option<JoinHandle<()>>,
    last: Option<(StartPlan, Instant)>,
    /// Held while the window lives; the system releases it however the process ends. It is the last field, so that the thread ends before.
    _lock: Option<fs::Lock>,
}

impl Autosave {
    /// Takes the first slot in `folder` that no other window holds. A slot with copies of a dead window comes first.
    ///
    /// Where the file system has no locks, the first slot is shared.
    /// # Errors
    /// When the system can't start a thread.
    pub fn claim(folder: &Path) -> std::io::Result<Autosave> {
        // Without a folder there is no lock; writing a copy will say why.
        let _reported_later = fs::create_dir_all(folder);
        let (stem, lock) = claim_slot(folder);
        let store = AutosaveStore::new(folder, stem);
        let answers = channel();
        let (jobs, thread) = match platform::WRITES_WAIT {
            true => writer(store.clone(), answers.0.clone()).map(|(jobs, thread)| (Some(jobs), Some(thread)))?,
            false => (None, None),
        };
        Ok(Autosave { store, jobs, answers, pending: 0, thread, last: None, _lock: lock })
    }

    /// Reads the copies of a dead window in this slot. A file that can't be read is set aside, not deleted.
    pub fn restore(&self) -> Restored {
        self.store.restore()
    }

    /// Keeps copies of the unsaved documents of `editor`, and deletes the copies of saved ones; at most every 250 ms, except where another document
    /// came on screen. Returns the time until the next copy may be made, if this one had to wait.
    ///
    /// To be called after every change, and never during a drag.
    pub fn keep(&mut self, editor: &Editor) -> Option<Duration> {
        let plan = StartPlan::of(editor);
        if let Some((last, when)) = &self.last {
            if last.is_same(&plan) {
                return None;
            }
            if let Some(wait) = MIN_COPY_INTERVAL.checked_sub(when.elapsed()).filter(|_| last.has_same_documents(&plan))
            {
                return Some(wait);
            }
        }
        self.ask(plan);
        None
    }

    /// Keeps copies at once and waits until they are on disk: the window is closing.
    /// # Errors
    /// Name of a file that could not be written, and the reason.
    pub fn keep_now(&mut self, editor: &Editor) -> Result<(), String> {
        self.ask(StartPlan::of(editor));
        let mut result = Ok(());
        while self.pending > 0 {
            self.pending -= 1;
            result = self.answers.1.recv().unwrap_or_else(|_| Err("the autosave has stopped".to_owned()));
        }
        result
    }

    /// Whether the unsaved documents of `editor` are on disk as they are.
    pub fn holds(&self, editor: &Editor) -> bool {
        !self.is_busy() && self.last.as_ref().is_some_and(|(last, _)| last.is_same(&StartPlan::of(editor)))
    }

    /// Errors since the last call.
    pub fn poll(&mut self) -> Vec<String> {
        let mut problems = Vec::new();
        while let Ok(answer) = self.answers.1.try_recv() {
            self.pending -= 1;
            problems.extend(answer.err());
        }
        problems
    }

    /// Whether files are being written.
    pub fn is_busy(&self) -> bool {
        self.pending > 0
    }

    fn ask(&mut self, plan: StartPlan) {
        self.last = Some((plan.clone(), Instant::now()));
        let sent = match &self.jobs {
            Some(jobs) => jobs.send(plan).is_ok(),
            None => self.answers.0.send(self.store.carry_out(&plan)).is_ok(),
        };
        self.pending += usize::from(sent);
    }
}

impl Drop for Autosave {
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was reported for each file that it did not write.
            let _panicked = thread.join();
        }
    }
}

/// Starts the thread that writes files. Only the latest plan of those that wait matters; each has an answer.
fn writer(mut store: AutosaveStore, answer: Sender<Answer>) -> std::io::Result<(Sender<StartPlan>, JoinHandle<()>)> {
    let (jobs, asked) = channel::<StartPlan>();
    let work = move || {
        while let Ok(plan) = asked.recv() {
            let plans: Vec<StartPlan> = std::iter::once(plan).chain(asked.try_iter()).collect();
            let count = plans.len();
            let result = plans.into_iter().next_back().map_or(Ok(()), |p| store.carry_out(&p));
            for answered in 1..=count {
                let result = if answered == count { result.clone() } else { Ok(()) };
                if answer.send(result).is_err() {
                    return;
                }
            }
        }
    };
    std::thread::Builder::new().name("autosave".to_owned()).spawn(work).map(|thread| (jobs, thread))
}

fn claim_slot(folder: &Path) -> (String, Option<fs::Lock>) {
    let name = |slot: u32| if slot == 1 { "autosave".to_owned() } else { format!("autosave-{slot}") };
    let lock_path = |slot: u32| -> PathBuf { folder.join(format!("{}.lock", name(slot))) };
    let mut free = None;
    for slot in 1..=SLOTS {
        match fs::claim(&lock_path(slot)) {
            Claim::Ours(lock) if AutosaveStore::new(folder, name(slot)).has_copies() => {
                return (name(slot), Some(lock));
            }
            Claim::Ours(lock) => _ = free.get_or_insert((name(slot), lock)),
            Claim::Theirs => {}
            Claim::Unavailable => break,
        }
        // Slots are taken in order: behind a free one without its lock file there is nothing.
        if free.is_some() && !fs::exists(&lock_path(slot + 1)) {
            break;
        }
    }
    free.map_or_else(|| (name(1), None), |(name, lock)| (name, Some(lock)))
}

#[cfg(test)]
mod tests;
