//! Two markers on a cut: placing, dragging and readings, which are levels and widths of peaks.

use super::trace::{Cut, Trace};
use crate::app::state::Units;
use crate::app::widgets::{
    self, Chart, Drawn, Span, angle_degrees, axes, difference, direction, signed, significant, with_unit,
};
use crate::radar::Radar;
use eframe::egui::{Align2, Color32, CursorIcon, Stroke, Ui, pos2, vec2};
use egui_plot::LineStyle;

/// Largest distance of the pointer from a marker to drag it, points.
const MARKER_REACH_POINTS: f32 = 7.0;

pub const NAMES: [&str; 2] = ["A", "B"];

/// Places on the axis of a cut.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Markers {
    /// Places of A and B; `None` for one that is not placed.
    pub places: [Option<f64>; 2],
    pub held: Option<usize>,
}

impl Markers {
    pub fn is_empty(&self) -> bool {
        self.places == [None, None]
    }

    /// Puts a marker at a place: first A, then B, then the nearer of the two.
    pub fn place(&mut self, at: f64) {
        let index = match self.places {
            [None, _] => 0,
            [_, None] => 1,
            [Some(a), Some(b)] => usize::from((b - at).abs() < (a - at).abs()),
        };
        self.places[index] = Some(at);
    }

    /// Handles the pointer: a click places a marker, a drag moves the one under the pointer.
    pub fn follow(&mut self, ui: &Ui, drawn: &Drawn, whole: Span) {
        let x_of = |place: f64| drawn.at([place, 0.0]).x;
        let under = |at: f32| {
            let away = |i: &usize| self.places[*i].map_or(f32::INFINITY, |place| (x_of(place) - at).abs());
            (0..2).min_by(|a, b| away(a).total_cmp(&away(b))).filter(|i| away(i) <= MARKER_REACH_POINTS)
        };
        let response = &drawn.response;
        let hovered = response.hover_pos().and_then(|pos| under(pos.x));
        if response.drag_started() {
            self.held = ui.input(|i| i.pointer.press_origin()).and_then(|pos| under(pos.x));
        }
        if let Some((index, pos)) = self.held.zip(response.interact_pointer_pos()) {
            self.places[index] = Some(whole.nearest(drawn.x_at(pos)));
        } else if let Some(pos) = response.interact_pointer_pos().filter(|_| response.clicked()) {
            self.place(whole.nearest(drawn.x_at(pos)));
        }
        if response.drag_stopped() {
            self.held = None;
        }
        if hovered.or(self.held).is_some() {
            ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
        }
    }

    pub fn draw(&self, drawn: &Drawn, ink: Color32) {
        for (place, name) in self.places.into_iter().zip(NAMES) {
            let Some(place) = place else { continue };
            let at = pos2(drawn.at([place, 0.0]).x, drawn.rect.top());
            drawn.painter.vline(at.x, drawn.rect.y_range(), Stroke::new(1.5, ink));
            if drawn.rect.x_range().contains(at.x) {
                axes::text_on_patch(&drawn.painter, at + vec2(6.0, 3.0), Align2::LEFT_TOP, name);
            }
        }
    }
}

/// Texts of a line's levels at the markers, their difference, and the widths of its peaks.
pub fn readings(cut: Cut, radar: &Radar, trace: &Trace, units: Units, markers: &Markers) -> Vec<String> {
    let decibels = trace.decibels();
    let level = |place: f64| decibels.as_ref().and_then(|points| value_at(points, place));
    let mut said = Vec::new();
    let one = |(place, name): (Option<f64>, &str)| {
        let lambda = format!("Λ {:.3}", value_at(&trace.lambda, place?)?);
        let level = level(place?).zip(trace.range_db());
        let level = level.map(|(db, range_db)| with_unit(&widgets::level(db, range_db)));
        let value = match (level, units) {
            (None, _) => lambda,
            (Some(level), Units::Lambda) => format!("{lambda}, {level}"),
            (Some(level), Units::Decibels) => format!("{level}, {lambda}"),
        };
        let at = if cut == Cut::Angle { format!(" at {}", direction(place?, 2)) } else { String::new() };
        Some(format!("{name}{at}: {value}"))
    };
    said.extend(markers.places.into_iter().zip(NAMES).filter_map(one));
    if let [Some(a), Some(b)] = markers.places {
        let levels = level(a).zip(level(b)).map_or_else(String::new, |(a, b)| format!(", {} dB", difference(b - a)));
        said.push(format!("B − A: {}{levels}", between(cut, radar, a, b)));
    }
    let width = |(place, name): (Option<f64>, &str)| {
        let Width { low, high, cells, .. } = width_at(decibels.as_ref()?, place?)?;
        Some(format!("3 dB width at {name}: {}", extent(cut, low, high, cells)))
    };
    said.extend(markers.places.into_iter().zip(NAMES).filter_map(width));
    said
}

