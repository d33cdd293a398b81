//! What the panels are told that set maps beside each other.

use super::maps::{caption, cells, is_updating, map_input, marked, verdict};
use super::{Contents, offered};
use crate::app::jobs::Jobs;
use crate::app::panels::{compare, values};
use crate::app::state::{Command, MapKind, MethodSlot, Panel, State};
use crate::app::widgets::numbers::percent;
use eframe::egui::Ui;

impl Contents<'_> {
    pub(super) fn compare(&mut self, ui: &mut Ui) -> Vec<Command> {
        let kinds = self.state.settings.compare.maps();
        let textures: Vec<_> = kinds.iter().map(|kind| self.texture(ui, *kind)).collect();
        let projection = self.state.settings.projection;
        let mut view = *self.state.map_views.of(projection);
        let objects = marked(self.state, &mut self.memory.reflectors);
        let (state, jobs) = (&*self.state, self.jobs);
        let map = |(kind, texture): (&MapKind, _)| compare::Titled {
            title: title(state, jobs, *kind),
            map: map_input(state, jobs, objects, texture, *kind),
        };
        let second = jobs.pipeline.method(MethodSlot::Second);
        let input = compare::Input {
            compare: &state.settings.compare,
            methods: offered(state, jobs),
            chosen: MethodSlot::BOTH.map(|slot| state.method_in(slot).map_or("", |m| m.name())),
            maps: kinds.iter().zip(textures).map(map).collect(),
            progress: second.progress(),
        };
        let asked = compare::show(ui, input, &mut view, &mut self.memory.map);
        *self.state.map_views.of(projection) = view;
        asked
    }

    pub(super) fn values(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (state, jobs) = (&*self.state, self.jobs);
        // What is to be predicted is not to be read off a table.
        let hidden = state.is_predicting();
        let compares = state.arrangement.shown().contains(&Panel::Compare);
        let listed = |kind: &MapKind| compares || kind.slot() != Some(MethodSlot::Second);
        let row = |kind: MapKind| {
            let method = kind.slot().and_then(|slot| jobs.pipeline.method(slot).output()).map(|o| o.method);
            let cells = cells(jobs, kind)?;
            Some(values::Row { kind, method, cells, updating: is_updating(jobs, kind) })
        };
        let kinds = values::LISTED.into_iter().filter(listed).filter(|_| !hidden);
        let rows: Vec<values::Row<'_>> = kinds.filter_map(row).collect();
        let input = values::Input { radar: state.radar(), cursor: state.cut_cursor(), rows: &rows, hidden };
        values::show(ui, input)
    }
}

/// What stands above a compared map: whose it is, and how good.
fn title(state: &State, jobs: &Jobs, kind: MapKind) -> String {
    let method = kind.slot().and_then(|slot| state.method_in(slot)).map_or("", |m| m.name());
    let shown = kind.slot().and_then(|slot| jobs.pipeline.method(slot).of_another_method());
    let updating = match (shown, is_updating(jobs, kind)) {
        (Some(shown), _) => return format!("{shown}'s result; {method} is running"),
        (None, true) => " (updating)",
        (None, false) => "",
    };
    let slot = kind.slot().filter(|_| !state.is_predicting());
    let figures = slot.and_then(|slot| jobs.pipeline.scores_in(slot)).map(|s| s.metrics);
    match kind {
        MapKind::Output | MapKind::Second => {
            let figures = figures.map_or_else(String::new, |m| {
                let detection = m.detection.map_or("–".to_owned(), percent);
                format!(" · SE {:.0} · P_D {detection} · P_FA {}", m.squared_error, percent(m.false_alarm))
            });
            let verdict = verdict(state, jobs, kind.slot().unwrap_or(MethodSlot::First));
            let verdict = verdict.map_or_else(String::new, |verdict| format!(" · {verdict}"));
            format!("{method}{verdict}{figures}{updating}")
        }
        MapKind::Difference | MapKind::SecondDifference => format!("{method} − target{updating}"),
        MapKind::OutputAbove | MapKind::SecondAbove => {
            let figures = caption(state, jobs, kind).unwrap_or_default();
            format!("{method} > η · {figures}")
        }
        _ => format!("{}{updating}", kind.title()),
    }
}
