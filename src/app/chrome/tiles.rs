//! The panels' tiles: tabs, title bars, one panel that fills the window.

use crate::app::state::{Arrangement, Command, Panel};
use crate::app::widgets::icons::{Icon, icon};
use eframe::egui;
use eframe::egui::{Ui, WidgetText};
use egui_tiles::{SimplificationOptions, TileId, Tiles, UiResponse};
use std::collections::BTreeSet;

/// Whoever knows what the panels show.
pub trait Draw {
    /// Draws a panel.
    fn draw(&mut self, ui: &mut Ui, panel: Panel);

    /// What stands in a panel's title bar beside its name.
    fn caption(&self, panel: Panel) -> Option<String>;
}

/// Draws the panels.
pub fn show(ui: &mut Ui, arrangement: &mut Arrangement, panels: &mut dyn Draw) -> Vec<Command> {
    let mut behavior = Behavior { panels, shown: BTreeSet::new(), asked: Vec::new() };
    match arrangement.maximised() {
        Some(panel) => maximised(ui, panel, &mut behavior),
        None => arrangement.tree_mut().ui(&mut behavior, ui),
    }
    let Behavior { shown, asked, .. } = behavior;
    if arrangement.set_shown(shown) {
        // A tab that has just come to the front is laid out in this frame and drawn in the next.
        ui.request_repaint();
    }
    asked
}

fn maximised(ui: &mut Ui, panel: Panel, behavior: &mut Behavior<'_>) {
    let bar = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(8, 2));
    egui::Panel::top("maximised").frame(bar).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.strong(panel.title());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Restore").on_hover_text("Show all panels again (Esc)").clicked() {
                    behavior.asked.push(Command::Maximise(panel));
                }
                behavior.caption(ui, panel);
            });
        });
    });
    behavior.draw(ui, panel);
}

struct Behavior<'a> {
    panels: &'a mut dyn Draw,
    shown: BTreeSet<Panel>,
    asked: Vec<Command>,
}

impl Behavior<'_> {
    fn draw(&mut self, ui: &mut Ui, panel: Panel) {
        self.shown.insert(panel);
        self.panels.draw(ui, panel);
    }

    fn caption(&self, ui: &mut Ui, panel: Panel) {
        if let Some(text) = self.panels.caption(panel) {
            let text = egui::RichText::new(text).size(11.0).weak();
            ui.add(egui::Label::new(text).selectable(false).truncate());
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
            self.asked.push(Command::Maximise(panel));
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
            self.asked.push(Command::ClosePanel(panel));
        }
        if icon(ui, Icon::Maximise, &format!("Maximise {name}")).clicked() {
            self.asked.push(Command::Maximise(panel));
        }
        self.caption(ui, panel);
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
