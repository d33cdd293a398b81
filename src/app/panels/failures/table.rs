//! The table: of any number of rows only those in sight are drawn.

use super::cells;
use super::order::Sort;
use crate::app::jobs::{Album, RowTable, THUMBNAIL_HEIGHT, THUMBNAIL_WIDTH, Thumbnail};
use crate::app::widgets::list_rows::{Window, bring_in_sight, colour_behind, focus_after_click};
use crate::app::widgets::textures::{Texture, colour_table};
use crate::evaluate::rows::{Column, Row};
use crate::picture::ColourMap;
use eframe::egui;
use eframe::egui::{
    Align2, Color32, ColorImage, EventFilter, FontId, Id, Key, Modifiers, Rect, Response, ScrollArea, Sense, Stroke,
    TextureOptions, Ui, Vec2, pos2, vec2,
};
use std::collections::HashMap;
use std::sync::Arc;

/// What is listed.
pub struct Input<'a> {
    /// Every row.
    pub table: &'a RowTable,
    /// Their small maps.
    pub album: &'a Album,
    /// Indices of those that are listed, from top to bottom.
    pub shown: &'a [usize],
    /// How they are sorted.
    pub sort: Option<Sort>,
    /// The row that was opened last.
    pub opened: Option<usize>,
    /// Colours of Lambda.
    pub colours: ColourMap,
}

/// What was asked of the table.
#[derive(Default)]
pub struct Answer {
    /// The row to open.
    pub open: Option<usize>,
    /// The column whose title was clicked.
    pub sort: Option<Column>,
    /// Rows in sight, from top to bottom.
    pub in_sight: Vec<usize>,
}

/// A picture of a row's maps, the target below the output.
struct Picture {
    of: Arc<Thumbnail>,
    colours: ColourMap,
    image: Arc<ColorImage>,
    texture: Texture,
}

/// What the table remembers from frame to frame.
#[derive(Default)]
pub struct Memory {
    /// Pictures of the rows in sight.
    pictures: HashMap<(u64, usize), Picture>,
    /// The row that was opened last, when it was last drawn.
    latest: Option<usize>,
    /// Whether the rows have less room than before, so that the opened one may have gone out of sight.
    is_crowded_out: bool,
    /// Whether the opened row was in sight.
    is_opened_in_sight: bool,
    /// Whether a row was clicked, so that the rows are to have the keys.
    was_clicked: bool,
    /// What of the rows is in sight.
    window: Window,
}

impl Memory {
    /// Pictures on the graphics card.
    #[cfg(test)]
    pub fn pictures(&self) -> usize {
        self.pictures.len()
    }
}

const ROW: f32 = 40.0;
const TITLE: f32 = 34.0;
/// Size of a small map on screen.
const MAP: Vec2 = vec2(72.0, 36.0);
/// Width of both.
const MAPS: f32 = 2.0 * MAP.x + 12.0;

/// Draws it.
pub fn show(ui: &mut Ui, input: &Input<'_>, memory: &mut Memory) -> Answer {
    let mut answer = Answer::default();
    // Not by its place: what is told of an opened row comes before it, and the focus must stay.
    let id = Id::unique("rows of failures");
    let list = ui.interact(ui.available_rect_before_wrap(), id, Sense::focusable_noninteractive());
    list.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ListBox, true, "Rows"));
    focus_after_click(&list, &mut memory.was_clicked);
    if list.has_focus() {
        answer.open = keys(ui, &list, input, memory.window.room);
    }
    let mut area = ScrollArea::both().auto_shrink([false, false]);
    // A row that is opened comes into sight, and stays there when what is told of it takes some of the room.
    if (input.opened != memory.latest || memory.is_crowded_out)
        && let Some(at) = input.opened.and_then(|row| input.shown.iter().position(|shown| *shown == row))
    {
        area = bring_in_sight(area, at, ROW, memory.window);
    }
    memory.latest = input.opened;
    let width = MAPS + Column::FIGURES.iter().map(|column| cells::width(*column)).sum::<f32>();
    let output = area.show_viewport(ui, |ui, viewport| {
        let size = vec2(width, TITLE + ROW * input.shown.len() as f32);
        ui.set_min_size(size);
        let origin = ui.max_rect().min;
        let first = (viewport.top() / ROW).max(0.0) as usize;
        let last = ((viewport.bottom() - TITLE) / ROW).max(0.0).ceil() as usize;
        let range = first.min(input.shown.len())..last.min(input.shown.len());
        for at in range.clone() {
            let top = pos2(origin.x, origin.y + TITLE + ROW * at as f32);
            let rect = Rect::from_min_size(top, vec2(width.max(viewport.width()), ROW));
            if row(ui, input, at, rect, memory) {
                memory.was_clicked = true;
                answer.open = Some(input.shown[at]);
            }
        }
        answer.in_sight = input.shown[range].to_vec();
        let titles = pos2(origin.x, origin.y + viewport.top());
        let titles = Rect::from_min_size(titles, vec2(width.max(viewport.width()), TITLE));
        answer.sort = self::titles(ui, input.sort, titles);
    });
    let window = Window { offset: output.state.clamped_offset().y, room: output.inner_rect.height() - TITLE };
    memory.is_crowded_out = window.room < memory.window.room && memory.is_opened_in_sight;
    memory.is_opened_in_sight = input.opened.is_some_and(|row| answer.in_sight.contains(&row));
    memory.window = window;
    let generation = input.table.generation();
    memory.pictures.retain(|(table, row), _| *table == generation && answer.in_sight.contains(row));
    answer
}

