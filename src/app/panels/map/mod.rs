//! One map: picture, axes, colour bar, cursor, marks.

mod frame;
mod hand;
mod outline;
mod overlay;
mod scale;
mod theory;

pub use frame::{Cells, Marked, Marks};
pub use hand::Memory;
pub use theory::Theory;

use crate::app::state::{Command, Cursor, DifferenceView, MapKind, MapView, Panel, Projection, Units};
use crate::app::widgets::axes::{self, Axis};
use crate::app::widgets::colour_bar::Bar;
use crate::app::widgets::entry::entry;
use crate::app::widgets::nudge::{nudge, zoom_keys};
use crate::app::widgets::numbers::percent;
use crate::app::widgets::theme::Inks;
use crate::evaluate::Metrics;
use crate::interact::Selection;
use crate::picture::ColourMap;
use crate::radar::{Carrier, End, Radar};
use crate::scene::Scene;
use eframe::egui;
use eframe::egui::{Align2, Color32, Painter, Rect, Sense, TextureId, Ui, pos2, vec2};
use frame::{Frame, cursor_at};

/// What a map shows.
pub struct Input<'a> {
    /// Which map.
    pub kind: MapKind,
    /// The radar.
    pub radar: &'a Radar,
    /// The scene: what can be grabbed by its blobs.
    pub scene: &'a Scene,
    /// What of it is selected.
    pub selection: &'a Selection,
    /// Over which coordinates.
    pub projection: Projection,
    /// Colours of Lambda.
    pub colours: ColourMap,
    /// What the colour bar counts.
    pub units: Units,
    /// How a difference is drawn.
    pub difference: DifferenceView,
    /// Its picture, if there is one.
    pub texture: Option<TextureId>,
    /// Where the scale of that picture ends, Lambda.
    pub end: f32,
    /// Whether the picture is of an earlier scene, and has been for long enough to be told.
    pub stale: bool,
    /// The numbers behind the picture.
    pub cells: Option<Cells<'a>>,
    /// What is drawn over it.
    pub marks: Marks<'a>,
    /// What the formulas say of a reflector, if that is drawn over it.
    pub theory: Option<Theory<'a>>,
    /// Where the pointer is, in whichever panel.
    pub cursor: Option<Cursor>,
    /// Why there is no picture.
    pub error: Option<Problem<'a>>,
    /// Hides the picture: a prediction is asked for.
    pub veil: Option<Veil>,
    /// Whether axes, values and the colours' scale are told.
    pub numbers: bool,
}

#[cfg(test)]
impl<'a> Input<'a> {
    /// A map without a picture.
    fn bare(
        kind: MapKind,
        radar: &'a Radar,
        projection: Projection,
        scene: &'a Scene,
        selection: &'a Selection,
    ) -> Input<'a> {
        Input {
            kind,
            radar,
            scene,
            selection,
            projection,
            colours: ColourMap::Grey,
            units: Units::Lambda,
            difference: DifferenceView::default(),
            texture: None,
            end: 1.0,
            stale: false,
            cells: None,
            marks: Marks { objects: &[], found: &[] },
            theory: None,
            cursor: None,
            error: None,
            veil: None,
            numbers: true,
        }
    }
}

/// A map that is hidden until somebody has predicted what it shows.
#[derive(Clone, Copy)]
pub struct Veil {
    /// Whether the prediction is a click in this map.
    pub is_clicked: bool,
}

/// Why there is no picture.
pub struct Problem<'a> {
    /// What is wrong.
    pub reason: &'a str,
    /// Name of a method that works instead.
    pub instead: Option<&'static str>,
}

