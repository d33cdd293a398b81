//! Weight files: safetensors with a record of the weights' origin.
//!
//! A file is checked against its module (names, shapes, types, length, finite values) before a single weight is loaded, so that a truncated,
//! foreign or wrong-shape file gives an error that names the fault.

use super::domain::Domain;
use crate::files::kind::kind_of;
use crate::files::sha256;
use crate::radar::Radar;
use crate::reconstruct::Weights;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

#[cfg(feature = "network")]
mod load;
mod values;

/// Entry of a weight file with the radar of its training scenes, as JSON.
pub const RADAR_ENTRY: &str = "radar";
/// Entry with the [`Domain`] of training scenes that several radars saw, as JSON.
pub const DOMAIN_ENTRY: &str = "domain";

/// Most tensors of a weight file; the thesis' network has some 70.
const MAX_TENSORS: usize = 10_000;

/// A weight file's record of its origin, from its safetensors header.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Provenance {
    /// All entries, by name: `network`, `recipe`, `trainer`, `optimiser`, `seed`, `maps_seen`, `validation`, `eta`, ... For a run in
    /// several parts `parts` has each one's record (JSON), in which a missing record says "not recorded".
    pub entries: BTreeMap<String, String>,
}

impl Provenance {
    /// An entry, or "" where the file lacks it.
    pub fn get(&self, name: &str) -> &str {
        self.entries.get(name).map_or("", String::as_str)
    }

    /// The optimiser that trained the weights, such as "AdamW" or "SGD, then Muon"; "not recorded" where the file doesn't name it.
    pub fn optimiser(&self) -> &str {
        match self.get("optimiser") {
            "" => "not recorded",
            named => named,
        }
    }

    /// The radars of the training scenes: those of the entry [`DOMAIN_ENTRY`], else that of [`RADAR_ENTRY`], else table 3.1's.
    /// # Errors
    /// [`WeightsError::Store`] where an entry of the file `name` can't be read.
    pub fn domain(&self, name: &str) -> Result<Domain, WeightsError> {
        let wrong = |entry: &str, what: &str, error: serde_json::Error| WeightsError::Store {
            file: name.to_owned(),
            reason: format!("its entry \"{entry}\" is no {what}: {error}"),
        };
        match (self.get(DOMAIN_ENTRY), self.get(RADAR_ENTRY)) {
            ("", "") => Ok(Domain::Radar(Box::default())),
            ("", text) => {
                let radar: Radar = serde_json::from_str(text).map_err(|error| wrong(RADAR_ENTRY, "radar", error))?;
                Ok(Domain::Radar(Box::new(radar)))
            }
            (text, _) => serde_json::from_str(text).map_err(|error| wrong(DOMAIN_ENTRY, "domain of radars", error)),
        }
    }

    /// The detection threshold chosen on validation scenes, if the file names a valid one.
    pub fn eta(&self) -> Option<f32> {
        self.get("eta").parse().ok().filter(|eta| (0.0..=1.0).contains(eta))
    }
}

/// The reason why a weight file can't be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The messages name every field.
pub enum WeightsError {
    /// The file could not be read.
    #[error("{file}: {reason}")]
    File { file: String, reason: String },
    #[error("{file} is not a safetensors file: {reason}")]
    NotSafetensors { file: String, reason: String },
    #[error("{file} is not a PyTorch checkpoint that can be read: {reason}")]
    NotPytorch { file: String, reason: String },
    #[error("{file} holds {found} bytes; its header promises {expected}; it was truncated or damaged")]
    Length { file: String, found: usize, expected: usize },
    #[error("{file} holds weights of \"{found}\"; expected \"{expected}\"")]
    Foreign { file: String, found: String, expected: String },
    #[error(
        "{file} names no network, and none of ours has its tensors ({count} in all): {names}; expected weights of {expected}"
    )]
    Unknown { file: String, count: usize, names: String, expected: String },
    /// A tensor that the network needs is missing, or one it doesn't know is there.
    #[error("{file}: tensor \"{tensor}\" {problem}")]
    Tensor { file: String, tensor: String, problem: String },
    /// The store refused the file.
    #[error("{file}: {reason}")]
    Store { file: String, reason: String },
}

