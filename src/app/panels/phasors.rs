//! The phasors panel: the contribution of every element to the cell under the cursor, added head to tail in the complex plane.

use crate::app::content::Content;
use crate::app::jobs::{PhasorsQuery, PhasorsResult};
use crate::app::state::{Command, PhasorMap, PhasorSettings, State, ViewCommand};
use crate::app::widgets::legend::{self, Sign};
use crate::app::widgets::{
    Axis, Chart, Computed, Drawn, Inks, MARK, computed, direction, edged, empty_text, labelled, padded, plain,
    scientific, significant,
};
use crate::radar::{End, Radar};
use crate::theory::Phasors;
use eframe::egui::{self, Color32, Sense, Slider, Stroke, Ui, emath::Rot2};
use egui_plot::LineStyle;
use num_complex::Complex64;

/// Duration of playing the whole array, seconds.
const PLAY_SECONDS: f32 = 4.0;

const ARROW_HEAD_POINTS: f32 = 12.0;

/// Progress of playing the chain.
#[derive(Default)]
pub struct PhasorsMemory {
    /// Part of the elements that is drawn; `None` for all.
    part: Option<f32>,
    is_playing: bool,
}

pub const PANEL: Content<PhasorsMemory, PhasorsQuery> = Content {
    tells_answers: true,
    ..Content::computed(
        |state, jobs| PhasorsQuery::of(state, &jobs.pipeline),
        |ui, cx| show(ui, cx.state, cx.value, cx.memory),
    )
};

pub fn show(
    ui: &mut Ui,
    state: &State,
    result: Computed<'_, PhasorsResult>,
    memory: &mut PhasorsMemory,
) -> Vec<Command> {
    padded(ui, |ui, asked| {
        let mut settings = state.settings.phasors;
        choices(ui, state, &mut settings);
        if settings != state.settings.phasors {
            asked.push(ViewCommand::SetPhasors(settings).into());
        }
        let Some(result) = computed(ui, result) else { return };
        play(ui, result, memory);
        said(ui, state.radar(), result);
        chart(ui, state.radar(), result, memory.part.unwrap_or(1.0));
    })
}

fn choices(ui: &mut Ui, state: &State, settings: &mut PhasorSettings) {
    ui.horizontal_wrapped(|ui| {
        for map in PhasorMap::ALL {
            ui.selectable_value(&mut settings.map, map, map.name()).on_hover_text("The map whose cell is taken apart");
        }
        ui.add_space(6.0);
        ui.checkbox(&mut settings.windowed, "Window").on_hover_text(
            "Weigh the elements by the window, as the map does. Without it every element counts alike.",
        );
        ui.checkbox(&mut settings.focused, "Focused").on_hover_text(
            "Also draw the chain without the curvature of the wave from this place: a near reflector's chain becomes straight.",
        );
        let echoes = egui::Checkbox::new(&mut settings.echoes, "Echoes alone");
        ui.add_enabled(!state.is_recorded(), echoes)
            .on_hover_text("Also draw the chain of the scene's echoes without noise")
            .on_disabled_hover_text("A recording is echoes and noise together.");
        let residual = egui::Checkbox::new(&mut settings.residual, "Residual");
        ui.add_enabled(state.finds_reflectors(), residual)
            .on_hover_text("Also draw the chain of what the method's reflectors leave")
            .on_disabled_hover_text("The chosen method draws a map and names no reflectors.");
    });
}

