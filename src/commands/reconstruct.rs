//! `apertura reconstruct`: an estimate of the whole array's map from the samples of the two ends.

use super::arguments::FloorArgs;
use super::network_args::NetworkArgs;
use super::radar_arg::RadarArg;
use super::{CommandError, print};
use crate::files::npz::{Npz, NpzError, write_npz};
use crate::radar::Radar;
use crate::reconstruct::found::find;
use crate::reconstruct::{Detection, ReconstructError, Reconstructor, Request};
use crate::signal::TwoEnds;
use ndarray::{Array1, Array2, Ix2, arr0};
use std::path::PathBuf;
use std::time::Instant;

/// Estimate the whole array's map from the samples of the two ends
///
/// IN holds sub0 and sub1 (complex128 [512, 12], any gain, or [samples, elements of an end] of another radar); for the thesis'
/// networks it may hold polar_partial_mag_phase (f64 [4, 512, 1024]) instead. OUT gets net_output (f32 [512, 1024] or
/// [samples, elements], 0 to 1), eta (the method's threshold, chosen on validation scenes) and milliseconds; and of what the method
/// found, the strongest first, found_cos_theta, found_range_metres and found_db (relative to the strongest): its reflectors, or the
/// peaks of its map within 20 dB.
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
    radar: RadarArg,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,
}

impl Args {
    /// Reconstructs and writes.
    pub fn run(self) -> Result<(), CommandError> {
        let radar = self.radar.load()?;
        let mut archive = Npz::open(&self.input).map_err(CommandError::on(&self.input))?;
        let methods = self.network.methods(std::slice::from_ref(&self.method))?;
        let [method] = methods.as_slice() else { return Err(CommandError::Usage("--method takes one name".into())) };
        let ready_made = !archive.has("sub0") && archive.has("polar_partial_mag_phase");
        let answer = if ready_made {
            let input =
                archive.reals::<ndarray::Ix3>("polar_partial_mag_phase").map_err(CommandError::on(&self.input))?;
            let started = Instant::now();
            let map = method.reconstruct_mag_phase(&radar, &input).map_err(CommandError::on(&self.input))?;
            Answer { map: map.lambda, milliseconds: started.elapsed().as_secs_f64() * 1e3, found: Vec::new() }
        } else {
            let ends = self.two_ends(&mut archive)?;
            self.answer(method.as_ref(), &radar, &ends).map_err(CommandError::on(&self.input))?
        };
        self.write(&answer, method.eta()).map_err(CommandError::on(&self.output))?;
        print(&format!("wrote {} ({}, {:.1} ms)", self.output.display(), method.name(), answer.milliseconds))
    }

    fn two_ends(&self, archive: &mut Npz) -> Result<TwoEnds, CommandError> {
        let [first, last] = ["sub0", "sub1"]
            .map(|key| archive.complexes::<Ix2>(key).map(|a| a.reversed_axes().as_standard_layout().into_owned()));
        let first = first.map_err(CommandError::on(&self.input))?;
        Ok(TwoEnds { first, last: last.map_err(CommandError::on(&self.input))? })
    }

    fn answer(&self, method: &dyn Reconstructor, radar: &Radar, ends: &TwoEnds) -> Result<Answer, ReconstructError> {
        let request = Request { floor: self.floor.floor, ..Request::default() };
        let started = Instant::now();
        let answer = method.reconstruct(radar, ends, &request)?;
        let milliseconds = started.elapsed().as_secs_f64() * 1e3;
        let found = find(method, radar, ends, &request, &answer)?;
        Ok(Answer { map: answer.lambda.lambda, milliseconds, found })
    }

    fn write(&self, answer: &Answer, eta: f32) -> Result<(), NpzError> {
        let list = |of: fn(&Detection) -> f64| answer.found.iter().map(of).collect::<Array1<f64>>();
        write_npz(&self.output, |out| {
            out.add("net_output", &answer.map)?;
            out.add("eta", &arr0(f64::from(eta)))?;
            out.add("milliseconds", &arr0(answer.milliseconds))?;
            out.add("found_cos_theta", &list(|f| f.cos_theta))?;
            out.add("found_range_metres", &list(|f| f.range_metres))?;
            out.add("found_db", &list(|f| f.relative_power.0))
        })
    }
}

/// What is written.
struct Answer {
    map: Array2<f32>,
    milliseconds: f64,
    found: Vec<Detection>,
}
