//! Rules that separate the bad rows from the others, each a filter that a click applies.

use crate::app::jobs::RowTable;
use crate::app::widgets::labelled;
use crate::evaluate::rows::Row;
use crate::evaluate::statistics::{SharedTrait, USUALLY_BAD, rules};
use crate::platform::Instant;
use crate::radar::counted;
use eframe::egui::{Label, RichText, ScrollArea, TextEdit, Ui};
use std::time::Duration;

/// Interval at which rules are looked for while rows arrive.
const RULES_INTERVAL: Duration = Duration::from_secs(2);

/// Most rows in which rules are looked for; of more, evenly chosen scenes are taken, so that no frame waits.
const MOST_ROWS: usize = 20_000;

/// The typed filter of bad rows, and the rules that were found.
pub struct SharedRulesMemory {
    bad: String,
    of: Option<(u64, String)>,
    when: Option<Instant>,
    found: Option<Result<SharedTrait, String>>,
}

impl Default for SharedRulesMemory {
    fn default() -> Self {
        SharedRulesMemory { bad: USUALLY_BAD.to_owned(), of: None, when: None, found: None }
    }
}

impl SharedRulesMemory {
    /// Looks for rules, if the rows or the filter of bad ones changed.
    fn update(&mut self, ui: &Ui, table: &RowTable) {
        let key = (table.version(), self.bad.clone());
        if self.of.as_ref() == Some(&key) {
            return;
        }
        let only_rows = self.of.as_ref().is_some_and(|(_, bad)| *bad == self.bad);
        if let Some(wait) = self.when.filter(|_| only_rows).and_then(|when| RULES_INTERVAL.checked_sub(when.elapsed()))
        {
            ui.request_repaint_after(wait);
            return;
        }
        self.found = Some(rules(&chosen(table.rows()), &self.bad).map_err(|error| error.to_string()));
        (self.of, self.when) = (Some(key), Some(Instant::now()));
    }
}

/// All rows, or those of evenly chosen scenes where there are more than [`MOST_ROWS`].
fn chosen(rows: &[Row]) -> Vec<Row> {
    let every = rows.len().div_ceil(MOST_ROWS).max(1) as u32;
    // Scenes are taken in pairs, so that half of them have even numbers.
    rows.iter().filter(|row| (row.index / 2).is_multiple_of(every)).cloned().collect()
}

/// Draws the field of bad rows and the rules. Returns the filter of a clicked rule.
pub fn show(ui: &mut Ui, table: &RowTable, memory: &mut SharedRulesMemory) -> Option<String> {
    ui.horizontal(|ui| {
        let tip = "A filter: which rows are bad. Rules speak of what is known before a method answers.";
        let edit = TextEdit::singleline(&mut memory.bad).desired_width(f32::INFINITY);
        labelled(ui, "Bad is", tip, edit);
    });
    memory.update(ui, table);
    let shared = match memory.found.as_ref()? {
        Err(error) => {
            ui.add(Label::new(RichText::new(error).color(ui.visuals().error_fg_color)).wrap());
            return None;
        }
        Ok(shared) => shared,
    };
    ui.weak(found(shared));
    let mut applied = None;
    ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
        for rule in &shared.rules {
            ui.horizontal_wrapped(|ui| {
                if ui.button(&rule.text).on_hover_text("Show the rows that this is true of").clicked() {
                    applied = Some(rule.text.clone());
                }
                ui.label(rule.told());
            });
        }
    });
    applied
}

/// Sentences on the search for rules and its result.
fn found(shared: &SharedTrait) -> String {
    let SharedTrait { bad, rows, rules, tried } = shared;
    let of = format!("{bad} of {} are bad.", counted(*rows, "row", "rows"));
    let how = "Scenes of even number suggest a rule, those of odd number test it.";
    match (rules.as_slice(), tried) {
        ([], 0) => format!("{of} {how} No rule was suggested."),
        ([], _) => format!("{of} {how} {} suggested, none held.", counted(*tried, "rule was", "rules were")),
        (rules, tried) => {
            format!("{of} {how} {} of {tried} held (at most 5 % of those shown are chance):", rules.len())
        }
    }
}
