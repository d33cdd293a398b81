//! The differences between a desktop and a page in a browser: clock, threads, files, file dialogs, storage, fonts of pictures, and opening of the window.
//! `desktop` and `page` have the same functions. Only this room and the SIMD kernels are compiled differently for `target_arch`.

#[cfg(not(target_arch = "wasm32"))]
pub mod console;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) mod desktop;
#[cfg(any(test, target_arch = "wasm32"))]
#[cfg_attr(test, allow(dead_code, reason = "the page uses what the tests don't"))]
mod memory_files;
#[cfg(target_arch = "wasm32")]
pub(crate) mod page;

#[cfg(not(target_arch = "wasm32"))]
pub(crate) use desktop as system;
#[cfg(target_arch = "wasm32")]
pub(crate) use page as system;

#[cfg(feature = "live")]
pub(crate) use system::live_weights;
#[cfg(feature = "pictures")]
pub(crate) use system::register_font;
pub use system::{
    IN_A_BROWSER, WRITES_WAIT, address, fs, has_threads, has_window, lock, on_panic, page_address, pool, problems,
    spawn, tell,
};
#[cfg(feature = "app")]
pub use system::{choose_file, dropped, open_window, storage_folder, waker};

/// A clock that works on a desktop and in a page.
pub use web_time::Instant;

use std::path::PathBuf;

/// A question for a file, for the system's dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileQuestion {
    /// Title of the dialog.
    pub title: String,
    /// Name of the kind of files.
    pub kind: String,
    /// Endings of the file's name, without the dot.
    pub endings: Vec<String>,
    /// The folder that the dialog begins in.
    pub folder: Option<PathBuf>,
    /// Default name of the file.
    pub name: String,
    /// Whether the file is read, not written.
    pub reads: bool,
}

/// The result of a claim on a lock file.
#[derive(Debug)]
pub enum Claim {
    /// The lock is ours until the value is dropped.
    Ours(fs::Lock),
    /// Another window holds the lock.
    Theirs,
    /// The system has no locks.
    Unavailable,
}
