//! `apertura evaluate`: tables 4.1 to 4.3 for any method, beside the printed values; row by row, in parts, and on scenes of one's own.

mod report;

use super::arguments::{self, FloorArgs};
use super::network_args::NetworkArgs;
use super::{CommandError, print};
use crate::evaluate::campaign::{Campaign, Shard};
use crate::evaluate::rows::{Row, merge, read_rows, write_rows};
use crate::evaluate::sets::{Folder, SceneSet};
use crate::files::write_atomically;
use crate::radar::{Carrier, Radar};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::{Kind, Reading};
use crate::task::Task;
use indicatif::{ProgressBar, ProgressStyle};
use report::{Conventions, Report};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// Fill tables 4.1 to 4.3: squared error, detection and false-alarm rates of reconstruction methods on random test scenes
///
/// P_D and P_FA are at the threshold that each method ships with, chosen on validation scenes: what a user gets. Beside them stands
/// P_D where every scene has a threshold of its own that holds its P_FA to the printed one. An object is missed when less than half of where
/// the whole array sees it is above the threshold; a ghost is a blob where the whole array sees nothing. "Near best" is the part of the
/// scenes on which the squared error is at most 1.2 times the least of the other methods'.
///
/// With --json one object is printed: count, seed, floor, carrier (floor and carrier null with --merge, as rows don't say), and sets,
/// each with its name (set: a number for the thesis' sets), what the thesis prints there (printed: baseline, experiment_1, experiment_2; null
/// for other scenes), false_alarm (the printed rate, experiment 2's; 1 % for other scenes) and methods, each with name, eta, scenes,
/// squared_error, detection, false_alarm, missed and ghosts (mean and standard_error), detection_at_printed_false_alarm (false_alarm,
/// detection, standard_error), median_milliseconds and near_best (null with one method). Rates are fractions, not percent.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Methods, separated by commas
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_value = "baseline")]
    method: Vec<String>,

    /// Test sets 1 to 3 or other kinds of scenes (clusters, walls, spacings, corner, crowd, dynamic, near, noise), separated by commas
    #[arg(long, value_name = "1,2,3,KIND,..", value_delimiter = ',', default_value = "1,2,3")]
    set: Vec<Kind>,

    /// Scenes of each set
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    count: u32,

    /// Seed of the scenes
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,

    /// The scene files of this folder in place of random scenes
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["set", "count", "seed", "carrier", "thesis_text"])]
    scenes: Option<PathBuf>,

    /// Write one row a scene and method to this CSV file; the figures printed are means of these rows
    #[arg(long, value_name = "FILE.csv")]
    rows: Option<PathBuf>,

    /// Try every N-th scene only, from scene I on
    #[arg(long, value_name = "I/N", default_value_t)]
    shard: Shard,

    /// Print the tables of rows that were written before, all together
    #[arg(long, value_name = "FILE.csv", num_args = 1..,
          conflicts_with_all = ["method", "set", "count", "seed", "scenes", "shard", "floor", "carrier", "thesis_text"])]
    merge: Vec<PathBuf>,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,

    /// How the carrier's phase is read
    #[arg(long, value_parser = arguments::carrier(), value_name = "one-way|two-way", default_value = "one-way")]
    carrier: Carrier,

    /// Make scenes as the thesis' text describes them, not as its author's program does
    #[arg(long)]
    thesis_text: bool,

    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

impl Args {
    /// Runs every method over every set, or reads what was found before, and prints the tables.
    pub fn run(self) -> Result<(), CommandError> {
        let (rows, conventions) = if self.merge.is_empty() { self.measure()? } else { (self.merged()?, None) };
        if let Some(path) = &self.rows {
            write_atomically(path, |out| write_rows(out, &rows)).map_err(on_file(path))?;
        }
        let report = Report::of(&rows, conventions);
        if self.json {
            print(&serde_json::to_string_pretty(&report).map_err(CommandError::failed)?)
        } else {
            print(&report.to_text())
        }
    }

    fn sets(&self) -> Result<Vec<SceneSet>, CommandError> {
        match &self.scenes {
            Some(folder) => Ok(vec![SceneSet::Folder(Folder::open(folder).map_err(CommandError::failed)?)]),
            None => Ok(self.set.iter().copied().map(SceneSet::Generated).collect()),
        }
    }

    fn measure(&self) -> Result<(Vec<Row>, Option<Conventions>), CommandError> {
        let methods = self.network.methods(&self.method)?;
        let methods: Vec<&dyn Reconstructor> = methods.iter().map(AsRef::as_ref).collect();
        let campaign = Campaign {
            radar: Radar { carrier: self.carrier, ..Radar::default() },
            reading: if self.thesis_text { Reading::Text } else { Reading::Program },
            seed: self.seed,
            count: self.count,
            shard: self.shard,
            floor: self.floor.floor,
            ..Campaign::default()
        };
        let sets = self.sets()?;
        let scenes: u32 = sets.iter().map(|set| campaign.scenes(set)).sum();
        if scenes == 0 {
            let message = format!("--shard {} has no scene; expected I below the number of scenes", self.shard);
            return Err(CommandError::Usage(message));
        }
        for said in campaign.untrained(&sets, &methods).map_err(CommandError::failed)? {
            eprintln!("apertura: {said}");
        }
        // Drawn on a terminal only: indicatif hides itself where standard error is a file or a pipe.
        let bar = ProgressBar::new(u64::from(scenes) * methods.len() as u64).with_style(bar_style());
        let on_row = |row: &Row| {
            bar.set_message(row.set.clone());
            bar.inc(1);
        };
        let rows = campaign.run(&sets, &methods, &Task::default(), on_row).map_err(CommandError::failed)?;
        bar.finish_and_clear();
        let conventions = Conventions { seed: self.seed, floor: self.floor.floor, carrier: self.carrier };
        Ok((rows, self.scenes.is_none().then_some(conventions)))
    }

    fn merged(&self) -> Result<Vec<Row>, CommandError> {
        let read = |path: &PathBuf| {
            let file = File::open(path).map_err(on_file(path))?;
            let rows = read_rows(file).map_err(CommandError::on(path))?;
            Ok((path.display().to_string(), rows))
        };
        let tables: Vec<_> = self.merge.iter().map(read).collect::<Result<_, CommandError>>()?;
        merge(tables).map_err(CommandError::failed)
    }
}

fn on_file(path: &Path) -> impl FnOnce(io::Error) -> CommandError {
    move |source| CommandError::File { path: path.to_owned(), source }
}

fn bar_style() -> ProgressStyle {
    ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} maps, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
