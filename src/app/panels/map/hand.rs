//! The pointer on a map: a click selects the reflector behind a blob, a drag moves it.

use super::frame::Frame;
use crate::app::state::{Command, EditCommand, MapKind};
use crate::interact::SelectionMode;
use crate::interact::blob::{self, BlobHit};
use crate::radar::Polar;
use crate::scene::Scene;
use eframe::egui::{CursorIcon, PointerButton, Pos2, Response, Ui};

/// Most reflectors among which the one under a resting pointer is looked for in every frame.
const MAX_HOVERED_REFLECTORS: usize = 2000;

#[derive(Default)]
pub struct HandMemory {
    /// The map in which a blob is dragged, the blob, and the place on the map where the drag began.
    held: Option<(MapKind, BlobHit, Polar)>,
}

/// Handles clicks and drags on blobs. Returns whether a blob is being dragged, so that the map stays in place.
pub fn work(
    ui: &Ui,
    kind: MapKind,
    scene: &Scene,
    frame: Frame<'_>,
    response: &Response,
    memory: &mut HandMemory,
    asked: &mut Vec<Command>,
) -> bool {
    let (origin, now, modifiers) = ui.input(|i| (i.pointer.press_origin(), i.pointer.interact_pos(), i.modifiers));
    let mode = if modifiers.shift || modifiers.command { SelectionMode::Toggle } else { SelectionMode::Replace };
    if response.drag_started_by(PointerButton::Primary)
        && let Some(origin) = origin
        && let Some(blob) = under(scene, frame, origin)
    {
        memory.held = Some((kind, blob, frame.polar(origin)));
        asked.push(EditCommand::Grab(blob).into());
    }
    if response.clicked_by(PointerButton::Primary)
        && let Some(pos) = now
    {
        let hit = under(scene, frame, pos);
        asked.push(EditCommand::Select(hit.map(|h| h.object).into_iter().collect(), mode).into());
    }
    let held = memory.held.filter(|(of, ..)| *of == kind);
    if let (Some((_, blob, from)), Some(now)) = (held, now) {
        let to = blob::moved(frame.radar, frame.centre_x_metres, blob.place, from, frame.polar(now));
        asked.push(EditCommand::DragTo(to).into());
        ui.set_cursor_icon(CursorIcon::Grabbing);
    } else if let Some(pos) = response.hover_pos()
        && scene.reflector_count() <= MAX_HOVERED_REFLECTORS
        && under(scene, frame, pos).is_some()
    {
        ui.set_cursor_icon(CursorIcon::Grab);
    }
    if held.is_some() && !response.dragged_by(PointerButton::Primary) {
        memory.held = None;
        asked.push(EditCommand::Drop.into());
    }
    held.is_some()
}

/// The blob at a place on screen.
fn under(scene: &Scene, frame: Frame<'_>, pos: Pos2) -> Option<BlobHit> {
    blob::nearest(scene, |reflector| f64::from(frame.blob(reflector).distance(pos)))
}

#[cfg(test)]
mod tests {
    use super::super::{Input, show};
    use super::*;
    use crate::app::state::{MapView, Projection, State};
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use crate::interact::Snap;
    use crate::radar::Radar;
    use crate::scene::Reflector;
    use eframe::egui::{Modifiers, Rect, Vec2, vec2};

    struct Desk {
        state: State,
        snap: Snap,
        view: MapView,
        memory: HandMemory,
        asked: Vec<Command>,
    }

