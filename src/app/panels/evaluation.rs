//! The evaluation panel: methods on the test sets of the tables, beside the figures that the thesis prints.

use crate::app::content::{Content, Cx};
use crate::app::jobs::Memo;
use crate::app::state::{Command, FailureChoice, RowsCommand};
use crate::app::widgets::{bar, scrolled_both, start_or_cancel, warning};
use crate::evaluate::eta_text;
use crate::evaluate::rows::{Column, Row, Text};
use crate::evaluate::tables::{Estimate, PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed, Tally};
use crate::radar::{Radar, counted};
use crate::scene::generate::Kind;
use eframe::egui::{Grid, Ui};
use std::collections::BTreeMap;

/// The printed columns with their headings.
const PRINTED_COLUMNS: [(&str, [Printed; 3]); 3] = [
    ("thesis: baseline", PRINTED_BASELINE),
    ("thesis: exp. 1", PRINTED_EXPERIMENT_1),
    ("thesis: exp. 2", PRINTED_EXPERIMENT_2),
];

const SET_CONTENTS: [&str; 3] = ["one point", "3 to 6 points", "points and lines"];

/// The summarised rows, and the state of the current run.
pub struct Input<'a> {
    /// The method in use, which can be tried on the test sets from here.
    pub method: Option<&'static str>,
    /// Radar of the rows, or of the next run where there are no rows.
    pub radar: &'a Radar,
    /// Completed part of the run, 0 to 1, while methods are tried.
    pub progress: Option<f32>,
    pub lines: &'a [Line],
    /// Message of the last run, where it did not succeed.
    pub note: Option<&'a str>,
}

/// One method on one test set.
pub struct Line {
    /// The test set, from 0.
    set: usize,
    /// The method's name, its threshold, and the optimisers of its weights.
    label: String,
    scenes: usize,
    /// SE, P_D, P_FA, and P_D where every scene's P_FA is held to the printed one of experiment 2.
    figures: [String; 4],
    /// P_D and P_FA by a detector of constant false-alarm rate, where one was in use.
    cfar: Option<[String; 2]>,
    milliseconds: String,
}

/// Scenes of each set that the button tries.
const SCENES_PER_SET: u32 = 10;

/// Remembers figures of the rows of this version.
pub const PANEL: Content<Memo<u64, Vec<Line>>> = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_, Memo<u64, Vec<Line>>>) -> Vec<Command> {
    let (state, job) = (&*cx.state, &cx.jobs.failures);
    let table = &job.table;
    let lines = &*cx.memory.of(table.version(), |_| lines(table.rows()));
    let input = Input {
        method: state.method().map(|m| m.name()),
        radar: if lines.is_empty() { state.radar() } else { &table.conditions().radar },
        progress: job.run.progress(),
        lines,
        note: job.run.note(),
    };
    show(ui, input)
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    scrolled_both(ui, |ui, asked| {
        buttons(ui, &input, asked);
        warning(ui, input.note);
        warning(ui, unlike_the_thesis(input.radar).as_deref());
        ui.separator();
        if input.lines.is_empty() {
            ui.weak("Tables 4.1 to 4.3 of the thesis for the methods that were tried on sets 1 to 3. Rows tries any method on any number of scenes.");
        }
        tables(ui, input.lines);
    })
}

/// Sentence on the radar's difference from that of the printed figures; `None` where both are the same.
fn unlike_the_thesis(radar: &Radar) -> Option<String> {
    let thesis = Radar::default();
    let what = match radar {
        radar if *radar == thesis => return None,
        radar if radar.window != thesis.window => format!("a {} window", radar.window.name()),
        radar if radar.carrier != thesis.carrier => "a two-way carrier".to_owned(),
        radar => format!("another radar, {} elements and {} samples", radar.elements, radar.samples),
    };
    Some(format!("With {what}: the printed figures are of table 3.1 and don't compare."))
}

