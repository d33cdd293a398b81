//! `apertura import`: what a raw capture holds, and the TOML that says so.

use super::input::load_board;
use super::{CommandError, print};
use crate::files::{ends_in, folder_of, write_bytes};
use crate::recording::Origin;
use crate::recording::layout::Candidate;
use crate::recording::raw::{self, Imported};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Say what a raw capture or an array holds, found by evidence, and write the TOML that describes it
///
/// FILE is a capture of 16-bit samples as radars and capture cards write them, an array (.npy, .npz, .mat), or the .cfg that set the radar up. The .cfg is the one that --config
/// names, or the one of the same name beside the capture, or the only one there; without any the samples and receivers of a chirp are searched
/// too. Candidates are judged by the spectrum that each makes, by receivers that see the same, by the count of frames that fill the file, by the
/// half of the range axis that is empty, and by what the .cfg says.
///
/// `apertura maps`, `reconstruct` and `range-doppler`, and the window, open FILE as it is: a TOML is needed only to change what it says.
///
/// --json prints one object: data, config, certainty (sure, likely or open), decided_by, log_odds_to_the_next, layouts (the four best: words, parts,
/// q_first, receivers, header_bytes, packets, samples, receiver_count, loop_chirps, loops, log_odds, evidence; of an array axes and log_odds), sentences, doubts and toml.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Raw capture, array, or the .cfg beside it
    file: PathBuf,

    /// The .cfg that set the radar up
    #[arg(long, value_name = "CFG")]
    config: Option<PathBuf>,

    /// The board that measured: where its antennas stand [default: as the transmitters of the .cfg make likely]
    #[arg(long, value_name = "xWR1642|xWR1443|xWR1843|xWR6843ISK|cascade")]
    board: Option<String>,

    /// TOML to write, in the folder of the capture
    #[arg(short, long, value_name = "REC.toml")]
    output: Option<PathBuf>,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Layouts that are listed.
const MAX_LISTED_LAYOUTS: usize = 4;

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let board = self.board.as_deref().map(load_board).transpose()?;
        let imported = raw::import(&self.file, self.config.as_deref(), board)?;
        if let Some(output) = &self.output {
            check_output(output, &imported.origin.data)?;
        }
        // A file whose recording can't be read is no import.
        let recording = imported.origin.recording()?;
        if self.json {
            print(&described(&imported, &recording.doubts).to_string())?;
        } else {
            imported.origin.sentences.iter().try_for_each(|sentence| print(sentence))?;
            recording
                .doubts
                .iter()
                .filter(|d| !imported.origin.sentences.contains(d))
                .try_for_each(|doubt| print(&format!("note: {doubt}")))?;
        }
        let Some(output) = &self.output else { return Ok(()) };
        let failed = CommandError::on(output);
        write_bytes(output, imported.origin.toml().as_bytes()).map_err(failed)?;
        if self.json { Ok(()) } else { print(&format!("wrote {}", output.display())) }
    }
}

/// The TOML names the capture by its place beside it.
fn check_output(output: &Path, data: &Path) -> Result<(), CommandError> {
    let folder = |path: &Path| {
        let folder = folder_of(path);
        std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
    };
    if !ends_in(output, &["toml"]) {
        return Err(CommandError(format!("{}: expected a name ending in .toml", output.display())));
    }
    if folder(output) != folder(data) {
        let place = folder(data);
        let message =
            format!("{}: the TOML stands beside the capture; expected a name in {}", output.display(), place.display());
        return Err(CommandError(message));
    }
    Ok(())
}

fn described(imported: &Imported, doubts: &[String]) -> Value {
    let Origin { data, config, offers, sentences, .. } = &imported.origin;
    let layouts: Vec<Value> = match &imported.found {
        Some(found) => found.candidates.iter().take(MAX_LISTED_LAYOUTS).map(layout).collect(),
        None => offers.iter().map(|o| json!({ "axes": o.description, "log_odds": o.log_odds })).collect(),
    };
    json!({
        "data": data.display().to_string(),
        "config": config.as_ref().map(|c| c.display().to_string()),
        "certainty": imported.certainty(),
        "decided_by": imported.found.as_ref().map_or(json!("axes"), |found| json!(found.decided_by())),
        "log_odds_to_the_next": imported.margin(),
        "layouts": layouts,
        "sentences": sentences,
        "doubts": doubts,
        "toml": imported.origin.toml(),
    })
}

fn layout(candidate: &Candidate) -> Value {
    let Candidate { layout, counts, evidence, .. } = candidate;
    json!({
        "words": layout.encoding,
        "parts": layout.part_order,
        "q_first": layout.q_first,
        "receivers": layout.receivers,
        "header_bytes": layout.header_bytes,
        "packets": layout.packets,
        "samples": counts.samples,
        "receiver_count": counts.receivers,
        "loop_chirps": counts.chirps,
        "loops": counts.loops,
        "log_odds": candidate.log_odds(),
        "evidence": evidence,
    })
}
