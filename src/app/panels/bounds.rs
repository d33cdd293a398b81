//! The bounds panel: the ambiguity function around a reflector, and the Cramer-Rao bound of its position.

use crate::app::content::Content;
use crate::app::jobs::{BoundsRequest, BoundsResult};
use crate::app::state::{BoundsSettings, Command, Elements, State, ViewCommand};
use crate::app::widgets::{
    Axis, Bar, Chart, Computed, Inks, MARK, NumberField, Texture, axes, choice, colour_table, computed, cross,
    direction, edged, labelled, padded, significant, warning,
};
use crate::bounds::PositionBound;
use crate::picture::ColourMap;
use crate::radar::{Layout, Radar};
use eframe::egui::{Grid, Sense, Stroke, TextureId, TextureOptions, Ui, Vec2, vec2};
use egui_plot::LineStyle;
use std::f64::consts::TAU;

/// Remembers texture of the ambiguity function.
pub const PANEL: Content<Texture, BoundsRequest> = Content {
    tells_answers: true,
    ..Content::computed(|state, _| BoundsRequest::of(state), |ui, cx| show(ui, cx.state, cx.value, cx.memory))
};

pub fn show(ui: &mut Ui, state: &State, result: Computed<'_, BoundsResult>, texture: &mut Texture) -> Vec<Command> {
    if BoundsRequest::of(state).is_none() {
        ui.centered_and_justified(|ui| ui.weak("Place a reflector ahead of the array to see its bounds."));
        return Vec::new();
    }
    padded(ui, |ui, asked| {
        let mut settings = state.settings.bounds;
        choices(ui, &mut settings, state.radar().elements);
        if settings != state.settings.bounds {
            asked.push(ViewCommand::SetBounds(settings).into());
        }
        let Some(result) = computed(ui, result) else { return };
        let texture = texture.of(ui.ctx(), "ambiguity", &result.image, TextureOptions::LINEAR);
        strip(ui, &result.request.radar, &result.layout);
        let size = ui.available_size();
        if size.x > 1.5 * size.y {
            ui.horizontal(|ui| {
                ui.allocate_ui(vec2(0.58 * size.x, size.y), |ui| picture(ui, result, texture));
                ui.vertical(|ui| bound(ui, result));
            });
        } else {
            ui.allocate_ui(vec2(size.x, 0.44 * size.y), |ui| picture(ui, result, texture));
            bound(ui, result);
        }
    })
}

fn choices(ui: &mut Ui, settings: &mut BoundsSettings, most: usize) {
    ui.horizontal_wrapped(|ui| {
        let count = if let Elements::Random(count) = settings.elements { count } else { 24 };
        let offered = [Elements::TwoEnds, Elements::OneEnd, Elements::Random(count), Elements::Mimo, Elements::All];
        choice(ui, "Seen by", "Which elements listen", &mut settings.elements, offered, |e| (e.name().to_owned(), ""));
        if let Elements::Random(count) = &mut settings.elements {
            ui.add(NumberField::new(count).range(2..=most).suffix(" of them")).on_hover_text("How many elements");
            labelled(ui, "seed", "", NumberField::new(&mut settings.seed).speed(0.05));
        }
        let snr = NumberField::new(&mut settings.snr.0).range(-40.0..=120.0).speed(0.5).suffix(" dB");
        labelled(ui, "SNR", "Of one sample, averaged over the elements", snr);
        let columns = NumberField::new(&mut settings.columns).range(1.0..=512.0).speed(0.2).suffix(" columns");
        let columns = labelled(ui, "±", "Width of the picture around the reflector", columns);
        let bins = NumberField::new(&mut settings.bins).range(0.5..=64.0).speed(0.1).suffix(" bins");
        ui.add(bins).labelled_by(columns.id);
    });
}

fn strip(ui: &mut Ui, radar: &Radar, layout: &Layout) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), Sense::hover());
    let half = radar.aperture_metres() / 2.0;
    let inner = rect.shrink2(vec2(8.0, 0.0));
    let at = |x: f64| inner.center().x + (x / half) as f32 * inner.width() / 2.0;
    let ink = ui.visuals().weak_text_color();
    ui.painter().hline(inner.x_range(), rect.center().y, Stroke::new(1.0, ink));
    let colour = Inks::of(ui.visuals()).selected;
    for x in &layout.x_metres {
        ui.painter().vline(at(*x), rect.center().y - 5.0..=rect.center().y + 5.0, Stroke::new(1.0, colour));
    }
    response.on_hover_text(format!("{} elements of an aperture of {:.2} m", layout.len(), radar.aperture_metres()));
}

