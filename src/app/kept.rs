//! Settings kept between starts, and messages where they can't be kept or read.

use super::state::{Arrangement, MethodTimes, Settings, View};
use crate::files::write_bytes;
use crate::lesson::Progress;
use crate::platform::{self, fs};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Name of the file in which the window library keeps settings.
const SETTINGS_FILE: &str = "app.ron";

/// Name of the copy of the settings' file from the last start.
const SETTINGS_COPY_FILE: &str = "app.ron.copy";

/// Key of the program's version in the settings' file.
const VERSION_KEY: &str = "version";

/// Largest file of settings that is read, bytes.
const MAX_SETTINGS_BYTES: u64 = 16 << 20;

#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct KeptSettings {
    pub settings: Settings,
    /// View of the scenes; part of the settings up to version 0.1.0.
    pub view: Option<View>,
    #[serde(alias = "layout")]
    pub arrangement: Arrangement,
    pub recent: Vec<PathBuf>,
    pub progress: Progress,
    pub method_times: MethodTimes,
    /// Scale of the interface before a presentation that was on screen at the end.
    pub zoom: Option<f32>,
    /// Whether an object was dragged, which ends the captions of the maps.
    pub captions_seen: bool,
    /// Names of the commands that the palette ran last, the latest first.
    pub recent_commands: Vec<String>,
}

/// The part of version 0.1.0's settings that is now [`KeptSettings::view`].
#[derive(Deserialize)]
struct OlderSettings {
    settings: View,
}

impl KeptSettings {
    /// Hands the state to the window library, which writes it.
    pub fn write(&self, storage: &mut dyn eframe::Storage) {
        storage.set_string(VERSION_KEY, env!("CARGO_PKG_VERSION").to_owned());
        eframe::set_value(storage, eframe::APP_KEY, self);
    }
}

/// The kept state, whether maps have captions, and a message about unreadable settings. Captions are off where nothing can be kept, as in tests. Unreadable
/// settings are copied into a file of their own in `folder`.
pub(super) fn read(
    storage: Option<&dyn eframe::Storage>,
    folder: Option<&Path>,
) -> (KeptSettings, bool, Option<String>) {
    let Some(storage) = storage else { return (KeptSettings::default(), false, None) };
    let kept: Option<KeptSettings> = eframe::get_value(storage, eframe::APP_KEY);
    let captions = !kept.as_ref().is_some_and(|k| k.captions_seen);
    let problem = match (&kept, storage.get_string(eframe::APP_KEY)) {
        (None, Some(text)) => Some(set_aside(folder, &text, storage.get_string(VERSION_KEY).as_deref())),
        _ => None,
    };
    let mut kept = kept.unwrap_or_default();
    let older = || eframe::get_value(storage, eframe::APP_KEY).map(|older: OlderSettings| older.settings);
    kept.settings.view = kept.view.take().or_else(older).unwrap_or_default();
    kept.arrangement.join_views();
    (kept, captions, problem)
}

/// Copies unreadable settings into a file of their own. Returns a sentence about it.
fn set_aside(folder: Option<&Path>, text: &str, version: Option<&str>) -> String {
    let ours = env!("CARGO_PKG_VERSION");
    let writer = version.map_or_else(|| "another version of apertura".to_owned(), |v| format!("apertura {v}"));
    let path = folder.and_then(|folder| {
        let mut names = (1u32..).map(|n| folder.join(format!("settings-{n}.ron")));
        names.find(|path| !fs::exists(path) || fs::read(path).is_ok_and(|there| there == text.as_bytes()))
    });
    let kept = match path.map(|path| (write_bytes(&path, text.as_bytes()), path)) {
        Some((Ok(()), path)) => format!("They were kept as {}.", path.display()),
        Some((Err(error), _)) => format!("They could not be kept: {error}."),
        None => "They could not be kept.".to_owned(),
    };
    format!("The settings that {writer} wrote can't be read by this program, apertura {ours}. {kept}")
}

/// Checks the folder of settings and autosave before the window opens. Returns messages about files that can't be kept there or were cut.
pub(super) fn problems(folder: Option<&Path>) -> Vec<String> {
    let Some(folder) = folder else {
        return vec![unkept("there is no home folder")];
    };
    if let Err(error) = fs::create_dir_all(folder) {
        return vec![unkept(&format!("{}: {error}", folder.display()))];
    }
    match keep_whole(folder) {
        Ok(problem) => problem.into_iter().collect(),
        Err(error) => vec![unkept(&error.to_string())],
    }
}

fn unkept(reason: &str) -> String {
    format!("Settings and unsaved scenes can't be kept ({reason}). Save what you want to keep in a file elsewhere.")
}

/// Copies the settings' file, which the window library doesn't write in one step, or restores it from the copy where it was cut.
///
/// # Errors
/// When no file can be written into `folder`.
fn keep_whole(folder: &Path) -> io::Result<Option<String>> {
    let (path, copy) = (folder.join(SETTINGS_FILE), folder.join(SETTINGS_COPY_FILE));
    let read = |path: &Path| crate::files::read_bounded(path, MAX_SETTINGS_BYTES).ok();
    match (read(&path), read(&copy)) {
        (Some(now), before) if is_whole(&now) => {
            if before.as_deref() != Some(&now) {
                write_bytes(&copy, &now)?;
            } else {
                platform::fs::Draft::begin(folder, &copy).map(drop).map_err(|e| refused(folder, &e))?;
            }
            Ok(None)
        }
        (Some(_), Some(before)) => {
            write_bytes(&path, &before)?;
            let reason = "they were not written whole the last time, as happens on a full disk";
            Ok(Some(format!("The settings are those of the start before the last: {reason}.")))
        }
        _ => platform::fs::Draft::begin(folder, &copy).map(|_| None).map_err(|e| refused(folder, &e)),
    }
}

