//! `apertura methods`: every reconstruction method, and which take the samples of a radar.

use super::input::InputArgs;
use super::{CommandError, print};
use crate::methods::all;
use crate::reconstruct::{Family, ReconstructError, Reconstructor};
use std::path::PathBuf;

/// List the reconstruction methods with a sentence each
///
/// With a scene or a recording, tell of each method whether it takes samples of that radar, and if not, why.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene (.toml or .npz) or recording (.toml) whose radar the methods are asked about
    input: Option<PathBuf>,
}

/// Columns of a name and the space behind it.
const NAME_WIDTH: usize = 27;

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let input = self.input.as_deref().map(InputArgs::load).transpose()?;
        let methods = all();
        let mut families = Vec::new();
        for family in Family::ALL {
            let of_family: Vec<String> =
                methods.iter().filter(|m| m.family() == family).map(|m| line(m.as_ref(), input.as_ref())).collect();
            if !of_family.is_empty() {
                families.push(format!("{}: {}\n{}", family.name(), family.describe(), of_family.join("\n")));
            }
        }
        print(&families.join("\n\n"))
    }
}

fn line(method: &dyn Reconstructor, input: Option<&InputArgs>) -> String {
    let told = match input.map(|input| takes(method, input)) {
        None => method.description().to_owned(),
        Some(Ok(())) => "yes".to_owned(),
        Some(Err(ReconstructError::Unusable { reason, .. })) => format!("no: {reason}"),
        Some(Err(error)) => format!("no: {error}"),
    };
    format!("  {:<NAME_WIDTH$}{told}", method.name())
}

fn takes(method: &dyn Reconstructor, input: &InputArgs) -> Result<(), ReconstructError> {
    match input {
        InputArgs::Scene(file) => method.check_array(&file.radar),
        InputArgs::Recording(recording) => {
            method.check_array(&recording.radar)?;
            method.check_hearing(&recording.two_ends())
        }
    }
}
