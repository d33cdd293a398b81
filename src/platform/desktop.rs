//! Threads, files and dialogs of a desktop system.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Query and fragment of the page's address; empty on a desktop.
pub fn address() -> String {
    String::new()
}

/// Address of the page; `None` on a desktop.
pub fn page_address() -> Option<String> {
    None
}

#[cfg(feature = "live")]
pub(crate) fn live_weights() -> [std::borrow::Cow<'static, [u8]>; 3] {
    let table_3_1 = include_bytes!("../../assets/weights/live.safetensors").as_slice();
    let any = include_bytes!("../../assets/weights/live-any.safetensors").as_slice();
    let cascade = include_bytes!("../../assets/weights/live-cascade.safetensors").as_slice();
    [table_3_1, any, cascade].map(Into::into)
}

/// Whether the window is a page in a browser.
pub const IN_A_BROWSER: bool = false;

/// Tells a sentence without a window: in the log.
pub fn tell(sentence: &str) {
    tracing::error!("{sentence}");
}

/// Whether long work runs on threads beside the window.
pub fn has_threads() -> bool {
    true
}

/// Whether this thread can have a window.
pub fn has_window() -> bool {
    true
}

/// Whether writing a file may take so long that the user notices.
pub const WRITES_WAIT: bool = true;

/// Locks `mutex`.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sets the action of a thread at a panic that can't be caught. On a desktop every panic can be caught.
pub fn on_panic(_then: impl FnOnce(String) + 'static) {}

/// Problems of threads since the last call. On a desktop there are none: a worker's reply has them.
pub fn problems() -> Vec<String> {
    Vec::new()
}

/// A pool of threads for slow work; `None` where the system can't start them.
pub fn pool(name: &'static str) -> Option<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new().thread_name(move |i| format!("{name} {i}")).build().ok()
}

/// A function that draws another frame of the window, from any thread.
#[cfg(feature = "app")]
pub fn waker(ctx: &eframe::egui::Context) -> impl Fn() + Clone + Send + Sync + 'static {
    let ctx = ctx.clone();
    move || ctx.request_repaint()
}

/// The path of a file that was dropped on the window.
#[cfg(feature = "app")]
pub fn dropped(
    file: &std::sync::Arc<dyn eframe::egui::DroppedFile + Send + Sync>,
    answer: impl FnOnce(Result<std::path::PathBuf, String>) + 'static,
) {
    answer(Ok(file.path().to_path_buf()));
}

/// Runs `work` on a thread called `name`.
/// # Errors
/// When the system can't start a thread.
pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> std::io::Result<()> {
    std::thread::Builder::new().name(name.to_owned()).spawn(work).map(|_| ())
}

/// Files on disk.
pub mod fs {
    use crate::platform::Claim;
    pub use std::fs::{
        DirEntry, File, canonicalize, create_dir, create_dir_all, metadata, read, read_dir, read_to_string,
        remove_file, rename, write,
    };
    use std::fs::{Permissions, TryLockError};
    use std::io::{self, Seek, SeekFrom, Write};
    use std::path::Path;
    use tempfile::NamedTempFile;

    /// Whether there is a file or a folder at `path`.
    pub fn exists(path: &Path) -> bool {
        path.exists()
    }

    /// Whether there is a folder at `path`.
    pub fn is_dir(path: &Path) -> bool {
        path.is_dir()
    }

    /// A held lock file. The system releases it however the process ends.
    #[derive(Debug)]
    pub struct Lock(#[expect(dead_code, reason = "holds the lock")] File);

    /// Tries to lock the file at `path`.
    pub fn claim(path: &Path) -> Claim {
        let Ok(file) = File::create(path) else { return Claim::Unavailable };
        match file.try_lock() {
            Ok(()) => Claim::Ours(Lock(file)),
            Err(TryLockError::WouldBlock) => Claim::Theirs,
            Err(TryLockError::Error(_)) => Claim::Unavailable,
        }
    }

    /// A file that is being written and has no name yet.
    #[derive(Debug)]
    pub struct Draft(NamedTempFile);

    impl Draft {
        /// Begins a file in `folder` that will replace the one at `path`.
        /// # Errors
        /// The system's error about the folder.
        pub fn begin(folder: &Path, path: &Path) -> io::Result<Draft> {
            let mut builder = tempfile::Builder::new();
            builder.prefix(".apertura-").suffix(".tmp");
            if let Some(permissions) = new_file_permissions(path) {
                builder.permissions(permissions);
            }
            builder.tempfile_in(folder).map(Draft)
        }

        /// Moves the file to `path`.
        /// # Errors
        /// The system's error: the disk is full, the place can't be written.
        pub fn persist(self, path: &Path) -> io::Result<()> {
            self.0.as_file().sync_all()?;
            self.0.persist(path).map(|_| ()).map_err(|e| e.error)
        }
    }

    impl Write for Draft {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            // The inner file: errors of the outer one name its temporary path, which means nothing to the user.
            self.0.as_file_mut().write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.as_file_mut().flush()
        }
    }

    impl Seek for Draft {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.as_file_mut().seek(to)
        }
    }

    /// Permissions of the file at `path`, or those that the umask leaves. Temporary files would be private.
    #[cfg(unix)]
    fn new_file_permissions(path: &Path) -> Option<Permissions> {
        use std::os::unix::fs::PermissionsExt;
        Some(metadata(path).map_or_else(|_| Permissions::from_mode(0o666), |m| m.permissions()))
    }

    #[cfg(not(unix))]
    fn new_file_permissions(_: &Path) -> Option<Permissions> {
        None
    }
}

/// Opens the system's dialog on a thread of its own; `answer` gets the file, or `None` where the dialog was closed.
/// # Errors
/// When the system can't start a thread.
#[cfg(feature = "app")]
pub fn choose_file(
    question: super::FileQuestion,
    answer: impl FnOnce(Option<std::path::PathBuf>) + Send + 'static,
) -> std::io::Result<()> {
    spawn("file dialog", move || {
        let dialog = rfd::FileDialog::new().set_title(&question.title).add_filter(&question.kind, &question.endings);
        let dialog = if let Some(folder) = &question.folder { dialog.set_directory(folder) } else { dialog };
        answer(if question.reads { dialog.pick_file() } else { dialog.set_file_name(&question.name).save_file() });
    })
}

/// The folder of the program's own files.
#[cfg(feature = "app")]
pub fn storage_folder(app_id: &str) -> Option<std::path::PathBuf> {
    eframe::storage_dir(app_id)
}

/// Opens the window and runs until it is closed.
/// # Errors
/// Where there is no display or no OpenGL, or where `create` fails.
#[cfg(feature = "app")]
pub fn open_window(app_id: &str, create: eframe::AppCreator<'static>) -> Result<(), eframe::Error> {
    let icon = eframe::icon_data::from_png_bytes(include_bytes!("../../assets/icon/apertura-128.png"));
    let native = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default()
            .with_icon(icon.unwrap_or_default())
            .with_title(app_id)
            .with_app_id(app_id)
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([800.0, 520.0])
            .with_drag_and_drop(true),
        ..eframe::NativeOptions::default()
    };
    eframe::run_native(app_id, native, create)
}

#[cfg(feature = "pictures")]
pub(crate) fn register_font(
    family: &str,
    style: plotters::style::FontStyle,
    bytes: &'static [u8],
) -> Result<(), &'static str> {
    plotters::style::register_font(family, style, bytes).map_err(|_| "is no font")
}
