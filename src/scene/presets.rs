//! Scenes that come with the program, with name and notes: the files of `assets/scenes`, embedded.

use super::file::{SceneFile, SceneTextError, from_toml};

/// A scene that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Name of its file in `assets/scenes`, without `.toml`.
    pub id: &'static str,
    pub toml: &'static str,
}

macro_rules! presets {
    ($($id:literal),* $(,)?) => {
        &[$(Preset { id: $id, toml: include_str!(concat!("../../assets/scenes/", $id, ".toml")) }),*]
    };
}

/// Every preset, in the order they are listed. The first is the [`default_scene`].
pub const ALL: &[Preset] = presets![
    "street",
    "four-reflectors",
    "one-at-20-m",
    "one-at-20-m-a-tenth-of-a-radian-off",
    "two-close-in-range",
    "points-by-a-line",
    "gaussian-clusters",
    "point-behind-a-line",
    "beyond-the-range",
    "cylinder-and-cube",
    "street-of-things",
    "car-behind-a-car",
    "traffic",
    "tunnel",
    "corner",
    "test-set-1",
    "test-set-2",
    "test-set-3",
    "empty",
    "failure-live-missed",
    "failure-live-merged",
    "failure-live-ghost",
    "failure-live-wrong-tooth",
    "failure-hybrid-merged",
    "failure-thesis-missed",
    "failure-thesis-merged",
    "failure-thesis-ghost",
    "failure-thesis-wrong-tooth",
];

impl Preset {
    /// Whether its file names a radar; another scene is seen by the radar on screen.
    pub fn has_radar(&self) -> bool {
        self.toml.lines().any(|line| line.trim() == "[radar]")
    }

    /// The scene.
    /// # Errors
    /// None for the presets of [`ALL`]: a test reads each of them.
    pub fn load(&self) -> Result<SceneFile, SceneTextError> {
        from_toml(self.toml)
    }

    /// Name of the method that fails on it, as its notes explain.
    pub fn failing_method(&self) -> Option<&'static str> {
        self.id.strip_prefix("failure-")?.split('-').next()
    }

    /// Whether a method fails on it, as its notes explain.
    pub fn is_failure(&self) -> bool {
        self.failing_method().is_some()
    }

    pub fn by_id(id: &str) -> Option<&'static Preset> {
        ALL.iter().find(|p| p.id == id)
    }
}

/// The scene that the program shows without a file.
pub fn default_scene() -> SceneFile {
    ALL[0].load().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_preset_has_notes() {
        let mut names = HashSet::new();
        for preset in ALL {
            let scene = preset.load().unwrap_or_else(|e| panic!("{}: {e}", preset.id)).scene;
            assert!(scene.notes.len() > 80, "{}: notes say what to look for", preset.id);
            assert_eq!(scene.objects.is_empty(), preset.id == "empty", "{}", preset.id);
            assert!(!scene.name.is_empty() && names.insert(scene.name), "{}: its own name", preset.id);
        }
        assert!(!default_scene().scene.objects.is_empty());
    }

    #[test]
    fn every_file_is_listed() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes");
        let files = std::fs::read_dir(folder).unwrap().count();
        assert_eq!(files, ALL.len(), "files in {folder}");
    }
}
