//! A map within its panel: its rectangle, its axes, zoom and pan.

use super::frame::{BUTTON_SIZE_POINTS, Frame};
use super::legend::MIN_PANEL_HEIGHT_POINTS;
use crate::app::state::{Command, Directions, MapKind, MapView, Projection, ViewCommand};
use crate::app::widgets::{Axis, Icon, Tick, axes, icons, pan_keys, zoom_keys};
use crate::radar::Radar;
use eframe::egui::{Align2, Painter, Rect, Response, Ui, pos2, vec2};

/// Height that is kept free above a Cartesian map, points, with the margin: that of a caption.
const CAPTION_BAND_POINTS: f32 = 20.0;

/// Rectangle of the picture within the panel, below a legend that is `above` points high. Every map has the same margins.
pub fn rect_of(area: Rect, projection: Projection, above: f32) -> Rect {
    let right = if is_wide(area) { axes::RIGHT } else { 12.0 };
    let (left, top) = (area.left() + axes::LEFT, area.top() + 8.0 + above);
    let (right, bottom) = ((area.right() - right).max(area.left() + 60.0), area.bottom() - axes::BOTTOM);
    let rect = Rect::from_min_max(pos2(left, top), pos2(right, bottom.max(area.top() + above + 30.0)));
    if projection == Projection::RangeAngle {
        return rect;
    }
    // Equal aspect: the map is twice as wide as high. The half disc leaves no corner of it large enough for a caption, so the free room is above.
    let band = if area.height() > MIN_PANEL_HEIGHT_POINTS { CAPTION_BAND_POINTS } else { 0.0 };
    let high = rect.height() - band;
    let size = vec2(rect.width().min(2.0 * high), high.min(rect.width() / 2.0));
    Align2::CENTER_BOTTOM.align_size_within_rect(size, rect)
}

/// Whether a panel has room for a bar of colours beside its map.
pub fn is_wide(area: Rect) -> bool {
    area.width() > 200.0
}

