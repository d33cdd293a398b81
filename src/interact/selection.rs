//! Which objects of a scene are selected.

use std::collections::BTreeSet;

/// How newly picked objects meet those already selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SelectionMode {
    /// They replace them.
    Replace,
    /// They join them; a picked object that was selected leaves.
    Toggle,
    /// They join them.
    Add,
}

/// Indices of selected objects.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Selection(BTreeSet<usize>);

impl Selection {
    /// Objects `indices`.
    pub fn of(indices: impl IntoIterator<Item = usize>) -> Self {
        Selection(indices.into_iter().collect())
    }

    /// Whether object `index` is selected.
    pub fn contains(&self, index: usize) -> bool {
        self.0.contains(&index)
    }

    /// Number of selected objects.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The selected indices, rising.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = usize> + '_ {
        self.0.iter().copied()
    }

    /// The object, where exactly one is selected.
    pub fn single(&self) -> Option<usize> {
        if self.0.len() == 1 { self.0.first().copied() } else { None }
    }

    /// Picks `indices`.
    pub fn pick(&mut self, indices: impl IntoIterator<Item = usize>, mode: SelectionMode) {
        if mode == SelectionMode::Replace {
            self.0.clear();
        }
        for index in indices {
            if !self.0.insert(index) && mode == SelectionMode::Toggle {
                self.0.remove(&index);
            }
        }
    }

    /// Drops indices that a scene of `count` objects doesn't have.
    pub fn clamp(&mut self, count: usize) {
        self.0.retain(|&i| i < count);
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
}
