//! PyTorch checkpoints (`.pt`, `.pth`), translated to safetensors so that one reader checks and loads both.

use super::weights::WeightsError;
use crate::files::read_bounded;
use burn::store::pytorch_reader::PytorchReader;
use std::collections::BTreeMap;
use std::path::Path;

/// Most bytes of a weight file, and of all tensors of a checkpoint together: 1 GiB, some 160 times the thesis' network.
const MAX_BYTES: u64 = 1 << 30;

/// The bytes of the weight file at `path` as safetensors: those of a safetensors file as they are; those of a PyTorch checkpoint,
/// which holds a `state_dict` or a whole model, translated. Names, shapes and types stay PyTorch's.
///
/// # Errors
/// [`WeightsError::File`] when it can't be read, [`WeightsError::NotPytorch`] when it is neither.
pub fn read_weights(path: &Path) -> Result<Vec<u8>, WeightsError> {
    let file = path.display().to_string();
    let bytes =
        read_bounded(path, MAX_BYTES).map_err(|e| WeightsError::File { file: file.clone(), reason: e.to_string() })?;
    if is_pytorch(&bytes) { translate(path) } else { Ok(bytes) }
}

/// A zip archive, which PyTorch has written since 1.6, or a bare pickle, which it wrote before.
fn is_pytorch(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(&[0x80, 2])
}

fn translate(path: &Path) -> Result<Vec<u8>, WeightsError> {
    let bad = |reason: String| WeightsError::NotPytorch { file: path.display().to_string(), reason };
    let reader = PytorchReader::new(path).map_err(|e| bad(e.to_string()))?;
    let tensors: BTreeMap<_, _> = reader.into_tensors().into_iter().collect();
    // Tensors may share a storage, or repeat one value: the file's length bounds nothing.
    let asked = tensors.values().fold(0u64, |n, t| n.saturating_add(t.byte_len() as u64));
    if asked > MAX_BYTES {
        return Err(bad(format!("its tensors ask for {asked} bytes; at most {MAX_BYTES} are read")));
    }
    let mut header = serde_json::Map::new();
    let mut data = Vec::new();
    for (name, tensor) in tensors {
        let start = data.len();
        data.extend(tensor.read().map_err(|e| bad(format!("tensor \"{name}\": {e}")))?);
        let entry = serde_json::json!({
            "dtype": format!("{:?}", tensor.dtype()), "shape": tensor.shape(), "data_offsets": [start, data.len()],
        });
        header.insert(name, entry);
    }
    let header = serde_json::Value::Object(header).to_string().into_bytes();
    Ok([&(header.len() as u64).to_le_bytes(), header.as_slice(), data.as_slice()].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::weights::WeightFile;
    use std::fs;

    /// The weights of `thesis_reference_weights.safetensors` as `torch.save` writes a `state_dict`.
    const CHECKPOINT: &str = "tests/data/thesis_reference_weights.pt";
    const WEIGHTS: &[u8] = include_bytes!("../../tests/data/thesis_reference_weights.safetensors");

    #[test]
    fn a_state_dict_holds_the_same_tensors_as_its_safetensors() {
        let translated = read_weights(Path::new(CHECKPOINT)).unwrap();
        let (found, expected) =
            (WeightFile::parse("test.pt", &translated).unwrap(), WeightFile::parse("test", WEIGHTS).unwrap());
        assert_eq!(found.network(), "", "its author recorded nothing");
        for name in ["down.layer3x3.0.0.weight", "down.layer5x5.2.1.running_var", "up.upconv.2.0.weight"] {
            let shape = expected.shape(name).unwrap();
            assert_eq!(found.tensor(name, shape).unwrap(), expected.tensor(name, shape).unwrap(), "{name}");
        }
    }

    #[test]
    fn damage_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cut.pt");
        let whole = fs::read(CHECKPOINT).unwrap();
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let message = read_weights(&path).unwrap_err().to_string();
        assert!(message.contains("cut.pt is not a PyTorch checkpoint"), "{message}");
        fs::write(&path, b"neither one nor the other").unwrap();
        let bytes = read_weights(&path).unwrap();
        assert!(matches!(WeightFile::parse("x", &bytes), Err(WeightsError::NotSafetensors { .. })));
        assert!(matches!(read_weights(&folder.path().join("none.pt")), Err(WeightsError::File { .. })));
    }
}
