//! The tables of an evaluation, from its rows.

use super::by_echo::{self, EchoReport};
use super::percent::{percent, percent_of};
use crate::evaluate::Estimate;
use crate::evaluate::rows::{Column, MissingRows, Row};
use crate::evaluate::sets::{NOISE_LEVEL, false_alarm};
use crate::evaluate::statistics::Paired;
use crate::evaluate::tables::{
    PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed, Tally, part_near_best,
};
use crate::radar::{Carrier, counted};
use crate::scene::generate::{Kind, Reading};
use serde::{Serialize, Serializer};
use std::fmt::{self, Write};

/// The report of an evaluation; its JSON is documented in the command's help.
#[derive(Debug, Serialize)]
pub struct EvaluationReport {
    count: usize,
    seed: Option<u64>,
    floor: Option<String>,
    normalisation: Option<String>,
    carrier: Option<Carrier>,
    reading: Option<Reading>,
    radar: Option<String>,
    layout: String,
    missing: Vec<MissingRows>,
    sets: Vec<SetReport>,
}

#[derive(Debug, Serialize)]
struct SetReport {
    #[serde(serialize_with = "number_or_name")]
    set: String,
    description: &'static str,
    printed: Option<PrintedColumns>,
    false_alarm: f64,
    methods: Vec<MethodReport>,
    against: Vec<Against>,
}

#[derive(Debug, Serialize)]
struct Against {
    first: String,
    second: String,
    #[serde(flatten)]
    paired: Paired,
}

impl Against {
    fn of(methods: &[&str], rows: &[&Row]) -> Vec<Against> {
        let Some((first, others)) = methods.split_first() else { return Vec::new() };
        let against = |second: &&str| {
            let paired = Paired::of(rows.iter().copied(), first, second)?;
            Some(Against { first: (*first).to_owned(), second: (*second).to_owned(), paired })
        };
        others.iter().filter_map(against).collect()
    }
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
    weights: Option<String>,
    optimiser: String,
    eta: f32,
    /// Whether every answer was judged at `eta`; otherwise `eta` is the mean of the answers' own.
    one_eta: bool,
    scenes: usize,
    squared_error: Estimate,
    detection: Estimate,
    false_alarm: Estimate,
    detection_at_printed_false_alarm: AtPrinted,
    missed: Estimate,
    ghosts: Estimate,
    /// `None` where no scene has a body, and in older rows.
    echoes: Option<EchoReport>,
    /// Part of the cells whose error is at most their doubt; `None` without doubt.
    within_doubt: Option<Estimate>,
    /// `None` where no detector of constant false-alarm rate was tried.
    cfar: Option<CfarReport>,
    median_milliseconds: f64,
    /// Part of the scenes on which no other method is much better; `None` for a single method.
    near_best: Option<f64>,
}

#[derive(Debug, Serialize)]
struct CfarReport {
    detector: String,
    detection: Estimate,
    false_alarm: Estimate,
}

impl CfarReport {
    fn of(rows: &[&Row], tally: &Tally) -> Option<CfarReport> {
        let row = rows.iter().find(|row| !row.cfar.is_empty())?;
        Some(CfarReport {
            detector: row.cfar.to_string(),
            detection: tally.estimate(Column::CfarDetection),
            false_alarm: tally.estimate(Column::CfarFalseAlarm),
        })
    }
}

#[derive(Debug, Serialize)]
struct AtPrinted {
    /// A note that the figure is not the thesis' P_D, which is at one threshold.
    threshold: &'static str,
    false_alarm: f64,
    detection: f64,
    standard_error: f64,
    median: f64,
}

const FOLDER_HEADING: &str = "scenes of a folder";

const LABEL_WIDTH: usize = 26;

/// Widths of the columns behind a label.
const COLUMN_WIDTHS: [usize; 8] = [20, 16, 16, 22, 7, 7, 11, 9];

fn line<const N: usize>(text: &mut String, width: usize, label: &str, cells: [impl fmt::Display; N]) {
    let _ = write!(text, "{label:<width$}");
    for (cell, width) in cells.iter().zip(COLUMN_WIDTHS) {
        let _ = write!(text, " {cell:>width$}");
    }
    text.push('\n');
}

fn number_or_name<S: Serializer>(set: &str, serializer: S) -> Result<S::Ok, S::Error> {
    match set.parse::<u32>() {
        Ok(number) => serializer.serialize_u32(number),
        Err(_) => serializer.serialize_str(set),
    }
}

fn names<'a>(rows: &[&'a Row], name: impl Fn(&'a Row) -> &'a str) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for row in rows {
        if !seen.contains(&name(row)) {
            seen.push(name(row));
        }
    }
    seen
}