/// Draws the ambiguity function over columns and metres from the reflector, with its colour bar.
fn picture(ui: &mut Ui, result: &BoundsResult, texture: TextureId) {
    let BoundsRequest { radar, settings: BoundsSettings { columns, bins, .. }, .. } = &result.request;
    let half = [*columns, bins * radar.range_resolution_metres()];
    let area = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(area);
    let bar = Bar::new(colour_table(ColourMap::Viridis), 0.0, 1.0, "likeness");
    let x = Axis::new(-half[0], half[0], "cos θ off, columns");
    let mut chart = Chart::new("Ambiguity function", x, Axis::new(-half[1], half[1], "range off, m"));
    chart.image(texture, half.map(|half| -half), half);
    let map = area.with_max_x(area.right() - axes::RIGHT + 12.0);
    let drawn = chart.show(ui, map, Sense::hover());
    let middle = drawn.at([0.0, 0.0]);
    edged([3.0, 1.4], MARK, |stroke| cross(&drawn.painter, middle, Vec2::splat(5.0), stroke));
    bar.draw(ui, &ui.painter().with_clip_rect(area), drawn.rect);
    drawn.tell(|[columns, metres]| Some(likeness_at(result, half, columns, metres)));
}

/// Text of direction, range and likeness at a place, in columns and metres from the reflector.
fn likeness_at(result: &BoundsResult, half: [f64; 2], columns: f64, metres: f64) -> String {
    let cell = |v: f64, half: f64, count: usize| {
        let part = (v + half) / (2.0 * half) * (count - 1) as f64;
        (part > -0.5 && part < count as f64 - 0.5).then(|| part.round() as usize)
    };
    let likeness = &result.ambiguity.likeness;
    let (rows, across) = likeness.dim();
    let value = cell(metres, half[1], rows).zip(cell(columns, half[0], across)).and_then(|at| likeness.get(at));
    let column = 2.0 / result.request.radar.elements as f64;
    let (cos, range) = (result.centre.cos_theta + columns * column, result.centre.range_metres + metres);
    let value = value.filter(|v| v.is_finite()).map_or_else(String::new, |v| format!("\nlikeness {v:.3}"));
    format!("{}\nrange {range:.3} m{value}", direction(cos, 2))
}

fn bound(ui: &mut Ui, result: &BoundsResult) {
    let name = &result.request.name;
    let bound = match &result.bound {
        Ok(bound) => bound,
        Err(error) => return warning(ui, Some(&error.to_string())),
    };
    let column = 2.0 / result.request.radar.elements as f64;
    ui.strong(format!("Least error for {name}")).on_hover_text(
        "The Cramér–Rao bound: no unbiased estimator has smaller standard deviations. One that knows scenes beforehand may.",
    );
    numbers(ui, bound, result.gain_per_end.as_ref(), column);
    ellipse(ui, bound);
}

/// Least width that has room for both bounds, points.
const BOTH: f32 = 250.0;

/// Draws the standard deviations of both bounds side by side; in a narrow panel those of the second are tooltips.
fn numbers(ui: &mut Ui, bound: &PositionBound, per_end: Option<&PositionBound>, column_cos: f64) {
    let rows = |b: &PositionBound| {
        [
            ("x", millimetres(b.x_metres)),
            ("y", millimetres(b.y_metres)),
            ("range", millimetres(b.range_metres)),
            ("column", significant(b.cos_theta / column_cos)),
            ("amplitude", format!("{} dB", significant(b.amplitude_db()))),
        ]
    };
    let both = ui.available_width() > BOTH;
    let second = per_end.map_or_else(|| std::array::from_fn(|_| "–".to_owned()), |b| rows(b).map(|r| r.1));
    let (columns, gap) = if both { (3, 3.0) } else { (2, 1.0) };
    let grid = Grid::new("bound").num_columns(columns).spacing([12.0, gap]);
    grid.show(ui, |ui| {
        if both {
            ui.weak("σ of");
            ui.weak("one gain").on_hover_text(
                "All elements hear the reflector with one unknown gain: the phase between the ends is known",
            );
            ui.weak("a gain an end").on_hover_text(GAIN_PER_END_TOOLTIP);
            ui.end_row();
        }
        for ((what, value), second) in rows(bound).into_iter().zip(second) {
            ui.weak(if both { what.to_owned() } else { format!("σ of {what}") });
            let shown = ui.monospace(value);
            match both {
                true => _ = ui.monospace(second),
                false => _ = shown.on_hover_text(format!("{second} with a gain an end. {GAIN_PER_END_TOOLTIP}.")),
            }
            ui.end_row();
        }
    });
}

const GAIN_PER_END_TOOLTIP: &str =
    "Either half of the elements has an unknown gain of its own: the phase between the ends is not known";

fn millimetres(metres: f64) -> String {
    if metres.is_finite() { format!("{} mm", significant(metres * 1e3)) } else { "∞".to_owned() }
}

