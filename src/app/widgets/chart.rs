//! Charts of lines, drawn as the maps are: the same axes, the same font, nothing over the data.

use super::axes::{self, Axis};
use super::nudge::{pan_keys, zoom_keys};
use eframe::egui;
use eframe::egui::{Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2};

/// What is drawn around the lines.
pub struct Chart<'a> {
    /// Name for screen readers.
    pub name: &'a str,
    /// To the right.
    pub x: Axis<'a>,
    /// Upwards.
    pub y: Axis<'a>,
}

/// A chart on screen, to draw into.
pub struct Drawn<'a> {
    /// Where its lines are.
    pub rect: Rect,
    /// What the pointer does there.
    pub response: Response,
    x: Axis<'a>,
    y: Axis<'a>,
    painter: Painter,
}

/// Strokes of a line and the gaps between them, points; no gaps where `None`.
pub type Dash = Option<[f32; 2]>;

impl<'a> Chart<'a> {
    /// Draws frame, grid and axes into `area`.
    pub fn show(self, ui: &mut Ui, area: Rect, sense: Sense) -> Drawn<'a> {
        let Chart { name, x, y } = self;
        let rect = inner(ui.painter(), area, y);
        let response = ui.interact(rect, ui.scope_id().with(name), sense);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name));
        let painter = ui.painter().with_clip_rect(area);
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        let grid = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color.gamma_multiply(0.6));
        let (x_marks, y_marks) = axes::marks_of(&painter, rect, x, y);
        for tick in x_marks {
            painter.vline(rect.left() + x.part(tick.value) * rect.width(), rect.y_range(), grid);
        }
        for tick in y_marks {
            painter.hline(rect.x_range(), rect.bottom() - y.part(tick.value) * rect.height(), grid);
        }
        axes::draw(ui, &painter, rect, x, y);
        Drawn { rect, response, x, y, painter: ui.painter().with_clip_rect(rect.expand(1.0)) }
    }
}

/// Where the lines go: what labels and titles leave of `area`.
pub fn inner(painter: &Painter, area: Rect, y: Axis<'_>) -> Rect {
    let height = (area.height() - 8.0 - axes::BOTTOM).max(20.0);
    let marks = y.upwards(height);
    let labels = marks.iter().map(|t| axes::width(painter, &t.text)).fold(0.0, f32::max);
    let left = (labels + 26.0).min(area.width() / 2.0);
    Rect::from_min_size(area.min + vec2(left, 8.0), vec2((area.width() - left - 12.0).max(20.0), height))
}

impl Drawn<'_> {
    /// Where a point is.
    pub fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        let Rect { min, max } = self.rect;
        pos2(min.x + self.x.part(x) * (max.x - min.x), max.y - self.y.part(y) * (max.y - min.y))
    }

    /// The x of a place.
    pub fn x_at(&self, at: Pos2) -> f64 {
        self.x.at((at.x - self.rect.left()) / self.rect.width())
    }

    /// The y of a place.
    pub fn y_at(&self, at: Pos2) -> f64 {
        self.y.at((self.rect.bottom() - at.y) / self.rect.height())
    }

    /// A line from point to point. Points far outside are drawn just outside: a dashed line that leads away by millions of points would be
    /// made of as many dashes.
    pub fn line(&self, points: impl IntoIterator<Item = [f64; 2]>, stroke: Stroke, dash: Dash) {
        let around = self.rect.expand2(self.rect.size());
        let points = points.into_iter().map(|p| self.at(p)).filter(|p| !p.any_nan());
        let points: Vec<Pos2> = points.map(|p| p.clamp(around.min, around.max)).collect();
        match dash {
            None => _ = self.painter.add(Shape::line(points, stroke)),
            Some([long, gap]) => self.painter.extend(Shape::dashed_line(&points, stroke, long, gap)),
        }
    }

    /// A line from bottom to top.
    pub fn upright(&self, x: f64, stroke: Stroke) {
        self.painter.vline(self.at([x, 0.0]).x, self.rect.y_range(), stroke);
    }

    /// A dot.
    pub fn dot(&self, at: [f64; 2], radius: f32, colour: Color32) {
        self.painter.circle_filled(self.at(at), radius, colour);
    }

    /// What else is drawn over the lines, cut off at the frame.
    pub fn painter(&self) -> &Painter {
        &self.painter
    }
}

