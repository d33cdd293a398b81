//! What a dataset is made of.

use crate::radar::Radar;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the format. Before version 2 a dataset had one target, without a name, and the radar of table 3.1.
pub const VERSION: u32 = 2;

/// Name of the manifest in the dataset's folder.
pub const FILE_NAME: &str = "manifest.json";

/// What a dataset holds and what made it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the format.
    pub apertura_dataset: u32,
    /// Version of the program.
    pub program: String,
    /// Seed of the scenes.
    pub seed: u64,
    /// Kinds of scenes: example `i` of a split is of kind `i % kinds`.
    pub kinds: Vec<String>,
    /// What lies beneath the echoes.
    pub floor: String,
    /// The radar; none where each example has its own.
    pub radar: Option<Radar>,
    /// The elements that are heard in the place of the two ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Vec<usize>>,
    /// The elements that are off: their share of the scenes, and the largest tolerances in decibels, degrees and millimetres. None where all are ideal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<[f64; 4]>,
    /// Type and axes of each array.
    pub arrays: BTreeMap<String, ArrayEntry>,
    /// Shards of each split, in order.
    pub splits: BTreeMap<String, Vec<ShardEntry>>,
}

/// An array of a shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArrayEntry {
    /// NumPy's name of its numbers.
    pub dtype: String,
    /// Names of its axes; the first is the example.
    pub axes: Vec<String>,
    /// Its shape behind the first axis.
    pub shape: Vec<usize>,
}

/// A shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShardEntry {
    /// How many examples it has.
    pub examples: u32,
    /// Kind of each example.
    pub kinds: Vec<String>,
    /// Radar of each example, where each has its own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub radars: Vec<Radar>,
    /// Its files by array.
    pub files: BTreeMap<String, FileEntry>,
}

/// A file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileEntry {
    /// Its name from the dataset's folder on.
    pub name: String,
    /// How long it is.
    pub bytes: u64,
    /// SHA-256 of it.
    pub sha256: String,
}
