//! Panels in tiles that can be moved, resized, hidden and maximised.

use super::application::App;
use super::pictures::MapKind;
use super::{
    bounds_panel, controls_panel, cuts_panel, evaluation_panel, front_panel, guide_panel, inspector_panel, map_panel,
    roc_panel, scene_panel, timing_panel, training_panel,
};
use eframe::egui;
use eframe::egui::{Ui, WidgetText};
use egui_tiles::{Container, Linear, LinearDir, SimplificationOptions, Tile, TileId, Tiles, Tree, UiResponse};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Everything that can be shown in a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Panel {
    /// The scene's canvas.
    Scene,
    /// Radar, display and reconstruction settings.
    Controls,
    /// Numbers of the selected objects.
    Inspector,
    /// A map.
    Map(MapKind),
    /// Range profile and angle cut through the cursor.
    Cuts,
    /// P_D against P_FA.
    Roc,
    /// What each stage cost and what was skipped.
    Timing,
    /// Ambiguity function and Cramer-Rao bound.
    Bounds,
    /// Methods on the tables' test sets.
    Evaluation,
    /// Run time against error.
    Front,
    /// A training watched.
    Training,
    /// What the maps show and why.
    Guide,
}

impl Panel {
    /// Panels that are closed at first: each is a tool for a question of its own.
    pub const TOOLS: [Panel; 5] = [Panel::Guide, Panel::Bounds, Panel::Evaluation, Panel::Front, Panel::Training];

    /// All panels, in the order menus list them.
    pub fn all() -> Vec<Panel> {
        let mut all = vec![Panel::Scene, Panel::Controls, Panel::Inspector];
        all.extend(MapKind::ALL.map(Panel::Map));
        all.extend([Panel::Cuts, Panel::Roc, Panel::Timing]);
        all.extend(Panel::TOOLS);
        all
    }

    /// Its title.
    pub fn title(self) -> &'static str {
        match self {
            Panel::Scene => "Scene",
            Panel::Controls => "Settings",
            Panel::Inspector => "Inspector",
            Panel::Map(kind) => kind.title(),
            Panel::Cuts => "Cuts",
            Panel::Roc => "ROC",
            Panel::Timing => "Timing",
            Panel::Bounds => "Bounds",
            Panel::Evaluation => "Evaluation",
            Panel::Front => "Run time",
            Panel::Training => "Training",
            Panel::Guide => "Guide",
        }
    }

    /// What it is for.
    pub fn describe(self) -> &'static str {
        match self {
            Panel::Scene => "The reflectors before the radar; drag them",
            Panel::Controls => "Radar, display and reconstruction settings",
            Panel::Inspector => "Numbers of what is selected",
            Panel::Map(kind) => kind.describe(),
            Panel::Cuts => "Range profile and angle cut of all maps through the cursor",
            Panel::Roc => "Detection against false alarm of this scene, over every threshold",
            Panel::Timing => "What each stage of the last update cost, and what was skipped and why",
            Panel::Bounds => "How well any method could place a reflector, and what looks like it to chosen elements",
            Panel::Evaluation => "Tables 4.1 to 4.3 for any method, beside the printed values",
            Panel::Front => "Run time against error of the simulation on this machine",
            Panel::Training => "The loss of a network while it is trained",
            Panel::Guide => "What the maps show and why, with something to try",
        }
    }
}

/// Where the panels are.
#[derive(Serialize, Deserialize)]
pub struct Layout {
    tree: Tree<Panel>,
    maximised: Option<Panel>,
    /// Panels drawn in the last frame: only these are computed.
    #[serde(skip)]
    shown: BTreeSet<Panel>,
}

impl Default for Layout {
    fn default() -> Self {
        let mut tiles = Tiles::default();
        let mut pane = |panel| tiles.insert_pane(panel);
        let [scene, controls, inspector] = [Panel::Scene, Panel::Controls, Panel::Inspector].map(&mut pane);
        let [in0, in1, target, output, target_above, output_above, difference] =
            MapKind::ALL.map(|kind| pane(Panel::Map(kind)));
        let [cuts, roc, timing] = [Panel::Cuts, Panel::Roc, Panel::Timing].map(&mut pane);
        let [guide, tools @ ..] = Panel::TOOLS.map(pane);
        for closed in [timing, guide].iter().chain(&tools) {
            tiles.set_visible(*closed, false);
        }
        let tabs = |tiles: &mut Tiles<Panel>, children: Vec<TileId>| tiles.insert_tab_tile(children);
        let scene = tabs(&mut tiles, vec![scene]);
        let controls = tabs(&mut tiles, vec![controls, timing, guide]);
        let inspector = tabs(&mut tiles, vec![inspector]);
        let left = column(&mut tiles, vec![scene, controls, inspector], &[0.40, 0.37, 0.23]);
        let first = tabs(&mut tiles, vec![in0]);
        let second = tabs(&mut tiles, vec![target]);
        let third = tabs(&mut tiles, vec![target_above, cuts]);
        let left_maps = column(&mut tiles, vec![first, second, third], &[1.0, 1.0, 1.0]);
        let first = tabs(&mut tiles, vec![in1]);
        let second = tabs(&mut tiles, vec![output, difference]);
        let third = tabs(&mut tiles, [output_above, roc].into_iter().chain(tools).collect());
        let right_maps = column(&mut tiles, vec![first, second, third], &[1.0, 1.0, 1.0]);
        let root = linear(&mut tiles, LinearDir::Horizontal, vec![left, left_maps, right_maps], &[1.1, 1.0, 1.0]);
        Layout { tree: Tree::new(egui::Id::unique("panels"), root, tiles), maximised: None, shown: BTreeSet::new() }
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

impl Layout {
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
        match self.tree.tiles.find_pane(&panel) {
            Some(id) => {
                self.tree.tiles.set_visible(id, open);
                if open {
                    self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if *p == panel));
                }
            }
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
}

/// Draws the panels.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let mut layout = std::mem::take(&mut app.layout);
    let mut behavior = Behavior { app, shown: BTreeSet::new(), maximise: None, hide: None };
    match layout.maximised {
        Some(panel) => {
            let bar = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(8, 2));
            egui::Panel::top("maximised").frame(bar).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.strong(panel.title());
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        if ui.button("Restore").on_hover_text("Show all panels again (Esc)").clicked() {
                            behavior.maximise = Some(panel);
                        }
                    });
                });
            });
            behavior.draw(ui, panel);
        }
        None => layout.tree.ui(&mut behavior, ui),
    }
    let Behavior { app, shown, maximise, hide } = behavior;
    if shown != layout.shown {
        // A tab that has just come to the front is laid out in this frame and drawn in the next.
        ui.request_repaint();
    }
    layout.shown = shown;
    if let Some(panel) = maximise {
        layout.toggle_maximised(panel);
    }
    if let Some(panel) = hide {
        layout.set_open(panel, false);
    }
    app.layout = layout;
}