#[derive(Debug, Serialize, Deserialize)]
struct TensorHeader {
    dtype: String,
    shape: Vec<usize>,
    data_offsets: [usize; 2],
}

impl TensorHeader {
    /// Bytes of a tensor of this shape and type; `None` where they overflow, or the type is not one of safetensors'.
    fn bytes(&self) -> Option<usize> {
        let bits: usize =
            self.dtype.trim_start_matches(|c: char| !c.is_ascii_digit()).split('_').next()?.parse().ok()?;
        let size = if self.dtype == "BOOL" { 1 } else { bits / 8 };
        self.shape.iter().try_fold(size, |product, n| product.checked_mul(*n))
    }

    /// Whether the offsets lie within a file's `length` and enclose as many bytes as shape and type need.
    fn is_sound(&self, length: usize) -> bool {
        let [start, end] = self.data_offsets;
        start <= end && end <= length && self.bytes().is_none_or(|bytes| bytes == end - start)
    }
}

/// A weight file whose header and length are valid.
#[derive(Debug)]
pub struct WeightFile<'a> {
    name: String,
    #[cfg(feature = "network")]
    bytes: &'a [u8],
    data: &'a [u8],
    tensors: BTreeMap<String, TensorHeader>,
    /// The origin of the weights.
    pub provenance: Provenance,
}

impl<'a> WeightFile<'a> {
    /// Reads the header of the file called `name` and checks its length.
    /// # Errors
    /// [`WeightsError`] when it isn't safetensors or is cut short.
    pub fn parse(name: &str, bytes: &'a [u8]) -> Result<Self, WeightsError> {
        let not = |reason: &str| WeightsError::NotSafetensors { file: name.to_owned(), reason: reason.to_owned() };
        let (length, rest) = bytes.split_first_chunk::<8>().ok_or_else(|| not("it is shorter than 8 bytes"))?;
        let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        if length > 16 << 20 {
            let told = |kind| format!("it is {kind}; expected weights as safetensors, or PyTorch's .pt");
            return Err(not(&kind_of(bytes).map_or("its first 8 bytes are no header length".to_owned(), told)));
        }
        if length > rest.len() {
            return Err(WeightsError::Length { file: name.to_owned(), found: bytes.len(), expected: length + 8 });
        }
        let (header, data) = rest.split_at(length);
        let header: BTreeMap<String, serde_json::Value> =
            serde_json::from_slice(header).map_err(|e| not(&format!("its header is no JSON: {e}")))?;
        let mut provenance = Provenance::default();
        let mut tensors = BTreeMap::new();
        for (key, value) in header {
            if tensors.len() == MAX_TENSORS {
                return Err(not(&format!("it has more than {MAX_TENSORS} tensors")));
            }
            if key == "__metadata__" {
                provenance.entries =
                    serde_json::from_value(value).map_err(|e| not(&format!("its metadata is odd: {e}")))?;
            } else {
                let tensor: TensorHeader =
                    serde_json::from_value(value).map_err(|e| not(&format!("tensor \"{key}\": {e}")))?;
                tensors.insert(key, tensor);
            }
        }
        let end = tensors.values().map(|t| t.data_offsets[1]).max().unwrap_or(0);
        if end != data.len() {
            let expected = end.saturating_add(length + 8);
            return Err(WeightsError::Length { file: name.to_owned(), found: bytes.len(), expected });
        }
        if let Some((tensor, _)) = tensors.iter().find(|(_, t)| !t.is_sound(data.len())) {
            let problem = "has a place in the file that does not fit its shape and type".to_owned();
            return Err(WeightsError::Tensor { file: name.to_owned(), tensor: tensor.clone(), problem });
        }
        Ok(WeightFile {
            name: name.to_owned(),
            #[cfg(feature = "network")]
            bytes,
            data,
            tensors,
            provenance,
        })
    }