/// Arrow keys, Page Up and Down, Home and End walk through the rows.
fn keys(ui: &Ui, list: &Response, input: &Input<'_>, room: f32) -> Option<usize> {
    let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|m| m.set_focus_lock_filter(list.id, filter));
    let page = ((room / ROW) as isize).max(1);
    let (by, end) = ui.input_mut(|i| {
        let mut times = |key| i.count_and_consume_key(Modifiers::NONE, key) as isize;
        let lines = times(Key::ArrowDown) - times(Key::ArrowUp);
        let pages = times(Key::PageDown) - times(Key::PageUp);
        (lines + page * pages, times(Key::End) - times(Key::Home))
    });
    let last = input.shown.len().checked_sub(1)?;
    let now = input.opened.and_then(|row| input.shown.iter().position(|shown| *shown == row));
    let to = match (end.signum(), now) {
        (1, _) => last,
        (-1, _) => 0,
        _ if by == 0 => return None,
        (_, Some(now)) => now.saturating_add_signed(by).min(last),
        (_, None) => {
            if by > 0 {
                0
            } else {
                last
            }
        }
    };
    (Some(to) != now).then(|| input.shown[to])
}

/// Draws a row; whether it was clicked.
fn row(ui: &Ui, input: &Input<'_>, at: usize, rect: Rect, memory: &mut Memory) -> bool {
    let index = input.shown[at];
    let Some(row) = input.table.rows().get(index) else { return false };
    // What of it can be seen, and so clicked in its middle.
    let response = ui.interact(rect.intersect(ui.clip_rect()), ui.scope_id().with(("row", at)), Sense::CLICK);
    let selected = input.opened == Some(index);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::ListBoxOption, true, selected, cells::name(row)));
    let visuals = ui.visuals();
    let striped = (at % 2 == 1).then_some(visuals.faint_bg_color);
    if let Some(colour) = colour_behind(visuals, &response, selected).or(striped) {
        ui.painter().rect_filled(rect, 0.0, colour);
    }
    let problem = maps(ui, input, index, row, rect, memory);
    figures(ui, row, rect);
    let clicked = response.clicked();
    if let Some(problem) = problem {
        response.on_hover_text(format!("No small maps: {problem}"));
    }
    clicked
}

fn figures(ui: &Ui, row: &Row, rect: Rect) {
    let ink = ui.visuals().text_color();
    let mut x = rect.left() + MAPS;
    for &column in Column::FIGURES {
        let (from, to) = (x, x + cells::width(column));
        x = to;
        let cell = Rect::from_min_max(pos2(from, rect.top()), pos2(to, rect.bottom()));
        if !ui.is_rect_visible(cell) {
            continue;
        }
        let (place, align) = match cells::is_number(column) {
            true => (pos2(to - 8.0, rect.center().y), Align2::RIGHT_CENTER),
            false => (pos2(from + 4.0, rect.center().y), Align2::LEFT_CENTER),
        };
        let painter = ui.painter().with_clip_rect(cell.intersect(ui.clip_rect()));
        painter.text(place, align, cells::text(row, column), FontId::proportional(12.5), ink);
    }
}

