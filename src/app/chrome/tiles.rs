//! The panels' tiles: tabs, title bars, and a maximised panel.

use super::column;
use crate::app::content::OLD_PANEL_OPACITY;
use crate::app::state::{Arrangement, Command, Panel, WindowCommand};
use crate::app::widgets::{Icon, icon};
use eframe::egui::text::LayoutJob;
use eframe::egui::{self, FontId, TextStyle, Ui, WidgetText, vec2};
use egui_tiles::{SimplificationOptions, TileId, Tiles, UiResponse};
use std::collections::{BTreeMap, BTreeSet};

/// Draws the panels of the tiles.
pub trait Draw {
    fn draw(&mut self, ui: &mut Ui, panel: Panel);

    /// Text in the title bar beside the panel's name, from its longest form to its shortest.
    fn caption(&self, panel: Panel) -> Vec<String>;

    /// Whether a panel shows results of an earlier scene or settings. Its caption is then dimmed as its content is.
    fn is_old(&self, _: Panel) -> bool {
        false
    }
}

pub fn show(ui: &mut Ui, arrangement: &mut Arrangement, panels: &mut dyn Draw) -> Vec<Command> {
    let views = arrangement.views.clone();
    let mut behavior = Behavior { panels, views, shown: BTreeSet::new(), asked: Vec::new() };
    let is_narrow = ui.available_width() < column::MAX_COLUMN_WIDTH_POINTS;
    match arrangement.maximised {
        Some(panel) => maximised(ui, panel, &mut behavior),
        None if is_narrow => column::show(ui, &column::order(arrangement), |ui, panel| behavior.draw(ui, panel)),
        None => arrangement.tree.ui(&mut behavior, ui),
    }
    let Behavior { shown, asked, .. } = behavior;
    if arrangement.set_shown(shown) | (!is_narrow && arrangement.make_room()) {
        // A tab that has just come to the front is laid out in this frame and drawn in the next one.
        ui.request_repaint();
    }
    asked
}

fn maximised(ui: &mut Ui, panel: Panel, behavior: &mut Behavior<'_>) {
    let bar = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(8, 2));
    egui::Panel::top("maximised").frame(bar).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.strong(panel.tile_title());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Restore").on_hover_text("Show all panels again (Esc)").clicked() {
                    let front = behavior.front(panel);
                    behavior.asked.push(WindowCommand::Maximise(front).into());
                }
                let room = ui.available_width();
                behavior.caption(ui, panel, room);
            });
        });
    });
    behavior.draw(ui, panel);
}

/// Gap between a tab's title and its sides, points.
const TAB_MARGIN: f32 = 8.0;

const MIN_CAPTION_POINTS: f32 = 60.0;

/// Size of a caption in two lines, points.
const SMALL_CAPTION_POINTS: f32 = 10.0;

/// Width of the two arrows that scroll the tabs, points.
const SCROLL_ARROWS_POINTS: f32 = 64.0;

struct Behavior<'a> {
    panels: &'a mut dyn Draw,
    /// The view in front of each tile with several views, where it is not the first.
    views: BTreeMap<Panel, Panel>,
    shown: BTreeSet<Panel>,
    asked: Vec<Command>,
}

impl Behavior<'_> {
    fn front(&self, tile: Panel) -> Panel {
        self.views.get(&tile).copied().unwrap_or(tile)
    }

    /// Draws the view in front of a tile, below the names of all its views where it has several.
    fn draw(&mut self, ui: &mut Ui, tile: Panel) {
        let panel = self.front(tile);
        self.shown.insert(panel);
        if !panel.views().is_empty() {
            let names = egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 3));
            names.show(ui, |ui| ui.horizontal_wrapped(|ui| self.names_of_views(ui, panel)));
        }
        self.panels.draw(ui, panel);
    }

    fn names_of_views(&mut self, ui: &mut Ui, front: Panel) {
        for view in front.views() {
            let name = ui.selectable_label(view == front, view.view_title());
            if name.on_hover_text(view.describe()).clicked() && view != front {
                self.asked.push(WindowCommand::OpenView(view).into());
            }
        }
    }

    /// Draws the longest form of a panel's caption that fits `room` points, or the shortest in two small lines; none where `room` is too narrow.
    fn caption(&self, ui: &mut Ui, panel: Panel, room: f32) {
        let forms = self.panels.caption(panel);
        let Some(shortest) = forms.last().filter(|_| room >= MIN_CAPTION_POINTS) else { return };
        let ink = ui.visuals().weak_text_color();
        let ink = if self.panels.is_old(panel) { ink.gamma_multiply(OLD_PANEL_OPACITY) } else { ink };
        let lines = |text: &str, size| LayoutJob::simple(text.to_owned(), FontId::proportional(size), ink, room);
        let fits = |form: &&String| ui.painter().layout_job(lines(form, 12.0)).rows.len() == 1;
        let mut text = match forms.iter().find(fits) {
            Some(form) => lines(form, 12.0),
            None => lines(&shortest.replacen(", ", ",\n", 1), SMALL_CAPTION_POINTS),
        };
        text.wrap.max_rows = 2;
        let layout = egui::Layout::right_to_left(egui::Align::Center);
        ui.allocate_ui_with_layout(vec2(room, ui.available_height()), layout, |ui| {
            ui.add(egui::Label::new(text).selectable(false).wrap());
        });
    }
}

/// A tab and its edges in the row of tabs, points.
struct Tab {
    tile: TileId,
    left: f32,
    right: f32,
}