fn play(ui: &mut Ui, result: &PhasorsResult, memory: &mut PhasorsMemory) {
    let count = result.measured.contributions.len();
    ui.horizontal(|ui| {
        let label = if memory.is_playing { "Pause" } else { "Play" };
        if ui.button(label).on_hover_text("Add the elements one after the other").clicked() {
            memory.is_playing = !memory.is_playing;
            if memory.is_playing && memory.part.is_none_or(|part| part >= 1.0) {
                memory.part = Some(0.0);
            }
        }
        if memory.is_playing {
            let part = memory.part.unwrap_or(0.0) + ui.input(|i| i.stable_dt.min(0.1)) / PLAY_SECONDS;
            memory.is_playing = part < 1.0;
            memory.part = (part < 1.0).then_some(part);
            ui.ctx().request_repaint();
        }
        let mut drawn = drawn_count(memory.part.unwrap_or(1.0), count);
        let tooltip = "How many elements of the aperture are added, from the left";
        if labelled(ui, "Elements", tooltip, Slider::new(&mut drawn, 0..=count)).changed() {
            memory.is_playing = false;
            memory.part = (drawn < count).then(|| drawn as f32 / count as f32);
        }
    });
}

fn drawn_count(part: f32, count: usize) -> usize {
    (part * count as f32).round() as usize
}

/// Writes place, amplitude and phase of the cell.
fn said(ui: &mut Ui, radar: &Radar, result: &PhasorsResult) {
    let [bin, column] = result.cell;
    let (sum, length) = (result.measured.sum(), whole_length(&result.measured));
    let part = if length > 0.0 { 100.0 * sum.norm() / length } else { 0.0 };
    let (way, range) = (direction(radar.cos_of_column(column as f64), 1), radar.range_of_bin_metres(bin as f64));
    let phase = plain(sum.arg().to_degrees(), 0);
    let amplitude = match sum.norm() {
        usual if (1e-3..1e5).contains(&usual) => significant(usual),
        other => scientific(other, 2),
    };
    let share = format!("{part:.1} % of the length of all contributions");
    ui.label(format!("{way}, {range:.2} m: amplitude {amplitude}, phase {phase}°; {share}"))
        .on_hover_text("100 % where all contributions have one phase, 0 % where they cancel");
}

fn whole_length(chain: &Phasors) -> f64 {
    chain.contributions.iter().map(|c| c.norm()).sum()
}

/// Draws the chains in the complex plane, both axes to one scale.
fn chart(ui: &mut Ui, radar: &Radar, result: &PhasorsResult, part: f32) {
    let drawn = drawn(ui, result);
    if drawn.len() > 1 {
        let entry = |(_, name, colour, _): &Drawable<'_>| (Sign::Line, *colour, (*name).to_owned());
        legend::row(ui, &drawn.iter().map(entry).collect::<Vec<_>>());
    }
    let area = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(area);
    let unit = whole_length(&result.measured);
    if unit <= 0.0 {
        empty_text(ui, area, "No element hears anything.");
        return;
    }
    let place = |z: &Complex64| [z.re / unit, z.im / unit];
    let chains: Vec<Vec<[f64; 2]>> =
        drawn.iter().map(|(chain, ..)| chain.chain().iter().map(place).collect()).collect();
    let axis = |i: usize, title| {
        let values = chains.iter().flatten().map(|place| place[i]);
        let (low, high) = values.fold((0.0, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)));
        let room = 0.08 * (high - low).max(1e-6);
        Axis::new(low - room, high + room, title)
    };
    let (x, y) = (axis(0, "real part, of the length of all contributions"), axis(1, "imaginary part"));
    let mut chart = Chart::new("Phasors in the complex plane", x, y).with_one_scale();
    let count = drawn_count(part, result.measured.contributions.len());
    for (n, (chain, (_, _, colour, style))) in chains.iter().zip(drawn).enumerate() {
        let chain = &chain[..=count.min(chain.len() - 1)];
        chart.line(chain.iter().copied(), Stroke::new(1.4, colour), style);
        if n == 0 {
            ends(ui, &mut chart, radar, chain, result.measured.first_element);
        }
    }
    let drawn = chart.show(ui, area, Sense::hover());
    if let Some(end) = chains.first().and_then(|chain| chain.get(count)) {
        arrow(&drawn, *end);
    }
}

/// A chain with its name, its colour and its style.
type Drawable<'a> = (&'a Phasors, &'static str, Color32, LineStyle);

