//! One map: picture, axes, colour bar, cursor, marks.

use super::application::App;
use super::axes::{self, Axis};
use super::command::Command;
use super::layout::Panel;
use super::pictures::{self, MapKind};
use super::settings::Projection;
use super::theme::{MARK, MARK_EDGE, Palette};
use super::view::{Cursor, Window};
use crate::interact::Place;
use crate::picture::ColourMap;
use crate::radar::Radar;
use crate::scene::Reflector;
use eframe::egui;
use eframe::egui::{Align2, Color32, Mesh, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

/// Width of the colour bar with its numbers.
const BAR: f32 = 38.0;

/// Most reflectors that are marked.
const MARKS: usize = 4000;

/// Draws a map.
pub(super) fn show(app: &mut App, ui: &mut Ui, kind: MapKind) {
    let area = ui.available_rect_before_wrap();
    ui.painter().rect_filled(area, 0.0, ui.visuals().panel_fill);
    let bar = has_bar(kind) && area.width() > 250.0;
    let right = if bar { BAR } else { 10.0 };
    let mut rect = Rect::from_min_max(
        area.min + vec2(axes::LEFT + 4.0, 8.0),
        pos2((area.right() - right).max(area.left() + 60.0), (area.bottom() - axes::BOTTOM).max(area.top() + 30.0)),
    );
    let projection = app.settings.projection;
    if projection == Projection::Cartesian {
        // Equal aspect: the map is twice as wide as high.
        let size = vec2(rect.width().min(2.0 * rect.height()), rect.height().min(rect.width() / 2.0));
        rect = Align2::CENTER_CENTER.align_size_within_rect(size, rect);
    }
    let response = ui.interact(rect, ui.scope_id().with(("map", kind)), Sense::click_and_drag());
    let label = format!("{} map", kind.title());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
    navigate(app, ui, rect, &response);
    let painter = ui.painter().with_clip_rect(area);
    let inner = ui.painter().with_clip_rect(rect.intersect(area));
    let window = *window_of(app);
    match app.texture(ui.ctx(), kind) {
        Some(texture) => {
            let uv = Rect::from_min_max(pos2(window.low.x, window.high.y), pos2(window.high.x, window.low.y));
            inner.rect_filled(rect, 0.0, Palette::of(ui.visuals()).beyond);
            inner.image(texture, rect, uv, Color32::WHITE);
        }
        None => empty(app, ui, &inner, rect, kind),
    }
    draw_axes(app, ui, &painter, rect, window);
    marks(app, &inner, rect, window, kind);
    if let Some(pos) = response.hover_pos() {
        app.next_cursor = cursor_at(&app.radar, projection, window.at(rect, pos));
    }
    cursor(app, &inner, rect, window, kind);
    if bar {
        let bar = Rect::from_min_max(pos2(rect.right() + 7.0, rect.top()), pos2(rect.right() + 16.0, rect.bottom()));
        colour_bar(app, ui, &painter, bar, kind);
    }
    response.context_menu(|ui| menu(app, ui, kind));
}

/// What stands in the title bar of a map's panel: its figures.
pub(super) fn heading(app: &App, ui: &mut Ui, kind: MapKind) {
    let weak = |ui: &mut Ui, text: String| {
        let text = egui::RichText::new(text).size(11.0).weak();
        ui.add(egui::Label::new(text).selectable(false).truncate());
    };
    let scores = app.pipeline.result.as_ref().and_then(|r| r.scores);
    match kind {
        MapKind::TargetAbove => weak(ui, format!("η' = {:.2} ", app.settings.target_eta)),
        MapKind::OutputAbove => {
            let figures = scores.map_or_else(String::new, |s| {
                let detection = s.metrics.detection.map_or("–".to_owned(), |d| format!("{:.1} %", d * 100.0));
                format!("P_D {detection} · P_FA {:.2} % · ", s.metrics.false_alarm * 100.0)
            });
            weak(ui, format!("{figures}η = {:.2} ", app.output_eta()));
        }
        MapKind::Output => {
            let name = app.method().map_or("", |m| m.name());
            let stale = if app.pipeline.output_is_stale() { " (updating)" } else { "" };
            weak(ui, format!("{name}{stale} "));
        }
        MapKind::Difference => {
            if let Some(s) = scores {
                weak(ui, format!("SE {:.0} ", s.metrics.squared_error));
            }
        }
        _ => {}
    }
}

fn has_bar(kind: MapKind) -> bool {
    !matches!(kind, MapKind::TargetAbove | MapKind::OutputAbove)
}

fn window_of(app: &mut App) -> &mut Window {
    match app.settings.projection {
        Projection::RangeAngle => &mut app.range_angle,
        Projection::Cartesian => &mut app.cartesian,
    }
}

fn navigate(app: &mut App, ui: &Ui, rect: Rect, response: &egui::Response) {
    let window = window_of(app);
    if let Some(pos) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
        let factor = pinch * (scroll / 200.0).exp();
        if factor != 1.0 {
            let fixed = window.at(rect, pos);
            window.zoom(factor, fixed);
        }
    }
    if response.dragged() {
        let before = window.at(rect, rect.min);
        let after = window.at(rect, rect.min + response.drag_delta());
        window.pan(before - after);
    }
    if response.double_clicked() {
        *window = Window::default();
    }
}

