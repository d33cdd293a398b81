//! The range-Doppler panel: the map of range against radial velocity, the radar's chirps, and the timeline on which the scene plays.

use super::recording::frame_slider;
use crate::app::content::Content;
use crate::app::jobs::{DopplerQuery, DopplerResult};
use crate::app::state::{Command, DocumentCommand, RadarCommand, State, TIMELINE_SECONDS, ViewCommand};
use crate::app::widgets::{
    Axis, Bar, Chart, Computed, Drawn, MARK, MARK_EDGE, NumberField, Texture, Tick, axes, colour_table, computed,
    edged, labelled, padded, plain, press, tick, warning, with_minuses,
};
use crate::maps::Normalisation;
use crate::radar::{MAX_CHIRPS, Radar};
use crate::theory::doppler::{DopplerBlob, folded};
use eframe::egui::{Align2, Sense, Slider, Stroke, TextureId, TextureOptions, Ui, vec2};
use egui_plot::{LineStyle, VLine};

/// Number of chirps that the button of an empty map sets.
const INITIAL_CHIRPS: usize = 128;

const MAX_MARKED_OBJECTS: usize = 200;

/// Longest interval of chirps that the field takes, microseconds, unless a chirp lasts longer.
const MAX_CHIRP_INTERVAL_MICROSECONDS: f64 = 1e5;

pub const PANEL: Content<Texture, DopplerQuery> = Content {
    tells_answers: true,
    ..Content::computed(|state, _| DopplerQuery::of(state), |ui, cx| show(ui, cx.state, cx.value, cx.memory))
};

pub fn show(ui: &mut Ui, state: &State, result: Computed<'_, DopplerResult>, texture: &mut Texture) -> Vec<Command> {
    padded(ui, |ui, asked| {
        chirps(ui, state, result, asked);
        match state.frames() {
            Some(frames) => frames_played(ui, state, frames, asked),
            None if state.is_recorded() => {}
            None => timeline(ui, state, asked),
        }
        said(ui, state, result, asked);
        let has_loops = if state.is_recorded() { result.is_some() } else { state.radar().chirps > 1 };
        if let Some(result) = has_loops.then(|| computed(ui, result)).flatten() {
            let texture = texture.of(ui.ctx(), "range-Doppler", &result.image, TextureOptions::NEAREST);
            map(ui, state, result, texture);
        }
    })
}

/// Draws the fields of the chirps' number and interval, and the velocities that follow.
fn chirps(ui: &mut Ui, state: &State, result: Computed<'_, DopplerResult>, asked: &mut Vec<Command>) {
    let mut radar = state.radar().clone();
    ui.add_enabled_ui(!state.is_recorded(), |ui| {
        ui.horizontal_wrapped(|ui| {
            let count = NumberField::new(&mut radar.chirps).range(1..=MAX_CHIRPS).speed(0.5);
            labelled(ui, "Chirps", "Chirps that are sent one after another: columns of the map", count);
            let tooltip =
                "From the beginning of a chirp to that of the next. Half as long makes twice the velocity unambiguous.";
            let mut microseconds = 1e6 * radar.chirp_interval_seconds;
            let least = 1e6 * radar.chirp_seconds;
            let most = MAX_CHIRP_INTERVAL_MICROSECONDS.max(least);
            let field = NumberField::new(&mut microseconds).range(least..=most).speed(0.05).suffix(" µs");
            if labelled(ui, "Interval", tooltip, field).changed() {
                radar.chirp_interval_seconds = (1e-6 * microseconds).max(radar.chirp_seconds);
            }
        });
    });
    let of_file = result.and_then(Result::ok).filter(|_| state.is_recorded()).map(|result| &result.radar);
    ui.weak(follows(of_file.unwrap_or(state.radar())));
    if radar != *state.radar() && !state.is_recorded() {
        radar.chirp_interval_seconds = radar.chirp_interval_seconds.max(radar.chirp_seconds);
        asked.push(RadarCommand::Set(Box::new(radar)).into());
    }
}

