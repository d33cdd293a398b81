//! Histogram and scatter plot of the rows; a box selects rows, a click opens one.

use super::cells::heading;
use super::input::Input;
use super::order::{Boxed, Order};
use super::points::{Dot, GROUP_COLUMNS, Points, Subject};
use crate::app::jobs::{Memo, RowTable};
use crate::app::shared::Shared;
use crate::app::widgets::legend::{self, Entry, Sign};
use crate::app::widgets::{Axis, Chart, Drawn, Inks, choice, empty_text};
use crate::evaluate::rows::Column;
use eframe::egui::{Color32, Mesh, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, Vec2};
use egui_plot::{Bar, BarChart, LineStyle, Span};
use std::collections::HashSet;

/// The chart to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum View {
    /// No chart: the table has all the room.
    #[default]
    None,
    Histogram,
    Columns,
    Methods,
}

impl View {
    const ALL: [(View, &'static str, &'static str); 4] = [
        (View::None, "Table", "The table alone"),
        (View::Histogram, "Histogram", "Rows counted by their figure in a column"),
        (View::Columns, "Scatter", "One column against another"),
        (View::Methods, "A against B", "One column for one method against the same for another, scene by scene"),
    ];
}

pub struct ChartsMemory {
    pub view: View,
    x: Column,
    y: Column,
    methods: [String; 2],
    grouping: Column,
    made: Memo<PointsKey, Points>,
    start: Option<Pos2>,
}

impl Default for ChartsMemory {
    fn default() -> Self {
        let (x, y, grouping) = (Column::NearestPairColumns, Column::SquaredError, Column::Method);
        let (view, methods, made) = Default::default();
        ChartsMemory { view, x, y, methods, grouping, made, start: None }
    }
}

/// The values on which the charted points depend: stamp of the order, chart, grouping.
type PointsKey = (u64, Subject, Column);

/// Number of dots below which they are drawn larger.
const MAX_LARGE_DOTS: usize = 500;

/// Largest distance of a click from a dot, points.
const DOT_REACH_POINTS: f32 = 10.0;

/// Draws the choice of the chart, its columns and its methods.
pub fn choices(ui: &mut Ui, table: &RowTable, memory: &mut ChartsMemory) {
    for (view, name, tip) in View::ALL {
        ui.selectable_value(&mut memory.view, view, name).on_hover_text(tip);
    }
    let column = |ui: &mut Ui, name: &str, column: &mut Column| {
        choice(ui, name, "", column, Column::FIGURES.iter().copied(), |column| (heading(*column), ""));
    };
    if matches!(memory.view, View::Histogram | View::Columns) {
        choice(ui, "Colour", "", &mut memory.grouping, GROUP_COLUMNS, |column| (heading(*column), ""));
    }
    match memory.view {
        View::None => {}
        View::Histogram => column(ui, "of", &mut memory.y),
        View::Columns => {
            column(ui, "of", &mut memory.y);
            column(ui, "over", &mut memory.x);
        }
        View::Methods => {
            column(ui, "of", &mut memory.y);
            let mut names = table.methods().iter();
            for (chosen, name) in memory.methods.iter_mut().zip(["A", "B"]) {
                let other = names.next();
                if !table.methods().contains(chosen) {
                    *chosen = other.cloned().unwrap_or_default();
                }
                choice(ui, name, "", chosen, table.methods().iter().cloned(), |name| (name.clone(), ""));
            }
        }
    }
}

fn groups(ui: &mut Ui, points: &Points) {
    if points.groups.len() < 2 {
        return;
    }
    let colour = |group| colour_of(ui, group, points.groups.len());
    let groups = points.groups.iter().enumerate();
    let entries: Vec<Entry> =
        groups.map(|(group, name)| (Sign::Square { filled: true }, colour(group), name.clone())).collect();
    legend::row(ui, &entries);
}