fn between(cut: Cut, radar: &Radar, a: f64, b: f64) -> String {
    match cut {
        Cut::Angle => {
            let columns = (b - a) / (radar.cos_of_column(1.0) - radar.cos_of_column(0.0));
            let (cos, angle) = (signed(b - a, 4), signed(angle_degrees(b) - angle_degrees(a), 2));
            format!("{angle}° = {cos} in cos θ = {} columns", signed(columns, 1))
        }
        Cut::Range => {
            let bins = radar.bin_of_range(b) - radar.bin_of_range(a);
            format!("{} m = {} bins", signed(b - a, 3), signed(bins, 1))
        }
    }
}

fn extent(cut: Cut, low: f64, high: f64, cells: f64) -> String {
    let size = significant(high - low);
    match cut {
        Cut::Angle => {
            let angle = significant((angle_degrees(low) - angle_degrees(high)).abs());
            format!("{angle}° = {size} in cos θ = {} columns", significant(cells))
        }
        Cut::Range => format!("{size} m = {} bins", significant(cells)),
    }
}

/// Draws the width of the peak at each marker, where the line has fallen by 3 dB. `y_of` turns decibels into the chart's unit.
pub fn draw_widths(chart: &mut Chart<'_>, trace: &Trace, markers: &Markers, ink: Color32, y_of: impl Fn(f64) -> f64) {
    let Some(points) = trace.decibels() else { return };
    for place in markers.places.into_iter().flatten() {
        let Some(width) = width_at(&points, place) else { continue };
        let y = y_of(width.level_db);
        chart.line([[width.low, y], [width.high, y]], Stroke::new(2.5, ink), LineStyle::Solid);
        chart.dot([width.low, y], 3.0, ink);
        chart.dot([width.high, y], 3.0, ink);
    }
}

/// Drop below a peak at which its width is measured, decibels.
const DROP_DB: f64 = 3.0;

/// The 3 dB width of a peak.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Width {
    /// Place on the axis where the near side has fallen by 3 dB.
    low: f64,
    /// Place on the axis where the far side has fallen by 3 dB.
    high: f64,
    /// Level at both places, decibels.
    level_db: f64,
    /// Width between both places, cells.
    cells: f64,
}

/// Value at a place between the first cell and the last, along straight lines between cells.
fn value_at(points: &[[f64; 2]], place: f64) -> Option<f64> {
    let after = points.iter().position(|[x, _]| *x >= place)?;
    let [x1, y1] = points[after];
    let [x0, y0] = points[after.saturating_sub(1)];
    match x1 > x0 {
        true if place >= x0 => Some(y0 + (y1 - y0) * (place - x0) / (x1 - x0)),
        true => None,
        false => (place == x1).then_some(y1),
    }
}