/// A place of the map as fractions of its width and height, to a cursor. `None` outside the radar's view.
fn cursor_at(radar: &Radar, projection: Projection, fraction: Pos2) -> Option<Cursor> {
    let (fx, fy) = (f64::from(fraction.x), f64::from(fraction.y));
    match projection {
        Projection::RangeAngle => {
            Some(Cursor::at_cell(radar, fy * radar.samples as f64 - 0.5, fx * radar.elements as f64 - 0.5))
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            let cursor = Cursor::at_place(radar, Place::new((2.0 * fx - 1.0) * extent, fy * extent));
            cursor.cell(radar).map(|_| cursor)
        }
    }
}

/// Where a place of the scene appears in the map, as fractions.
fn fraction_of(radar: &Radar, projection: Projection, cursor: &Cursor) -> Pos2 {
    match projection {
        Projection::RangeAngle => {
            let bin = cursor.bin.rem_euclid(radar.samples as f64);
            pos2(((cursor.column + 0.5) / radar.elements as f64) as f32, ((bin + 0.5) / radar.samples as f64) as f32)
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            // A line array sees y and -y alike.
            let (x, y) = (cursor.place.x_metres, cursor.place.y_metres.abs());
            pos2(((x / extent + 1.0) / 2.0) as f32, (y / extent) as f32)
        }
    }
}

fn draw_axes(app: &App, ui: &Ui, painter: &Painter, rect: Rect, window: Window) {
    let radar = &app.radar;
    match app.settings.projection {
        Projection::RangeAngle => {
            let cos = |fraction: f32| radar.cos_of_column(f64::from(fraction) * radar.elements as f64 - 0.5);
            let range = |fraction: f32| radar.range_of_bin_metres(f64::from(fraction) * radar.samples as f64 - 0.5);
            let title = match radar.carrier {
                crate::radar::Carrier::OneWay => "cos θ",
                crate::radar::Carrier::TwoWay => "cos θ, folded: each column stands for two directions",
            };
            axes::draw(
                ui,
                painter,
                rect,
                Axis { low: cos(window.low.x), high: cos(window.high.x), title },
                Axis { low: range(window.low.y), high: range(window.high.y), title: "range, m" },
            );
        }
        Projection::Cartesian => {
            let extent = radar.max_range_metres();
            let x = |fraction: f32| (2.0 * f64::from(fraction) - 1.0) * extent;
            let y = |fraction: f32| f64::from(fraction) * extent;
            axes::draw(
                ui,
                painter,
                rect,
                Axis { low: x(window.low.x), high: x(window.high.x), title: "x, m" },
                Axis { low: y(window.low.y), high: y(window.high.y), title: "y, m" },
            );
        }
    }
}

/// What a map without a picture says.
fn empty(app: &App, ui: &Ui, painter: &Painter, rect: Rect, kind: MapKind) {
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    let text = match (&app.pipeline.scene_error, &app.pipeline.method_error) {
        (Some(error), _) => error.clone(),
        (None, Some(error)) if kind.needs_output() => error.clone(),
        _ => "computing…".to_owned(),
    };
    let galley =
        painter.layout(text, egui::FontId::proportional(12.0), ui.visuals().weak_text_color(), rect.width() - 16.0);
    painter.galley(rect.center() - galley.size() / 2.0, galley, ui.visuals().weak_text_color());
}

/// True reflectors as rings, those the method found as crosses.
fn marks(app: &App, painter: &Painter, rect: Rect, window: Window, kind: MapKind) {
    let place = |r: &Reflector| {
        let cursor = Cursor::at_place(&app.radar, Place::new(r.x_metres, r.y_metres));
        window.to_screen(rect, fraction_of(&app.radar, app.settings.projection, &cursor))
    };
    if app.settings.show_reflectors {
        let reflectors = app.editor.scene().reflectors();
        let radius = if reflectors.len() > 60 { 2.5 } else { 6.0 };
        for r in reflectors.iter().take(MARKS) {
            let at = place(r);
            painter.circle_stroke(at, radius, Stroke::new(2.5, MARK_EDGE));
            painter.circle_stroke(at, radius, Stroke::new(1.2, MARK));
        }
    }
    if app.settings.show_found
        && kind.needs_output()
        && let Some(output) = &app.pipeline.output
    {
        for r in output.found.reflectors.iter().take(MARKS) {
            cross(painter, place(r), 4.0, Stroke::new(2.6, MARK_EDGE));
            cross(painter, place(r), 4.0, Stroke::new(1.3, Color32::from_rgb(120, 255, 150)));
        }
    }
}

fn cross(painter: &Painter, at: Pos2, r: f32, stroke: Stroke) {
    painter.line_segment([at + vec2(-r, -r), at + vec2(r, r)], stroke);
    painter.line_segment([at + vec2(-r, r), at + vec2(r, -r)], stroke);
}