/// The chains, that of the samples first.
fn drawn<'a>(ui: &Ui, result: &'a PhasorsResult) -> Vec<Drawable<'a>> {
    let inks = Inks::of(ui.visuals());
    let all = [
        (Some(&result.measured), "all elements", inks.reflector, LineStyle::Solid),
        (result.focused.as_ref(), "focused", inks.selected, LineStyle::Solid),
        (result.echoes.as_ref(), "echoes alone", inks.grid_text, LineStyle::dashed_dense()),
        (result.residual.as_ref(), "residual", inks.found, LineStyle::Solid),
    ];
    all.into_iter().filter_map(|(chain, name, colour, style)| Some((chain?, name, colour, style))).collect()
}

/// Draws the pieces of the two ends of the array in their colours over a chain.
fn ends(ui: &Ui, chart: &mut Chart<'_>, radar: &Radar, chain: &[[f64; 2]], first_element: usize) {
    for (end, colour) in End::BOTH.into_iter().zip(Inks::of(ui.visuals()).ends) {
        let range = radar.end_range(end);
        let from = range.start.saturating_sub(first_element).min(chain.len());
        let to = (range.end + 1).saturating_sub(first_element).min(chain.len());
        if range.start >= first_element && from < to {
            chart.line(chain[from..to].iter().copied(), Stroke::new(3.0, colour), LineStyle::Solid);
        }
    }
}

fn arrow(drawn: &Drawn, end: [f64; 2]) {
    let (from, to) = (drawn.at([0.0, 0.0]), drawn.at(end));
    let back = ARROW_HEAD_POINTS * (from - to).normalized();
    let ends = [from, to + Rot2::from_angle(0.4) * back, to + Rot2::from_angle(-0.4) * back];
    edged([4.0, 1.8], MARK, |stroke| ends.map(|end| drawn.painter.line_segment([end, to], stroke)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};
    use crate::scene::Scene;

    fn result() -> PhasorsResult {
        let contributions = vec![Complex64::new(1.0, 0.0), Complex64::new(0.0, 1.0), Complex64::new(-1.0, 0.0)];
        let measured = Phasors { first_element: 0, contributions };
        PhasorsResult { cell: [10, 40], measured, focused: None, echoes: None, residual: None }
    }

    fn panel(result: Option<Result<PhasorsResult, &'static str>>) -> Harness<'static, (PhasorsMemory, Vec<Command>)> {
        let state = State::of(Radar { elements: 64, samples: 32, ..Radar::default() }, Scene::default());
        seen::asking_with([420.0, 360.0], PhasorsMemory::default(), move |ui, memory| {
            show(ui, &state, result.as_ref().map(|r| r.as_ref().map_err(|e| *e)), memory)
        })
    }

    #[test]
    fn the_cell_is_told_in_numbers_or_an_error_is_said() {
        let panel = panel(Some(Ok(result())));
        // 1 + j - 1 = j: a third of the length of three contributions.
        let _told = panel.get_by_label_contains("amplitude 1.00, phase 90°; 33.3 %");
        let _chart = panel.get_by_label("Phasors in the complex plane");
        let _said = self::panel(Some(Err("The two ends alone."))).get_by_label("The two ends alone.");
    }

    #[test]
    fn a_choice_asks_for_another_map() {
        let mut panel = panel(Some(Ok(result())));
        panel.clicks(&["Input 1"]);
        let wanted = PhasorSettings { map: PhasorMap::Input1, ..PhasorSettings::default() };
        assert_eq!(panel.state().1.first(), Some(&ViewCommand::SetPhasors(wanted).into()));
    }

    #[test]
    fn play_adds_one_element_after_the_other() {
        let mut panel = panel(Some(Ok(result())));
        panel.clicks(&["Play"]);
        let part = panel.state().0.part.unwrap();
        assert!(part > 0.0 && part < 1.0, "{part}");
        panel.clicks(&["Pause"]);
        assert!(!panel.state().0.is_playing);
    }
}
