//! The chirp panel: frequency against time of the sent chirp and of its echoes, the sampled beat, and the beat's spectrum.

use crate::app::content::Content;
use crate::app::jobs::{ChirpQuery, ChirpResult};
use crate::app::state::{ChirpSettings, Command, RadarCommand, State, ViewCommand};
use crate::app::widgets::legend::{self, Sign};
use crate::app::widgets::{Axis, Chart, Computed, Drawn, Inks, NumberField, axes, labelled, padded, plain};
use crate::radar::{Carrier, Radar};
use crate::scene::Interferer;
use crate::theory::chirp::{BeatTone, ChirpShape, beat_tones, delay_seconds};
use eframe::egui::text::LayoutJob;
use eframe::egui::{self, CursorIcon, FontId, Rect, RichText, Sense, Stroke, Ui, vec2};
use egui_plot::{LineStyle, PlotPoints, Points};
use std::collections::{BTreeMap, BTreeSet};

/// Part of the chirp's duration as which the delay from the maximum range is drawn, where the delay is shorter.
const MIN_DRAWN_DELAY_PART: f64 = 0.25;

/// Most echoes that are drawn, unless there are more objects.
const MAX_ECHOES: usize = 60;

/// Most lines of the objects' beats, in a low panel and in a high one; the pointer shows all.
const MAX_LINES_OF_BEATS: [usize; 2] = [1, 3];

/// Height below which a panel is low and leaves all its room to the charts, points.
const LOW_PANEL_HEIGHT_POINTS: f32 = 370.0;

/// Where the beats of the first objects are drawn, as parts of the time in which they are heard while the chirp is sent.
const BEAT_PLACES: [f64; 2] = [0.2, 0.65];

const HANDLE_RADIUS_POINTS: f32 = 5.0;

/// Least and largest bandwidth and carrier that dragging reaches, hertz.
const DRAGGED_BANDWIDTH_HZ: [f64; 2] = [1e6, 2e10];
const DRAGGED_CARRIER_HZ: [f64; 2] = [1e9, 3e11];

/// Least height of a chart whose axis has its whole title, points.
const MIN_TITLE_HEIGHT_POINTS: f32 = 170.0;

/// Least height in which the charts can be read, points.
const MIN_CHARTS_HEIGHT_POINTS: f32 = 230.0;

const SPECTRUM_DB: f64 = 100.0;

/// Shortest and longest chirp duration that dragging reaches, seconds.
const DRAGGED_SECONDS: [f64; 2] = [1e-6, 1e-2];

pub const PANEL: Content<(), ChirpQuery> = Content {
    tells_answers: true,
    ..Content::computed(|state, _| Some(ChirpQuery::of(state)), |ui, cx| show(ui, cx.state, cx.value))
};

/// Draws the panel with the beat. A low panel scrolls to its charts.
pub fn show(ui: &mut Ui, state: &State, result: Computed<'_, ChirpResult>) -> Vec<Command> {
    padded(ui, |ui, asked| {
        let height = ui.available_height();
        let scroll = egui::ScrollArea::vertical().auto_shrink(false);
        scroll.show(ui, |ui| contents(ui, state, result, height, asked));
    })
}

