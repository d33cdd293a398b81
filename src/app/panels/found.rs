//! The found panel: the method's echoes as a list of angle, range and strength.

mod attempts;

use crate::app::content::{Content, Cx, Nothing};
use crate::app::jobs::Wants;
use crate::app::state::{Command, MapKind, MethodSlot};
use crate::app::widgets::{CONVENTION, angle_degrees, padded, plain, signed};
use crate::reconstruct::{Attempt, Detection};
use crate::scene::Object;
use eframe::egui::{Align, Grid, Layout, ScrollArea, Ui};

/// Most lines that are shown.
const LINES: usize = 200;

/// Opacity of a list that belongs to an earlier scene.
const OLD_OPACITY: f32 = 0.45;

/// Tooltip of the last column.
const NEEDED: &str = "How far the samples need this echo: of the energy around its range that the other echoes leave unexplained, the part \
    that it explains. Low: the other echoes, noise or side lobes would do without it. – where the method does not say";

/// The list of echoes, and the state of the method.
pub struct Input<'a> {
    /// Name of the method in use, where it draws a map and lists no echoes.
    pub draws_only: Option<&'static str>,
    /// The method whose output is shown.
    pub method: Option<&'static str>,
    /// The found echoes, the strongest first; `None` until the list is computed.
    pub found: Option<&'a [Detection]>,
    /// Attempts of the method's search, in their order.
    pub attempts: &'a [Attempt],
    /// The objects of the scene on screen.
    pub objects: &'a [Object],
    /// The method's refusal, the reason for a missing output.
    pub refusal: Option<&'a str>,
    /// Whether the list has belonged to an earlier scene for so long that the panel says so.
    pub stale: bool,
    /// Whether the echoes have ranges; a single sample measures none.
    pub has_ranges: bool,
}

pub struct FoundPanel;

impl Content for FoundPanel {
    type Asks = Nothing;
    type Remembers = ();
    const WANTS: Wants = Wants { listed: true, ..Wants::OUTPUT };
    const MARKS_AGE: bool = true;
    const TELLS_ANSWERS: bool = true;

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let (state, pipeline) = (&*cx.state, &cx.jobs.pipeline);
        let output = pipeline.output_of(state);
        let recording = state.editor.document().recording();
        let input = Input {
            draws_only: state.method().map(|m| m.name()).filter(|_| !state.finds_reflectors()),
            method: output.map(|o| o.method()),
            found: output.and_then(|o| o.found.as_deref()),
            attempts: output.map_or(&[], |o| o.attempts.as_slice()),
            objects: &state.editor.scene().objects,
            refusal: pipeline.method(MethodSlot::First).refusal().map(|r| r.reason.as_str()),
            stale: pipeline.is_stale(MapKind::Output),
            has_ranges: state.radar().samples > 1 || recording.is_some_and(|r| r.range_metres.is_some()),
        };
        show(ui, input)
    }
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    padded(ui, |ui, asked| {
        if let Some(method) = input.draws_only {
            ui.weak(format!("{method} draws a map and finds no echoes to list. Choose another method in Settings."));
            return;
        }
        let Some((method, found)) = input.method.zip(input.found).filter(|_| input.refusal.is_none()) else {
            match input.refusal {
                Some(reason) => _ = ui.colored_label(ui.visuals().error_fg_color, reason),
                None => _ = ui.weak("Nothing is listed yet."),
            }
            return;
        };
        if input.stale {
            ui.weak("out of date; updating…");
            ui.set_opacity(OLD_OPACITY);
        }
        let more = found.len().saturating_sub(LINES);
        ui.weak(match found.len() {
            0 => format!("{method} found nothing."),
            1 => format!("{method} found one echo"),
            count => format!("{method} found {count} echoes, the strongest first"),
        });
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("found").num_columns(6).striped(true).spacing([18.0, 3.0]).show(ui, |ui| {
                if !found.is_empty() {
                    for (heading, tooltip) in [
                        ("", ""),
                        ("angle", CONVENTION),
                        ("cos θ", "Cosine of the angle to the array's axis, as the maps count directions"),
                        ("range", "From the centre of the array"),
                        ("dB", "Power of the echo, relative to the strongest"),
                        ("needed", NEEDED),
                    ] {
                        ui.strong(heading).on_hover_text(tooltip);
                    }
                    ui.end_row();
                }
                found.iter().take(LINES).enumerate().for_each(|(i, d)| line(ui, i + 1, d, input.has_ranges));
            });
            if more > 0 {
                ui.weak(format!("and {more} weaker ones"));
            }
            asked.extend(attempts::show(ui, input.attempts, input.objects));
        });
    })
}

