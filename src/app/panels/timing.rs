//! The timing panel: duration of each stage of the last update, and the skipped stages with their reasons.

use crate::app::content::{Content, Cx};
use crate::app::state::Command;
use crate::app::widgets::{headings, scrolled};
use crate::engine::{EngineReport, StageOutcome};
use eframe::egui::{Grid, Label, RichText, Ui};
use std::time::Duration;

pub struct Update<'a> {
    pub report: &'a EngineReport,
    /// Duration of the update with its pictures.
    pub took: Duration,
    /// Pictures painted since the start.
    pub painted: u64,
    pub output: Option<(&'static str, Duration)>,
    /// Whether that output is of an earlier scene or of another method.
    pub outdated: bool,
}

pub const PANEL: Content = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_>) -> Vec<Command> {
    let pipeline = &cx.jobs.pipeline;
    let update = pipeline.maps.result().map(|r| Update {
        report: &r.frame.report,
        took: r.took,
        painted: r.painted,
        output: pipeline.output().map(|o| (o.method(), o.took)),
        outdated: pipeline.output_is_outdated(),
    });
    show(ui, update)
}

pub fn show(ui: &mut Ui, update: Option<Update<'_>>) -> Vec<Command> {
    let Some(update) = update else {
        ui.weak("No update yet.");
        return Vec::new();
    };
    scrolled(ui, |ui, _| {
        Grid::new("stages").num_columns(3).striped(true).show(ui, |ui| table(ui, &update));
    })
}

/// Draws a row: a name, a duration if there is one, and a text, which may take several lines.
fn row(ui: &mut Ui, name: &str, took: Option<Duration>, text: RichText) {
    ui.label(name);
    match took {
        Some(took) => ui.monospace(format!("{:.2}", took.as_secs_f64() * 1e3)),
        None => ui.weak("–"),
    };
    ui.add(Label::new(text).wrap());
    ui.end_row();
}

fn table(ui: &mut Ui, update: &Update<'_>) {
    headings(ui, ["stage", "ms", "what"].map(|heading| (heading, "")));
    for stage in &update.report.stages {
        let name = stage.stage.to_string();
        match &stage.outcome {
            StageOutcome::Computed(what) => row(ui, &name, Some(stage.took), RichText::new(what)),
            StageOutcome::Skipped(why) => row(ui, &name, None, RichText::new(format!("skipped: {why}")).weak()),
        }
    }
    row(ui, "engine", Some(update.report.total), RichText::new(""));
    let painted = format!("{} pictures painted since the start", update.painted);
    row(ui, "with pictures", Some(update.took), RichText::new(painted));
    if let Some((method, took)) = update.output {
        let text = if update.outdated { "out of date" } else { "on a thread of its own" };
        row(ui, method, Some(took), RichText::new(text));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Queryable};
    use crate::engine::{Engine, MapRequest};
    use crate::radar::Radar;
    use crate::scene::Scene;

    #[test]
    fn an_output_that_is_out_of_date_is_told() {
        let mut engine = Engine::new(Radar { elements: 64, samples: 32, ..Radar::default() });
        let frame = engine.update(&Scene::of_points([(0.0, 10.0)]), &MapRequest::default()).unwrap();
        let mut timing = seen::asking([280.0, 700.0], |ui| {
            let (report, took) = (&frame.report, Duration::from_millis(12));
            show(ui, Some(Update { report, took, painted: 7, output: Some(("capon", took)), outdated: true }))
        });
        timing.run_steps(3);
        seen::assert_readable(timing.output());
        let _told = timing.get_by_label("out of date");
        let _counted = timing.get_by_label("7 pictures painted since the start");
        assert!(timing.state().is_empty());
    }
}
