//! Where the panels are: tiles that can be moved, resized, hidden and maximised.

use super::panel::{MapKind, Panel};
use crate::lesson::Uses;
use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Where the panels are.
#[derive(Serialize, Deserialize)]
pub struct Arrangement {
    tree: Tree<Panel>,
    maximised: Option<Panel>,
    /// Panels drawn in the last frame: only these are computed.
    #[serde(skip)]
    shown: BTreeSet<Panel>,
}

/// Heights of what stands above a panel that has the whole width, and of that panel.
const BELOW: [f32; 2] = [1.0, 0.8];

impl Default for Arrangement {
    fn default() -> Self {
        let mut tiles = Tiles::default();
        let mut pane = |panel| tiles.insert_pane(panel);
        let [scene, controls, inspector, objects] =
            [Panel::Scene, Panel::Controls, Panel::Inspector, Panel::Objects].map(&mut pane);
        let [in0, in1, target, output, target_above, output_above, difference, unexplained] =
            MapKind::ALL.map(|kind| pane(Panel::Map(kind)));
        let [cuts, roc, timing] = [Panel::Cuts, Panel::Roc, Panel::Timing].map(&mut pane);
        let [guide, lesson, failures, radar, elements, disturbances, tools @ ..] = Panel::TOOLS.map(pane);
        for closed in [timing, guide, lesson, failures, radar, elements, disturbances, unexplained].iter().chain(&tools)
        {
            tiles.set_visible(*closed, false);
        }
        let tabs = |tiles: &mut Tiles<Panel>, children: Vec<TileId>| tiles.insert_tab_tile(children);
        let scene = tabs(&mut tiles, vec![scene]);
        let controls = tabs(&mut tiles, vec![controls, radar, elements, disturbances, timing]);
        // What is read while settings change stands beside them.
        let beside = tabs(&mut tiles, vec![guide, lesson]);
        let inspector = tabs(&mut tiles, vec![inspector, objects]);
        let left = column(&mut tiles, vec![scene, controls, inspector], &[0.40, 0.37, 0.23]);
        let first = tabs(&mut tiles, vec![in0]);
        let second = tabs(&mut tiles, vec![target]);
        let third = tabs(&mut tiles, vec![target_above, cuts]);
        let left_maps = column(&mut tiles, vec![first, second, third], &[1.0, 1.0, 1.0]);
        let first = tabs(&mut tiles, vec![in1]);
        let second = tabs(&mut tiles, vec![output, difference, unexplained]);
        let third = tabs(&mut tiles, [output_above, roc].into_iter().chain(tools).collect());
        let right_maps = column(&mut tiles, vec![first, second, third], &[1.0, 1.0, 1.0]);
        let columns =
            linear(&mut tiles, LinearDir::Horizontal, vec![left, beside, left_maps, right_maps], &[1.1, 0.9, 1.0, 1.0]);
        // Rows are long, and the maps are looked at while one walks through them.
        let below = tabs(&mut tiles, vec![failures]);
        let root = column(&mut tiles, vec![columns, below], &BELOW);
        Arrangement {
            tree: Tree::new(egui::Id::unique("panels"), root, tiles),
            maximised: None,
            shown: BTreeSet::new(),
        }
    }
}

fn column(tiles: &mut Tiles<Panel>, children: Vec<TileId>, shares: &[f32]) -> TileId {
    linear(tiles, LinearDir::Vertical, children, shares)
}

fn linear(tiles: &mut Tiles<Panel>, dir: LinearDir, children: Vec<TileId>, shares: &[f32]) -> TileId {
    let mut linear = Linear::new(dir, children.clone());
    for (child, share) in children.into_iter().zip(shares) {
        linear.shares.set_share(child, *share);
    }
    tiles.insert_container(Container::Linear(linear))
}

impl Arrangement {
    /// A lesson large, with the scene, the four maps that lessons ask about, and the target above its threshold: for a projector.
    pub fn of_a_lesson() -> Self {
        let mut tiles = Tiles::default();
        let mut tab = |panel| {
            let pane = tiles.insert_pane(panel);
            tiles.insert_tab_tile(vec![pane])
        };
        let [lesson, scene] = [Panel::Lesson, Panel::Scene].map(&mut tab);
        let [in0, in1, target] = [MapKind::Input0, MapKind::Input1, MapKind::Target].map(|kind| tab(Panel::Map(kind)));
        let output = [MapKind::Output, MapKind::TargetAbove].map(|kind| tiles.insert_pane(Panel::Map(kind))).to_vec();
        let output = tiles.insert_tab_tile(output);
        let left = column(&mut tiles, vec![lesson, scene], &[0.6, 0.4]);
        let middle = column(&mut tiles, vec![target, in0], &[1.0, 1.0]);
        let right = column(&mut tiles, vec![output, in1], &[1.0, 1.0]);
        let root = linear(&mut tiles, LinearDir::Horizontal, vec![left, middle, right], &[1.15, 1.0, 1.0]);
        Arrangement {
            tree: Tree::new(egui::Id::unique("lesson"), root, tiles),
            maximised: None,
            shown: BTreeSet::new(),
        }
    }

