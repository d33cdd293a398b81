//! The panels in one column, for a window as narrow as a telephone.

use crate::app::state::{Arrangement, MapKind, Panel};
use eframe::egui::{ScrollArea, Sense, Ui, UiBuilder, Vec2, vec2};

/// Width below which a window has its panels in one column, points. Beside a scene a map could not be read.
pub const MAX_COLUMN_WIDTH_POINTS: f32 = 520.0;

/// Panels that together fill the height of the window.
const PANELS_IN_VIEW: f32 = 3.0;

/// Least height of a panel that is no map, points.
const MIN_PANEL_HEIGHT_POINTS: f32 = 260.0;

const TITLE_HEIGHT_POINTS: f32 = 20.0;

/// The open panels from top to bottom: tools, then scene, output, target and controls, then the rest.
pub fn order(arrangement: &Arrangement) -> Vec<Panel> {
    let first = [Panel::Scene, Panel::Map(MapKind::Output), Panel::Map(MapKind::Target), Panel::Controls];
    let (tools, rest): (Vec<Panel>, Vec<Panel>) = Panel::tiles().into_iter().partition(|panel| panel.is_tool());
    let rest = rest.into_iter().filter(|panel| !first.contains(panel));
    tools.into_iter().chain(first).chain(rest).filter(|panel| arrangement.has_tile(*panel)).collect()
}

/// Draws the column of `panels`; calls `draw` only for those in sight.
pub fn show(ui: &mut Ui, panels: &[Panel], mut draw: impl FnMut(&mut Ui, Panel)) {
    let map_height =
        (ui.available_height() / PANELS_IN_VIEW - TITLE_HEIGHT_POINTS - ui.spacing().item_spacing.y).max(140.0);
    // A touch on a panel drags its content; it does not scroll the column.
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = Vec2::new(0.0, 2.0);
        for &panel in panels {
            let is_picture = matches!(panel, Panel::Scene | Panel::Map(_));
            let height = if is_picture { map_height } else { map_height.max(MIN_PANEL_HEIGHT_POINTS) };
            let (title, _) = ui.allocate_exact_size(vec2(ui.available_width(), TITLE_HEIGHT_POINTS), Sense::hover());
            ui.put(title, eframe::egui::Label::new(panel.tile_title()).selectable(false));
            let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
            if ui.clip_rect().intersects(rect) {
                let mut inside = ui.new_child(UiBuilder::new().id_salt(panel).max_rect(rect));
                inside.set_clip_rect(rect.intersect(ui.clip_rect()));
                draw(&mut inside, panel);
            }
        }
    });
}
