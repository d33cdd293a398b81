//! The evaluation panel: methods on the test sets of the tables, beside the figures that the thesis prints.

use crate::app::content::{Content, Cx, Nothing};
use crate::app::jobs::{EvaluationRow, Memo, evaluated};
use crate::app::state::{Command, ExportCommand, FailureChoice, RowsCommand};
use crate::app::widgets::padded::{scrolled_both, warning};
use crate::app::widgets::progress::{bar, start_or_cancel};
use crate::evaluate::eta_text;
use crate::evaluate::tables::{Estimate, PRINTED_BASELINE, PRINTED_EXPERIMENT_1, PRINTED_EXPERIMENT_2, Printed};
use crate::radar::{Radar, counted};
use crate::scene::generate::Kind;
use eframe::egui::{Grid, Ui};

/// The printed columns with their headings.
const PRINTED: [(&str, [Printed; 3]); 3] = [
    ("thesis: baseline", PRINTED_BASELINE),
    ("thesis: exp. 1", PRINTED_EXPERIMENT_1),
    ("thesis: exp. 2", PRINTED_EXPERIMENT_2),
];

/// Contents of the test sets.
const SETS: [&str; 3] = ["one point", "3 to 6 points", "points and lines"];

/// The summarised rows, and the state of the current run.
pub struct Input<'a> {
    /// The method in use, which can be tried on the test sets from here.
    pub method: Option<&'static str>,
    /// Radar of the rows, or of the next run where there are no rows.
    pub radar: &'a Radar,
    /// Completed part of the run, 0 to 1, while methods are tried.
    pub progress: Option<f32>,
    /// Figures of each method on each test set.
    pub rows: &'a [EvaluationRow],
    /// Message of the last run, where it did not succeed.
    pub note: Option<&'a str>,
}

/// Scenes of each set that the button tries.
const SCENES_A_SET: u32 = 10;

pub struct EvaluationPanel;

impl Content for EvaluationPanel {
    type Asks = Nothing;
    /// The summary of the rows, kept for one version of them.
    type Remembers = Memo<u64, Vec<EvaluationRow>>;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let (state, job) = (&*cx.state, &cx.jobs.failures);
        let table = job.table();
        let rows = &*cx.memory.of(table.version(), |_| evaluated(table.rows()));
        let input = Input {
            method: state.method().map(|m| m.name()),
            radar: if rows.is_empty() { state.radar() } else { &table.conditions().radar },
            progress: job.progress(),
            rows,
            note: job.note(),
        };
        show(ui, input)
    }
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    scrolled_both(ui, |ui, asked| {
        buttons(ui, &input, asked);
        warning(ui, input.note);
        warning(ui, unlike_the_thesis(input.radar).as_deref());
        ui.separator();
        if input.rows.is_empty() {
            ui.weak("Tables 4.1 to 4.3 of the thesis for the methods that were tried on sets 1 to 3. Rows tries any method on any number of scenes.");
        }
        tables(ui, input.rows);
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
            let choice = FailureChoice { methods, kinds, own: false, count: SCENES_A_SET, seed: 0 };
            asked.push(RowsCommand::Try(choice).into());
        }
        if !input.rows.is_empty()
            && ui.button("Copy as CSV").on_hover_text("Copy the tables to the clipboard").clicked()
        {
            asked.push(ExportCommand::CopyEvaluation.into());
        }
        if let Some(part) = input.progress {
            bar(ui, part, 180.0);
        }
    });
}

