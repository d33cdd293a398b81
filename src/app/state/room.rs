//! Room for an opened panel: its least size, taken from its neighbours and returned when it is closed.

use super::panel::Panel;
use eframe::egui::Vec2;
use egui_tiles::{Container, LinearDir, Shares, Tile, TileId, Tiles};
use serde::{Deserialize, Serialize};

/// Neighbours keep at least this much, points; a lesson more, so that its text is still read.
const MIN_NEIGHBOUR_POINTS: f32 = 120.0;
const MIN_LESSON_POINTS: f32 = 230.0;

const TABS_HEIGHT_POINTS: f32 = 24.0;

/// Shares of a container before a panel took room in it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Taken {
    panel: Panel,
    container: TileId,
    before: Shares,
}

/// The least useful size of a panel, points.
pub fn least_size(panel: Panel) -> Vec2 {
    let [width, height] = match panel {
        Panel::Scene | Panel::Map(_) => [200.0, 140.0],
        Panel::Inspector => [250.0, 210.0],
        Panel::Objects | Panel::Timing => [250.0, 160.0],
        Panel::Controls | Panel::Found => [260.0, 220.0],
        Panel::Cuts | Panel::Values | Panel::Roc => [260.0, 180.0],
        Panel::Guide | Panel::Lesson => [300.0, 260.0],
        Panel::Radar | Panel::Elements | Panel::Disturbances => [280.0, 260.0],
        Panel::Several => [420.0, 320.0],
        Panel::Phasors => [360.0, 350.0],
        Panel::Chirp => [360.0, 380.0],
        Panel::Compare | Panel::Failures | Panel::Evaluation | Panel::RunTime => [560.0, 320.0],
        _ => [360.0, 280.0],
    };
    Vec2::new(width, height)
}

/// Gives an opened panel its least size, where its containers have room for it. Returns the changed containers. Sizes are those of the last frame.
pub fn make(tiles: &mut Tiles<Panel>, panel: Panel) -> Vec<Taken> {
    let least = least_size(panel);
    let across = grow(tiles, panel, LinearDir::Horizontal, least.x);
    let down = grow(tiles, panel, LinearDir::Vertical, least.y + TABS_HEIGHT_POINTS);
    across.into_iter().chain(down).collect()
}

/// Returns the room taken for a panel. Where another panel took room in the same container later, that panel will return it.
pub fn give_back(tiles: &mut Tiles<Panel>, taken: &mut Vec<Taken>, panel: Panel) {
    while let Some(index) = taken.iter().position(|t| t.panel == panel) {
        let Taken { container, before, .. } = taken.remove(index);
        match taken[index..].iter_mut().find(|later| later.container == container) {
            Some(later) => later.before = before,
            None => {
                if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(container) {
                    linear.shares = before;
                }
            }
        }
    }
}

/// The visible children of a row or a column.
fn in_sight(tiles: &Tiles<Panel>, container: TileId) -> Vec<TileId> {
    let Some(Tile::Container(Container::Linear(linear))) = tiles.get(container) else { return Vec::new() };
    linear.children.iter().copied().filter(|id| tiles.is_visible_in_layout(*id)).collect()
}

/// The columns beside one with rows at the same heights, which stay aligned for the frames of maps.
fn aligned(tiles: &Tiles<Panel>, column: TileId) -> Vec<TileId> {
    let tops = |id: TileId| -> Vec<i64> {
        in_sight(tiles, id)
            .into_iter()
            .filter_map(|row| tiles.rect(row))
            .map(|rect| rect.top().round() as i64)
            .collect()
    };
    let own = tops(column);
    let beside = tiles.parent_of(column).map(|row| in_sight(tiles, row)).unwrap_or_default();
    beside.into_iter().filter(|id| *id != column && tops(*id) == own).collect()
}

/// Least size that a neighbour keeps, points.
fn kept_of(tiles: &Tiles<Panel>, neighbour: TileId) -> f32 {
    let lesson = tiles.find_pane(&Panel::Lesson);
    let has_lesson = std::iter::successors(lesson, |id| tiles.parent_of(*id)).any(|id| id == neighbour);
    if has_lesson { MIN_LESSON_POINTS } else { MIN_NEIGHBOUR_POINTS }
}

/// Enlarges the panel along one direction, from the innermost container outwards, until it has `need` points.
fn grow(tiles: &mut Tiles<Panel>, panel: Panel, dir: LinearDir, need: f32) -> Vec<Taken> {
    let mut taken = Vec::new();
    let extent = |tiles: &Tiles<Panel>, id: TileId| {
        let size = tiles.rect(id).map_or(Vec2::ZERO, |rect| rect.size());
        if dir == LinearDir::Horizontal { size.x } else { size.y }
    };
    let Some(mut child) = tiles.find_pane(&panel) else { return taken };
    let mut lacking = tiles.parent_of(child).map_or(0.0, |tabs| need - extent(tiles, tabs));
    while let Some(parent) = tiles.parent_of(child).filter(|_| lacking > 0.5) {
        let (whole, now, rows) = (extent(tiles, parent), extent(tiles, child), in_sight(tiles, parent));
        let leads = matches!(tiles.get(parent), Some(Tile::Container(Container::Linear(l))) if l.dir == dir);
        let kept: f32 = rows.iter().filter(|id| **id != child).map(|id| kept_of(tiles, *id)).sum();
        let wanted = (now + lacking).min(whole - kept);
        if let Some(row) = rows.iter().position(|id| *id == child).filter(|_| leads && rows.len() > 1 && wanted > now) {
            lacking -= wanted - now;
            for container in aligned(tiles, parent).into_iter().chain([parent]) {
                let rows = in_sight(tiles, container);
                if let Some(Tile::Container(Container::Linear(linear))) = tiles.get_mut(container) {
                    let before = linear.shares.clone();
                    let of_others = rows.iter().map(|id| before[*id]).sum::<f32>() - before[rows[row]];
                    linear.shares.set_share(rows[row], of_others * wanted / (whole - wanted));
                    taken.push(Taken { panel, container, before });
                }
            }
        }
        child = parent;
    }
    taken
}
