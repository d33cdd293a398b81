//! Default arrangement of the panels for each task, for a presentation, and for a lesson on the whole screen.

use super::panel::{MapKind, Panel};
use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

named! {
    /// A use of the window. Each task has its own arrangement of panels, kept as the user leaves it.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    pub enum Task {
        /// The scene, its settings and all maps.
        #[default]
        Explore = "Explore",
        /// Two methods on one scene, large.
        Compare = "Compare",
        /// Rows of scenes on which methods fail, with the maps of the opened one.
        Failures = "Failures",
        /// A lesson, the scene and the maps that lessons ask about.
        Teach = "Teach",
    }
}

impl Task {
    /// The task's panels in a sentence, for tooltips.
    pub fn describe(self) -> &'static str {
        match self {
            Task::Explore => "Arrange panels: the scene, its settings and all maps",
            Task::Compare => "Arrange panels: two methods on this scene, large, beside the scene and the target",
            Task::Failures => {
                "Arrange panels: the rows on the whole width, above them the maps of the row that is open"
            }
            Task::Teach => "Arrange panels: a lesson, the scene and the maps it asks about",
        }
    }

    /// The task of a large panel that needs maps beside it.
    pub fn of(panel: Panel) -> Option<Task> {
        match panel {
            Panel::Compare => Some(Task::Compare),
            Panel::Failures => Some(Task::Failures),
            Panel::Lesson => Some(Task::Teach),
            _ => None,
        }
    }

    /// The default tiles of the task.
    pub fn tree(self) -> Tree<Panel> {
        match self {
            Task::Explore => explore(),
            Task::Compare => compare(),
            Task::Failures => failures(),
            Task::Teach => lesson("teach", [0.6, 1.75]),
        }
    }
}

/// The scene, its settings and all maps; tools have closed tiles.
fn explore() -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let mut pane = |panel| tiles.insert_pane(panel);
    let [scene, controls, inspector, objects] =
        [Panel::Scene, Panel::Controls, Panel::Inspector, Panel::Objects].map(&mut pane);
    let [in0, in1, target, output, target_above, output_above, difference, doubt, unexplained] =
        MapKind::ALL.map(|kind| pane(Panel::Map(kind)));
    let [cuts, roc, timing] = [Panel::Cuts, Panel::Roc, Panel::Timing].map(&mut pane);
    let [guide, lesson, recording, radar] =
        [Panel::Guide, Panel::Lesson, Panel::Recording, Panel::Radar].map(&mut pane);
    let of_results = [Panel::Found, Panel::Bounds, Panel::Phasors, Panel::Chirp, Panel::Training];
    let tools = of_results.map(pane);
    for closed in [timing, guide, lesson, recording, radar, doubt, unexplained].iter().chain(&tools) {
        tiles.set_visible(*closed, false);
    }
    let tabs = |tiles: &mut Tiles<Panel>, children: Vec<TileId>| tiles.insert_tab_tile(children);
    let scene = tabs(&mut tiles, vec![scene]);
    let controls = tabs(&mut tiles, vec![controls, radar, timing]);
    // Panels that are read while settings change are beside them.
    let beside = tabs(&mut tiles, vec![guide, lesson, recording]);
    let inspector = tabs(&mut tiles, vec![inspector, objects]);
    let left = column(&mut tiles, vec![scene, controls, inspector], &[0.40, 0.37, 0.23]);
    let first = tabs(&mut tiles, vec![in0]);
    let second = tabs(&mut tiles, vec![target]);
    let third = tabs(&mut tiles, vec![target_above, cuts]);
    let left_maps = column(&mut tiles, vec![first, second, third], &[1.0, 1.0, 1.0]);
    let first = tabs(&mut tiles, vec![in1]);
    let second = tabs(&mut tiles, vec![output, difference, doubt, unexplained]);
    let third = tabs(&mut tiles, [output_above, roc].into_iter().chain(tools).collect());
    let right_maps = column(&mut tiles, vec![first, second, third], &[1.0, 1.0, 1.0]);
    let root = row(&mut tiles, vec![left, beside, left_maps, right_maps], &[1.1, 0.9, 1.0, 1.0]);
    Tree::new(egui::Id::unique("panels"), root, tiles)
}