fn buttons(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let tips = [
            "Try the method in use on ten scenes of each set, in the background",
            "Stop after this map; the rows that are finished stay",
        ];
        let (button, is_ready) = (("Evaluate", RowsCommand::CancelTrying), input.method.is_some());
        if start_or_cancel(ui, button, input.progress.is_some(), is_ready, tips, asked) {
            let (methods, kinds) = (input.method.into_iter().collect(), Kind::TEST_SETS.to_vec());
            let choice = FailureChoice { methods, kinds, own: false, count: SCENES_PER_SET, seed: 0 };
            asked.push(RowsCommand::Try(choice).into());
        }
        bar(ui, input.progress, 180.0);
    });
}

/// Every method on every test set of which there are rows.
fn lines(rows: &[Row]) -> Vec<Line> {
    let sets = Kind::TEST_SETS.map(|kind| kind.to_string());
    let mut found: BTreeMap<(usize, &Text), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        if let Some(set) = sets.iter().position(|set| row.set == set.as_str()) {
            found.entry((set, &row.method)).or_default().push(row);
        }
    }
    found.into_iter().map(|((set, method), rows)| line(set, method, rows)).collect()
}

fn line(set: usize, method: &Text, rows: Vec<&Row>) -> Line {
    let has_cfar = rows.iter().all(|row| row.cfar_false_alarm.is_some());
    let tally = Tally::of(rows);
    let rate = |column| match tally.estimate(column) {
        estimate if estimate.mean.is_finite() => with_error(estimate, 100.0, 2),
        _ => "–".to_owned(),
    };
    let eta = if tally.has_one_eta() { eta_text(tally.eta()) } else { format!("{:.4}, mean", tally.eta()) };
    let optimiser = Some(tally.optimiser()).filter(|optimiser| !optimiser.is_empty());
    let optimiser = optimiser.map_or_else(String::new, |optimiser| format!("\n{}", optimiser.replace(", ", ",\n")));
    let [detection, false_alarm, at_printed] =
        [Column::Detection, Column::FalseAlarm, Column::DetectionAtPrinted].map(rate);
    Line {
        set,
        label: format!("{method}\nη = {eta}{optimiser}"),
        scenes: tally.scenes(),
        figures: [with_error(tally.squared_error(), 1.0, 0), detection, false_alarm, at_printed],
        cfar: has_cfar.then(|| [Column::CfarDetection, Column::CfarFalseAlarm].map(rate)),
        milliseconds: format!("{:.1}", tally.median_milliseconds()),
    }
}

fn tables(ui: &mut Ui, lines: &[Line]) {
    for (set, name) in SET_CONTENTS.iter().enumerate() {
        let lines: Vec<&Line> = lines.iter().filter(|line| line.set == set).collect();
        if lines.is_empty() {
            continue;
        }
        ui.strong(format!("Table 4.{}: {name}", set + 1));
        let has_cfar = lines.iter().any(|line| line.cfar.is_some());
        let grid = Grid::new(("table", set)).num_columns(if has_cfar { 8 } else { 6 }).striped(true);
        grid.spacing([8.0, 3.0]).show(ui, |ui| {
            let at = format!("P_D % at\nP_FA {:.2} %\n(own η)", 100.0 * PRINTED_EXPERIMENT_2[set].false_alarm);
            for title in ["", "SE", "P_D %", "P_FA %"] {
                ui.weak(title);
            }
            ui.weak(&at).on_hover_text(
                "Every scene has a threshold of its own here, which holds its P_FA to the printed one.\n\
                 The printed P_D is at one threshold for all scenes: it belongs to the column P_D %.",
            );
            if has_cfar {
                let tip = "Each cell is held against the cells around it, by the detector of the Settings panel";
                ui.weak("P_D %\nby CFAR").on_hover_text(tip);
                ui.weak("P_FA %\nby CFAR").on_hover_text(tip);
            }
            ui.weak("ms");
            ui.end_row();
            for (name, columns) in PRINTED_COLUMNS {
                let printed = columns[set];
                ui.weak(name);
                ui.monospace(format!("{:.0}", printed.squared_error));
                for rate in [printed.detection, printed.false_alarm] {
                    ui.monospace(format!("{:.2}", 100.0 * rate));
                }
                ui.end_row();
            }
            for line in lines {
                let scenes = counted(line.scenes, "scene", "scenes");
                ui.strong(&line.label)
                    .on_hover_text(format!("{scenes}; mean ± standard error, and the median in brackets"));
                line.figures.iter().for_each(|figure| _ = ui.monospace(figure));
                for i in 0..if has_cfar { 2 } else { 0 } {
                    ui.monospace(line.cfar.as_ref().map_or("–", |rates| &rates[i]));
                }
                ui.monospace(&line.milliseconds);
                ui.end_row();
            }
        });
        ui.add_space(8.0);
    }
}

