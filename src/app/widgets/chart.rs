//! Charts of egui_plot, with the axes and the font of the maps.

use super::axes::{self, Axis, Tick};
use super::nudge::{pan_keys, zoom_keys};
use eframe::egui::{
    self, Color32, Painter, Pos2, Rect, Response, RichText, Sense, Stroke, TextureId, Ui, UiBuilder, vec2,
};
use egui_plot::{
    AxisHints, GridInput, GridMark, Line, LineStyle, Plot, PlotImage, PlotItem, PlotPoint, PlotPoints, PlotTransform,
    Points, VLine,
};

/// Margins above a chart, and at its right where no label needs more, points.
const MARGINS_POINTS: [f32; 2] = [8.0, 12.0];

/// Space left of a vertical axis' title, and width of the title itself, points.
const TITLE_ROOM_POINTS: [f32; 2] = [4.0, 20.0];

/// A chart before it is drawn.
pub struct Chart<'a> {
    name: &'a str,
    x: Axis<'a>,
    y: Axis<'a>,
    has_one_scale: bool,
    has_grid: bool,
    is_zoomable: bool,
    items: Vec<Box<dyn PlotItem>>,
}

/// A drawn chart, for reading values off and drawing over.
pub struct Drawn {
    /// Rectangle of its lines.
    pub rect: Rect,
    /// The pointer's response on it.
    pub response: Response,
    transform: PlotTransform,
    pub painter: Painter,
}

impl<'a> Chart<'a> {
    /// A chart with a name for screen readers, without lines.
    pub fn new(name: &'a str, x: Axis<'a>, y: Axis<'a>) -> Self {
        Chart { name, x, y, has_one_scale: false, has_grid: true, is_zoomable: false, items: Vec::new() }
    }

    /// The chart with one scale for both axes; one of them then covers more than its range.
    pub fn with_one_scale(self) -> Self {
        Chart { has_one_scale: true, ..self }
    }

    /// The chart with zoom: a drag pans, a pinch or Ctrl and the wheel zooms, a double click shows all again.
    pub fn with_zoom(self) -> Self {
        Chart { is_zoomable: true, ..self }
    }

    /// Adds an item of egui_plot over the earlier ones.
    pub fn add(&mut self, item: impl PlotItem + 'static) {
        self.items.push(Box::new(item));
    }

    /// Adds a line from point to point. Points far outside are moved to just outside: a dashed line millions of points long would have as many dashes.
    pub fn line(&mut self, points: impl IntoIterator<Item = [f64; 2]>, stroke: Stroke, style: LineStyle) {
        let within = |v: f64, axis: &Axis<'_>| v.min(2.0 * axis.high - axis.low).max(2.0 * axis.low - axis.high);
        let points = points.into_iter().filter(|p| !(p[0].is_nan() || p[1].is_nan()));
        let points: PlotPoints<'static> = points.map(|[x, y]| [within(x, &self.x), within(y, &self.y)]).collect();
        self.add(Line::new("", points).stroke(stroke).style(style));
    }

    /// Adds a line from bottom to top.
    pub fn upright(&mut self, x: f64, stroke: Stroke) {
        self.add(VLine::new("", x).stroke(stroke));
    }

    pub fn dot(&mut self, at: [f64; 2], radius: f32, colour: Color32) {
        self.add(Points::new("", vec![at]).radius(radius).color(colour));
    }

    /// Adds a picture between two corners, without a grid over it.
    pub fn image(&mut self, texture: TextureId, [left, bottom]: [f64; 2], [right, top]: [f64; 2]) {
        self.has_grid = false;
        let middle = PlotPoint::new((left + right) / 2.0, (bottom + top) / 2.0);
        self.add(PlotImage::new("", texture, middle, [(right - left) as f32, (top - bottom) as f32]));
    }