impl EvaluationReport {
    /// The tables of `rows`; `missing` are the scenes that lack in the whole run.
    pub fn of(rows: &[Row], missing: Vec<MissingRows>) -> EvaluationReport {
        let all: Vec<&Row> = rows.iter().collect();
        let sets: Vec<SetReport> = names(&all, |row| &row.set)
            .into_iter()
            .map(|set| SetReport::of(set, &all.iter().copied().filter(|r| r.set == set).collect::<Vec<_>>()))
            .collect();
        let seed = rows.first().map(|row| row.seed).filter(|seed| rows.iter().all(|row| row.seed == *seed));
        let generated = rows.iter().find(|row| row.carrier.is_some());
        let usual = rows.iter().filter(|row| row.version.is_some()).min_by_key(|row| row.has_own_floor());
        let of_all = |column: Column| usual.map(|row| column.text(row));
        EvaluationReport {
            count: sets.iter().flat_map(|s| &s.methods).map(|m| m.scenes).max().unwrap_or(0),
            seed,
            floor: of_all(Column::Floor),
            normalisation: of_all(Column::Normalisation),
            carrier: generated.and_then(|row| row.carrier),
            reading: generated.and_then(|row| row.reading),
            radar: generated.map(|row| row.radar.to_string()),
            layout: rows.first().map(|row| row.layout.to_string()).unwrap_or_default(),
            missing,
            sets,
        }
    }

    pub fn to_text(&self) -> String {
        let carrier = |carrier| if carrier == Carrier::OneWay { "carrier one-way" } else { "carrier two-way" };
        let normalisation = self.normalisation.as_ref().filter(|n| *n != "min-max");
        let of_text = self.reading == Some(Reading::Text);
        let made_by = [
            Some(counted(self.count, "scene a set", "scenes a set")),
            self.seed.map(|seed| format!("seed {seed}")),
            self.floor.as_ref().map(|floor| format!("floor {floor}")),
            normalisation.map(|normalisation| format!("normalisation {normalisation}")),
            self.carrier.map(|c| carrier(c).to_owned()),
            of_text.then(|| "scenes of the thesis' text".to_owned()),
            self.radar.as_ref().filter(|radar| !radar.is_empty()).map(|radar| format!("radar {radar}")),
            (!self.layout.is_empty()).then(|| format!("elements {} heard", self.layout)),
        ];
        let mut text = made_by.into_iter().flatten().collect::<Vec<_>>().join(", ");
        text.push_str("; mean \u{b1} standard error, and beneath it the median\n");
        for lack in &self.missing {
            let _ = writeln!(text, "missing: {lack}");
        }
        for set in &self.sets {
            set.write(self.count, &mut text);
        }
        text.truncate(text.trim_end().len());
        text
    }
}

impl SetReport {
    fn of(set: &str, rows: &[&Row]) -> SetReport {
        let kind = set.parse::<Kind>().ok();
        let (test_set, description) = (kind.and_then(Kind::test_set), kind.map_or(FOLDER_HEADING, Kind::description));
        let is_of_table = rows.iter().all(|row| row.radar.is_empty());
        let printed = test_set.filter(|_| is_of_table).map(|number| PrintedColumns {
            baseline: PRINTED_BASELINE[number - 1],
            experiment_1: PRINTED_EXPERIMENT_1[number - 1],
            experiment_2: PRINTED_EXPERIMENT_2[number - 1],
        });
        let false_alarm = false_alarm(test_set);
        let method = |name: &&str| MethodReport::of(name, rows, false_alarm);
        let names = names(rows, |row| &row.method);
        let (methods, against) = (names.iter().map(method).collect(), Against::of(&names, rows));
        SetReport { set: set.to_owned(), description, printed, false_alarm, methods, against }
    }

    fn write(&self, count: usize, text: &mut String) {
        let kind = self.set.parse::<Kind>().ok();
        let what = self.description;
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
        let width = self.methods.iter().map(|m| m.label(count).chars().count()).fold(LABEL_WIDTH, usize::max);
        let rate = format!("P_D % at P_FA {:.2} %", 100.0 * self.false_alarm);
        let (fixed, own) = ("at the method's threshold", "at each scene's own");
        let _ = writeln!(text, "{:<width$} {:>20} {fixed:>33} {own:>22}", "", "");
        line(text, width, "", ["SE", "P_D %", "P_FA %", &rate, "missed", "false", "near best %", "ms a map"]);
        if let Some(printed) = &self.printed {
            printed.write(width, text);
        }
        for method in &self.methods {
            method.write(count, width, text);
            if let ("baseline", Some(printed)) = (method.name.as_str(), &self.printed) {
                method.write_deviation(width, &printed.baseline, text);
            }
        }
        let counted = self.methods.iter().filter_map(|m| Some((m.name.as_str(), m.echoes.as_ref()?)));
        by_echo::write(&counted.collect::<Vec<_>>(), width, text);
        for (name, part) in self.methods.iter().filter_map(|m| Some((&m.name, m.within_doubt.as_ref()?))) {
            let _ = writeln!(
                text,
                "doubt of {name}: the error of {} % of the cells is at most their doubt; 90 % is the aim over noise that it was trained on",
                percent_of(part)
            );
        }
        self.write_cfar(width, text);
        for Against { first, second, paired } in &self.against {
            let _ = writeln!(text, "{}", paired.sentence(first, second));
        }
    }