    /// An arrangement of nothing, to stand in for one that is being drawn.
    pub fn empty() -> Self {
        let tree = Tree::empty(egui::Id::unique("no panels"));
        Arrangement { tree, maximised: None, shown: BTreeSet::new() }
    }

    /// What is shown to many people at once: the scene, an end's map, the target and the output, large.
    pub fn presentation() -> Self {
        let mut tiles = Tiles::default();
        let maps = [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output];
        let mut tab = |panel| {
            let pane = tiles.insert_pane(panel);
            tiles.insert_tab_tile(vec![pane])
        };
        let (scene, [first, last, target, output]) = (tab(Panel::Scene), maps.map(|kind| tab(Panel::Map(kind))));
        let upper = linear(&mut tiles, LinearDir::Horizontal, vec![scene, target], &[1.0, 1.0]);
        let lower = linear(&mut tiles, LinearDir::Horizontal, vec![first, last, output], &[1.0, 1.0, 1.0]);
        let root = column(&mut tiles, vec![upper, lower], &[1.0, 1.0]);
        let tree = Tree::new(egui::Id::unique("presentation"), root, tiles);
        Arrangement { tree, maximised: None, shown: BTreeSet::new() }
    }

    /// The tiles.
    pub fn tree_mut(&mut self) -> &mut Tree<Panel> {
        &mut self.tree
    }

    /// Says which panels this frame drew; whether they are others than before.
    pub fn set_shown(&mut self, shown: BTreeSet<Panel>) -> bool {
        let changed = shown != self.shown;
        self.shown = shown;
        changed
    }

    /// Panels drawn in the last frame.
    pub fn shown(&self) -> &BTreeSet<Panel> {
        &self.shown
    }

    /// The panel that fills the window, if one does.
    pub fn maximised(&self) -> Option<Panel> {
        self.maximised
    }

    /// Lets `panel` fill the window, or ends that.
    pub fn toggle_maximised(&mut self, panel: Panel) {
        self.maximised = if self.maximised == Some(panel) { None } else { Some(panel) };
    }

    /// Ends that a panel fills the window.
    pub fn restore(&mut self) {
        self.maximised = None;
    }

    /// Whether a panel has a visible tile (its tab may be behind another).
    pub fn is_open(&self, panel: Panel) -> bool {
        self.tree.tiles.find_pane(&panel).is_some_and(|id| self.tree.tiles.is_visible(id))
    }

    /// Hides a panel that is in sight; shows any other, its tab in front.
    pub fn toggle(&mut self, panel: Panel) {
        let in_sight = self.is_open(panel) && self.shown.contains(&panel);
        self.set_open(panel, !in_sight);
    }

    /// Shows or hides a panel; a shown one comes to the front.
    pub fn set_open(&mut self, panel: Panel, open: bool) {
        self.maximised = None;
        if open && matches!(panel, Panel::Guide | Panel::Lesson) {
            self.take_from_over_settings(panel);
        }
        match self.tree.tiles.find_pane(&panel) {
            Some(id) => {
                self.tree.tiles.set_visible(id, open);
                if open {
                    self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if *p == panel));
                }
            }
            None if open && panel == Panel::Failures => self.insert_below(panel),
            // A layout kept from an older version may lack a panel.
            None if open => {
                let id = self.tree.tiles.insert_pane(panel);
                if let Some(root) = self.tree.root() {
                    self.tree.move_tile_to_container(id, root, usize::MAX, false);
                }
            }
            None => {}
        }
    }

    /// Closes what a lesson doesn't use; each panel that was open, and whether its tab was in front.
    pub fn close_unused(&mut self, uses: Uses) -> Vec<(Panel, bool)> {
        let unused = |panel: &Panel| match panel {
            Panel::Map(MapKind::TargetAbove) => !uses.threshold,
            Panel::Map(MapKind::OutputAbove) => !(uses.output && uses.threshold),
            Panel::Map(kind) => kind.needs_output() && !uses.output,
            Panel::Found | Panel::Roc | Panel::Compare => !uses.output,
            _ => false,
        };
        let open = Panel::all().into_iter().filter(|p| unused(p) && self.is_open(*p));
        let closed: Vec<(Panel, bool)> = open.map(|panel| (panel, self.is_in_front(panel))).collect();
        closed.iter().for_each(|(panel, _)| self.set_open(*panel, false));
        closed
    }

    /// Whether no other tab is over a panel's.
    fn is_in_front(&self, panel: Panel) -> bool {
        let tiles = &self.tree.tiles;
        let Some(id) = tiles.find_pane(&panel) else { return false };
        match tiles.parent_of(id).and_then(|parent| tiles.get(parent)) {
            Some(Tile::Container(Container::Tabs(tabs))) => tabs.active == Some(id),
            _ => true,
        }
    }

    /// Opens again what [`Arrangement::close_unused`] closed; what was in front is in front again.
    pub fn open_again(&mut self, closed: &[(Panel, bool)]) {
        for (panel, was_in_front) in closed {
            let Some(id) = self.tree.tiles.find_pane(panel) else { continue };
            self.tree.tiles.set_visible(id, true);
            if *was_in_front {
                self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if p == panel));
            }
        }
    }

    /// Gives a panel the whole width below all others.
    fn insert_below(&mut self, panel: Panel) {
        let tiles = &mut self.tree.tiles;
        let pane = tiles.insert_pane(panel);
        let tab = tiles.insert_tab_tile(vec![pane]);
        let children = self.tree.root.into_iter().chain([tab]).collect();
        self.tree.root = Some(column(tiles, children, &BELOW));
    }

    /// The container of the columns, one of which holds the settings.
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

    /// Moves a panel that is read while settings change from the settings' tabs to a place beside them: that is where layouts kept from
    /// older versions have it.
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
mod tests {
    use super::*;

