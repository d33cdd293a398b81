//! Menus that stay open while boxes are ticked: methods by family with description and time, and kinds of random scenes.

use super::numbers::significant;
use crate::app::state::{Command, State};
use crate::reconstruct::{Family, Reconstructor};
use crate::scene::generate::Kind;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Align, Button, Grid, Label, Layout, PopupCloseBehavior, Response, RichText, Sense, Ui, vec2};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Height of a popup that lists methods, points.
pub const LIST_HEIGHT: f32 = 420.0;

/// Width of a method's description, points: most take one line.
const DESCRIPTION_WIDTH: f32 = 560.0;

/// Size of descriptions and times, points.
const DESCRIPTION_SIZE: f32 = 12.0;

/// Width of a time, points.
const TIME_WIDTH: f32 = 56.0;

/// Most methods that the menu's title names; more are counted.
const MAX_NAMED_METHODS: usize = 2;

/// Refusals of methods that can't use the layout in use, by the method's name.
fn refusals(state: &State) -> BTreeMap<&'static str, String> {
    let Some(Ok(layout)) = state.settings.layout.as_ref().map(|layout| layout.numbers(state.radar())) else {
        return BTreeMap::new();
    };
    let refusal = |method: &Arc<dyn Reconstructor>| {
        Some((method.name(), method.check_elements(state.radar(), &layout).err()?.to_string()))
    };
    state.methods.all.iter().filter_map(refusal).collect()
}

/// Draws a menu of methods with a box for each; its title names those of `chosen`.
pub fn method_menu(ui: &mut Ui, state: &State, chosen: &mut Vec<&'static str>, tip: &str) {
    let title = match chosen.len() {
        count if count > MAX_NAMED_METHODS => format!("{count} methods"),
        _ => chosen.join(", "),
    };
    let mut ticked: BTreeSet<&str> = chosen.iter().copied().collect();
    let menu = ticking_menu(ui, &format!("Methods: {title}"), |ui| {
        _ = method_lines(ui, state, |ui, method| member_box(ui, method.name(), method.name(), &mut ticked));
    });
    *chosen = ticked.into_iter().collect();
    menu.on_hover_text(tip);
}

/// The content of a popup for choosing one method, scrolled to the chosen one. Another choice adds the command of `choose` to `asked`.
pub fn method_list(
    ui: &mut Ui,
    state: &State,
    chosen: &str,
    choose: impl Fn(&'static str) -> Command,
    asked: &mut Vec<Command>,
) {
    let has_opened = has_opened(ui);
    let mut clicked = None;
    let described = method_lines(ui, state, |ui, method| {
        let is_chosen = method.name() == chosen;
        let response = ui.selectable_label(is_chosen, method.name());
        if response.clicked() {
            clicked = Some(method.name());
        }
        if is_chosen && has_opened {
            response.scroll_to_me_animation(Some(Align::Center), eframe::egui::style::ScrollAnimation::none());
        }
        response
    });
    #[cfg(feature = "live")]
    super::networks::networks(ui, &state.methods.all, state.radar(), asked);
    ui.separator();
    ui.weak("Times are medians of the latest runs on this machine, with this radar.");
    if let Some(name) = clicked.or(described) {
        ui.close();
        if name != chosen {
            asked.push(choose(name));
        }
    }
}

/// Whether a popup was opened within the last two passes: its size is known in the second.
fn has_opened(ui: &Ui) -> bool {
    let (id, now) = (ui.scope_id().with("opened"), ui.ctx().cumulative_pass_nr());
    let (first, last) =
        ui.data(|d| d.get_temp::<(u64, u64)>(id)).filter(|(_, last)| last + 2 >= now).unwrap_or((now, now));
    ui.data_mut(|d| d.insert_temp(id, (first, now.max(last))));
    now <= first + 2
}

/// A row for each method by family: the widget drawn by `name`, description and time. Returns the method whose description was clicked.
pub fn method_lines(
    ui: &mut Ui,
    state: &State,
    mut name: impl FnMut(&mut Ui, &dyn Reconstructor) -> Response,
) -> Option<&'static str> {
    let (mut clicked, refusals) = (None, refusals(state));
    let room = DESCRIPTION_WIDTH.min((ui.ctx().content_rect().width() - 205.0 - TIME_WIDTH).max(120.0));
    Grid::new("methods").num_columns(3).spacing([10.0, 3.0]).show(ui, |ui| {
        for family in Family::ALL {
            let mut of_family = state.methods.all.iter().filter(|method| method.family() == family).peekable();
            if of_family.peek().is_none() {
                continue;
            }
            ui.strong(family.name());
            ui.label(RichText::new(family.describe()).weak().italics().size(DESCRIPTION_SIZE));
            ui.end_row();
            for method in of_family {
                let refusal = refusals.get(method.name());
                let named = ui.add_enabled_ui(refusal.is_none(), |ui| name(ui, method.as_ref())).inner;
                if let Some(reason) = refusal {
                    named.on_disabled_hover_text(reason);
                }
                ui.scope(|ui| {
                    ui.set_width(room);
                    let text = RichText::new(method.description()).weak().size(DESCRIPTION_SIZE);
                    if ui.add(Label::new(text).wrap().selectable(false).sense(Sense::click())).clicked()
                        && refusal.is_none()
                    {
                        clicked = Some(method.name());
                    }
                });
                time(ui, state.method_times.typical_ms(state.radar(), method.name()));
                ui.end_row();
            }
        }
    });
    clicked
}

