//! Default arrangement of the panels for each task, for a presentation, and for a lesson on the whole screen.

use super::panel::{MapKind, Panel};
use MapKind::{Difference, Doubt, Input0, Input1, Output, OutputAbove, Target, TargetAbove, Unexplained};
use Panel::Map;
use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
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

/// Part of an arrangement: tabs, the first in front, or a row or column of parts with their shares.
enum Part {
    Tabs(Vec<Panel>),
    Linear(LinearDir, Vec<(f32, Part)>),
}

/// The scene, its settings and all maps; tools have closed tiles.
fn explore() -> Tree<Panel> {
    let tools = [Panel::Found, Panel::Bounds, Panel::Phasors, Panel::Chirp, Panel::Training];
    // Panels that are read while settings change are beside them.
    let beside = [Panel::Guide, Panel::Lesson, Panel::Recording];
    let left = column([
        (0.40, tabs([Panel::Scene])),
        (0.37, tabs([Panel::Controls, Panel::Radar, Panel::Timing])),
        (0.23, tabs([Panel::Inspector, Panel::Objects])),
    ]);
    let left_maps =
        column([(1.0, tabs([Map(Input0)])), (1.0, tabs([Map(Target)])), (1.0, tabs([Map(TargetAbove), Panel::Cuts]))]);
    let right_maps = column([
        (1.0, tabs([Map(Input1)])),
        (1.0, tabs([Output, Difference, Doubt, Unexplained].map(Map))),
        (1.0, tabs([Map(OutputAbove), Panel::Roc].into_iter().chain(tools))),
    ]);
    let all = row([(1.1, left), (0.9, tabs(beside)), (1.0, left_maps), (1.0, right_maps)]);
    let closed = [Panel::Timing, Panel::Radar, Map(Doubt), Map(Unexplained)];
    tree("panels", all, closed.into_iter().chain(beside).chain(tools))
}

/// Two methods large, with scene, target and settings beside them.
fn compare() -> Tree<Panel> {
    let settings = tabs([Panel::Controls, Panel::Inspector, Panel::Cuts]);
    let left = column([(1.0, tabs([Panel::Scene])), (0.9, tabs([Map(Target)])), (1.0, settings)]);
    tree("compare", row([(0.3, left), (0.7, tabs([Panel::Compare]))]), [])
}

/// Rows on the whole width, since they are long, with the maps of the opened one above.
fn failures() -> Tree<Panel> {
    let above = row([
        (0.9, tabs([Panel::Scene, Panel::Inspector])),
        (1.0, tabs([Target, TargetAbove].map(Map))),
        (1.0, tabs([Output, OutputAbove, Difference].map(Map))),
    ]);
    tree("failures", column([(0.42, above), (0.58, tabs([Panel::Failures]))]), [])
}

/// A lesson large, with the scene and the controls of challenges, one map large, the others that lessons ask about, the target above its
/// threshold, and the waveform closed. `part` of the height is the lesson's, and the maps are so many times as wide.
pub fn lesson(name: &'static str, [part, times]: [f32; 2]) -> Tree<Panel> {
    let controls = [Panel::Radar, Panel::Inspector];
    let scene = tabs([Panel::Scene].into_iter().chain(controls));
    let left = column([(part, tabs([Panel::Lesson])), (1.0 - part, scene)]);
    let others = [vec![Map(Input0)], vec![Map(Input1)], vec![Map(Output), Map(TargetAbove), Panel::Chirp]];
    let others = row(others.map(|maps| (1.0, tabs(maps))));
    let right = column([(1.5, tabs([Map(Target)])), (1.0, others)]);
    tree(name, row([(1.0, left), (times, right)]), controls.into_iter().chain([Panel::Chirp]))
}

/// Panels for an audience: target and output equally large, scene and the ends' maps below them.
pub fn presentation() -> Tree<Panel> {
    let side_by_side = |panels: &[Panel]| row(panels.iter().map(|panel| (1.0, tabs([*panel]))));
    let upper = side_by_side(&[Map(Target), Map(Output)]);
    let lower = side_by_side(&[Panel::Scene, Map(Input0), Map(Input1)]);
    tree("presentation", column([(1.0, upper), (1.0, lower)]), [])
}

/// The panels whose tabs a panel shares in a tree, itself among them; none where it has no tile.
pub fn beside(tree: &Tree<Panel>, panel: Panel) -> Vec<Panel> {
    let tabs = tree.tiles.find_pane(&panel).and_then(|id| tree.tiles.parent_of(id));
    let Some(Tile::Container(tabs)) = tabs.and_then(|id| tree.tiles.get(id)) else { return Vec::new() };
    tabs.children().filter_map(|id| tree.tiles.get_pane(id).copied()).collect()
}

fn tabs(panels: impl IntoIterator<Item = Panel>) -> Part {
    Part::Tabs(panels.into_iter().collect())
}

fn column(parts: impl IntoIterator<Item = (f32, Part)>) -> Part {
    Part::Linear(LinearDir::Vertical, parts.into_iter().collect())
}

fn row(parts: impl IntoIterator<Item = (f32, Part)>) -> Part {
    Part::Linear(LinearDir::Horizontal, parts.into_iter().collect())
}

/// The tiles of an arrangement; those of `closed` are hidden.
fn tree(name: &'static str, all: Part, closed: impl IntoIterator<Item = Panel>) -> Tree<Panel> {
    let mut tiles = Tiles::default();
    let root = add(&mut tiles, all);
    for id in closed.into_iter().filter_map(|panel| tiles.find_pane(&panel)).collect::<Vec<_>>() {
        tiles.set_visible(id, false);
    }
    Tree::new(egui::Id::unique(name), root, tiles)
}

fn add(tiles: &mut Tiles<Panel>, part: Part) -> TileId {
    match part {
        Part::Tabs(panels) => {
            let panes = panels.into_iter().map(|panel| tiles.insert_pane(panel)).collect();
            tiles.insert_tab_tile(panes)
        }
        Part::Linear(dir, parts) => {
            let placed: Vec<_> = parts.into_iter().map(|(share, part)| (share, add(tiles, part))).collect();
            let mut linear = Linear::new(dir, placed.iter().map(|(_, id)| *id).collect());
            placed.into_iter().for_each(|(share, id)| linear.shares.set_share(id, share));
            tiles.insert_container(Container::Linear(linear))
        }
    }
}