fn line(ui: &mut Ui, number: usize, found: &Detection, has_ranges: bool) {
    ui.weak(number.to_string());
    let range = if has_ranges { format!("{:.2} m", found.range_metres) } else { "–".to_owned() };
    let angle = format!("{}°", signed(angle_degrees(found.cos_theta), 2));
    for text in [angle, signed(found.cos_theta, 4), range] {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.monospace(text));
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.monospace(plain(found.relative_power.0, 1)));
    // The last column takes all the room that is left: nothing is aligned to its end.
    ui.monospace(found.confidence.map_or("–".to_owned(), |c| format!("{:.0} %", 100.0 * c)));
    ui.end_row();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn panel(found: Option<Vec<Detection>>, change: fn(Input<'_>) -> Input<'_>) -> Harness<'static> {
        let mut panel = Harness::builder().with_size([360.0, 300.0]).build_ui(move |ui| {
            let input = Input {
                draws_only: None,
                method: Some("iaa"),
                found: found.as_deref(),
                attempts: &[],
                objects: &[],
                refusal: None,
                stale: false,
                has_ranges: true,
            };
            assert!(show(ui, change(input)).is_empty());
        });
        panel.run();
        panel
    }

    fn detection(degrees: f64, range_metres: f64, db: f64) -> Detection {
        let relative_power = Decibels(db);
        Detection {
            cos_theta: degrees.to_radians().sin(),
            range_metres,
            relative_power,
            confidence: Some(0.4 + 0.1 * db),
        }
    }

    fn two() -> Vec<Detection> {
        vec![detection(6.96, 15.0, 0.0), detection(-3.5, 7.25, -2.04)]
    }

    #[test]
    fn angles_ranges_and_decibels_are_listed() {
        let shown = panel(Some(two()), |input| input);
        let _told = [
            "iaa found 2 echoes, the strongest first",
            "+6.96°",
            "+0.1212",
            "15.00 m",
            "40 %",
            "−3.50°",
            "7.25 m",
            "−2.0",
            "20 %",
        ]
        .map(|text| shown.get_by_label(text));
    }

    #[test]
    fn what_is_not_listed_is_told() {
        let many = (0..250).map(|i| detection(0.0, f64::from(i), -1.0)).collect();
        type Case = (Option<Vec<Detection>>, fn(Input<'_>) -> Input<'_>, &'static str);
        let cases: [Case; 4] = [
            (Some(two()), |input| Input { draws_only: Some("live"), ..input }, "live draws a map"),
            (Some(Vec::new()), |input| input, "iaa found nothing."),
            (Some(many), |input| input, "and 50 weaker ones"),
            (None, |input| Input { refusal: Some("needs 4 samples"), ..input }, "needs 4 samples"),
        ];
        for (found, change, told) in cases {
            let panel = panel(found, change);
            assert!(panel.query_by_label_contains(told).is_some(), "{told}");
            assert!(panel.query_by_label("15.00 m").is_none() || told.contains("weaker"), "{told}");
        }
        let snapshot = panel(Some(two()), |input| Input { has_ranges: false, ..input });
        assert!(snapshot.query_by_label("15.00 m").is_none(), "one sample tells no range");
    }
}
