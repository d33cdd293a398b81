//! Campaigns: methods over many scenes, whose rows fill tables 4.1 to 4.3.

mod elements;
mod error;
mod job;
mod radar;
#[cfg(test)]
mod tests;

pub use super::shard::Shard;
pub use elements::Elements;
pub use error::{CampaignError, MethodFailure};

use super::Target;
use super::rows::{FORMAT, Row, Text, WholeRun};
use super::sets::{SceneCase, SceneSet};
use super::trial::{TimedAnswer, Trial};
use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::radar::{Radar, check_layout, ranges};
use crate::reconstruct::{Reconstructor, Request, Weights, untrained_noise};
use crate::scattering::EchoSources;
use crate::scene::generate::{Generator, Purpose, Reading};
use crate::signal::Floor;
use crate::task::Task;
use error::set_name;
use job::SceneJob;
use rayon::prelude::*;

/// The scenes on which methods are tried, and the measures of their maps.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// The radar of generated scenes.
    pub radar: Radar,
    /// The description after which scenes are generated.
    pub reading: Reading,
    /// Purpose of generated scenes; reported figures come from [`Purpose::Test`].
    pub purpose: Purpose,
    /// Seed of generated scenes.
    pub seed: u64,
    /// Number of generated scenes of each kind; of a folder's, all are tried.
    pub count: u32,
    /// Shard of the scenes that this run tries.
    pub shard: Shard,
    /// Noise of the scene.
    pub floor: Floor,
    /// Normalisation of every map.
    pub normalisation: Normalisation,
    /// A detector that is tried on every output beside the method's threshold, if there is one.
    pub cfar: Option<Cfar>,
    /// The elements that measure the scenes.
    pub elements: Elements,
    /// The map of the whole array against which outputs are compared.
    pub target: Target,
    /// Numbers of the elements whose samples methods get, in place of the two ends.
    pub layout: Option<Vec<usize>>,
}

impl Default for Campaign {
    fn default() -> Self {
        Campaign {
            radar: Radar::default(),
            reading: Reading::Program,
            purpose: Purpose::Test,
            seed: 0,
            count: 100,
            shard: Shard::default(),
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
            cfar: None,
            elements: Elements::OfScenes,
            target: Target::Measured,
            layout: None,
        }
    }
}

impl Campaign {
    /// Number of scenes of a set that this campaign tries.
    pub fn scenes(&self, set: &SceneSet) -> u32 {
        self.shard.size(set.len().unwrap_or(self.count))
    }

    /// The generator of its scenes.
    pub fn generator(&self) -> Generator {
        Generator::new(&self.radar, self.reading, self.purpose, self.seed)
    }

    /// Tries every method on the scenes of every set. `on_row` is called with each row as it is found; all are returned, sorted by set,
    /// scene and method, as they are given.
    ///
    /// Scenes are simulated in parallel, reconstructions run one after another, so that their times are those of a map alone on
    /// the machine: in an order that is drawn anew for every scene, after each has made one map that is not timed. The figures, times apart,
    /// don't depend on the order nor on the number of threads.
    /// # Errors
    /// [`CampaignError`] names the scene, and the method that failed or was cancelled through `task`.
    pub fn run(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
        task: &Task,
        mut on_row: impl FnMut(&Row),
    ) -> Result<Vec<Row>, CampaignError> {
        let empty = self.empty_rows(sets, methods)?;
        self.run_rest(sets, methods, &empty, &|_, _, _| false, task, |row, _, _| on_row(row))
    }

    /// [`Campaign::run`], continued without a method where it fails on a scene. The answer is the rows found, and the methods that failed.
    /// # Errors
    /// As [`Campaign::run`], but for methods that fail.
    pub fn run_fit(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
        task: &Task,
        on_row: impl FnMut(&Row, &Trial, &TimedAnswer),
    ) -> Result<(Vec<Row>, Vec<MethodFailure>), CampaignError> {
        let empty = self.empty_rows(sets, methods)?;
        let mut unfit: Vec<MethodFailure> = Vec::new();
        let rows = self.run_through(sets, methods, &empty, &|_, _, _| false, task, on_row, |error| {
            MethodFailure::note(&mut unfit, error)
        })?;
        Ok((rows, unfit))
    }