fn contents(ui: &mut Ui, state: &State, result: Computed<'_, ChirpResult>, height: f32, asked: &mut Vec<Command>) {
    let (radar, top) = (state.radar(), ui.cursor().top());
    let element = state.settings.chirp.element.min(radar.elements - 1);
    let echoes = if state.is_recorded() { Vec::new() } else { beat_tones(radar, state.scene(), element) };
    let interferer = state.scene().disturbances.interferer.filter(|_| !state.is_recorded());
    let longest = delay_seconds(radar.max_range_metres());
    let chirp = ChirpShape::of(radar);
    let stretch = (MIN_DRAWN_DELAY_PART * chirp.duration_seconds / longest).max(1.0);
    let mut shown = Shown { state, chirp, echoes, interferer, stretch };
    choices(ui, radar, element, asked);
    let is_low = height < LOW_PANEL_HEIGHT_POINTS;
    shown.legend(ui);
    shown.tell_beats(ui, MAX_LINES_OF_BEATS[usize::from(!is_low)]);
    if radar.carrier == Carrier::OneWay && !is_low {
        let half_gigahertz = radar.carrier_hz / 2e9;
        ui.weak(format!("Drawn rising; the thesis' formula falls from {half_gigahertz} GHz: the same beats."));
    }
    let left = (height - 1.0 - (ui.cursor().top() - top)).max(MIN_CHARTS_HEIGHT_POINTS);
    let (_, area) = ui.allocate_space(vec2(ui.available_width(), left));
    let [frequencies, beat, spectrum] = parts(area);
    shown.thin();
    shown.frequencies(ui, frequencies, asked);
    let text = match result {
        Some(Ok(result)) => {
            shown.beat(ui, beat, result);
            shown.spectrum(ui, spectrum, result);
            return;
        }
        Some(Err(error)) => RichText::new(error).color(ui.visuals().error_fg_color),
        None => RichText::new("computing…").weak(),
    };
    ui.put(beat, egui::Label::new(text));
}

/// Draws the fields of element and chirp duration. `element` is the one on screen.
fn choices(ui: &mut Ui, radar: &Radar, element: usize, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let mut settings = ChirpSettings { element };
        let number = NumberField::new(&mut settings.element).range(0..=radar.elements - 1).speed(0.3);
        labelled(ui, "Element", "The element whose chirp and beat are drawn, from the left", number);
        if settings.element != element {
            asked.push(ViewCommand::SetChirp(settings).into());
        }
        let tooltip = "Time that the samples span. No echo at rest depends on it: a beat turns 2RB/c times in a chirp of any length.";
        let mut microseconds = 1e6 * radar.chirp_seconds;
        let range = 1e6 * DRAGGED_SECONDS[0]..=1e6 * DRAGGED_SECONDS[1];
        let field = NumberField::new(&mut microseconds).range(range).speed(0.05).suffix(" µs");
        if labelled(ui, "Chirp", tooltip, field).changed() {
            let mut changed = radar.clone();
            changed.set_chirp_seconds(1e-6 * microseconds);
            set(radar, changed, asked);
        }
    });
}

/// Sends the command for a radar, if it differs from the one on screen.
fn set(radar: &Radar, changed: Radar, asked: &mut Vec<Command>) {
    if changed != *radar {
        asked.push(RadarCommand::Set(Box::new(changed)).into());
    }
}

/// Rectangles of the three charts: the chirp over its beat with the spectrum beside them, in a narrow panel all below each other.
fn parts(area: Rect) -> [Rect; 3] {
    let part = |left: f32, top: f32, right: f32, bottom: f32| {
        let at = |x: f32, y: f32| area.min + vec2(x * area.width(), y * area.height());
        Rect::from_min_max(at(left, top), at(right, bottom))
    };
    match area.width() > 1.3 * area.height() {
        true => [part(0.0, 0.0, 0.58, 0.56), part(0.0, 0.56, 0.58, 1.0), part(0.58, 0.0, 1.0, 1.0)],
        false => [part(0.0, 0.0, 1.0, 0.4), part(0.0, 0.4, 1.0, 0.68), part(0.0, 0.68, 1.0, 1.0)],
    }
}

struct Shown<'a> {
    state: &'a State,
    chirp: ChirpShape,
    echoes: Vec<BeatTone>,
    interferer: Option<Interferer>,
    /// Factor by which delays are drawn longer: a chirp lasts far longer than the delays of its echoes.
    stretch: f64,
}