    /// Shape of the tensor called `name`, if the file has it.
    pub fn shape(&self, name: &str) -> Option<&[usize]> {
        self.tensors.get(name).map(|tensor| tensor.shape.as_slice())
    }

    /// Checks that `known` accepts every tensor of the file.
    /// # Errors
    /// [`WeightsError::Tensor`] names the first that it doesn't accept.
    #[cfg(feature = "network")]
    pub(super) fn expect_only(&self, known: impl Fn(&str) -> bool) -> Result<(), WeightsError> {
        let Some(tensor) = self.tensors.keys().find(|name| !known(name)) else { return Ok(()) };
        let (file, problem) = (self.name.clone(), "is not part of this network".to_owned());
        Err(WeightsError::Tensor { file, tensor: tensor.clone(), problem })
    }

    /// Name of the network that the weights belong to, as recorded in the file; "" without a record.
    pub fn network(&self) -> &str {
        self.provenance.get("network")
    }

    /// Name of the file, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file with other tensor names.
    /// # Errors
    /// [`WeightsError::NotSafetensors`] if the header can't be written again.
    pub fn renamed(&self, rename: impl Fn(&str) -> String) -> Result<Vec<u8>, WeightsError> {
        let tensors = self.tensors.iter().map(|(name, tensor)| (rename(name), tensor)).collect();
        write(&self.name, &tensors, &self.provenance, self.data)
    }

    /// The fingerprint of the weights, independent of the file's other metadata.
    pub fn weights(&self) -> Weights {
        let sha256 = sha256::of_pieces([self.data]);
        Weights { sha256: sha256::short(&sha256).to_owned(), optimiser: self.provenance.optimiser().to_owned() }
    }

    /// Checks that the file holds weights of `network`.
    /// # Errors
    /// [`WeightsError::Foreign`] otherwise.
    pub fn expect_network(&self, network: &str) -> Result<(), WeightsError> {
        match self.network() {
            found if found == network => Ok(()),
            _ => Err(self.foreign(network)),
        }
    }

    /// The error of a file that holds other weights than those of `expected`.
    pub fn foreign(&self, expected: &str) -> WeightsError {
        let (file, expected) = (self.name.clone(), expected.to_owned());
        match self.network() {
            "" => {
                let mut names: Vec<&str> = self.tensors.keys().map(String::as_str).take(3).collect();
                if self.tensors.len() > names.len() {
                    names.push("...");
                }
                WeightsError::Unknown { file, count: self.tensors.len(), names: names.join(", "), expected }
            }
            found => WeightsError::Foreign { file, found: found.to_owned(), expected },
        }
    }
}