/// Text of the unambiguous velocity and of the velocity resolution.
fn follows(radar: &Radar) -> String {
    let most = radar.unambiguous_velocity_metres_per_second();
    match radar.chirps {
        1 => format!("unambiguous ±{most:.1} m/s"),
        _ => format!("unambiguous ±{most:.1} m/s in steps of {:.2} m/s", radar.velocity_resolution_metres_per_second()),
    }
}

fn timeline(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    ui.add_enabled_ui(state.scene().is_moving(), |ui| {
        ui.horizontal_wrapped(|ui| {
            play(ui, state, "Let every object move by its velocity; all maps follow", asked);
            let mut seconds = state.timeline.seconds;
            let slider = Slider::new(&mut seconds, 0.0..=TIMELINE_SECONDS).fixed_decimals(2).suffix(" s");
            let tooltip = "Time at which the scene is looked at; its file has time 0";
            if labelled(ui, "Time", tooltip, slider).changed() {
                asked.push(ViewCommand::SetTime(seconds).into());
            }
            if state.timeline.seconds > 0.0 {
                press(ui, "Back to 0 s", "", ViewCommand::SetTime(0.0), asked);
            }
        });
    });
}

fn frames_played(ui: &mut Ui, state: &State, frames: [u64; 2], asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        play(ui, state, "Show one frame after another; all maps and methods follow", asked);
        asked.extend(frame_slider(ui, frames).map(|way| DocumentCommand::Reread(way).into()));
    });
}

fn play(ui: &mut Ui, state: &State, tip: &str, asked: &mut Vec<Command>) {
    press(ui, if state.timeline.is_playing { "Pause" } else { "Play" }, tip, ViewCommand::TogglePlay, asked);
}

/// Writes why there is no map, or a note on the map.
fn said(ui: &mut Ui, state: &State, result: Computed<'_, DopplerResult>, asked: &mut Vec<Command>) {
    if state.is_recorded() {
        let text = match result {
            None => "The loops of a raw capture's frame, or of an array, make this map. One chirp tells no velocity.",
            Some(Ok(result)) if !result.knows_interval => {
                "Nothing says the interval of chirps: a step of velocity is shown as 1 m/s."
            }
            Some(_) => "The loops of the recording's frame.",
        };
        ui.weak(text);
        let tooltip = "The mean over the loops, which holds all that stands still";
        if result.is_some() {
            let out = state.settings.static_clutter_out;
            tick(ui, out, "Static clutter out", tooltip, ViewCommand::TakeOutStaticClutter, asked);
        }
    } else if state.radar().chirps < 2 {
        ui.horizontal_wrapped(|ui| {
            ui.label("One chirp tells no velocity.");
            let mut radar = state.radar().clone();
            radar.chirps = INITIAL_CHIRPS;
            radar.chirp_interval_seconds = radar.chirp_interval_seconds.max(radar.chirp_seconds);
            press(ui, format!("Send {INITIAL_CHIRPS} chirps"), "", RadarCommand::Set(Box::new(radar)), asked);
        });
    } else if !state.scene().is_moving() {
        ui.weak("Nothing moves: everything stands at 0 m/s. The Inspector sets velocities.");
    } else {
        warning(ui, folded(state.radar(), state.scene()).map(|told| with_minuses(&told)).as_deref());
    }
}

