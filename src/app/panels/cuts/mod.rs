//! The cuts panel: range profile and angle cut of all maps through the cursor, with pinned cuts, and markers to measure between.

mod markers;
mod trace;

use crate::app::content::Content;
use crate::app::jobs::Want;
use crate::app::state::{Command, CutMap, MapKind, State, Units, ViewCommand};
use crate::app::widgets::{
    Axis, Chart, Inks, NumberField, Span, axes, button, choice, choices, direction, labelled, lowest_db, press,
};
use eframe::egui::{self, Color32, Label, Rect, RichText, Sense, Stroke, Ui, vec2};
use egui_plot::LineStyle;
use markers::{Markers, NAMES};
use std::collections::{BTreeMap, BTreeSet};
use trace::{Cut, Trace};

/// Hidden maps, the measured line, and zoom and markers of each cut.
#[derive(Default)]
pub struct CutsMemory {
    hidden: BTreeSet<MapKind>,
    /// The line that the markers read: of a map, of a pinned cut or of the one at the cursor.
    read: Option<Line>,
    views: BTreeMap<Cut, View>,
}

/// A line that both cuts draw: a map, at the cursor or as it was pinned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Line {
    kind: MapKind,
    pin: Option<usize>,
}

impl Line {
    fn name(self) -> String {
        match self.pin {
            None => self.kind.title().to_owned(),
            Some(pin) => format!("{}, pinned {}", self.kind.title(), pin + 1),
        }
    }
}

#[derive(Default, Clone, Copy)]
struct View {
    span: Option<Span>,
    markers: Markers,
}

pub const PANEL: Content<CutsMemory> = Content {
    wants: &[Want::Output, Want::EveryMap],
    tells_answers: true,
    ..Content::drawn(|ui, cx| show(ui, cx.state, &cx.jobs.pipeline.cut_maps(), cx.memory))
};

/// Draws the panel of maps that can be cut: angle cut above (or left), range profile below (or right).
pub fn show(ui: &mut Ui, state: &State, maps: &[CutMap], memory: &mut CutsMemory) -> Vec<Command> {
    let mut asked = Vec::new();
    let frame = egui::Frame::NONE.inner_margin(egui::Margin { left: 8, right: 8, top: 4, bottom: 0 });
    frame.show(ui, |ui| {
        head(ui, state, maps, memory, &mut asked);
        let lines = lines(state, maps, &memory.hidden);
        let best = lines.iter().find(|line| line.kind == MapKind::Target).or(lines.first());
        memory.read = memory.read.filter(|line| lines.contains(line)).or(best.copied());
    });
    let area = ui.available_rect_before_wrap();
    let (first, second) = match area.width() > 1.6 * area.height() {
        true => area.split_left_right_at_fraction(0.5),
        false => area.split_top_bottom_at_fraction(0.5),
    };
    for (cut, area) in Cut::ALL.into_iter().zip([first, second]) {
        draw(ui, area, state, maps, memory, cut);
    }
    asked
}

/// The drawn lines: first those of the cut at the cursor, then those of the pinned cuts.
fn lines(state: &State, maps: &[CutMap], hidden: &BTreeSet<MapKind>) -> Vec<Line> {
    let live = maps.iter().map(|map| Line { kind: map.kind, pin: None });
    let pins = state.pins.iter().enumerate();
    let pinned = pins.flat_map(|(i, p)| p.maps.iter().map(move |m| Line { kind: m.kind, pin: Some(i) }));
    live.chain(pinned).filter(|line| !hidden.contains(&line.kind)).collect()
}

