//! A bound on the work of a search: counted and not timed, so that the search ends at the same place on every machine.

use std::sync::atomic::{AtomicUsize, Ordering};

/// WorkBudget done and new. The unit is about the time of one reflector's echo in all samples of both ends: ten microseconds.
#[derive(Debug)]
pub struct WorkBudget {
    done: AtomicUsize,
    limit: usize,
}

impl WorkBudget {
    /// A budget of `limit` units.
    pub fn new(limit: usize) -> Self {
        WorkBudget { done: AtomicUsize::new(0), limit }
    }

    /// Counts work; any thread may call it.
    pub fn spend(&self, units: usize) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }

    /// Grants as much as makes the remaining work at least `units`.
    pub fn grant(&self, units: usize) {
        let done = self.limit.saturating_sub(units);
        self.done.fetch_min(done, Ordering::Relaxed);
    }

    /// Gives up the remaining work.
    pub fn exhaust(&self) {
        self.done.fetch_max(self.limit, Ordering::Relaxed);
    }

    /// The work done; call it where nothing runs in parallel.
    pub fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// Whether the new work is done. Call it where nothing runs in parallel: only there is the answer the same every time.
    pub fn is_spent(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_granted_is_spent() {
        let work = WorkBudget::new(10);
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
        work.exhaust();
        assert!(work.is_spent());
    }
}