/// The part of an axis that is in sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

impl Span {
    /// Follows wheel, pinch and drag over a chart, and arrow keys, `+` and `-` in one that has the focus; a double click shows `whole` again.
    pub fn navigate(self, ui: &Ui, drawn: &Drawn<'_>, whole: Span, may_drag: bool) -> Span {
        if drawn.response.double_clicked() {
            return whole;
        }
        let Span { mut low, mut high } = self;
        if let Some(pos) = drawn.response.hover_pos() {
            let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
            let factor = f64::from(pinch * (scroll / 200.0).exp());
            let fixed = drawn.x_at(pos);
            (low, high) = (fixed - (fixed - low) / factor, fixed + (high - fixed) / factor);
        }
        if let Some(factor) = zoom_keys(&drawn.response) {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low) / f64::from(factor));
            (low, high) = (middle - half, middle + half);
        }
        if let Some(by) = pan_keys(&drawn.response, true) {
            let by = f64::from(by.x) * (high - low);
            (low, high) = (low + by, high + by);
        }
        if may_drag && drawn.response.dragged() {
            let by = f64::from(drawn.response.drag_delta().x / drawn.rect.width()) * (high - low);
            (low, high) = (low - by, high - by);
        }
        Span { low, high }.within(whole)
    }

    /// The place in the span that is nearest to `x`; where nothing is spanned, its beginning.
    pub fn nearest(self, x: f64) -> f64 {
        x.min(self.high).max(self.low)
    }

    fn within(self, whole: Span) -> Span {
        // What has no cells yet spans nothing.
        let all = (whole.high - whole.low).max(0.0);
        let size = (self.high - self.low).clamp(1e-3 * all, all);
        let low = self.low.clamp(whole.low, whole.low + (all - size));
        Span { low, high: low + size }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use egui_kittest::Harness;

    #[test]
    fn a_span_stays_within_the_whole() {
        let whole = Span { low: -1.0, high: 1.0 };
        assert_eq!(Span { low: -3.0, high: 9.0 }.within(whole), whole);
        assert_eq!(Span { low: 0.75, high: 1.25 }.within(whole), Span { low: 0.5, high: 1.0 });
    }

    #[test]
    fn labels_of_a_small_chart_are_readable() {
        let ticks = ["≤0.001 %", "1 %", "100 %"];
        let ticks: Vec<_> = ticks
            .into_iter()
            .zip([-5.0, -2.0, 0.0])
            .map(|(t, value)| axes::Tick { value, text: t.to_owned() })
            .collect();
        for size in [[220.0, 130.0], [500.0, 300.0]] {
            let ticks = ticks.clone();
            let chart = Harness::builder().with_size(size).build_ui(move |ui| {
                let x = Axis { ticks: Some(&ticks), ..Axis::new(-5.0, 0.0, "P_FA") };
                let y = Axis::new(0.0, 100.0, "P_D, %");
                let area = ui.available_rect_before_wrap();
                Chart { name: "roc", x, y }.show(ui, area, Sense::hover());
            });
            let texts = seen::texts(chart.output());
            assert!(["≤0.001 %", "100 %", "0", "100"].iter().all(|t| texts.iter().any(|s| s.text == *t)), "{texts:?}");
            seen::assert_readable(chart.output());
        }
    }

    #[test]
    fn a_dashed_line_that_leads_far_away_takes_few_dashes() {
        let chart = Harness::builder().with_size([300.0, 200.0]).build_ui(|ui| {
            let (x, y) = (Axis::new(0.0, 1.0, "x"), Axis::new(-1.0, 0.0, "dB"));
            let area = ui.available_rect_before_wrap();
            let drawn = Chart { name: "far", x, y }.show(ui, area, Sense::hover());
            let points = [[0.0, 0.0], [0.3, -1e7], [0.6, f64::NAN], [1.0, -0.5]];
            drawn.line(points, Stroke::new(1.0, Color32::WHITE), Some([6.0, 4.0]));
        });
        assert!(chart.output().shapes.len() < 1000, "{} shapes", chart.output().shapes.len());
    }
}