/// Draws the ellipse of one standard deviation, which holds 39 % of the estimates of the best unbiased estimator.
fn ellipse(ui: &mut Ui, bound: &PositionBound) {
    let Some(outline) = outline(bound) else { return };
    let area = ui.available_rect_before_wrap();
    if area.height() < 110.0 {
        return;
    }
    let colour = Inks::of(ui.visuals()).selected;
    let most = |i: usize| outline.iter().map(|p| 1.2 * p[i].abs()).fold(0.0, f64::max);
    let axis = |i: usize, title| Axis::new(-most(i), most(i), title);
    let (x, y) = (axis(0, "error of x, mm"), axis(1, "error of y, mm"));
    let mut chart = Chart::new("Ellipse of one standard deviation", x, y).with_one_scale();
    chart.line(outline, Stroke::new(1.8, colour), LineStyle::Solid);
    chart.dot([0.0, 0.0], 2.5, colour);
    let drawn = chart.show(ui, area, Sense::hover());
    drawn.response.on_hover_text("39 % of the estimates of the best unbiased estimator lie within");
}

/// Points of the ellipse in millimetres: a circle through the Cholesky factor of the covariance.
fn outline(bound: &PositionBound) -> Option<Vec<[f64; 2]>> {
    let (x, y) = (bound.x_metres * 1e3, bound.y_metres * 1e3);
    if !(x > 0.0 && y.is_finite()) {
        return None;
    }
    let slanted = bound.xy_covariance_metres2 * 1e6 / x;
    let upright = (y * y - slanted * slanted).max(0.0).sqrt();
    let at = |i: i32| {
        let (sin, cos) = (TAU * f64::from(i) / 96.0).sin_cos();
        [x * cos, slanted * cos + upright * sin]
    };
    Some((0..=96).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::jobs::Query;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};
    use crate::scene::Scene;
    use crate::task::Task;

    fn panel(size: [f32; 2]) -> Harness<'static, (Texture, Vec<Command>)> {
        let state = State::of(Radar { elements: 64, samples: 32, ..Radar::default() }, Scene::of_points([(1.5, 9.0)]));
        let result = BoundsRequest::of(&state).and_then(|request| request.compute(&mut (), &Task::default()).ok());
        let draw = move |ui: &mut Ui, memory: &mut Texture| show(ui, &state, result.as_ref().map(Ok), memory);
        seen::asking_with(size, Texture::default(), draw)
    }

    #[test]
    fn another_choice_of_elements_is_asked_for() {
        let mut bounds = panel([500.0, 400.0]);
        bounds.clicks(&["Seen by", "the whole array"]);
        let all = BoundsSettings { elements: Elements::All, ..BoundsSettings::default() };
        assert_eq!(bounds.state().1, [Command::View(ViewCommand::SetBounds(all))]);
    }

    #[test]
    fn the_ellipse_has_one_scale_for_both_axes() {
        for size in [[460.0, 640.0], [1400.0, 800.0]] {
            let bounds = panel(size);
            seen::assert_readable(bounds.output());
            let texts = seen::texts(bounds.output());
            seen::assert_reads(bounds.output(), &["error of x, mm", "error of y, mm"]);
            let ellipse = bounds.get_by_label("Ellipse of one standard deviation").rect();
            let numbers = texts.iter().filter(|t| ellipse.expand(60.0).contains_rect(t.rect));
            let number = |t: &seen::Seen| t.text.replace('−', "-").parse::<f64>().ok();
            let upwards = numbers.clone().filter(|t| t.rect.right() < ellipse.left());
            let across = numbers.filter(|t| t.rect.top() > ellipse.bottom());
            let upwards = upwards.filter_map(|t| Some((number(t)?, -t.rect.center().y)));
            let across = across.filter_map(|t| Some((number(t)?, t.rect.center().x)));
            let [up, along] = [upwards.collect::<Vec<_>>(), across.collect()].map(|ticks| {
                let [a, .., b] = ticks[..] else { panic!("{ticks:?}") };
                f64::from(b.1 - a.1) / (b.0 - a.0)
            });
            assert!((up / along - 1.0).abs() < 0.03, "a millimetre is {up} points upwards and {along} across");
        }
    }

    #[test]
    fn likeness_and_bounds_are_there_in_wide_and_narrow_panels() {
        for (size, wanted) in [
            ([460.0, 640.0], &["likeness", "1.0", "one gain", "a gain an end", "amplitude"][..]),
            ([410.0, 200.0], &["likeness", "cos θ off, columns"]),
        ] {
            let bounds = panel(size);
            seen::assert_readable(bounds.output());
            seen::assert_reads(bounds.output(), wanted);
        }
    }

    #[test]
    fn the_ellipse_reaches_one_standard_deviation_in_x_and_y() {
        let bound = PositionBound {
            range_metres: 1e-3,
            cos_theta: 1e-4,
            x_metres: 3e-3,
            y_metres: 1e-3,
            xy_covariance_metres2: -2e-6,
            amplitude: 1e-3,
        };
        let outline = outline(&bound).unwrap();
        let most = |i: usize| outline.iter().map(|p| p[i]).fold(0.0, f64::max);
        assert!((most(0) - 3.0).abs() < 1e-9 && (most(1) - 1.0).abs() < 3e-3, "{} {}", most(0), most(1));
        assert!(outline[0][1] < 0.0, "it leans down to the right");
        assert!(super::outline(&PositionBound { y_metres: f64::INFINITY, ..bound }).is_none());
    }
}
