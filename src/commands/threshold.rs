//! `apertura threshold`: the threshold at which a method keeps a rate of false alarms.

use super::arguments::{FloorArgs, real, seed, whole};
use super::own_method::OwnMethodArgs;
use super::{CommandError, print};
use crate::evaluate::trial::Trial;
use crate::evaluate::{Roc, RocPoint, detection_rates};
use crate::methods;
use crate::radar::{Radar, counted};
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use serde::Serialize;

/// Find the threshold at which a method's false alarms stay below a rate on further scenes like those that it was tried on
///
/// The method is tried on random validation scenes. The threshold is the lowest one with (n P_FA + 1) / (n + 1) below the rate, where P_FA
/// is the mean over the n scenes (conformal risk control; Angelopoulos et al., ICLR 2024). On a further scene that is drawn like these,
/// P_FA is then below the rate on average. This holds for no other kinds, floors or radars, and not for each single scene. A rate of 1 %
/// takes 99 scenes or more. --check tries the threshold on further scenes.
///
/// With --json one object is printed: method, sets, floor, seed, wanted, eta, scenes, false_alarm and detection (means over the scenes
/// tried), and check (null without --check; scenes, false_alarm, detection). Rates are fractions, not percent.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The method
    #[arg(long, value_name = "NAME", default_value = "live")]
    method: String,

    #[command(flatten)]
    own: OwnMethodArgs,

    /// Part of the cells that are dark in the target which may exceed the threshold, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0, value_parser = real(0.01..=50.0))]
    false_alarm: f64,

    /// Test sets or other kinds of scenes with echoes, separated by commas
    #[arg(long, value_name = "1,2,3,KIND,..", value_delimiter = ',', default_value = "1,2,3")]
    set: Vec<Kind>,

    /// Scenes of each kind
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = whole(1..=100_000u32))]
    count: u32,

    /// Seed of the scenes
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed)]
    seed: u64,

    /// Try the threshold on N further scenes of each kind
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = whole(0..=100_000u32))]
    check: u32,

    #[command(flatten)]
    floor: FloorArgs,

    /// Print one JSON object instead of text
    #[arg(long)]
    json: bool,
}

/// What was found; its JSON is documented in the command's help.
#[derive(Debug, Serialize)]
struct Report {
    method: String,
    sets: Vec<String>,
    floor: String,
    seed: u64,
    wanted: f64,
    eta: f32,
    #[serde(flatten)]
    tried: Tried,
    check: Option<Tried>,
}

/// Means over scenes.
#[derive(Debug, Serialize)]
struct Tried {
    scenes: usize,
    false_alarm: f64,
    detection: f64,
}

impl Args {
    /// Tries the method, and prints the threshold.
    pub fn run(self) -> Result<(), CommandError> {
        self.own.start()?;
        if self.set.contains(&Kind::Noise) {
            return Err(CommandError::failed(
                "scenes of the kind \"noise\" have no echoes, and so no P_D to set against P_FA",
            ));
        }
        let method = methods::by_name(self.method.trim()).map_err(CommandError::failed)?;
        let wanted = self.false_alarm / 100.0;
        let scenes = self.count as usize * self.set.len();
        let fewest = Roc::fewest_scenes(wanted);
        if (scenes as f64) < fewest {
            let had = counted(scenes, "scene", "scenes");
            let told = format!("{had} can't keep a rate of {} %; take {fewest} scenes or more", self.false_alarm);
            return Err(CommandError::failed(told));
        }
        let mut roc = Roc::default();
        self.each(&*method, 0, self.count, |target, output| roc.add(target, output))?;
        let RocPoint { eta, detection, false_alarm } = roc.keeping_false_alarm(wanted).ok_or_else(|| {
            CommandError::failed(format!("no threshold keeps {} % on these scenes", self.false_alarm))
        })?;
        let report = Report {
            method: method.name().to_owned(),
            sets: self.set.iter().map(Kind::to_string).collect(),
            floor: self.floor.floor.to_string(),
            seed: self.seed,
            wanted,
            eta,
            tried: Tried { scenes: roc.scenes(), false_alarm, detection },
            check: if self.check > 0 { Some(self.checked(&*method, eta)?) } else { None },
        };
        match self.json {
            true => print(&serde_json::to_string_pretty(&report).map_err(CommandError::failed)?),
            false => print(&report.text()),
        }
    }

    /// Tries `method` on the scenes of every kind from number `first` on, and hands target and output over.
    fn each(
        &self,
        method: &dyn Reconstructor,
        first: u32,
        count: u32,
        mut judge: impl FnMut(&crate::maps::RangeAngleMap, &crate::maps::RangeAngleMap),
    ) -> Result<(), CommandError> {
        let radar = Radar::default();
        let generator = Generator::new(&radar, Reading::Program, Purpose::Validation, self.seed);
        let request = Request { noise: self.floor.floor.into(), ..Request::default() };
        let bar = indicatif::ProgressBar::new(u64::from(count) * self.set.len() as u64);
        for kind in &self.set {
            for number in first..first + count {
                let scene = generator.scene(*kind, number);
                let trial = Trial::new(&radar, &scene, self.floor.floor, request.normalisation)
                    .map_err(CommandError::failed)?;
                let answer = trial.ask(method, &request).map_err(CommandError::failed)?;
                judge(&trial.target, &answer.found.lambda);
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        Ok(())
    }

    /// The rates at `eta` on scenes that did not choose it.
    fn checked(&self, method: &dyn Reconstructor, eta: f32) -> Result<Tried, CommandError> {
        let mut sums = Tried { scenes: 0, false_alarm: 0.0, detection: 0.0 };
        self.each(method, self.count, self.check, |target, output| {
            let (detection, false_alarm) = detection_rates(target, output, eta);
            if let Some(detection) = detection {
                sums.scenes += 1;
                sums.detection += detection;
                sums.false_alarm += false_alarm;
            }
        })?;
        let scenes = sums.scenes.max(1) as f64;
        Ok(Tried { detection: sums.detection / scenes, false_alarm: sums.false_alarm / scenes, ..sums })
    }
}

impl Report {
    fn text(&self) -> String {
        let tried = |what: &str, tried: &Tried| {
            let scenes = counted(tried.scenes, "scene", "scenes");
            format!("{what} {scenes}: P_FA {:.3} %, P_D {:.2} %", 100.0 * tried.false_alarm, 100.0 * tried.detection)
        };
        let mut lines = vec![
            format!("threshold of {} over {}, sets {}: {:.4}", self.method, self.floor, self.sets.join(", "), self.eta),
            tried("on the", &self.tried),
            format!(
                "on a further scene that is drawn like these, P_FA is at most {} % on average",
                100.0 * self.wanted
            ),
        ];
        lines.extend(self.check.as_ref().map(|check| tried("checked on further", check)));
        lines.join("\n")
    }
}
