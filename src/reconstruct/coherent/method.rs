//! The steps that all coherent methods share.

use super::ends::Ends;
use super::model::{Model, Update};
use super::peaks::{Peak, distinct, gains, peaks};
use super::places::places;
use super::refinement::Refinement;
use super::sectors::Sectors;
use crate::radar::Radar;
use crate::reconstruct::answer::{Reconstruction, Request};
use crate::reconstruct::echoes::{Gained, of_echoes};
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::family::Family;
use crate::reconstruct::noise_model::NoiseModel;
use crate::reconstruct::polar::no_plane_waves;
use crate::reconstruct::reconstructor::{LayoutSupport, MethodInfo, Reconstructor};
use crate::signal::TwoEnds;
use crate::task::Task;
use rayon::prelude::*;

/// Largest number of elements with samples: the work of a model grows with the cube of their number.
const MAX_ELEMENTS: usize = 96;

/// Largest number of searches for peaks, in the samples and in the residuals of the reflectors found so far.
const MAX_SEARCHES: usize = 4;

/// Distance of peaks, in range bins and in periods of the ends' fringes, within which they are one reflector.
const MAX_PEAK_DISTANCE: [f64; 2] = [1.0, 0.75];

/// Largest length of the array, range bins: it has as many sectors.
const MAX_SECTORS: f64 = 1000.0;

/// [`MethodInfo::prior_knowledge`](crate::reconstruct::MethodInfo::prior_knowledge) of the coherent methods.
pub(super) const TOLD_TO_COHERENT: &str = "nothing about the scene or the floor; it measures the noise itself";

/// A method that finds the powers of steering vectors of both ends together.
#[derive(Debug, Clone, Copy)]
pub struct CoherentMethod {
    pub(super) about: MethodInfo,
    pub(super) update: Update,
    /// Least power of a reflector over the largest of its model.
    pub(super) min_peak_part: f64,
}

impl Reconstructor for CoherentMethod {
    fn family(&self) -> Family {
        Family::Sparse
    }

    fn info(&self) -> MethodInfo {
        self.about
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn fewest_end_elements(&self) -> usize {
        1
    }

    fn layout_support(&self) -> LayoutSupport {
        LayoutSupport::Halves
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        self.check_size(radar, radar.end_elements.saturating_mul(2))
    }

    fn check_halves(&self, halves: &Radar, elements: usize) -> Result<(), ReconstructError> {
        self.check_size(halves, elements)
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let task = &request.task;
        let hearing = NoiseModel::beneath(radar, ends, request.noise);
        let found = if radar.samples == 1 {
            // A single sample has no ranges along which reflectors could be moved.
            gains(radar, &self.peaks(radar, ends, &hearing, task)?, ends, task)?
        } else {
            let search = |ends: &TwoEnds| self.peaks(radar, ends, &hearing, task);
            found_in_residuals(radar, ends, task, search)?
        };
        Ok(of_echoes(radar, ends, &found, hearing.ends_noise_variance(radar, ends), request))
    }
}

impl CoherentMethod {
    /// Whether models can be made of `elements` elements of `radar`'s ends.
    fn check_size(&self, radar: &Radar, elements: usize) -> Result<(), ReconstructError> {
        if elements > MAX_ELEMENTS {
            return Err(self.unusable(format!(
                "its models take at most {MAX_ELEMENTS} elements, and {elements} are heard; matched-filter takes any number"
            )));
        }
        let bins = radar.bin_of_range(radar.aperture_metres());
        if radar.samples > 1 && bins > MAX_SECTORS {
            return Err(self.unusable(format!(
                "the array is {bins:.0} range bins long; a sector of directions for each bin is taken up to {MAX_SECTORS}"
            )));
        }
        no_plane_waves(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    /// Peaks of the samples of both ends, the strongest first.
    fn peaks(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        hearing: &NoiseModel,
        task: &Task,
    ) -> Result<Vec<Peak>, ReconstructError> {
        let elements = Ends::new(radar, ends);
        let sectors = Sectors::new(radar, &elements);
        // The noise bandwidth of the window is 1.5 bins.
        let noise_power = hearing.ends_noise_variance(radar, ends) * 1.5 / radar.samples as f64;
        let places = places(radar, &elements, &sectors, noise_power, task)?;
        let found: Vec<Vec<Peak>> = places
            .par_iter()
            .map(|place| {
                let powers = Model::new(radar, &elements, &sectors, place, noise_power).powers(&self.update, task)?;
                Ok(peaks(&sectors, place, &powers, self.min_peak_part))
            })
            .collect::<Result<_, ReconstructError>>()?;
        let [bins, fringes] = MAX_PEAK_DISTANCE;
        Ok(distinct(radar, found.concat(), [bins, fringes * sectors.fringe_cos]))
    }
}

/// Reflectors behind the peaks that `search` finds in `ends`, and in the residuals of those found so far.
pub(in crate::reconstruct) fn found_in_residuals(
    radar: &Radar,
    ends: &TwoEnds,
    task: &Task,
    search: impl Fn(&TwoEnds) -> Result<Vec<Peak>, ReconstructError>,
) -> Result<Vec<Gained>, ReconstructError> {
    let mut refinement = Refinement::new(radar, ends, task);
    for round in 0..MAX_SEARCHES {
        task.set_progress(0.9 * round as f32 / MAX_SEARCHES as f32);
        if !refinement.add(&search(&refinement.residual())?)? {
            break;
        }
    }
    refinement.with_model_order()?.found(ends)
}
