//! The panel that compares settings: one map several times, side by side, for several values of one constant.

use super::map;
use crate::app::content::Content;
use crate::app::jobs::Small;
use crate::app::state::{Command, MapKind, Parameter, Projection, RadarCommand, Several, State, Variant, ViewCommand};
use crate::app::widgets::{
    Bar, Inks, NumberField, Texture, axes, choice, colour_table, labelled, member_box, method_lines, padded,
    ticking_menu,
};
use eframe::egui::{self, Align2, Color32, FontId, Rect, Sense, TextureOptions, Ui, Vec2, pos2, vec2};

/// Height of a map's name.
const NAME: f32 = 18.0;

/// Remembers textures of the maps.
pub const PANEL: Content<Vec<Texture>> =
    Content { tells_answers: true, ..Content::drawn(|ui, cx| show(ui, cx.state, &cx.jobs.several.shown, cx.memory)) };

/// Draws the panel with these maps. A click on a map gives the scene its value.
pub fn show(ui: &mut Ui, state: &State, maps: &[Small], textures: &mut Vec<Texture>) -> Vec<Command> {
    padded(ui, |ui, asked| {
        choices(ui, state, asked);
        // Room for the bar of colours, which all maps share.
        ui.set_max_width((ui.available_width() - axes::RIGHT).max(60.0));
        if maps.is_empty() {
            ui.weak("No radar can have these values.");
            return;
        }
        textures.resize_with(maps.len(), Texture::default);
        let area = ui.available_rect_before_wrap();
        let (columns, size) = grid(maps.len(), area.size());
        for (index, (small, texture)) in maps.iter().zip(textures).enumerate() {
            let corner = vec2((index % columns) as f32 * size.x, (index / columns) as f32 * size.y);
            let place = Rect::from_min_size(area.min + corner, size).shrink(3.0);
            let picture = picture_of(place, state.settings.projection);
            asked.extend(tile(ui, (place, picture), small, texture, state));
            if index == columns.min(maps.len()) - 1 {
                let bar = Bar::new(colour_table(state.settings.colours), 0.0, 1.0, "Λ");
                bar.draw(ui, ui.painter(), picture);
            }
        }
    })
}

/// Number of columns that makes the largest maps twice as wide as high, and the size of each map.
fn grid(count: usize, area: Vec2) -> (usize, Vec2) {
    let size = |columns: usize| vec2(area.x / columns as f32, area.y / count.div_ceil(columns) as f32);
    let width = |columns: usize| (size(columns).x - axes::LEFT).min(2.0 * (size(columns).y - NAME - axes::BOTTOM));
    let columns = (1..=count.max(1)).max_by(|a, b| width(*a).total_cmp(&width(*b))).unwrap_or(1);
    (columns, size(columns))
}

fn choices(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    let mut several = state.settings.several.clone();
    ui.horizontal_wrapped(|ui| {
        let mut parameter = several.parameter;
        choice(ui, "Compare", "", &mut parameter, Parameter::ALL, |p| (p.name().to_owned(), ""));
        if parameter != several.parameter {
            several = several.with(parameter, state.radar());
        }
        let maps = [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output];
        choice(ui, "in", "", &mut several.map, maps, |map| (map.title().to_owned(), map.describe()));
        match several.parameter.unit() {
            Some(unit) => numbers(ui, &mut several, unit),
            None if several.parameter == Parameter::Method => methods(ui, &mut several, state),
            None => {}
        }
    });
    if several != state.settings.several {
        asked.push(ViewCommand::SetSeveral(Box::new(several)).into());
    }
}

fn numbers(ui: &mut Ui, several: &mut Several, unit: &str) {
    let speed = ((several.high - several.low).abs() / 200.0).max(1e-3);
    let value = |ui: &mut Ui, name: &str, value: &mut f64| {
        let field = NumberField::new(value).speed(speed).range(-100.0..=1e4).max_decimals(3).suffix(unit);
        labelled(ui, name, "", field);
    };
    value(ui, "from", &mut several.low);
    value(ui, "to", &mut several.high);
    let count = NumberField::new(&mut several.count).range(2..=crate::app::state::MAX_MAPS_AT_ONCE).speed(0.05);
    labelled(ui, "maps", "", count);
}

fn methods(ui: &mut Ui, several: &mut Several, state: &State) {
    ticking_menu(ui, "Methods", |ui| {
        _ = method_lines(ui, state, |ui, method| {
            member_box(ui, method.name(), method.name().to_owned(), &mut several.methods)
        });
    })
    .on_hover_text("Which methods, at most eight; the first eight where none is chosen");
}

/// Rectangle of a map within its `place`: below its name and within its axes. A Cartesian map is twice as wide as high.
fn picture_of(place: Rect, projection: Projection) -> Rect {
    let within = Rect::from_min_max(place.min + vec2(axes::LEFT, NAME), place.max - vec2(8.0, axes::BOTTOM));
    let size = match projection {
        Projection::RangeAngle => within.size(),
        Projection::Cartesian => {
            vec2(within.width().min(2.0 * within.height()), within.height().min(within.width() / 2.0))
        }
    };
    Rect::from_min_size(within.min, size.max(Vec2::splat(10.0)))
}

