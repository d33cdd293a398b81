//! Axes of maps, charts and the scene, with ticks at round numbers and labels that neither collide nor leave the panel.

use super::numbers::plain;
use eframe::egui::{self, Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Ui, Vec2, pos2, vec2};

/// Space for tick labels and an axis title, points.
pub const LEFT: f32 = 46.0;
pub const BOTTOM: f32 = 36.0;

/// Space right of a map for its colour bar or its controls, points; the same beside every map.
pub const RIGHT: f32 = 62.0;

/// Gap between a side of the plot and its labels, points.
const GAP: f32 = 5.0;

pub fn tick_font() -> FontId {
    FontId::proportional(12.0)
}

/// Round numbers between `low` and `high`, about `count` of them; the order of the ends doesn't matter.
pub fn ticks(low: f64, high: f64, count: f32) -> Vec<f64> {
    let (low, high) = (low.min(high), low.max(high));
    let raw = (high - low) / f64::from(count.max(1.0));
    if !(raw.is_finite() && raw > 0.0) {
        return Vec::new();
    }
    let decade = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|s| *s >= raw * 0.999).unwrap_or(raw);
    let first = (low / step - 1e-6).ceil() as i64;
    let last = (high / step + 1e-6).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A number with as many decimals as ticks `step` apart need.
pub fn tick_text(value: f64, step: f64) -> String {
    plain(value, (-step.abs().log10() - 1e-9).ceil().clamp(0.0, 6.0) as usize)
}

/// A mark of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    pub value: f64,
    pub text: String,
}

pub fn round_ticks(low: f64, high: f64, count: f32) -> Vec<Tick> {
    let values = ticks(low, high, count);
    let step = values.windows(2).map(|w| w[1] - w[0]).next().unwrap_or(1.0);
    values.into_iter().map(|value| Tick { value, text: tick_text(value, step) }).collect()
}

/// An axis: the values at the two ends of a side of the plot, and its title.
#[derive(Debug, Clone, Copy)]
pub struct Axis<'a> {
    /// Value at the left or lower end.
    pub low: f64,
    /// Value at the right or upper end.
    pub high: f64,
    pub title: &'a str,
    /// Marks; those at round numbers where `None`.
    pub ticks: Option<&'a [Tick]>,
    /// Largest distance of a round number beyond an end that still has its mark at the end, in the axis' unit.
    pub slack: f64,
}

impl<'a> Axis<'a> {
    /// An axis with marks at round numbers.
    pub fn new(low: f64, high: f64, title: &'a str) -> Self {
        Axis { low, high, title, ticks: None, slack: 0.0 }
    }

    /// The axis with marks at its ends for round numbers up to `slack` beyond. Where the ends are the edges of cells, `slack` is half a cell.
    pub fn with_slack(self, slack: f64) -> Self {
        Axis { slack: slack.abs(), ..self }
    }

    /// Position of a value along the axis, 0 to 1.
    pub fn part(&self, value: f64) -> f32 {
        let part = ((value - self.low) / (self.high - self.low)) as f32;
        if self.slack > 0.0 { part.clamp(0.0, 1.0) } else { part }
    }

    /// Marks along `length` points to the right, as many as have room for their labels.
    pub fn across(&self, painter: &Painter, length: f32) -> Vec<Tick> {
        let room = |ticks: &[Tick]| ticks.iter().map(|t| width(painter, &t.text) + 10.0).fold(0.0, f32::max);
        self.marks(length, 60.0, room)
    }

    /// Marks along `length` points upwards.
    pub fn upwards(&self, length: f32) -> Vec<Tick> {
        self.marks(length, 36.0, |_| 18.0)
    }

    /// Marks about every `spacing` points, at least about four where each has the `room` of its label.
    fn marks(&self, length: f32, spacing: f32, room: impl Fn(&[Tick]) -> f32) -> Vec<Tick> {
        if let Some(ticks) = self.ticks {
            let inside = |t: &&Tick| (-1e-4..=1.0 + 1e-4).contains(&self.part(t.value));
            return ticks.iter().filter(inside).cloned().collect();
        }
        let most = (length / spacing).max(4.0) as usize;
        let (low, high) = (self.low.min(self.high) - self.slack, self.low.max(self.high) + self.slack);
        let of = |count: usize| round_ticks(low, high, count as f32);
        let fits = |ticks: &Vec<Tick>| ticks.len().saturating_sub(1) as f32 * room(ticks) <= length;
        (1..=most).rev().map(of).find(fits).unwrap_or_else(|| of(1))
    }
}

