//! The handle of long work: progress and cancellation.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// The work was cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Handle shared between long work and its waiting caller.
#[derive(Debug, Clone, Default)]
pub struct Task {
    cancelled: Arc<AtomicBool>,
    progress: Arc<AtomicU32>,
}

impl Task {
    /// Asks the work to stop soon.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether the work was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Reports the finished part, 0 to 1.
    pub fn set_progress(&self, part: f32) {
        self.progress.store(part.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
    }

    /// The task of a part of the work: it is cancelled with the whole, and has its own hidden progress.
    pub fn quiet(&self) -> Task {
        Task { cancelled: self.cancelled.clone(), progress: Arc::default() }
    }

    /// The finished part, 0 to 1.
    pub fn progress(&self) -> f32 {
        f32::from_bits(self.progress.load(Ordering::Relaxed))
    }

    /// An error once the task was cancelled, to leave a computation with `?`.
    /// # Errors
    /// [`Cancelled`] after [`Task::cancel`].
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clone_is_the_same_task() {
        let (ours, theirs) = (Task::default(), Task::default());
        let handed = ours.clone();
        handed.set_progress(0.25);
        ours.cancel();
        assert_eq!(ours.progress(), 0.25);
        assert_eq!((handed.check(), theirs.check()), (Err(Cancelled), Ok(())));
    }
}
