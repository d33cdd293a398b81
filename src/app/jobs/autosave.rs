//! A copy of the unsaved scene that outlives a crash or a kill. Every window has its own.

use crate::app::state::State;
use crate::scene::Scene;
use crate::scene::file::{self, SceneFile};
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Shortest time between two copies.
const EVERY: Duration = Duration::from_secs(2);

/// Most windows that keep copies at once.
const SLOTS: u32 = 64;

/// The file that one window keeps its copy in.
pub struct Autosave {
    path: PathBuf,
    last: Option<Instant>,
    /// The scene that was looked at last: it is kept, or needs no keeping.
    seen: Option<Arc<Scene>>,
    /// Held while the window lives; the system lets go of it however the process ends.
    _lock: Option<File>,
}

impl Autosave {
    /// Takes the first file in `folder` that no other window holds: one that a dead window left behind comes first.
    ///
    /// Where the file system has no locks, the first file is shared.
    pub fn claim(folder: &Path) -> Autosave {
        // Without a folder there is no lock; writing a copy will say why.
        let _reported_later = std::fs::create_dir_all(folder);
        let mut free = None;
        for slot in 1..=SLOTS {
            let name = if slot == 1 { "autosave".to_owned() } else { format!("autosave-{slot}") };
            let path = folder.join(name).with_extension("toml");
            let Ok(lock) = File::create(path.with_extension("lock")) else { break };
            match lock.try_lock() {
                Ok(()) if path.exists() => return Autosave { path, last: None, seen: None, _lock: Some(lock) },
                Ok(()) => _ = free.get_or_insert((path, lock)),
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(_)) => break,
            }
            // Slots are taken in order: behind a free one without its lock file there is nothing.
            let next = folder.join(format!("autosave-{}.lock", slot + 1));
            if free.is_some() && !next.exists() {
                break;
            }
        }
        match free {
            Some((path, lock)) => Autosave { path, last: None, seen: None, _lock: Some(lock) },
            None => Autosave { path: folder.join("autosave.toml"), last: None, seen: None, _lock: None },
        }
    }

    /// Keeps a copy of the scene on screen if it is unsaved and has changed, or deletes the copy of one that was saved. Returns how
    /// long until the next copy may be written, if this one had to wait.
    ///
    /// # Errors
    /// Why it could not be written; it is tried again when the scene changes.
    pub fn follow(&mut self, state: &State) -> Result<Option<Duration>, String> {
        let scene = state.editor.scene();
        if self.seen.as_ref().is_some_and(|seen| Arc::ptr_eq(seen, scene)) || state.editor.dragged().is_some() {
            return Ok(None);
        }
        let kept = if state.editor.is_modified() {
            self.keep(&state.scene_file())
        } else {
            // The scene that the app starts with deletes nothing: what an earlier window left may still be wanted.
            if self.seen.is_some() {
                self.forget();
            }
            Ok(None)
        };
        if !matches!(kept, Ok(Some(_))) {
            self.seen = Some(scene.clone());
        }
        kept
    }

    /// Keeps a copy of an unsaved scene, at most every two seconds. Returns how long until the next may be written, if this one
    /// had to wait.
    pub fn keep(&mut self, scene: &SceneFile) -> Result<Option<Duration>, String> {
        if let Some(waited) = self.last.map(|t| t.elapsed()).filter(|t| *t < EVERY) {
            return Ok(Some(EVERY - waited));
        }
        self.keep_now(scene).map(|()| None)
    }

    /// Keeps a copy at once: the window is closing.
    pub fn keep_now(&mut self, scene: &SceneFile) -> Result<(), String> {
        self.last = Some(Instant::now());
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        }
        file::save(&self.path, scene).map_err(|e| e.to_string())
    }

    /// Reads what an earlier run left unsaved. A file that can't be read is set aside, not deleted.
    pub fn restore(&self) -> Option<Result<SceneFile, String>> {
        let path = Some(&self.path).filter(|p| p.exists())?;
        Some(file::load(path).map_err(|e| {
            let aside = path.with_extension("broken.toml");
            match std::fs::rename(path, &aside) {
                Ok(()) => format!("{e}; it was kept as {}", aside.display()),
                Err(_) => e.to_string(),
            }
        }))
    }

    /// Deletes the copy: what it held is safe elsewhere.
    pub fn forget(&mut self) {
        // Not there is as good as deleted.
        let _absent = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::presets;

    #[test]
    fn two_windows_keep_two_copies_and_the_next_two_find_them() {
        let folder = tempfile::tempdir().unwrap();
        let scene = presets::default_scene();
        let mut first = Autosave::claim(folder.path());
        let mut second = Autosave::claim(folder.path());
        assert_ne!(first.path, second.path);
        first.keep_now(&scene).unwrap();
        second.keep_now(&SceneFile { scene: Default::default(), ..scene.clone() }).unwrap();
        drop(second);
        let again = Autosave::claim(folder.path());
        assert!(again.restore().unwrap().unwrap().scene.objects.is_empty(), "the second's, the first is still open");
        drop(first);
        let other = Autosave::claim(folder.path());
        assert_eq!(other.restore().unwrap().unwrap().scene, scene.scene);
        assert!(Autosave::claim(folder.path()).restore().is_none());
    }

    #[test]
    fn copies_wait_for_each_other_but_not_when_the_window_closes() {
        let folder = tempfile::tempdir().unwrap();
        let mut autosave = Autosave::claim(folder.path());
        let scene = presets::default_scene();
        assert_eq!(autosave.keep(&scene).unwrap(), None);
        assert!(autosave.keep(&scene).unwrap().is_some());
        autosave.forget();
        autosave.keep_now(&scene).unwrap();
        assert!(autosave.restore().is_some());
    }
}
