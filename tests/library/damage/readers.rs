//! All readers of files from outside, with valid files to start from.

use crate::made_captures::{RISING, cfg};
use crate::prelude::*;
use apertura::evaluate::rows::write_rows;
use apertura::recording::RadarProfile;
use apertura::recording::presets::ALL as SHIPPED;
use apertura::scene::file;
use ndarray::{Ix2, Ix3};

pub struct Reader {
    pub name: &'static str,
    pub files: Vec<Vec<u8>>,
    /// Reads the bytes, through a file in the folder where there is no other way.
    pub read: fn(&Path, &[u8]) -> Result<(), String>,
    /// Most bytes that may be held while a file is read: so many, and so many more for each byte of the file.
    pub bound: [usize; 2],
    /// Every `slow`-th input is tried: the reader does more than read.
    pub slow: u64,
}

pub fn all() -> Vec<Reader> {
    let mut all = vec![scenes(), autosaves(), archives(), recordings(), recorded_data(), profiles(), shared()];
    all.extend([tables_of_rows(), lessons()]);
    #[cfg(feature = "network")]
    all.extend(networks::all());
    all
}

fn text(bytes: &[u8]) -> Result<&str, String> {
    std::str::from_utf8(bytes).map_err(|e| e.to_string())
}

fn told<T>(outcome: Result<T, impl ToString>) -> Result<(), String> {
    outcome.map(|_| ()).map_err(|e| e.to_string())
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    fs::write(folder.join(name), bytes).unwrap();
    folder.join(name)
}

fn older(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/program-0.1.0").join(name)
}

fn scene() -> SceneFile {
    file::load(&older("scene-thesis.toml")).unwrap()
}

fn scenes() -> Reader {
    let mut files: Vec<Vec<u8>> = presets::ALL.iter().map(|p| p.toml.as_bytes().to_vec()).collect();
    files.push(file::to_toml(&scene()).unwrap().into_bytes());
    let read = |_: &Path, bytes: &[u8]| {
        let file = file::from_toml(text(bytes)?).map_err(|e| e.to_string())?;
        let again = file::to_toml(&file).map_err(|e| e.to_string())?;
        assert_eq!(file::from_toml(&again), Ok(file));
        Ok(())
    };
    // The reflectors of the largest scene, and the tables of the text.
    Reader { name: "scene", files, read, bound: [16 << 20, 1024], slow: 1 }
}

fn autosaves() -> Reader {
    let beside = toml::Table::from_iter([("path".to_owned(), "/there/a.toml".into())]);
    let write = |file: &SceneFile| file::to_toml_beside(file, "document", &beside).unwrap().into_bytes();
    let files = vec![write(&scene()), write(&SceneFile::default())];
    let read = |_: &Path, bytes: &[u8]| told(file::from_toml_beside::<toml::Table>(text(bytes)?, "document"));
    Reader { name: "autosave", files, read, bound: [1 << 20, 1024], slow: 1 }
}

fn shared() -> Reader {
    use apertura::share::{SharedScene, SharedView, VisiblePart};
    use apertura::view::View;
    let method = "live".to_owned();
    let view = View { method, layout: "0-11 20".parse().ok(), show_theory: true, ..View::default() };
    let view = SharedView { time_seconds: 1.5, ..SharedView::of(&view, [VisiblePart::default(); 2], None) };
    let write = |file| SharedScene { file, view: view.clone() }.to_text().unwrap().into_bytes();
    let files = vec![write(scene()), write(SceneFile::default())];
    // Most bytes that a text may unpack to.
    let bound = [12 << 20, 1024];
    Reader { name: "shared", files, read: |_, bytes| told(SharedScene::from_text(text(bytes)?)), bound, slow: 1 }
}

fn archives() -> Reader {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let mut files = Vec::new();
    for points in [0, 1, 40] {
        let scene = Scene::of_points((0..points).map(|i| (f64::from(i), 5.0)));
        file::save(&path, &SceneFile { scene, ..SceneFile::default() }).unwrap();
        files.push(fs::read(&path).unwrap());
    }
    write_npz(&path, |out| {
        out.add("all_point_x", &Array1::<f32>::ones(3))?;
        out.add("all_point_y", &Array1::<i64>::ones(3))?;
        out.add("sub0", &Array2::<Complex64>::zeros((4, 3)))
    })
    .unwrap();
    files.push(fs::read(&path).unwrap());
    let read = |folder: &Path, bytes: &[u8]| {
        let path = written(folder, "damaged.npz", bytes);
        if let Ok(mut npz) = Npz::open(&path) {
            for key in npz.keys().to_vec() {
                let _any = (npz.reals::<Ix1>(&key), npz.complexes::<Ix2>(&key), npz.reals::<Ix3>(&key));
            }
        }
        told(file::load(&path))
    };
    Reader { name: "npz", files, read, bound: [1 << 20, 64], slow: 1 }
}

/// Memory for the largest radar's samples is bounded by the radar; damaged numbers of elements and samples stay far below.
const RECORDING_BOUND_BYTES: [usize; 2] = [64 << 20, 1024];

fn recordings() -> Reader {
    let files = SHIPPED.iter().map(|preset| preset.toml.as_bytes().to_vec()).collect();
    let read = |folder: &Path, bytes: &[u8]| {
        for preset in SHIPPED.iter().filter(|preset| !folder.join(preset.data_name).exists()) {
            written(folder, preset.data_name, preset.data);
        }
        told(recording::file::load(&written(folder, "recording.toml", bytes)))
    };
    Reader { name: "recording", files, read, bound: RECORDING_BOUND_BYTES, slow: 2 }
}

