//! The tables of an evaluation, from its rows.

use crate::evaluate::Estimate;
use crate::evaluate::rows::Row;
use crate::evaluate::sets::{NOISE_LEVEL, false_alarm};
use crate::evaluate::tables::{
    PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed, Tally, part_near_best,
};
use crate::radar::Carrier;
use crate::scene::generate::Kind;
use crate::signal::Floor;
use serde::{Serialize, Serializer};
use std::fmt::Write;

/// What rows don't say of the run that made them.
#[derive(Debug, Clone, Copy)]
pub struct Conventions {
    pub seed: u64,
    pub floor: Floor,
    pub carrier: Carrier,
}

/// What the command found; its JSON is documented in the command's help.
#[derive(Debug, Serialize)]
pub struct Report {
    count: usize,
    seed: Option<u64>,
    floor: Option<String>,
    carrier: Option<Carrier>,
    sets: Vec<SetReport>,
}

#[derive(Debug, Serialize)]
struct SetReport {
    #[serde(serialize_with = "number_or_name")]
    set: String,
    printed: Option<PrintedColumns>,
    /// At which methods are held against each other.
    false_alarm: f64,
    methods: Vec<MethodReport>,
}

#[derive(Debug, Serialize)]
struct PrintedColumns {
    baseline: Printed,
    experiment_1: Printed,
    experiment_2: Printed,
}

#[derive(Debug, Serialize)]
struct MethodReport {
    name: String,
    eta: f32,
    scenes: usize,
    squared_error: Estimate,
    detection: Estimate,
    false_alarm: Estimate,
    detection_at_printed_false_alarm: AtPrinted,
    missed: Estimate,
    ghosts: Estimate,
    median_milliseconds: f64,
    /// Part of the scenes on which no other method is much better; `None` beside no other.
    near_best: Option<f64>,
}

/// P_D where every scene's P_FA is held to a rate.
#[derive(Debug, Serialize)]
struct AtPrinted {
    false_alarm: f64,
    detection: f64,
    standard_error: f64,
}

fn number_or_name<S: Serializer>(set: &str, serializer: S) -> Result<S::Ok, S::Error> {
    match set.parse::<u32>() {
        Ok(number) => serializer.serialize_u32(number),
        Err(_) => serializer.serialize_str(set),
    }
}

/// Names in the order they first appear.
fn names<'a>(rows: &[&'a Row], name: impl Fn(&'a Row) -> &'a str) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for row in rows {
        if !seen.contains(&name(row)) {
            seen.push(name(row));
        }
    }
    seen
}

impl Report {
    /// The tables of `rows`; `conventions` where they are of one run over generated scenes.
    pub fn of(rows: &[Row], conventions: Option<Conventions>) -> Report {
        let all: Vec<&Row> = rows.iter().collect();
        let sets: Vec<SetReport> = names(&all, |row| &row.set)
            .into_iter()
            .map(|set| SetReport::of(set, &all.iter().copied().filter(|r| r.set == set).collect::<Vec<_>>()))
            .collect();
        let seeds = rows.first().map(|row| row.seed).filter(|seed| rows.iter().all(|row| row.seed == *seed));
        Report {
            count: sets.iter().flat_map(|s| &s.methods).map(|m| m.scenes).max().unwrap_or(0),
            seed: conventions.map(|c| c.seed).or(seeds),
            floor: conventions.map(|c| c.floor.to_string()),
            carrier: conventions.map(|c| c.carrier),
            sets,
        }
    }

    pub fn to_text(&self) -> String {
        let mut text = format!("{} scenes a set", self.count);
        // Writing to a string can't fail.
        if let Some(seed) = self.seed {
            let _ = write!(text, ", seed {seed}");
        }
        if let Some(floor) = &self.floor {
            let _ = write!(text, ", floor {floor}");
        }
        match self.carrier {
            Some(Carrier::OneWay) => text.push_str(", carrier one-way"),
            Some(Carrier::TwoWay) => text.push_str(", carrier two-way"),
            None => {}
        }
        text.push_str("; mean \u{b1} standard error\n");
        for set in &self.sets {
            set.write(&mut text);
        }
        text.truncate(text.trim_end().len());
        text
    }
}

impl SetReport {
    fn of(set: &str, rows: &[&Row]) -> SetReport {
        let test_set = set.parse::<Kind>().ok().and_then(Kind::test_set);
        let printed = test_set.map(|number| PrintedColumns {
            baseline: PRINTED_BASELINE[number - 1],
            experiment_1: PRINTED_EXPERIMENT_1[number - 1],
            experiment_2: PRINTED_EXPERIMENT_2[number - 1],
        });
        let false_alarm = false_alarm(test_set);
        let method = |name: &&str| MethodReport::of(name, rows, false_alarm);
        let methods = names(rows, |row| &row.method).iter().map(method).collect();
        SetReport { set: set.to_owned(), printed, false_alarm, methods }
    }

