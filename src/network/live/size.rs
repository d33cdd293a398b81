//! The size of a live network: its numbers of channels and blocks, and the shape of its radar's maps.

use super::config::{DECODER_CHANNELS, INPUT_CHANNELS, WIDE_COLUMNS};
use super::constants::WINDOW_COUNT;
use super::grid::{COARSE_COLUMNS, COLUMNS, FINE_COLUMNS, ROWS};
use crate::network::domain::Domain;
use crate::network::kernels::convolution::padded;
use crate::network::weights::{WeightFile, WeightsError};
use crate::radar::{Bytes, Radar};
use serde::Deserialize;
use std::ops::RangeInclusive;

/// Entry of a weight file with the size of its network, as JSON. Without the entry it is that of the shipped network.
pub const SIZE_ENTRY: &str = "size";

/// Most samples of a network's radar.
pub const MAX_ROWS: usize = 4096;
/// Divisor of the number of samples: the network halves it three times.
pub const ROWS_STEP: usize = 8;

/// Most memory of a network for its weights and one pass, bytes.
const MAX_BYTES: u64 = 1 << 30;
/// Channels of networks for radars of at most half as many cells as table 3.1's.
const SMALL_CHANNELS: [usize; 4] = [12, 24, 44, 60];
/// Processor seconds of training for a map of 512 samples, with the shipped numbers of channels and with the small ones (training/README.md).
const MAP_SECONDS: f64 = 0.52;
const SMALL_MAP_SECONDS: f64 = 0.33;
const CHANNEL_RANGE: RangeInclusive<usize> = 1..=512;
const BLOCK_RANGE: RangeInclusive<usize> = 1..=16;
const ELEMENT_RANGE: RangeInclusive<usize> = 2..=65_536;

/// The size of a network. `training/train_live.py` writes the same names into [`SIZE_ENTRY`].
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LiveSize {
    /// Channels of the four levels, finest first.
    #[serde(rename = "c")]
    pub channels: [usize; 4],
    /// Residual blocks of the four levels; the encoder has half as many (rounded up) at the middle two.
    pub blocks: [usize; 4],
    /// Channels of the fine convolution.
    pub fine: usize,
    /// Samples of the radar: range rows of every tensor.
    pub rows: usize,
    /// Elements of the radar's whole array: columns of the map. The network's inner pictures have 64, 256 and 1024 for any radar.
    pub columns: usize,
}

impl Default for LiveSize {
    fn default() -> Self {
        LiveSize { channels: [16, 32, 64, 96], blocks: [1, 2, 2, 3], fine: 16, rows: ROWS, columns: COLUMNS }
    }
}

impl LiveSize {
    /// The size of the network of `file`.
    /// # Errors
    /// [`WeightsError`] names the entry where it can't be read, and the number that is out of bounds.
    pub fn of(file: &WeightFile) -> Result<Self, WeightsError> {
        let wrong = |told: String| WeightsError(format!("{}: its entry \"{SIZE_ENTRY}\" {told}", file.name()));
        let size: LiveSize = match file.provenance.get(SIZE_ENTRY) {
            "" => LiveSize::default(),
            text => serde_json::from_str(text).map_err(|e| wrong(format!("is no size of a network: {e}")))?,
        };
        size.check().map_err(wrong)?;
        Ok(size)
    }

    /// The size of the network that `training/train_live.py` trains for `radar`.
    /// # Errors
    /// A sentence without its full stop, where the radar is too small or too large.
    pub fn for_radar(radar: &Radar) -> Result<Self, String> {
        if radar.end_elements < 2 {
            return Err("an end of one element sees no direction".to_owned());
        }
        let mut size = LiveSize { rows: radar.samples, columns: radar.elements, ..LiveSize::default() };
        if 2 * size.rows * size.columns <= ROWS * COLUMNS {
            size.channels = SMALL_CHANNELS;
        }
        size.check().map(|()| size).map_err(|why| format!("its network {why}"))
    }

    /// Checks that the radars of the weight file called `name` have this shape.
    /// # Errors
    /// [`WeightsError`] with both shapes.
    pub(super) fn check_domain(&self, name: &str, domain: &Domain) -> Result<(), WeightsError> {
        let ([samples, elements], LiveSize { rows, columns, .. }) = (domain.shape(), self);
        if [samples, elements] == [*rows, *columns] {
            return Ok(());
        }
        Err(WeightsError(format!(
            "{name}: its entry \"{SIZE_ENTRY}\" says {rows} samples and {columns} elements; its radars have {samples} and {elements}"
        )))
    }

