//! A page in a browser: Web Workers as threads, files in memory, the browser's storage and downloads.

mod threads;

use super::memory_files;
use std::io;
use std::path::{Path, PathBuf};
#[cfg(feature = "app")]
pub use threads::waker;
pub use threads::{has_threads, lock, on_panic, pool, problems, spawn};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::spawn_local;

/// Folder whose files the browser keeps between visits.
const STORAGE: &str = "/storage";

/// Folder of opened and dropped files.
const OPENED: &str = "/opened";

/// Folder whose files the browser saves as downloads.
const DOWNLOADS: &str = "/downloads";

#[wasm_bindgen(module = "/src/platform/page.js")]
extern "C" {
    #[wasm_bindgen(js_name = download)]
    fn save_as_download(name: &str, bytes: &[u8]);
    #[wasm_bindgen(js_name = storedKeys)]
    fn stored_keys() -> Vec<String>;
    fn stored(key: &str) -> Option<String>;
    /// Whether the browser had room for the text.
    fn store(key: &str, text: &str) -> bool;
    fn forget(key: &str);
    #[wasm_bindgen(js_name = claimLock)]
    fn claim_lock(key: &str) -> bool;
    #[wasm_bindgen(js_name = releaseLock)]
    fn release_lock(key: &str);
    /// Query and fragment of the page's address, with `?` and `#`.
    pub fn address() -> String;
    #[wasm_bindgen(js_name = pageAddress)]
    fn page_address_here() -> String;
    #[cfg(feature = "live")]
    #[wasm_bindgen(js_name = fetchedWeights)]
    fn fetched_weights(index: usize) -> Vec<u8>;
    /// Shows a sentence in place of the window.
    pub fn tell(sentence: &str);
}

/// Address of the page, without query and fragment.
pub fn page_address() -> Option<String> {
    Some(page_address_here())
}

#[cfg(feature = "live")]
pub(crate) fn live_weights() -> [std::borrow::Cow<'static, [u8]>; 3] {
    [0, 1, 2].map(|index| fetched_weights(index).into())
}

/// Whether the window is a page in a browser.
pub const IN_A_BROWSER: bool = true;

/// Whether this thread can have a window.
pub fn has_window() -> bool {
    threads::on_first_thread()
}

/// Whether writing a file may take so long that the user notices.
pub const WRITES_WAIT: bool = false;

/// Files in memory. The browser keeps those in the storage folder and saves those in the folder of downloads.
pub mod fs {
    use super::{DOWNLOADS, STORAGE, claim_lock, forget, memory_files, release_lock, save_as_download, store};
    use crate::platform::Claim;
    pub use memory_files::{
        DirEntry, File, Metadata, canonicalize, create_dir, create_dir_all, exists, is_dir, metadata, read, read_dir,
        read_to_string,
    };
    use std::io::{self, Cursor, Seek, SeekFrom, Write};
    use std::path::{Path, PathBuf};

    /// A held lock, released some seconds after the page is closed.
    #[derive(Debug)]
    pub struct Lock(PathBuf);

    impl Drop for Lock {
        fn drop(&mut self) {
            release_lock(&self.0.to_string_lossy());
        }
    }

    /// Tries to lock `path` against other pages.
    pub fn claim(path: &Path) -> Claim {
        if claim_lock(&path.to_string_lossy()) { Claim::Ours(Lock(path.to_owned())) } else { Claim::Theirs }
    }

    /// A file that is being written and has no name yet.
    #[derive(Debug)]
    pub struct Draft(Cursor<Vec<u8>>);

    impl Draft {
        /// Begins a file that will replace another; never an error on a page.
        pub fn begin(_folder: &Path, _path: &Path) -> io::Result<Draft> {
            Ok(Draft(Cursor::default()))
        }

        /// Writes the file to `path`.
        /// # Errors
        /// When the browser's storage is full or forbidden.
        pub fn persist(self, path: &Path) -> io::Result<()> {
            write(path, self.0.into_inner())
        }
    }