fn time(ui: &mut Ui, typical_ms: Option<f64>) {
    let text = typical_ms.map_or_else(|| "–".to_owned(), time_text);
    let tip = if typical_ms.is_some() { "Typical time on this machine" } else { "It has not run on this machine yet" };
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.set_min_width(TIME_WIDTH);
        ui.label(RichText::new(text).weak().size(DESCRIPTION_SIZE)).on_hover_text(tip);
    });
}

/// A time in milliseconds or seconds, with three significant digits.
fn time_text(ms: f64) -> String {
    if ms >= 999.5 { format!("{} s", significant(ms / 1e3)) } else { format!("{} ms", significant(ms)) }
}

/// Width of a kind's description, points.
const SENTENCE_WIDTH: f32 = 520.0;
/// Width of a button with a ticking menu, points; a longer title ends in an ellipsis.
const TITLE_WIDTH: f32 = 200.0;

fn kind_name(kind: &Kind) -> String {
    if kind.test_set().is_some() { format!("set {kind}") } else { kind.to_string() }
}

/// A button with a menu that stays open at clicks into it; returns the button's response.
pub fn ticking_menu(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui)) -> Response {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    // A tall menu opens beside its button. A button of constant width keeps it in place while the title grows.
    let size = vec2(TITLE_WIDTH.min(ui.max_rect().width()), ui.spacing().interact_size.y);
    let button = Button::new(title).truncate().min_size(size);
    ui.allocate_ui(size, |ui| MenuButton::from_button(button).config(config).ui(ui, contents).0).inner
}

pub fn member_box<T: Ord>(ui: &mut Ui, name: impl Into<String>, value: T, chosen: &mut BTreeSet<T>) -> Response {
    let mut ticked = chosen.contains(&value);
    let response = ui.checkbox(&mut ticked, name.into());
    if response.changed() {
        match ticked {
            true => chosen.insert(value),
            false => chosen.remove(&value),
        };
    }
    response
}

/// A box for each kind of scenes with its description; `chosen` has the ticked ones.
pub fn kind_boxes(ui: &mut Ui, chosen: &mut Vec<Kind>) {
    let room = SENTENCE_WIDTH.min((ui.ctx().content_rect().width() - 220.0).max(120.0));
    let mut ticked: BTreeSet<Kind> = chosen.iter().copied().collect();
    Grid::new("kinds").num_columns(2).spacing([10.0, 3.0]).show(ui, |ui| {
        for kind in Kind::all() {
            member_box(ui, kind_name(&kind), kind, &mut ticked);
            ui.scope(|ui| {
                ui.set_width(room);
                let text = RichText::new(kind.description()).weak().size(DESCRIPTION_SIZE);
                ui.add(Label::new(text).wrap().selectable(false));
            });
            ui.end_row();
        }
    });
    *chosen = ticked.into_iter().collect();
}