struct Behavior<'a> {
    app: &'a mut App,
    shown: BTreeSet<Panel>,
    maximise: Option<Panel>,
    hide: Option<Panel>,
}

impl Behavior<'_> {
    fn draw(&mut self, ui: &mut Ui, panel: Panel) {
        self.shown.insert(panel);
        let app = &mut *self.app;
        match panel {
            Panel::Scene => scene_panel::show(app, ui),
            Panel::Controls => controls_panel::show(app, ui),
            Panel::Inspector => inspector_panel::show(app, ui),
            Panel::Map(kind) => map_panel::show(app, ui, kind),
            Panel::Cuts => cuts_panel::show(app, ui),
            Panel::Roc => roc_panel::show(app, ui),
            Panel::Timing => timing_panel::show(app, ui),
            Panel::Bounds => bounds_panel::show(app, ui),
            Panel::Evaluation => evaluation_panel::show(app, ui),
            Panel::Front => front_panel::show(app, ui),
            Panel::Training => training_panel::show(app, ui),
            Panel::Guide => guide_panel::show(app, ui),
        }
    }
}

impl egui_tiles::Behavior<Panel> for Behavior<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, panel: &mut Panel) -> UiResponse {
        self.draw(ui, *panel);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, panel: &Panel) -> WidgetText {
        panel.title().into()
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<Panel>, tile: TileId, button: egui::Response) -> egui::Response {
        let Some(panel) = tiles.get_pane(&tile).copied() else { return button };
        if button.double_clicked() {
            self.maximise = Some(panel);
        }
        button.on_hover_ui(|ui| {
            ui.label(panel.describe());
            ui.weak("Drag to move · double-click to maximise");
        })
    }

    fn top_bar_right_ui(
        &mut self,
        tiles: &Tiles<Panel>,
        ui: &mut Ui,
        _tile: TileId,
        tabs: &egui_tiles::Tabs,
        _: &mut f32,
    ) {
        let Some(panel) = tabs.active.and_then(|id| tiles.get_pane(&id).copied()) else { return };
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.add_space(4.0);
        let name = panel.title();
        if icon(ui, Icon::Close, &format!("Hide {name}")).clicked() {
            self.hide = Some(panel);
        }
        if icon(ui, Icon::Maximise, &format!("Maximise {name}")).clicked() {
            self.maximise = Some(panel);
        }
        if let Panel::Map(kind) = panel {
            map_panel::heading(self.app, ui, kind);
        }
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        24.0
    }

    fn gap_width(&self, _style: &egui::Style) -> f32 {
        3.0
    }

    fn min_size(&self) -> f32 {
        90.0
    }
}

pub(super) enum Icon {
    Maximise,
    Close,
}

/// A small drawn button with a name for tooltips and screen readers.
pub(super) fn icon(ui: &mut Ui, icon: Icon, name: &str) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(18.0), egui::Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 3.0, visuals.bg_fill);
    }
    let r = rect.shrink(5.0);
    let stroke = egui::Stroke::new(1.2, visuals.fg_stroke.color);
    match icon {
        Icon::Maximise => {
            ui.painter().rect_stroke(r, 1.0, stroke, egui::StrokeKind::Middle);
        }
        Icon::Close => {
            ui.painter().line_segment([r.left_top(), r.right_bottom()], stroke);
            ui.painter().line_segment([r.right_top(), r.left_bottom()], stroke);
        }
    }
    response.on_hover_text(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_panel_is_there_and_the_tools_are_closed() {
        let mut layout = Layout::default();
        for panel in Panel::all() {
            let closed = panel == Panel::Timing || Panel::TOOLS.contains(&panel);
            assert_eq!(layout.is_open(panel), !closed, "{panel:?}");
        }
        layout.toggle(Panel::Timing);
        layout.toggle(Panel::Cuts);
        assert!(layout.is_open(Panel::Cuts), "it was behind another tab");
        layout.shown.insert(Panel::Cuts);
        layout.toggle(Panel::Cuts);
        assert!(layout.is_open(Panel::Timing) && !layout.is_open(Panel::Cuts));
    }
}