/// Zooms by wheel, pinch and keys, pans by dragging and by arrow keys (where these are `free`, without Ctrl); a double click shows the whole map.
pub fn navigate(ui: &Ui, rect: Rect, response: &Response, view: &mut MapView, pans: bool, free: bool) {
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
    if let Some(by) = pan_keys(response, free) {
        view.pan(by * (view.high - view.low));
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

/// Titles of the axis of directions in degrees, the longest first.
const DEGREE_TITLES: &[&str] =
    &["degrees from straight ahead: − is left, + is right", "degrees from straight ahead", "degrees"];

/// Least period of the folding, in cos(theta), with which nearly every direction has a column of its own.
const MIN_FOLD_PERIOD_COS: f64 = 1.9;

/// Titles of the axis of directions in cos(theta), the longest first.
fn direction_titles(radar: &Radar) -> &'static [&'static str] {
    if radar.fold_period_cos() < MIN_FOLD_PERIOD_COS {
        return &["cos θ, folded: each column stands for two directions", "cos θ, folded"];
    }
    &[
        "cos θ: −1 is −90° (left), 0 straight ahead, 1 is +90° (right)",
        "cos θ (0 straight ahead, 1 at 90° right)",
        "cos θ",
    ]
}

/// Widest column, in cos(theta), with which the edges of a map count as its outermost directions.
const MAX_COLUMN_OF_SLACK_COS: f64 = 0.05;

/// Degrees between marks, the finest first.
const DEGREE_STEPS: [f64; 7] = [0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0];

const DIRECTION_GAP_POINTS: f32 = 8.0;

/// Ticks at round angles from straight ahead, for an axis of cos θ from `low` to `high` over `length` points: the finest step whose labels
/// have room. Labels crowd towards the sides, where those without room are left out.
fn degrees(painter: &Painter, low: f64, high: f64, length: f32) -> Vec<Tick> {
    let text = |degrees: f64| format!("{degrees}°").replace('-', "−");
    let part = |degrees: f64| ((degrees.to_radians().sin() - low) / (high - low)) as f32;
    let of = |step: f64| -> Vec<f64> {
        let last = (90.0 / step).floor() as i64;
        let angles = (-last..=last).map(|i| i as f64 * step);
        angles.filter(|degrees| (-1e-4..=1.0 + 1e-4).contains(&part(*degrees))).collect()
    };
    // The room includes a minus, so that both sides have the same marks.
    let room = |degrees: f64| axes::width(painter, &text(-degrees.abs())) + DIRECTION_GAP_POINTS;
    // Directions are farthest apart straight ahead; the middle of the visible part decides.
    let fits = |step: &&f64| {
        let angles = of(**step);
        let apart = |pair: &[f64]| (part(pair[1]) - part(pair[0])).abs() * length >= room(pair[1]).max(room(pair[0]));
        angles.len() < 4 || angles.windows(2).filter(|pair| apart(pair)).count() * 2 > angles.len()
    };
    let mut angles = of(DEGREE_STEPS.iter().find(fits).copied().unwrap_or(30.0));
    // Sorted from straight ahead to both sides.
    angles.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let mut taken: Vec<[f32; 2]> = Vec::new();
    let mut ticks = Vec::new();
    for degrees in angles {
        let (at, half) = (part(degrees) * length, room(degrees) / 2.0);
        let [from, to] = [at - half, at + half];
        if taken.iter().all(|other| to <= other[0] || from >= other[1]) {
            ticks.push(Tick { value: degrees.to_radians().sin(), text: text(degrees) });
            taken.push([from, to]);
        }
    }
    ticks.sort_by(|a, b| a.value.total_cmp(&b.value));
    ticks
}

/// Draws both axes of the visible part; the title below leaves `free` points at each end. The vertical axis is Lambda where the map is a line.
pub fn draw_axes(ui: &Ui, painter: &Painter, frame: Frame<'_>, directions: Directions, (free, is_line): (f32, bool)) {
    let Frame { rect, view, radar, projection, .. } = frame;
    let marks;
    let (x, y) = match projection {
        Projection::RangeAngle => {
            let cos = |fraction: f32| radar.cos_of_column(radar.column_across(f64::from(fraction)));
            let range = |fraction: f32| radar.range_of_bin_metres(f64::from(fraction) * radar.samples as f64 - 0.5);
            let titles = match directions {
                Directions::Cosine => direction_titles(radar),
                Directions::Degrees => DEGREE_TITLES,
            };
            let title = axes::fitting(painter, rect.width() - 2.0 * free, titles);
            // A column stands for the direction in its middle: the ends of a whole map are half a column away from a round number.
            let column = cos(1.0 / radar.elements as f32) - cos(0.0);
            let is_near = view.high.x - view.low.x == 1.0 && column.abs() < MAX_COLUMN_OF_SLACK_COS;
            let slack = if is_near { 0.51 * column } else { 0.0 };
            let (low, high) = (cos(view.low.x), cos(view.high.x));
            let x = match directions {
                Directions::Cosine => Axis::new(low, high, title).with_slack(slack),
                Directions::Degrees => {
                    marks = degrees(painter, low, high, rect.width());
                    Axis { ticks: Some(&marks), ..Axis::new(low, high, title).with_slack(slack) }
                }
            };
            // The only row of a snapshot has no range.
            let y = match radar.samples {
                _ if is_line => Axis::new(view.low.y.into(), view.high.y.into(), "Λ of one range"),
                1 => Axis { ticks: Some(&[]), ..Axis::new(0.0, 1.0, "one range") },
                _ => Axis::new(range(view.low.y), range(view.high.y), "range, m"),
            };
            (x, y)
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

/// Draws the button in a map's corner that changes the projection of all maps. The upper corners of a Cartesian map are outside its half disc.
pub fn projection_button(ui: &mut Ui, rect: Rect, kind: MapKind, projection: Projection, asked: &mut Vec<Command>) {
    if rect.width() < 120.0 || rect.height() < 60.0 {
        return;
    }
    let (icon, name) = match projection {
        Projection::RangeAngle => (Icon::Fan, "bend into x and y"),
        Projection::Cartesian => (Icon::Grid, "straighten into cos θ and range"),
    };
    let corner = match projection {
        Projection::RangeAngle => rect.right_bottom() - vec2(4.0, 4.0) - BUTTON_SIZE_POINTS,
        Projection::Cartesian => rect.left_top() + vec2(4.0, 4.0),
    };
    let corner = Rect::from_min_size(corner, BUTTON_SIZE_POINTS);
    if icons::over_picture(ui, corner, icon, &format!("{}: {name}", kind.title())).clicked() {
        asked.push(ViewCommand::SetProjection(projection.other()).into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::presets::RadarPreset;

    #[test]
    fn an_axis_in_degrees_has_round_angles_where_cos_theta_has_them() {
        let draw = |ui: &mut Ui| {
            for (low, high, length) in [(-1.0, 1.0, 700.0), (-1.0, 1.0, 160.0), (-0.1, 0.3, 400.0)] {
                let ticks = degrees(ui.painter(), low, high, length);
                assert!(ticks.len() >= 3, "{ticks:?}");
                for tick in &ticks {
                    let told: f64 = tick.text.trim_end_matches('°').replace('−', "-").parse().unwrap();
                    assert!((told.to_radians().sin() - tick.value).abs() < 1e-9, "{tick:?}");
                }
                let places: Vec<f32> = ticks.iter().map(|t| ((t.value - low) / (high - low)) as f32 * length).collect();
                assert!(places.windows(2).all(|pair| pair[1] - pair[0] > 16.0), "{ticks:?} at {places:?}");
                let mirrored = ticks.iter().rev().map(|t| -t.value);
                let is_even = ticks.iter().zip(mirrored).all(|(t, other)| (t.value - other).abs() < 1e-9);
                assert!(is_even || low != -high, "both sides have the same marks: {ticks:?}");
            }
        };
        _ = egui_kittest::Harness::new_ui(draw);
    }

    #[test]
    fn only_radars_whose_directions_share_columns_are_called_folded() {
        let is_folded = |radar: &Radar| direction_titles(radar)[0].contains("folded");
        for id in ["table-3.1", "table-3.1-physical", "cascade-12x16", "chip-3x4"] {
            assert!(!is_folded(&RadarPreset::by_id(id).expect("a preset").radar), "{id}");
        }
        assert!(is_folded(&RadarPreset::by_id("one-wavelength").expect("a preset").radar));
        assert!(is_folded(&Radar { carrier: crate::radar::Carrier::TwoWay, ..Radar::default() }));
    }
}
