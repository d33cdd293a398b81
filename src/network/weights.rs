//! Weight files: safetensors with a record of the weights' origin.
//!
//! A file is checked against its module (names, shapes, types, length, finite values) before a single weight is loaded, so that a truncated,
//! foreign or wrong-shape file gives an error that names the fault.

use super::domain::Domain;
use crate::files::kind::kind_of;
use crate::files::sha256;
use crate::reconstruct::Weights;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

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
    /// [`WeightsError`] where an entry of the file `name` can't be read.
    pub fn domain(&self, name: &str) -> Result<Domain, WeightsError> {
        let (entry, what, read) = match (self.get(DOMAIN_ENTRY), self.get(RADAR_ENTRY)) {
            ("", "") => return Ok(Domain::Radar(Box::default())),
            ("", text) => (RADAR_ENTRY, "radar", serde_json::from_str(text).map(Domain::Radar)),
            (text, _) => (DOMAIN_ENTRY, "domain of radars", serde_json::from_str(text)),
        };
        read.map_err(|error| WeightsError(format!("{name}: its entry \"{entry}\" is no {what}: {error}")))
    }

    /// The detection threshold chosen on validation scenes, if the file names a valid one.
    pub fn eta(&self) -> Option<f32> {
        self.get("eta").parse().ok().filter(|eta| (0.0..=1.0).contains(eta))
    }
}

/// The reason why a weight file can't be used; the message names the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct WeightsError(pub(super) String);

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct TensorHeader {
    pub dtype: String,
    pub shape: Vec<usize>,
    pub data_offsets: [usize; 2],
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
        let not = |reason: &str| not_safetensors(name, reason);
        let cut = |expected: usize| {
            let found = bytes.len();
            let told = format!("holds {found} bytes; its header promises {expected}; it was truncated or damaged");
            WeightsError(format!("{name} {told}"))
        };
        let (length, rest) = bytes.split_first_chunk::<8>().ok_or_else(|| not("it is shorter than 8 bytes"))?;
        let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        if length > 16 << 20 {
            let told = |kind| format!("it is {kind}; expected weights as safetensors, or PyTorch's .pt");
            return Err(not(&kind_of(bytes).map_or("its first 8 bytes are no header length".to_owned(), told)));
        }
        if length > rest.len() {
            return Err(cut(length + 8));
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
            return Err(cut(end.saturating_add(length + 8)));
        }
        let file = WeightFile { name: name.to_owned(), data, tensors, provenance };
        match file.tensors.iter().find(|(_, t)| !t.is_sound(data.len())) {
            Some((name, _)) => {
                Err(file.bad_tensor(name, "has a place in the file that does not fit its shape and type"))
            }
            None => Ok(file),
        }
    }

    /// The error of a tensor that the network needs and the file lacks, that the network doesn't know, or that it can't use.
    pub(super) fn bad_tensor(&self, tensor: &str, problem: impl fmt::Display) -> WeightsError {
        WeightsError(format!("{}: tensor \"{tensor}\" {problem}", self.name))
    }

    /// Shape of the tensor called `name`, if the file has it.
    pub fn shape(&self, name: &str) -> Option<&[usize]> {
        self.tensors.get(name).map(|tensor| tensor.shape.as_slice())
    }

    /// Checks that `known` accepts every tensor of the file.
    /// # Errors
    /// [`WeightsError`] names the first that it doesn't accept.
    #[cfg(feature = "network")]
    pub(super) fn expect_only(&self, known: impl Fn(&str) -> bool) -> Result<(), WeightsError> {
        let unknown = self.tensors.keys().find(|name| !known(name));
        unknown.map_or(Ok(()), |name| Err(self.bad_tensor(name, "is not part of this network")))
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
    /// [`WeightsError`] if the header can't be written again.
    pub fn renamed(&self, rename: impl Fn(&str) -> String) -> Result<Vec<u8>, WeightsError> {
        let tensors = self.tensors.iter().map(|(name, tensor)| (rename(name), tensor)).collect();
        write(&self.name, &tensors, &self.provenance, self.data)
    }

    /// The fingerprint of the weights, independent of the file's other metadata.
    pub fn weights(&self) -> Weights {
        let sha256 = sha256::of_pieces([self.data]);
        Weights { sha256: sha256::short(&sha256).to_owned(), optimiser: self.provenance.optimiser().to_owned() }
    }

    /// The error of a file that holds other weights than those of `expected`.
    pub fn foreign(&self, expected: &str) -> WeightsError {
        let (file, count) = (&self.name, self.tensors.len());
        if !self.network().is_empty() {
            let found = self.network();
            return WeightsError(format!("{file} holds weights of \"{found}\"; expected \"{expected}\""));
        }
        let more = (count > 3).then_some("...");
        let names: Vec<&str> = self.tensors.keys().map(String::as_str).take(3).chain(more).collect();
        WeightsError(format!(
            "{file} names no network, and none of ours has its tensors ({count} in all): {}; expected weights of {expected}",
            names.join(", ")
        ))
    }
}

fn not_safetensors(file: &str, reason: impl fmt::Display) -> WeightsError {
    WeightsError(format!("{file} is not a safetensors file: {reason}"))
}

/// A safetensors file called `name`, for messages, with the header of `tensors` before their `data`.
pub(super) fn write<T: Serialize>(
    name: &str,
    tensors: &BTreeMap<String, T>,
    record: &Provenance,
    data: &[u8],
) -> Result<Vec<u8>, WeightsError> {
    let not = |e: serde_json::Error| not_safetensors(name, e);
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
    use crate::network::live::engine::LiveEngine;
    use crate::network::live::size::LiveSize;
    use crate::radar::Radar;

    const WEIGHTS: &[u8] = include_bytes!("../../tests/data/live_reference_weights.safetensors");

    fn load(bytes: &[u8], channels: [usize; 4]) -> Result<(), WeightsError> {
        let size = LiveSize { channels, blocks: [1, 1, 1, 1], fine: 4, ..LiveSize::default() };
        let file = WeightFile::parse("test.safetensors", bytes)?;
        LiveEngine::new(&file, &size).map(drop)
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
        let foreign = file.foreign("thesis").to_string();
        assert_eq!(foreign, "test.safetensors holds weights of \"live\"; expected \"thesis\"");
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
