//! Arrangement of the panels: tiles that can be moved, resized, hidden and maximised.

use super::panel::{MapKind, Panel};
use super::room::{self, Taken};
use super::task_layouts::{self, Task};
use crate::lesson::Uses;
use eframe::egui;
use egui_tiles::{Container, LinearDir, Tile, TileId, Tree};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// The panels of a task that is not on screen.
#[derive(Serialize, Deserialize)]
struct Left {
    task: Task,
    tree: Tree<Panel>,
    taken: Vec<Taken>,
}

/// Tiles of the panels, for the task on screen and for others.
#[derive(Serialize, Deserialize)]
pub struct Arrangement {
    /// The tiles of the task on screen.
    pub tree: Tree<Panel>,
    /// The panel that fills the window, if any.
    pub maximised: Option<Panel>,
    #[serde(default)]
    pub task: Task,
    /// The task before a panel switched to its own.
    #[serde(default)]
    before: Option<Task>,
    /// The panels of other tasks, as the user left them.
    #[serde(default)]
    others: Vec<Left>,
    /// Divisions of containers before opened panels took room.
    #[serde(default)]
    taken: Vec<Taken>,
    /// The view in front of each tile with several views, where it is not the first.
    #[serde(default)]
    pub views: BTreeMap<Panel, Panel>,
    /// A panel opened in this frame, which gets its least size once laid out.
    #[serde(skip)]
    opened: Option<Panel>,
    /// Panels drawn in the last frame. Only their values are computed.
    #[serde(skip)]
    shown: BTreeSet<Panel>,
}

impl Default for Arrangement {
    fn default() -> Self {
        Arrangement::of(Task::Explore.tree())
    }
}

impl Arrangement {
    fn of(tree: Tree<Panel>) -> Self {
        Arrangement {
            tree,
            maximised: None,
            task: Task::default(),
            before: None,
            others: Vec::new(),
            taken: Vec::new(),
            views: BTreeMap::new(),
            opened: None,
            shown: BTreeSet::new(),
        }
    }

    /// A large lesson with the scene and the maps that lessons ask about, for a projector: its text is read from afar, and has more room.
    pub fn of_a_lesson() -> Self {
        Arrangement::of(task_layouts::lesson("lesson", [0.68, 1.3]))
    }

    /// An arrangement without panels, in place of one that is being drawn.
    pub fn empty() -> Self {
        Arrangement::of(Tree::empty(egui::Id::unique("no panels")))
    }

    /// Scene, the ends' maps, target and output, large, for an audience.
    pub fn presentation() -> Self {
        Arrangement::of(task_layouts::presentation())
    }

    /// Switches to the panels of a task, as the user left them.
    pub fn switch(&mut self, task: Task) {
        self.before = None;
        self.change(task);
    }

    fn change(&mut self, task: Task) {
        self.maximised = None;
        if task == self.task {
            return;
        }
        let kept = self.others.iter().position(|left| left.task == task);
        let next = match kept {
            Some(index) => self.others.remove(index),
            None => Left { task, tree: task.tree(), taken: Vec::new() },
        };
        let (tree, taken) =
            (std::mem::replace(&mut self.tree, next.tree), std::mem::replace(&mut self.taken, next.taken));
        self.others.push(Left { task: self.task, tree, taken });
        self.task = task;
    }

    /// Switches to the task that a panel needs, until the panel is closed.
    fn change_for(&mut self, panel: Panel, task: Task) {
        let before = self.before.unwrap_or(self.task);
        self.change(task);
        self.before = Some(before).filter(|before| *before != task);
        self.set_open(panel, true);
    }

    /// Sets the panels drawn in this frame; true where they changed.
    pub fn set_shown(&mut self, shown: BTreeSet<Panel>) -> bool {
        let changed = shown != self.shown;
        self.shown = shown;
        changed
    }

    /// Panels drawn in the last frame.
    pub fn shown(&self) -> &BTreeSet<Panel> {
        &self.shown
    }

    /// Whether a panel fills the window.
    pub fn is_maximised(&self, panel: Panel) -> bool {
        self.maximised == Some(panel.tile()) && self.is_in_front_of_tile(panel)
    }

    /// Lets `panel` fill the window, or ends that.
    pub fn toggle_maximised(&mut self, panel: Panel) {
        let is_maximised = self.is_maximised(panel);
        self.bring_to_front(panel);
        self.maximised = Some(panel.tile()).filter(|_| !is_maximised);
    }

    pub fn view(&self, tile: Panel) -> Panel {
        self.views.get(&tile).copied().unwrap_or(tile)
    }

    /// Whether a panel is the view in front of its tile.
    fn is_in_front_of_tile(&self, panel: Panel) -> bool {
        self.view(panel.tile()) == panel
    }

