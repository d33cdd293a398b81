//! What no method can beat: the ambiguity function around a reflector, and the Cramer-Rao bound of its position.

use crate::app::jobs::{BoundsRequest, BoundsResult};
use crate::app::state::{BoundsSettings, Command, Elements};
use crate::app::widgets::textures::Texture;
use crate::app::widgets::theme;
use crate::bounds::PositionBound;
use crate::radar::{Layout, Radar};
use eframe::egui;
use eframe::egui::{Color32, ComboBox, DragValue, Grid, TextureOptions, Ui, vec2};
use egui_plot::{HoverPosition, Line, Plot, PlotImage, PlotPoint, PlotPoints, Points};
use std::f64::consts::TAU;

/// What is chosen, and what came of it.
pub struct Input<'a> {
    /// What is looked at.
    pub settings: BoundsSettings,
    /// Elements of the radar: the most that can be chosen at random.
    pub elements: usize,
    /// Whether there is a reflector ahead of the array.
    pub has_subject: bool,
    /// What was found last.
    pub result: Option<&'a BoundsResult>,
    /// Why nothing was found.
    pub error: Option<&'a str>,
}

/// The picture on the graphics card.
#[derive(Default)]
pub struct Memory {
    texture: Texture,
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>, memory: &mut Memory) -> Vec<Command> {
    let mut asked = Vec::new();
    if !input.has_subject {
        ui.centered_and_justified(|ui| ui.weak("Place a reflector ahead of the array to see its bounds."));
        return asked;
    }
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 6)).show(ui, |ui| {
        let mut settings = input.settings;
        choices(ui, &mut settings, input.elements);
        if settings != input.settings {
            asked.push(Command::SetBounds(settings));
        }
        if let Some(error) = input.error {
            ui.colored_label(ui.visuals().error_fg_color, error);
            return;
        }
        let Some(result) = input.result else {
            ui.weak("computing…");
            return;
        };
        let texture = memory.texture.of(ui.ctx(), "ambiguity", &result.image, TextureOptions::LINEAR);
        strip(ui, &result.request.radar, &result.layout);
        let size = ui.available_size();
        if size.x > 1.5 * size.y {
            ui.horizontal(|ui| {
                ui.allocate_ui(vec2(0.58 * size.x, size.y), |ui| picture(ui, result, texture));
                ui.vertical(|ui| bound(ui, result));
            });
        } else {
            ui.allocate_ui(vec2(size.x, 0.5 * size.y), |ui| picture(ui, result, texture));
            bound(ui, result);
        }
    });
    asked
}

fn choices(ui: &mut Ui, settings: &mut BoundsSettings, most: usize) {
    ui.horizontal_wrapped(|ui| {
        let label = ui.label("Seen by").on_hover_text("Which elements listen");
        let combo = ComboBox::from_id_salt("elements").selected_text(settings.elements.name()).show_ui(ui, |ui| {
            let count = if let Elements::Random(count) = settings.elements { count } else { 24 };
            for choice in [Elements::TwoEnds, Elements::OneEnd, Elements::Random(count), Elements::Mimo, Elements::All]
            {
                ui.selectable_value(&mut settings.elements, choice, choice.name());
            }
        });
        combo.response.labelled_by(label.id);
        if let Elements::Random(count) = &mut settings.elements {
            ui.add(DragValue::new(count).range(2..=most).suffix(" of them")).on_hover_text("How many elements");
            let label = ui.label("seed");
            ui.add(DragValue::new(&mut settings.seed).speed(0.05)).labelled_by(label.id);
        }
        let label = ui.label("SNR").on_hover_text("Of one sample, averaged over the elements");
        ui.add(DragValue::new(&mut settings.snr.0).range(-40.0..=120.0).speed(0.5).suffix(" dB")).labelled_by(label.id);
        let label = ui.label("±").on_hover_text("What the picture spans around the reflector");
        ui.add(DragValue::new(&mut settings.columns).range(1.0..=512.0).speed(0.2).suffix(" columns"))
            .labelled_by(label.id);
        ui.add(DragValue::new(&mut settings.bins).range(0.5..=64.0).speed(0.1).suffix(" bins")).labelled_by(label.id);
    });
}

/// The aperture with the elements that listen.
fn strip(ui: &mut Ui, radar: &Radar, layout: &Layout) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 14.0), egui::Sense::hover());
    let half = radar.aperture_metres() / 2.0;
    let inner = rect.shrink2(vec2(8.0, 0.0));
    let at = |x: f64| inner.center().x + (x / half) as f32 * inner.width() / 2.0;
    let ink = ui.visuals().weak_text_color();
    ui.painter().hline(inner.x_range(), rect.center().y, egui::Stroke::new(1.0, ink));
    let colour = theme::Inks::of(ui.visuals()).selected;
    for x in &layout.x_metres {
        ui.painter().vline(at(*x), rect.center().y - 5.0..=rect.center().y + 5.0, egui::Stroke::new(1.0, colour));
    }
    response.on_hover_text(format!("{} elements of an aperture of {:.2} m", layout.len(), radar.aperture_metres()));
}