/// Draws a map.
pub fn show(ui: &mut Ui, input: Input<'_>, view: &mut MapView, memory: &mut Memory) -> Vec<Command> {
    let mut asked = Vec::new();
    let area = ui.available_rect_before_wrap();
    ui.painter().rect_filled(area, 0.0, ui.visuals().panel_fill);
    let is_told = has_bar(input.kind) && input.numbers && area.width() > 200.0;
    let bar = is_told.then(|| bar_of(&input));
    let rect = rect_of(ui.painter(), area, bar.as_ref(), input.projection);
    let response = ui.interact(rect, ui.scope_id().with(("map", input.kind)), Sense::click_and_drag());
    let label = format!("{} map", input.kind.title());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
    let frame = Frame {
        rect,
        view: *view,
        radar: input.radar,
        projection: input.projection,
        centre_x_metres: centre_x_metres(input.kind, input.radar),
    };
    let is_bare = input.veil.is_none();
    let holds = is_bare && hand::work(ui, input.kind, input.scene, frame, &response, memory, &mut asked);
    navigate(ui, rect, &response, view, !holds);
    if response.has_focus() && !input.selection.is_empty() {
        asked.extend(nudge(ui.ctx(), input.radar.range_resolution_metres()));
    }
    let frame = Frame { view: *view, ..frame };
    let painter = ui.painter().with_clip_rect(area);
    let inner = ui.painter().with_clip_rect(rect.intersect(area));
    let is_drawn = picture(ui, &inner, frame, &input, &mut asked);
    if input.numbers {
        draw_axes(ui, &painter, frame);
    }
    if input.veil.is_none() {
        overlay::marks(&inner, frame, &input.marks, response.hover_pos().filter(|_| input.numbers));
        overlay::selected(&inner, frame, input.scene, input.selection);
        input.theory.iter().filter(|_| input.numbers).for_each(|theory| theory.draw(&inner, frame));
    }
    point(&input, frame, &response, &mut asked);
    if let Some(cursor) = &input.cursor {
        let told = input.veil.is_none() && input.numbers;
        overlay::cursor(&inner, frame, cursor, input.cells.as_ref().filter(|_| told));
    }
    if input.stale && is_drawn {
        let corner = rect.left_bottom() + vec2(8.0, -8.0);
        axes::text_on_patch(&inner, corner, Align2::LEFT_BOTTOM, "of an earlier scene; updating…");
    }
    if let Some(bar) = bar {
        bar.draw(ui, &painter, rect);
    }
    response.context_menu(|ui| menu(ui, input.kind, &mut asked));
    asked
}

/// Draws the map itself, or says why there is none; whether there is one.
fn picture(ui: &mut Ui, inner: &Painter, frame: Frame<'_>, input: &Input<'_>, asked: &mut Vec<Command>) -> bool {
    let (rect, view) = (frame.rect, frame.view);
    let texture = input.texture.filter(|_| input.veil.is_none());
    match texture {
        Some(texture) => {
            let uv = Rect::from_min_max(pos2(view.low.x, view.high.y), pos2(view.high.x, view.low.y));
            let tint = if input.stale { Color32::from_gray(120) } else { Color32::WHITE };
            inner.rect_filled(rect, 0.0, Inks::of(ui.visuals()).beyond);
            inner.image(texture, rect, uv, tint);
        }
        None if input.veil.is_some() => {
            veil(inner, rect, input.veil.is_some_and(|v| v.is_clicked), ui.visuals());
        }
        None => empty(ui, inner, rect, input.error.as_ref(), asked),
    }
    texture.is_some()
}

/// Tells where the pointer is; a click predicts where that is asked for.
fn point(input: &Input<'_>, frame: Frame<'_>, response: &egui::Response, asked: &mut Vec<Command>) {
    let Some(pos) = response.hover_pos() else { return };
    let Some(cursor) = cursor_at(input.radar, input.projection, frame.view.at(frame.rect, pos)) else { return };
    if input.veil.is_some_and(|v| v.is_clicked) && response.clicked() {
        let cell = crate::lesson::Cell { bin: cursor.bin, column: cursor.column };
        asked.push(Command::Predict(crate::lesson::Guess::Place(cell)));
    }
    asked.push(Command::Hover(cursor));
}

