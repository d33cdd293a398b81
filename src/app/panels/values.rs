//! The values panel: the value of every map under the pointer, in one small table.

use super::map::{Cells, cells, is_updating};
use crate::app::content::{Content, Cx};
use crate::app::jobs::Want;
use crate::app::state::{Command, MapKind, MethodSlot, Panel, State};
use crate::app::widgets::{CONVENTION, direction, headings, padded, right_aligned};
use eframe::egui::{Grid, RichText, ScrollArea, Ui};

/// The maps that are listed, from the inputs to the differences.
pub const LISTED_MAPS: [MapKind; 9] = {
    use MapKind::*;
    [Input0, Input1, Target, Output, Second, Difference, Doubt, SecondDifference, Unexplained]
};

const COLUMN_HEADINGS: [(&str, &str); 3] = [
    ("map", "Every map there is; those of the second method while the panel Compare is in sight"),
    ("Λ", "Normalised magnitude, 0 to 1; of a difference with its sign"),
    (
        "dB",
        "Decibels relative to the map's peak; of a difference the decibels between both. ≤: at the floor of the scale, or \
         lower than any receiver hears",
    ),
];

/// A map whose values are listed.
pub struct Row<'a> {
    pub kind: MapKind,
    /// The method that made the map, if one did.
    pub method: Option<&'static str>,
    pub cells: Cells<'a>,
    /// Whether the map is of an earlier scene or of another method.
    pub updating: bool,
}

pub const PANEL: Content =
    Content { wants: &[Want::Output, Want::EveryMap], tells_answers: true, ..Content::drawn(draw) };

fn draw(ui: &mut Ui, cx: Cx<'_>) -> Vec<Command> {
    let (state, jobs) = (&*cx.state, cx.jobs);
    let compares = state.arrangement.shown().contains(&Panel::Compare);
    let listed = |kind: &MapKind| compares || kind.slot() != Some(MethodSlot::Second);
    let row = |kind: MapKind| {
        let method = kind.slot().and_then(|slot| jobs.pipeline.method(slot).output()).map(|o| o.method());
        let cells = cells(jobs, kind)?;
        Some(Row { kind, method, cells, updating: is_updating(jobs, kind) })
    };
    let rows: Vec<Row<'_>> = LISTED_MAPS.into_iter().filter(listed).filter_map(row).collect();
    show(ui, state, &rows)
}

pub fn show(ui: &mut Ui, state: &State, rows: &[Row<'_>]) -> Vec<Command> {
    padded(ui, |ui, _| {
        let cursor = state.cut_cursor();
        let Some((bin, column)) = cursor.cell(state.radar()) else { return };
        let (range, way) = (cursor.range_metres, direction(cursor.cos_theta, 1));
        ui.label(format!("range {range:.2} m · {way}")).on_hover_text(CONVENTION);
        ui.weak(format!("range bin {bin}, column {column}"));
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("values").num_columns(3).striped(true).spacing([18.0, 3.0]).show(ui, |ui| {
                headings(ui, COLUMN_HEADINGS);
                rows.iter().for_each(|row| line(ui, row, bin, column));
            });
        });
    })
}

fn line(ui: &mut Ui, row: &Row<'_>, bin: usize, column: usize) {
    let (lambda, decibels) = row.cells.texts(bin, column).unzip();
    let method = row.method.map_or_else(String::new, |method| format!(" ({method})"));
    let updating = if row.updating { ", updating" } else { "" };
    ui.label(format!("{}{method}{updating}", row.kind.title())).on_hover_text(row.kind.describe());
    let text = |text: Option<String>| {
        let text = RichText::new(text.as_deref().unwrap_or("–")).monospace();
        if row.updating { text.weak() } else { text }
    };
    right_aligned(ui, |ui| ui.label(text(lambda)));
    // The last column takes all the room that is left: nothing is aligned to its end.
    ui.label(text(decibels.flatten()));
    ui.end_row();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::Cursor;
    use crate::app::widgets::seen::{self, Harness};
    use crate::maps::{LambdaScale, RangeAngleMap};
    use crate::radar::Radar;
    use ndarray::Array2;

    fn panel(cursor: Cursor) -> Harness<'static> {
        let mut state = State::new(Vec::new());
        state.pointer.hover(cursor);
        state.pointer.turn(&Radar::default());
        let map = |value: f32| RangeAngleMap { lambda: Array2::from_elem((512, 1024), value) };
        let mut maps = [map(0.25), map(0.5), map(1.0)];
        maps[0].lambda[[100, 700]] = 0.75;
        let draw = move |ui: &mut Ui| {
            let scale = Some(LambdaScale { peak: 5.0, floor: 0.0 });
            let cells =
                |of: usize, minus: Option<usize>| Cells { map: &maps[of], minus: minus.map(|m| &maps[m]), scale };
            let row = |kind, method, cells, updating| Row { kind, method, cells, updating };
            let rows = [
                row(MapKind::Input0, None, cells(0, None), false),
                row(MapKind::Target, None, cells(2, None), false),
                row(MapKind::Second, Some("capon"), cells(1, None), true),
                row(MapKind::SecondDifference, Some("capon"), cells(1, Some(2)), false),
            ];
            assert!(show(ui, &state, &rows).is_empty());
        };
        let mut panel = Harness::builder().with_size([360.0, 220.0]).build_ui(draw);
        panel.run();
        panel
    }

    #[test]
    fn every_map_tells_what_it_has_under_the_pointer() {
        let cursor = Cursor::at_cell(&Radar::default(), 100.0, 700.0);
        let shown = panel(cursor);
        let place = format!("range {:.2} m · {}", cursor.range_metres, direction(cursor.cos_theta, 1));
        let first = [&place, "range bin 100, column 700", "Input 0", "0.750", "−25.0", "Target", "1.000", "0.0"];
        let second = ["Second output (capon), updating", "0.500", "−50.0", "Second difference (capon)", "−0.500"];
        seen::assert_reads(shown.output(), &first);
        seen::assert_reads(shown.output(), &second);
        seen::assert_readable(shown.output());
    }
}