    fn check(&self) -> Result<(), String> {
        let LiveSize { channels, blocks, fine, rows, columns } = self;
        let within = |name: &str, number: usize, range: &RangeInclusive<usize>| match range.contains(&number) {
            true => Ok(()),
            false => Err(format!("has {name} of {number}; expected {} to {}", range.start(), range.end())),
        };
        if *rows == 0 || *rows > MAX_ROWS || !rows.is_multiple_of(ROWS_STEP) {
            return Err(format!("has rows of {rows}; expected a multiple of {ROWS_STEP} up to {MAX_ROWS}"));
        }
        within("columns", *columns, &ELEMENT_RANGE)?;
        within("fine", *fine, &CHANNEL_RANGE)?;
        channels.iter().try_for_each(|c| within("c", *c, &CHANNEL_RANGE))?;
        blocks.iter().try_for_each(|b| within("blocks", *b, &BLOCK_RANGE))?;
        let bytes = self.memory_bytes();
        if bytes > MAX_BYTES {
            let (bytes, most) = (Bytes(bytes), Bytes(MAX_BYTES));
            return Err(format!("asks for {bytes} of memory; expected at most {most}"));
        }
        Ok(())
    }

    /// Processor seconds of training for a map in `training/train_live.py`, proportional to the radar's number of samples.
    pub fn training_seconds_a_map(&self) -> f64 {
        let seconds = if self.channels == SMALL_CHANNELS { SMALL_MAP_SECONDS } else { MAP_SECONDS };
        seconds * self.rows as f64 / ROWS as f64
    }