/// Draws the row above the cuts: a box for each map in its colour, the units, and the pinned cuts.
fn head(ui: &mut Ui, state: &State, maps: &[CutMap], memory: &mut CutsMemory, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        for map in maps {
            let kind = map.kind;
            let mut shown = !memory.hidden.contains(&kind);
            let name = RichText::new(kind.title()).color(colour(ui, kind)).strong();
            if ui.checkbox(&mut shown, name).on_hover_text("Draw this line or not").changed() {
                match shown {
                    true => memory.hidden.remove(&kind),
                    false => memory.hidden.insert(kind),
                };
            }
        }
        ui.add_space(6.0);
        let tip = "Λ, or decibels relative to each map's peak (D)";
        let of = [(Units::Lambda, "Λ", tip), (Units::Decibels, "dB", tip)];
        choices(ui, state.settings.units, of, ViewCommand::SetUnits, asked);
        ui.add_space(6.0);
        button(ui, "Pin", ViewCommand::PinCuts, !maps.is_empty(), asked);
        for (index, pin) in state.pins.iter().enumerate() {
            let way = direction(pin.cursor.cos_theta, 1);
            let place = format!("{}: {:.2} m · {way}", index + 1, pin.cursor.range_metres);
            let tip = "A cut that stays, drawn thin; click to let it go";
            press(ui, format!("Unpin {place}"), tip, ViewCommand::Unpin(index), asked);
        }
        ui.add_space(6.0);
        marks(ui, state, maps, memory);
    });
}

/// Draws the buttons that place and remove markers, and the choice of the line that they measure.
fn marks(ui: &mut Ui, state: &State, maps: &[CutMap], memory: &mut CutsMemory) {
    if memory.views.values().all(|view| view.markers.is_empty()) {
        let tip = "Two places to measure between; a click in a cut places one, too, and they can be dragged";
        if ui.button("Markers").on_hover_text(tip).clicked() {
            for cut in Cut::ALL {
                let at = cut.position(state.radar(), &state.cut_cursor());
                memory.views.entry(cut).or_default().markers.place(at);
            }
        }
    } else {
        let lines = lines(state, maps, &memory.hidden).into_iter().map(Some);
        let name = |line: &Option<Line>| (line.map_or_else(String::new, Line::name), "");
        choice(ui, "Read", "The line that the markers measure", &mut memory.read, lines, name);
        if ui.button("No markers").on_hover_text("Take the markers away").clicked() {
            memory.views.values_mut().for_each(|view| view.markers = Markers::default());
        }
    }
    if memory.views.values().any(|view| view.span.is_some())
        && ui.button("Whole cuts").on_hover_text("Undo zoom and pan of the cuts").clicked()
    {
        memory.views.values_mut().for_each(|view| view.span = None);
    }
}

fn colour(ui: &Ui, kind: MapKind) -> Color32 {
    let rgb = Color32::from_rgb;
    match (kind, ui.visuals().dark_mode) {
        (MapKind::Input0, true) => rgb(84, 168, 255),
        (MapKind::Input0, false) => rgb(0, 98, 196),
        (MapKind::Input1, true) => rgb(248, 112, 140),
        (MapKind::Input1, false) => rgb(196, 24, 80),
        (MapKind::Target, true) => rgb(222, 228, 238),
        (MapKind::Target, false) => rgb(52, 60, 74),
        (_, true) => rgb(255, 176, 59),
        (_, false) => rgb(176, 92, 0),
    }
}

/// Lines differ by dash as well as by colour.
fn style(kind: MapKind) -> LineStyle {
    match kind {
        MapKind::Input0 => LineStyle::Dashed { length: 7.0 },
        MapKind::Input1 => LineStyle::Dashed { length: 3.0 },
        _ => LineStyle::Solid,
    }
}

