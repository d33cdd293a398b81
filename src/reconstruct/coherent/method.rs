//! A coherent method is one closure; everything around it is written here once.

use super::ends::Ends;
use super::model::{Model, Update};
use super::peaks::{Peak, apart, gains, peaks};
use super::places::places;
use super::sectors::Sectors;
use super::settle::Settled;
use crate::radar::Radar;
use crate::reconstruct::answer::{Reconstruction, Request};
use crate::reconstruct::echoes::{Gained, of_echoes};
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::family::Family;
use crate::reconstruct::hearing::Hearing;
use crate::reconstruct::reconstructor::{About, Hears, Reconstructor};
use crate::reconstruct::seen::no_plane_waves;
use crate::signal::TwoEnds;
use crate::task::Task;
use rayon::prelude::*;

/// Most elements that are heard: a model's work grows with the cube of their number.
const MOST_HEARD_ELEMENTS: usize = 96;

/// Looks at what the reflectors found so far leave of the samples.
const LOOKS: usize = 4;

/// Most sectors: of an array that is thousands of range bins long.
const MOST_SECTORS: f64 = 1000.0;

/// What every coherent method is told.
pub(super) const TOLD_TO_COHERENT: &str = "nothing about the scene or the floor; it measures the noise itself";

/// A method that finds the powers of steering vectors of both ends together.
#[derive(Debug, Clone, Copy)]
pub struct CoherentMethod {
    pub(super) about: About,
    pub(super) update: Update,
    /// A direction's least power, as a part of its model's strongest, to be taken for a reflector.
    pub(super) least_part: f64,
}

impl Reconstructor for CoherentMethod {
    fn family(&self) -> Family {
        Family::Sparse
    }

    fn about(&self) -> About {
        self.about
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn fewest_end_elements(&self) -> usize {
        1
    }

    fn hears(&self) -> Hears {
        Hears::Halves
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        self.check_size(radar, radar.end_elements.saturating_mul(2))
    }

    fn check_halves(&self, halves: &Radar, heard: usize) -> Result<(), ReconstructError> {
        self.check_size(halves, heard)
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let task = &request.task;
        let hearing = Hearing::beneath(radar, ends, request.noise);
        let found = if radar.samples == 1 {
            // A single sample tells no range to move reflectors along.
            gains(radar, &self.peaks(radar, ends, &hearing, task)?, ends, task)?
        } else {
            let look = |ends: &TwoEnds| self.peaks(radar, ends, &hearing, task);
            explained(radar, ends, task, look)?
        };
        Ok(of_echoes(radar, ends, &found, hearing.ends_noise_variance(radar, ends), request))
    }
}

impl CoherentMethod {
    /// Whether its models can be made of `heard` elements of `radar`'s ends.
    fn check_size(&self, radar: &Radar, heard: usize) -> Result<(), ReconstructError> {
        if heard > MOST_HEARD_ELEMENTS {
            return Err(self.unusable(format!(
                "its models take at most {MOST_HEARD_ELEMENTS} elements, and {heard} are heard; matched-filter takes any number"
            )));
        }
        let bins = radar.bin_of_range(radar.aperture_metres());
        if radar.samples > 1 && bins > MOST_SECTORS {
            return Err(self.unusable(format!(
                "the array is {bins:.0} range bins long; a sector of directions for each bin is taken up to {MOST_SECTORS}"
            )));
        }
        no_plane_waves(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    /// What stands out of the samples of both ends, the strongest first.
    fn peaks(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        hearing: &Hearing,
        task: &Task,
    ) -> Result<Vec<Peak>, ReconstructError> {
        let heard = Ends::new(radar, ends);
        let sectors = Sectors::new(radar, &heard);
        // The window's mean weight squared over its mean square, for each sample.
        let noise_power = hearing.ends_noise_variance(radar, ends) * 1.5 / radar.samples as f64;
        let places = places(radar, &heard, &sectors, noise_power, task)?;
        let found: Vec<Vec<Peak>> = places
            .par_iter()
            .map(|place| {
                let powers = Model::new(radar, &heard, &sectors, place, noise_power).powers(&self.update, task)?;
                Ok(peaks(&sectors, place, &powers, self.least_part))
            })
            .collect::<Result<_, ReconstructError>>()?;
        Ok(apart(radar, found.concat(), sectors.fringe_cos))
    }
}

/// Reflectors behind the peaks that `look` finds in `ends`, and in what those found so far leave of them.
///
/// # Errors
/// [`ReconstructError::Cancelled`], and those of `look`.
pub(in crate::reconstruct) fn explained(
    radar: &Radar,
    ends: &TwoEnds,
    task: &Task,
    look: impl Fn(&TwoEnds) -> Result<Vec<Peak>, ReconstructError>,
) -> Result<Vec<Gained>, ReconstructError> {
    let mut first = None;
    let mut settled = looked(Settled::new(radar, ends, task), &mut first, 0.0, &look)?;
    if settled.is_doubtful() {
        settled = settled.or(looked(Settled::new(radar, ends, task).trying_two(), &mut first, 0.45, &look)?);
    }
    settled.found(ends)
}

/// `settled` after all looks; `first` are the peaks of the first one, which are the same for the same samples. Progress
/// goes on from `from`.
fn looked<'a>(
    mut settled: Settled<'a>,
    first: &mut Option<Vec<Peak>>,
    from: f32,
    look: &impl Fn(&TwoEnds) -> Result<Vec<Peak>, ReconstructError>,
) -> Result<Settled<'a>, ReconstructError> {
    for round in 0..LOOKS {
        settled.task.set_progress(from + 0.45 * round as f32 / LOOKS as f32);
        let peaks = match first {
            Some(peaks) if round == 0 => peaks.clone(),
            _ => look(&settled.left())?,
        };
        let goes_on = settled.take(&peaks)?;
        if round == 0 {
            *first = Some(peaks);
        }
        if !goes_on {
            break;
        }
    }
    Ok(settled)
}