/// Figures for a map's title bar.
pub struct Caption {
    /// Which map.
    pub kind: MapKind,
    /// The method whose output is shown.
    pub method: Option<&'static str>,
    /// Whether the map is of an earlier scene.
    pub updating: bool,
    /// Figures of the output that is shown, against the target of the same scene.
    pub metrics: Option<Metrics>,
    /// eta'.
    pub target_eta: f32,
    /// eta.
    pub output_eta: f32,
    /// Part of a recording's power that the reflectors laid over it explain.
    pub explained: Option<f64>,
}

/// What stands in the title bar of a map's panel.
pub fn caption(input: Caption) -> Option<String> {
    let updating = if input.updating { "(updating) " } else { "" };
    let text = match input.kind {
        MapKind::TargetAbove => format!("η' = {:.2} {updating}", input.target_eta),
        MapKind::OutputAbove => {
            let figures = input.metrics.map_or_else(String::new, |m| {
                let detection = m.detection.map_or("–".to_owned(), percent);
                format!("P_D {detection} · P_FA {} · ", percent(m.false_alarm))
            });
            format!("{figures}η = {:.2} {updating}", input.output_eta)
        }
        MapKind::Output => format!("{} {updating}", input.method.unwrap_or_default()),
        MapKind::Difference => {
            let figures = input.metrics.map_or_else(String::new, |m| format!("SE {:.0} ", m.squared_error));
            format!("{figures}{updating}")
        }
        MapKind::Unexplained => input.explained.map_or_else(String::new, |explained| {
            format!("{:.1} % of the power explained {updating}", 100.0 * explained)
        }),
        _ => updating.to_owned(),
    };
    (!text.trim().is_empty()).then_some(text)
}

/// Middle of the elements that a map is of.
fn centre_x_metres(kind: MapKind, radar: &Radar) -> f64 {
    match kind {
        MapKind::Input0 => radar.end_centre_metres(End::First),
        MapKind::Input1 => radar.end_centre_metres(End::Last),
        _ => 0.0,
    }
}

fn has_bar(kind: MapKind) -> bool {
    !matches!(kind, MapKind::TargetAbove | MapKind::OutputAbove)
}

fn bar_of(input: &Input<'_>) -> Bar {
    let Input { kind, colours, units, difference, end, .. } = *input;
    let lambda = input.cells.as_ref().and_then(|cells| cells.scale);
    scale::Scale { kind, colours, units, lambda, difference, end }.bar()
}

/// Where the picture goes within the panel.
fn rect_of(painter: &Painter, area: Rect, bar: Option<&Bar>, projection: Projection) -> Rect {
    let height = area.height() - axes::BOTTOM - 8.0;
    let right = bar.map_or(12.0, |bar| bar.width(painter, height));
    let rect = Rect::from_min_max(
        area.min + vec2(axes::LEFT, 8.0),
        pos2((area.right() - right).max(area.left() + 60.0), (area.bottom() - axes::BOTTOM).max(area.top() + 30.0)),
    );
    if projection == Projection::RangeAngle {
        return rect;
    }
    // Equal aspect: the map is twice as wide as high.
    let size = vec2(rect.width().min(2.0 * rect.height()), rect.height().min(rect.width() / 2.0));
    Align2::CENTER_CENTER.align_size_within_rect(size, rect)
}

fn navigate(ui: &Ui, rect: Rect, response: &egui::Response, view: &mut MapView, pans: bool) {
    if let Some(pos) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = pinch * (scroll / 200.0).exp();
        if factor != 1.0 {
            let fixed = view.at(rect, pos);
            view.zoom(factor, fixed);
        }
    }
    if let Some(factor) = zoom_keys(response) {
        let middle = view.at(rect, rect.center());
        view.zoom(factor, middle);
    }
    if pans && response.dragged() {
        let before = view.at(rect, rect.min);
        let after = view.at(rect, rect.min + response.drag_delta());
        view.pan(before - after);
    }
    if response.double_clicked() {
        *view = MapView::default();
    }
}