    /// Upper bound of the bytes of the packed weights, and of the tables, tensors and maps of one pass.
    pub fn memory_bytes(&self) -> u64 {
        let LiveSize { channels, blocks, fine, .. } = self;
        let padded_channels = |count: usize| padded(count) as u64;
        // A 3x3 convolution is packed as 36 products.
        let conv = |input: usize, output: usize| 36 * padded_channels(input) * padded_channels(output);
        let levels: u64 = channels
            .iter()
            .zip(blocks)
            .map(|(c, blocks)| 2 * *blocks as u64 * (2 * conv(*c, *c) + 4 * padded_channels(*c) * padded_channels(*c)))
            .sum();
        let steps: u64 = channels.windows(2).map(|pair| 8 * padded_channels(pair[0]) * padded_channels(pair[1])).sum();
        let heads = conv(INPUT_CHANNELS, channels[0]) + conv(channels[0], 4 * DECODER_CHANNELS) + conv(12, *fine);
        let [rows, columns] = [self.rows, self.columns].map(|n| n as u64);
        let kernels = WINDOW_COUNT as u64 * (rows * rows + (WIDE_COLUMNS * WIDE_COLUMNS) as u64);
        // Values in a row: of a level, the input of its convolution and the result of the coarser level; of heads and features; of maps.
        let level_values: u64 =
            channels.iter().enumerate().map(|(level, c)| 3 * (padded_channels(*c) >> (2 * level))).sum();
        let pictures =
            COARSE_COLUMNS as u64 * (level_values + 64) + FINE_COLUMNS as u64 * 32 + 2 * COLUMNS as u64 + 3 * columns;
        4 * (levels + steps + heads + kernels + rows * pictures)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::live::LiveMethod;
    use crate::network::live::engine::LiveScratch;
    use crate::network::live::twin_tests::heard;
    use crate::radar::Convention;
    use crate::reconstruct::{Reconstructor, Request};

    fn of(entry: &str) -> Result<LiveSize, String> {
        let header = serde_json::json!({ "__metadata__": { SIZE_ENTRY: entry } }).to_string();
        let bytes = [&(header.len() as u64).to_le_bytes(), header.as_bytes()].concat();
        LiveSize::of(&WeightFile::parse("own.safetensors", &bytes).unwrap()).map_err(|e| e.to_string())
    }

    #[test]
    fn a_size_has_the_shipped_values_where_it_says_none() {
        assert_eq!(of(""), Ok(LiveSize::default()));
        assert_eq!(of("{}"), Ok(LiveSize::default()));
        let small = of(r#"{"c": [12, 24, 44, 60], "rows": 128, "columns": 192}"#).unwrap();
        assert_eq!((small.rows, small.columns, small.channels), (128, 192, [12, 24, 44, 60]));
        assert_eq!(of(r#"{"rows": 4096}"#).unwrap().rows, MAX_ROWS);
        assert_eq!(small.blocks, LiveSize::default().blocks);
    }

    #[test]
    fn a_size_out_of_bounds_is_named_with_file_and_entry() {
        for (entry, told) in [
            ("7", "is no size of a network"),
            (r#"{"depth": 3}"#, "unknown field `depth`"),
            (r#"{"rows": 100}"#, "rows of 100; expected a multiple of 8 up to 4096"),
            (r#"{"rows": 4104}"#, "rows of 4104; expected a multiple of 8 up to 4096"),
            (r#"{"columns": 1}"#, "columns of 1; expected 2 to 65536"),
            (r#"{"c": [16, 32, 64, 4096]}"#, "c of 4096; expected 1 to 512"),
            (r#"{"blocks": [1, 2, 2, 0]}"#, "blocks of 0; expected 1 to 16"),
            (r#"{"rows": 4096, "columns": 65536}"#, "of memory; expected at most 1.0 GiB"),
            (r#"{"c": [512, 512, 512, 512], "blocks": [16, 16, 16, 16]}"#, "of memory; expected at most 1.0 GiB"),
        ] {
            let error = of(entry).unwrap_err();
            assert!(error.starts_with("own.safetensors: its entry \"size\" ") && error.contains(told), "{error}");
        }
    }

    // `training/reference.py` writes these files.
    /// Weights of a tiny network for a radar of another shape, in whose maps cos(theta) falls with the column.
    const WEIGHTS: &[u8] = include_bytes!("../../../tests/data/shape_reference_weights.safetensors");
    /// Three reflectors before this radar, and every third row of PyTorch's results.
    const REFERENCE: &[u8] = include_bytes!("../../../tests/data/shape_reference.safetensors");

    /// Largest distance of every third row of a map from the tensor `name` of the reference.
    fn gap(found: &[f32], reference: &WeightFile, name: &str) -> f32 {
        let expected = reference.tensor(name, &[24, 86]).unwrap();
        assert_eq!(found.len(), 72 * 86);
        let picked = found.chunks(86).step_by(3).flatten();
        picked.zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn a_network_of_another_shape_agrees_with_its_twin() {
        let reference = WeightFile::parse("reference", REFERENCE).unwrap();
        let method = LiveMethod::new(WeightFile::parse("weights", WEIGHTS).unwrap()).unwrap();
        let shape = Radar { elements: 86, end_elements: 8, samples: 72, ..Radar::default() };
        let radar = shape.in_convention(Convention::Physical);
        let (ends, input) = heard(&radar, &reference);
        let mut scratch = LiveScratch::default();
        let found = method.engine().forward(&input, &mut scratch);
        let of_decades = gap(&found.map, &reference, "log");
        assert!(of_decades < 1e-2, "decades: {of_decades}");
        let minimum = reference.tensor("minimum", &[1]).unwrap()[0];
        assert!((found.minimum - minimum).abs() < 1e-3, "{} for {minimum}", found.minimum);
        let doubt = method.engine().doubt(&scratch).unwrap().lambda;
        let of_doubt = gap(doubt.as_slice().unwrap(), &reference, "doubt");
        assert!(of_doubt < 1e-4, "doubt: {of_doubt}");
        let lambda = method.estimate(&radar, &ends, &Request::default()).unwrap().lambda.lambda;
        let of_lambda = gap(lambda.as_slice().unwrap(), &reference, "lambda");
        assert!(of_lambda < 2e-3, "Lambda: {of_lambda}");
    }

    #[test]
    fn weights_that_do_not_fit_their_size_are_named() {
        let says = br#"\"rows\": 72"#;
        let at = WEIGHTS.windows(says.len()).position(|part| part == says).unwrap();
        let mut bytes = WEIGHTS.to_vec();
        bytes[at..at + says.len()].copy_from_slice(br#"\"rows\": 80"#);
        let told = LiveMethod::new(WeightFile::parse("own", &bytes).unwrap()).unwrap_err().to_string();
        assert!(told.contains("says 80 samples and 86 elements; its radars have 72 and 86"), "{told}");
    }
}