fn tables(ui: &mut Ui, rows: &[EvaluationRow]) {
    for set in 1..=3 {
        if !rows.iter().any(|r| r.set == set) {
            continue;
        }
        ui.strong(format!("Table 4.{set}: {}", SETS[set - 1]));
        let has_cfar = rows.iter().any(|r| r.set == set && r.cfar.is_some());
        Grid::new(("table", set)).num_columns(if has_cfar { 8 } else { 6 }).striped(true).spacing([8.0, 3.0]).show(
            ui,
            |ui| {
                let at = format!("P_D % at\nP_FA {:.2} %\n(own η)", 100.0 * PRINTED_EXPERIMENT_2[set - 1].false_alarm);
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
                for (name, columns) in PRINTED {
                    let printed = columns[set - 1];
                    ui.weak(name);
                    ui.monospace(format!("{:.0}", printed.squared_error));
                    ui.monospace(format!("{:.2}", 100.0 * printed.detection));
                    ui.monospace(format!("{:.2}", 100.0 * printed.false_alarm));
                    ui.end_row();
                }
                for row in rows.iter().filter(|r| r.set == set) {
                    let scenes = counted(row.scenes, "scene", "scenes");
                    ui.strong(label(row))
                        .on_hover_text(format!("{scenes}; mean ± standard error, and the median in brackets"));
                    ui.monospace(with_error(row.squared_error, 1.0, 0));
                    ui.monospace(with_error(row.detection, 100.0, 2));
                    ui.monospace(with_error(row.false_alarm, 100.0, 2));
                    ui.monospace(row.detection_at_printed.map_or("–".to_owned(), |d| with_error(d, 100.0, 2)));
                    if has_cfar {
                        let rate = |i: usize| row.cfar.map_or("–".to_owned(), |rates| with_error(rates[i], 100.0, 2));
                        ui.monospace(rate(0));
                        ui.monospace(rate(1));
                    }
                    ui.monospace(format!("{:.1}", row.median_milliseconds));
                    ui.end_row();
                }
            },
        );
        ui.add_space(8.0);
    }
}

/// Text of a method's name, its threshold, and the optimisers of its weights.
fn label(row: &EvaluationRow) -> String {
    let eta = if row.one_eta { eta_text(row.eta) } else { format!("{:.4}, mean", row.eta) };
    let optimiser =
        if row.optimiser.is_empty() { String::new() } else { format!("\n{}", row.optimiser.replace(", ", ",\n")) };
    format!("{}\nη = {eta}{optimiser}", row.method)
}

/// Text of a mean, with its standard error and the median in lines of their own, which keeps the column narrow.
fn with_error(Estimate { mean, standard_error, median }: Estimate, scale: f64, digits: usize) -> String {
    let [mean, standard_error, median] = [mean, standard_error, median].map(|v| format!("{:.digits$}", scale * v));
    format!("{mean}\n± {standard_error}\n({median})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use crate::radar::{Carrier, WindowFunction};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn the_method_in_use_is_tried_on_the_test_sets() {
        let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        let draw = |ui: &mut Ui, asked: &mut Vec<Command>| {
            let input = Input { method: Some("capon"), radar: &radar, progress: None, rows: &[], note: None };
            asked.extend(show(ui, input));
        };
        let mut evaluation = Harness::builder().with_size([700.0, 300.0]).build_ui_state(draw, Vec::new());
        evaluation.get_by_label("Evaluate").click();
        evaluation.step();
        let [Command::Rows(RowsCommand::Try(choice))] = evaluation.state().as_slice() else { panic!("one choice") };
        assert_eq!((choice.methods.as_slice(), choice.kinds.as_slice()), (&["capon"][..], &Kind::TEST_SETS[..]));
        let _told = evaluation.get_by_label_contains("With a two-way carrier");
    }

    #[test]
    fn a_panel_of_the_window_has_room_for_every_column() {
        let estimate = |mean, standard_error| Estimate { mean, standard_error, median: mean };
        let row = EvaluationRow {
            set: 3,
            method: "linear-prediction".into(),
            optimiser: "AdamW, then Muon".into(),
            eta: 0.851_234_5,
            one_eta: true,
            scenes: 100,
            squared_error: estimate(12_345.6, 1234.5),
            detection: estimate(0.99351, 0.10123),
            false_alarm: estimate(0.10163, 0.10012),
            detection_at_printed: Some(estimate(1.0, 0.0)),
            cfar: None,
            median_milliseconds: 1234.5,
        };
        let radar = Radar::default();
        let evaluation = Harness::builder().with_size([460.0, 480.0]).build_ui(move |ui| {
            let rows = std::slice::from_ref(&row);
            _ = show(ui, Input { method: None, radar: &radar, progress: None, rows, note: None });
        });
        seen::assert_readable(evaluation.output());
        let texts = seen::texts(evaluation.output());
        assert!(texts.iter().any(|t| t.text == "1234.5"), "the last column: {texts:?}");
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
