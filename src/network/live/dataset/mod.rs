//! Examples on disk, for programs that read files: shards of NumPy arrays in three splits, and a manifest with their hashes.
//!
//! ```text
//! DIR/manifest.json                 format, origin, the files of each split with their SHA-256
//! DIR/train/00000.ends.npy          complex128 [examples, 2, 12, 512]; of a layout 00000.heard.npy [examples, elements, samples]
//! DIR/train/00000.fine.npy ...      the live network's input, where the radar has a fitting shape, and the targets by their names
//! DIR/validation/...  DIR/test/...
//! ```
//!
//! The scenes of the splits have different random streams ([`Purpose`]). Example `i` of a split is scene `i / kinds` of kind `i % kinds`: a longer
//! dataset begins with the examples of a shorter one.

mod manifest;
mod shard;

pub use manifest::{FILE_NAME, Manifest, VERSION};

use super::arrays::Arrays;
use super::examples::{Example, ExampleError, Examples, ExamplesRequest, Features};
use super::radars::{DRAWN_LIMITS, Radars};
use crate::evaluate::Target;
use crate::files::{make_folder, sha256, write_bytes};
use crate::network::floors::Floors;
use crate::platform::fs;
use crate::radar::Radar;
use crate::scene::generate::{Kind, Mixture, Purpose};
use crate::task::{Cancelled, Task};
use manifest::{FileEntry, ShardEntry};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Precision of features and target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DatasetPrecision {
    /// float16: 11 bits, half the space.
    #[default]
    Half,
    /// float32.
    Single,
}

impl FromStr for DatasetPrecision {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "f16" | "float16" => Ok(DatasetPrecision::Half),
            "f32" | "float32" => Ok(DatasetPrecision::Single),
            _ => Err(format!("unknown precision \"{name}\"; expected f16 or f32")),
        }
    }
}

/// A part of an example that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExamplePart {
    /// The samples of both ends, or of the elements of a layout.
    Ends,
    /// The live network's input.
    Features,
    /// A map of the whole array in decades.
    Target(Target),
}

impl ExamplePart {
    /// The default parts of examples: samples, targets, and the live network's input where the radar has a fitting shape and there is no layout.
    pub fn usual(radars: &Radars, layout: Option<&[usize]>) -> Vec<ExamplePart> {
        let fits = layout.is_none()
            && match radars {
                Radars::Fixed(radar) => DRAWN_LIMITS.has_shape(radar),
                Radars::Random => true,
            };
        let features = fits.then_some(ExamplePart::Features);
        [ExamplePart::Ends].into_iter().chain(features).chain(Target::USUAL.map(ExamplePart::Target)).collect()
    }

    fn arrays(self, layout: Option<usize>) -> Vec<ArrayKind> {
        match self {
            ExamplePart::Ends => vec![layout.map_or(ArrayKind::Ends, ArrayKind::Layout)],
            ExamplePart::Features => {
                vec![ArrayKind::Fine, ArrayKind::Coarse, ArrayKind::Rows, ArrayKind::Scalars, ArrayKind::Constants]
            }
            ExamplePart::Target(target) => vec![ArrayKind::Target(target)],
        }
    }
}

impl fmt::Display for ExamplePart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ExamplePart::Ends => "ends",
            ExamplePart::Features => "features",
            ExamplePart::Target(target) => target.array(),
        })
    }
}