    pub fn show(mut self, ui: &mut Ui, area: Rect, sense: Sense) -> Drawn {
        let (left, right) = self.beside(ui.painter(), area);
        let Chart { name, x, y, has_one_scale, has_grid, is_zoomable, items } = self;
        let painter = ui.painter().clone();
        let rect =
            Rect::from_min_max(area.min + vec2(TITLE_ROOM_POINTS[0], MARGINS_POINTS[0]), area.max - vec2(right, 0.0));
        let mut inside = ui.new_child(UiBuilder::new().id_salt(name).max_rect(rect));
        let mut plot = Plot::new(name)
            .custom_x_axes(vec![hints(ui, AxisHints::new_x(), x).min_thickness(axes::BOTTOM)])
            .custom_y_axes(vec![hints(ui, AxisHints::new_y(), y).min_thickness(left)])
            .x_grid_spacer(move |input| marks(x, input, |axis, length| axis.across(&painter, length)))
            .y_grid_spacer(move |input| marks(y, input, |axis, length| axis.upwards(length)))
            .grid_spacing(1.0..=2.0)
            .show_grid(has_grid)
            .grid_color(ui.visuals().widgets.noninteractive.bg_stroke.color.gamma_multiply(0.6))
            .allow_zoom(is_zoomable)
            .allow_drag(is_zoomable)
            .allow_double_click_reset(is_zoomable)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_axis_zoom_drag(false)
            .set_margin_fraction(egui::Vec2::ZERO)
            .min_size(vec2(20.0, 20.0))
            .show_x(false)
            .show_y(false)
            .sense(sense);
        if has_one_scale {
            plot = plot.data_aspect(1.0);
        }
        for (x, y) in [(x.low, y.low), (x.high, y.high)] {
            plot = plot.include_x(x).include_y(y);
        }
        let shown = plot.show(&mut inside, move |plot| {
            if !is_zoomable {
                plot.set_plot_bounds_x(x.low..=x.high);
                plot.set_plot_bounds_y(y.low..=y.high);
            }
            items.into_iter().for_each(|item| plot.add_item(item));
        });
        let (response, transform) = (shown.response, shown.transform);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name));
        let rect = *transform.frame();
        let painter = ui.painter().with_clip_rect(rect.expand(1.0).intersect(ui.clip_rect()));
        Drawn { rect, response, transform, painter }
    }

    /// Widths of labels and titles left and right of the chart. Removes a title without room. Starts below the lowest label where it would overlap one of the
    /// other axis.
    fn beside(&mut self, painter: &Painter, area: Rect) -> (f32, f32) {
        let Chart { x, y, .. } = self;
        let height = (area.height() - MARGINS_POINTS[0] - axes::BOTTOM).max(20.0);
        if axes::width(painter, y.title) > height {
            y.title = "";
        }
        let y_marks = y.upwards(height);
        let labels = y_marks.iter().map(|t| axes::width(painter, &t.text)).fold(0.0, f32::max);
        let left = labels + 8.0 + if y.title.is_empty() { 0.0 } else { TITLE_ROOM_POINTS[1] };
        let width = (area.width() - TITLE_ROOM_POINTS[0] - left - MARGINS_POINTS[1]).max(20.0);
        let x_marks = x.across(painter, width);
        // Length of half a label beyond `room`, points.
        let beyond = |t: &Tick, room: f32| axes::width(painter, &t.text) / 2.0 - room;
        let right =
            x_marks.last().map_or(0.0, |t| beyond(t, (1.0 - x.part(t.value)) * width) + 1.0).max(MARGINS_POINTS[1]);
        let is_crowded = x_marks.first().is_some_and(|t| beyond(t, x.part(t.value) * width) > 2.0);
        if is_crowded && y_marks.first().is_some_and(|t| y.part(t.value) * height < 8.0) {
            y.low -= f64::from(8.0 / height) * (y.high - y.low);
        }
        (left, right)
    }
}

fn hints<'a>(ui: &Ui, hints: AxisHints<'a>, axis: Axis<'a>) -> AxisHints<'a> {
    let ink = ui.visuals().weak_text_color();
    let text = move |mark: GridMark, _: &_| match axis.ticks {
        None => axes::tick_text(mark.value, mark.step_size),
        Some(ticks) => ticks.iter().find(|t| t.value == mark.value).map_or_else(String::new, |t| t.text.clone()),
    };
    let hints = hints.label(RichText::new(axis.title).font(axes::tick_font()).color(ink)).formatter(text);
    hints.label_spacing(0.0..=1.0).tick_label_color(ink).tick_label_font(axes::tick_font())
}

