//! How much a search may compute: counted and not timed, so that it ends at the same place on every machine.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Work done and granted. The unit is about what one reflector's echo in all samples of both ends takes: ten microseconds.
#[derive(Debug)]
pub struct Work {
    done: AtomicUsize,
    most: usize,
}

impl Work {
    /// With this much granted.
    pub fn granted(most: usize) -> Self {
        Work { done: AtomicUsize::new(0), most }
    }

    /// Counts what was done; any thread may.
    pub fn spend(&self, units: usize) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }

    /// Grants so much that at least this is left.
    pub fn grant(&self, units: usize) {
        let done = self.most.saturating_sub(units);
        self.done.fetch_min(done, Ordering::Relaxed);
    }

    /// Gives back what is left.
    pub fn give_up(&self) {
        self.done.fetch_max(self.most, Ordering::Relaxed);
    }

    /// What was done; to be asked where nothing runs in parallel.
    pub fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// Part of what was granted that is done; to be asked where nothing runs in parallel.
    pub fn spent(&self) -> f64 {
        self.done.load(Ordering::Relaxed) as f64 / self.most.max(1) as f64
    }

    /// Whether what was granted is done. To be asked where nothing runs in parallel: only there is the answer the same every time.
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
