//! `apertura dataset`: examples to train on as files.

use super::arguments::{real, seed, whole};
use super::layout_arg::LayoutArg;
use super::radar_arg::RadarArg;
use super::{CommandError, print};
use crate::network::floors::Floors;
use crate::network::live::arrays::Arrays;
use crate::network::live::dataset::{DatasetPrecision, DatasetRequest, ExamplePart, write};
use crate::network::live::radars::Radars;
use crate::radar::{Bytes, Decibels};
use crate::scene::generate::Kind;
use crate::signal::Floor;
use crate::task::Task;
use std::path::PathBuf;
use std::time::Duration;

/// Write examples for training as files: samples of both ends, the live network's input, and maps of the whole array
///
/// DIR gets train, validation and test with shards of NumPy arrays, and manifest.json with the SHA-256 of each file. The scenes of the three
/// never meet. The same arguments write the same files. With --layout the samples of its elements stand in place of those of the ends, as the array
/// heard, and manifest.json has the numbers of the elements. docs/data.md leads from here to a training loop.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(long, value_name = "1,2,3,KIND,..", value_delimiter = ',', required = true, value_parser = Kind::for_training,
          help = format!("Kinds of scenes, separated by commas: {}; or world, for training and validation", Kind::names()))]
    set: Vec<Kind>,

    /// Scenes of each kind for training
    #[arg(long, value_name = "N", value_parser = whole(1..=10_000_000u32))]
    count: u32,

    /// Scenes of each kind for validation [default: a tenth of --count]
    #[arg(long, value_name = "N", value_parser = whole(0..=10_000_000u32))]
    validation: Option<u32>,

    /// Scenes of each kind for the test [default: a tenth of --count, 0 for world]
    #[arg(long, value_name = "N", value_parser = whole(0..=10_000_000u32))]
    test: Option<u32>,

    /// Seed of the scenes
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed)]
    seed: u64,

    /// Noise beneath all scenes: thesis, exact, snr=DB or dbm=LEVEL (LEVEL counts the squared magnitude of a sample as watts; it is no power in
    /// a receiver)
    #[arg(long, value_name = "FLOOR", default_value_t = Floor::Thesis)]
    floor: Floor,

    /// Fraction of the scenes over thermal noise of 10 to 60 dB; the others lie over the thesis' floor
    #[arg(long, value_name = "PART", conflicts_with = "floor", value_parser = real(0.0..=1.0))]
    thermal: Option<f64>,

    /// Precision of features and target: f16 or f32. Ends are always complex128
    #[arg(long, value_name = "f16|f32", default_value = "f16")]
    dtype: DatasetPrecision,

    /// What to write: ends, features (the live network's input), target_ideal (the map of the array as it should be, without noise), target_measured
    /// (what the whole array heard), target_calibrated (what it would have heard without errors of its elements) [default: ends, features where the
    /// radar has the live network's shape, target_ideal, target_measured]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    arrays: Vec<ExamplePart>,

    #[command(flatten)]
    radar: RadarArg,

    #[command(flatten)]
    layout: LayoutArg,

    /// Examples of a shard; as many are in memory at once
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = whole(1..=4096u32))]
    shard: u32,

    /// Folder to write into: a new one, or an empty one
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Ratios of --thermal, those that the live network was trained at.
const THERMAL_SNR: [Decibels; 2] = [Decibels(10.0), Decibels(60.0)];

const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let [from, to] = THERMAL_SNR;
        let radar = self.radar.load()?.0;
        let layout = self.layout.numbers(&radar)?;
        let radars = Radars::Fixed(Box::new(radar));
        let request = DatasetRequest {
            counts: DatasetRequest::counts(&self.set, self.count, self.validation, self.test),
            kinds: self.set,
            seed: self.seed,
            floors: self.thermal.map_or(Floors::Fixed(self.floor), |share| Floors::Thermal { share, from, to }),
            precision: self.dtype,
            parts: if self.arrays.is_empty() { ExamplePart::usual(&radars, layout.as_deref()) } else { self.arrays },
            arrays: Arrays::IDEAL,
            radars,
            layout,
            shard: self.shard,
        };
        let task = Task::default();
        let bar = indicatif::ProgressBar::new(1000);
        let written = std::thread::scope(|scope| {
            let writing = scope.spawn(|| write(&self.output, &request, &task));
            while !writing.is_finished() {
                bar.set_position((1000.0 * task.progress()) as u64);
                std::thread::sleep(PROGRESS_INTERVAL);
            }
            writing.join()
        });
        bar.finish_and_clear();
        let manifest = written.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
        let files = || manifest.splits.values().flatten().flat_map(|shard| shard.files.values());
        let bytes: u64 = files().map(|file| file.bytes).sum();
        let examples: u32 = manifest.splits.values().flatten().map(|shard| shard.examples).sum();
        let (count, bytes) = (files().count(), Bytes(bytes));
        print(&format!("wrote {}: {examples} examples in {count} files, {bytes}", self.output.display()))
    }
}