/// The marks of an axis in its visible part.
fn marks(axis: Axis<'_>, input: GridInput, of: impl Fn(Axis<'_>, f32) -> Vec<Tick>) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    let ticks = of(Axis { low, high, ..axis }, ((high - low) / input.base_step_size) as f32);
    let step_size = ticks.windows(2).map(|w| w[1].value - w[0].value).fold(high - low, f64::min);
    ticks.into_iter().map(|tick| GridMark { value: tick.value, step_size }).collect()
}

impl Drawn {
    /// The place on screen of a point of the chart.
    pub fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        self.transform.position_from_point(&PlotPoint::new(x, y))
    }

    pub fn x_at(&self, at: Pos2) -> f64 {
        self.transform.value_from_position(at).x
    }

    /// Shows a text at the pointer, made of the values there.
    pub fn tell(self, what: impl FnOnce([f64; 2]) -> Option<String>) {
        let at = self.response.hover_pos().map(|pos| self.transform.value_from_position(pos));
        if let Some(told) = at.and_then(|at| what([at.x, at.y])) {
            self.response.on_hover_text_at_pointer(told);
        }
    }
}

/// The visible part of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    pub low: f64,
    pub high: f64,
}

impl Span {
    /// The span after the wheel, pinch and drag over a chart, and arrow keys, `+` and `-` with the focus; a double click gives `whole`.
    pub fn navigate(self, ui: &Ui, drawn: &Drawn, whole: Span, may_drag: bool) -> Span {
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

    /// The value in the span that is nearest to `x`; the lower end of an empty span.
    pub fn nearest(self, x: f64) -> f64 {
        x.min(self.high).max(self.low)
    }

    fn within(self, whole: Span) -> Span {
        // A chart without cells has an empty span.
        let all = (whole.high - whole.low).max(0.0);
        let size = (self.high - self.low).clamp(1e-3 * all, all);
        let low = self.low.clamp(whole.low, whole.low + (all - size));
        Span { low, high: low + size }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness};

    #[test]
    fn a_span_stays_within_the_whole() {
        let whole = Span { low: -1.0, high: 1.0 };
        assert_eq!(Span { low: -3.0, high: 9.0 }.within(whole), whole);
        assert_eq!(Span { low: 0.75, high: 1.25 }.within(whole), Span { low: 0.5, high: 1.0 });
    }

    #[test]
    fn labels_of_a_small_chart_are_readable() {
        let ticks = [(-5.0, "≤0.001 %"), (-2.0, "1 %"), (0.0, "100 %")];
        let ticks = ticks.map(|(value, text)| axes::Tick { value, text: text.to_owned() });
        for size in [[220.0, 130.0], [500.0, 300.0]] {
            let ticks = ticks.clone();
            let chart = Harness::builder().with_size(size).build_ui(move |ui| {
                let x = Axis { ticks: Some(&ticks), ..Axis::new(-5.0, 0.0, "P_FA") };
                let y = Axis::new(0.0, 100.0, "P_D, %");
                let area = ui.available_rect_before_wrap();
                Chart::new("roc", x, y).show(ui, area, Sense::hover());
            });
            seen::assert_reads(chart.output(), &["≤0.001 %", "100 %", "0", "100"]);
            seen::assert_readable(chart.output());
        }
    }

    #[test]
    fn a_dashed_line_that_leads_far_away_takes_few_dashes() {
        let chart = Harness::builder().with_size([300.0, 200.0]).build_ui(|ui| {
            let (x, y) = (Axis::new(0.0, 1.0, "x"), Axis::new(-1.0, 0.0, "dB"));
            let area = ui.available_rect_before_wrap();
            let mut chart = Chart::new("far", x, y);
            let points = [[0.0, 0.0], [0.3, -1e7], [0.6, f64::NAN], [1.0, -0.5]];
            chart.line(points, Stroke::new(1.0, Color32::WHITE), LineStyle::dashed_dense());
            chart.show(ui, area, Sense::hover());
        });
        assert!(chart.output().shapes.len() < 1000, "{} shapes", chart.output().shapes.len());
    }
}
