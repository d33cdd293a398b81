//! A budget of work, counted and not timed, so that a search ends with the same result on every machine.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Work done and its limit. The unit is about ten microseconds, the time of one reflector's echo in all samples of both ends.
#[derive(Debug)]
pub struct WorkBudget {
    done: AtomicUsize,
    limit: usize,
}

impl WorkBudget {
    pub fn new(limit: usize) -> Self {
        WorkBudget { done: AtomicUsize::new(0), limit }
    }

    /// Adds `units` to the work done; any thread may call it.
    pub fn spend(&self, units: usize) {
        self.done.fetch_add(units, Ordering::Relaxed);
    }

    /// Lowers the work done so far that `units` remain at least.
    pub fn grant(&self, units: usize) {
        let done = self.limit.saturating_sub(units);
        self.done.fetch_min(done, Ordering::Relaxed);
    }

    /// Uses up the budget.
    pub fn exhaust(&self) {
        self.done.fetch_max(self.limit, Ordering::Relaxed);
    }

    /// The work done. It is the same each time only where nothing runs in parallel.
    pub fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// Whether the budget is used up. The result is the same each time only where nothing runs in parallel.
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
