//! A scene's samples and maps as a NumPy archive with the keys of the thesis author's program.

use super::{Aperture, LogMap, RangeAngleMap, angle_transform, channels_map, network_input, range_transform};
use crate::files::npz::{NpzError, NpzOutput, write_npz};
use crate::radar::{End, Radar};
use crate::scene::{Scene, npz};
use crate::signal::{BeatSignal, TwoEnds};
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
    let profiles = range_transform(radar, signal);
    let full = angle_transform(radar, &profiles, Aperture::Full).log_magnitude();
    write_npz(path, |out| {
        npz::add_positions(out, scene)?;
        add_samples_and_maps(out, radar, &signal.two_ends(radar), Some(&full))?;
        add_output(out, output)
    })
}

/// The same of a recording: nothing is known of its reflectors, and `polar_full` is there where all its elements were recorded.
///
/// # Errors
/// As [`write_maps`].
pub fn write_recorded_maps(
    path: &Path,
    radar: &Radar,
    ends: &TwoEnds,
    full: Option<&LogMap>,
    output: Option<&RangeAngleMap>,
) -> Result<(), NpzError> {
    write_npz(path, |out| {
        add_samples_and_maps(out, radar, ends, full)?;
        add_output(out, output)
    })
}

fn add_output(out: &mut NpzOutput, output: Option<&RangeAngleMap>) -> Result<(), NpzError> {
    output.map_or(Ok(()), |output| out.add("output", &output.lambda.view().insert_axis(Axis(0))))
}

fn add_samples_and_maps(
    out: &mut NpzOutput,
    radar: &Radar,
    ends: &TwoEnds,
    full: Option<&LogMap>,
) -> Result<(), NpzError> {
    let [first, last] = End::BOTH.map(|end| channels_map(radar, ends.end(end).view()));
    for (key, end) in [("sub0", End::First), ("sub1", End::Last)] {
        out.add(key, &ends.end(end).t().as_standard_layout())?;
    }
    if let Some(full) = full {
        out.add("polar_full", &full.decades().view().insert_axis(Axis(0)))?;
    }
    out.add("polar_partial_mag_phase", &network_input::mag_phase(&first, &last))
}
