//! The command line: one subcommand a file.
//!
//! A subcommand is a file with `pub struct Args` (clap) and `Args::run(self) -> Result<(), CommandError>`, and
//! a line in `commands!`. Errors of other rooms become a [`CommandError`] by `?`.

mod arguments;
mod bench;
mod bounds;
mod budget;
#[cfg(feature = "live")]
mod dataset;
mod error;
mod evaluate;
mod figure;
#[cfg(feature = "network")]
mod figures;
mod frames;
mod import;
mod input;
mod layout_arg;
mod layouts;
#[cfg(feature = "app")]
mod lesson;
mod line_chart;
mod listen;
mod maps;
mod methods;
mod network_args;
mod open;
mod output;
mod own_method;
mod progress;
mod radar_arg;
mod range_doppler;
mod reconstruct;
mod robustness;
mod scenes;
mod threshold;
#[cfg(feature = "network")]
mod train;
mod worsen;

pub use error::CommandError;
pub use output::{check_no_picture, picture_format, print, print_json, write_file};

use crate::platform::console;
use crate::signal::simd::Simd;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

/// See what a 1024-element automotive radar sees, and how much of it 24 of those elements recover.
///
/// Without a command the window opens, on a scene or a recording if one is given. Without a display its panels are drawn to
/// apertura.png instead.
#[derive(Debug, Parser)]
#[command(version, about, args_conflicts_with_subcommands = true, after_help = ENVIRONMENT)]
struct Cli {
    #[command(flatten)]
    open: open::Args,

    #[command(subcommand)]
    command: Option<Command>,
}

const ENVIRONMENT: &str = "Environment:
  APERTURA_SIMD  portable, avx2 or avx512: instructions of simulation, maps and live network (default: the best that the processor has);
                 least squares and burn choose for themselves
  APERTURA_LOG   messages on standard error, such as debug (default: warnings)";

macro_rules! commands {
    ($($(#[$built:meta])* $name:ident of $file:ident,)+) => {
        #[derive(Debug, Subcommand)]
        enum Command {
            $($(#[$built])* $name($file::Args),)+
        }

        impl Command {
            fn run(self) -> Result<(), CommandError> {
                match self {
                    $($(#[$built])* Command::$name(args) => args.run(),)+
                }
            }
        }
    };
}

commands! {
    Bench of bench,
    Bounds of bounds,
    Budget of budget,
    #[cfg(feature = "live")]
    Dataset of dataset,
    Evaluate of evaluate,
    #[cfg(feature = "network")]
    Figures of figures,
    Import of import,
    Layouts of layouts,
    #[cfg(feature = "app")]
    Lesson of lesson,
    Listen of listen,
    Maps of maps,
    Methods of methods,
    RangeDoppler of range_doppler,
    Reconstruct of reconstruct,
    Robustness of robustness,
    Scenes of scenes,
    Threshold of threshold,
    #[cfg(feature = "network")]
    Train of train,
    Worsen of worsen,
}

/// Runs the program; errors go to standard error and make the exit status non-zero.
pub fn main() -> ExitCode {
    console::join();
    log_to_stderr();
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let found = command().try_get_matches_from(&arguments).and_then(|found| Cli::from_arg_matches(&found));
    let cli = found.unwrap_or_else(|error| {
        let mistyped = if error.use_stderr() { mistyped_command(&arguments) } else { None };
        mistyped.unwrap_or(error).exit()
    });
    let run = || {
        Simd::requested()?;
        cli.command.map_or_else(|| cli.open.run(), Command::run)
    };
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::say(&format!("error: {error}"));
            ExitCode::FAILURE
        }
    }
}

/// The command line as `clap` has it, for man pages and completions.
pub fn command() -> clap::Command {
    // A negative number is a value, so that a message names the allowed values, and not an unknown option.
    Cli::command().mut_subcommands(|command| command.allow_negative_numbers(true))
}

/// The error of a first argument that stands where a command does, and is neither one nor a file. clap takes it for the scene, and finds fault with
/// the next argument.
fn mistyped_command(arguments: &[OsString]) -> Option<clap::Error> {
    let name = arguments.get(1)?.to_str()?;
    let is_word = name.starts_with(char::is_alphanumeric) && name.chars().all(|c| c.is_alphanumeric() || c == '-');
    let mut command = command();
    if !is_word || name == "help" || command.find_subcommand(name).is_some() || Path::new(name).exists() {
        return None;
    }
    // Where no scene may stand, clap looks for similar commands, of which the most similar comes last.
    let alone = clap::Command::new("apertura").subcommands(command.get_subcommands().cloned());
    let refused = alone.try_get_matches_from(["apertura", name]).err()?;
    let similar = match refused.get(ContextKind::SuggestedSubcommand) {
        Some(ContextValue::Strings(names)) => names.last(),
        _ => None,
    };
    let advice = similar.map_or_else(String::new, |similar| format!(", did you mean \"{similar}\"?"));
    Some(command.error(ErrorKind::InvalidSubcommand, format!("no command \"{name}\"{advice}")))
}

/// Shows warnings on standard error; `APERTURA_LOG=debug` (or any `tracing` filter) shows more.
fn log_to_stderr() {
    let filter =
        tracing_subscriber::EnvFilter::try_from_env("APERTURA_LOG").unwrap_or_else(|_| "apertura=warn,off".into());
    let _already_set = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).try_init();
}
