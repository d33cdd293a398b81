//! Methods over many scenes: what fills tables 4.1 to 4.3, row by row.

use super::rows::Row;
use super::sets::{Case, SceneSet};
use super::trial::{Answer, RowPlace, Trial};
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::reconstruct::{ReconstructError, Reconstructor, Request, untrained_noise};
use crate::scene::SceneError;
use crate::scene::file::SceneFileError;
use crate::scene::generate::{Generator, Purpose, Reading};
use crate::signal::Floor;
use crate::task::Task;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// Which scenes methods are tried on.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// The radar of generated scenes.
    pub radar: Radar,
    /// How generated scenes are made.
    pub reading: Reading,
    /// What generated scenes are for; reported figures come from [`Purpose::Test`].
    pub purpose: Purpose,
    /// Seed of generated scenes.
    pub seed: u64,
    /// Number of generated scenes of each kind; of a folder's, all are tried.
    pub count: u32,
    /// Which of them are this run's.
    pub shard: Shard,
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
            shard: Shard::default(),
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
        }
    }
}

/// Every `of`-th scene, from scene `part` on: runs on several machines that together do all. Written and read as "0/4".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    part: u32,
    of: u32,
}

impl Default for Shard {
    /// All scenes.
    fn default() -> Self {
        Shard { part: 0, of: 1 }
    }
}

impl Shard {
    /// Whether scene `index` is this shard's.
    pub fn contains(self, index: u32) -> bool {
        index % self.of == self.part
    }

    /// How many of the scenes 0 to `count - 1` are this shard's.
    pub fn size(self, count: u32) -> u32 {
        count.saturating_sub(self.part).div_ceil(self.of)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let parts = s.split_once('/').and_then(|(part, of)| Some((part.trim().parse().ok()?, of.trim().parse().ok()?)));
        match parts {
            Some((part, of)) if part < of => Ok(Shard { part, of }),
            _ => Err(format!("\"{s}\" is no part of a whole; expected I/N with I from 0 to N - 1, as in 0/4")),
        }
    }
}

/// Why a campaign stopped.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// A scene can't be simulated.
    #[error("scene {index} of {set}: {source}")]
    Scene {
        /// The set.
        set: String,
        /// Number of the scene.
        index: u32,
        /// Why.
        source: SceneError,
    },
    /// A scene can't be read.
    #[error(transparent)]
    File(#[from] SceneFileError),
    /// A method failed.
    #[error("{method} on scene {index} of {set}: {source}")]
    Method {
        /// Name of the method.
        method: &'static str,
        /// The set.
        set: String,
        /// Number of the scene.
        index: u32,
        /// Why.
        source: ReconstructError,
    },
}

impl CampaignError {
    /// Whether somebody asked it to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, CampaignError::Method { source: ReconstructError::Cancelled, .. })
    }
}

impl Campaign {
    /// How many of a set's scenes this campaign tries.
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
    ///
    /// # Errors
    /// [`CampaignError`] names the scene, and the method that failed or was cancelled through `task`.
    pub fn run(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
        task: &Task,
        mut on_row: impl FnMut(&Row),
    ) -> Result<Vec<Row>, CampaignError> {
        self.run_watched(sets, methods, task, |row, _, _| on_row(row))
    }

