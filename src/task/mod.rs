//! Long work: progress, cancellation, and a worker thread.
//!
//! Uses only [`platform`](crate::platform) of the crate, so that nearly everything may use it.

mod handle;
mod worker;

pub use handle::{Cancelled, Task};
pub use worker::{Generation, Reply, Worker, panic_message};
