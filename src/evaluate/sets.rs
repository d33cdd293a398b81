//! Scenes that methods are tried on: a kind of generated scenes, or a folder of scene files.

use super::tables::PRINTED_EXPERIMENT_2;
use crate::files::{read_bounded, sha256};
use crate::platform::fs;
use crate::radar::{DecibelMilliwatts, Radar};
use crate::scene::Scene;
use crate::scene::file::{self, MAX_FILE_BYTES, SceneFile, SceneFileError};
use crate::scene::generate::{Generator, Kind};
use crate::signal::Floor;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A false-alarm rate for scenes that the thesis prints no table of.
const UNPRINTED_FALSE_ALARM_RATE: f64 = 0.01;

/// Level of the noise of scenes of noise alone, where no thermal noise was asked for.
pub const NOISE_LEVEL: DecibelMilliwatts = DecibelMilliwatts(-20.0);

/// A set of scenes.
#[derive(Debug, Clone, PartialEq)]
pub enum SceneSet {
    /// Random scenes of one kind.
    Generated(Kind),
    /// A folder of the user's.
    Folder(SceneFolder),
    /// Scenes given one by one.
    Listed(SceneList),
}

/// Scenes that are given one by one, with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneList {
    name: String,
    cases: Arc<Vec<SceneCase>>,
    fingerprint: String,
}

impl SceneList {
    /// A set called `name` in rows.
    /// # Errors
    /// [`toml::ser::Error`] for a scene that can't be written as a file.
    pub fn new(name: String, cases: Vec<SceneCase>) -> Result<SceneList, toml::ser::Error> {
        let of = |case: &SceneCase| file::to_toml(&SceneFile { scene: case.scene.clone(), radar: case.radar.clone() });
        let texts: Vec<String> = cases.iter().map(of).collect::<Result<_, _>>()?;
        // A zero byte, which no file contains, ends each scene's text.
        let digest = sha256::of_pieces(texts.iter().flat_map(|text| [text.as_bytes(), b"\0".as_slice()]));
        Ok(SceneList { name, cases: Arc::new(cases), fingerprint: sha256::short(&digest).to_owned() })
    }

    /// The fingerprint of the scenes and their radars, equal only where all are equal.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

/// The scene files of a folder, in the order of their names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneFolder {
    path: PathBuf,
    files: Vec<PathBuf>,
}

/// A folder without a scene, or a folder or file that can't be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {why}", path.display())]
pub struct FolderError {
    path: PathBuf,
    why: String,
}

impl FolderError {
    fn on(path: &Path) -> impl Fn(io::Error) -> FolderError {
        move |error| FolderError { path: path.to_owned(), why: error.to_string() }
    }
}

impl SceneFolder {
    /// Lists the scene files of `path` without reading them. Files whose names begin with a dot are left out.
    /// # Errors
    /// [`FolderError`] where there is none.
    pub fn open(path: &Path) -> Result<SceneFolder, FolderError> {
        let mut files = Vec::new();
        for entry in fs::read_dir(path).map_err(FolderError::on(path))? {
            let file = entry.map_err(FolderError::on(path))?.path();
            let hidden = file.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
            if !hidden && file.is_file() && file::SceneFormat::of_path(&file).is_ok() {
                files.push(file);
            }
        }
        files.sort();
        if files.is_empty() {
            let why = "there is no scene in this folder; expected files ending in .toml or .npz".to_owned();
            Err(FolderError { path: path.to_owned(), why })
        } else {
            Ok(SceneFolder { path: path.to_owned(), files })
        }
    }

    /// The fingerprint of the files' names and contents, equal only where all are equal.
    /// # Errors
    /// [`FolderError`] names the file that can't be read.
    pub fn fingerprint(&self) -> Result<String, FolderError> {
        let mut pieces = Vec::new();
        for path in &self.files {
            let bytes = read_bounded(path, MAX_FILE_BYTES).map_err(FolderError::on(path))?;
            let name = path.file_name().unwrap_or_default().as_encoded_bytes().to_vec();
            pieces.extend([name, sha256::of_pieces([bytes.as_slice()]).into_bytes()]);
        }
        let digest = sha256::of_pieces(pieces.iter().map(Vec::as_slice));
        Ok(sha256::short(&digest).to_owned())
    }

    /// The file of scene `index`.
    pub fn file(&self, index: u32) -> Option<&Path> {
        self.files.get(index as usize).map(PathBuf::as_path)
    }
}

/// A scene of a set, with its radar.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneCase {
    /// The radar.
    pub radar: Radar,
    /// The scene; its [`Scene::noise_seed`] picks the floor's noise.
    pub scene: Scene,
}

impl SceneSet {
    /// The set called `name` in rows: a kind of scenes, or else a folder.
    /// # Errors
    /// [`FolderError`] for a folder without a scene.
    pub fn by_name(name: &str) -> Result<SceneSet, FolderError> {
        match name.parse() {
            Ok(kind) => Ok(SceneSet::Generated(kind)),
            Err(_) => SceneFolder::open(Path::new(name)).map(SceneSet::Folder),
        }
    }