/// A safetensors file called `name`, for messages, with the header of `tensors` before their `data`.
fn write<T: Serialize>(
    name: &str,
    tensors: &BTreeMap<String, T>,
    record: &Provenance,
    data: &[u8],
) -> Result<Vec<u8>, WeightsError> {
    let not = |e: serde_json::Error| WeightsError::NotSafetensors { file: name.to_owned(), reason: e.to_string() };
    let mut header = serde_json::Map::new();
    for (name, tensor) in tensors {
        header.insert(name.clone(), serde_json::to_value(tensor).map_err(not)?);
    }
    header.insert("__metadata__".into(), serde_json::to_value(&record.entries).map_err(not)?);
    let mut header = serde_json::to_vec(&header).map_err(not)?;
    header.resize(header.len().next_multiple_of(8), b' ');
    Ok([&(header.len() as u64).to_le_bytes(), header.as_slice(), data].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::LiveConfig;
    use crate::network::live::engine::LiveEngine;

    const WEIGHTS: &[u8] = include_bytes!("../../tests/data/live_reference_weights.safetensors");

    fn load(bytes: &[u8], channels: [usize; 4]) -> Result<(), WeightsError> {
        let config = LiveConfig { channels, blocks: [1, 1, 1, 1], fine: 4 };
        let file = WeightFile::parse("test.safetensors", bytes)?;
        LiveEngine::new(&file, &config.into()).map(drop)
    }

    #[test]
    fn every_kind_of_damage_is_told_apart() {
        let good = [4, 6, 8, 10];
        load(WEIGHTS, good).unwrap();
        let says = |bytes: &[u8], channels, expected: &str| {
            let message = load(bytes, channels).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        };
        says(&[], good, "shorter than 8 bytes");
        says(b"PK\x03\x04 this is a zip file", good, "not a safetensors file");
        says(&WEIGHTS[..WEIGHTS.len() - 4], good, "truncated");
        says(&WEIGHTS[..100], good, "truncated");
        says(&[WEIGHTS, &[0; 4]].concat(), good, "truncated or damaged");
        says(WEIGHTS, [4, 6, 8, 12], "expected [");
        let file = WeightFile::parse("test.safetensors", WEIGHTS).unwrap();
        let renamed = file.renamed(|n| if n == "up0.bias" { "up9.bias".into() } else { n.into() }).unwrap();
        says(&renamed, good, "tensor \"up0.bias\" is missing");
        let mut bad = WEIGHTS.to_vec();
        let end = bad.len();
        bad[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
        says(&bad, good, "is not finite");
        assert!(matches!(file.expect_network("thesis"), Err(WeightsError::Foreign { .. })));
        let stranger = include_bytes!("../../tests/data/thesis_reference.safetensors");
        says(stranger, good, "is missing");
    }

    #[test]
    fn shipped_weights_record_their_training() {
        for (bytes, optimiser, maps) in [
            (include_bytes!("../../assets/weights/live.safetensors").as_slice(), "AdamW", 11_172 + 55_124 + 864_436),
            (include_bytes!("../../assets/weights/thesis-1.safetensors"), "SGD, then Muon", 3872 + 14_966),
            (include_bytes!("../../assets/weights/thesis.safetensors"), "AdamW, then Muon", 20_986),
        ] {
            let record = WeightFile::parse("shipped", bytes).unwrap().provenance;
            assert_eq!((record.optimiser(), record.get("maps_seen")), (optimiser, maps.to_string().as_str()));
            let parts: Vec<serde_json::Value> = serde_json::from_str(record.get("parts")).unwrap();
            let mut seen = 0;
            for part in &parts {
                assert_eq!(part["maps_before"].as_u64(), Some(seen), "no part is left out: {part}");
                seen += part["maps_seen"].as_u64().unwrap();
                assert!(part["optimiser"].is_string() && part["started"].is_string(), "{part}");
            }
            assert_eq!(seen, maps);
        }
        let unet = include_bytes!("../../assets/weights/unet.safetensors");
        assert_eq!(WeightFile::parse("shipped", unet).unwrap().provenance.optimiser(), "SGD");
        assert_eq!(Provenance::default().optimiser(), "not recorded");
    }

    #[test]
    fn weights_without_a_radar_were_trained_for_table_3_1() {
        assert_eq!(Provenance::default().domain("w").unwrap(), Domain::Radar(Box::default()));
    }

    #[test]
    fn weights_carry_their_radars() {
        let of = |entry: &str, text: String| {
            let entries = [(entry.to_owned(), text)].into_iter().collect();
            Provenance { entries }.domain("w.safetensors")
        };
        let radar = Radar { bandwidth_hz: 1e9, ..Radar::default() };
        let read = of(RADAR_ENTRY, serde_json::to_string(&radar).unwrap()).unwrap();
        // JSON may round the last bit of a number.
        assert!(read.holds(&radar) && !read.holds(&Radar::default()), "{read:?}");
        let limits = Domain::Limits(crate::network::live::radars::DRAWN_LIMITS);
        assert_eq!(of(DOMAIN_ENTRY, serde_json::to_string(&limits).unwrap()).unwrap(), limits);
        for (entry, what) in [(RADAR_ENTRY, "no radar"), (DOMAIN_ENTRY, "no domain of radars")] {
            let told = of(entry, "{\"elements\": \"many\"}".into()).unwrap_err().to_string();
            assert!(told.contains("w.safetensors") && told.contains(what), "{told}");
        }
    }
}