/// Width of the peak that is uphill of a place, in decibels over equidistant cells. The summit is that of the parabola through the three
/// highest cells, and so is the width where it is at most two cells: exact for a Gaussian lobe. Wider ones are measured along straight
/// lines between cells. `None` where there is no peak, or where it doesn't fall by 3 dB before something higher comes.
fn width_at(points: &[[f64; 2]], place: f64) -> Option<Width> {
    let distance = |i: &usize| (points[*i][0] - place).abs();
    let mut top = (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let level = |i: usize| points[i][1];
    let higher = |from: usize| [from.checked_sub(1), Some(from + 1).filter(|i| *i < points.len())];
    while let Some(next) = higher(top)
        .into_iter()
        .flatten()
        .filter(|i| level(*i) > level(top))
        .max_by(|a, b| level(*a).total_cmp(&level(*b)))
    {
        top = next;
    }
    if top == 0 || top + 1 >= points.len() {
        return None;
    }
    let (left, right) = (level(top - 1), level(top + 1));
    let bend = level(top) - (left + right) / 2.0;
    if bend <= 0.0 {
        return None;
    }
    let slope = (right - left) / 2.0;
    let (summit, peak) = (slope / (2.0 * bend), level(top) + slope * slope / (4.0 * bend));
    let half = (DROP_DB / bend).sqrt();
    let threshold = peak - DROP_DB;
    // Number of cells from the summit to the fall below the threshold on one side.
    let side = |sign: f64| -> Option<f64> {
        let near = summit + sign * half;
        if half <= 1.0 {
            // The line must fall as far as the parabola predicts before it rises again.
            let beyond = top as f64 + near.signum() * near.abs().ceil().max(1.0);
            return (beyond >= 0.0 && beyond < points.len() as f64 && level(beyond as usize) <= threshold)
                .then_some(near);
        }
        let mut steps = 1;
        loop {
            let here =
                if sign > 0.0 { Some(top + steps).filter(|i| *i < points.len()) } else { top.checked_sub(steps) }?;
            if level(here) > level(top) {
                return None;
            }
            if level(here) <= threshold {
                let before = level(if sign > 0.0 { here - 1 } else { here + 1 });
                let part = (before - threshold) / (before - level(here));
                return Some(sign * ((steps - 1) as f64 + part.clamp(0.0, 1.0)));
            }
            steps += 1;
        }
    };
    let (low, high) = (side(-1.0)?, side(1.0)?);
    let cell = points[top + 1][0] - points[top][0];
    let at = |offset: f64| points[top][0] + cell * offset;
    Some(Width { low: at(low), high: at(high), level_db: threshold, cells: high - low })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{Cursor, CutMap, MapKind};
    use crate::maps::{LambdaScale, RangeAngleMap};
    use ndarray::Array2;
    use std::sync::Arc;

    #[test]
    fn clicks_place_a_then_b_then_move_the_nearer() {
        let mut markers = Markers::default();
        for at in [1.0, 5.0, 4.0, 1.5] {
            markers.place(at);
        }
        assert_eq!(markers.places, [Some(1.5), Some(4.0)]);
    }

    #[test]
    fn differences_are_told_in_the_units_of_the_cut_and_in_decibels() {
        let radar = Radar::default();
        let mut lambda = Array2::zeros((radar.samples, radar.elements));
        (lambda[[100, 512]], lambda[[110, 512]], lambda[[100, 640]]) = (1.0f32, 0.5, 0.75);
        let scale = Some(LambdaScale { peak: 0.0, floor: -2.0 });
        let map = CutMap { kind: MapKind::Target, map: Arc::new(RangeAngleMap { lambda }), scale };
        let cursor = Cursor::at_cell(&radar, 100.0, 512.0);
        let told = |cut, a: f64, b: f64| {
            let trace = Trace::of(&radar, &cursor, &map, cut, None).unwrap();
            let markers = Markers { places: [Some(a), Some(b)], held: None };
            readings(cut, &radar, &trace, Units::Lambda, &markers)
        };
        let range = |bin: f64| radar.range_of_bin_metres(bin);
        let told_range = told(Cut::Range, range(100.0), range(110.0));
        assert_eq!(told_range[..2], ["A: Λ 1.000, 0.0 dB", "B: Λ 0.500, −20.0 dB"]);
        let metres = signed(10.0 * radar.range_resolution_metres(), 3);
        assert_eq!(told_range[2], format!("B − A: {metres} m = +10.0 bins, −20.0 dB"));
        assert!(told_range[3].starts_with("3 dB width at A: ") && told_range.len() == 5, "{told_range:?}");
        let told_angle = told(Cut::Angle, radar.cos_of_column(512.0), radar.cos_of_column(640.0));
        assert_eq!(told_angle[1], "B at +14.48° · cos θ +0.2500: Λ 0.750, −10.0 dB");
        assert_eq!(told_angle[2], "B − A: +14.48° = +0.2500 in cos θ = +128.0 columns, −10.0 dB");
    }

    /// A lobe that is a parabola in decibels, 3 dB down at `half` cells from `centre`.
    fn lobe(centre: f64, half: f64, count: usize) -> Vec<[f64; 2]> {
        let level = |i: usize| (-3.0 * ((i as f64 - centre) / half).powi(2)).max(-60.0);
        (0..count).map(|i| [0.5 * i as f64, level(i)]).collect()
    }

    #[test]
    fn a_gaussian_lobe_has_its_own_width_wherever_its_summit_falls() {
        for centre in [20.0, 20.3, 20.5] {
            let width = width_at(&lobe(centre, 0.72, 40), 10.4).unwrap();
            assert!((width.cells - 1.44).abs() < 1e-9, "{centre}: {width:?}");
            assert!((width.low - 0.5 * (centre - 0.72)).abs() < 1e-9 && (width.level_db + 3.0).abs() < 1e-9);
        }
        let wide = width_at(&lobe(20.0, 6.0, 40), 8.0).unwrap();
        assert!((wide.cells - 12.0).abs() < 0.1, "straight lines between far cells: {wide:?}");
    }

    #[test]
    fn there_is_no_width_without_a_peak_that_falls() {
        let flat: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), -60.0]).collect();
        assert_eq!(width_at(&flat, 4.0), None);
        let rising: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), f64::from(i)]).collect();
        assert_eq!(width_at(&rising, 2.0), None, "the end of the line is no peak");
        let shoulder: Vec<[f64; 2]> =
            [-9.0, -4.0, -5.0, 0.0, -9.0].into_iter().enumerate().map(|(i, y)| [i as f64, y]).collect();
        assert_eq!(width_at(&shoulder, 1.0), None, "it runs into a higher one");
        assert!(width_at(&shoulder, 3.0).is_some());
        assert_eq!(width_at(&[], 0.0), None);
    }

    #[test]
    fn values_are_read_only_between_cells() {
        let line = [[0.0, -10.0], [2.0, -20.0]];
        let values = [-0.1, 0.0, 1.0, 2.0, 2.1].map(|x| value_at(&line, x));
        assert_eq!(values, [None, Some(-10.0), Some(-15.0), Some(-20.0), None]);
    }
}
