//! The table of rows, of any number: only rows in sight are drawn.

use super::cells;
use super::input::Input;
use super::order::Sort;
use crate::app::jobs::{THUMBNAIL_HEIGHT, THUMBNAIL_WIDTH, Thumbnail};
use crate::app::widgets::{Texture, colour_table, focus_after_click, list_keys};
use crate::evaluate::rows::Column;
use crate::picture::ColourMap;
use eframe::egui::{
    self, Align, Color32, ColorImage, FontId, Id, Label, Layout, Modifiers, Rect, RichText, ScrollArea, Sense, Stroke,
    TextureOptions, Ui, Vec2, pos2, vec2,
};
use egui_extras::{Column as TableColumn, TableBuilder, TableRow};
use std::collections::HashMap;
use std::sync::Arc;

/// A picture of a row's maps, the target below the output.
pub struct Picture {
    of: Arc<Thumbnail>,
    colours: ColourMap,
    image: Arc<ColorImage>,
    texture: Texture,
}

#[derive(Default)]
pub struct TableMemory {
    pub pictures: HashMap<(u64, usize), Picture>,
    /// Indices of the rows in sight, from top to bottom.
    pub in_sight: Vec<usize>,
    /// The row that was opened last, at the last drawing.
    latest: Option<usize>,
    /// Whether a row was clicked, so that the table takes the keyboard focus.
    was_clicked: bool,
    /// Heights of the table and of the area of its rows, points.
    room: [f32; 2],
}

const ROW_HEIGHT_POINTS: f32 = 40.0;
const TITLE_HEIGHT_POINTS: f32 = 34.0;
/// Size of a small map on screen.
const MAP_SIZE_POINTS: Vec2 = vec2(72.0, 36.0);

/// Draws the rows whose indices are in `shown`. A click on a title sorts them. Returns the row to open.
pub fn show(
    ui: &mut Ui,
    input: &Input<'_>,
    shown: &[usize],
    sort: &mut Option<Sort>,
    memory: &mut TableMemory,
) -> Option<usize> {
    let (mut open, opened) = (None, input.opened());
    // An id that doesn't depend on the place: the figures of an opened row come before it, and the focus must stay.
    let id = Id::unique("rows of failures");
    let list = ui.interact(ui.available_rect_before_wrap(), id, Sense::focusable_noninteractive());
    list.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ListBox, true, "Rows"));
    focus_after_click(&list, &mut memory.was_clicked);
    if list.has_focus() {
        let now = opened.and_then(|row| shown.iter().position(|shown| *shown == row));
        let page = ((memory.room[1] / ROW_HEIGHT_POINTS) as usize).max(1);
        open = list_keys(&list, Modifiers::NONE, now, shown.len(), page)
            .map(|to| shown[to])
            .filter(|row| opened != Some(*row));
    }
    let height = ui.available_height();
    // An opened row is scrolled into sight, and stays there when its figures take some of the room.
    let was_in_sight = memory.latest.is_some_and(|row| memory.in_sight.contains(&row));
    let is_crowded_out = height < memory.room[0] && was_in_sight;
    let wanted = opened.filter(|_| opened != memory.latest || is_crowded_out);
    let scroll_to = wanted.and_then(|row| shown.iter().position(|shown| *shown == row));
    memory.latest = opened;
    memory.in_sight.clear();
    let output = ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = Vec2::ZERO;
        let of_maps = [MAP_SIZE_POINTS.x + 4.0; 2].into_iter();
        let widths = of_maps.chain(Column::FIGURES.iter().map(|column| cells::width(*column)));
        let mut table = widths.fold(TableBuilder::new(ui), |t, width| t.column(TableColumn::exact(width).clip(true)));
        table = table.striped(true).sense(Sense::CLICK).auto_shrink(false).min_scrolled_height(0.0);
        table = table.cell_layout(Layout::left_to_right(Align::Center)).animate_scrolling(false);
        if let Some(row) = scroll_to {
            table = table.scroll_to_row(row, None);
        }
        let table = table.header(TITLE_HEIGHT_POINTS, |mut row| titles(&mut row, sort));
        table.body(|body| {
            body.rows(ROW_HEIGHT_POINTS, shown.len(), |mut drawn| {
                let index = shown[drawn.index()];
                memory.in_sight.push(index);
                if row(&mut drawn, input, index, memory) {
                    memory.was_clicked = true;
                    open = Some(index);
                }
            });
        })
    });
    memory.room = [height, output.inner.inner_rect.height()];
    let TableMemory { pictures, in_sight, .. } = memory;
    let generation = input.job.table.generation();
    pictures.retain(|(table, row), _| *table == generation && in_sight.contains(row));
    open
}