/// Two methods large, with scene, target and settings beside them.
fn compare() -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let scene = tabs(&mut tiles, &[Panel::Scene]);
    let target = tabs(&mut tiles, &[Panel::Map(MapKind::Target)]);
    let settings = tabs(&mut tiles, &[Panel::Controls, Panel::Inspector, Panel::Cuts]);
    let left = column(&mut tiles, vec![scene, target, settings], &[1.0, 0.9, 1.0]);
    let compare = tabs(&mut tiles, &[Panel::Compare]);
    let root = row(&mut tiles, vec![left, compare], &[0.3, 0.7]);
    Tree::new(egui::Id::unique("compare"), root, tiles)
}

/// Rows on the whole width, since they are long, with the maps of the opened one above.
fn failures() -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let scene = tabs(&mut tiles, &[Panel::Scene, Panel::Inspector]);
    let target = tabs(&mut tiles, &[MapKind::Target, MapKind::TargetAbove].map(Panel::Map));
    let output = tabs(&mut tiles, &[MapKind::Output, MapKind::OutputAbove, MapKind::Difference].map(Panel::Map));
    let above = row(&mut tiles, vec![scene, target, output], &[0.9, 1.0, 1.0]);
    let rows = tabs(&mut tiles, &[Panel::Failures]);
    let root = column(&mut tiles, vec![above, rows], &[0.42, 0.58]);
    Tree::new(egui::Id::unique("failures"), root, tiles)
}

/// A lesson on the whole screen: its text is read from afar, and has more room.
pub fn projected_lesson() -> Tree<Panel> {
    lesson("lesson", [0.68, 1.3])
}

/// A lesson large, with the scene and the controls of challenges, one map large, the others that lessons ask about, and the target above
/// its threshold. `part` of the height is the lesson's, and the maps are so many times as wide.
fn lesson(name: &'static str, [part, times]: [f32; 2]) -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let lesson = tabs(&mut tiles, &[Panel::Lesson]);
    let controls = [Panel::Radar, Panel::Inspector].map(|panel| tiles.insert_pane(panel));
    controls.iter().for_each(|control| tiles.set_visible(*control, false));
    let scene = tiles.insert_pane(Panel::Scene);
    let scene = tiles.insert_tab_tile([scene].into_iter().chain(controls).collect());
    let [in0, in1, target] =
        [MapKind::Input0, MapKind::Input1, MapKind::Target].map(|kind| tabs(&mut tiles, &[Panel::Map(kind)]));
    let output = tabs(&mut tiles, &[MapKind::Output, MapKind::TargetAbove].map(Panel::Map));
    let left = column(&mut tiles, vec![lesson, scene], &[part, 1.0 - part]);
    let others = row(&mut tiles, vec![in0, in1, output], &[1.0, 1.0, 1.0]);
    let right = column(&mut tiles, vec![target, others], &[1.5, 1.0]);
    let root = row(&mut tiles, vec![left, right], &[1.0, times]);
    Tree::new(egui::Id::unique(name), root, tiles)
}

/// Panels for an audience: target and output equally large, scene and the ends' maps below them.
pub fn presentation() -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let maps = [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output];
    let scene = tabs(&mut tiles, &[Panel::Scene]);
    let [first, last, target, output] = maps.map(|kind| tabs(&mut tiles, &[Panel::Map(kind)]));
    let upper = row(&mut tiles, vec![target, output], &[1.0, 1.0]);
    let lower = row(&mut tiles, vec![scene, first, last], &[1.0, 1.0, 1.0]);
    let root = column(&mut tiles, vec![upper, lower], &[1.0, 1.0]);
    Tree::new(egui::Id::unique("presentation"), root, tiles)
}

/// Tabs of these panels, the first in front.
fn tabs(tiles: &mut Tiles<Panel>, panels: &[Panel]) -> TileId {
    let panes = panels.iter().map(|panel| tiles.insert_pane(*panel)).collect();
    tiles.insert_tab_tile(panes)
}

fn column(tiles: &mut Tiles<Panel>, children: Vec<TileId>, shares: &[f32]) -> TileId {
    linear(tiles, LinearDir::Vertical, children, shares)
}

fn row(tiles: &mut Tiles<Panel>, children: Vec<TileId>, shares: &[f32]) -> TileId {
    linear(tiles, LinearDir::Horizontal, children, shares)
}

fn linear(tiles: &mut Tiles<Panel>, dir: LinearDir, children: Vec<TileId>, shares: &[f32]) -> TileId {
    let mut linear = Linear::new(dir, children.clone());
    for (child, share) in children.into_iter().zip(shares) {
        linear.shares.set_share(child, *share);
    }
    tiles.insert_container(Container::Linear(linear))
}