/// The cell under the pointer of whichever panel has it, and its value here.
fn cursor(app: &App, painter: &Painter, rect: Rect, window: Window, kind: MapKind) {
    let Some(cursor) = app.cursor else { return };
    let Some((bin, column)) = cursor.cell(&app.radar) else { return };
    let at = window.to_screen(rect, fraction_of(&app.radar, app.settings.projection, &cursor));
    for (stroke, gap) in [(Stroke::new(2.6, Color32::from_black_alpha(110)), 7.0), (Stroke::new(1.0, MARK), 7.0)] {
        if app.settings.projection == Projection::RangeAngle {
            painter.hline(rect.left()..=at.x - gap, at.y, stroke);
            painter.hline(at.x + gap..=rect.right(), at.y, stroke);
            painter.vline(at.x, rect.top()..=at.y - gap, stroke);
            painter.vline(at.x, at.y + gap..=rect.bottom(), stroke);
        }
        painter.circle_stroke(at, gap, stroke);
    }
    let text = value_text(app, kind, bin, column);
    if let Some(text) = text {
        // Away from the pointer: in the corner where it isn't.
        let (corner, align) = if at.y < rect.top() + 40.0 && at.x > rect.center().x {
            (rect.left_top() + vec2(10.0, 8.0), Align2::LEFT_TOP)
        } else {
            (rect.right_top() + vec2(-10.0, 8.0), Align2::RIGHT_TOP)
        };
        axes::text_on_patch(painter, corner, align, &text);
    }
}

/// Value of a map's cell in Lambda and decibels below the peak.
fn value_text(app: &App, kind: MapKind, bin: usize, column: usize) -> Option<String> {
    let result = app.pipeline.result.as_ref()?;
    let at = |map: &crate::maps::RangeAngleMap| map.lambda.get((bin, column)).copied();
    let frame = &result.frame;
    let output = app.pipeline.output.as_ref().map(|o| &o.lambda);
    let (lambda, scale) = match kind {
        MapKind::Input0 => (at(&frame.first.as_ref()?.lambda)?, Some(frame.first.as_ref()?.scale)),
        MapKind::Input1 => (at(&frame.last.as_ref()?.lambda)?, Some(frame.last.as_ref()?.scale)),
        MapKind::Target | MapKind::TargetAbove => (at(&frame.full.as_ref()?.lambda)?, Some(frame.full.as_ref()?.scale)),
        MapKind::Output | MapKind::OutputAbove => (at(output?)?, frame.full.as_ref().map(|f| f.scale)),
        MapKind::Difference => {
            let difference = at(output?)? - at(&frame.full.as_ref()?.lambda)?;
            return Some(format!("ΔΛ {difference:+.3}"));
        }
    };
    let decibels = scale.map(|s| 20.0 * (s.peak - s.floor) * (f64::from(lambda) - 1.0));
    Some(match decibels {
        Some(db) => format!("Λ {lambda:.3}  {db:6.1} dB"),
        None => format!("Λ {lambda:.3}"),
    })
}

fn colour_bar(app: &App, ui: &Ui, painter: &Painter, rect: Rect, kind: MapKind) {
    let (table, low, high) = match kind {
        MapKind::Difference => (pictures::table(ColourMap::Diverging), -1.0, 1.0),
        _ => (pictures::table(app.settings.colours), 0.0, 1.0),
    };
    let mut mesh = Mesh::default();
    let steps = 32;
    for i in 0..=steps {
        let part = i as f32 / steps as f32;
        let y = rect.bottom() - part * rect.height();
        let colour = table[(part * 255.0) as usize];
        mesh.colored_vertex(pos2(rect.left(), y), colour);
        mesh.colored_vertex(pos2(rect.right(), y), colour);
        if i > 0 {
            let v = 2 * i as u32;
            mesh.add_triangle(v - 2, v - 1, v);
            mesh.add_triangle(v - 1, v, v + 1);
        }
    }
    painter.add(Shape::mesh(mesh));
    let ink = ui.visuals().weak_text_color();
    for value in axes::ticks(low, high, (rect.height() / 40.0).min(5.0)) {
        let part = ((value - low) / (high - low)) as f32;
        let y = rect.bottom() - part * rect.height();
        painter.hline(rect.right()..=rect.right() + 2.0, y, Stroke::new(1.0, ink));
        axes::text(painter, pos2(rect.right() + 4.0, y), Align2::LEFT_CENTER, &axes::tick_text(value, 0.1), ink);
    }
    let title = if kind == MapKind::Difference { "ΔΛ" } else { "Λ" };
    axes::text(painter, pos2(rect.center().x, rect.bottom() + 16.0), Align2::CENTER_TOP, title, ink);
}

fn menu(app: &mut App, ui: &mut Ui, kind: MapKind) {
    for command in [
        Command::Maximise(Panel::Map(kind)),
        Command::ToggleProjection,
        Command::ResetMaps,
        Command::ToggleReflectors,
        Command::ClosePanel(Panel::Map(kind)),
    ] {
        super::menu::entry(app, ui, command, true);
    }
}
