//! The command line: one subcommand a file.

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// See what a 1024-element automotive radar sees, and how much of it 24 of those elements recover.
#[derive(Debug, Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

/// What the program can do beside opening its window.
#[derive(Debug, Subcommand)]
enum Command {}

/// Runs the program; errors go to standard error and make the exit status non-zero.
pub fn main() -> ExitCode {
    match Cli::parse().command {
        Some(command) => match command {},
        None => ExitCode::SUCCESS,
    }
}