    pub fn bring_to_front(&mut self, view: Panel) {
        if view.tile() == view {
            self.views.remove(&view);
        } else {
            self.views.insert(view.tile(), view);
        }
    }

    /// Removes tiles of panels that are now views of another tile, as layouts of older versions have them. A view that was in sight comes to the front.
    pub fn join_views(&mut self) {
        let trees = self.others.iter_mut().map(|left| &mut left.tree).chain([&mut self.tree]);
        for tree in trees {
            for view in Panel::all().into_iter().filter(|panel| panel.tile() != *panel) {
                let Some(id) = tree.tiles.find_pane(&view) else { continue };
                if tree.tiles.is_visible(id) {
                    match tree.tiles.find_pane(&view.tile()) {
                        Some(tile) => {
                            if !tree.tiles.is_visible(tile) {
                                self.views.insert(view.tile(), view);
                            }
                            tree.tiles.set_visible(tile, true);
                        }
                        None => {
                            self.views.insert(view.tile(), view);
                            tree.tiles.insert(id, Tile::Pane(view.tile()));
                            continue;
                        }
                    }
                }
                tree.remove_recursively(id);
            }
        }
        if let Some(view) = self.maximised.filter(|view| view.tile() != *view) {
            self.bring_to_front(view);
            self.maximised = Some(view.tile());
        }
    }

    /// Whether a panel has a visible tile, possibly behind another tab, and is the view in front of it.
    pub fn is_open(&self, panel: Panel) -> bool {
        self.has_tile(panel) && self.is_in_front_of_tile(panel)
    }

    /// Whether the tile of a panel is visible, with this or another view in front.
    pub fn has_tile(&self, panel: Panel) -> bool {
        self.tree.tiles.find_pane(&panel.tile()).is_some_and(|id| self.tree.tiles.is_visible(id))
    }

    /// Hides a panel in sight; shows any other with its tab in front.
    pub fn toggle(&mut self, panel: Panel) {
        let in_sight = self.is_open(panel) && self.shown.contains(&panel);
        self.set_open(panel, !in_sight);
    }

    /// Shows or hides a panel; a shown one comes to the front. A large panel that needs maps beside it switches to its own task, and closing it switches back.
    pub fn set_open(&mut self, panel: Panel, open: bool) {
        self.maximised = None;
        if open {
            self.bring_to_front(panel);
        }
        let (view, panel) = (panel, panel.tile());
        let own = Task::of(panel).filter(|_| !self.has_tile(panel) || !open);
        // A lesson does not open in its own task where the task on screen has a tile for it.
        let is_placed = panel == Panel::Lesson && self.tree.tiles.find_pane(&panel).is_some();
        match own {
            Some(task) if open && task != self.task && !is_placed => return self.change_for(view, task),
            Some(task) if !open && task == self.task && task != Task::Explore => {
                let before = self.before.take().unwrap_or_default();
                return self.change(before);
            }
            _ => {}
        }
        if open && matches!(panel, Panel::Guide | Panel::Lesson) {
            self.take_from_over_settings(panel);
        }
        match self.tree.tiles.find_pane(&panel) {
            Some(id) => self.set_pane_open(id, panel, open),
            // An arrangement for a task, or one kept from an older version, may lack a panel.
            None if open => self.insert(panel),
            None => {}
        }
    }

