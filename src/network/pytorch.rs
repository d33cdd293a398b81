//! PyTorch checkpoints (`.pt`, `.pth`), translated to safetensors so that one reader checks and loads both.

use super::weights::{self, Provenance, TensorHeader, WeightsError};
use crate::files::kind::kind_of;
use crate::files::read_bounded;
use burn::store::pytorch_reader::PytorchReader;
use std::collections::BTreeMap;
use std::path::Path;

/// Most bytes of a weight file, and of all tensors of a checkpoint together: 1 GiB, some 160 times the thesis' network.
const MAX_BYTES: u64 = 1 << 30;

/// Keys under which programs keep a network's state beside an optimizer's and others; the first that a file has counts. `training` keeps the
/// averaged weights, which it validates and ships, under `average`.
const STATE_KEYS: [&str; 6] = ["average", "model_state_dict", "state_dict", "model", "network", "net"];
const MAX_STATE_DEPTH: usize = 4;
/// Prefix that `DataParallel` adds to every name.
const PARALLEL_PREFIX: &str = "module.";

/// The bytes of the weight file at `path` as safetensors: those of a safetensors file as they are; those of a PyTorch checkpoint,
/// which holds a `state_dict` by itself or under one of [`STATE_KEYS`], translated. Names, shapes and types stay PyTorch's; tensors beside
/// the state, such as an optimizer's, are not read.
/// # Errors
/// [`WeightsError`] when it can't be read, and when it is neither.
pub fn read_weights(path: &Path) -> Result<Vec<u8>, WeightsError> {
    let file = path.display();
    let bytes = read_bounded(path, MAX_BYTES).map_err(|e| WeightsError(format!("{file}: {e}")))?;
    if !is_pytorch(&bytes) {
        return Ok(bytes);
    }
    translate(path).map_err(|reason| {
        let reason = match kind_of(&bytes) {
            Some(kind) if !kind.contains("PyTorch") => format!("it is {kind} ({reason})"),
            _ => reason,
        };
        WeightsError(format!("{file} is not a PyTorch checkpoint that can be read: {reason}"))
    })
}

/// Whether the file is a zip archive, which PyTorch has written since 1.6, or a bare pickle, which it wrote before.
fn is_pytorch(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(&[0x80, 2])
}

/// Prefix of the network's own tensors among `names`: "" for a bare `state_dict`, such as "model." for one beside others.
fn state_prefix(names: &[&str]) -> String {
    let mut prefix = String::new();
    for _ in 0..MAX_STATE_DEPTH {
        let under = |state: &&&str| {
            let start = format!("{prefix}{state}.");
            names.iter().any(|name| name.starts_with(&start))
        };
        match STATE_KEYS.iter().find(under) {
            Some(state) => prefix = format!("{prefix}{state}."),
            None => break,
        }
    }
    let mut own = names.iter().filter_map(|name| name.strip_prefix(prefix.as_str()));
    if own.all(|name| name.starts_with(PARALLEL_PREFIX)) { prefix + PARALLEL_PREFIX } else { prefix }
}