    impl Write for Draft {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Draft {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    /// Writes a whole file.
    /// # Errors
    /// When the browser's storage is full or forbidden.
    pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
        let bytes = bytes.as_ref();
        if path.starts_with(DOWNLOADS) {
            let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            save_as_download(&name, bytes);
        }
        if path.starts_with(STORAGE)
            && let Ok(text) = std::str::from_utf8(bytes)
            && !store(&path.to_string_lossy(), text)
        {
            return Err(io::Error::new(io::ErrorKind::StorageFull, "the browser's storage is full or forbidden"));
        }
        memory_files::put(path, bytes.to_vec());
        Ok(())
    }

    /// Removes a file.
    /// # Errors
    /// [`io::ErrorKind::NotFound`] where there is none.
    pub fn remove_file(path: impl AsRef<Path>) -> io::Result<()> {
        let path = path.as_ref();
        memory_files::remove_file(path)?;
        forget(&path.to_string_lossy());
        Ok(())
    }

    /// Gives a file another name.
    /// # Errors
    /// Where there is no such file, or no room in the storage.
    pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
        write(to, read(from)?)?;
        remove_file(from)
    }
}

/// Opens the browser's dialog for a file to read. A file to write is a download, whose name is the answer at once.
#[cfg(feature = "app")]
pub fn choose_file(
    question: super::FileQuestion,
    answer: impl FnOnce(Option<PathBuf>) + Send + 'static,
) -> io::Result<()> {
    spawn_local(async move {
        if !question.reads {
            return answer(Some(Path::new(DOWNLOADS).join(&question.name)));
        }
        let dialog =
            rfd::AsyncFileDialog::new().set_title(&question.title).add_filter(&question.kind, &question.endings);
        let Some(file) = dialog.pick_file().await else { return answer(None) };
        answer(Some(opened(&file.file_name(), file.read().await)));
    });
    Ok(())
}

/// Reads a file that was dropped on the window; `answer` gets its path in memory once the browser has read it.
#[cfg(feature = "app")]
pub fn dropped(
    file: &std::sync::Arc<dyn eframe::egui::DroppedFile + Send + Sync>,
    answer: impl FnOnce(Result<PathBuf, String>) + 'static,
) {
    let file = file.clone();
    spawn_local(async move {
        let name = file.path().to_string_lossy().into_owned();
        answer(file.bytes_async().await.map(|bytes| opened(&name, bytes)));
    });
}

fn opened(name: &str, bytes: Vec<u8>) -> PathBuf {
    let path = Path::new(OPENED).join(name);
    memory_files::put(&path, bytes);
    path
}

/// The folder of the program's own files, filled from the browser's storage.
#[cfg(feature = "app")]
pub fn storage_folder(_app_id: &str) -> Option<PathBuf> {
    for folder in [STORAGE, OPENED, DOWNLOADS] {
        memory_files::create_dir_all(Path::new(folder)).ok()?;
    }
    for key in stored_keys() {
        if let Some(text) = stored(&key) {
            memory_files::put(Path::new(&key), text.into_bytes());
        }
    }
    Some(PathBuf::from(STORAGE))
}

/// Opens the window on the page's canvas and returns at once.
/// # Errors
/// Where the page has no canvas; a page without WebGL tells a sentence instead.
#[cfg(feature = "app")]
pub fn open_window(_app_id: &str, create: eframe::AppCreator<'static>) -> Result<(), eframe::Error> {
    use wasm_bindgen::JsCast;
    let canvas = web_sys::window()
        .and_then(|w| w.document())
        .and_then(|d| d.get_element_by_id("window"))
        .and_then(|e| e.dyn_into::<web_sys::HtmlCanvasElement>().ok());
    let Some(canvas) = canvas else {
        tell("The page has no canvas with the name \"window\".");
        return Ok(());
    };
    threads::begin();
    let runner = eframe::WebRunner::new();
    threads::watch_panics();
    spawn_local(async move {
        let started = runner.start(canvas, eframe::WebOptions::default(), create).await;
        match started {
            Ok(()) => tell(""),
            Err(error) => tell(&format!("The window could not be opened; it needs WebGL. ({error:?})")),
        }
    });
    Ok(())
}

#[cfg(feature = "pictures")]
pub(crate) fn register_font(
    _family: &str,
    _style: plotters::style::FontStyle,
    _bytes: &'static [u8],
) -> Result<(), &'static str> {
    Ok(())
}