    /// [`Campaign::run`], with what each row was made of.
    ///
    /// # Errors
    /// As [`Campaign::run`].
    pub fn run_watched(
        &self,
        sets: &[SceneSet],
        methods: &[&dyn Reconstructor],
        task: &Task,
        mut on_row: impl FnMut(&Row, &Trial, &Answer),
    ) -> Result<Vec<Row>, CampaignError> {
        let generator = self.generator();
        let request = |floor| {
            let normalisation = self.normalisation;
            Request { floor, normalisation, task: task.clone(), ..Request::default() }
        };
        let mut rows = Vec::new();
        let mut warm = false;
        for set in sets {
            let count = set.len().unwrap_or(self.count);
            let request = request(set.floor(self.floor));
            let numbers: Vec<u32> = (0..count).filter(|&n| self.shard.contains(n)).collect();
            for batch in numbers.chunks(rayon::current_num_threads()) {
                let trials: Result<Vec<Trial>, _> =
                    batch.par_iter().map(|&index| self.trial(set, &generator, index)).collect();
                for (trial, &index) in trials?.iter().zip(batch) {
                    let job = Job { campaign: self, set, index, trial, request: &request };
                    if !std::mem::replace(&mut warm, true) {
                        methods.iter().try_for_each(|&method| job.answer(method).map(drop))?;
                    }
                    rows.extend(job.rows(methods, &mut on_row)?);
                }
            }
        }
        Ok(rows)
    }

    /// For each set and method, on how many of the scenes the method was trained on other noise, in words; nothing where on none.
    ///
    /// # Errors
    /// [`CampaignError`] names a scene that can't be read.
    pub fn untrained(&self, sets: &[SceneSet], methods: &[&dyn Reconstructor]) -> Result<Vec<String>, CampaignError> {
        let generator = self.generator();
        let mut told = Vec::new();
        for set in sets {
            let floor = set.floor(self.floor);
            let trained: Vec<_> =
                methods.iter().filter(|m| floor.is_thermal() && m.trained_noise().is_some()).collect();
            if trained.is_empty() {
                continue;
            }
            let count = set.len().unwrap_or(self.count);
            let mut said = vec![(0, None); trained.len()];
            for index in (0..count).filter(|&n| self.shard.contains(n)) {
                let Case { radar, scene } = set.case(&self.radar, &generator, index)?;
                let reflectors = scene.reflectors();
                for (said, method) in said.iter_mut().zip(&trained) {
                    if let Some(why) = untrained_noise(**method, &radar, &reflectors, floor) {
                        *said = (said.0 + 1, said.1.take().or(Some(why)));
                    }
                }
            }
            let (name, all) = (set_name(set), self.shard.size(count));
            told.extend(said.into_iter().filter_map(|(scenes, why)| {
                Some(format!(
                    "{scenes} of {all} scenes of {name} have noise that was not trained on, the first: {}",
                    why?
                ))
            }));
        }
        Ok(told)
    }

    /// Reads or makes a scene, simulates it, and finds where its objects show.
    ///
    /// # Errors
    /// [`CampaignError`] names the scene.
    pub fn trial(&self, set: &SceneSet, generator: &Generator, index: u32) -> Result<Trial, CampaignError> {
        let Case { radar, scene } = set.case(&self.radar, generator, index)?;
        let trial = Trial::new(&radar, &scene, set.floor(self.floor), self.normalisation)
            .map_err(|source| CampaignError::Scene { set: set_name(set), index, source })?;
        trial.footprints();
        Ok(trial)
    }
}

fn set_name(set: &SceneSet) -> String {
    match set {
        SceneSet::Generated(kind) if kind.test_set().is_some() => format!("set {kind}"),
        set => set.to_string(),
    }
}

/// All methods on one scene.
struct Job<'a> {
    campaign: &'a Campaign,
    set: &'a SceneSet,
    index: u32,
    trial: &'a Trial,
    request: &'a Request,
}