fn translate(path: &Path) -> Result<Vec<u8>, String> {
    let mut tensors = PytorchReader::new(path).map_err(|e| e.to_string())?.into_tensors();
    if tensors.is_empty() {
        return Err(format!(
            "it holds no tensors; expected a state_dict, by itself or under {}",
            STATE_KEYS.join(", ")
        ));
    }
    let prefix = state_prefix(&tensors.keys().map(String::as_str).collect::<Vec<_>>());
    tensors.retain(|name, _| name.starts_with(&prefix));
    let tensors: BTreeMap<_, _> = tensors.into_iter().collect();
    // Tensors may share a storage, or repeat one value: the file's length is no bound.
    let asked = tensors.values().fold(0u64, |n, t| n.saturating_add(t.byte_len() as u64));
    if asked > MAX_BYTES {
        return Err(format!("its tensors ask for {asked} bytes; at most {MAX_BYTES} are read"));
    }
    let (mut headers, mut data) = (BTreeMap::new(), Vec::new());
    for (name, tensor) in tensors {
        let start = data.len();
        data.extend(tensor.read().map_err(|e| format!("tensor \"{name}\": {e}"))?);
        let (dtype, shape) = (format!("{:?}", tensor.dtype()), tensor.shape().to_vec());
        headers
            .insert(name[prefix.len()..].to_owned(), TensorHeader { dtype, shape, data_offsets: [start, data.len()] });
    }
    weights::write("", &headers, &Provenance::default(), &data).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::weights::WeightFile;
    use std::fs;
    use std::io::{Cursor, Read, Write};
    use zip::write::SimpleFileOptions;
    use zip::{CompressionMethod, ZipArchive, ZipWriter};

    /// The weights of `thesis_reference_weights.safetensors` as `torch.save` writes a `state_dict`.
    const CHECKPOINT: &str = "tests/data/thesis_reference_weights.pt";
    /// `CHECKPOINT` with its state under `keys`, each inside the one before, beside an epoch and an optimizer's copy of one of its tensors.
    fn nested(keys: &[&str]) -> Vec<u8> {
        let mut archive = ZipArchive::new(Cursor::new(fs::read(CHECKPOINT).unwrap())).unwrap();
        let mut out = ZipWriter::new(Cursor::new(Vec::new()));
        for i in 0..archive.len() {
            let mut entry = archive.by_index(i).unwrap();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            if entry.name().ends_with("data.pkl") {
                bytes = nest(&bytes, keys);
            }
            let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
            out.start_file(entry.name(), stored).unwrap();
            out.write_all(&bytes).unwrap();
        }
        out.finish().unwrap().into_inner()
    }

    /// A pickle of `{keys[0]: {keys[1]: ... value of `pickle`}, "epoch": 3, "optimizer": {"state": {0: [the same value]}}}`.
    fn nest(pickle: &[u8], keys: &[&str]) -> Vec<u8> {
        let text = |text: &str| [b"X".as_slice(), &(text.len() as u32).to_le_bytes(), text.as_bytes()].concat();
        let value = pickle.strip_prefix(b"\x80\x02").unwrap().strip_suffix(b".").unwrap();
        let mut out = b"\x80\x02".to_vec();
        for key in keys {
            // An empty dictionary, then a key in it.
            out.extend([b"}".as_slice(), &text(key)].concat());
        }
        // The value is stored under a number that the pickle doesn't use, and put into the dictionaries (SETITEM).
        out.extend([value, b"r\x00\x00\x01\x00".as_slice(), &b"s".repeat(keys.len())].concat());
        out.extend(
            [&text("epoch"), b"K\x03s".as_slice(), &text("optimizer"), b"}", &text("state"), b"}K\x00"].concat(),
        );
        out.extend(b"]j\x00\x00\x01\x00asss.");
        out
    }

    #[test]
    fn a_state_is_found_under_the_usual_keys() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("nested.pt");
        let bare = read_weights(Path::new(CHECKPOINT)).unwrap();
        for keys in
            [["model"].as_slice(), &["state_dict"], &["model_state_dict"], &["model", "state_dict"], &["net", "module"]]
        {
            fs::write(&path, nested(keys)).unwrap();
            assert_eq!(read_weights(&path).unwrap(), bare, "{keys:?}: the same weights, and nothing of the optimizer");
        }
        fs::write(&path, nested(&["epochs"])).unwrap();
        let found = read_weights(&path).unwrap();
        assert!(WeightFile::parse("x", &found).unwrap().shape("epochs.down.layer3x3.0.0.weight").is_some());
    }

    #[test]
    fn a_pytorch_checkpoint_gives_the_averaged_weights() {
        let shipped = include_bytes!("../../assets/weights/thesis-1.safetensors");
        let found = read_weights(Path::new("training/checkpoints/thesis-1.pt")).unwrap();
        let (found, shipped) = (WeightFile::parse("x", &found).unwrap(), WeightFile::parse("y", shipped).unwrap());
        let name = "up.upconv.0.0.weight";
        let shape = shipped.shape(name).unwrap();
        assert_eq!(found.tensor(name, shape).unwrap(), shipped.tensor(name, shape).unwrap());
        assert!(found.shape("model.up.upconv.0.0.weight").is_none(), "the weights that are not averaged are left out");
    }
}
