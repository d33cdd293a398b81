//! All readers of files from outside, with valid files to start from.

use crate::prelude::*;
use apertura::evaluate::rows::write_rows;
use apertura::recording::RadarProfile;
use apertura::scene::file;
use ndarray::{Ix2, Ix3};

pub struct Reader {
    pub name: &'static str,
    pub files: Vec<Vec<u8>>,
    /// Reads the bytes, through a file in the folder where there is no other way.
    pub read: fn(&Path, &[u8]) -> Result<(), String>,
    /// Most bytes that may be held while a file of this length is read.
    pub bound: fn(usize) -> usize,
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

fn scene() -> SceneFile {
    let line = Line { reflectivity: 0.5, direction_degrees: 30.0, ..Line::vertical(1.0, 2.0, 0.1, 75) };
    let cluster = GaussianCluster { seed: 9, ..GaussianCluster::new([-5.0, 20.0], [1.0, 0.5], 40) };
    let objects = vec![Object::Point(Point::new(1.0, 2.0)), Object::Line(line), Object::Gaussian(cluster)];
    let scene = Scene {
        name: "All \"three\"".to_owned(),
        notes: "First.\nSecond.".to_owned(),
        noise_seed: 5,
        objects,
        ..Scene::default()
    };
    SceneFile { scene, radar: Radar { carrier: Carrier::TwoWay, elements: 64, samples: 128, ..Radar::default() } }
}

fn scenes() -> Reader {
    let mut files: Vec<Vec<u8>> = presets::ALL.iter().map(|p| p.toml.as_bytes().to_vec()).collect();
    files.push(file::to_toml(&scene()).unwrap().into_bytes());
    Reader {
        name: "scene",
        files,
        read: |_, bytes| {
            let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
            let file = file::from_toml(text).map_err(|e| e.to_string())?;
            // An accepted text can be written and read again.
            let again = file::to_toml(&file).map_err(|e| e.to_string())?;
            assert_eq!(file::from_toml(&again), Ok(file));
            Ok(())
        },
        // The reflectors of the largest scene, and the tables of the text.
        bound: |length| (16 << 20) + 1024 * length,
        slow: 1,
    }
}

fn autosaves() -> Reader {
    let beside = toml::Table::from_iter([("path".to_owned(), "/there/a.toml".into())]);
    let write = |file: &SceneFile| file::to_toml_beside(file, "document", &beside).unwrap().into_bytes();
    Reader {
        name: "autosave",
        files: vec![write(&scene()), write(&SceneFile::default())],
        read: |_, bytes| {
            let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
            file::from_toml_beside::<toml::Table>(text, "document").map(|_| ()).map_err(|e| e.to_string())
        },
        bound: |length| (1 << 20) + 1024 * length,
        slow: 1,
    }
}

fn shared() -> Reader {
    use apertura::share::{SharedScene, SharedView, VisiblePart};
    use apertura::view::View;
    let method = "live".to_owned();
    let view = View { method, layout: "0-11 20".parse().ok(), show_theory: true, ..View::default() };
    let view = SharedView { time_seconds: 1.5, ..SharedView::of(&view, [VisiblePart::default(); 2], None) };
    let write = |file| SharedScene { file, view: view.clone() }.to_text().unwrap().into_bytes();
    Reader {
        name: "shared",
        files: vec![write(scene()), write(SceneFile::default())],
        read: |_, bytes| {
            let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
            SharedScene::from_text(text).map(|_| ()).map_err(|e| e.to_string())
        },
        // Most bytes that a text may unpack to.
        bound: |length| (12 << 20) + 1024 * length,
        slow: 1,
    }
}

fn archives() -> Reader {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let mut files = Vec::new();
    for points in [0, 1, 40] {
        file::save(
            &path,
            &SceneFile { scene: Scene::of_points((0..points).map(|i| (f64::from(i), 5.0))), ..SceneFile::default() },
        )
        .unwrap();
        files.push(std::fs::read(&path).unwrap());
    }
    write_npz(&path, |out| {
        out.add("all_point_x", &Array1::<f32>::ones(3))?;
        out.add("all_point_y", &Array1::<i64>::ones(3))?;
        out.add("sub0", &Array2::<Complex64>::zeros((4, 3)))
    })
    .unwrap();
    files.push(std::fs::read(&path).unwrap());
    Reader {
        name: "npz",
        files,
        read: |folder, bytes| {
            let path = folder.join("damaged.npz");
            std::fs::write(&path, bytes).map_err(|e| e.to_string())?;
            if let Ok(mut npz) = Npz::open(&path) {
                for key in npz.keys().to_vec() {
                    let _any = (npz.reals::<Ix1>(&key), npz.complexes::<Ix2>(&key), npz.reals::<Ix3>(&key));
                }
            }
            file::load(&path).map(|_| ()).map_err(|e| e.to_string())
        },
        bound: |length| (1 << 20) + 64 * length,
        slow: 1,
    }
}

/// The recordings that come with the program: data file, its bytes, text.
const RECORDINGS: [(&str, &[u8], &str); 2] = [
    (
        "chip-8.npz",
        include_bytes!("../../../assets/recordings/chip-8.npz"),
        include_str!("../../../assets/recordings/chip-8.toml"),
    ),
    (
        "cascade-86.mat",
        include_bytes!("../../../assets/recordings/cascade-86.mat"),
        include_str!("../../../assets/recordings/cascade-86.toml"),
    ),
];

/// Memory for the largest radar's samples is bounded by the radar; damaged numbers of elements and samples stay far below.
fn recording_bound(length: usize) -> usize {
    (64 << 20) + 1024 * length
}

/// Damaged descriptions beside whole data.
fn recordings() -> Reader {
    Reader {
        name: "recording",
        files: RECORDINGS.iter().map(|(_, _, text)| text.as_bytes().to_vec()).collect(),
        read: |folder, bytes| {
            for (name, data, _) in RECORDINGS {
                if !folder.join(name).exists() {
                    std::fs::write(folder.join(name), data).map_err(|e| e.to_string())?;
                }
            }
            let path = folder.join("recording.toml");
            std::fs::write(&path, bytes).map_err(|e| e.to_string())?;
            recording::file::load(&path).map(|_| ()).map_err(|e| e.to_string())
        },
        bound: recording_bound,
        slow: 2,
    }
}

/// Damaged data beside whole descriptions.
fn recorded_data() -> Reader {
    Reader {
        name: "recorded data",
        files: RECORDINGS.iter().map(|(_, data, _)| data.to_vec()).collect(),
        read: |folder, bytes| {
            let folder = folder.join("data");
            std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
            let mut read = Err(String::new());
            for (name, _, text) in RECORDINGS {
                let path = folder.join(name).with_extension("toml");
                if !path.exists() {
                    std::fs::write(&path, text).map_err(|e| e.to_string())?;
                }
                std::fs::write(folder.join(name), bytes).map_err(|e| e.to_string())?;
                read = read.or_else(|_| recording::file::load(&path).map(|_| ()).map_err(|e| e.to_string()));
            }
            read
        },
        bound: recording_bound,
        slow: 2,
    }
}

/// Set-up of a small radar.
const PROFILE: &str = "channelCfg 15 5 0
adcCfg 2 1
profileCfg 0 77 429 7 57.14 0 0 70 1 8 5209 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 2 0 100 1 0
";

fn profiles() -> Reader {
    Reader {
        name: "profile",
        files: vec![PROFILE.as_bytes().to_vec()],
        read: |_, bytes| {
            let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
            RadarProfile::parse(text).map(|_| ()).map_err(|e| e.to_string())
        },
        bound: |length| (1 << 20) + 1024 * length,
        slow: 1,
    }
}

fn tables_of_rows() -> Reader {
    let campaign = Campaign::default();
    let empty = campaign.empty_rows(&[SceneSet::Generated(Kind::Set1)], &[&Baseline as &dyn Reconstructor]).unwrap();
    let made = Row { index: 3, ..empty[0][0].clone() };
    let row = |index: u32, figure: Option<f64>| Row {
        set: "a \"set\", quoted".into(),
        index,
        seed: u64::from(index) << 60,
        eta: 0.5,
        squared_error: 321.25,
        detection: figure,
        milliseconds: 1.5,
        reflectors: 77,
        nearest_pair_bins: figure,
        found: figure.map(|_| 2),
        doubt: figure,
        ..made.clone()
    };
    let mut file = Vec::new();
    write_rows(&mut file, &[row(0, None), row(1, Some(1e-3)), row(2, Some(0.75)), made.clone()]).unwrap();
    Reader {
        name: "rows",
        files: vec![file],
        read: |_, bytes| {
            let rows = read_rows(bytes).map_err(|e| e.to_string())?;
            let mut again = Vec::new();
            write_rows(&mut again, &rows).map_err(|e| e.to_string())?;
            assert_eq!(read_rows(again.as_slice()).unwrap(), rows);
            Ok(())
        },
        bound: |length| (1 << 20) + 256 * length,
        slow: 1,
    }
}

fn lessons() -> Reader {
    Reader {
        name: "lesson",
        files: shipped::ALL.iter().map(|l| l.toml.as_bytes().to_vec()).collect(),
        read: |_, bytes| {
            let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
            let lesson = Lesson::from_toml(text).map_err(|e| e.to_string())?;
            lesson.steps.iter().for_each(|step| drop(step.scene()));
            Ok(())
        },
        // The reflectors of the largest scene, and the tables of the text.
        bound: |length| (16 << 20) + 1024 * length,
        slow: 4,
    }
}

#[cfg(feature = "network")]
mod networks {
    use super::Reader;
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
        Reader {
            name: "safetensors",
            files: vec![LIVE.to_vec(), THESIS.to_vec()],
            read: |_, bytes| {
                let file = WeightFile::parse("damaged", bytes).map_err(|e| e.to_string())?;
                let _any = (file.network().len(), file.all_values().len(), file.provenance.eta());
                let renamed = file.renamed(|name| format!("x.{name}")).map_err(|e| e.to_string())?;
                WeightFile::parse("renamed", &renamed).map(|_| ()).map_err(|e| e.to_string())
            },
            bound: |length| (1 << 20) + 256 * length,
            slow: 1,
        }
    }

