//! Scenes kept with a note, in a folder of the user's own that is also a test set.

use crate::platform::fs;
use crate::scene::file::{self, SceneFile};
use std::path::{Path, PathBuf};

/// Most characters of a scene's name in the name of its file.
const NAME: usize = 40;

/// Writes `file` into `folder` under a name that sorts after all others there, so that earlier rows of the folder keep their scenes.
///
/// # Errors
/// The reason why nothing was written.
pub fn keep(folder: &Path, mut file: SceneFile, note: &str) -> Result<PathBuf, String> {
    let told = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    fs::create_dir_all(folder).map_err(|e| told(folder, e))?;
    let mut last = 0;
    for entry in fs::read_dir(folder).map_err(|e| told(folder, e))? {
        let name = entry.map_err(|e| told(folder, e))?.file_name();
        let digits: String = name.to_string_lossy().chars().take_while(char::is_ascii_digit).collect();
        last = last.max(digits.parse::<u32>().unwrap_or(0));
    }
    let note = note.trim();
    let notes = [note, file.scene.notes.as_str()].into_iter().filter(|n| !n.is_empty()).collect::<Vec<_>>();
    file.scene.notes = notes.join("\n\n");
    let path = folder.join(format!("{:04}-{}.toml", last.saturating_add(1), plain(&file.scene.name)));
    file::save(&path, &file).map_err(|e| e.to_string())?;
    Ok(path)
}

/// The name in lower-case ASCII letters, digits and hyphens, which any file system takes.
fn plain(name: &str) -> String {
    let letters = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' });
    let words: String = letters.take(NAME).collect();
    let words: Vec<&str> = words.split_whitespace().collect();
    if words.is_empty() { "scene".to_owned() } else { words.join("-") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::sets::SceneFolder;
    use crate::scene::Scene;

    #[test]
    fn kept_scenes_stand_in_the_order_they_were_kept() {
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("own");
        let of = |name: &str| {
            let scene = Scene { name: name.into(), notes: "Old.".into(), ..Scene::of_points([(1.0, 9.0)]) };
            SceneFile { scene, ..SceneFile::default() }
        };
        for name in ["Walls 3, seed 0", "a", ""] {
            keep(&own, of(name), " Misses the corner. ").unwrap();
        }
        let set = SceneFolder::open(&own).unwrap();
        let names = [0, 1, 2].map(|i| set.file(i).unwrap().file_name().unwrap().to_owned());
        assert_eq!(names, ["0001-walls-3-seed-0.toml", "0002-a.toml", "0003-scene.toml"]);
        let first = file::load(set.file(0).unwrap()).unwrap().scene;
        assert_eq!(first.notes, "Misses the corner.\n\nOld.");
        std::fs::write(folder.path().join("file"), "").unwrap();
        assert!(keep(&folder.path().join("file"), of("a"), "").unwrap_err().contains("file"));
    }
}
