//! The disturbances panel: an interfering radar, and a wall that mirrors.

use crate::app::content::Content;
use crate::app::state::{Command, RadarCommand, State};
use crate::app::widgets::{Quantity, labelled, scrolled};
use crate::scene::{Interferer, Mirror};
use eframe::egui::{Grid, Ui};

pub const PANEL: Content = Content::drawn(|ui, cx| show(ui, cx.state));

pub fn show(ui: &mut Ui, state: &State) -> Vec<Command> {
    scrolled(ui, |ui, asked| {
        if state.is_recorded() {
            ui.weak("A recording has the disturbances that it was made with.");
            return;
        }
        interferer(ui, state, asked);
        ui.add_space(8.0);
        mirror(ui, state.editor.scene().disturbances.mirror, asked);
    })
}

fn metres(name: &'static str, tooltip: &'static str) -> Quantity {
    Quantity::metres(name, tooltip).with(" m", [-1e4, 1e4], 0.05, 4)
}

fn percent(name: &'static str, tooltip: &'static str, low: f64, high: f64) -> Quantity {
    metres(name, tooltip).with(" %", [low, high], 0.5, 4)
}

/// Draws a row: name and number. A percentage is a part of 1 in `value`.
fn number(ui: &mut Ui, quantity: Quantity, value: &mut f64) {
    let scale = if quantity.unit == " %" { 100.0 } else { 1.0 };
    let mut shown = *value * scale;
    if labelled(ui, quantity.name, quantity.tooltip, quantity.field(&mut shown)).changed() {
        *value = shown / scale;
    }
    ui.end_row();
}

/// Draws the box that switches a disturbance on or off, and the `rows` of its numbers. Returns the disturbance where it was changed.
fn switched<T: Copy + PartialEq>(
    ui: &mut Ui,
    (name, tooltip): (&str, &str),
    now: Option<T>,
    usual: T,
    rows: impl FnOnce(&mut Ui, &mut T),
) -> Option<Option<T>> {
    let mut on = now.is_some();
    if ui.checkbox(&mut on, name).on_hover_text(tooltip).changed() {
        return Some(on.then_some(usual));
    }
    let mut edited = now?;
    Grid::new(name).num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| rows(ui, &mut edited));
    (now != Some(edited)).then_some(Some(edited))
}

fn interferer(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    let tooltip = "Another radar whose chirps are not synchronised: received while its frequency crosses ours";
    let (now, usual) = (state.editor.scene().disturbances.interferer, Interferer::before(state.radar()));
    let changed = switched(ui, ("Interferer", tooltip), now, usual, |ui, edited| {
        number(ui, metres("interferer's x", "Position along the array's axis"), &mut edited.x_metres);
        number(ui, metres("interferer's y", "Position ahead of the array"), &mut edited.y_metres);
        let tooltip = "Its amplitude at 1 m, in units of the radar's power; a reflector of reflectivity 1 at 1 m has 1";
        number(ui, metres("strength", tooltip).with("", [0.0, 1e3], 0.005, 4), &mut edited.strength);
        let tooltip = "When its frequency crosses ours, as a part of the chirp";
        number(ui, percent("crossing time (% of chirp)", tooltip, -100.0, 200.0), &mut edited.crossing);
        let tooltip = "For which part of the chirp it is received: the steeper its chirp relative to ours, the shorter";
        number(ui, percent("duration (% of chirp)", tooltip, 0.1, 200.0), &mut edited.duration);
    });
    asked.extend(changed.map(|interferer| Command::Radar(RadarCommand::SetInterferer(interferer))));
}

fn mirror(ui: &mut Ui, now: Option<Mirror>, asked: &mut Vec<Command>) {
    let tooltip = "A straight wall: every reflector on the radar's side of it gets three ghosts";
    let changed = switched(ui, ("Mirror", tooltip), now, Mirror::default(), |ui, edited| {
        number(ui, metres("mirror's x", "Of a point of the wall"), &mut edited.x_metres);
        number(ui, metres("mirror's y", "Of the same point"), &mut edited.y_metres);
        let tooltip = "Where the wall leads: 0° straight ahead, 90° along the array to the right";
        let before = 90.0 - edited.direction_degrees;
        let mut leads = before;
        number(ui, metres("direction", tooltip).with("°", [-360.0, 360.0], 0.5, 4), &mut leads);
        if leads != before {
            edited.direction_degrees = 90.0 - leads;
        }
        let tooltip = "Part of an amplitude that the wall reflects; a ghost over it both ways has the square of it";
        number(ui, percent("reflection", tooltip, 0.0, 100.0), &mut edited.reflection);
    });
    asked.extend(changed.map(|mirror| Command::Radar(RadarCommand::SetMirror(mirror))));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::panels::recording::tests::some_recording;
    use crate::app::widgets::seen::{Harness, Queryable, User};

    fn panel(state: State) -> Harness<'static, State> {
        let draw = move |ui: &mut Ui, state: &mut State| {
            for command in show(ui, state) {
                state.editor.edit(None, |scene, _| match command {
                    Command::Radar(RadarCommand::SetInterferer(interferer)) => {
                        scene.disturbances.interferer = interferer;
                    }
                    Command::Radar(RadarCommand::SetMirror(mirror)) => scene.disturbances.mirror = mirror,
                    other => panic!("{other:?}"),
                });
            }
        };
        let mut panel = Harness::builder().with_size([360.0, 420.0]).build_ui_state(draw, state);
        panel.run();
        panel
    }

    fn disturbances(panel: &Harness<'static, State>) -> (Option<Interferer>, Option<Mirror>) {
        let disturbances = &panel.state().editor.scene().disturbances;
        (disturbances.interferer, disturbances.mirror)
    }

    fn panel_of_both() -> Harness<'static, State> {
        let mut panel = panel(State::new(Vec::new()));
        panel.clicks(&["Interferer", "Mirror"]);
        panel
    }

    #[test]
    fn what_is_switched_on_has_its_usual_numbers() {
        assert!(panel(State::recorded(some_recording())).query_by_label("Mirror").is_none(), "not over a recording");
        let mut panel = panel_of_both();
        let usual = (Some(Interferer::default()), Some(Mirror::default()));
        assert_eq!(disturbances(&panel), usual, "as they stand before the radar of table 3.1");
        panel.clicks(&["Interferer"]);
        assert_eq!(disturbances(&panel), (None, usual.1), "either is switched off by itself");
    }

    #[test]
    fn a_number_that_is_typed_changes_no_other() {
        let mut panel = panel_of_both();
        panel.enters("crossing time (% of chirp)", "25");
        let edited = disturbances(&panel).0.unwrap();
        assert_eq!(edited, Interferer { crossing: 0.25, ..Interferer::default() });
    }
}