impl Job<'_> {
    fn answer(&self, method: &dyn Reconstructor) -> Result<Answer, CampaignError> {
        self.trial.ask(method, self.request).map_err(|source| CampaignError::Method {
            method: method.name(),
            set: set_name(self.set),
            index: self.index,
            source,
        })
    }

    /// One row a method, in their order.
    fn rows(
        &self,
        methods: &[&dyn Reconstructor],
        on_row: &mut impl FnMut(&Row, &Trial, &Answer),
    ) -> Result<Vec<Row>, CampaignError> {
        let set = self.set.to_string();
        let seed = if matches!(self.set, SceneSet::Generated(_)) { self.campaign.seed } else { 0 };
        let place = RowPlace { set: &set, index: self.index, seed };
        let mut order: Vec<usize> = (0..methods.len()).collect();
        order.shuffle(&mut ChaCha8Rng::seed_from_u64(u64::from(self.index)));
        let mut found = Vec::new();
        for i in order {
            let answer = self.answer(methods[i])?;
            let row = self.trial.row(place, methods[i].name(), &answer, self.set.false_alarm());
            on_row(&row, self.trial, &answer);
            found.push((i, row));
        }
        found.sort_by_key(|(i, _)| *i);
        Ok(found.into_iter().map(|(_, row)| row).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::{BARTLETT, Baseline};
    use crate::scene::generate::Kind;

    /// Rows without their times.
    fn figures(rows: &[Row]) -> Vec<Row> {
        rows.iter().map(|r| Row { milliseconds: 0.0, ..r.clone() }).collect()
    }

    #[test]
    fn a_campaign_repeats_itself_and_its_shards_add_up_to_it() {
        let sets = [SceneSet::Generated(Kind::Set1), SceneSet::Generated(Kind::Set2)];
        let run = |shard: &str| {
            let campaign = Campaign { count: 3, seed: 3, shard: shard.parse().unwrap(), ..Campaign::default() };
            let mut seen = 0;
            let rows = campaign.run(&sets, &[&Baseline, &BARTLETT], &Task::default(), |_| seen += 1).unwrap();
            assert_eq!(rows.len(), seen);
            figures(&rows)
        };
        let whole = run("0/1");
        assert_eq!(
            whole.iter().map(|r| (r.set.as_str(), r.index)).collect::<Vec<_>>()[2..6],
            [("1", 1), ("1", 1), ("1", 2), ("1", 2)]
        );
        assert_eq!(whole.len(), 12);
        assert_ne!(whole[0].squared_error, whole[2].squared_error);
        let shards = vec![("a".into(), run("1/2")), ("b".into(), run("0/2"))];
        assert_eq!(super::super::rows::merge(shards).unwrap(), whole);
    }

    #[test]
    fn scenes_of_noise_alone_have_no_detection_rate() {
        let campaign = Campaign { count: 2, ..Campaign::default() };
        let sets = [SceneSet::Generated(Kind::Noise)];
        let rows = campaign.run(&sets, &[&Baseline, &BARTLETT], &Task::default(), |_| ()).unwrap();
        assert_eq!(rows.len(), 4);
        for row in rows {
            assert_eq!(
                (row.set.as_str(), row.objects, row.detection, row.detection_at_printed),
                ("noise", 0, None, None)
            );
            assert_eq!((row.false_alarm, row.ghosts), (0.0, 0), "{}", row.method);
            assert!(row.squared_error > 1.0, "the target is noise");
        }
    }

    #[test]
    fn a_campaign_can_be_cancelled() {
        let task = Task::default();
        task.cancel();
        let sets = [SceneSet::Generated(Kind::Set1)];
        let stopped = Campaign::default().run(&sets, &[&Baseline], &task, |_| ()).unwrap_err();
        assert!(stopped.is_cancelled() && stopped.to_string().contains("scene 0 of set 1"), "{stopped}");
    }

    #[test]
    fn shards_share_all_scenes() {
        for (count, of) in [(10, 3), (2, 5), (0, 2), (7, 1)] {
            let shards: Vec<Shard> = (0..of).map(|part| Shard { part, of }).collect();
            assert_eq!(shards.iter().map(|s| s.size(count)).sum::<u32>(), count);
            for s in shards {
                assert_eq!((0..count).filter(|&n| s.contains(n)).count() as u32, s.size(count), "{s}");
            }
        }
        assert_eq!("1/4".parse(), Ok(Shard { part: 1, of: 4 }));
        for wrong in ["4/4", "1", "a/b", "0/0", "-1/2"] {
            assert!(wrong.parse::<Shard>().is_err_and(|e| e.contains(wrong)));
        }
    }
}
