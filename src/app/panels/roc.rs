//! The ROC panel: detection against false alarm of the scene on screen, over every threshold.

use crate::app::content::{Content, Cx};
use crate::app::jobs::Want;
use crate::app::state::{Command, MethodSlot};
use crate::app::widgets::legend::{self, Sign};
use crate::app::widgets::{Axis, Chart, Inks, Tick, percent};
use crate::evaluate::{Metrics, RocPoint, eta_text};
use crate::maps::cfar::Cfar;
use eframe::egui::{self, Sense, Stroke, Ui};
use egui_plot::LineStyle;

/// Least P_FA of the logarithmic axis; smaller ones are drawn there.
const MIN_DRAWN_P_FA: f64 = 1e-5;

/// Marks of P_FA: powers of ten.
const FALSE_ALARM_MARKS: [(f64, &str); 6] =
    [(-5.0, "≤0.001"), (-4.0, "0.01"), (-3.0, "0.1"), (-2.0, "1"), (-1.0, "10"), (0.0, "100")];

/// The characteristic, and the threshold in use.
pub struct Input<'a> {
    /// Rates of every threshold, if there are any.
    pub points: Option<&'a [RocPoint]>,
    pub method: &'a str,
    pub eta: f32,
    /// The detector in place of the threshold, if one is in use.
    pub cfar: Option<Cfar>,
    /// Figures of the output at the threshold in use; the characteristic may only have thresholds near it.
    pub metrics: Option<Metrics>,
    pub refusal: Option<&'a str>,
}

pub const PANEL: Content = Content { wants: &[Want::Output, Want::Roc], tells_answers: true, ..Content::drawn(draw) };

fn draw(ui: &mut Ui, cx: Cx<'_>) -> Vec<Command> {
    let (state, pipeline) = (&*cx.state, &cx.jobs.pipeline);
    let shown = pipeline.maps.result();
    let points = pipeline.output().and(shown).and_then(|r| r.roc.as_deref()).map(Vec::as_slice);
    let method = pipeline.output().map_or("output", |o| o.method());
    let refusal = pipeline.method(MethodSlot::First).refusal().map(|r| r.reason.as_str());
    let eta = pipeline.eta(state, MethodSlot::First);
    let cfar = state.settings.cfar;
    let is_now = shown.is_some_and(|r| r.request.etas[0] == eta && r.request.cfar == cfar);
    let metrics = pipeline.scores_in(MethodSlot::First).filter(|_| is_now).map(|scores| scores.metrics);
    show(ui, Input { points, method, eta, cfar, metrics, refusal })
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    let Some(roc) = input.points else {
        ui.centered_and_justified(|ui| ui.weak(input.refusal.unwrap_or("No ROC: the target has no cell above 0.9.")));
        return Vec::new();
    };
    let place = |p: &RocPoint| [p.false_alarm.max(MIN_DRAWN_P_FA).log10(), 100.0 * p.detection];
    let nearest = |eta: f32| roc.iter().min_by(|a, b| (a.eta - eta).abs().total_cmp(&(b.eta - eta).abs()));
    let at_eta = |m: Metrics| Some(RocPoint { eta: input.eta, detection: m.detection?, false_alarm: m.false_alarm });
    let at_threshold = || nearest(input.eta).copied().filter(|_| input.cfar.is_none());
    let now = input.metrics.and_then(at_eta).or_else(at_threshold);
    let (line, mark) = (Inks::of(ui.visuals()).selected, Inks::of(ui.visuals()).ends[0]);
    egui::Frame::NONE.inner_margin(egui::Margin { left: 8, right: 8, top: 4, bottom: 0 }).show(ui, |ui| {
        let mut entries = vec![(Sign::Line, line, input.method.to_owned())];
        if let Some(now) = &now {
            let rates = format!("P_D {}, P_FA {}", percent(now.detection), percent(now.false_alarm));
            let name = match input.cfar {
                None => format!("η = {}: {rates}", eta_text(input.eta)),
                Some(cfar) => format!("{}: {rates}", cfar.statistic.name()),
            };
            entries.push((Sign::Circle { filled: true }, mark, name));
        }
        legend::row(ui, &entries);
    });
    let ticks = FALSE_ALARM_MARKS.map(|(value, text)| Tick { value, text: text.to_owned() });
    let x = Axis { ticks: Some(&ticks), ..Axis::new(MIN_DRAWN_P_FA.log10(), 0.0, "P_FA, %") };
    let mut chart = Chart::new("Receiver operating characteristic", x, Axis::new(0.0, 102.0, "P_D, %"));
    chart.line(roc.iter().map(place), Stroke::new(1.8, line), LineStyle::Solid);
    if let Some(now) = &now {
        chart.dot(place(now), 5.0, mark);
    }
    let area = ui.available_rect_before_wrap();
    let drawn = chart.show(ui, area, Sense::hover());
    drawn.tell(|[at, _]| {
        let p = roc.iter().min_by(|a, b| (place(a)[0] - at).abs().total_cmp(&(place(b)[0] - at).abs()))?;
        Some(format!("η = {}\nP_D {}\nP_FA {}", eta_text(p.eta), percent(p.detection), percent(p.false_alarm)))
    });
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable};

    #[test]
    fn a_scene_without_a_characteristic_is_told() {
        let input = || Input { points: None, method: "baseline", eta: 0.5, cfar: None, metrics: None, refusal: None };
        let roc = seen::asking([800.0, 600.0], |ui| show(ui, input()));
        let _told = roc.get_by_label_contains("No ROC");
        assert!(roc.state().is_empty());
    }

    #[test]
    fn both_axes_reach_a_hundred_percent() {
        for size in [[270.0, 150.0], [450.0, 270.0], [1200.0, 700.0]] {
            let roc = Harness::builder().with_size(size).build_ui(|ui| {
                let point = |i: u16| {
                    let part = f64::from(i) / 100.0;
                    RocPoint { eta: 1.0 - part as f32, detection: part.sqrt(), false_alarm: part * part }
                };
                let points: Vec<RocPoint> = (0..=100).map(point).collect();
                let metrics = Some(Metrics { squared_error: 1.0, detection: Some(0.4466), false_alarm: 0.0398 });
                let (points, method) = (Some(points.as_slice()), "live");
                _ = show(ui, Input { points, method, eta: 0.8, cfar: None, metrics, refusal: None });
            });
            seen::assert_readable(roc.output());
            let texts = seen::texts(roc.output());
            let count = |text: &str| texts.iter().filter(|t| t.text == text).count();
            assert_eq!((count("100"), count("P_FA, %"), count("≤0.001")), (2, 1, 1), "{size:?}: {texts:?}");
            assert_eq!(count("η = 0.80: P_D 44.66 %, P_FA 3.98 %"), 1, "the figures on screen: {texts:?}");
        }
    }
}