/// Text of a mean, with its standard error and the median in lines of their own, which keeps the column narrow.
fn with_error(Estimate { mean, standard_error, median }: Estimate, scale: f64, digits: usize) -> String {
    let [mean, standard_error, median] = [mean, standard_error, median].map(|v| format!("{:.digits$}", scale * v));
    format!("{mean}\n± {standard_error}\n({median})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::jobs::some_row;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};
    use crate::radar::{Carrier, WindowFunction};

    #[test]
    fn the_method_in_use_is_tried_on_the_test_sets() {
        let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        let mut evaluation = seen::asking([700.0, 300.0], |ui| {
            show(ui, Input { method: Some("capon"), radar: &radar, progress: None, lines: &[], note: None })
        });
        evaluation.clicks(&["Evaluate"]);
        let [Command::Rows(RowsCommand::Try(choice))] = evaluation.state().as_slice() else { panic!("one choice") };
        assert_eq!((choice.methods.as_slice(), choice.kinds.as_slice()), (&["capon"][..], &Kind::TEST_SETS[..]));
        let _told = evaluation.get_by_label_contains("With a two-way carrier");
    }

    #[test]
    fn a_panel_of_the_window_has_room_for_every_column() {
        let estimate = |mean, standard_error| Estimate { mean, standard_error, median: mean };
        let rate = |mean, standard_error| with_error(estimate(mean, standard_error), 100.0, 2);
        let squared_error = with_error(estimate(12_345.6, 1234.5), 1.0, 0);
        let line = Line {
            set: 2,
            label: "linear-prediction\nη = 0.8512345\nAdamW,\nthen Muon".to_owned(),
            scenes: 100,
            figures: [squared_error, rate(0.99351, 0.10123), rate(0.10163, 0.10012), rate(1.0, 0.0)],
            cfar: None,
            milliseconds: "1234.5".to_owned(),
        };
        let radar = Radar::default();
        let evaluation = Harness::builder().with_size([460.0, 480.0]).build_ui(move |ui| {
            let lines = std::slice::from_ref(&line);
            _ = show(ui, Input { method: None, radar: &radar, progress: None, lines, note: None });
        });
        seen::assert_readable(evaluation.output());
        assert!(evaluation.reads("1234.5"), "the last column");
    }

    #[test]
    fn rows_of_test_sets_become_the_printed_tables() {
        let other = Row { set: "walls".into(), ..some_row(2, "live") };
        let rows = [some_row(0, "live"), some_row(1, "live"), some_row(0, "capon"), other];
        let found = lines(&rows);
        let told: Vec<(usize, &str, usize)> =
            found.iter().map(|line| (line.set, line.label.lines().next().unwrap(), line.scenes)).collect();
        assert_eq!(told, [(0, "capon", 1), (0, "live", 2)]);
        assert!(found.iter().all(|line| line.cfar.is_none()));
    }

    #[test]
    fn a_radar_that_the_tables_do_not_know_is_told() {
        assert_eq!(unlike_the_thesis(&Radar::default()), None);
        let hamming = Radar { window: WindowFunction::Hamming, ..Radar::default() };
        assert!(unlike_the_thesis(&hamming).unwrap().contains("hamming"));
        let small = Radar { elements: 128, ..Radar::default() };
        assert!(unlike_the_thesis(&small).unwrap().contains("128 elements"));
    }
}