impl Shown<'_> {
    fn legend(&self, ui: &mut Ui) {
        let inks = Inks::of(ui.visuals());
        let returns = match self.stretch > 1.0 {
            true => format!("returns, delays drawn {:.0} times as long", self.stretch),
            false => "returns".to_owned(),
        };
        let mut entries = vec![(Sign::Line, inks.selected, "sent".to_owned())];
        entries.extend((!self.state.is_recorded()).then_some((Sign::Line, inks.ends[0], returns)));
        entries.extend(self.interferer.map(|_| (Sign::Line, inks.ends[1], "interferer".to_owned())));
        legend::row(ui, &entries);
    }

    fn tell_beats(&self, ui: &mut Ui, max_lines: usize) {
        let mut beats: Vec<(usize, [f64; 2])> = Vec::new();
        for echo in &self.echoes {
            let beat = self.chirp.beat_hz(echo.range_metres) / 1e6;
            match beats.iter_mut().find(|(object, _)| *object == echo.object) {
                Some((_, [_, high])) => *high = beat,
                None => beats.push((echo.object, [beat, beat])),
            }
        }
        let told = beats.iter().map(|(object, [low, high])| {
            let name = self.state.scene().objects[*object].called(*object);
            if high - low < 0.005 { format!("{name} {low:.2}") } else { format!("{name} {low:.2} to {high:.2}") }
        });
        if !beats.is_empty() {
            let text = format!("Beats in MHz: {}", told.collect::<Vec<_>>().join(" · "));
            let (font, ink) = (FontId::proportional(12.0), Inks::of(ui.visuals()).ends[0]);
            let mut lines = LayoutJob::simple(text, font, ink, f32::INFINITY);
            lines.wrap.max_rows = max_lines;
            ui.label(lines);
        }
    }

    /// Keeps so many echoes that each can be seen: of every object about as many, spread over its ranges.
    fn thin(&mut self) {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        self.echoes.iter().for_each(|echo| *counts.entry(echo.object).or_default() += 1);
        let of_each = (MAX_ECHOES / counts.len().max(1)).max(1);
        let mut before: BTreeMap<usize, usize> = BTreeMap::new();
        self.echoes.retain(|echo| {
            let before = before.entry(echo.object).or_default();
            *before += 1;
            (*before - 1).is_multiple_of(counts[&echo.object].div_ceil(of_each))
        });
    }

    fn frequencies(&self, ui: &mut Ui, area: Rect, asked: &mut Vec<Command>) {
        let (chirp, inks) = (self.chirp, Inks::of(ui.visuals()));
        let (microseconds, giga) = (1e6 * chirp.duration_seconds, chirp.bandwidth_hz / 1e9);
        // The whole title stands upright beside a tall chart alone.
        let whole = format!("GHz above {:.4} GHz", chirp.start_hz / 1e9);
        let title = if area.height() < MIN_TITLE_HEIGHT_POINTS { "GHz" } else { &whole };
        let x = Axis::new(-0.05 * microseconds, 1.25 * microseconds, "time, µs");
        let mut chart = Chart::new("Frequency against time", x, Axis::new(-0.08 * giga, 1.12 * giga, title));
        let stroke = Stroke::new(1.2, inks.ends[0].gamma_multiply(0.9));
        let mut objects = BTreeSet::new();
        for echo in &self.echoes {
            let late = 1e6 * self.stretch * delay_seconds(echo.range_metres);
            chart.line([[late, 0.0], [late + microseconds, giga]], stroke, LineStyle::Solid);
            let place = BEAT_PLACES.get(objects.len());
            if let Some(part) = place.filter(|_| objects.insert(echo.object)) {
                let time = late + part * (microseconds - late).max(0.0);
                let [sent, returned] = [time, time - late].map(|t| giga * t / microseconds);
                chart.line([[time, returned], [time, sent]], stroke, LineStyle::Dashed { length: 2.5 });
            }
        }
        if let Some(interferer) = &self.interferer {
            let at = |part: f64| {
                let seconds = part * chirp.duration_seconds;
                let above_hz = chirp.sent_hz(seconds) - chirp.start_hz + chirp.interferer_above_hz(interferer, seconds);
                [1e6 * seconds, above_hz / 1e9]
            };
            chart.line([at(0.0), at(1.25)], Stroke::new(1.6, inks.ends[1]), LineStyle::dashed_dense());
        }
        chart.line([[0.0, 0.0], [microseconds, giga]], Stroke::new(2.2, inks.selected), LineStyle::Solid);
        let drawn = chart.show(ui, area, Sense::hover());
        self.handles(ui, &drawn, [microseconds, giga], asked);
    }

    /// Draws the handles at both ends of the sent chirp: the beginning is dragged up and down for the carrier, the end for bandwidth and duration.
    fn handles(&self, ui: &mut Ui, drawn: &Drawn, [microseconds, giga]: [f64; 2], asked: &mut Vec<Command>) {
        let mut radar = self.state.radar().clone();
        let size = vec2(6.0 * HANDLE_RADIUS_POINTS, 6.0 * HANDLE_RADIUS_POINTS);
        for (at, name, icon) in [
            ([0.0, 0.0], "Beginning of the chirp: its carrier", CursorIcon::ResizeVertical),
            ([microseconds, giga], "End of the chirp: bandwidth and duration", CursorIcon::Move),
        ] {
            let centre = drawn.at(at);
            let response = ui.interact(Rect::from_center_size(centre, size), ui.scope_id().with(name), Sense::drag());
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, name));
            let by = response.drag_delta();
            let up = f64::from(-by.y / drawn.rect.height());
            if response.dragged() && !self.state.is_recorded() {
                let [low, high] = if at[1] == 0.0 { DRAGGED_CARRIER_HZ } else { DRAGGED_BANDWIDTH_HZ };
                let hertz = if at[1] == 0.0 { &mut radar.carrier_hz } else { &mut radar.bandwidth_hz };
                *hertz = (*hertz * (1.0 + up)).clamp(low, high);
            }
            if response.dragged() && at[1] != 0.0 {
                let across = f64::from(by.x / drawn.rect.width());
                let seconds = radar.chirp_seconds * (1.0 + across);
                radar.set_chirp_seconds(seconds.clamp(DRAGGED_SECONDS[0], DRAGGED_SECONDS[1]));
            }
            let radius = if response.hovered() || response.dragged() {
                HANDLE_RADIUS_POINTS + 1.5
            } else {
                HANDLE_RADIUS_POINTS
            };
            let stroke = Stroke::new(1.0, ui.visuals().text_color());
            drawn.painter.circle(centre, radius, Inks::of(ui.visuals()).selected, stroke);
            response.on_hover_cursor(icon).on_hover_text(name);
        }
        set(self.state.radar(), radar, asked);
    }

    fn beat(&self, ui: &mut Ui, area: Rect, result: &ChirpResult) {
        let inks = Inks::of(ui.visuals());
        let most = result.samples.iter().map(|s| s.norm()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let count = result.samples.len() as f64;
        let title = format!("beat of element {}, real part", result.element);
        let x = Axis::new(-0.02 * count, 1.02 * count, "sample");
        let mut chart = Chart::new("Beat", x, Axis::new(-1.1, 1.1, &title));
        let points = || result.samples.iter().enumerate().map(|(k, s)| [k as f64, s.re / most]);
        chart.line(points(), Stroke::new(1.0, inks.grid_text), LineStyle::Solid);
        // Dots that overlap would be a band.
        if f64::from(area.width()) > 2.0 * count {
            let dots: PlotPoints<'static> = points().collect();
            chart.add(Points::new("", dots).radius(1.6).color(inks.ends[0]));
        }
        chart.show(ui, area, Sense::hover());
    }

    /// Draws the level of every range bin in decibels, and the predicted bin of each echo.
    fn spectrum(&self, ui: &mut Ui, area: Rect, result: &ChirpResult) {
        let inks = Inks::of(ui.visuals());
        let peak = result.spectrum.iter().copied().fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let bins = result.spectrum.len() as f64;
        let titles = ["range bin: turns of the beat in a chirp", "range bin"];
        let title = axes::fitting(ui.painter(), area.width() - 70.0, &titles);
        let (x, y) = (Axis::new(-0.5, bins - 0.5, title), Axis::new(-SPECTRUM_DB, 5.0, "dB"));
        let mut chart = Chart::new("Spectrum of the beat", x, y);
        for echo in &self.echoes {
            let bin = self.chirp.range_bin(self.chirp.beat_hz(echo.range_metres));
            chart.upright(bin, Stroke::new(1.0, inks.ends[0].gamma_multiply(0.5)));
        }
        let decibels = |amplitude: &f64| (20.0 * (amplitude / peak).log10()).max(-2.0 * SPECTRUM_DB);
        let points = result.spectrum.iter().enumerate().map(|(bin, v)| [bin as f64, decibels(v)]);
        chart.line(points, Stroke::new(1.5, inks.selected), LineStyle::Solid);
        chart.show(ui, area, Sense::hover()).tell(|[bin, _]| {
            let bin = bin.round().clamp(0.0, bins - 1.0);
            let level = result.spectrum.get(bin as usize).map_or(-SPECTRUM_DB, decibels);
            let beat = bin / self.chirp.duration_seconds / 1e6;
            let range = self.state.radar().range_of_bin_metres(bin);
            Some(format!("range bin {bin:.0}: {range:.2} m, beat {beat:.3} MHz\n{} dB", plain(level, 1)))
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};
    use crate::scene::Scene;
    use num_complex::Complex64;

    fn panel(size: [f32; 2], result: Result<(), &'static str>) -> Harness<'static, Vec<Command>> {
        let radar = Radar { elements: 64, samples: 64, bandwidth_hz: 2.5e8, ..Radar::default() };
        let mut state = State::of(radar, Scene::of_points([(0.0, 12.0), (3.0, 20.0)]));
        state.settings.chirp.element = 3;
        let samples = (0..64).map(|k| Complex64::from_polar(1.0, 0.3 * f64::from(k))).collect();
        let beat =
            ChirpResult { element: 3, samples, spectrum: (0..64).map(|bin| 1.0 / (1.0 + f64::from(bin))).collect() };
        seen::asking(size, move |ui| show(ui, &state, Some(result.map(|()| &beat))))
    }

    #[test]
    fn every_chart_is_there_in_a_wide_panel_or_a_narrow_one() {
        for size in [[900.0, 420.0], [380.0, 520.0]] {
            let panel = panel(size, Ok(()));
            for name in ["Frequency against time", "Beat", "Spectrum of the beat"] {
                let rect = panel.get_by_label(name).rect();
                assert!(rect.height() > 40.0 && rect.right() <= size[0], "{name}: {rect:?}");
            }
            let rising = "Drawn rising; the thesis' formula falls from 38.5 GHz: the same beats.";
            // 12 m before the middle element's neighbour: 20.0 turns in 25.6 us.
            seen::assert_reads(panel.output(), &["Beats in MHz: point 1 0.78 · point 2 1.32", rising]);
            seen::assert_readable(panel.output());
        }
        let _said = panel([900.0, 420.0], Err("every element is needed")).get_by_label("every element is needed");
    }

    #[test]
    fn dragging_the_end_of_the_chirp_changes_bandwidth_and_duration() {
        let mut panel = panel([900.0, 420.0], Ok(()));
        let at = panel.get_by_label("End of the chirp: bandwidth and duration").rect().center();
        panel.drags(&[at, at + vec2(20.0, -20.0)]);
        let mut radars = panel.state().iter().filter_map(|c| match c {
            Command::Radar(RadarCommand::Set(radar)) => Some(radar),
            _ => None,
        });
        let dragged = |radar: &Radar| radar.bandwidth_hz > 2.5e8 && radar.chirp_seconds > 25.6e-6;
        assert!(radars.next_back().is_some_and(|radar| dragged(radar)), "{:?}", panel.state());
    }
}