    /// A map, with an editor that executes its commands.
    fn map(kind: MapKind, projection: Projection, points: &[(f64, f64)]) -> Harness<'static, Desk> {
        let draw = move |ui: &mut Ui, desk: &mut Desk| {
            let asked = show(ui, Input::bare(kind, &desk.state), &mut desk.view, &mut desk.memory);
            let editor = &mut desk.state.editor;
            for command in asked {
                match command.clone() {
                    Command::Edit(EditCommand::Grab(blob)) => editor.grab(blob),
                    Command::Edit(EditCommand::DragTo(place)) => _ = editor.drag_to(place, desk.snap),
                    Command::Edit(EditCommand::Drop) => editor.end_drag(),
                    Command::Edit(EditCommand::Select(objects, mode)) => editor.select(objects, mode),
                    _ => continue,
                }
                desk.asked.push(command);
            }
        };
        let mut state = State::of(Radar::default(), Scene::of_points(points.iter().copied()));
        state.settings.projection = projection;
        let (view, memory) = (MapView::default(), HandMemory::default());
        let desk = Desk { state, snap: Snap::Off, view, memory, asked: Vec::new() };
        let mut map = Harness::builder().with_size([700.0, 420.0]).with_step_dt(0.05).build_ui_state(draw, desk);
        map.step();
        map
    }

    fn frame(radar: &Radar, kind: MapKind, projection: Projection, rect: Rect) -> Frame<'_> {
        let centre_x_metres = super::super::centre_x_metres(kind, radar);
        Frame::of(rect, MapView::default(), radar, projection, centre_x_metres)
    }

    fn place(map: &Harness<'static, Desk>, object: usize) -> [f64; 2] {
        map.state().state.editor.scene().objects[object].anchor_metres()
    }

    const POINTS: [(f64, f64); 2] = [(-8.0, 18.0), (9.0, 25.0)];

    fn blob_at(map: &Harness<'static, Desk>, kind: MapKind, projection: Projection, place: [f64; 2]) -> Pos2 {
        let rect = map.get_by_label(&format!("{} map", kind.title())).rect();
        let reflector = Reflector { x_metres: place[0], y_metres: place[1], reflectivity: 1.0 };
        frame(&Radar::default(), kind, projection, rect).blob(&reflector)
    }

    /// The map after a drag of the second point, and the expected place of its blob.
    fn dragged(kind: MapKind, projection: Projection) -> (Harness<'static, Desk>, Pos2) {
        let mut map = map(kind, projection, &POINTS);
        let (from, by) = (blob_at(&map, kind, projection, POINTS[1].into()), vec2(-60.0, 35.0));
        map.drags(&[0.0, 0.3, 0.7, 1.0].map(|part| from + by * part + vec2(2.0, 1.0)));
        (map, from + by)
    }

    #[test]
    fn a_blob_follows_the_pointer_in_every_map() {
        for projection in [Projection::RangeAngle, Projection::Cartesian] {
            for kind in [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output, MapKind::Difference] {
                let (mut map, to) = dragged(kind, projection);
                let off = blob_at(&map, kind, projection, place(&map, 1)).distance(to);
                assert!(off < 1.5, "{kind:?}, {projection:?}: its blob is {off} points beside the pointer");
                assert_eq!(place(&map, 0), [-8.0, 18.0]);
                assert_eq!(map.state().view, MapView::default(), "the map itself stays");
                assert_eq!(map.state().asked.last(), Some(&Command::Edit(EditCommand::Drop)));
                assert_eq!(map.state().state.editor.selection().single(), Some(1));
                let editor = &mut map.state_mut().state.editor;
                assert_eq!(editor.history().depth(), 1);
                editor.undo();
                assert_eq!(place(&map, 1), [9.0, 25.0], "one undo brings it back");
            }
        }
    }

    /// Indices of the objects that a click at this distance from a point's blob selects.
    fn clicked(map: &mut Harness<'static, Desk>, point: usize, off: Vec2, modifiers: Modifiers) -> Vec<usize> {
        let pos = blob_at(map, MapKind::Target, Projection::RangeAngle, POINTS[point].into()) + off;
        for pressed in [true, false] {
            map.hover_at(pos);
            map.event_modifiers(
                eframe::egui::Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers },
                modifiers,
            );
            map.step();
        }
        map.run_steps(12);
        assert_eq!(map.state().state.editor.history().depth(), 0);
        map.state().state.editor.selection().iter().collect()
    }

    #[test]
    fn a_click_selects_what_is_behind_a_blob() {
        let mut map = map(MapKind::Target, Projection::RangeAngle, &POINTS);
        assert_eq!(clicked(&mut map, 1, Vec2::ZERO, Modifiers::NONE), [1]);
        assert_eq!(clicked(&mut map, 0, Vec2::ZERO, Modifiers::NONE), [0]);
        assert_eq!(clicked(&mut map, 1, Vec2::ZERO, Modifiers::COMMAND), [0, 1]);
        assert!(clicked(&mut map, 1, vec2(70.0, 40.0), Modifiers::NONE).is_empty(), "beside every blob");
    }

    #[test]
    fn a_dragged_blob_snaps_as_in_the_scene() {
        let mut map = map(MapKind::Target, Projection::Cartesian, &[(4.0, 20.0)]);
        map.state_mut().snap = Snap::Metres(2.0);
        let from = blob_at(&map, MapKind::Target, Projection::Cartesian, [4.0, 20.0]);
        map.drags(&[from, from + vec2(55.0, 0.0)]);
        let [x, y] = place(&map, 0);
        assert!(x > 5.0 && x % 2.0 == 0.0 && y % 2.0 == 0.0, "{x}, {y}");
    }
}