/// Draws a frame around `rect` with ticks and titles left of it and below it, inside the painter's clip rectangle.
pub fn draw(ui: &Ui, painter: &Painter, rect: Rect, x: Axis<'_>, y: Axis<'_>) {
    let ink = ui.visuals().weak_text_color();
    let stroke = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    painter.rect_stroke(rect, 0.0, stroke, egui::StrokeKind::Outside);
    let (mut x_marks, y_marks) = (x.across(painter, rect.width()), y.upwards(rect.height()));
    x_marks.sort_by(|a, b| x.part(a.value).total_cmp(&x.part(b.value)));
    let mut free = f32::NEG_INFINITY;
    for tick in &x_marks {
        let at = rect.left() + x.part(tick.value) * rect.width();
        painter.vline(at, rect.bottom()..=rect.bottom() + 3.0, Stroke::new(1.0, ink));
        let label = place(painter, pos2(at, rect.bottom() + 3.0), Align2::CENTER_TOP, &tick.text);
        if label.left() > free {
            text(painter, label.min, Align2::LEFT_TOP, &tick.text, ink);
            free = label.right() + 4.0;
        }
    }
    for tick in &y_marks {
        let at = rect.bottom() - y.part(tick.value) * rect.height();
        painter.hline(rect.left() - 3.0..=rect.left(), at, Stroke::new(1.0, ink));
        let label = place(painter, pos2(rect.left() - GAP, at), Align2::RIGHT_CENTER, &tick.text);
        // The lowest label must not overlap that of the other axis.
        let label = label.translate(vec2(0.0, (rect.bottom() + 2.0 - label.bottom()).min(0.0)));
        text(painter, label.min, Align2::LEFT_TOP, &tick.text, ink);
    }
    let title = place(painter, pos2(rect.center().x, rect.bottom() + 18.0), Align2::CENTER_TOP, x.title);
    text(painter, title.min, Align2::LEFT_TOP, x.title, ink);
    let galley = painter.layout_no_wrap(y.title.to_owned(), tick_font(), ink);
    let labels = y_marks.iter().map(|t| width(painter, &t.text)).fold(0.0, f32::max);
    let left = |wide: f32| (rect.left() - GAP - labels - 3.0 - wide).max(painter.clip_rect().left() + 1.0);
    let Vec2 { x: long, y: high } = galley.size();
    if y.title.chars().count() == 1 {
        // A single letter on its side would look like another letter.
        painter.galley(pos2(left(long), rect.center().y - high / 2.0), galley, ink);
    } else if long <= rect.height() {
        let at = pos2(left(high), rect.center().y + long / 2.0);
        painter.add(egui::epaint::TextShape::new(at, galley, ink).with_angle(-std::f32::consts::FRAC_PI_2));
    }
}

/// Width of small text, points.
pub fn width(painter: &Painter, text: &str) -> f32 {
    painter.layout_no_wrap(text.to_owned(), tick_font(), Color32::PLACEHOLDER).size().x
}

/// The first title that fits `room` points; the last where none fits.
pub fn fitting<'a>(painter: &Painter, room: f32, titles: &[&'a str]) -> &'a str {
    let fits = titles.iter().find(|title| width(painter, title) <= room);
    fits.or(titles.last()).copied().unwrap_or_default()
}

/// Rectangle of small text, moved so that it is not cut off.
fn place(painter: &Painter, at: Pos2, align: Align2, text: &str) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), tick_font(), Color32::PLACEHOLDER);
    let (rect, room) = (align.anchor_size(at, galley.size()), painter.clip_rect().shrink(1.0));
    let back = |low: f32, high: f32, from: f32, to: f32| (from - low).max(0.0) + (to - high).min(0.0);
    rect.translate(vec2(back(rect.left(), rect.right(), room.left(), room.right()), 0.0))
}

pub fn text(painter: &Painter, at: Pos2, align: Align2, text: &str, colour: Color32) -> Rect {
    painter.text(at, align, text, tick_font(), colour)
}

/// Draws small text on a dark patch, which makes it readable over any picture.
pub fn text_on_patch(painter: &Painter, at: Pos2, align: Align2, text: &str) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::monospace(12.0), Color32::WHITE);
    let rect = align.anchor_size(at, galley.size()).expand2(vec2(4.0, 2.0));
    painter.rect_filled(rect, 3.0, Color32::from_black_alpha(170));
    painter.galley(rect.min + vec2(4.0, 2.0), galley, Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_with_the_same_digits() {
        assert_eq!(ticks(-1.0, 1.0, 4.0), [-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(ticks(1.0, -1.0, 4.0), ticks(-1.0, 1.0, 4.0));
        assert_eq!(ticks(0.0, 38.4, 4.0), [0.0, 10.0, 20.0, 30.0]);
        assert!(ticks(1.0, 1.0, 4.0).is_empty() && ticks(f64::NAN, 1.0, 4.0).is_empty());
        let texts = |low, high| round_ticks(low, high, 4.0).into_iter().map(|t| t.text).collect::<Vec<_>>();
        assert_eq!(texts(-1.0, 1.0), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(texts(0.0, 38.4), ["0", "10", "20", "30"]);
        assert_eq!(texts(-0.1, 0.1), ["−0.10", "−0.05", "0.00", "0.05", "0.10"]);
        assert_eq!(tick_text(-0.0, 0.5), "0.0");
    }

    #[test]
    fn a_round_number_just_beyond_the_end_is_marked_at_the_end() {
        let axis = Axis::new(-1.001, 0.999, "cos θ").with_slack(0.001);
        let last = axis.upwards(200.0).pop().unwrap();
        assert_eq!((last.text.as_str(), axis.part(last.value)), ("1.0", 1.0));
        assert_eq!(Axis { slack: 0.0, ..axis }.upwards(200.0).pop().unwrap().text, "0.5");
    }
}