/// Draws a map into the second rectangle, with its name and its axes in the first. A click gives the scene its value.
fn tile(
    ui: &mut Ui,
    (place, picture): (Rect, Rect),
    small: &Small,
    texture: &mut Texture,
    state: &State,
) -> Option<Command> {
    let (Variant { label, radar, .. }, parameter) = (&small.variant, state.settings.several.parameter);
    let response = ui.interact(place, ui.scope_id().with(("small map", label)), Sense::click());
    let name = format!("{}: {label}", parameter.name());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    let painter = ui.painter().with_clip_rect(place);
    painter.rect_filled(picture, 0.0, Inks::of(ui.visuals()).beyond);
    let is_met = response.hovered() || response.has_focus();
    let ink = if is_met { ui.visuals().strong_text_color() } else { ui.visuals().text_color() };
    painter.text(place.left_top(), Align2::LEFT_TOP, label, FontId::proportional(12.5), ink);
    match &small.made {
        Some(Ok(image)) => {
            let texture = texture.of(ui.ctx(), &name, image, TextureOptions::LINEAR);
            let uv = Rect::from_min_max(pos2(0.0, 1.0), pos2(1.0, 0.0));
            let tint = if small.is_current { Color32::WHITE } else { Color32::from_gray(190) };
            painter.image(texture, picture, uv, tint);
        }
        Some(Err(reason)) => {
            let galley = painter.layout(reason.clone(), FontId::proportional(11.0), ink, picture.width() - 8.0);
            painter.galley(picture.min + vec2(4.0, 4.0), galley, ink);
        }
        None => {
            _ = painter.text(picture.center(), Align2::CENTER_CENTER, "computing…", FontId::proportional(11.0), ink)
        }
    }
    map::draw_axes_around(ui, picture, radar, state.settings.projection, state.settings.directions);
    response.on_hover_text("Use this value for the scene").clicked().then(|| take(&small.variant, parameter)).flatten()
}

/// The command that sets the scene's radar, floor or method to this value.
fn take(variant: &Variant, parameter: Parameter) -> Option<Command> {
    Some(match parameter {
        Parameter::Window => Command::Radar(RadarCommand::SetWindow(variant.radar.window)),
        Parameter::Snr | Parameter::Floor => Command::View(ViewCommand::SetFloor(variant.floor)),
        Parameter::Method => Command::View(ViewCommand::Method(variant.method.as_ref()?.name())),
        _ => Command::Radar(RadarCommand::Set(Box::new(variant.radar.clone()))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, User};
    use crate::radar::Radar;
    use crate::signal::Floor;
    use std::sync::Arc;

    fn harness(parameter: Parameter) -> Harness<'static, Vec<Command>> {
        let (mut state, mut textures) = (State::new(Vec::new()), Vec::new());
        state.settings.several = Several::default().with(parameter, &Radar::default());
        seen::asking([900.0, 500.0], move |ui| {
            let variants = state.settings.several.variants(&Radar::default(), Floor::Thesis, None, &[]);
            let small = |variant| {
                let image = Arc::new(egui::ColorImage::filled([4, 2], Color32::GRAY));
                Small { variant, made: Some(Ok(image)), is_current: true }
            };
            let maps: Vec<Small> = variants.into_iter().map(small).collect();
            show(ui, &state, &maps, &mut textures)
        })
    }

    #[test]
    fn a_map_that_is_clicked_puts_its_value_before_the_scene() {
        let mut panel = harness(Parameter::Window);
        panel.clicks(&["window: rectangular"]);
        let rectangular = crate::radar::WindowFunction::Rectangular;
        assert_eq!(panel.state(), &[Command::Radar(RadarCommand::SetWindow(rectangular))]);
        let mut panel = harness(Parameter::Bandwidth);
        panel.clicks(&["bandwidth: 4.00 GHz"]);
        let [Command::Radar(RadarCommand::Set(radar))] = panel.state().as_slice() else {
            panic!("{:?}", panel.state())
        };
        assert!((radar.bandwidth_hz - 4e9).abs() < 1.0);
    }

    #[test]
    fn another_parameter_comes_with_its_usual_values_and_map() {
        let mut panel = harness(Parameter::Window);
        panel.clicks(&["Compare"]);
        panel.step();
        panel.clicks(&["elements of an end"]);
        let Some(Command::View(ViewCommand::SetSeveral(several))) = panel.state().last() else {
            panic!("{:?}", panel.state())
        };
        assert_eq!((several.parameter, several.map, several.low), (Parameter::EndElements, MapKind::Input0, 3.0));
    }

    #[test]
    fn maps_fill_the_panel() {
        for (count, area) in
            [(8, vec2(1200.0, 500.0)), (8, vec2(400.0, 900.0)), (4, vec2(800.0, 400.0)), (1, vec2(300.0, 200.0))]
        {
            let (columns, size) = grid(count, area);
            assert!(columns as f32 * size.x <= area.x + 0.1 && count.div_ceil(columns) as f32 * size.y <= area.y + 0.1);
        }
        assert_eq!(grid(8, vec2(1600.0, 460.0)).0, 4);
    }
}
