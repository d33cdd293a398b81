//! The threshold at which a method keeps a rate of false alarms on further scenes like those that it was tried on.

use super::campaign::CampaignError;
use super::trial::Trial;
use super::{Roc, RocPoint, Target, detection_rates};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{Radar, check_layout, counted};
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::Floor;
use crate::task::Task;
use std::fmt;

/// A search for a threshold on validation scenes of some kinds, after the author's program.
#[derive(Debug, Clone, PartialEq)]
pub struct ThresholdSearch {
    /// The radar of the scenes.
    pub radar: Radar,
    /// Numbers of the elements whose samples the method gets in place of the two ends.
    pub layout: Option<Vec<usize>>,
    /// Noise of the scenes.
    pub floor: Floor,
    /// Normalisation of every map.
    pub normalisation: Normalisation,
    /// Kinds of scenes, each once.
    pub kinds: Vec<Kind>,
    /// Scenes of each kind.
    pub count: u32,
    /// Seed of the scenes.
    pub seed: u64,
    /// The rate of false alarms to keep, percent of the cells that are dark in the target; above 0 and below 100.
    pub false_alarm_percent: f64,
}

impl Default for ThresholdSearch {
    fn default() -> Self {
        ThresholdSearch {
            radar: Radar::default(),
            layout: None,
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
            kinds: vec![Kind::Set1, Kind::Set2, Kind::Set3],
            count: 100,
            seed: 0,
            false_alarm_percent: 1.0,
        }
    }
}

/// A threshold, with its rates on the scenes that chose it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeptThreshold {
    /// The threshold of Lambda.
    pub eta: f32,
    /// P_FA and P_D at the threshold.
    pub tried: ThresholdMeans,
}

/// Means over scenes.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct ThresholdMeans {
    /// Scenes with target cells.
    pub scenes: usize,
    /// P_FA, 0 to 1.
    pub false_alarm: f64,
    /// P_D, 0 to 1.
    pub detection: f64,
}

impl ThresholdSearch {
    /// Tries `method` on every scene, and gives the lowest threshold that keeps the rate ([`Roc::keeping_false_alarm`]): the mean of P_FA over
    /// further scenes that are exchangeable with these is at most the rate. `on_part` receives the part that is done, 0 to 1.
    /// # Errors
    /// [`CampaignError`]; it names the scene that failed, and [`CampaignError::is_cancelled`] after `task` was cancelled.
    pub fn run(
        &self,
        method: &dyn Reconstructor,
        task: &Task,
        on_part: impl FnMut(f32),
    ) -> Result<KeptThreshold, CampaignError> {
        self.check()?;
        let mut roc = Roc::default();
        self.each(method, [0, self.count], task, on_part, |target, output| roc.add(target, output))?;
        let unreached = || refused(format!("no threshold keeps {} % on these scenes", self.false_alarm_percent));
        let found = roc.keeping_false_alarm(self.rate());
        let RocPoint { eta, detection, false_alarm } = found.ok_or_else(unreached)?;
        Ok(KeptThreshold { eta, tried: ThresholdMeans { scenes: roc.scenes(), false_alarm, detection } })
    }

    /// The rates at `eta` on `count` further scenes of each kind, which did not choose it.
    /// # Errors
    /// As [`ThresholdSearch::run`].
    pub fn try_further(
        &self,
        method: &dyn Reconstructor,
        eta: f32,
        count: u32,
        task: &Task,
        on_part: impl FnMut(f32),
    ) -> Result<ThresholdMeans, CampaignError> {
        let mut sums = ThresholdMeans::default();
        self.each(method, [self.count, count], task, on_part, |target, output| {
            let (detection, false_alarm) = detection_rates(target, output, eta);
            if let Some(detection) = detection {
                sums.scenes += 1;
                sums.detection += detection;
                sums.false_alarm += false_alarm;
            }
        })?;
        let scenes = sums.scenes.max(1) as f64;
        Ok(ThresholdMeans { detection: sums.detection / scenes, false_alarm: sums.false_alarm / scenes, ..sums })
    }

    /// A sentence with the part of the rate that is left to P_FA on `scenes` scenes, and the number of scenes with nine tenths of it.
    pub fn margin_sentence(&self, scenes: usize) -> String {
        let (percent, left, fewest) =
            (self.false_alarm_percent, 100.0 * self.left_to_scenes(scenes), self.scenes_within_a_tenth());
        let scenes = counted(scenes, "scene", "scenes");
        format!(
            "for {percent} % on further scenes, P_FA on {scenes} may be {left:.3} %: the rest is the price of few scenes, a tenth or less from {fewest} \
             scenes on"
        )
    }

    /// [`Roc::left_to_scenes`] of the rate, a fraction.
    pub fn left_to_scenes(&self, scenes: usize) -> f64 {
        Roc::left_to_scenes(scenes, self.rate())
    }

