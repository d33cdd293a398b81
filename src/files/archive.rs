//! A scene's samples and maps as a NumPy archive with the keys of the thesis author's program.

use super::npz::{NpzError, write_npz};
use crate::maps::{self, Aperture, RangeAngleMap, network_input};
use crate::radar::{End, Radar};
use crate::scene::{Scene, npz};
use crate::signal::BeatSignal;
use ndarray::Axis;
use std::path::Path;

/// Writes `all_point_x`, `all_point_y` (f64 [L], metres), `sub0`, `sub1` (complex128 [samples, end elements], the samples of the two
/// ends), `polar_full` (f64 [1, range bins, columns], log10 magnitude of the whole array, not normalised) and
/// `polar_partial_mag_phase` (f64 [4, range bins, columns], the network's input); and where there is one, `output` (f32 [1, range bins,
/// columns], Lambda as a method estimates it). Arrays are in NumPy's usual (C) order.
///
/// # Errors
/// [`NpzError`] where the file can't be written; nothing is left half-written.
pub fn write_maps(
    path: &Path,
    radar: &Radar,
    scene: &Scene,
    signal: &BeatSignal,
    output: Option<&RangeAngleMap>,
) -> Result<(), NpzError> {
    let profiles = maps::range_transform(radar, signal);
    let map = |aperture| maps::angle_transform(radar, &profiles, aperture);
    let [first, last] = End::BOTH.map(|end| map(Aperture::End(end)));
    let full = map(Aperture::Full).log_magnitude();
    write_npz(path, |out| {
        npz::add_positions(out, scene)?;
        for (key, end) in [("sub0", End::First), ("sub1", End::Last)] {
            out.add(key, &signal.end(radar, end).t().as_standard_layout())?;
        }
        out.add("polar_full", &full.decades().view().insert_axis(Axis(0)))?;
        out.add("polar_partial_mag_phase", &network_input::mag_phase(&first, &last))?;
        match output {
            Some(output) => out.add("output", &output.lambda.view().insert_axis(Axis(0))),
            None => Ok(()),
        }
    })
}