    /// Rows without figures, one a set and method: only the columns that say how the rows of this campaign are made.
    /// # Errors
    /// [`CampaignError`] for an unreadable folder, a kind that finds no room before the radar, and a set or method that is there twice.
    pub fn empty_rows(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
    ) -> Result<Vec<Vec<Row>>, CampaignError> {
        for set in sets {
            if let SceneSet::Generated(kind) = set {
                kind.check_room(&self.radar)?;
            }
        }
        let counted = |set: &SceneSet| (set.to_string(), set.len().unwrap_or(self.count));
        let names = methods.iter().map(|method| method.name().to_owned()).collect();
        let whole = WholeRun::new(sets.iter().map(counted).collect(), names).map_err(CampaignError::Refused)?;
        let of_all = Row {
            version: Some(FORMAT),
            program: env!("CARGO_PKG_VERSION").into(),
            normalisation: Some(self.normalisation),
            shard: Some(self.shard),
            whole: whole.sets_text().into(),
            methods: whole.methods_text().into(),
            cfar: self.cfar.map(Text::from).unwrap_or_default(),
            elements: self.elements.text().into(),
            target: self.target.to_string().into(),
            layout: self.layout.as_deref().map(ranges).unwrap_or_default().into(),
            ..Row::default()
        };
        let of_set = |set: &SceneSet| -> Result<Vec<Row>, CampaignError> {
            let of_set = Row { set: set.to_string().into(), floor: Some(set.floor(self.floor)), ..of_all.clone() };
            let of_set = match set {
                SceneSet::Folder(folder) => Row { scenes: folder.fingerprint()?.into(), ..of_set },
                SceneSet::Listed(listed) => Row { scenes: listed.fingerprint().into(), ..of_set },
                SceneSet::Generated(_) => Row {
                    seed: self.seed,
                    purpose: Some(self.purpose),
                    reading: Some(self.reading),
                    carrier: Some(self.radar.carrier),
                    radar: radar::text(&self.radar).into(),
                    ..of_set
                },
            };
            let of_method = |method: &&dyn Reconstructor| {
                let Weights { sha256, optimiser } = method.weights(&self.radar).unwrap_or_default();
                let method = method.name().into();
                Row { method, weights: sha256.into(), optimiser: optimiser.into(), ..of_set.clone() }
            };
            Ok(methods.iter().map(of_method).collect())
        };
        sets.iter().map(of_set).collect()
    }

    /// [`Campaign::run`] without the rows that exist already: `is_done` tells whether the row of a set, scene and method exists. `empty` are
    /// [`Campaign::empty_rows`].
    /// # Errors
    /// As [`Campaign::run`].
    pub fn run_rest(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
        empty: &[Vec<Row>],
        is_done: &dyn Fn(&str, u32, &str) -> bool,
        task: &Task,
        on_row: impl FnMut(&Row, &Trial, &TimedAnswer),
    ) -> Result<Vec<Row>, CampaignError> {
        self.run_through(sets, methods, empty, is_done, task, on_row, Err)
    }