    fn set_pane_open(&mut self, id: TileId, panel: Panel, open: bool) {
        let was_open = self.has_tile(panel);
        self.tree.tiles.set_visible(id, open);
        if open {
            self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if *p == panel));
            self.opened = Some(panel);
        } else if was_open {
            room::give_back(&mut self.tree.tiles, &mut self.taken, panel);
        }
    }

    /// Adds a tab for a panel without a tile: where the task's own arrangement has it, else beside the settings, the inspector or the scene.
    fn insert(&mut self, panel: Panel) {
        let beside = task_layouts::beside(&self.task.tree(), panel);
        let tiles = &mut self.tree.tiles;
        let like = beside.iter().chain(&[Panel::Controls, Panel::Inspector, Panel::Scene]);
        let like = like.filter(|p| **p != panel).find_map(|p| tiles.find_pane(p));
        let tabs = like.and_then(|id| tiles.parent_of(id)).or(self.tree.root);
        let id = tiles.insert_pane(panel);
        if let Some(tabs) = tabs {
            self.tree.move_tile_to_container(id, tabs, usize::MAX, false);
        }
        self.set_pane_open(id, panel, true);
    }

    /// Swaps a map, of range and angle or of range and velocity, with the map in the largest tile.
    pub fn put_large(&mut self, map: Panel) {
        let asked = map.tile();
        if !self.is_open(map) || !self.is_in_front(asked) {
            self.set_open(map, true);
        }
        let tiles = &self.tree.tiles;
        let area = |panel: &Panel| {
            let place = tiles.find_pane(panel).filter(|_| self.has_tile(*panel) && self.is_in_front(*panel));
            place.and_then(|id| tiles.rect(id)).map_or(0.0, |rect| rect.area())
        };
        // Before a layout the first tile counts as the largest.
        let order = |panel: &Panel| tiles.find_pane(panel).map_or(u64::MAX, |id| id.0);
        let maps = MapKind::ALL.map(Panel::Map).into_iter().chain([Panel::RangeDoppler.tile()]);
        let compared = |a: &Panel, b: &Panel| area(a).total_cmp(&area(b)).then(order(b).cmp(&order(a)));
        let Some(large) = maps.max_by(compared) else { return };
        let (Some(to), Some(from)) = (tiles.find_pane(&large), tiles.find_pane(&asked)) else { return };
        if area(&large) > area(&asked) || area(&large) == 0.0 {
            self.tree.tiles.insert(to, Tile::Pane(asked));
            self.tree.tiles.insert(from, Tile::Pane(large));
        }
    }

    /// Gives an opened panel its least size, once laid out; true where sizes changed.
    pub fn make_room(&mut self) -> bool {
        let in_sight = |tile: &Panel| self.shown.contains(&self.views.get(tile).copied().unwrap_or(*tile));
        let Some(panel) = self.opened.take_if(|panel| in_sight(panel)) else { return false };
        let taken = room::make(&mut self.tree.tiles, panel);
        let moved = !taken.is_empty();
        self.taken.extend(taken);
        moved
    }

    /// Closes the panels that a lesson doesn't use. Returns each closed panel, and whether its tab was in front.
    pub fn close_unused(&mut self, uses: Uses) -> Vec<(Panel, bool)> {
        let unused = |panel: &Panel| match panel {
            Panel::Map(MapKind::TargetAbove) => !uses.threshold,
            Panel::Map(MapKind::OutputAbove) => !(uses.output && uses.threshold),
            Panel::Map(kind) => kind.needs_output() && !uses.output,
            Panel::Found | Panel::Roc | Panel::Compare => !uses.output,
            _ => false,
        };
        if unused(&Panel::Compare) && self.task == Task::Compare {
            self.switch(Task::Teach);
        }
        let open = Panel::tiles().into_iter().filter(|p| unused(p) && self.has_tile(*p));
        let closed: Vec<(Panel, bool)> = open.map(|panel| (panel, self.is_in_front(panel))).collect();
        closed.iter().for_each(|(panel, _)| self.set_open(*panel, false));
        closed
    }

    /// Whether a panel's tab is the front one.
    fn is_in_front(&self, panel: Panel) -> bool {
        let tiles = &self.tree.tiles;
        let Some(id) = tiles.find_pane(&panel) else { return false };
        match tiles.parent_of(id).and_then(|parent| tiles.get(parent)) {
            Some(Tile::Container(Container::Tabs(tabs))) => tabs.active == Some(id),
            _ => true,
        }
    }

    /// Opens the panels closed by [`Arrangement::close_unused`]; tabs that were in front are so again.
    pub fn open_again(&mut self, closed: &[(Panel, bool)]) {
        for (panel, was_in_front) in closed {
            let Some(id) = self.tree.tiles.find_pane(panel) else { continue };
            self.tree.tiles.set_visible(id, true);
            if *was_in_front {
                self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if p == panel));
            }
        }
    }

    /// The container of the columns, one of which has the settings.
    fn columns(&self) -> Option<TileId> {
        let tiles = &self.tree.tiles;
        let of = |id: TileId| tiles.parent_of(id);
        let across = |id: &TileId| {
            let tile = tiles.get(*id);
            matches!(tile, Some(Tile::Container(Container::Linear(l))) if l.dir == LinearDir::Horizontal)
        };
        let controls = tiles.find_pane(&Panel::Controls);
        std::iter::successors(controls, |id| of(*id)).find(across).or(self.tree.root())
    }

    /// Moves a panel from the settings' tabs, where older versions have it, to a place beside them, so that it can be read while settings change.
    fn take_from_over_settings(&mut self, panel: Panel) {
        let tiles = &self.tree.tiles;
        let [of_panel, of_settings] =
            [panel, Panel::Controls].map(|p| tiles.find_pane(&p).and_then(|id| tiles.parent_of(id)));
        if let (Some(id), Some(columns)) = (tiles.find_pane(&panel), self.columns())
            && of_panel.is_some()
            && of_panel == of_settings
            && of_panel != Some(columns)
        {
            self.tree.move_tile_to_container(id, columns, 1, false);
        }
    }
}

#[cfg(test)]
mod tests;