/// Draws a row. Returns whether it was clicked.
fn row(drawn: &mut TableRow<'_, '_>, input: &Input<'_>, index: usize, memory: &mut TableMemory) -> bool {
    let Some(row) = input.job.table.rows().get(index) else { return false };
    let is_selected = input.opened() == Some(index);
    drawn.set_selected(is_selected);
    let made = texture(drawn, input, index, memory);
    for &column in Column::FIGURES {
        let text = RichText::new(cells::text(row, column)).size(12.5);
        drawn.col(|ui| {
            let layout = match cells::is_number(column) {
                true => Layout::right_to_left(Align::Center),
                false => Layout::left_to_right(Align::Center),
            };
            ui.with_layout(layout, |ui| {
                ui.add_space(6.0);
                ui.add(Label::new(text).selectable(false));
            });
        });
    }
    let mut response = drawn.response();
    // A screen reader gets the part in sight: a row may be wider than the panel.
    response.rect = response.interact_rect;
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::ListBoxOption, true, is_selected, cells::name(row)));
    let is_clicked = response.clicked();
    if let Err(problem) = made {
        response.on_hover_text(format!("No small maps: {problem}"));
    }
    is_clicked
}

/// Draws the small maps of target and output into two cells. Returns the reason where there are none.
fn texture(
    drawn: &mut TableRow<'_, '_>,
    input: &Input<'_>,
    index: usize,
    memory: &mut TableMemory,
) -> Result<(), String> {
    let (generation, colours) = (input.job.table.generation(), input.state.settings.colours);
    let made = input.job.thumbnails.album.get(generation, &input.job.table.rows()[index]);
    let key = (generation, index);
    if let Some(Ok(thumbnail)) = &made {
        let same = |p: &Picture| Arc::ptr_eq(&p.of, thumbnail) && p.colours == colours;
        if !memory.pictures.get(&key).is_some_and(same) {
            let image = Arc::new(picture(thumbnail, colours));
            let texture = memory.pictures.remove(&key).map(|p| p.texture).unwrap_or_default();
            let of = thumbnail.clone();
            memory.pictures.insert(key, Picture { of, colours, image, texture });
        }
    }
    let mut picture = memory.pictures.get_mut(&key).filter(|_| matches!(made, Some(Ok(_))));
    // Row 0 of the picture is range 0, at the lower end.
    for low in [0.0, 0.5] {
        drawn.col(|ui| {
            let place = Rect::from_center_size(ui.max_rect().center(), MAP_SIZE_POINTS);
            match &mut picture {
                Some(Picture { texture, image, .. }) => {
                    let texture = texture.of(ui.ctx(), "small maps", image, TextureOptions::LINEAR);
                    let uv = Rect::from_min_max(pos2(0.0, low + 0.5), pos2(1.0, low));
                    ui.painter().image(texture, place, uv, Color32::WHITE);
                }
                None => _ = ui.painter().rect_filled(place, 0.0, ui.visuals().extreme_bg_color),
            }
        });
    }
    match made {
        Some(Err(problem)) => Err(problem),
        _ => Ok(()),
    }
}

fn picture(thumbnail: &Thumbnail, colours: ColourMap) -> ColorImage {
    let table = colour_table(colours);
    let bytes = thumbnail.target.iter().chain(thumbnail.output.iter());
    let pixels = bytes.map(|byte| table[usize::from(*byte)]).collect();
    ColorImage::new([THUMBNAIL_WIDTH, 2 * THUMBNAIL_HEIGHT], pixels)
}

/// Draws the titles over the rows. A click on one changes how they are sorted.
fn titles(drawn: &mut TableRow<'_, '_>, sort: &mut Option<Sort>) {
    for name in ["target", "output"] {
        drawn.col(|ui| {
            ui.add_space(4.0);
            ui.add(Label::new(RichText::new(name).size(11.5).weak()).selectable(false));
        });
    }
    for &column in Column::FIGURES {
        let sorted = sort.filter(|sort| sort.column == column);
        let (_, response) = drawn.col(|ui| title(ui, column, sorted));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ColumnHeader, true, cells::heading(column)));
        if response.clicked() {
            *sort = Sort::clicked(*sort, column);
            response.ctx.request_repaint();
        }
        response.on_hover_text(format!("Click to sort. Filters and files call it {}", column.name()));
    }
}

fn title(ui: &mut Ui, column: Column, sorted: Option<Sort>) {
    let (visuals, cell) = (ui.visuals(), ui.max_rect());
    let ink = if sorted.is_some() { visuals.strong_text_color() } else { visuals.weak_text_color() };
    let galley = ui.painter().layout_no_wrap(cells::title(column), FontId::proportional(11.5), ink);
    // Room beside the triangle.
    let free = cell.width() - galley.size().x - 10.0;
    let left = if cells::is_number(column) { cell.left() + free.max(0.0) } else { cell.left() + 4.0 };
    ui.painter().galley(pos2(left, cell.center().y - galley.size().y / 2.0), galley, ink);
    if let Some(sort) = sorted {
        let (middle, up) = (pos2(cell.right() - 5.0, cell.center().y), if sort.descending { 1.0 } else { -1.0 });
        let points = [vec2(-3.5, -2.5 * up), vec2(3.5, -2.5 * up), vec2(0.0, 3.5 * up)].map(|by| middle + by);
        ui.painter().add(egui::Shape::convex_polygon(points.to_vec(), ink, Stroke::NONE));
    }
}
