//! `apertura threshold`: the threshold at which a method keeps a rate of false alarms.

use super::arguments::{FloorArgs, real, seed, whole};
use super::layout_arg::LayoutArg;
use super::own_method::OwnMethodArgs;
use super::radar_arg::RadarArg;
use super::{CommandError, print, print_json};
use crate::evaluate::threshold::{KeptThreshold, ThresholdMeans, ThresholdSearch};
use crate::methods;
use crate::radar::{LayoutKind, counted};
use crate::scene::generate::Kind;
use crate::task::Task;
use indicatif::ProgressBar;
use serde::Serialize;

/// Find the threshold at which a method's false alarms stay below a rate on further scenes like those that it was tried on
///
/// The method is tried on random validation scenes. The threshold is the lowest one with (n P_FA + 1) / (n + 1) below the rate, where P_FA
/// is the mean over the n scenes (conformal risk control; Angelopoulos et al., ICLR 2024). On a further scene that is drawn like these,
/// P_FA is then below the rate on average. This holds for no other kinds, floors or radars, and not for each single scene. A rate of 1 %
/// takes 99 scenes or more, and with few more next to no false alarm is left to the scenes tried: ((n + 1) rate - 1) / n. From 990 scenes on
/// that is nine tenths of 1 %. --check tries the threshold on further scenes.
///
/// With --json one object is printed: method, sets, floor, layout (null for the two ends), seed, wanted, eta, scenes, false_alarm and detection (means over the scenes
/// tried), left_to_scenes (the most that false_alarm may be), scenes_within_a_tenth (from so many scenes on left_to_scenes is nine tenths of
/// wanted), and check (null without --check; scenes, false_alarm, detection). Rates are fractions, not percent.
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

    #[arg(long, value_name = "1,2,3,KIND,..", value_delimiter = ',', default_value = "1,2,3",
          help = format!("Kinds of scenes with echoes, separated by commas: {}", Kind::names().trim_end_matches(", noise")))]
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

    #[command(flatten)]
    radar: RadarArg,

    #[command(flatten)]
    layout: LayoutArg,

    /// Print one JSON object instead of text
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct Report {
    method: String,
    sets: Vec<String>,
    floor: String,
    layout: Option<String>,
    seed: u64,
    wanted: f64,
    eta: f32,
    #[serde(flatten)]
    tried: ThresholdMeans,
    left_to_scenes: f64,
    scenes_within_a_tenth: u64,
    check: Option<ThresholdMeans>,
    #[serde(skip)]
    margin_sentence: String,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        self.own.start()?;
        let method = methods::by_name(self.method.trim())?;
        let (radar, _) = self.radar.load()?;
        let search = ThresholdSearch {
            layout: self.layout.numbers(&radar)?,
            radar,
            floor: self.floor.floor(),
            kinds: self.set.clone(),
            count: self.count,
            seed: self.seed,
            false_alarm_percent: self.false_alarm,
            ..ThresholdSearch::default()
        };
        let (task, scenes) = (Task::default(), |count: u32| u64::from(count) * self.set.len() as u64);
        let bar = ProgressBar::new(scenes(self.count));
        let step = |_| bar.inc(1);
        let KeptThreshold { eta, tried } = search.run(&*method, &task, step)?;
        bar.set_length(scenes(self.count) + scenes(self.check));
        let further = || search.try_further(&*method, eta, self.check, &task, step);
        let check = (self.check > 0).then(further).transpose()?;
        bar.finish_and_clear();
        let report = Report {
            method: method.name().to_owned(),
            sets: self.set.iter().map(Kind::to_string).collect(),
            floor: self.floor.floor().to_string(),
            layout: self.layout.other().map(LayoutKind::to_string),
            seed: self.seed,
            wanted: self.false_alarm / 100.0,
            eta,
            tried,
            left_to_scenes: search.left_to_scenes(tried.scenes),
            scenes_within_a_tenth: search.scenes_within_a_tenth(),
            margin_sentence: search.margin_sentence(tried.scenes),
            check,
        };
        if self.json { print_json(&report) } else { print(&report.text()) }
    }
}

impl Report {
    fn text(&self) -> String {
        let tried = |what: &str, tried: &ThresholdMeans| {
            let scenes = counted(tried.scenes, "scene", "scenes");
            format!("{what} {scenes}: P_FA {:.3} %, P_D {:.2} %", 100.0 * tried.false_alarm, 100.0 * tried.detection)
        };
        let heard = self.layout.as_ref().map_or_else(String::new, |layout| format!(", elements {layout} heard"));
        let Report { method, floor, eta, .. } = self;
        let (sets, wanted) = (self.sets.join(", "), 100.0 * self.wanted);
        let mut lines = vec![
            format!("threshold of {method} over {floor}{heard}, sets {sets}: {eta:.4}"),
            tried("on the", &self.tried),
            self.margin_sentence.clone(),
            format!("on a further scene that is drawn like these, P_FA is at most {wanted} % on average"),
        ];
        lines.extend(self.check.as_ref().map(|check| tried("checked on further", check)));
        lines.join("\n")
    }
}