    /// [`Roc::scenes_within_a_tenth`] of the rate.
    pub fn scenes_within_a_tenth(&self) -> u64 {
        Roc::scenes_within_a_tenth(self.rate())
    }

    fn rate(&self) -> f64 {
        self.false_alarm_percent / 100.0
    }

    /// Checks the settings before any scene is tried.
    /// # Errors
    /// [`CampaignError`] of the first setting that can't be used.
    pub fn check(&self) -> Result<(), CampaignError> {
        let percent = self.false_alarm_percent;
        if !(percent > 0.0 && percent < 100.0) {
            let expected = "expected more than 0 and less than 100";
            return Err(refused(format!("a rate of {percent} % of false alarms can't be kept; {expected}")));
        }
        if self.kinds.contains(&Kind::Noise) {
            let noise = Kind::Noise;
            return Err(refused(format!(
                "scenes of the kind \"{noise}\" have no echoes, and so no P_D to set against P_FA"
            )));
        }
        self.layout.iter().try_for_each(|layout| check_layout(layout, self.radar.elements)).map_err(refused)?;
        self.kinds.iter().try_for_each(|kind| kind.check_room(&self.radar)).map_err(refused)?;
        let twice = self.kinds.iter().enumerate().find(|(i, kind)| self.kinds[..*i].contains(kind));
        if let Some((_, kind)) = twice {
            return Err(refused(format!("the kind \"{kind}\" is given twice; expected each kind once")));
        }
        let (scenes, fewest) = (self.count as usize * self.kinds.len(), Roc::fewest_scenes(self.rate()));
        if (scenes as f64) < fewest {
            let scenes = counted(scenes, "scene", "scenes");
            return Err(refused(format!("{scenes} can't keep a rate of {percent} %; take {fewest} scenes or more")));
        }
        Ok(())
    }

    fn each(
        &self,
        method: &dyn Reconstructor,
        [first, count]: [u32; 2],
        task: &Task,
        mut on_part: impl FnMut(f32),
        mut judge: impl FnMut(&RangeAngleMap, &RangeAngleMap),
    ) -> Result<(), CampaignError> {
        let generator = Generator::new(&self.radar, Reading::Program, Purpose::Validation, self.seed);
        let (noise, normalisation) = (self.floor.into(), self.normalisation);
        // The progress of a single map is not that of the search.
        let request = Request { noise, normalisation, task: task.quiet(), ..Request::default() };
        let total = count as f32 * self.kinds.len() as f32;
        let mut done = 0.0;
        for &kind in &self.kinds {
            for index in first..first.saturating_add(count) {
                let scene = generator.scene(kind, index);
                let layout = self.layout.as_deref();
                let trial =
                    Trial::against(Target::Measured, layout, &self.radar, &scene, self.floor, self.normalisation)
                        .map_err(|source| refused(format!("scene {index} of {kind}: {source}")))?;
                let failed =
                    |source| CampaignError::Method { method: method.name(), set: kind.to_string(), index, source };
                let answer = trial.ask(method, &request).map_err(failed)?;
                judge(&trial.target, &answer.found.lambda);
                done += 1.0;
                on_part(done / total);
            }
        }
        Ok(())
    }
}

fn refused(why: impl fmt::Display) -> CampaignError {
    CampaignError::Refused(why.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::Baseline;

    fn search() -> ThresholdSearch {
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let kinds = vec![Kind::Set1, Kind::Set2];
        ThresholdSearch { radar, kinds, count: 3, false_alarm_percent: 40.0, ..ThresholdSearch::default() }
    }

    #[test]
    fn what_cannot_be_kept_is_said_before_anything_is_tried() {
        let told = search().margin_sentence(6);
        assert!(told.starts_with("for 40 % on further scenes, P_FA on 6 scenes may be 30.000 %"), "{told}");
        assert!(told.ends_with("from 15 scenes on"), "{told}");
        let says = |search: ThresholdSearch, expected: &str| {
            let error = search.run(&Baseline, &Task::default(), |_| panic!("nothing is tried")).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
        };
        let percent = |false_alarm_percent| ThresholdSearch { false_alarm_percent, ..search() };
        says(percent(1.0), "6 scenes can't keep a rate of 1 %; take 99 scenes or more");
        says(percent(0.0), "a rate of 0 % of false alarms can't be kept");
        says(percent(100.0), "less than 100");
        says(percent(f64::NAN), "NaN");
        says(ThresholdSearch { kinds: Vec::new(), ..search() }, "0 scenes can't keep");
        says(ThresholdSearch { kinds: vec![Kind::Noise], ..search() }, "\"noise\" have no echoes");
        says(ThresholdSearch { kinds: vec![Kind::Set2, Kind::Set1, Kind::Set2], ..search() }, "\"2\" is given twice");
    }
}
