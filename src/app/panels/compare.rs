//! The panel that compares two methods on the scene on screen: side by side, or flipped in place.

use super::map::{self, MapMemory, caption_of, is_updating, map_input, marks_of, verdict};
use crate::app::content::{Content, Cx};
use crate::app::jobs::{Jobs, Want};
use crate::app::state::{Command, Compare, Layout, MapKind, MapView, MethodSlot, State, ViewCommand, WorkCommand};
use crate::app::widgets::{LIST_HEIGHT, button, choice, labelled, method_list, padded, percent, progress};
use eframe::egui::{ComboBox, Label, Rect, RichText, Ui, UiBuilder, Vec2, vec2};

const TITLE_HEIGHT_POINTS: f32 = 18.0;

pub const PANEL: Content<MapMemory> =
    Content { wants: &[Want::Output, Want::Second], marks_age: true, ..Content::drawn(draw) };

fn draw(ui: &mut Ui, cx: Cx<'_, MapMemory>) -> Vec<Command> {
    let Cx { state, jobs, memory, .. } = cx;
    let kinds = state.settings.compare.maps();
    let textures: Vec<_> = kinds.iter().map(|kind| memory.texture(ui, jobs, *kind)).collect();
    let projection = state.settings.projection;
    let mut view = *state.map_views.of(projection);
    let marks = marks_of(ui, state);
    let maps = kinds.iter().zip(textures).map(|(kind, texture)| {
        let title = title(state, jobs, *kind);
        (title, map_input(state, jobs, &marks, texture, *kind))
    });
    let (maps, progress) = (maps.collect(), jobs.pipeline.method(MethodSlot::Second).progress());
    let asked = show(ui, state, maps, progress, &mut view, &mut memory.hand);
    *state.map_views.of(projection) = view;
    asked
}

/// The title of a compared map: method, verdict and figures.
fn title(state: &State, jobs: &Jobs, kind: MapKind) -> String {
    let method = kind.slot().and_then(|slot| state.method_in(slot)).map_or("", |m| m.name());
    if kind.slot().is_some_and(|slot| jobs.pipeline.method(slot).of_another_method().is_some()) {
        return map::old(state, jobs, kind);
    }
    let updating = if is_updating(jobs, kind) { " (updating)" } else { "" };
    let slot = kind.slot().filter(|_| !state.is_predicting());
    let figures = slot.and_then(|slot| jobs.pipeline.scores_in(slot)).map(|s| s.metrics);
    match kind {
        MapKind::Output | MapKind::Second => {
            let figures = figures.map_or_else(String::new, |m| {
                let detection = m.detection.map_or("–".to_owned(), percent);
                format!(" · SE {:.0} · P_D {detection} · P_FA {}", m.squared_error, percent(m.false_alarm))
            });
            let verdict = verdict(state, jobs, kind.slot().unwrap_or(MethodSlot::First), true);
            let verdict = verdict.map_or_else(String::new, |verdict| format!(" · {verdict}"));
            format!("{method}{verdict}{figures}{updating}")
        }
        MapKind::Difference | MapKind::SecondDifference => format!("{method} − target{updating}"),
        MapKind::OutputAbove | MapKind::SecondAbove => {
            let figures = caption_of(state, jobs, kind).into_iter().next().unwrap_or_default();
            format!("{method} > η · {figures}")
        }
        _ => format!("{}{updating}", kind.title()),
    }
}