    #[test]
    fn every_panel_is_there_and_the_tools_are_closed() {
        let mut arrangement = Arrangement::default();
        for panel in Panel::all() {
            let closed =
                [Panel::Timing, Panel::Map(MapKind::Unexplained)].contains(&panel) || Panel::TOOLS.contains(&panel);
            assert_eq!(arrangement.is_open(panel), !closed, "{panel:?}");
        }
        let lesson = Arrangement::of_a_lesson();
        assert!([Panel::Lesson, Panel::Scene, Panel::Map(MapKind::Target)].iter().all(|p| lesson.is_open(*p)));
        assert!(!lesson.is_open(Panel::Controls) && !lesson.is_open(Panel::Cuts));
        arrangement.toggle(Panel::Timing);
        arrangement.toggle(Panel::Cuts);
        assert!(arrangement.is_open(Panel::Cuts), "it was behind another tab");
        arrangement.shown.insert(Panel::Cuts);
        arrangement.toggle(Panel::Cuts);
        assert!(arrangement.is_open(Panel::Timing) && !arrangement.is_open(Panel::Cuts));
    }

    fn tabs_of(arrangement: &Arrangement, panel: Panel) -> Option<TileId> {
        let tiles = &arrangement.tree.tiles;
        tiles.parent_of(tiles.find_pane(&panel)?)
    }

    #[test]
    fn rows_have_the_whole_width_below_the_maps_even_where_an_older_layout_lacks_them() {
        let mut old = Arrangement::default();
        let id = old.tree.tiles.find_pane(&Panel::Failures).unwrap();
        let below = tabs_of(&old, Panel::Failures).unwrap();
        old.tree.root = old.columns();
        old.tree.tiles.remove(id);
        old.tree.tiles.remove(below);
        for mut arrangement in [old, Arrangement::default()] {
            arrangement.set_open(Panel::Failures, true);
            let tabs = tabs_of(&arrangement, Panel::Failures).unwrap();
            assert_eq!(arrangement.tree.tiles.parent_of(tabs), arrangement.tree.root());
            assert_ne!(arrangement.columns(), arrangement.tree.root(), "the columns stand above");
            assert!(arrangement.is_open(Panel::Failures) && arrangement.is_open(Panel::Controls));
        }
    }

    #[test]
    fn the_guide_opens_beside_the_settings_even_where_an_older_layout_had_it_over_them() {
        let mut arrangement = Arrangement::default();
        let controls = tabs_of(&arrangement, Panel::Controls).unwrap();
        assert_ne!(tabs_of(&arrangement, Panel::Guide), Some(controls));
        let guide = arrangement.tree.tiles.find_pane(&Panel::Guide).unwrap();
        arrangement.tree.move_tile_to_container(guide, controls, 0, false);
        assert_eq!(tabs_of(&arrangement, Panel::Guide), Some(controls), "as older versions had it");
        arrangement.set_open(Panel::Guide, true);
        assert_ne!(tabs_of(&arrangement, Panel::Guide), Some(controls));
        assert!(arrangement.is_open(Panel::Guide) && arrangement.is_open(Panel::Controls));
    }
}
