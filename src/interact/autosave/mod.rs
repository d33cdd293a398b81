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
use crate::task::{Reply, Task, Worker};
use std::path::{Path, PathBuf};
use std::time::Duration;
use store::{AutosaveStore, StartPlan};

/// Shortest time between two copies: no hand makes two edits in it.
const MIN_COPY_INTERVAL: Duration = Duration::from_millis(250);

/// Most windows that keep copies at once.
const MAX_WINDOWS: u32 = 64;

/// The copies of one window.
pub struct Autosave {
    store: AutosaveStore,
    /// Writes the latest plan of those that wait.
    worker: Worker<StartPlan, Result<(), String>>,
    /// Errors of plans that were carried out at once.
    problems: Vec<String>,
    is_busy: bool,
    last: Option<(StartPlan, Instant)>,
    /// Held while the window lives; the system releases it however the process ends.
    _lock: Option<fs::Lock>,
}

impl Autosave {
    /// Takes the first slot in `folder` that no other window holds. A slot with copies of a dead window comes first.
    ///
    /// Where the file system has no locks, the first slot is shared.
    pub fn claim(folder: &Path) -> Autosave {
        // Without a folder there is no lock; writing a copy will say why.
        let _reported_later = fs::create_dir_all(folder);
        let (stem, lock) = claim_slot(folder);
        let store = AutosaveStore::new(folder, stem);
        let kept = store.clone();
        let write = move |(): &mut (), plan: StartPlan, _: &Task| kept.carry_out(&plan);
        let worker = Worker::spawn("autosave", || (), write, || ());
        Autosave { store, worker, problems: Vec::new(), is_busy: false, last: None, _lock: lock }
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
        self.worker.cancel();
        self.wait();
        self.poll();
        let plan = StartPlan::of(editor);
        self.last = Some((plan.clone(), Instant::now()));
        self.store.carry_out(&plan)
    }

    fn wait(&self) {
        while self.worker.is_busy() {
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// Whether the unsaved documents of `editor` are on disk as they are.
    pub fn holds(&self, editor: &Editor) -> bool {
        !self.is_busy() && self.last.as_ref().is_some_and(|(last, _)| last.is_same(&StartPlan::of(editor)))
    }

    /// Errors since the last call.
    pub fn poll(&mut self) -> Vec<String> {
        self.is_busy &= self.worker.is_busy();
        let told = self.worker.replies().into_iter().filter_map(|reply| match reply {
            Reply::Done { result, .. } => result.err(),
            Reply::Panicked { message, .. } => Some(message),
        });
        std::mem::take(&mut self.problems).into_iter().chain(told).collect()
    }

    /// Whether files are being written.
    pub fn is_busy(&self) -> bool {
        self.is_busy
    }

    fn ask(&mut self, plan: StartPlan) {
        self.last = Some((plan.clone(), Instant::now()));
        self.is_busy = true;
        match platform::WRITES_WAIT {
            true => _ = self.worker.request(plan),
            false => self.problems.extend(self.store.carry_out(&plan).err()),
        }
    }
}

impl Drop for Autosave {
    fn drop(&mut self) {
        self.wait();
    }
}

fn claim_slot(folder: &Path) -> (String, Option<fs::Lock>) {
    let name = |slot: u32| if slot == 1 { "autosave".to_owned() } else { format!("autosave-{slot}") };
    let lock_path = |slot: u32| -> PathBuf { folder.join(format!("{}.lock", name(slot))) };
    let mut free = None;
    for slot in 1..=MAX_WINDOWS {
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
