//! Long work: progress, cancellation, and a worker thread.
//!
//! Uses nothing else of the crate, so that everything may use it.

mod handle;
mod worker;

pub use handle::{Cancelled, Task};
pub use worker::{Generation, Reply, Worker, panic_message};