fn refused(folder: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {}", folder.display(), error.kind()))
}

/// Whether a file of settings ends as the window library ends it: with the bracket of a map on a line of its own.
fn is_whole(bytes: &[u8]) -> bool {
    let end = bytes.trim_ascii_end();
    end.ends_with(b"\n}") || end == b"{}"
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[derive(Default)]
    struct InMemory(BTreeMap<String, String>);

    impl eframe::Storage for InMemory {
        fn get_string(&self, key: &str) -> Option<String> {
            self.0.get(key).cloned()
        }

        fn set_string(&mut self, key: &str, value: String) {
            self.0.insert(key.to_owned(), value);
        }

        fn remove_string(&mut self, key: &str) {
            self.0.remove(key);
        }

        fn flush(&mut self) {}
    }

    #[test]
    fn maps_say_what_they_show_until_something_was_dragged() {
        let mut storage = InMemory::default();
        assert!(read(Some(&storage), None).1, "a first start");
        for seen in [false, true] {
            KeptSettings { captions_seen: seen, ..KeptSettings::default() }.write(&mut storage);
            assert_eq!(read(Some(&storage), None).1, !seen);
        }
        let view = View { one_scale: true, method: "capon".to_owned(), ..View::default() };
        KeptSettings { view: Some(view.clone()), ..KeptSettings::default() }.write(&mut storage);
        assert_eq!(read(Some(&storage), None).0.settings.view, view, "how scenes are looked at is kept");
        assert!(!read(None, None).1, "nowhere to keep that it was seen");
    }

    #[test]
    fn settings_of_a_newer_program_are_set_aside() {
        let folder = tempfile::tempdir().unwrap();
        let mut storage = InMemory::default();
        KeptSettings::default().write(&mut storage);
        assert_eq!(read(Some(&storage), Some(folder.path())).2, None);
        let newer = "(settings: (theme: Sepia))";
        storage.0.insert(eframe::APP_KEY.to_owned(), newer.to_owned());
        storage.0.insert(VERSION_KEY.to_owned(), "9.1.0".to_owned());
        for _ in 0..2 {
            let problem = read(Some(&storage), Some(folder.path())).2.unwrap();
            assert!(problem.contains("apertura 9.1.0") && problem.contains("settings-1.ron"), "{problem}");
        }
        assert_eq!(std::fs::read_to_string(folder.path().join("settings-1.ron")).unwrap(), newer);
        storage.0.insert(eframe::APP_KEY.to_owned(), "(other".to_owned());
        let problem = read(Some(&storage), Some(folder.path())).2.unwrap();
        assert!(problem.contains("settings-2.ron"), "the first ones are not replaced: {problem}");
    }

    #[test]
    fn settings_that_were_cut_come_back_from_the_copy() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(SETTINGS_FILE);
        assert_eq!(problems(Some(folder.path())), Vec::<String>::new(), "a first start");
        let whole = "{\n    \"app\": \"(zoom:None)\",\n}";
        std::fs::write(&path, whole).unwrap();
        assert_eq!(problems(Some(folder.path())), Vec::<String>::new());
        for cut in ["", "{\n    \"app\": \"(zo"] {
            std::fs::write(&path, cut).unwrap();
            let told = problems(Some(folder.path()));
            assert!(told.len() == 1 && told[0].contains("not written whole"), "{told:?}");
            assert_eq!(std::fs::read_to_string(&path).unwrap(), whole);
        }
    }

    #[test]
    fn a_place_that_takes_no_files_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("home");
        std::fs::write(&file, "").unwrap();
        for place in [None, Some(file.join("apertura"))] {
            let told = problems(place.as_deref());
            assert!(told.len() == 1 && told[0].contains("can't be kept"), "{told:?}");
        }
    }

    /// Settings written by version 0.1.0; never to be rewritten.
    const OF_0_1_0: &str = include_str!("../../tests/data/program-0.1.0/settings.ron");

    #[test]
    fn settings_of_version_0_1_0_are_read() {
        let mut storage = InMemory::default();
        storage.0.insert(eframe::APP_KEY.to_owned(), OF_0_1_0.trim_end().to_owned());
        let (kept, captions, problem) = read(Some(&storage), None);
        assert_eq!((problem, captions), (None, false));
        let settings = &kept.settings;
        assert_eq!([settings.floor.to_string(), settings.normalisation.to_string()], ["snr=17.5", "db=60"]);
        assert_eq!((settings.method.as_str(), settings.method_eta["live"]), ("hybrid", 0.75));
        assert_eq!((settings.target_eta, settings.show_reflectors, settings.random_seed), (0.85, true, 41));
        assert_eq!(settings.cfar.unwrap().to_string(), "os:guard=2x2:training=4x8:rate=0.001");
        assert_eq!((kept.progress.learner(), kept.progress.score()), ("Ada", (1, 1)));
        assert!(kept.progress.record("near-field", 2).challenge_met);
        assert_eq!((kept.recent[0].to_str(), kept.zoom), (Some("/home/ada/scenes/post.toml"), Some(1.25)));
        assert_eq!(kept.recent_commands, ["Save"]);
    }
}