    fn write_cfar(&self, width: usize, text: &mut String) {
        let Some(first) = self.methods.iter().find_map(|method| method.cfar.as_ref()) else { return };
        text.push('\n');
        line(text, width, &format!("by {}", first.detector), ["P_D %", "P_FA %"]);
        for (name, cfar) in self.methods.iter().filter_map(|m| Some((&m.name, m.cfar.as_ref()?))) {
            line(text, width, name, [&cfar.detection, &cfar.false_alarm].map(percent_of));
        }
    }
}

impl PrintedColumns {
    fn write(&self, width: usize, text: &mut String) {
        for (name, printed) in [
            ("printed: baseline", &self.baseline),
            ("printed: experiment 1", &self.experiment_1),
            ("printed: experiment 2", &self.experiment_2),
        ] {
            let figures = [printed.squared_error, 100.0 * printed.detection, 100.0 * printed.false_alarm];
            line(text, width, name, figures.map(|figure| format!("{figure:.2}")));
        }
    }
}

impl MethodReport {
    fn of(name: &str, rows: &[&Row], false_alarm: f64) -> Self {
        let tally = Tally::of(rows.iter().copied().filter(|row| row.method == name));
        let at = tally.estimate(Column::DetectionAtPrinted);
        MethodReport {
            name: name.to_owned(),
            weights: tally.weights().map(str::to_owned),
            optimiser: tally.optimiser().to_owned(),
            eta: tally.eta(),
            one_eta: tally.has_one_eta(),
            scenes: tally.scenes(),
            squared_error: tally.squared_error(),
            detection: tally.detection(),
            false_alarm: tally.false_alarm(),
            detection_at_printed_false_alarm: AtPrinted {
                threshold: "each scene's own",
                false_alarm,
                detection: at.mean,
                standard_error: at.standard_error,
                median: at.median,
            },
            missed: tally.estimate(Column::Missed),
            ghosts: tally.estimate(Column::Ghosts),
            cfar: CfarReport::of(rows, &tally),
            echoes: tally.echoes().map(EchoReport::of),
            within_doubt: Some(tally.estimate(Column::WithinDoubt)).filter(|part| !part.mean.is_nan()),
            median_milliseconds: tally.median_milliseconds(),
            near_best: part_near_best(rows, name),
        }
    }

    fn label(&self, count: usize) -> String {
        let eta = match self.one_eta {
            true => format!("eta {}", self.eta),
            false => format!("eta {:.4} on average", self.eta),
        };
        let optimiser = Some(self.optimiser.clone()).filter(|optimiser| !optimiser.is_empty());
        let scenes = (self.scenes != count).then(|| counted(self.scenes, "scene", "scenes"));
        let behind: Vec<String> = optimiser.into_iter().chain([eta]).chain(scenes).collect();
        format!("{} ({})", self.name, behind.join("; "))
    }

    fn write(&self, count: usize, width: usize, text: &mut String) {
        let MethodReport { squared_error, missed, ghosts, median_milliseconds, .. } = self;
        let at = &self.detection_at_printed_false_alarm;
        let error = format!("{:.1} \u{b1} {:.1}", squared_error.mean, squared_error.standard_error);
        let (detection, false_alarm) = (percent_of(&self.detection), percent_of(&self.false_alarm));
        let at_printed = percent(at.detection, at.standard_error);
        let near_best = self.near_best.map_or("-".to_owned(), |part| format!("{:.0}", 100.0 * part));
        let [lost, alarms] = [missed, ghosts].map(|count| format!("{:.2}", count.mean));
        let time = format!("{median_milliseconds:.1}");
        let cells = [error, detection, false_alarm, at_printed, lost, alarms, near_best, time];
        line(text, width, &self.label(count), cells);
        let median = |rate: f64| if rate.is_nan() { "-".to_owned() } else { format!("{:.2}", 100.0 * rate) };
        let [detection, false_alarm, at_printed] =
            [self.detection.median, self.false_alarm.median, at.median].map(median);
        let [lost, alarms] = [missed, ghosts].map(|count| count.median.to_string());
        let error = format!("{:.1}", squared_error.median);
        line(text, width, "  median", [error, detection, false_alarm, at_printed, lost, alarms]);
    }

    fn write_deviation(&self, width: usize, printed: &Printed, text: &mut String) {
        let off = |e: Estimate, printed: f64, rounding: f64| match e.standard_error {
            0.0 => "-".to_owned(),
            _ => format!("{:+.2} s.e.", e.deviation_from(printed, rounding)),
        };
        let rounding = printed.rate_rounding();
        let cells = [
            off(self.squared_error, printed.squared_error, 0.005),
            off(self.detection, printed.detection, rounding),
            off(self.false_alarm, printed.false_alarm, rounding),
        ];
        line(text, width, "  off the printed by", cells);
    }
}