    fn write(&self, text: &mut String) {
        let kind = self.set.parse::<Kind>().ok();
        let what = kind.map_or("scenes of a folder", Kind::description);
        let _ = match kind.and_then(Kind::test_set) {
            Some(set) => writeln!(text, "\nTable 4.{set}: test set {set}, {what}"),
            None if kind == Some(Kind::Noise) => {
                let level = NOISE_LEVEL.0;
                writeln!(
                    text,
                    "\n{}: {what}, of {level} dBm a sample unless --floor names another level; all alarms are false",
                    self.set
                )
            }
            None => writeln!(text, "\n{}: {what}", self.set),
        };
        let rate = format!("P_D % at P_FA {:.2} %", 100.0 * self.false_alarm);
        let _ = writeln!(
            text,
            "{:<26} {:>20} {:>16} {:>16} {:>22} {:>7} {:>7} {:>11} {:>9}",
            "", "SE", "P_D %", "P_FA %", rate, "missed", "ghosts", "near best %", "ms a map"
        );
        if let Some(printed) = &self.printed {
            printed.write(text);
        }
        for method in &self.methods {
            method.write(text);
            if let ("baseline", Some(printed)) = (method.name.as_str(), &self.printed) {
                method.write_deviation(&printed.baseline, text);
            }
        }
    }
}

impl PrintedColumns {
    fn write(&self, text: &mut String) {
        for (name, printed) in [
            ("printed: baseline", &self.baseline),
            ("printed: experiment 1", &self.experiment_1),
            ("printed: experiment 2", &self.experiment_2),
        ] {
            let (detection, false_alarm) = (100.0 * printed.detection, 100.0 * printed.false_alarm);
            let _ = writeln!(text, "{name:<26} {:>20.2} {detection:>16.2} {false_alarm:>16.2}", printed.squared_error);
        }
    }
}

impl MethodReport {
    fn of(name: &str, rows: &[&Row], false_alarm: f64) -> Self {
        let tally = Tally::of(rows.iter().copied().filter(|row| row.method == name));
        let at = tally.detection_at_printed();
        MethodReport {
            name: name.to_owned(),
            eta: tally.eta(),
            scenes: tally.scenes(),
            squared_error: tally.squared_error(),
            detection: tally.detection(),
            false_alarm: tally.false_alarm(),
            detection_at_printed_false_alarm: AtPrinted {
                false_alarm,
                detection: at.mean,
                standard_error: at.standard_error,
            },
            missed: tally.missed(),
            ghosts: tally.ghosts(),
            median_milliseconds: tally.median_milliseconds(),
            near_best: part_near_best(rows, name),
        }
    }

    fn write(&self, text: &mut String) {
        let percent = |mean: f64, error: f64| match mean.is_nan() {
            true => "-".to_owned(),
            false => format!("{:.2} \u{b1} {:.3}", 100.0 * mean, 100.0 * error),
        };
        let rate = |e: Estimate| percent(e.mean, e.standard_error);
        let at = &self.detection_at_printed_false_alarm;
        let _ = writeln!(
            text,
            "{:<26} {:>20} {:>16} {:>16} {:>22} {:>7.2} {:>7.2} {:>11} {:>9.1}",
            format!("{} (eta {})", self.name, self.eta),
            format!("{:.1} \u{b1} {:.1}", self.squared_error.mean, self.squared_error.standard_error),
            rate(self.detection),
            rate(self.false_alarm),
            percent(at.detection, at.standard_error),
            self.missed.mean,
            self.ghosts.mean,
            self.near_best.map_or("-".to_owned(), |part| format!("{:.0}", 100.0 * part)),
            self.median_milliseconds
        );
    }

    fn write_deviation(&self, printed: &Printed, text: &mut String) {
        let off = |e: Estimate, printed: f64, rounding: f64| match e.standard_error {
            0.0 => "-".to_owned(),
            _ => format!("{:+.2} s.e.", e.deviation_from(printed, rounding)),
        };
        let rounding = printed.rate_rounding();
        let _ = writeln!(
            text,
            "{:<26} {:>20} {:>16} {:>16}",
            "  off the printed by",
            off(self.squared_error, printed.squared_error, 0.005),
            off(self.detection, printed.detection, rounding),
            off(self.false_alarm, printed.false_alarm, rounding)
        );
    }
}
