//! `apertura train`: trains a network by a recipe.

use super::arguments::{real, whole};
use super::{CommandError, print};
use crate::files::{read_bounded, sha256};
use crate::network::backend::Backend;
use crate::network::checkpoint;
use crate::network::recipe::{Network, Recipe, SHIPPED};
use crate::network::run::{Origin, RunProgress, TrainingRun};
use crate::network::thesis::Thesis;
use crate::network::train::train;
use crate::network::trainable_network::TrainableNetwork;
use crate::network::unet::Unet;
use crate::radar::{Radar, counted};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

/// Train a network by a recipe
///
/// The folder gets log.csv, a checkpoint, and at the end weights.safetensors with the record of the run.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Recipe: the name of a shipped one, or a .toml file [with --resume: that of the run]
    #[arg(required_unless_present_any = ["list", "resume"])]
    recipe: Option<String>,

    /// List the shipped recipes
    #[arg(long)]
    list: bool,

    /// Folder of a new run [default: runs/RECIPE]
    #[arg(long, value_name = "DIR", conflicts_with = "resume")]
    output: Option<PathBuf>,

    /// Resume the run in this folder
    #[arg(long, value_name = "DIR")]
    resume: Option<PathBuf>,

    /// Stop with a checkpoint after this many steps in all
    #[arg(long, value_name = "N", value_parser = whole(0..=u64::MAX))]
    steps: Option<u64>,

    /// Stop with a checkpoint after this many minutes
    #[arg(long, value_name = "M", value_parser = real(0.0..=MAX_MINUTES))]
    minutes: Option<f64>,

    /// Write random weights if no step was taken
    #[arg(long)]
    untrained: bool,

    /// Backend that computes tensors
    #[arg(long, value_name = "NAME", default_value = "flex", help = format!("Backend: {}", Backend::names()))]
    backend: Backend,
}

/// A year.
const MAX_MINUTES: f64 = 525_600.0;

const MAX_RECIPE_BYTES: u64 = 1 << 20;

const CHECKPOINT: &str = "checkpoint";

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        if self.list {
            return list();
        }
        let recipe = self.recipe()?;
        let resume = self.resume.is_some();
        let folder = self.resume.or(self.output).unwrap_or_else(|| PathBuf::from("runs").join(&recipe.name));
        let run = TrainingRun {
            folder,
            device: self.backend.device(),
            radar: Radar::default(),
            max_steps: self.steps,
            max_time: self.minutes.map(|m| Duration::from_secs_f64(60.0 * m)),
            untrained: self.untrained,
            checkpoint_every: Duration::from_secs(120),
            origin: origin(),
        };
        match &recipe.network {
            Network::Thesis(config) => go::<Thesis>(&recipe, config, &run, resume),
            Network::Unet(config) => go::<Unet>(&recipe, config, &run, resume),
        }
    }

    fn recipe(&self) -> Result<Recipe, CommandError> {
        if let (None, Some(folder)) = (&self.recipe, &self.resume) {
            return Ok(checkpoint::recipe(&folder.join(CHECKPOINT))?);
        }
        let name = self.recipe.as_deref().unwrap_or_default();
        if let Some(recipe) = Recipe::shipped(name) {
            return Ok(recipe?);
        }
        let path = PathBuf::from(name);
        if !path.exists() {
            let known: Vec<_> = SHIPPED.iter().map(|(name, _)| *name).collect();
            let message = format!("\"{name}\" is neither a file nor a shipped recipe; shipped: {}", known.join(", "));
            return Err(CommandError(message));
        }
        let bytes = read_bounded(&path, MAX_RECIPE_BYTES).map_err(CommandError::on(&path))?;
        let text = String::from_utf8(bytes).map_err(CommandError::on(&path))?;
        Ok(Recipe::parse(name, &text)?)
    }
}

fn list() -> Result<(), CommandError> {
    SHIPPED.iter().try_for_each(|(name, text)| print(&format!("{name:20} {}", Recipe::parse(name, text)?.description)))
}

fn go<S: TrainableNetwork>(
    recipe: &Recipe,
    config: &S::Config,
    run: &TrainingRun,
    resume: bool,
) -> Result<(), CommandError> {
    let all = recipe.training_scenes().len() / recipe.batch * recipe.epochs as usize;
    let bar = ProgressBar::new(run.max_steps.map_or(all as u64, |most| most.min(all as u64)));
    bar.set_style(ProgressStyle::with_template("{bar:30} step {pos}/{len}, {eta} left, {msg}")?);
    let watch = |p: &RunProgress| {
        bar.set_position(p.step);
        bar.set_message(format!("epoch {}, loss {:.5}", p.epoch, p.loss));
    };
    let end = train::<S>(recipe, config, run, resume, watch)?;
    bar.finish_and_clear();
    let (steps, maps) = (counted(end.step, "step", "steps"), counted(end.maps, "map", "maps"));
    let minutes = counted((end.seconds / 60.0).round(), "minute", "minutes");
    let (loss, path) = (end.loss, run.folder.join("weights.safetensors"));
    print(&format!("{steps}, {maps}, {minutes}, loss {loss:.5}; wrote {}", path.display()))
}

fn origin() -> Origin {
    let program = std::env::current_exe().and_then(|path| sha256::of_file(&path));
    Origin {
        commit: commit(),
        program_sha256: program.unwrap_or_else(|_| "unknown".to_owned()),
        arguments: std::env::args().skip(1).collect(),
    }
}

/// The commit of the working folder, for the record in the weights; "unknown" outside a repository.
fn commit() -> String {
    let out = Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    let text = out.ok().filter(|o| o.status.success()).and_then(|o| String::from_utf8(o.stdout).ok());
    text.map_or_else(|| "unknown".to_owned(), |t| t.trim().to_owned())
}
