//! Undo and redo: whole documents, shared.

use super::{Document, Selection};
use crate::scene::Scene;
use std::sync::Arc;

const MAX_STEPS: usize = 500;

/// Objects that are kept in all steps together, each scene counted once: some 300 MB.
const OBJECT_LIMIT: usize = 4_000_000;

#[derive(Debug, Clone)]
pub(super) struct Snapshot {
    pub document: Document,
    pub selection: Selection,
}

#[derive(Debug, Clone)]
struct Step {
    /// Edits with the same key merge into one step until the history is sealed.
    merge_key: Option<String>,
    before: Snapshot,
}

/// Steps that were done, and steps that were undone.
#[derive(Debug, Clone, Default)]
pub struct History {
    done: Vec<Step>,
    undone: Vec<Step>,
    sealed: bool,
}

impl History {
    pub(super) fn push(&mut self, merge_key: Option<&str>, before: Snapshot) {
        self.undone.clear();
        let merges = !self.sealed
            && merge_key.is_some()
            && self.done.last().is_some_and(|s| s.merge_key.as_deref() == merge_key);
        self.sealed = false;
        if !merges {
            self.done.push(Step { merge_key: merge_key.map(str::to_owned), before });
            let kept = newest(&self.done, MAX_STEPS, OBJECT_LIMIT);
            self.done.drain(..self.done.len() - kept);
        }
    }

    /// Ends the current step: the next edit starts a new one with any key.
    pub fn seal(&mut self) {
        self.sealed = true;
    }

    /// Whether there is a step to redo.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Steps that can be undone.
    pub fn depth(&self) -> usize {
        self.done.len()
    }

    pub(super) fn documents_mut(&mut self) -> impl Iterator<Item = &mut Document> {
        self.done.iter_mut().chain(&mut self.undone).map(|s| &mut s.before.document)
    }

    pub(super) fn undo(&mut self, now: Snapshot) -> Option<Snapshot> {
        Self::step(&mut self.done, &mut self.undone, now)
    }

    pub(super) fn redo(&mut self, now: Snapshot) -> Option<Snapshot> {
        Self::step(&mut self.undone, &mut self.done, now)
    }

    fn step(from: &mut Vec<Step>, to: &mut Vec<Step>, now: Snapshot) -> Option<Snapshot> {
        let step = from.pop()?;
        to.push(Step { merge_key: None, before: now });
        Some(step.before)
    }
}

/// Number of the newest steps to keep: at most `steps`, with at most `objects` in all their scenes; the last one always.
fn newest(done: &[Step], steps: usize, objects: usize) -> usize {
    let (mut held, mut kept) = (0, 0);
    let mut later: Option<&Arc<Scene>> = None;
    for step in done.iter().rev().take(steps) {
        let scene = step.before.document.scene();
        if later.is_none_or(|l| !Arc::ptr_eq(l, scene)) {
            held += scene.objects.len();
        }
        if kept > 0 && held > objects {
            break;
        }
        later = Some(scene);
        kept += 1;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::file::SceneFile;

    fn step(objects: usize) -> Step {
        let scene = Scene::of_points((0..objects).map(|i| (i as f64, 1.0)));
        let document = Document::shipped(SceneFile { scene, ..SceneFile::default() });
        let before = Snapshot { document, selection: Selection::default() };
        Step { merge_key: None, before }
    }

    #[test]
    fn the_history_is_bounded() {
        let (one, ten) = (step(1), step(10));
        assert_eq!(newest(&vec![one.clone(); 8], 5, 100), 5);
        assert_eq!(newest(&vec![ten.clone(); 8], 500, 10), 8, "one scene, however many steps look at it");
        let different: Vec<Step> = (0..8).map(|_| step(10)).collect();
        assert_eq!(newest(&different, 500, 45), 4);
        assert_eq!(newest(&different, 500, 5), 1, "the last step always stays");
        assert_eq!(newest(&[], 500, 5), 0);
        let mut history = History::default();
        (0..MAX_STEPS + 50).for_each(|_| history.push(None, one.before.clone()));
        assert_eq!(history.depth(), MAX_STEPS);
    }
}
