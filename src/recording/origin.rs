//! The source of a recording that was opened without a text, and other ways to read its bytes.

use std::path::PathBuf;

/// One way to read a file: a layout of a raw capture, or kinds of an array's axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Offer {
    /// The layout in a sentence's words.
    pub described: String,
    /// Natural logarithm of its odds, up to a constant that all offers of a file share.
    pub log_odds: f64,
    /// Mean power of each range bin, in the square of the file's unit.
    pub power: Vec<f64>,
    /// The TOML of the recording that is read so, to stand in the folder of the data.
    pub toml: String,
}

/// The source of a recording whose file can be read in another way, or of which another frame can be taken.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Origin {
    /// The file with the samples, or the TOML that describes them.
    pub data: PathBuf,
    /// The `.cfg` that was read, where there is one.
    pub config: Option<PathBuf>,
    /// Ways to read the file, the most likely first; the TOML alone where there is one.
    pub offers: Vec<Offer>,
    /// Index of the way that was taken, in `offers`.
    pub taken: usize,
    /// The findings on the file, a sentence each.
    pub sentences: Vec<String>,
    /// Doubts that hold for every way to read the file, a sentence each.
    pub doubts: Vec<String>,
    /// The board whose antennas were taken, where one was.
    pub board: Option<&'static str>,
    /// Whole frames of the file.
    pub frames: u64,
    /// Number of the frame that is looked at, from 0.
    pub frame: u64,
}

impl Origin {
    /// The text of the way that was taken.
    pub fn toml(&self) -> &str {
        self.offers.get(self.taken).map_or("", |offer| offer.toml.as_str())
    }
}
