//! Undo and redo: whole scenes, shared, with what was done to them.

use super::Selection;
use crate::scene::Scene;
use std::sync::Arc;

/// Steps that are kept.
const LIMIT: usize = 500;

/// A scene as it was.
#[derive(Debug, Clone)]
pub(super) struct Snapshot {
    pub scene: Arc<Scene>,
    pub selection: Selection,
}

#[derive(Debug, Clone)]
struct Step {
    label: String,
    /// Edits with the same key merge into one step until the history is sealed.
    merge_key: Option<String>,
    before: Snapshot,
}

/// What was done, and what was undone.
#[derive(Debug, Clone, Default)]
pub struct History {
    done: Vec<Step>,
    undone: Vec<Step>,
    sealed: bool,
}

impl History {
    /// Records that `label` happened to `before`.
    pub(super) fn push(&mut self, label: &str, merge_key: Option<&str>, before: Snapshot) {
        self.undone.clear();
        let merges = !self.sealed
            && merge_key.is_some()
            && self.done.last().is_some_and(|s| s.merge_key.as_deref() == merge_key);
        self.sealed = false;
        if !merges {
            self.done.push(Step { label: label.to_owned(), merge_key: merge_key.map(str::to_owned), before });
            if self.done.len() > LIMIT {
                self.done.remove(0);
            }
        }
    }

    /// Ends the current step: the next edit starts a new one whatever its key.
    pub fn seal(&mut self) {
        self.sealed = true;
    }

    /// What undo would undo.
    pub fn undo_label(&self) -> Option<&str> {
        self.done.last().map(|s| s.label.as_str())
    }

    /// What redo would redo.
    pub fn redo_label(&self) -> Option<&str> {
        self.undone.last().map(|s| s.label.as_str())
    }

    /// Steps that can be undone.
    pub fn depth(&self) -> usize {
        self.done.len()
    }

    pub(super) fn undo(&mut self, now: Snapshot) -> Option<Snapshot> {
        Self::step(&mut self.done, &mut self.undone, now)
    }

    pub(super) fn redo(&mut self, now: Snapshot) -> Option<Snapshot> {
        Self::step(&mut self.undone, &mut self.done, now)
    }

    fn step(from: &mut Vec<Step>, to: &mut Vec<Step>, now: Snapshot) -> Option<Snapshot> {
        let step = from.pop()?;
        to.push(Step { label: step.label, merge_key: None, before: now });
        Some(step.before)
    }
}
