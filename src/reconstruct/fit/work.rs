//! A bound on the work of a search: counted and not timed, so that the search ends at the same place on every machine.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Work done and granted. The unit is about the time of one reflector's echo in all samples of both ends: ten microseconds.
#[derive(Debug)]
pub struct Work {
    done: AtomicUsize,
    most: usize,
}

impl Work {
    /// A budget of `most` units.
    pub fn granted(most: usize) -> Self {
        Work { done: AtomicUsize::new(0), most }
    }

    /// Counts work; any thread may call it.
    pub fn spend(&self, units: usize) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }

    /// Grants as much as makes the remaining work at least `units`.
    pub fn grant(&self, units: usize) {
        let done = self.most.saturating_sub(units);
        self.done.fetch_min(done, Ordering::Relaxed);
    }

    /// Gives up the remaining work.
    pub fn give_up(&self) {
        self.done.fetch_max(self.most, Ordering::Relaxed);
    }

    /// The work done; call it where nothing runs in parallel.
    pub fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// Whether the granted work is done. Call it where nothing runs in parallel: only there is the answer the same every time.
    pub fn is_spent(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_granted_is_spent() {
        let work = Work::granted(10);
        work.spend(9);
        assert!(!work.is_spent());
        work.spend(1);
        assert!(work.is_spent());
        work.grant(3);
        assert_eq!(work.done(), 7);
        work.spend(2);
        assert!(!work.is_spent());
        work.spend(1);
        assert!(work.is_spent());
        work.grant(10);
        work.give_up();
        assert!(work.is_spent());
    }
}