/// Draws the chart that was chosen. Returns the row to open, and the rows in a box that the user drew.
pub fn show(
    ui: &mut Ui,
    input: &Input<'_>,
    order: &Order,
    boxed: Option<&Boxed>,
    memory: &mut ChartsMemory,
) -> (Option<usize>, Option<Boxed>) {
    let Some((subject, titles)) = subject(memory) else { return (None, None) };
    let (table, opened) = (&input.job.table, input.opened());
    // The dot of a scene tried by two methods has the colour of the scene's set.
    let grouping = if memory.view == View::Methods { Column::Set } else { memory.grouping };
    let points = &*memory.made.of((order.stamp, subject, grouping), |(_, subject, grouping)| {
        Points::of(table, &order.filtered, subject, *grouping)
    });
    if let Some(told) = &points.told {
        ui.label(told);
    }
    groups(ui, points);
    let area = ui.available_rect_before_wrap();
    ui.allocate_rect(area, Sense::hover());
    if points.dots.is_empty() {
        empty_text(ui, area, "No row has these figures.");
        return (None, None);
    }
    let [[left, right], [bottom, top]] = points.spans;
    let (x, y) = (Axis::new(left, right, &titles[0]), Axis::new(bottom, top, &titles[1]));
    let mut chart = Chart::new("Chart of rows", x, y);
    bars(ui, &mut chart, points, boxed);
    if memory.view == View::Methods {
        let (low, high) = (left.max(bottom), right.min(top));
        let equal = Stroke::new(1.0, ui.visuals().weak_text_color());
        let ends = [[low, low], [high, high]].into_iter().filter(|_| low < high);
        chart.line(ends, equal, LineStyle::dashed_dense());
    }
    let opened = points.dots.iter().find(|dot| opened.is_some_and(|row| dot.rows.contains(&row)));
    let around = Stroke::new(2.0, ui.visuals().strong_text_color());
    if let Some(dot) = opened.filter(|_| points.bars.is_some()) {
        chart.upright(dot.at[0], around);
    }
    let drawn = chart.show(ui, area, Sense::click_and_drag());
    if points.bars.is_none() {
        dots(ui, &drawn, points, boxed);
        if let Some(dot) = opened {
            drawn.painter.circle_stroke(drawn.at(dot.at), 5.0, around);
        }
    }
    let boxed = rubber_box(ui, &drawn, points, &mut memory.start)
        .map(|rows| Boxed { generation: table.generation(), rows: Shared::new(rows) });
    told(&drawn, points, table);
    (clicked(&drawn, points), boxed)
}

fn subject(memory: &ChartsMemory) -> Option<(Subject, [String; 2])> {
    let (x, y) = (memory.x, memory.y);
    let [a, b] = &memory.methods;
    Some(match memory.view {
        View::None => return None,
        View::Histogram => (Subject::Histogram(y), [heading(y), "rows".to_owned()]),
        View::Columns => (Subject::Columns(x, y), [heading(x), heading(y)]),
        View::Methods => {
            let title = |method: &str| format!("{}, {method}", heading(y));
            (Subject::Methods(y, a.clone(), b.clone()), [title(a), title(b)])
        }
    })
}

/// Colours of groups: those of Okabe and Ito, which differ for the colour-blind, too.
const GROUP_COLOURS: [[u8; 3]; 7] =
    [[86, 180, 233], [230, 159, 0], [0, 158, 115], [204, 121, 167], [213, 94, 0], [0, 114, 178], [240, 228, 66]];

/// The colour of a group; a single group has the usual colour of charts.
fn colour_of(ui: &Ui, group: usize, groups: usize) -> Color32 {
    let [r, g, b] = GROUP_COLOURS[group % GROUP_COLOURS.len()];
    if groups > 1 { Color32::from_rgb(r, g, b) } else { Inks::of(ui.visuals()).ends[0] }
}

