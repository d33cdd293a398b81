//! Methods over many test scenes: what fills tables 4.1 to 4.3.

use super::tables::Tally;
use super::{Metrics, Roc};
use crate::maps::{self, Aperture, Normalisation, RangeAngleMap};
use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Reconstructor, Request};
use crate::scene::SceneError;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::{self, Floor, TwoEnds};
use crate::task::Task;
use rayon::prelude::*;
use std::time::Instant;

/// Which scenes methods are tried on.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// The radar.
    pub radar: Radar,
    /// How scenes are made.
    pub reading: Reading,
    /// What the scenes are for; reported figures come from [`Purpose::Test`].
    pub purpose: Purpose,
    /// Seed of the scenes and of the noise.
    pub seed: u64,
    /// Number of scenes of each kind.
    pub count: u32,
    /// What lies beneath the reflectors.
    pub floor: Floor,
    /// How every map is normalised.
    pub normalisation: Normalisation,
}

impl Default for Campaign {
    /// The tables' conventions: 100 test scenes over the thesis floor.
    fn default() -> Self {
        Campaign {
            radar: Radar::default(),
            reading: Reading::Program,
            purpose: Purpose::Test,
            seed: 0,
            count: 100,
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
        }
    }
}

/// Why a campaign stopped.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CampaignError {
    /// A generated scene can't be simulated.
    #[error("scene {number} of {kind:?}: {source}")]
    Scene {
        /// Kind of the scene.
        kind: Kind,
        /// Number of the scene.
        number: u32,
        /// Why.
        source: SceneError,
    },
    /// A method failed.
    #[error("{method} on scene {number} of {kind:?}: {source}")]
    Method {
        /// Name of the method.
        method: &'static str,
        /// Kind of the scene.
        kind: Kind,
        /// Number of the scene.
        number: u32,
        /// Why.
        source: ReconstructError,
    },
}

/// A scene as a method meets it.
struct Trial {
    number: u32,
    ends: TwoEnds,
    target: RangeAngleMap,
}

impl Campaign {
    /// Tries every method on the scenes of one kind; one [`Tally`] a method, in their order.
    ///
    /// Scenes are simulated in parallel, reconstructions run one after another, so that their times are those of a map alone on
    /// the machine. The figures, times apart, don't depend on the number of threads. `on_map` is called after every map.
    ///
    /// # Errors
    /// [`CampaignError`] names the scene, and the method that failed or was cancelled through `task`.
    pub fn run(
        &self,
        kind: Kind,
        methods: &[&dyn Reconstructor],
        task: &Task,
        mut on_map: impl FnMut(),
    ) -> Result<Vec<Tally>, CampaignError> {
        let generator = Generator::new(&self.radar, self.reading, self.purpose, self.seed);
        let request = Request { floor: self.floor, normalisation: self.normalisation, task: task.clone() };
        let mut tallies = vec![Tally::default(); methods.len()];
        let numbers: Vec<u32> = (0..self.count).collect();
        for batch in numbers.chunks(rayon::current_num_threads()) {
            let trials: Result<Vec<Trial>, _> =
                batch.par_iter().map(|&number| self.trial(&generator, kind, number)).collect();
            for trial in trials? {
                for (method, tally) in methods.iter().zip(&mut tallies) {
                    let start = Instant::now();
                    let found = task
                        .check()
                        .map_err(ReconstructError::from)
                        .and_then(|()| method.reconstruct(&self.radar, &trial.ends, &request))
                        .map_err(|source| CampaignError::Method {
                            method: method.name(),
                            kind,
                            number: trial.number,
                            source,
                        })?;
                    let milliseconds = start.elapsed().as_secs_f64() * 1e3;
                    let metrics = Metrics::of(&trial.target, &found.lambda, method.eta());
                    tally.add(&metrics, |roc: &mut Roc| roc.add(&trial.target, &found.lambda), milliseconds);
                    on_map();
                }
            }
        }
        Ok(tallies)
    }

    fn trial(&self, generator: &Generator, kind: Kind, number: u32) -> Result<Trial, CampaignError> {
        let scene = generator.scene(kind, number);
        let noise_seed = generator.noise_seed(kind, number);
        let signal = signal::simulate(&self.radar, &scene, self.floor, noise_seed)
            .map_err(|source| CampaignError::Scene { kind, number, source })?;
        let profiles = maps::range_transform(&self.radar, &signal);
        let full = maps::angle_transform(&self.radar, &profiles, Aperture::Full).log_magnitude();
        Ok(Trial { number, ends: signal.two_ends(&self.radar), target: full.normalise(self.normalisation) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::Baseline;

    #[test]
    fn a_campaign_repeats_itself_and_can_be_cancelled() {
        let campaign = Campaign { count: 3, seed: 3, ..Campaign::default() };
        let run = |task: &Task| campaign.run(Kind::Set1, &[&Baseline], task, || ());
        let (a, b) = (run(&Task::default()).unwrap(), run(&Task::default()).unwrap());
        assert_eq!(a[0].squared_error(), b[0].squared_error());
        assert_eq!((a[0].scenes(), a[0].roc().scenes()), (3, 3));
        let task = Task::default();
        task.cancel();
        let stopped = run(&task).unwrap_err();
        assert!(matches!(stopped, CampaignError::Method { source: ReconstructError::Cancelled, .. }), "{stopped}");
    }
}