    /// Number of scenes; `None` for generated scenes, which have no end.
    pub fn len(&self) -> Option<u32> {
        match self {
            SceneSet::Generated(_) => None,
            SceneSet::Folder(folder) => Some(u32::try_from(folder.files.len()).unwrap_or(u32::MAX)),
            SceneSet::Listed(listed) => Some(u32::try_from(listed.cases.len()).unwrap_or(u32::MAX)),
        }
    }

    /// Whether the set has no scenes: a folder always has some.
    pub fn is_empty(&self) -> bool {
        self.len() == Some(0)
    }

    /// Scene `index`. `radar` and `generator` are those of generated scenes; a file names its own radar.
    /// # Errors
    /// [`SceneFileError`] for a file that can't be read as a scene.
    pub fn case(&self, radar: &Radar, generator: &Generator, index: u32) -> Result<SceneCase, SceneFileError> {
        match self {
            SceneSet::Generated(kind) => Ok(SceneCase { radar: radar.clone(), scene: generator.scene(*kind, index) }),
            SceneSet::Folder(folder) => {
                let path = folder.file(index).unwrap_or(&folder.path);
                file::load(path).map(|file| SceneCase { radar: file.radar, scene: file.scene })
            }
            SceneSet::Listed(listed) => {
                let beyond = || SceneCase { radar: radar.clone(), scene: Scene::default() };
                Ok(listed.cases.get(index as usize).cloned().unwrap_or_else(beyond))
            }
        }
    }

    /// The floor of this set's scenes where a run has `floor`. Scenes of noise alone have thermal noise: `floor` where it is thermal, else that
    /// of [`NOISE_LEVEL`], since any other floor leaves scenes without echoes silent.
    pub fn floor(&self, floor: Floor) -> Floor {
        match (self, floor) {
            (SceneSet::Generated(Kind::Noise), Floor::Level(_) | Floor::Thermal) => floor,
            (SceneSet::Generated(Kind::Noise), _) => Floor::Level(NOISE_LEVEL),
            _ => floor,
        }
    }

    /// The false-alarm rate at which methods are compared: the rate that the thesis prints for its experiment 2, and 1 % where it prints none.
    pub fn false_alarm(&self) -> f64 {
        match self {
            SceneSet::Generated(kind) => false_alarm(kind.test_set()),
            SceneSet::Folder(_) | SceneSet::Listed(_) => false_alarm(None),
        }
    }
}

/// [`SceneSet::false_alarm`] of test set 1, 2 or 3, or of another set.
pub fn false_alarm(test_set: Option<usize>) -> f64 {
    let printed = test_set.and_then(|set| PRINTED_EXPERIMENT_2.get(set.wrapping_sub(1)));
    printed.map_or(UNPRINTED_FALSE_ALARM_RATE, |p| p.false_alarm)
}

/// The set's name in rows. A folder that is called like a kind is "./kind".
impl fmt::Display for SceneSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SceneSet::Generated(kind) => kind.fmt(f),
            SceneSet::Folder(folder) => {
                let path = folder.path.display();
                if path.to_string().parse::<Kind>().is_ok() { write!(f, "./{path}") } else { path.fmt(f) }
            }
            SceneSet::Listed(listed) => listed.name.fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_a_set_of_its_scene_files() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let empty = SceneFolder::open(folder.path()).unwrap_err().to_string();
        assert!(empty.contains("no scene in this folder"), "{empty}");
        write("b.toml", "name = \"b\"");
        write("a.toml", "name = \"a\"\nnoise_seed = 12");
        write("notes.txt", "");
        write(".hidden.toml", "");
        let set = SceneSet::Folder(SceneFolder::open(folder.path()).unwrap());
        assert_eq!((set.len(), set.false_alarm()), (Some(2), 0.01));
        let radar = Radar::default();
        let generator = Generator::new(&radar, Default::default(), crate::scene::generate::Purpose::Test, 0);
        let case = set.case(&radar, &generator, 0).unwrap();
        assert_eq!((case.scene.name.as_str(), case.scene.noise_seed), ("a", 12));
        assert!(set.case(&radar, &generator, 7).is_err());
        let fingerprint = || SceneFolder::open(folder.path()).unwrap().fingerprint().unwrap();
        let before = fingerprint();
        assert_eq!((before.len(), fingerprint()), (12, before.clone()));
        write("b.toml", "name = \"another\"");
        assert_ne!(fingerprint(), before, "what stands in a file counts");
        assert!(SceneFolder::open(&folder.path().join("missing")).unwrap_err().to_string().contains("missing"));
    }

    #[test]
    fn a_folder_called_like_a_kind_stays_a_folder() {
        let folder = SceneFolder { path: "walls".into(), files: Vec::new() };
        assert_eq!(SceneSet::Folder(folder).to_string(), "./walls");
    }
}