/// Draws the maps of [`Compare::maps`] with their titles, and the `progress` of the second method while it runs.
pub fn show(
    ui: &mut Ui,
    state: &State,
    maps: Vec<(String, map::Input<'_>)>,
    progress: Option<f32>,
    view: &mut MapView,
    memory: &mut map::HandMemory,
) -> Vec<Command> {
    padded(ui, |ui, asked| {
        choices(ui, state, progress, asked);
        let (area, compare) = (ui.available_rect_before_wrap(), &state.settings.compare);
        let (places, skipped) = match compare.layout {
            Layout::Beside => (grid(area, maps.len()), 0),
            Layout::Flip => (vec![area], compare.front),
        };
        for (index, (place, (title, map))) in places.into_iter().zip(maps.into_iter().skip(skipped)).enumerate() {
            let (above, below) = place.split_top_bottom_at_y(place.top() + TITLE_HEIGHT_POINTS);
            // With the opacity of the map below.
            let old_ink = map.stale.then(|| ui.visuals().weak_text_color().gamma_multiply(0.55));
            let title = RichText::new(title).size(12.0);
            let title = if let Some(ink) = old_ink { title.color(ink) } else { title };
            ui.scope_builder(UiBuilder::new().max_rect(above).id_salt(("title", index)), |ui| {
                ui.add(Label::new(title).truncate().selectable(false));
            });
            ui.scope_builder(UiBuilder::new().max_rect(below).id_salt(("map", index)), |ui| {
                asked.extend(map::show(ui, map, view, memory));
            });
        }
    })
}

/// Rectangles of the maps, in two columns.
fn grid(area: Rect, count: usize) -> Vec<Rect> {
    let size: Vec2 = vec2(area.width() / 2.0, area.height() / count.div_ceil(2).max(1) as f32);
    let corner = |i: usize| area.min + vec2((i % 2) as f32 * size.x, (i / 2) as f32 * size.y);
    (0..count).map(|i| Rect::from_min_size(corner(i), size).shrink(2.0)).collect()
}

fn choices(ui: &mut Ui, state: &State, second_progress: Option<f32>, asked: &mut Vec<Command>) {
    let mut compare = state.settings.compare.clone();
    ui.horizontal_wrapped(|ui| {
        let [first, second] = MethodSlot::BOTH.map(|slot| state.method_in(slot).map_or("", |m| m.name()));
        method(ui, "First", first, state, |v| Command::View(ViewCommand::Method(v)), asked);
        let second_is = |name: &str| {
            let compare = Compare { second: name.to_owned(), ..state.settings.compare.clone() };
            Command::View(ViewCommand::SetCompare(Box::new(compare)))
        };
        method(ui, "Second", second, state, second_is, asked);
        for layout in Layout::ALL {
            let tip = match layout {
                Layout::Beside => "Both outputs above, their differences from the target below",
                Layout::Flip => "One of two maps, in the same place as the other",
            };
            if ui.selectable_label(compare.layout == layout, layout.name()).on_hover_text(tip).clicked() {
                compare.layout = layout;
            }
        }
        if compare.layout != Layout::Beside {
            for (label, map) in ["of", "and"].into_iter().zip(&mut compare.maps) {
                choice(ui, label, "", map, Compare::OFFERED_MAPS, |kind| (kind.title().to_owned(), kind.describe()));
            }
        }
        button(ui, "Flip maps", ViewCommand::Flip, true, asked);
        // The room is kept, so that the maps below don't jump when a reconstruction begins.
        let room = vec2(170.0, ui.spacing().interact_size.y);
        ui.allocate_ui(room, |ui| {
            ui.set_min_size(room);
            if let Some(part) = second_progress
                && progress(ui, part, 100.0, "Stop the second method; its last output stays")
            {
                asked.push(WorkCommand::CancelSecond.into());
            }
        });
    });
    if compare != state.settings.compare {
        asked.push(ViewCommand::SetCompare(Box::new(compare)).into());
    }
}

fn method(
    ui: &mut Ui,
    label: &str,
    chosen: &'static str,
    state: &State,
    choose: impl Fn(&'static str) -> Command,
    asked: &mut Vec<Command>,
) {
    let combo = ComboBox::from_id_salt(label).width(100.0).height(LIST_HEIGHT).selected_text(chosen);
    let list = |ui: &mut Ui| combo.show_ui(ui, |ui| method_list(ui, state, chosen, choose, asked)).response;
    labelled(ui, label, "", list);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};
    use crate::reconstruct::{Baseline, CAPON, Reconstructor};
    use eframe::egui::TextureId;
    use eframe::egui::accesskit::Role;
    use std::sync::Arc;

    struct Held {
        state: State,
        progress: Option<f32>,
        asked: Vec<Command>,
    }

    fn panel(layout: Layout) -> Harness<'static, Held> {
        let (mut view, mut memory) = (MapView::default(), map::HandMemory::default());
        let draw = move |ui: &mut Ui, held: &mut Held| {
            let state = &held.state;
            let titled = |kind: MapKind| {
                let map = map::Input { texture: Some(TextureId::default()), ..map::Input::bare(kind, state) };
                (kind.title().to_owned(), map)
            };
            let maps = state.settings.compare.maps().into_iter().map(titled).collect();
            let asked = show(ui, state, maps, held.progress, &mut view, &mut memory);
            held.asked.extend(asked.into_iter().filter(|c| !matches!(c, Command::View(ViewCommand::Hover(_)))));
        };
        let mut state = State::new(vec![Arc::new(Baseline), Arc::new(CAPON)]);
        state.settings.method = Baseline.name().to_owned();
        state.settings.compare.layout = layout;
        let held = Held { state, progress: None, asked: Vec::new() };
        let mut panel = Harness::builder().with_size([900.0, 560.0]).build_ui_state(draw, held);
        panel.run_steps(3);
        panel
    }

    #[test]
    fn both_outputs_and_both_differences_are_side_by_side() {
        let panel = panel(Layout::Beside);
        let place = |label: &str| panel.get_by_label(label).rect();
        let [first, second] = ["Output map", "Second output map"].map(place);
        let [below, beside] = ["Difference map", "Second difference map"].map(place);
        assert!(first.right() < second.left() && below.right() < beside.left());
        assert!(first.bottom() < below.top() && (first.width() - second.width()).abs() < 30.0);
        seen::assert_readable(panel.output());
    }

    fn asked_for(panel: &Harness<'_, Held>) -> Compare {
        match panel.state().asked.last() {
            Some(Command::View(ViewCommand::SetCompare(compare))) => Compare::clone(compare),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_second_method_and_map_are_chosen_from_lists() {
        let mut panel = panel(Layout::Flip);
        panel.clicks(&["Second"]);
        panel.get_by_role_and_label(Role::Button, "baseline").click();
        panel.run_steps(2);
        assert_eq!(asked_for(&panel).second, "baseline");
        panel.clicks(&["and", "Target"]);
        assert_eq!(asked_for(&panel).maps, [MapKind::Output, MapKind::Target]);
    }

    #[test]
    fn a_second_method_can_be_cancelled() {
        let mut panel = panel(Layout::Beside);
        panel.state_mut().progress = Some(0.4);
        panel.run_steps(2);
        panel.clicks(&["Cancel"]);
        assert_eq!(panel.state().asked.last(), Some(&Command::Work(WorkCommand::CancelSecond)));
    }
}