    /// [`Campaign::run_rest`] whose `on_failure` decides whether the campaign continues after a method's failure.
    #[expect(clippy::too_many_arguments, reason = "what a campaign is run on, and two calls back")]
    fn run_through(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
        empty: &[Vec<Row>],
        is_done: &dyn Fn(&str, u32, &str) -> bool,
        task: &Task,
        mut on_row: impl FnMut(&Row, &Trial, &TimedAnswer),
        mut on_failure: impl FnMut(CampaignError) -> Result<(), CampaignError>,
    ) -> Result<Vec<Row>, CampaignError> {
        let generator = self.generator();
        let request = |floor: Floor| {
            let normalisation = self.normalisation;
            Request { noise: floor.into(), normalisation, task: task.clone(), ..Request::default() }
        };
        let mut rows = Vec::new();
        let mut warm = false;
        for (set, empty) in sets.iter().zip(empty) {
            let (count, name) = (set.len().unwrap_or(self.count), set.to_string());
            let request = request(set.floor(self.floor));
            let rest = |index| -> Vec<usize> {
                (0..methods.len()).filter(|i| !is_done(&name, index, methods[*i].name())).collect()
            };
            let numbers: Vec<u32> = (0..count).filter(|&n| self.shard.contains(n) && !rest(n).is_empty()).collect();
            for batch in numbers.chunks(rayon::current_num_threads()) {
                let trials: Result<Vec<Trial>, _> =
                    batch.par_iter().map(|&index| self.trial(set, &generator, index)).collect();
                for (trial, &index) in trials?.iter().zip(batch) {
                    let job = SceneJob { cfar: self.cfar, set, index, trial, request: &request, empty };
                    if !std::mem::replace(&mut warm, true) {
                        // A method that fails in this untimed run fails again in the timed one, where its row is asked for.
                        methods.iter().for_each(|&method| drop(job.answer(method)));
                    }
                    rows.extend(job.rows(methods, rest(index), &mut on_row, &mut on_failure)?);
                }
            }
        }
        Ok(rows)
    }

    /// Sentences, one a set and method, with the number of scenes whose noise the method was not trained on; none where that number is 0.
    /// # Errors
    /// [`CampaignError`] names a scene that can't be read.
    pub fn untrained(&self, sets: &[SceneSet], methods: &[&dyn Reconstructor]) -> Result<Vec<String>, CampaignError> {
        let generator = self.generator();
        let mut told = Vec::new();
        for set in sets {
            let floor = set.floor(self.floor);
            let trained: Vec<_> =
                methods.iter().filter(|m| floor != Floor::Thesis && m.trained_noise().is_some()).collect();
            if trained.is_empty() {
                continue;
            }
            let count = set.len().unwrap_or(self.count);
            let mut said = vec![(0, None); trained.len()];
            for index in (0..count).filter(|&n| self.shard.contains(n)) {
                let SceneCase { radar, scene } = set.case(&self.radar, &generator, index)?;
                let echoing = EchoSources::of(&radar, &scene);
                for (said, method) in said.iter_mut().zip(&trained) {
                    if let Some(why) = untrained_noise(**method, &radar, &echoing, floor) {
                        *said = (said.0 + 1, said.1.take().or(Some(why)));
                    }
                }
            }
            let (name, all) = (set_name(set), self.shard.size(count));
            told.extend(said.into_iter().filter_map(|(scenes, why)| {
                Some(format!(
                    "{scenes} of {all} scenes of {name} lie over noise outside the training's, the first: {}",
                    why?
                ))
            }));
        }
        Ok(told)
    }

    /// Reads or generates scene `index` of a set, and simulates it.
    /// # Errors
    /// [`CampaignError`] names the scene.
    pub fn trial(&self, set: &SceneSet, generator: &Generator, index: u32) -> Result<Trial, CampaignError> {
        let SceneCase { radar, mut scene } = set.case(&self.radar, generator, index)?;
        let fits = |layout: &Vec<usize>| check_layout(layout, radar.elements).map_err(CampaignError::Refused);
        self.layout.as_ref().map_or(Ok(()), fits)?;
        if let Some(elements) = self.elements.of(&radar, self.seed, index) {
            scene.disturbances.elements = elements;
        }
        let trial = Trial::against(
            self.target,
            self.layout.as_deref(),
            &radar,
            &scene,
            set.floor(self.floor),
            self.normalisation,
        )
        .map_err(|error| CampaignError::Refused(format!("scene {index} of {}: {error}", set_name(set))))?;
        trial.footprints();
        Ok(trial)
    }
}
