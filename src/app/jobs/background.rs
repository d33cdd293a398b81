//! Single pieces of work beside the window, each on a thread of its own.

use crate::platform;
use crate::task::panic_message;
use eframe::egui::Context;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Pieces of work under way, and the results of finished ones.
pub struct Background<T> {
    wake: Context,
    done: (Sender<T>, Receiver<T>),
    /// Cloned by every piece of work under way, so that the count tells how many there are.
    under_way: Arc<()>,
}

impl<T: Send + 'static> Background<T> {
    /// No work yet; `wake` draws another frame when a piece is finished.
    pub fn new(wake: Context) -> Self {
        Background { wake, done: channel(), under_way: Arc::new(()) }
    }

    /// Begins `work` on a thread called `name`; `failed` makes the result of a panic's message.
    ///
    /// # Errors
    /// When the system can't start a thread.
    pub fn begin(
        &self,
        name: &str,
        work: impl FnOnce() -> T + Send + 'static,
        failed: impl FnOnce(String) -> T + Send + 'static,
    ) -> std::io::Result<()> {
        let (done, wake, held) = (self.done.0.clone(), platform::waker(&self.wake), self.under_way.clone());
        platform::spawn(name, move || {
            let made =
                catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| failed(panic_message(panic.as_ref())));
            // The window may be gone by now.
            let _closed = done.send(made);
            drop(held);
            wake();
        })
    }

    /// Results finished since the last call.
    pub fn finished(&self) -> Vec<T> {
        self.done.1.try_iter().collect()
    }

    pub fn is_busy(&self) -> bool {
        Arc::strong_count(&self.under_way) > 1
    }
}