/// The ambiguity function over columns and metres from the reflector.
fn picture(ui: &mut Ui, result: &BoundsResult, texture: egui::TextureId) {
    let BoundsRequest { radar, columns, bins, .. } = &result.request;
    let centre = result.centre;
    let column = 2.0 / radar.elements as f64;
    let half = [*columns, bins * radar.range_resolution_metres()];
    let likeness = &result.ambiguity.likeness;
    let value = move |p: &PlotPoint| {
        let cell = |v: f64, half: f64, count: usize| {
            let part = (v + half) / (2.0 * half) * (count - 1) as f64;
            (part > -0.5 && part < count as f64 - 0.5).then(|| part.round() as usize)
        };
        let (rows, columns) = likeness.dim();
        likeness.get((cell(p.y, half[1], rows)?, cell(p.x, half[0], columns)?)).copied()
    };
    Plot::new("ambiguity")
        .x_axis_label("cos θ off the reflector's, columns")
        .y_axis_label("range off, m")
        .default_x_bounds(-half[0], half[0])
        .default_y_bounds(-half[1], half[1])
        .reset()
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_drag(false)
        .y_axis_min_width(36.0)
        .show_grid(false)
        .label_formatter(|hover| {
            let p = match hover {
                HoverPosition::NearDataPoint { position, .. } | HoverPosition::Elsewhere { position } => position,
            };
            let likeness = value(p).map_or_else(String::new, |v| format!("\nlikeness {v:.3}"));
            let (cos, range) = (centre.cos_theta + p.x * column, centre.range_metres + p.y);
            Some(format!("cos θ {cos:.4}\nrange {range:.3} m{likeness}"))
        })
        .show(ui, |plot| {
            let size = vec2(2.0 * half[0] as f32, 2.0 * half[1] as f32);
            plot.image(PlotImage::new("likeness", texture, PlotPoint::new(0.0, 0.0), size).allow_hover(false));
            let cross = Points::new("the reflector", vec![[0.0, 0.0]]).shape(egui_plot::MarkerShape::Cross);
            plot.points(cross.radius(5.0).color(Color32::WHITE));
        });
}

/// Numbers and ellipse of the Cramer-Rao bound.
fn bound(ui: &mut Ui, result: &BoundsResult) {
    let name = &result.request.name;
    let bound = match &result.bound {
        Ok(bound) => bound,
        Err(error) => {
            ui.colored_label(ui.visuals().warn_fg_color, error.to_string());
            return;
        }
    };
    let column = 2.0 / result.request.radar.elements as f64;
    ui.strong(format!("Best possible for {name}"));
    let columns = if ui.available_width() > 420.0 { 2 } else { 1 };
    Grid::new("bound").num_columns(2 * columns).spacing([12.0, 3.0]).show(ui, |ui| {
        for (i, (what, value)) in [
            ("x", millimetres(bound.x_metres)),
            ("y", millimetres(bound.y_metres)),
            ("range", millimetres(bound.range_metres)),
            ("cos θ", format!("{:.4} columns", bound.cos_theta / column)),
        ]
        .into_iter()
        .enumerate()
        {
            ui.weak(format!("σ of {what}"));
            ui.monospace(value);
            if i % columns == columns - 1 {
                ui.end_row();
            }
        }
    });
    ellipse(ui, bound);
}

fn millimetres(metres: f64) -> String {
    if metres.is_finite() { format!("{:.3} mm", metres * 1e3) } else { "∞".to_owned() }
}

/// Where 39 % of the estimates of the best unbiased estimator would lie: one standard deviation.
fn ellipse(ui: &mut Ui, bound: &PositionBound) {
    let Some(outline) = outline(bound) else { return };
    let colour = theme::Inks::of(ui.visuals()).selected;
    let size = outline.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()));
    let id = ("ellipse", size.log10().round() as i32);
    let area = ui.available_size();
    if area.y < 110.0 {
        return;
    }
    Plot::new(id)
        .x_axis_label("error of x, mm")
        .y_axis_label("error of y, mm")
        .data_aspect(1.0)
        .height(area.y - 4.0)
        .include_x(-1.2 * size)
        .include_x(1.2 * size)
        .include_y(-1.2 * size)
        .include_y(1.2 * size)
        .allow_scroll(false)
        .y_axis_min_width(36.0)
        .show(ui, |plot| {
            plot.line(Line::new("one standard deviation", PlotPoints::from(outline)).color(colour).width(1.6));
            plot.points(Points::new("the reflector", vec![[0.0, 0.0]]).radius(2.5).color(colour));
        });
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
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn another_choice_of_elements_is_asked_for() {
        let draw = |ui: &mut Ui, state: &mut (Memory, Vec<Command>)| {
            let settings = BoundsSettings::default();
            let input = Input { settings, elements: 64, has_subject: true, result: None, error: None };
            let commands = show(ui, input, &mut state.0);
            state.1.extend(commands);
        };
        let mut bounds = Harness::builder().with_size([500.0, 400.0]).build_ui_state(draw, Default::default());
        bounds.get_by_label("Seen by").click();
        bounds.run();
        bounds.get_by_label("the whole array").click();
        bounds.run();
        let all = BoundsSettings { elements: Elements::All, ..BoundsSettings::default() };
        assert_eq!(bounds.state().1, [Command::SetBounds(all)]);
    }

    #[test]
    fn the_ellipse_reaches_one_standard_deviation_in_x_and_y() {
        let bound = PositionBound {
            range_metres: 1e-3,
            cos_theta: 1e-4,
            x_metres: 3e-3,
            y_metres: 1e-3,
            xy_covariance_metres2: -2e-6,
        };
        let outline = outline(&bound).unwrap();
        let most = |i: usize| outline.iter().map(|p| p[i]).fold(0.0, f64::max);
        assert!((most(0) - 3.0).abs() < 1e-9 && (most(1) - 1.0).abs() < 3e-3, "{} {}", most(0), most(1));
        assert!(outline[0][1] < 0.0, "it leans down to the right");
        assert!(outline_of_flat().is_none());
    }

    fn outline_of_flat() -> Option<Vec<[f64; 2]>> {
        let (range_metres, cos_theta, x_metres) = (1.0, 1.0, 1.0);
        outline(&PositionBound {
            range_metres,
            cos_theta,
            x_metres,
            y_metres: f64::INFINITY,
            xy_covariance_metres2: 0.0,
        })
    }
}
