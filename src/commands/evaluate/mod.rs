//! `apertura evaluate`: tables 4.1 to 4.3 for any method, beside the printed values. Also writes rows, runs shards, and takes your own scenes.

mod by_echo;
mod percent;
mod report;

use super::arguments::{self, FloorArgs, seed, whole};
use super::layout_arg::LayoutArg;
use super::network_args::NetworkArgs;
use super::progress::ProgressArg;
use super::radar_arg::RadarArg;
use super::{CommandError, print, print_json};
use crate::evaluate::campaign::{Campaign, Shard};
use crate::evaluate::rows::{
    MissingRows, Row, RowFile, RowFileError, RowIdentity, RunRows, WHY_NO_OTHER_FORMAT, merge, missing_rows,
    read_table, row_identity, write_merged,
};
use crate::evaluate::sets::{SceneFolder, SceneSet};
use crate::maps::cfar::Cfar;
use crate::platform::console::note;
use crate::radar::{Carrier, Radar};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::{Kind, Reading};
use crate::task::Task;
use report::EvaluationReport;
use std::collections::HashSet;
use std::fs::File;
use std::path::PathBuf;
use std::sync::Arc;

/// Fill tables 4.1 to 4.3: squared error, detection and false-alarm rates of reconstruction methods on random test scenes
///
/// P_D and P_FA are at the threshold that each method ships with, which was chosen on validation scenes, or at that which it reads off each answer
/// (live, hybrid, and nomp where something is unexplained). A further column gives P_D
/// with a threshold for each scene that holds its P_FA to the printed one. The thesis' P_D is at one fixed threshold and cannot be compared with
/// that column. Below each mean stands the median over the scenes. An object is missed when less than half of the cells in which the whole
/// array shows it exceed the threshold. A false alarm (column false; ghosts in rows) is a blob where the scene has no object and the whole array
/// shows nothing. "Near best" is the fraction of scenes on which the squared error is at most 1.2 times the smallest of the other methods'. The optimisers that trained a network stand behind
/// its name. For scenes with bodies a further table counts echoes: those that stand 10 dB out of the map of the whole array, and those of them
/// that the method shows, by classes of 10 dB below the scene's strongest. The end of a wall lies 30 to 60 dB below its glint, where P_D doesn't see it.
///
/// With --layout methods hear those elements in place of the two ends; each row names them in the column layout. A method that can't is left out,
/// and standard error says why.
///
/// With --cfar a further table gives P_D and P_FA where each cell is held against the cells around it in place of the threshold; rows have it
/// in the columns cfar_detection, cfar_false_alarm and cfar. The output is brought to power on the target's scale.
///
/// For a method that says its doubt a line has the part of the cells whose error is at most their doubt (column within_doubt of --rows). Doubt
/// (column doubt) is the squared error if every cell were off by as much as the method says that nine of ten cells stay below, on scenes and over
/// noise like those it was trained on.
///
/// With --rows each row is appended as soon as it is found. The same command resumes a stopped run. Rows of another run are
/// refused. --merge joins the rows of the parts of one run, and fails where scenes are missing.
///
/// With --json one object is printed: count, seed, floor, normalisation, carrier, reading and radar (what made the rows; null where older rows
/// don't say, the last three also for the scenes of a folder; radar is empty for table 3.1's), layout (numbers of the elements heard; empty for the two
/// ends), missing (what lacks of the whole run: set,
/// method, missing, of, first numbers, shard) and sets,
/// each with its name (set: a number for the thesis' sets), its description, what the thesis prints there (printed: baseline, experiment_1,
/// experiment_2; null for other scenes), false_alarm (the printed rate, experiment 2's; 1 % for other scenes) and methods, each with name, weights (the first 12
/// digits of their SHA-256; null without weights), optimiser, eta (the mean where one_eta is false: then each answer has its own), one_eta,
/// scenes, squared_error, detection, false_alarm, missed and ghosts (mean, standard_error and median; rates at the method's threshold),
/// detection_at_printed_false_alarm (false_alarm, detection, standard_error, median; threshold says that each scene has its own), echoes
/// (null without bodies; below_db: where each class begins, there and found: echoes of each class, detection: the part of all that are found),
/// within_doubt (null where no row says it: mean, standard_error and median of the part of the cells), cfar (null without --cfar: detector, and detection and false_alarm by it),
/// median_milliseconds and near_best (null with one method). Each set also has against: the first method beside each other one on the scenes
/// of both (first, second, scenes, squared_error_difference and its interval_95 by the paired bootstrap, first_alone and second_alone: scenes
/// in which that one alone finds every object, none merged or on a wrong tooth; mcnemar_p). Rates are fractions, not percent.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Methods, separated by commas [default: those of --method-command, or else baseline]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    method: Vec<String>,

    #[arg(long, value_name = "1,2,3,KIND,..", value_delimiter = ',', default_value = "1,2,3",
          help = format!("Kinds of scenes, separated by commas: {}", Kind::names()))]
    set: Vec<Kind>,

    /// Scenes of each set
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = whole(1..=1_000_000u32))]
    count: u32,

    /// Seed of the scenes
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed)]
    seed: u64,

    /// Folder of scene files, in place of random scenes
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["set", "count", "seed", "carrier", "radar", "thesis_text"])]
    scenes: Option<PathBuf>,

    /// Append one row a scene and method to this CSV file, and resume where its rows end; tables are printed from these rows
    #[arg(long, value_name = "FILE.csv")]
    rows: Option<PathBuf>,

    /// Replace the file of --rows, with any content
    #[arg(long, requires = "rows")]
    overwrite: bool,

    /// Only every N-th scene, from scene I on
    #[arg(long, value_name = "I/N", default_value_t)]
    shard: Shard,

    /// Print the tables of rows from these files together
    #[arg(long, value_name = "FILE.csv", num_args = 1..,
          conflicts_with_all = ["method", "set", "count", "seed", "scenes", "shard", "floor", "carrier", "radar",
                                "layout", "thesis_text"])]
    merge: Vec<PathBuf>,

    /// Print the tables of --merge even if scenes are missing
    #[arg(long, requires = "merge")]
    partial: bool,

    #[command(flatten)]
    progress: ProgressArg,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,

    /// How the carrier's phase is read
    #[arg(long, value_parser = arguments::carrier(), value_name = "one-way|two-way", default_value = "one-way", conflicts_with = "radar")]
    carrier: Carrier,

    #[command(flatten)]
    radar: RadarArg,

    #[command(flatten)]
    layout: LayoutArg,

    /// Make scenes as the thesis' text describes them, not as its author's program does
    #[arg(long)]
    thesis_text: bool,

    /// Try a detector of constant false-alarm rate on every output: ca (cell averaging) or os (ordered statistics), with guard and training cells a side as range bins x columns and the wanted rate, as in ca:guard=4x0:training=16x0:rate=1e-4
    #[arg(long, value_name = "ca|os[:..]", conflicts_with = "merge")]
    cfar: Option<Cfar>,

    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let (rows, missing) = if self.merge.is_empty() { (self.measure()?, Vec::new()) } else { self.merged()? };
        let report = EvaluationReport::of(&rows, missing);
        if self.json { print_json(&report) } else { print(&report.to_text()) }
    }

    fn sets(&self) -> Result<Vec<SceneSet>, CommandError> {
        match &self.scenes {
            Some(folder) => Ok(vec![SceneSet::Folder(SceneFolder::open(folder)?)]),
            None => Ok(self.set.iter().copied().map(SceneSet::Generated).collect()),
        }
    }

    fn campaign(&self, sets: &[SceneSet]) -> Result<Campaign, CommandError> {
        let radar = match self.radar.is_given() {
            true => self.radar.load()?.0,
            false => Radar { carrier: self.carrier, ..Radar::default() },
        };
        let campaign = Campaign {
            radar,
            reading: if self.thesis_text { Reading::Text } else { Reading::Program },
            seed: self.seed,
            count: self.count,
            shard: self.shard,
            floor: self.floor.floor(),
            cfar: self.cfar,
            ..Campaign::default()
        };
        let radar = match sets {
            // The folder's scenes name their own radars.
            [folder @ SceneSet::Folder(_)] => folder.case(&campaign.radar, &campaign.generator(), 0)?.radar,
            _ => campaign.radar.clone(),
        };
        Ok(match self.layout.numbers(&radar)? {
            None => campaign,
            layout => Campaign { layout, radar, ..campaign },
        })
    }

    fn measure(&self) -> Result<Vec<Row>, CommandError> {
        let own = self.network.start_own()?;
        let methods = self.network.methods(&arguments::chosen(&self.method, &own, "baseline"))?;
        let sets = self.sets()?;
        let campaign = self.campaign(&sets)?;
        let methods = hearing(&campaign, &methods)?;
        let empty = campaign.empty_rows(&sets, &methods)?;
        let scenes: u64 = sets.iter().map(|set| u64::from(campaign.scenes(set))).sum();
        if scenes == 0 {
            let message = format!("--shard {} has no scene; expected I below the number of scenes", self.shard);
            return Err(CommandError(message));
        }
        for said in campaign.untrained(&sets, &methods)? {
            note(&format!("apertura: {said}"));
        }
        let wanted = RunRows::new(&empty);
        let open = |path: &PathBuf| RowFile::open(path, &wanted, self.overwrite);
        let mut file = self.rows.as_ref().map(open).transpose().map_err(told)?;
        let maps = scenes * methods.len() as u64;
        let done = self.done(file.as_ref(), maps);
        let mut progress = self.progress.of(maps - done.len() as u64, "maps");
        let is_done = |set: &str, index: u32, method: &str| {
            !done.is_empty() && done.contains(&(set.into(), index, method.into()))
        };
        let task = Task::default();
        let found = campaign.run_rest(&sets, &methods, &empty, &is_done, &task, |row, _, _| {
            progress.step(format_args!("now set {}", row.set));
            if file.as_mut().is_some_and(|file| !file.append(row)) {
                task.cancel();
            }
        });
        progress.finish();
        match file {
            None => Ok(found?),
            Some(mut file) => match file.failure() {
                Some(failure) => Err(told(failure)),
                None => found.map_or_else(|error| Err(error.into()), |_| file.finish().map_err(told)),
            },
        }
    }

    fn done(&self, file: Option<&RowFile>, maps: u64) -> HashSet<RowIdentity> {
        let done: HashSet<RowIdentity> = file.iter().flat_map(|file| file.present.iter().map(row_identity)).collect();
        if let (Some(path), false) = (&self.rows, done.is_empty()) {
            let (path, there) = (path.display(), done.len());
            match there as u64 == maps {
                true => note(&format!("{path} holds all {maps} rows of this run already")),
                false => {
                    note(&format!("{path} holds {there} of {maps} rows of this run already: going on with the rest"))
                }
            }
        }
        done
    }

    fn merged(&self) -> Result<(Vec<Row>, Vec<MissingRows>), CommandError> {
        let (mut tables, mut problems) = (Vec::new(), Vec::new());
        for path in &self.merge {
            let on_file = CommandError::on(path);
            let file = File::open(path).map_err(on_file)?;
            let table = read_table(file).map_err(CommandError::on(path))?;
            if table.is_cut {
                problems.push(format!("{} ends within a line, which was left out", path.display()));
            }
            if table.rows.is_empty() {
                problems.push(format!("{} holds no row", path.display()));
            }
            tables.push((path.display().to_string(), table.rows));
        }
        let rows = merge(tables).map_err(CommandError)?;
        let missing = missing_rows(&rows);
        problems.extend(missing.iter().map(|lack| format!("missing: {lack}")));
        if rows.is_empty() || !(problems.is_empty() || self.partial) {
            let listed = problems.join("\n  ");
            let message = format!(
                "the rows are not those of a whole run:\n  {listed}\n--partial prints the tables of what there is"
            );
            return Err(CommandError(message));
        }
        problems.iter().for_each(|problem| note(&format!("note: {problem}")));
        if rows.iter().any(|row| row.version == Some(1)) {
            note(&format!("note: {WHY_NO_OTHER_FORMAT}; these rows are of format 1"));
        }
        if rows.iter().any(|row| row.version.is_none()) {
            note("note: an older program wrote these rows; they don't say what made them, nor what the whole run was");
        }
        if let Some(path) = &self.rows {
            write_merged(path, &rows, self.overwrite).map_err(told)?;
        }
        Ok((rows, missing))
    }
}

fn hearing<'a>(
    campaign: &Campaign,
    methods: &'a [Arc<dyn Reconstructor>],
) -> Result<Vec<&'a dyn Reconstructor>, CommandError> {
    let (mut hearing, mut refusals) = (Vec::new(), Vec::new());
    for method in methods {
        let heard = campaign.layout.as_ref().map_or(Ok(()), |layout| method.check_elements(&campaign.radar, layout));
        heard.map_or_else(|error| refusals.push(error), |()| hearing.push(method.as_ref()));
    }
    match refusals.pop() {
        Some(refusal) if hearing.is_empty() => Err(refusal.into()),
        last => {
            refusals.iter().chain(&last).for_each(|refusal| note(&format!("apertura: left out: {refusal}")));
            Ok(hearing)
        }
    }
}

fn told(error: RowFileError) -> CommandError {
    let help = match error {
        RowFileError::Other { .. } => "; name another file, or write over this one with --overwrite",
        _ => "",
    };
    CommandError(format!("{error}{help}"))
}