fn draw_axes(ui: &Ui, painter: &Painter, frame: Frame<'_>) {
    let Frame { rect, view, radar, projection, .. } = frame;
    let (x, y) = match projection {
        Projection::RangeAngle => {
            let cos = |fraction: f32| radar.cos_of_column(f64::from(fraction) * radar.elements as f64 - 0.5);
            let range = |fraction: f32| radar.range_of_bin_metres(f64::from(fraction) * radar.samples as f64 - 0.5);
            let title = match radar.carrier {
                Carrier::OneWay => "cos θ",
                Carrier::TwoWay => {
                    let titles = ["cos θ, folded: each column stands for two directions", "cos θ, folded"];
                    axes::fitting(painter, rect.width(), &titles)
                }
            };
            let x = Axis::new(cos(view.low.x), cos(view.high.x), title);
            (x, Axis::new(range(view.low.y), range(view.high.y), "range, m"))
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            let x = |fraction: f32| (2.0 * f64::from(fraction) - 1.0) * extent;
            let y = |fraction: f32| f64::from(fraction) * extent;
            let across = Axis::new(x(view.low.x), x(view.high.x), "x, m");
            (across, Axis::new(y(view.low.y), y(view.high.y), "y, m"))
        }
    };
    axes::draw(ui, painter, rect, x, y);
}

/// What a map without a picture says, and the way out of it.
fn empty(ui: &mut Ui, painter: &Painter, rect: Rect, error: Option<&Problem<'_>>, asked: &mut Vec<Command>) {
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    let text = error.map_or("computing…", |e| e.reason);
    let place = Rect::from_center_size(rect.center(), vec2((rect.width() - 16.0).max(40.0), 76.0));
    ui.scope_builder(egui::UiBuilder::new().max_rect(place), |ui| {
        ui.vertical_centered(|ui| {
            ui.add(egui::Label::new(egui::RichText::new(text).size(12.0).weak()).wrap().selectable(false));
            if let Some(instead) = error.and_then(|e| e.instead)
                && ui.button(format!("Use {instead}")).on_hover_text("A method that works here").clicked()
            {
                asked.push(Command::Method(instead));
            }
        });
    });
}

/// What a hidden map says, at its top: the middle is where many a peak will be. The one that waits for a click stands out.
fn veil(painter: &Painter, rect: Rect, is_clicked: bool, visuals: &egui::Visuals) {
    let (text, ink, size) = match is_clicked {
        true => ("Click where you expect it", Inks::of(visuals).selected, 16.0),
        false => ("Hidden until you have predicted", visuals.weak_text_color(), 13.0),
    };
    let at = rect.center_top() + vec2(0.0, 10.0);
    painter.text(at, Align2::CENTER_TOP, text, egui::FontId::proportional(size), ink);
    if is_clicked {
        painter.rect_stroke(rect.shrink(1.0), 0.0, egui::Stroke::new(2.0, ink), egui::StrokeKind::Inside);
    }
}

