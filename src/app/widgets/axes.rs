//! Axes of maps and of the scene: ticks at round numbers, labels that don't collide.

use eframe::egui;
use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};

/// Space for tick labels and an axis title.
pub const LEFT: f32 = 34.0;
pub const BOTTOM: f32 = 30.0;

/// Font of tick labels.
pub fn tick_font() -> FontId {
    FontId::proportional(10.5)
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

/// A number with as many digits as neighbouring ticks need.
pub fn tick_text(value: f64, step: f64) -> String {
    let digits = (-step.abs().log10()).ceil().clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}");
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        "0".to_owned()
    } else {
        text.replace('-', "−")
    }
}

/// An axis: the values at the two ends of a side of the plot, and its title.
#[derive(Debug, Clone, Copy)]
pub struct Axis<'a> {
    pub low: f64,
    pub high: f64,
    pub title: &'a str,
}

impl Axis<'_> {
    fn part(&self, value: f64) -> f32 {
        ((value - self.low) / (self.high - self.low)) as f32
    }
}

/// Draws a frame around `rect`, ticks and titles left of it and below it.
pub fn draw(ui: &Ui, painter: &Painter, rect: Rect, x: Axis<'_>, y: Axis<'_>) {
    let ink = ui.visuals().weak_text_color();
    let stroke = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    painter.rect_stroke(rect, 0.0, stroke, egui::StrokeKind::Outside);
    let x_ticks = ticks(x.low, x.high, rect.width() / 58.0);
    let x_step = step_of(&x_ticks);
    for value in x_ticks {
        let at = rect.left() + x.part(value) * rect.width();
        painter.vline(at, rect.bottom()..=rect.bottom() + 3.0, Stroke::new(1.0, ink));
        text(painter, pos2(at, rect.bottom() + 4.0), Align2::CENTER_TOP, &tick_text(value, x_step), ink);
    }
    let y_ticks = ticks(y.low, y.high, rect.height() / 34.0);
    let y_step = step_of(&y_ticks);
    for value in y_ticks {
        let at = rect.bottom() - y.part(value) * rect.height();
        painter.hline(rect.left() - 3.0..=rect.left(), at, Stroke::new(1.0, ink));
        text(painter, pos2(rect.left() - 5.0, at), Align2::RIGHT_CENTER, &tick_text(value, y_step), ink);
    }
    text(painter, pos2(rect.center().x, rect.bottom() + 16.0), Align2::CENTER_TOP, x.title, ink);
    if rect.height() > 60.0 {
        let galley = painter.layout_no_wrap(y.title.to_owned(), tick_font(), ink);
        let at = pos2(rect.left() - LEFT + 2.0, rect.center().y + galley.size().x / 2.0);
        let shape = egui::epaint::TextShape::new(at, galley, ink).with_angle(-std::f32::consts::FRAC_PI_2);
        painter.add(shape);
    }
}

fn step_of(ticks: &[f64]) -> f64 {
    ticks.windows(2).map(|w| w[1] - w[0]).next().unwrap_or(1.0)
}

/// Small text.
pub fn text(painter: &Painter, at: Pos2, align: Align2, text: &str, colour: Color32) -> Rect {
    painter.text(at, align, text, tick_font(), colour)
}

/// Small text on a patch that makes it readable over any picture.
pub fn text_on_patch(painter: &Painter, at: Pos2, align: Align2, text: &str) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::monospace(11.0), Color32::WHITE);
    let rect = align.anchor_size(at, galley.size()).expand2(vec2(4.0, 2.0));
    painter.rect_filled(rect, 3.0, Color32::from_black_alpha(170));
    painter.galley(rect.min + vec2(4.0, 2.0), galley, Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks(-1.0, 1.0, 4.0), [-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(ticks(1.0, -1.0, 4.0), ticks(-1.0, 1.0, 4.0));
        assert_eq!(ticks(0.0, 38.4, 4.0), [0.0, 10.0, 20.0, 30.0]);
        assert!(ticks(1.0, 1.0, 4.0).is_empty() && ticks(f64::NAN, 1.0, 4.0).is_empty());
        assert_eq!(
            (tick_text(-0.5, 0.5), tick_text(-0.0, 0.5), tick_text(20.0, 10.0)),
            ("−0.5".into(), "0".into(), "20".into())
        );
    }
}