fn draw(ui: &mut Ui, area: Rect, state: &State, maps: &[CutMap], memory: &mut CutsMemory, cut: Cut) {
    let (radar, cursor, units) = (state.radar(), state.cut_cursor(), state.settings.units);
    let traces = traces(state, maps, &memory.hidden, cut);
    let whole = cut.whole(radar);
    let mut view = memory.views.get(&cut).copied().unwrap_or_default();
    let read = memory.read.and_then(|line| traces.iter().find(|t| (t.kind, t.pin) == (line.kind, line.pin)));
    let said = read.map_or_else(Vec::new, |trace| markers::readings(cut, radar, trace, units, &view.markers));
    let area = if view.markers.is_empty() { area } else { readings(ui, area, cut, whole, &mut view.markers, &said) };
    let span = view.span.unwrap_or(whole);
    let range_db = traces.iter().filter_map(Trace::range_db).fold(1.0, f64::max);
    let y = match units {
        Units::Lambda => Axis::new(0.0, 1.05, "brightness Λ"),
        // Lower levels are no echo.
        Units::Decibels => Axis::new(lowest_db(range_db), -0.05 * lowest_db(range_db), "relative to the peak, dB"),
    };
    let title = cut.title(radar, &cursor);
    let title = axes::fitting(ui.painter(), area.width() - 20.0, &[&title, cut.unit()]);
    let mut chart = Chart::new(cut.name(), Axis::new(span.low, span.high, title), y);
    for trace in &traces {
        let Some(points) = trace.points(units) else { continue };
        let (width, fade) = if trace.pin.is_some() { (1.0, 0.6) } else { (1.6, 1.0) };
        let stroke = Stroke::new(width, colour(ui, trace.kind).gamma_multiply(fade));
        chart.line(in_sight(&points, span), stroke, style(trace.kind));
    }
    chart.upright(cut.position(radar, &cursor), Stroke::new(1.0, ui.visuals().weak_text_color()));
    let ink = Inks::of(ui.visuals()).selected;
    if let Some(trace) = read {
        let range = trace.range_db().unwrap_or(1.0);
        let y_of = |db: f64| if units == Units::Decibels { db } else { 1.0 + db / range };
        markers::draw_widths(&mut chart, trace, &view.markers, ink, y_of);
    }
    let drawn = chart.show(ui, area, Sense::click_and_drag());
    view.markers.follow(ui, &drawn, whole);
    let turned = span.navigate(ui, &drawn, whole, view.markers.held.is_none());
    view.span = (turned != whole).then_some(turned);
    view.markers.draw(&drawn, ink);
    memory.views.insert(cut, view);
}

/// The lines of one cut, those of pinned cuts first, so that they lie beneath the others.
fn traces(state: &State, maps: &[CutMap], hidden: &BTreeSet<MapKind>, cut: Cut) -> Vec<Trace> {
    let shown = |map: &&CutMap| !hidden.contains(&map.kind);
    let pinned = state.pins.iter().enumerate().flat_map(|(i, pin)| {
        let maps = pin.maps.iter().filter(shown);
        maps.filter_map(move |map| Trace::of(&pin.radar, &pin.cursor, map, cut, Some(i)))
    });
    let (radar, cursor) = (state.radar(), state.cut_cursor());
    let live = maps.iter().filter(shown).filter_map(|map| Trace::of(radar, &cursor, map, cut, None));
    pinned.chain(live).collect()
}

/// The visible cells of a line, and one beyond on either side.
fn in_sight(points: &[[f64; 2]], span: Span) -> Vec<[f64; 2]> {
    let first = points.partition_point(|[x, _]| *x < span.low).saturating_sub(1);
    let last = (points.partition_point(|[x, _]| *x <= span.high) + 1).min(points.len());
    points[first.min(last)..last].to_vec()
}

/// Draws the fields of the markers' places and the readings at the foot of `area`. Returns the rest of `area`.
fn readings(ui: &mut Ui, area: Rect, cut: Cut, whole: Span, markers: &mut Markers, said: &[String]) -> Rect {
    let (font, ink) = (axes::tick_font(), ui.visuals().text_color());
    let width = area.width() - 16.0;
    let height_of = |text: &String| ui.painter().layout(text.clone(), font.clone(), ink, width).size().y + 2.0;
    let wanted: f32 = said.iter().map(height_of).sum::<f32>() + ui.spacing().interact_size.y + 6.0;
    let (chart, foot) = area.split_top_bottom_at_y(area.bottom() - wanted.min(0.55 * area.height()));
    ui.scope_builder(egui::UiBuilder::new().max_rect(foot.shrink2(vec2(8.0, 0.0))), |ui| {
        egui::ScrollArea::vertical().id_salt(cut).auto_shrink([false, false]).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            ui.horizontal(|ui| {
                let digits = if cut == Cut::Angle { 4 } else { 3 };
                for (place, name) in markers.places.iter_mut().zip(NAMES) {
                    let Some(place) = place else { continue };
                    let step = (whole.high - whole.low) / 1000.0;
                    let drag = NumberField::new(place)
                        .range(whole.low..=whole.high)
                        .speed(step)
                        .min_decimals(digits)
                        .max_decimals(digits);
                    labelled(ui, format!("{name}, {}", cut.unit()), "", drag);
                }
            });
            for line in said {
                ui.add(Label::new(RichText::new(line).font(font.clone())).wrap());
            }
        });
    });
    chart
}

#[cfg(test)]
mod tests;
