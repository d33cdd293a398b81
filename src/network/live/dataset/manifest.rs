//! The manifest of a dataset.

use crate::radar::Radar;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the format. Before version 2 a dataset had one target, without a name, and the radar of table 3.1.
pub const VERSION: u32 = 2;

/// Name of the manifest in the dataset's folder.
pub const FILE_NAME: &str = "manifest.json";

/// Contents and origin of a dataset.
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
    /// Floor of the scenes.
    pub floor: String,
    /// The radar; `None` where each example has another.
    pub radar: Option<Radar>,
    /// Numbers of the elements with samples, in place of the two ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layout: Option<Vec<usize>>,
    /// Errors of elements: the share of scenes with them, and the largest tolerances in decibels, degrees and millimetres. `None` for exact elements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elements: Option<[f64; 4]>,
    /// Type and axes of each array.
    pub arrays: BTreeMap<String, ArrayEntry>,
    /// Shards of each split, in order.
    pub splits: BTreeMap<String, Vec<ShardEntry>>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArrayEntry {
    /// NumPy's name of the array's type.
    pub dtype: String,
    /// Names of the array's axes; the first is the example.
    pub axes: Vec<String>,
    /// The array's shape after the first axis.
    pub shape: Vec<usize>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShardEntry {
    pub examples: u32,
    /// Kind of each example.
    pub kinds: Vec<String>,
    /// Radar of each example, where they differ.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub radars: Vec<Radar>,
    /// The shard's files by array.
    pub files: BTreeMap<String, FileEntry>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileEntry {
    /// The file's path relative to the dataset's folder.
    pub name: String,
    /// Length of the file, bytes.
    pub bytes: u64,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}
