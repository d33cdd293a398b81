//! The disturbances panel: an interfering radar, and a wall that mirrors.

use crate::app::content::{Content, Cx, Nothing};
use crate::app::state::{Command, RadarCommand};
use crate::app::widgets::{Quantity, labelled, scrolled};
use crate::radar::Radar;
use crate::scene::{Disturbances, Interferer, Mirror};
use eframe::egui::{Grid, Ui};

/// The scene's disturbances, and the radar.
pub struct Input<'a> {
    pub disturbances: &'a Disturbances,
    pub radar: &'a Radar,
    /// Whether a recording takes the place of the scene: no disturbance can be added to it.
    pub is_recorded: bool,
}

pub struct DisturbancesPanel;

impl Content for DisturbancesPanel {
    type Asks = Nothing;
    type Remembers = ();

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let document = cx.state.editor.document();
        let is_recorded = document.recording().is_some();
        show(ui, Input { disturbances: &document.scene().disturbances, radar: cx.state.radar(), is_recorded })
    }
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    scrolled(ui, |ui, asked| {
        if input.is_recorded {
            ui.weak("A recording has the disturbances that it was made with.");
            return;
        }
        interferer(ui, &input, asked);
        ui.add_space(8.0);
        mirror(ui, input.disturbances.mirror, asked);
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
    let response = labelled(ui, quantity.name, quantity.tooltip, quantity.field(&mut shown));
    if response.changed() && (shown - *value * scale).abs() >= 0.5e-4 {
        *value = shown / scale;
    }
    ui.end_row();
}

fn interferer(ui: &mut Ui, input: &Input<'_>, asked: &mut Vec<Command>) {
    let now = input.disturbances.interferer;
    let mut on = now.is_some();
    let tooltip = "Another radar whose chirps are not synchronised: received while its frequency crosses ours";
    if ui.checkbox(&mut on, "Interferer").on_hover_text(tooltip).changed() {
        asked.push(RadarCommand::SetInterferer(on.then(|| Interferer::before(input.radar))).into());
        return;
    }
    let Some(now) = now else { return };
    let mut edited = now;
    Grid::new("interferer").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
        number(ui, metres("interferer's x", "Position along the array's axis"), &mut edited.x_metres);
        number(ui, metres("interferer's y", "Position ahead of the array"), &mut edited.y_metres);
        let tooltip = "Its amplitude at 1 m, in units of the radar's power; a reflector of reflectivity 1 at 1 m has 1";
        number(ui, metres("strength", tooltip).with("", [0.0, 1e3], 0.005, 4), &mut edited.strength);
        let tooltip = "When its frequency crosses ours, as a part of the chirp";
        number(ui, percent("crossing time (% of chirp)", tooltip, -100.0, 200.0), &mut edited.crossing);
        let tooltip = "For which part of the chirp it is received: the steeper its chirp relative to ours, the shorter";
        number(ui, percent("duration (% of chirp)", tooltip, 0.1, 200.0), &mut edited.duration);
    });
    if edited != now {
        asked.push(RadarCommand::SetInterferer(Some(edited)).into());
    }
}

fn mirror(ui: &mut Ui, now: Option<Mirror>, asked: &mut Vec<Command>) {
    let mut on = now.is_some();
    let tooltip = "A straight wall: every reflector on the radar's side of it gets three ghosts";
    if ui.checkbox(&mut on, "Mirror").on_hover_text(tooltip).changed() {
        asked.push(RadarCommand::SetMirror(on.then(Mirror::default)).into());
        return;
    }
    let Some(now) = now else { return };
    let mut edited = now;
    Grid::new("mirror").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
        number(ui, metres("mirror's x", "Of a point of the wall"), &mut edited.x_metres);
        number(ui, metres("mirror's y", "Of the same point"), &mut edited.y_metres);
        let tooltip = "Where the wall leads: 0° straight ahead, 90° along the array to the right";
        let before = 90.0 - now.direction_degrees;
        let mut leads = before;
        number(ui, metres("direction", tooltip).with("°", [-360.0, 360.0], 0.5, 4), &mut leads);
        if leads != before {
            edited.direction_degrees = 90.0 - leads;
        }
        let tooltip = "Part of an amplitude that the wall reflects; a ghost over it both ways has the square of it";
        number(ui, percent("reflection", tooltip, 0.0, 100.0), &mut edited.reflection);
    });
    if edited != now {
        asked.push(RadarCommand::SetMirror(Some(edited)).into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn panel(is_recorded: bool) -> Harness<'static, Disturbances> {
        let draw = move |ui: &mut Ui, state: &mut Disturbances| {
            for command in show(ui, Input { disturbances: &state.clone(), radar: &Radar::default(), is_recorded }) {
                match command {
                    Command::Radar(RadarCommand::SetInterferer(interferer)) => state.interferer = interferer,
                    Command::Radar(RadarCommand::SetMirror(mirror)) => state.mirror = mirror,
                    other => panic!("{other:?}"),
                }
            }
        };
        let mut panel = Harness::builder().with_size([360.0, 420.0]).build_ui_state(draw, Disturbances::default());
        panel.run();
        panel
    }

    fn click(panel: &mut Harness<'static, Disturbances>, label: &str) {
        panel.get_by_label(label).click();
        panel.run();
    }

    /// The panel with interferer and mirror switched on.
    fn panel_of_both() -> Harness<'static, Disturbances> {
        let mut panel = panel(false);
        ["Interferer", "Mirror"].into_iter().for_each(|label| click(&mut panel, label));
        panel
    }

    #[test]
    fn what_is_switched_on_has_its_usual_numbers() {
        let panel = panel_of_both();
        assert_eq!(panel.state().interferer, Some(Interferer::default()), "as it stands before the radar of table 3.1");
        assert_eq!(panel.state().mirror, Some(Mirror::default()));
    }

    #[test]
    fn a_number_that_is_typed_changes_no_other() {
        let mut panel = panel_of_both();
        let field = panel.get_by(|n| {
            n.label().as_deref() == Some("crossing time (% of chirp)") && n.role() == egui::accesskit::Role::SpinButton
        });
        field.focus();
        panel.run();
        panel.event(egui::Event::Text("25".to_owned()));
        panel.run();
        panel.key_press(egui::Key::Enter);
        panel.run();
        let edited = panel.state().interferer.unwrap();
        assert_eq!(edited, Interferer { crossing: 0.25, ..Interferer::default() });
    }

    #[test]
    fn either_is_switched_off_by_itself() {
        let mut panel = panel_of_both();
        click(&mut panel, "Interferer");
        assert_eq!((panel.state().interferer, panel.state().mirror.is_some()), (None, true));
    }

    #[test]
    fn nothing_is_added_to_a_recording() {
        let panel = panel(true);
        assert!(panel.query_by_label("Mirror").is_none());
    }
}