impl FromStr for ExamplePart {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "ends" => Ok(ExamplePart::Ends),
            "features" => Ok(ExamplePart::Features),
            _ if name.starts_with("target") => name.parse().map(ExamplePart::Target),
            _ => Err(format!(
                "unknown array \"{name}\"; expected ends, features, target_ideal, target_measured or target_calibrated"
            )),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ArrayKind {
    Ends,
    Layout(usize),
    Fine,
    Coarse,
    Rows,
    Scalars,
    Constants,
    Target(Target),
    Gain,
}

/// The contents of a dataset to write.
#[derive(Debug, Clone, PartialEq)]
pub struct DatasetRequest {
    /// Kinds of scenes, in equal numbers.
    pub kinds: Vec<Kind>,
    /// Scenes of each kind for training, validation and test.
    pub counts: [u32; 3],
    /// Seed of the scenes.
    pub seed: u64,
    /// Floors of the scenes.
    pub floors: Floors,
    /// Arrays of the scenes.
    pub arrays: Arrays,
    /// Radars of the scenes.
    pub radars: Radars,
    /// Numbers of the elements with samples, in place of the two ends.
    pub layout: Option<Vec<usize>>,
    /// Precision of features and targets.
    pub precision: DatasetPrecision,
    /// The parts of an example to write.
    pub parts: Vec<ExamplePart>,
    /// Examples of a shard, all of which are in memory at once, some 6 MB each.
    pub shard: u32,
}

impl DatasetRequest {
    /// Scenes of each kind for training, validation and test; by default a tenth of `training` for the last two, without tests for [`Kind::World`].
    pub fn counts(kinds: &[Kind], training: u32, validation: Option<u32>, test: Option<u32>) -> [u32; 3] {
        let tenth = training.div_ceil(10);
        let default_test = if kinds.contains(&Kind::World) { 0 } else { tenth };
        [training, validation.unwrap_or(tenth), test.unwrap_or(default_test)]
    }
}

/// The reason why a dataset can't be written.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum DatasetError {
    #[error("{0}")]
    Request(String),
    #[error("{path}: {source}")]
    File { path: PathBuf, source: io::Error },
    #[error(transparent)]
    Example(#[from] ExampleError),
    #[error("cancelled")]
    Cancelled(#[from] Cancelled),
}

/// Writes a dataset into `folder`, an empty folder or a new one, and last its manifest.
/// # Errors
/// [`DatasetError`]. The folder then has no manifest, which marks an incomplete dataset.
pub fn write(folder: &Path, request: &DatasetRequest, task: &Task) -> Result<Manifest, DatasetError> {
    let on = |path: &Path| {
        let path = path.to_owned();
        move |source| DatasetError::File { path, source }
    };
    check(request)?;
    // Requests that can't be fulfilled are refused before files are written.
    let makers_of =
        |(purpose, count): (Purpose, u32)| if count > 0 { makers(request, purpose) } else { Ok(Vec::new()) };
    let purposes = [Purpose::Training, Purpose::Validation, Purpose::Test];
    let makers = purposes.into_iter().zip(request.counts).map(makers_of).collect::<Result<Vec<_>, _>>()?;
    make_folder(folder).map_err(on(folder))?;
    if fs::read_dir(folder).map_err(on(folder))?.next().is_some() {
        let message = format!("{} is not empty; expected an empty folder or a new one", folder.display());
        return Err(DatasetError::Request(message));
    }
    let heard = request.layout.as_ref().map(Vec::len);
    let arrays: Vec<ArrayKind> =
        request.parts.iter().flat_map(|part| part.arrays(heard)).chain([ArrayKind::Gain]).collect();
    let mut manifest = manifest_of(request, &arrays);
    let mut done = 0;
    for ((split, makers), count) in ["train", "validation", "test"].into_iter().zip(makers).zip(request.counts) {
        let mut shards = Vec::new();
        let total = count * makers.len() as u32;
        if total > 0 {
            let split_folder = folder.join(split);
            fs::create_dir_all(&split_folder).map_err(on(&split_folder))?;
        }
        for first in (0..total).step_by(request.shard as usize) {
            let last = total.min(first + request.shard);
            let examples: Result<Vec<Example>, DatasetError> = (first..last)
                .into_par_iter()
                .map(|i| {
                    task.check()?;
                    let kinds = makers.len() as u32;
                    Ok(makers[(i % kinds) as usize].example(i / kinds, task)?)
                })
                .collect();
            let examples = examples?;
            let radar = request.radars.shape();
            let files = write_shard(folder, split, shards.len(), &examples, (&arrays, &radar), request.precision)?;
            let kinds = examples.iter().flat_map(|e| e.kind).map(|kind| kind.to_string()).collect();
            let is_drawn = request.radars == Radars::Random;
            let radars = examples.iter().filter(|_| is_drawn).map(|e| e.radar.clone()).collect();
            shards.push(ShardEntry { examples: last - first, kinds, radars, files });
            done += last - first;
            task.set_progress(done as f32 / examples_of(request) as f32);
        }
        manifest.splits.insert(split.to_owned(), shards);
    }
    let path = folder.join(FILE_NAME);
    let text = serde_json::to_string_pretty(&manifest).map_err(|e| DatasetError::Request(e.to_string()))?;
    write_bytes(&path, text.as_bytes()).map_err(on(&path))?;
    Ok(manifest)
}

fn examples_of(request: &DatasetRequest) -> u64 {
    request.counts.iter().map(|count| u64::from(*count)).sum::<u64>() * request.kinds.len() as u64
}

fn check(request: &DatasetRequest) -> Result<(), DatasetError> {
    let refuse = |message: String| Err(DatasetError::Request(message));
    if request.kinds.is_empty() || request.parts.is_empty() {
        return refuse("there is nothing to write; expected at least one kind of scenes and one array".to_owned());
    }
    if let Some((_, part)) = request.parts.iter().enumerate().find(|(i, part)| request.parts[..*i].contains(part)) {
        return refuse(format!("array {part} is given twice"));
    }
    if let Some(kind) = request.kinds.iter().enumerate().find(|(i, kind)| request.kinds[..*i].contains(kind)) {
        return refuse(format!("kind {} is given twice", kind.1));
    }
    if !(1..=4096).contains(&request.shard) {
        return refuse(format!("a shard of {} examples is asked for; expected 1 to 4096", request.shard));
    }
    if request.counts[0] == 0 || examples_of(request) > 100_000_000 {
        return refuse(format!(
            "{} examples are asked for; expected 1 to 100000000, some for training",
            examples_of(request)
        ));
    }
    Ok(())
}

fn makers(request: &DatasetRequest, purpose: Purpose) -> Result<Vec<Examples>, DatasetError> {
    let targets = request
        .parts
        .iter()
        .filter_map(|part| if let ExamplePart::Target(target) = part { Some(*target) } else { None });
    let features = if request.parts.contains(&ExamplePart::Features) { Features::Needed } else { Features::No };
    let of_all = ExamplesRequest {
        purpose,
        seed: request.seed,
        floors: request.floors,
        arrays: request.arrays,
        radars: request.radars.clone(),
        targets: targets.collect(),
        features,
        layout: request.layout.clone(),
        ..ExamplesRequest::default()
    };
    let of = |kind: &Kind| Examples::new(ExamplesRequest { mixture: Mixture::of(*kind), ..of_all.clone() });
    request.kinds.iter().map(of).collect::<Result<_, _>>().map_err(DatasetError::Request)
}

fn write_shard(
    folder: &Path,
    split: &str,
    number: usize,
    examples: &[Example],
    (arrays, radar): (&[ArrayKind], &Radar),
    precision: DatasetPrecision,
) -> Result<BTreeMap<String, FileEntry>, DatasetError> {
    let array_name = |array: &ArrayKind| array.entry(radar, precision).0;
    let name_of = |array: &ArrayKind| format!("{split}/{number:05}.{}.npy", array_name(array));
    let write = |array: &ArrayKind| {
        let name = name_of(array);
        let bytes = array.file(examples, radar, precision);
        let path = folder.join(&name);
        write_bytes(&path, &bytes).map_err(|source| DatasetError::File { path: path.clone(), source })?;
        let entry = FileEntry { name, bytes: bytes.len() as u64, sha256: sha256::of_bytes(&bytes) };
        Ok((array_name(array).to_owned(), entry))
    };
    let written: Result<_, DatasetError> = arrays.par_iter().map(write).collect();
    if written.is_err() {
        arrays.iter().for_each(|array| _ = fs::remove_file(folder.join(name_of(array))));
    }
    written
}

fn manifest_of(request: &DatasetRequest, arrays: &[ArrayKind]) -> Manifest {
    let radar = &request.radars.shape();
    let entry = |array: &ArrayKind| {
        let (name, entry) = array.entry(radar, request.precision);
        (name.to_owned(), entry)
    };
    Manifest {
        apertura_dataset: VERSION,
        program: env!("CARGO_PKG_VERSION").to_owned(),
        seed: request.seed,
        kinds: request.kinds.iter().map(Kind::to_string).collect(),
        floor: request.floors.to_string(),
        radar: (request.radars != Radars::Random).then(|| radar.clone()),
        layout: request.layout.clone(),
        elements: (request.arrays != Arrays::IDEAL).then(|| {
            let Arrays { share, tolerances } = request.arrays;
            [share, tolerances.gain.0, tolerances.phase_degrees, tolerances.position_millimetres]
        }),
        arrays: arrays.iter().map(entry).collect(),
        splits: BTreeMap::new(),
    }
}

#[cfg(test)]
mod tests;