/// The names of `chosen` kinds and of the set `beside` them, or their number where there are more than four.
pub fn kind_names(chosen: &[Kind], beside: Option<&str>) -> String {
    // A number alone could be read as a count.
    let of = |kind: &Kind| if chosen.len() == 1 { kind_name(kind) } else { kind.to_string() };
    let names: Vec<String> = chosen.iter().map(of).chain(beside.map(str::to_owned)).collect();
    if names.len() > 4 { format!("{} kinds", names.len()) } else { names.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{Methods, ViewCommand};
    use crate::app::widgets::seen::{self, Harness, NodeT, Queryable, User};
    use crate::radar::{LayoutKind, Radar};
    use crate::scene::Scene;
    use std::time::Duration;

    /// A popup of all methods of 300 points, with a layout in use or not.
    fn popup(chosen: &'static str, layout: Option<LayoutKind>) -> Harness<'static, Vec<Command>> {
        let radar = Radar { elements: 86, end_elements: 8, ..Radar::default() };
        let mut state = State { methods: Methods::new(crate::methods::all()), ..State::of(radar, Scene::default()) };
        state.method_times.record(&state.editor.radar().clone(), chosen, Duration::from_millis(1240));
        state.settings.layout = layout;
        let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
            eframe::egui::ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
                method_list(ui, &state, chosen, |v| ViewCommand::Method(v).into(), asked);
            });
        };
        Harness::builder().with_size([700.0, 320.0]).build_ui_state(draw, Vec::new())
    }

    fn in_sight(popup: &Harness<'_, Vec<Command>>, text: &str) -> bool {
        seen::texts(popup.output()).iter().any(|t| t.text == text && t.clip.contains_rect(t.rect))
    }

    #[test]
    fn it_opens_at_the_chosen_method() {
        for chosen in ["baseline", "sbl", "esprit", "nomp"] {
            let mut popup = popup(chosen, None);
            popup.run_steps(4);
            assert!(in_sight(&popup, chosen), "{chosen}: {:?}", seen::texts(popup.output()));
        }
    }

    #[test]
    fn methods_that_cannot_hear_the_layout_are_grey_and_say_why() {
        let mut popup = popup("iaa", Some(LayoutKind::Nested { neighbours: 8, apart: 8 }));
        popup.run_steps(4);
        let is_grey = |label: &str| popup.get_by_label(label).accesskit_node().is_disabled();
        let grey = ["capon", "baseline", "iaa", "matched-filter"].map(is_grey);
        assert_eq!(grey, [true, true, false, false]);
        popup.get_by_label("baseline").hover();
        popup.run_steps(60);
        let told = "it hears the two ends of an array";
        assert!(seen::texts(popup.output()).iter().any(|text| text.text.contains(told)));
        popup.clicks(&["baseline"]);
        assert_eq!(popup.state()[..], []);
    }

    #[test]
    fn a_method_stands_under_its_family_with_its_measured_time() {
        let mut popup = popup("nomp", None);
        popup.run_steps(4);
        let at = |label: &str| popup.get_by_label(label).rect().top();
        let order = ["Search", "nomp", "Sparse", "sbl", "Classical", "baseline", "capon"];
        assert!(order.windows(2).all(|pair| at(pair[0]) < at(pair[1])), "{order:?}");
        assert!(in_sight(&popup, "1.24 s"));
        assert!(popup.reads("–"), "no time is told that was not measured");
        popup.clicks(&[crate::methods::by_name("hybrid").unwrap().description()]);
        assert_eq!(popup.state()[..], [Command::View(ViewCommand::Method("hybrid"))], "the description chooses, too");
    }

    #[test]
    fn ticking_moves_neither_the_button_nor_its_menu() {
        let methods = Methods::new(crate::methods::all());
        let state = State { methods, ..State::of(Radar::default(), Scene::default()) };
        let draw = move |ui: &mut Ui, chosen: &mut Vec<&'static str>| {
            ui.horizontal_wrapped(|ui| method_menu(ui, &state, chosen, ""));
        };
        let mut menu = Harness::builder().with_size([1000.0, 700.0]).build_ui_state(draw, vec!["live"]);
        menu.clicks(&["Methods: live"]);
        let before = menu.get_by_label("baseline").rect();
        menu.clicks(&["matched-filter-incoherent"]);
        assert_eq!(menu.get_by_label("baseline").rect(), before);
        menu.clicks(&["baseline"]);
        assert_eq!(menu.state().len(), 3, "the menu stays open");
    }

    #[test]
    fn times_have_three_digits() {
        assert_eq!([11.237, 124.9, 1004.0, 23_000.0].map(time_text), ["11.2 ms", "125 ms", "1.00 s", "23.0 s"]);
    }

    #[test]
    fn a_menu_with_ticks_stays_open_and_each_kind_has_its_sentence() {
        let draw = |ui: &mut Ui, chosen: &mut Vec<Kind>| {
            ticking_menu(ui, "Scenes", |ui| kind_boxes(ui, chosen));
        };
        let mut menu = Harness::builder().with_size([800.0, 900.0]).build_ui_state(draw, Vec::new());
        menu.clicks(&["Scenes"]);
        for kind in ["walls", "clusters"] {
            menu.clicks(&[kind]);
        }
        assert_eq!(menu.state().len(), 2, "two boxes were ticked in one opening");
        for kind in Kind::all() {
            assert!(menu.query_all_by_label(kind.description()).next().is_some(), "{kind}");
        }
    }
}
