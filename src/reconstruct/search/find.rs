//! The whole search, from samples of both ends to objects.

use super::calibrate::{Calibration, asks_for_gains};
use super::finish::Found;
use super::ladder::{LADDER, after_rungs};
use super::propose::peaks::Detector;
use super::settings::Settings;
use super::state::{Search, State};
use super::trace::Trace;
use crate::radar::{Radar, hann};
use crate::reconstruct::fit::{Fitter, Samples, Tie};
use crate::reconstruct::noise_model::NoiseModel;
use crate::reconstruct::reconstructor::unit_gain;
use crate::reconstruct::{ReconstructError, Request};
use crate::signal::TwoEnds;

/// The objects in the samples of both ends.
/// # Errors
/// [`ReconstructError::Cancelled`].
pub fn find(radar: &Radar, ends: &TwoEnds, request: &Request, settings: &Settings) -> Result<Found, ReconstructError> {
    find_from(&Found::nothing(), radar, ends, request, settings)
}

/// The objects in samples that differ little from those of `previous`, from its objects; by [`find`] where these don't explain the samples.
/// # Errors
/// [`ReconstructError::Cancelled`].
pub fn find_from(
    previous: &Found,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
    settings: &Settings,
) -> Result<Found, ReconstructError> {
    let previous = Some(previous).filter(|previous| !previous.atoms.is_empty());
    let Some((ends, scale)) = unit_gain(ends) else { return Ok(Found::nothing()) };
    let search = |previous: Option<&Found>, ends: &TwoEnds, request: &Request, settings: &Settings| {
        found_in(previous, radar, ends, request, settings, scale)
    };
    // Gains of the elements stay the same when an object moves.
    if let Some((previous, gains)) = previous.and_then(|previous| Some((previous, previous.element_gains.clone()?))) {
        let found = search(Some(previous), &gains.taken_from(&ends), request, settings)?;
        if found.is_complete || found.search_residual_part <= previous.search_residual_part {
            return Ok(Found { element_gains: Some(gains), ..found });
        }
    }
    let plain = search(previous.filter(|p| p.element_gains.is_none()), &ends, request, settings)?;
    if !asks_for_gains(&plain) {
        return Ok(plain);
    }
    let calibration = Calibration { search: &search, radar, ends: &ends, request, settings, plain: &plain };
    Ok(calibration.found()?.unwrap_or(plain))
}

/// The objects in samples of equal elements, which were multiplied by `scale` to have a peak between 1 and 2.
fn found_in(
    previous: Option<&Found>,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
    settings: &Settings,
    scale: f64,
) -> Result<Found, ReconstructError> {
    let flat = ends.flat();
    let window = hann(radar.samples);
    let fitter = Fitter::new(radar, &window, &request.task, settings.max_work)
        .with_channels_of(&flat)
        .with_noise(NoiseModel::beneath(radar, ends, request.noise));
    let samples = Samples::new(&fitter.sensor, &flat);
    let detector = Detector::of(radar);
    let trace = Trace::default();
    let has_white_noise = request.noise.is_white();
    let (fitter, detector, samples) = (&fitter, &detector, &samples);
    let search = Search { radar, fitter, detector, samples, has_white_noise, settings, trace: &trace };
    let followed = previous.map(|p| search.followed(p, scale)).transpose()?.flatten();
    let from_scratch = followed.as_ref().filter(|f| !f.is_complete).and(previous).map(|p| p.search_residual_part);
    let nothing = || State::of(fitter.solve(samples, Vec::new(), Tie::PerEnd, 0.0));
    let answer = search.with_model_order(followed.map_or_else(|| after_rungs(&search, LADDER, nothing()), Ok)?)?;
    request.task.check()?;
    request.task.set_progress(1.0);
    let found = search.finished(answer, scale)?;
    let search_residual_part = from_scratch.unwrap_or(found.search_residual_part);
    Ok(Found { search_residual_part, trace: trace.into_attempts(), ..found })
}
