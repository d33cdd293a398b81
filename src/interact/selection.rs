//! The selected objects of a scene.

use std::collections::BTreeSet;

/// The effect of newly picked objects on those already selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SelectionMode {
    Replace,
    /// The picked objects join the selected ones; a picked object that was selected leaves.
    Toggle,
    Add,
    /// Everything from the object picked before to the last picked one replaces the selected ones.
    Range,
}

/// Indices of selected objects. Two selections of the same objects are equal in any order of picking.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    picked: BTreeSet<usize>,
    anchor: Option<usize>,
    latest: Option<usize>,
}

impl PartialEq for Selection {
    fn eq(&self, other: &Self) -> bool {
        self.picked == other.picked
    }
}

impl Eq for Selection {}

impl Selection {
    /// Objects `indices`, the last of them picked last.
    pub fn of(indices: impl IntoIterator<Item = usize>) -> Self {
        let mut selection = Selection::default();
        selection.pick(indices, SelectionMode::Replace);
        selection
    }

    /// Whether object `index` is selected.
    pub fn contains(&self, index: usize) -> bool {
        self.picked.contains(&index)
    }

    /// Number of selected objects.
    pub fn len(&self) -> usize {
        self.picked.len()
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.picked.is_empty()
    }

    /// The selected indices, rising.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = usize> + '_ {
        self.picked.iter().copied()
    }

    /// The object, where exactly one is selected.
    pub fn single(&self) -> Option<usize> {
        if self.picked.len() == 1 { self.picked.first().copied() } else { None }
    }

    /// The object that was picked last.
    pub fn latest(&self) -> Option<usize> {
        self.latest
    }

    /// The object after or before the one that was picked last, around the ends of a scene of `count` objects; `None` in an empty one.
    pub fn neighbour(&self, count: usize, forward: bool) -> Option<usize> {
        let last = count.checked_sub(1)?;
        Some(match (self.latest, forward) {
            (Some(i), true) if i < last => i + 1,
            (_, true) => 0,
            (None | Some(0), false) => last,
            (Some(i), false) => (i - 1).min(last),
        })
    }

    pub fn pick(&mut self, indices: impl IntoIterator<Item = usize>, mode: SelectionMode) {
        if mode == SelectionMode::Range {
            let Some(to) = indices.into_iter().last() else { return };
            let from = self.anchor.unwrap_or(to);
            self.picked = (from.min(to)..=from.max(to)).collect();
            (self.anchor, self.latest) = (Some(from), Some(to));
            return;
        }
        if mode == SelectionMode::Replace {
            *self = Selection::default();
        }
        for index in indices {
            if !self.picked.insert(index) && mode == SelectionMode::Toggle {
                self.picked.remove(&index);
            }
            (self.anchor, self.latest) = (Some(index), Some(index));
        }
    }

    /// Drops indices that a scene of `count` objects doesn't have.
    pub fn clamp(&mut self, count: usize) {
        self.picked.retain(|&i| i < count);
        self.anchor = self.anchor.filter(|i| *i < count);
        self.latest = self.latest.filter(|i| *i < count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes() {
        let mut s = Selection::of([1, 2]);
        s.pick([2, 3], SelectionMode::Toggle);
        assert_eq!(s, Selection::of([1, 3]));
        s.pick([1], SelectionMode::Add);
        assert_eq!(s, Selection::of([1, 3]));
        s.pick([4], SelectionMode::Replace);
        assert_eq!(s.single(), Some(4));
        s.clamp(4);
        assert!(s.is_empty());
    }

    #[test]
    fn a_range_begins_where_something_was_picked_before() {
        let mut s = Selection::of([3]);
        s.pick([6], SelectionMode::Range);
        assert_eq!((s.clone(), s.latest()), (Selection::of([3, 4, 5, 6]), Some(6)));
        s.pick([1], SelectionMode::Range);
        assert_eq!(s, Selection::of([1, 2, 3]), "it turns around its beginning");
        s.pick([8], SelectionMode::Toggle);
        s.pick([7], SelectionMode::Range);
        assert_eq!(s, Selection::of([7, 8]));
    }

    #[test]
    fn neighbours_go_round() {
        let mut s = Selection::default();
        assert_eq!((s.neighbour(3, true), s.neighbour(3, false), s.neighbour(0, true)), (Some(0), Some(2), None));
        let mut walk = |forward| {
            let next = s.neighbour(3, forward).unwrap();
            s.pick([next], SelectionMode::Replace);
            next
        };
        assert_eq!([walk(true), walk(true), walk(true), walk(true)], [0, 1, 2, 0]);
        assert_eq!([walk(false), walk(false)], [2, 1]);
    }
}