/// Draws target and output of a row; why it can't.
fn maps(ui: &Ui, input: &Input<'_>, index: usize, row: &Row, rect: Rect, memory: &mut Memory) -> Option<String> {
    let generation = input.table.generation();
    let made = input.album.get(generation, row);
    let places = [0.0, MAP.x + 4.0].map(|x| Rect::from_min_size(rect.min + vec2(4.0 + x, 2.0), MAP));
    let Some(Ok(thumbnail)) = made else {
        for place in places {
            ui.painter().rect_filled(place, 0.0, ui.visuals().extreme_bg_color);
        }
        return made.and_then(Result::err);
    };
    let key = (generation, index);
    let same = |p: &Picture| Arc::ptr_eq(&p.of, &thumbnail) && p.colours == input.colours;
    if !memory.pictures.get(&key).is_some_and(same) {
        let image = Arc::new(picture(&thumbnail, input.colours));
        let texture = memory.pictures.remove(&key).map(|p| p.texture).unwrap_or_default();
        memory.pictures.insert(key, Picture { of: thumbnail, colours: input.colours, image, texture });
    }
    let picture = memory.pictures.get_mut(&key)?;
    let texture = picture.texture.of(ui.ctx(), "small maps", &picture.image, TextureOptions::LINEAR);
    // Row 0 is range 0, which hangs lowest.
    for (place, low) in places.into_iter().zip([0.0, 0.5]) {
        let uv = Rect::from_min_max(pos2(0.0, low + 0.5), pos2(1.0, low));
        ui.painter().image(texture, place, uv, Color32::WHITE);
    }
    None
}

fn picture(thumbnail: &Thumbnail, colours: ColourMap) -> ColorImage {
    let table = colour_table(colours);
    let bytes = thumbnail.target.iter().chain(thumbnail.output.iter());
    let pixels = bytes.map(|byte| table[usize::from(*byte)]).collect();
    ColorImage::new([THUMBNAIL_WIDTH, 2 * THUMBNAIL_HEIGHT], pixels)
}

/// Draws the titles over the rows; the column that was clicked.
fn titles(ui: &Ui, sort: Option<Sort>, rect: Rect) -> Option<Column> {
    let visuals = ui.visuals();
    ui.painter().rect_filled(rect, 0.0, visuals.panel_fill);
    let ink = visuals.weak_text_color();
    for (x, name) in [(4.0, "target"), (MAP.x + 8.0, "output")] {
        let place = pos2(rect.left() + x, rect.center().y);
        ui.painter().text(place, Align2::LEFT_CENTER, name, FontId::proportional(11.5), ink);
    }
    let mut clicked = None;
    let mut x = rect.left() + MAPS;
    for &column in Column::FIGURES {
        let (from, to) = (x, x + cells::width(column));
        x = to;
        let cell = Rect::from_min_max(pos2(from, rect.top()), pos2(to, rect.bottom()));
        let sorted = sort.filter(|sort| sort.column == column);
        if title(ui, column, sorted, cell) {
            clicked = Some(column);
        }
    }
    ui.painter().hline(rect.x_range(), rect.bottom(), Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color));
    clicked
}

/// Draws a column's title with a triangle that says how it is sorted; whether it was clicked.
fn title(ui: &Ui, column: Column, sorted: Option<Sort>, cell: Rect) -> bool {
    let response = ui.interact(cell, ui.scope_id().with(("title", column)), Sense::CLICK);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ColumnHeader, true, cells::heading(column)));
    if !ui.is_rect_visible(cell) {
        return false;
    }
    let visuals = ui.visuals();
    let strong = sorted.is_some() || response.hovered();
    let ink = if strong { visuals.strong_text_color() } else { visuals.weak_text_color() };
    let lines = cells::title(column);
    let lines = lines.join("\n").trim_end().to_owned();
    let galley = ui.painter().layout_no_wrap(lines, FontId::proportional(11.5), ink);
    // Beside the triangle.
    let free = cell.width() - galley.size().x - 10.0;
    let left = if cells::is_number(column) { cell.left() + free.max(0.0) } else { cell.left() + 4.0 };
    let at = pos2(left, cell.center().y - galley.size().y / 2.0);
    let painter = ui.painter().with_clip_rect(cell.intersect(ui.clip_rect()));
    painter.galley(at, galley, ink);
    if let Some(sort) = sorted {
        let (middle, up) = (pos2(cell.right() - 5.0, cell.center().y), if sort.descending { 1.0 } else { -1.0 });
        let points = [vec2(-3.5, -2.5 * up), vec2(3.5, -2.5 * up), vec2(0.0, 3.5 * up)].map(|by| middle + by);
        ui.painter().add(egui::Shape::convex_polygon(points.to_vec(), ink, Stroke::NONE));
    }
    let clicked = response.clicked();
    response.on_hover_text(format!("Click to sort. Filters and files call it {}", column.name()));
    clicked
}
