//! The animation of a map from one projection to the other: every cell, mark and curve moves along a straight line on screen.

use super::frame::{Frame, Morph};
use super::plot::rect_of;
use crate::app::state::{Command, MapKind, MapView, Projection, ViewCommand};
use crate::app::widgets::{Icon, icons};
use eframe::egui::emath::easing::cubic_in_out;
use eframe::egui::{Color32, Id, Mesh, Painter, Rect, Shape, TextureId, Ui, pos2, vec2};

/// Duration of the animation, seconds.
pub const SECONDS: f32 = 0.5;

/// Cells of the mesh that a picture is drawn on, across and up.
const MESH: [usize; 2] = [160, 64];

/// The rest of the animation to `projection`; `None` at rest.
pub fn morph(ui: &Ui, area: Rect, projection: Projection, other: MapView, above: f32) -> Option<Morph> {
    let end = if projection == Projection::Cartesian { 1.0 } else { 0.0 };
    let now = ui.ctx().animate_value_with_time(Id::unique("coordinates of the maps"), end, SECONDS);
    let left = cubic_in_out((end - now).abs().clamp(0.0, 1.0));
    let from = projection.other();
    (left > 0.0).then(|| Morph { rect: rect_of(area, from, above), view: other, projection: from, left })
}

/// Draws a picture in projection `own` at the places where `frame` shows its cells.
pub fn picture(painter: &Painter, frame: Frame<'_>, texture: TextureId, own: Projection, tint: Color32) {
    let [across, up] = MESH;
    let mut mesh = Mesh::with_texture(texture);
    for (row, column) in (0..=up).flat_map(|row| (0..=across).map(move |column| (row, column))) {
        let fraction = pos2(column as f32 / across as f32, row as f32 / up as f32);
        let polar = frame.polar_of_cell(fraction);
        // Row 0 of a picture is range 0, the lower end of the fractions.
        let uv = frame.fraction_in(own, polar, fraction);
        mesh.vertices.push(eframe::egui::epaint::Vertex { pos: frame.at_fraction(polar, fraction), uv, color: tint });
        if row < up && column < across {
            let at = (row * (across + 1) + column) as u32;
            let above = at + across as u32 + 1;
            mesh.add_triangle(at, at + 1, above);
            mesh.add_triangle(at + 1, above, above + 1);
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// Draws the button in a map's corner that changes the projection of all maps.
pub fn button(ui: &mut Ui, rect: Rect, kind: MapKind, projection: Projection, asked: &mut Vec<Command>) {
    if rect.width() < 120.0 || rect.height() < 60.0 {
        return;
    }
    let (icon, name) = match projection {
        Projection::RangeAngle => (Icon::Fan, "bend into x and y"),
        Projection::Cartesian => (Icon::Grid, "straighten into cos θ and range"),
    };
    let corner = Rect::from_min_size(rect.right_bottom() - vec2(28.0, 24.0), vec2(24.0, 20.0));
    if icons::over_picture(ui, corner, icon, &format!("{}: {name}", kind.title())).clicked() {
        asked.push(ViewCommand::SetProjection(projection.other()).into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Polar, Radar};
    use crate::scene::Reflector;
    use eframe::egui::Pos2;

    #[test]
    fn a_place_moves_in_a_straight_line_between_kinds_of_maps() {
        let radar = Radar::default();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
        let frame = |projection, morph| Frame { morph, ..Frame::of(rect, MapView::default(), &radar, projection, 0.0) };
        let reflector = Reflector { x_metres: -12.0, y_metres: 16.0, reflectivity: 1.0 };
        let [start, end] = [Projection::RangeAngle, Projection::Cartesian].map(|p| frame(p, None).blob(&reflector));
        assert!(start.distance(end) > 20.0);
        for left in [1.0, 0.5, 0.0] {
            let morph = Morph { rect, view: MapView::default(), projection: Projection::RangeAngle, left };
            let at = frame(Projection::Cartesian, Some(morph)).blob(&reflector);
            assert!(at.distance(end.lerp(start, left)) < 1e-3, "{at:?} with {left} left");
        }
    }

    #[test]
    fn a_picture_in_either_coordinates_has_the_cells_of_the_map() {
        let radar = Radar::default();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
        let frame = Frame::of(rect, MapView::default(), &radar, Projection::RangeAngle, 0.0);
        let polar = Polar { range_metres: 20.0, cos_theta: 0.5 };
        let cell = pos2(
            ((radar.column_of_cos(0.5) + 0.5) / radar.elements as f64) as f32,
            ((radar.bin_of_range(20.0) + 0.5) / radar.samples as f64) as f32,
        );
        let back = frame.polar_of_cell(cell);
        assert!((back.range_metres - 20.0).abs() < 1e-4 && (back.cos_theta - 0.5).abs() < 1e-5, "{back:?}");
        assert_eq!(frame.fraction_in(Projection::RangeAngle, polar, cell), cell);
        let flat = frame.fraction_in(Projection::Cartesian, polar, cell);
        let extent = radar.max_range_metres();
        let wanted = pos2(((10.0 / extent + 1.0) / 2.0) as f32, (20.0 * 0.75f64.sqrt() / extent) as f32);
        assert!(flat.distance(wanted) < 1e-5, "{flat:?}, not {wanted:?}");
    }
}
