//! No subcommand: the app, or a picture where there is no display.

use super::CommandError;
use std::path::PathBuf;

/// What to open.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene to open (.toml or .npz)
    pub scene: Option<PathBuf>,

    /// Write the app's time for every frame to this CSV file
    #[arg(long, value_name = "FILE")]
    pub frame_log: Option<PathBuf>,
}

impl Args {
    /// Opens the app.
    pub fn run(self) -> Result<(), CommandError> {
        super::print("the app is not part of this build; try: apertura --help")
    }
}