fn menu(ui: &mut Ui, kind: MapKind, asked: &mut Vec<Command>) {
    for command in [
        Command::Maximise(Panel::Map(kind)),
        Command::ToggleProjection,
        Command::ToggleUnits,
        Command::ResetMaps,
        Command::ToggleReflectors,
        Command::ToggleTheory,
        Command::CopyMap(kind),
        Command::ClosePanel(Panel::Map(kind)),
    ] {
        entry(ui, command, true, asked);
    }
    if kind == MapKind::Difference {
        entry(ui, Command::ToggleAbsoluteDifference, true, asked);
        entry(ui, Command::ToggleWholeDifference, true, asked);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use crate::maps::{LambdaScale, RangeAngleMap};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use ndarray::Array2;
    use std::sync::LazyLock;

    static NOTHING: LazyLock<(Scene, Selection)> = LazyLock::new(Default::default);

    fn input<'a>(radar: &'a Radar, error: Option<Problem<'a>>) -> Input<'a> {
        let (scene, selection) = &*NOTHING;
        Input { error, ..Input::bare(MapKind::Output, radar, Projection::RangeAngle, scene, selection) }
    }

    fn draw(ui: &mut Ui, error: Option<Problem<'_>>, asked: &mut Vec<Command>) {
        let radar = Radar::default();
        asked.extend(show(ui, input(&radar, error), &mut MapView::default(), &mut Memory::default()));
    }

    #[test]
    fn the_pointer_is_told_in_cells() {
        let mut map = Harness::new_ui_state(|ui, asked| draw(ui, None, asked), Vec::new());
        map.step();
        let rect = map.get_by_label("Output map").rect();
        map.hover_at(rect.center());
        map.step();
        let Some(Command::Hover(cursor)) = map.state().last() else { panic!("{:?}", map.state()) };
        assert!((cursor.bin - 255.5).abs() < 1.0 && (cursor.column - 511.5).abs() < 1.0, "{cursor:?}");
    }

    #[test]
    fn a_refusal_is_told_and_another_method_offered() {
        let problem = || Problem { reason: "trained on another radar", instead: Some("capon") };
        let mut map = Harness::new_ui_state(|ui, asked| draw(ui, Some(problem()), asked), Vec::new());
        map.step();
        let _told = map.get_by_label("trained on another radar");
        let _one = map.get_by_label("Output map");
        map.get_by_label("Use capon").click();
        map.step();
        assert!(map.state().contains(&Command::Method("capon")), "{:?}", map.state());
    }

    #[test]
    fn every_label_of_a_map_is_inside_its_panel_whatever_is_counted() {
        let lambda = RangeAngleMap { lambda: Array2::zeros((2, 2)) };
        for size in [[270.0, 130.0], [450.0, 270.0], [1400.0, 800.0]] {
            for (kind, units) in [
                (MapKind::Target, Units::Lambda),
                (MapKind::Target, Units::Decibels),
                (MapKind::Difference, Units::Lambda),
                (MapKind::Difference, Units::Decibels),
                (MapKind::TargetAbove, Units::Lambda),
            ] {
                let (lambda, radar) = (lambda.clone(), Radar::default());
                let map = Harness::builder().with_size(size).build_ui(move |ui| {
                    let scale = Some(LambdaScale { peak: 3.0, floor: -12.5 });
                    let cells = Some(Cells { map: &lambda, minus: None, scale });
                    let texture = Some(TextureId::default());
                    let input = Input { kind, units, cells, texture, end: 0.05, ..input(&radar, None) };
                    _ = show(ui, input, &mut MapView::default(), &mut Memory::default());
                });
                seen::assert_readable(map.output());
                let texts = seen::texts(map.output());
                assert!(texts.iter().any(|t| t.text == "range, m" || size[1] < 200.0), "{texts:?}");
                let bar = match (kind, units) {
                    (MapKind::TargetAbove, _) => None,
                    (MapKind::Difference, Units::Lambda) => Some("ΔΛ"),
                    (MapKind::Difference, Units::Decibels) => Some("Δ dB"),
                    (_, Units::Lambda) => Some("Λ"),
                    (_, Units::Decibels) => Some("−200"),
                };
                assert!(bar.is_none_or(|bar| texts.iter().any(|t| t.text == bar)), "{bar:?} at {size:?}: {texts:?}");
            }
        }
    }

    #[test]
    fn a_map_that_was_never_there_is_not_of_an_earlier_scene() {
        let radar = Radar::default();
        let map = Harness::builder().build_ui(move |ui| {
            _ = show(ui, Input { stale: true, ..input(&radar, None) }, &mut MapView::default(), &mut Memory::default());
        });
        let texts = seen::texts(map.output());
        assert!(texts.iter().any(|t| t.text == "computing…"));
        assert!(!texts.iter().any(|t| t.text.contains("earlier scene")), "{texts:?}");
    }
}
