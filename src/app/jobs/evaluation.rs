//! Methods on the tables' test scenes, in the background.

use super::rows::{Plan, Stopped, Teller};
use crate::evaluate::campaign::{Campaign, CampaignError};
use crate::evaluate::sets::SceneSet;
use crate::evaluate::tables::{Estimate, Tally};
use crate::reconstruct::Reconstructor;
use crate::scene::generate::Kind;
use std::fmt::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// One method on one test set.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationRow {
    /// Test set, 1 to 3.
    pub set: usize,
    /// Name of the method.
    pub method: &'static str,
    /// The optimisers that trained the method's weights; empty without weights.
    pub optimiser: String,
    /// The threshold it was judged at; the mean where each answer has its own.
    pub eta: f32,
    /// Whether every answer was judged at `eta`.
    pub one_eta: bool,
    /// Scenes of the set.
    pub scenes: usize,
    /// SE.
    pub squared_error: Estimate,
    /// P_D.
    pub detection: Estimate,
    /// P_FA.
    pub false_alarm: Estimate,
    /// P_D where every scene's P_FA is held to the printed one of experiment 2.
    pub detection_at_printed: Option<Estimate>,
    /// P_D and P_FA by a detector of constant false-alarm rate, where one was in use.
    pub cfar: Option<[Estimate; 2]>,
    /// Time of a map.
    pub median_milliseconds: f64,
}

/// What is to be evaluated.
pub struct EvaluationPlan {
    /// Radar, floor, scenes.
    pub campaign: Campaign,
    /// Test sets, 1 to 3.
    pub sets: Vec<usize>,
    /// The methods.
    pub methods: Vec<Arc<dyn Reconstructor>>,
}

impl EvaluationPlan {
    /// Maps to be made in all.
    fn maps(&self) -> usize {
        self.sets.len() * self.methods.len() * self.campaign.count as usize
    }
}

/// The rows as CSV; rates as fractions.
pub fn to_csv(rows: &[EvaluationRow]) -> String {
    let mut text = String::from(
        "set,method,eta,scenes,squared_error,squared_error_se,detection,detection_se,false_alarm,false_alarm_se,\
         detection_at_printed_false_alarm,median_milliseconds,optimiser,squared_error_median,detection_median,\
         false_alarm_median",
    );
    let has_cfar = rows.iter().any(|r| r.cfar.is_some());
    text.push_str(if has_cfar { ",cfar_detection,cfar_false_alarm\n" } else { "\n" });
    for r in rows {
        let at = r.detection_at_printed.map_or_else(String::new, |d| d.mean.to_string());
        // Writing to a string can't fail.
        let cfar = |rates: [Estimate; 2]| format!(",{},{}", rates[0].mean, rates[1].mean);
        let cfar = r.cfar.map_or_else(|| if has_cfar { ",,".to_owned() } else { String::new() }, cfar);
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{},{},{at},{:.3},\"{}\",{},{},{}{cfar}",
            r.set,
            r.method,
            r.eta,
            r.scenes,
            r.squared_error.mean,
            r.squared_error.standard_error,
            r.detection.mean,
            r.detection.standard_error,
            r.false_alarm.mean,
            r.false_alarm.standard_error,
            r.median_milliseconds,
            r.optimiser,
            r.squared_error.median,
            r.detection.median,
            r.false_alarm.median
        );
    }
    text
}

impl Plan for EvaluationPlan {
    type Row = EvaluationRow;
    type End = ();
    const THREAD: &'static str = "evaluation";
    const WHAT: &'static str = "The evaluation";
    const ADVICE: &'static str = "Leave the method out, or try another seed.";

    /// One method after another, so that each is on screen as soon as it is finished. The scenes are simulated anew for each: that is
    /// a small part of the time.
    fn run(&self, teller: &Teller<'_, EvaluationRow>) -> Result<(), Stopped> {
        let (done, total) = (AtomicUsize::new(0), self.maps().max(1));
        let on_map = || {
            let maps = done.fetch_add(1, Ordering::Relaxed) + 1;
            teller.part(maps as f32 / total as f32);
        };
        for &set in &self.sets {
            let kind = [Kind::Set1, Kind::Set2, Kind::Set3][set - 1];
            for method in &self.methods {
                let (sets, methods) = ([SceneSet::Generated(kind)], [method.as_ref()]);
                let rows = self.campaign.run(&sets, &methods, teller.task, |_| on_map()).map_err(stopped)?;
                let tally = Tally::of(&rows);
                if tally.scenes() == 0 {
                    continue;
                }
                teller.row(EvaluationRow {
                    set,
                    method: method.name(),
                    optimiser: tally.optimiser().to_owned(),
                    eta: tally.eta(),
                    one_eta: tally.has_one_eta(),
                    scenes: tally.scenes(),
                    squared_error: tally.squared_error(),
                    detection: tally.detection(),
                    false_alarm: tally.false_alarm(),
                    detection_at_printed: Some(tally.detection_at_printed()).filter(|d| d.mean.is_finite()),
                    cfar: self.campaign.cfar.map(|_| [tally.cfar_detection(), tally.cfar_false_alarm()]),
                    median_milliseconds: tally.median_milliseconds(),
                });
            }
        }
        Ok(())
    }
}

fn stopped(error: CampaignError) -> Stopped {
    if error.is_cancelled() { Stopped::Cancelled } else { Stopped::Failed(error.to_string()) }
}