fn recorded_data() -> Reader {
    let files = SHIPPED.iter().map(|preset| preset.data.to_vec()).collect();
    let read = |folder: &Path, bytes: &[u8]| {
        let folder = folder.join("data");
        fs::create_dir_all(&folder).unwrap();
        let mut read = Err(String::new());
        for preset in SHIPPED {
            let path = folder.join(preset.data_name).with_extension("toml");
            if !path.exists() {
                fs::write(&path, preset.toml).unwrap();
            }
            written(&folder, preset.data_name, bytes);
            read = read.or_else(|_| told(recording::file::load(&path)));
        }
        read
    };
    Reader { name: "recorded data", files, read, bound: RECORDING_BOUND_BYTES, slow: 2 }
}

fn profiles() -> Reader {
    let read = |_: &Path, bytes: &[u8]| told(RadarProfile::parse(text(bytes)?));
    let files = vec![cfg(&RISING, &[1, 4], 8, "").into_bytes()];
    Reader { name: "profile", files, read, bound: [1 << 20, 1024], slow: 1 }
}

fn tables_of_rows() -> Reader {
    let campaign = Campaign::default();
    let empty = campaign.empty_rows(&[SceneSet::Generated(Kind::Set1)], &[&Baseline as &dyn Reconstructor]).unwrap();
    let mut made = Vec::new();
    write_rows(&mut made, &empty[0]).unwrap();
    let mut files =
        ["rows.csv", "rows-cfar.csv", "rows-folder.csv"].map(|name| fs::read(older(name)).unwrap()).to_vec();
    files.push(made);
    let read = |_: &Path, bytes: &[u8]| {
        let rows = read_rows(bytes).map_err(|e| e.to_string())?;
        let mut again = Vec::new();
        write_rows(&mut again, &rows).map_err(|e| e.to_string())?;
        assert_eq!(read_rows(again.as_slice()).unwrap(), rows);
        Ok(())
    };
    Reader { name: "rows", files, read, bound: [1 << 20, 256], slow: 1 }
}

fn lessons() -> Reader {
    let files = shipped::ALL.iter().map(|l| l.toml.as_bytes().to_vec()).collect();
    let read = |_: &Path, bytes: &[u8]| {
        let lesson = Lesson::from_toml(text(bytes)?).map_err(|e| e.to_string())?;
        lesson.steps.iter().for_each(|step| drop(step.scene()));
        Ok(())
    };
    Reader { name: "lesson", files, read, bound: [16 << 20, 1024], slow: 4 }
}

#[cfg(feature = "network")]
mod networks {
    use super::{Reader, text, told, written};
    use apertura::network::recipe::{Recipe, SHIPPED};
    use apertura::network::weights::WeightFile;
    use apertura::network::{backend::Backend, from_file, pytorch};
    use std::path::Path;

    const LIVE: &[u8] = include_bytes!("../../data/live_reference_weights.safetensors");
    const SHAPE: &[u8] = include_bytes!("../../data/shape_reference_weights.safetensors");
    const THESIS: &[u8] = include_bytes!("../../data/thesis_reference_weights.safetensors");
    const CHECKPOINT: &[u8] = include_bytes!("../../data/thesis_reference_weights.pt");

    pub fn all() -> [Reader; 4] {
        [safetensors(), checkpoints(), whole_networks(), recipes()]
    }

    fn safetensors() -> Reader {
        let read = |_: &Path, bytes: &[u8]| {
            let file = WeightFile::parse("damaged", bytes).map_err(|e| e.to_string())?;
            let _any = (file.network().len(), file.all_values().len(), file.provenance.eta());
            let renamed = file.renamed(|name| format!("x.{name}")).map_err(|e| e.to_string())?;
            told(WeightFile::parse("renamed", &renamed))
        };
        let files = vec![LIVE.to_vec(), THESIS.to_vec()];
        Reader { name: "safetensors", files, read, bound: [1 << 20, 256], slow: 1 }
    }

    fn checkpoints() -> Reader {
        let read = |folder: &Path, bytes: &[u8]| told(pytorch::read_weights(&written(folder, "damaged.pt", bytes)));
        // Copies through the memo are bounded by the reader itself; all tensors together by 1 GiB.
        let bound = [(1 << 30) + (128 << 20), 256];
        Reader { name: "pytorch", files: vec![CHECKPOINT.to_vec()], read, bound, slow: 1 }
    }

    fn whole_networks() -> Reader {
        let files = vec![THESIS.to_vec(), CHECKPOINT.to_vec(), SHAPE.to_vec()];
        let read = |folder: &Path, bytes: &[u8]| {
            told(from_file(&written(folder, "damaged.weights", bytes), Backend::default()))
        };
        Reader { name: "weights", files, read, bound: [2 << 30, 256], slow: 20 }
    }

    fn recipes() -> Reader {
        let files = SHIPPED.iter().map(|(_, text)| text.as_bytes().to_vec()).collect();
        let read = |_: &Path, bytes: &[u8]| {
            let recipe = Recipe::parse("damaged", text(bytes)?).map_err(|e| e.to_string())?;
            let _used = (recipe.learning_rate(recipe.epochs), recipe.training_scenes());
            Ok(())
        };
        Reader { name: "recipe", files, read, bound: [256 << 20, 1024], slow: 1 }
    }
}