/// The tabs of a container that are not hidden, from left to right.
fn tabs_of(ui: &Ui, tiles: &Tiles<Panel>, tabs: &egui_tiles::Tabs) -> Vec<Tab> {
    let font = TextStyle::Button.resolve(ui.style());
    let mut right = 0.0;
    let visible = tabs.children.iter().filter(|tile| tiles.is_visible(**tile));
    let placed = visible.filter_map(|tile| {
        let title = tiles.get_pane(tile)?.tile_title().to_owned();
        let left = right;
        right += ui.painter().layout_no_wrap(title, font.clone(), egui::Color32::WHITE).size().x + 2.0 * TAB_MARGIN;
        Some(Tab { tile: *tile, left, right })
    });
    placed.collect()
}

/// Scrolls the row of tabs to the front one, whenever another has come to the front.
fn show_front(ui: &Ui, container: TileId, front: &Tab, room: f32, offset: &mut f32) {
    let id = egui::Id::unique(("front tab", container));
    let before = ui.data(|d| d.get_temp::<(TileId, bool)>(id));
    let now = (front.tile, front.right <= room);
    if before != Some(now) {
        *offset = offset.clamp((front.right - room).max(0.0), front.left.max((front.right - room).max(0.0)));
        ui.data_mut(|d| d.insert_temp(id, now));
    }
}

impl egui_tiles::Behavior<Panel> for Behavior<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, panel: &mut Panel) -> UiResponse {
        self.draw(ui, *panel);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, panel: &Panel) -> WidgetText {
        panel.tile_title().into()
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<Panel>, tile: TileId, button: egui::Response) -> egui::Response {
        let Some(panel) = tiles.get_pane(&tile).copied() else { return button };
        if button.double_clicked() {
            let front = self.front(panel);
            self.asked.push(WindowCommand::Maximise(front).into());
        }
        button.on_hover_ui(|ui| {
            ui.label(panel.describe_tile());
            ui.weak("Drag to move · double-click to maximise");
        })
    }

    fn top_bar_right_ui(
        &mut self,
        tiles: &Tiles<Panel>,
        ui: &mut Ui,
        tile: TileId,
        tabs: &egui_tiles::Tabs,
        offset: &mut f32,
    ) {
        let Some(panel) = tabs.active.and_then(|id| tiles.get_pane(&id).copied()) else { return };
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.add_space(4.0);
        let name = panel.tile_title();
        if icon(ui, Icon::Close, &format!("Hide {name}")).clicked() {
            self.asked.push(WindowCommand::ClosePanel(panel).into());
        }
        if icon(ui, Icon::Maximise, &format!("Maximise {name}")).clicked() {
            let front = self.front(panel);
            self.asked.push(WindowCommand::Maximise(front).into());
        }
        // The tabs come first; the caption gets the remaining width.
        let row = tabs_of(ui, tiles, tabs);
        let needed = row.last().map_or(0.0, |tab| tab.right);
        let room = ui.available_width();
        if needed <= room {
            self.caption(ui, panel, room - needed - TAB_MARGIN);
        }
        if let Some(front) = row.iter().find(|tab| Some(tab.tile) == tabs.active) {
            show_front(ui, tile, front, if needed <= room { room } else { room - SCROLL_ARROWS_POINTS }, offset);
        }
    }

    fn tab_title_spacing(&self, _: &egui::Visuals) -> f32 {
        TAB_MARGIN
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::Task;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    const VERDICT: &str = "5 of 5 found, 0 false";

    /// Panels without content, and with a long caption.
    struct Silent;

    impl Draw for Silent {
        fn draw(&mut self, _: &mut Ui, _: Panel) {}

        fn caption(&self, panel: Panel) -> Vec<String> {
            let forms = ["P_D 99.35 % · P_FA 1.63 % · η = 0.80 (updating)", VERDICT];
            forms.into_iter().filter(|_| matches!(panel, Panel::Map(_))).map(str::to_owned).collect()
        }
    }

    /// A window of 1280 by 720 pixels, drawn half as large again.
    fn window() -> Harness<'static, Arrangement> {
        let draw = |ui: &mut Ui, arrangement: &mut Arrangement| _ = show(ui, arrangement, &mut Silent);
        Harness::builder().with_size([853.0, 430.0]).build_ui_state(draw, Arrangement::default())
    }

    fn whole(window: &Harness<'_, Arrangement>, title: &str) -> bool {
        seen::texts(window.output()).iter().any(|t| t.text == title && t.clip.expand(0.5).contains_rect(t.rect))
    }

    #[test]
    fn every_tab_is_in_sight_in_a_small_window_with_long_captions() {
        let mut window = window();
        window.run_steps(3);
        for title in ["Output > η", "ROC", "Target > η'", "Cuts", "Output", "Difference"] {
            assert!(whole(&window, title), "{title}");
        }
        seen::assert_readable(window.output());
        let read = |verdict: &str| {
            seen::texts(window.output()).iter().any(|t| t.text.replace('\n', " ") == verdict && !t.is_shortened)
        };
        assert!(read(VERDICT), "the verdict is whole: {:?}", seen::texts(window.output()));
        window.clicks(&["ROC"]);
        assert!(window.state().shown().contains(&Panel::Roc));
    }

    #[test]
    fn a_tab_that_comes_to_the_front_is_scrolled_into_sight() {
        let mut window = window();
        for panel in Panel::tiles().into_iter().filter(|panel| panel.is_tool() && Task::of(*panel).is_none()) {
            window.state_mut().set_open(panel, true);
        }
        window.run_steps(3);
        for (panel, title) in [(Panel::Phasors, "Phasors"), (Panel::Roc, "ROC"), (Panel::Chirp, "Waveform")] {
            window.state_mut().set_open(panel, true);
            window.run_steps(4);
            assert!(whole(&window, title), "{title}: {:?}", seen::texts(window.output()));
        }
        assert!(window.query_all_by_label("Scroll tabs left").count() > 0);
    }
}