fn map(ui: &mut Ui, state: &State, result: &DopplerResult, texture: TextureId) {
    let radar = &result.radar;
    // To the edges of the outer columns and bins.
    let velocities = [-0.5, radar.chirps as f64 - 0.5].map(|column| radar.velocity_of_column_metres_per_second(column));
    let ranges = [-0.5, radar.samples as f64 - 0.5].map(|bin| radar.range_of_bin_metres(bin));
    let beyond = 0.06 * (velocities[1] - velocities[0]);
    let area = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(area);
    let most = radar.unambiguous_velocity_metres_per_second();
    let ticks = velocity_ticks(most);
    let x = Axis::new(velocities[0] - beyond, velocities[1] + beyond, "radial velocity, m/s");
    let x = Axis { ticks: Some(&ticks), ..x };
    let mut chart = Chart::new("Range-Doppler map", x, Axis::new(ranges[0], ranges[1], "range, m"));
    chart.image(texture, [velocities[0], ranges[0]], [velocities[1], ranges[1]]);
    let stroke = Stroke::new(1.2, ui.visuals().warn_fg_color);
    for edge in [-most, most] {
        chart.add(VLine::new("", edge).stroke(stroke).style(LineStyle::dashed_dense()));
    }
    let drawn = chart.show(ui, area.with_max_x(area.right() - axes::RIGHT + 12.0), Sense::hover());
    if state.settings.show_reflectors {
        marks(ui, state, &drawn, radar);
    }
    let (low, high, title) = match state.settings.normalisation {
        Normalisation::DynamicRange(range) => (-range.0, 0.0, "dB"),
        Normalisation::MinMax => (0.0, 1.0, "Λ"),
    };
    let bar = Bar::new(colour_table(state.settings.colours), low, high, title);
    bar.draw(ui, &ui.painter().with_clip_rect(area), drawn.rect);
    drawn.tell(|[velocity, range]| told(result, velocity, range));
}

/// Marks of the velocity axis: the limits, which the map repeats after, and round numbers that leave room for them.
fn velocity_ticks(most: f64) -> Vec<Tick> {
    let limit = |value: f64| Tick { value, text: axes::tick_text(value, most / 100.0) };
    let round = axes::round_ticks(-most, most, 4.0).into_iter().filter(|tick| tick.value.abs() < 0.75 * most);
    [limit(-most)].into_iter().chain(round).chain([limit(most)]).collect()
}

/// Draws a ring at the predicted place of each object, dashed where its velocity folds.
fn marks(ui: &Ui, state: &State, drawn: &Drawn, radar: &Radar) {
    for (index, object) in state.scene().objects.iter().take(MAX_MARKED_OBJECTS).enumerate() {
        let blob = DopplerBlob::of(radar, object);
        let at = drawn.at([blob.apparent_velocity_metres_per_second, blob.apparent_range_metres]);
        edged([3.0, 1.4], MARK, |stroke| drawn.painter.circle_stroke(at, 7.0, stroke));
        let name = if blob.is_folded() { format!("{} folded", index + 1) } else { format!("{}", index + 1) };
        let galley = ui.painter().layout_no_wrap(name, axes::tick_font(), MARK);
        let rect = Align2::LEFT_CENTER.anchor_size(at + vec2(9.0, 0.0), galley.size());
        drawn.painter.rect_filled(rect.expand(2.0), 2.0, MARK_EDGE);
        drawn.painter.galley(rect.min, galley, MARK);
    }
}

/// Text of velocity, range and level of the cell at a place.
fn told(result: &DopplerResult, velocity: f64, range: f64) -> Option<String> {
    let radar = &result.radar;
    let column = (velocity / radar.velocity_resolution_metres_per_second() + (radar.chirps / 2) as f64).round();
    let bin = radar.bin_of_range(range).round();
    if column < 0.0 || bin < 0.0 {
        return None;
    }
    let level = result.decades.decades().get([bin as usize, column as usize])? - result.decades.max();
    let velocity = radar.velocity_of_column_metres_per_second(column);
    let towards = match velocity {
        v if v < 0.0 => ", coming nearer",
        v if v > 0.0 => ", going away",
        _ => "",
    };
    let (range, below) = (radar.range_of_bin_metres(bin), -20.0 * level);
    Some(format!("{} m/s{towards}\nrange {range:.2} m\n{below:.1} dB below the peak", plain(velocity, 2)))
}

#[cfg(test)]
mod tests;