    fn checkpoints() -> Reader {
        Reader {
            name: "pytorch",
            files: vec![CHECKPOINT.to_vec()],
            read: |folder, bytes| {
                let path = folder.join("damaged.pt");
                std::fs::write(&path, bytes).map_err(|e| e.to_string())?;
                pytorch::read_weights(&path).map(|_| ()).map_err(|e| e.to_string())
            },
            // Copies through the memo are bounded by the reader itself; all tensors together by 1 GiB.
            bound: |length| (1 << 30) + (128 << 20) + 256 * length,
            slow: 1,
        }
    }

    /// Networks, read up to a method that could be used.
    fn whole_networks() -> Reader {
        Reader {
            name: "weights",
            files: vec![THESIS.to_vec(), CHECKPOINT.to_vec(), SHAPE.to_vec()],
            read: |folder, bytes| {
                let path = folder.join("damaged.weights");
                std::fs::write(&path, bytes).map_err(|e| e.to_string())?;
                from_file(&path, Backend::default()).map(|_| ()).map_err(|e| e.to_string())
            },
            bound: |length| (2 << 30) + 256 * length,
            slow: 20,
        }
    }

    fn recipes() -> Reader {
        Reader {
            name: "recipe",
            files: SHIPPED.iter().map(|(_, text)| text.as_bytes().to_vec()).collect(),
            read: |_: &Path, bytes| {
                let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
                let recipe = Recipe::parse("damaged", text).map_err(|e| e.to_string())?;
                let _rate = recipe.learning_rate(recipe.epochs);
                let _list = recipe.training_scenes();
                Ok(())
            },
            bound: |length| (256 << 20) + 1024 * length,
            slow: 1,
        }
    }
}
