//! `apertura reconstruct`: an estimate of the whole array's map from the samples of the two ends.

use super::arguments::FloorArgs;
use super::network_args::NetworkArgs;
use super::{CommandError, print};
use crate::files::npz::{Npz, write_npz};
use crate::radar::Radar;
use crate::reconstruct::Request;
use crate::signal::TwoEnds;
use ndarray::{Ix2, arr0};
use std::path::PathBuf;
use std::time::Instant;

/// Estimate the whole array's map from the samples of the two ends
///
/// IN holds sub0 and sub1 (complex128 [512, 12], any gain); for the thesis' networks it may hold polar_partial_mag_phase
/// (f64 [4, 512, 1024]) instead. OUT gets net_output (f32 [512, 1024], 0 to 1), eta (the method's threshold, chosen on validation
/// scenes) and milliseconds.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Archive with the samples (.npz)
    input: PathBuf,

    /// Archive to write (.npz)
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,

    /// Reconstruction method
    #[arg(long, value_name = "NAME", default_value = "live")]
    method: String,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,
}

impl Args {
    /// Reconstructs and writes.
    pub fn run(self) -> Result<(), CommandError> {
        let radar = Radar::default();
        let mut archive = Npz::open(&self.input).map_err(CommandError::on(&self.input))?;
        let ready_made = !archive.has("sub0") && archive.has("polar_partial_mag_phase");
        let methods = self.network.methods(std::slice::from_ref(&self.method))?;
        let [method] = methods.as_slice() else { return Err(CommandError::Usage("--method takes one name".into())) };
        let started;
        let lambda = if ready_made {
            let input =
                archive.reals::<ndarray::Ix3>("polar_partial_mag_phase").map_err(CommandError::on(&self.input))?;
            started = Instant::now();
            method.reconstruct_mag_phase(&radar, &input).map_err(CommandError::on(&self.input))?.lambda
        } else {
            let [first, last] = ["sub0", "sub1"]
                .map(|key| archive.complexes::<Ix2>(key).map(|a| a.reversed_axes().as_standard_layout().into_owned()));
            let ends = TwoEnds {
                first: first.map_err(CommandError::on(&self.input))?,
                last: last.map_err(CommandError::on(&self.input))?,
            };
            let request = Request { floor: self.floor.floor, ..Request::default() };
            started = Instant::now();
            method.reconstruct(&radar, &ends, &request).map_err(CommandError::on(&self.input))?.lambda.lambda
        };
        let milliseconds = started.elapsed().as_secs_f64() * 1e3;
        write_npz(&self.output, |out| {
            out.add("net_output", &lambda)?;
            out.add("eta", &arr0(f64::from(method.eta())))?;
            out.add("milliseconds", &arr0(milliseconds))
        })
        .map_err(CommandError::on(&self.output))?;
        print(&format!("wrote {} ({}, {milliseconds:.1} ms)", self.output.display(), method.name()))
    }
}