fn bars(ui: &Ui, chart: &mut Chart<'_>, points: &Points, boxed: Option<&Boxed>) {
    let Some(bars) = &points.bars else { return };
    let wide = (bars.high - bars.low).max(f64::MIN_POSITIVE) / bars.counts.len() as f64;
    let place = |dot: &Dot| (((dot.at[0] - bars.low) / wide) as usize).min(bars.counts.len() - 1);
    // The bar of each group is stacked on those of the groups before it.
    let mut below = vec![0usize; bars.counts.len()];
    for group in 0..points.groups.len() {
        let colour = colour_of(ui, group, points.groups.len());
        let mut own = vec![0usize; bars.counts.len()];
        points.dots.iter().filter(|dot| dot.group == group).for_each(|dot| own[place(dot)] += 1);
        let bar = |(i, (own, below)): (usize, (&usize, &usize))| {
            let bar = Bar::new(bars.low + wide * (i as f64 + 0.5), *own as f64).width(wide).fill(colour);
            bar.base_offset(*below as f64).stroke(Stroke::NONE)
        };
        let each = own.iter().zip(&below).enumerate().filter(|(_, (own, _))| **own > 0).map(bar);
        chart.add(BarChart::new(points.groups[group].clone(), each.collect()).color(colour));
        below.iter_mut().zip(own).for_each(|(below, own)| *below += own);
    }
    let chosen = points.dots.iter().filter(|dot| boxed.is_some_and(|b| b.rows.contains(&dot.rows[0])));
    let (low, high) =
        chosen.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), dot| (a.min(dot.at[0]), b.max(dot.at[0])));
    if low <= high {
        let ink = Inks::of(ui.visuals()).selected.gamma_multiply(0.25);
        let room = 0.1 * wide;
        chart.add(Span::new("", low - room..=high + room).fill(ink).border_color(ink));
    }
}

fn dots(ui: &Ui, drawn: &Drawn, points: &Points, boxed: Option<&Boxed>) {
    let mut mesh = Mesh::default();
    let size = Vec2::splat(if points.dots.len() < MAX_LARGE_DOTS { 5.0 } else { 3.0 });
    for dot in &points.dots {
        let is_chosen = boxed.is_some_and(|b| dot.rows.iter().any(|row| b.rows.contains(row)));
        let colour = match is_chosen {
            true => Inks::of(ui.visuals()).selected,
            false => colour_of(ui, dot.group, points.groups.len()).gamma_multiply(0.8),
        };
        mesh.add_colored_rect(Rect::from_center_size(drawn.at(dot.at), size), colour);
    }
    drawn.painter.add(mesh);
}

fn nearest(drawn: &Drawn, points: &Points, at: Pos2) -> Option<Dot> {
    let away = |dot: &&Dot| drawn.at(dot.at).distance(at);
    let nearest = points.dots.iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
    (points.bars.is_none() && away(&nearest) <= DOT_REACH_POINTS).then_some(*nearest)
}

fn clicked(drawn: &Drawn, points: &Points) -> Option<usize> {
    let at = drawn.response.interact_pointer_pos().filter(|_| drawn.response.clicked())?;
    nearest(drawn, points, at).map(|dot| dot.rows[0])
}

/// Shows the name of the row under the pointer.
fn told(drawn: &Drawn, points: &Points, table: &RowTable) {
    let at = drawn.response.hover_pos().filter(|_| !drawn.response.dragged());
    let row = at.and_then(|at| nearest(drawn, points, at)).and_then(|dot| table.rows().get(dot.rows[0]));
    if let Some(row) = row {
        drawn.response.clone().on_hover_text_at_pointer(super::cells::name(row));
    }
}

/// Draws the box that is being dragged. Returns the rows in it once it is released. Over a histogram the box is as high as the chart.
fn rubber_box(ui: &Ui, drawn: &Drawn, points: &Points, start: &mut Option<Pos2>) -> Option<HashSet<usize>> {
    let (origin, now) = ui.input(|i| (i.pointer.press_origin(), i.pointer.interact_pos()));
    if drawn.response.drag_started() {
        *start = origin.or(now);
    }
    let (from, now) = ((*start)?, now?);
    let mut drawn_box = Rect::from_two_pos(from, now);
    if points.bars.is_some() {
        drawn_box = Rect::from_x_y_ranges(drawn_box.x_range(), drawn.rect.y_range());
    }
    let ink = Inks::of(ui.visuals()).selected;
    drawn.painter.rect(drawn_box, 0.0, ink.gamma_multiply(0.12), Stroke::new(1.0, ink), StrokeKind::Middle);
    if !drawn.response.drag_stopped() {
        if !drawn.response.dragged() {
            *start = None;
        }
        return None;
    }
    *start = None;
    let inside = points.dots.iter().filter(|dot| drawn_box.expand(1e-3).contains(drawn.at(dot.at)));
    Some(inside.flat_map(|dot| dot.rows).collect())
}
