//! Attempts of the search, one line each. A click selects the object at the place of an attempt.

use crate::app::state::{Command, EditCommand};
use crate::app::widgets::{plain, signed};
use crate::interact::SelectionMode;
use crate::reconstruct::Attempt;
use crate::reconstruct::search::{LADDER, MOST_ATTEMPTS};
use crate::scene::Object;
use eframe::egui::{CollapsingHeader, Grid, Ui};

/// Largest distance from an attempt's place to the object that a click selects, metres.
const SAME_PLACE_METRES: f64 = 1.0;

/// The heading of the group.
const HEADING: &str = "How the search found them";

/// Heading and tooltip of each column.
const COLUMNS: [(&str, &str); 4] = [
    ("step", "The step of the search that tried it."),
    ("tried", "A reflector or a row, at the place where it was tried."),
    ("gain", "Decades by which the unexplained energy falls with it. One decade is 10 dB."),
    ("verdict", "Whether the search kept it, or the reason why not."),
];

/// Draws the folded group; nothing where there is no attempt. `objects` are those of the scene on screen.
pub fn show(ui: &mut Ui, attempts: &[Attempt], objects: &[Object]) -> Vec<Command> {
    let mut commands = Vec::new();
    if attempts.is_empty() {
        return commands;
    }
    CollapsingHeader::new(HEADING).id_salt("attempts").show_unindented(ui, |ui| {
        Grid::new("attempts").num_columns(4).striped(true).spacing([14.0, 3.0]).show(ui, |ui| {
            for (heading, help) in COLUMNS {
                ui.strong(heading).on_hover_text(help);
            }
            ui.end_row();
            for attempt in attempts {
                commands.extend(line(ui, attempt, objects));
            }
        });
        if attempts.len() == MOST_ATTEMPTS {
            ui.weak(format!("The search tried more. The first {MOST_ATTEMPTS} attempts are listed."));
        }
    });
    commands
}

fn line(ui: &mut Ui, attempt: &Attempt, objects: &[Object]) -> Option<Command> {
    let does = LADDER.iter().find(|rung| rung.name == attempt.rung).map_or("Starts from the last answer.", |r| r.does);
    ui.label(attempt.rung).on_hover_text(does);
    let place = attempt.tried.place_metres();
    let clicked = match place {
        Some([x, y]) => {
            let text = format!("{} at x {} m, y {} m", attempt.tried, signed(x, 2), signed(y, 2));
            ui.link(text).on_hover_text("Click: select the object of the scene that stands here").clicked()
        }
        None => ui.label(attempt.tried.to_string()).clicked(),
    };
    ui.monospace(plain(attempt.gain_decades, 2));
    ui.label(attempt.verdict.to_string());
    ui.end_row();
    let selected = |place| {
        Command::from(EditCommand::Select(nearest(objects, place).into_iter().collect(), SelectionMode::Replace))
    };
    place.filter(|_| clicked).map(selected)
}

/// The object that has a reflector nearest to a place; `None` where none is near. Samples do not distinguish y from -y.
fn nearest(objects: &[Object], [x, y]: [f64; 2]) -> Option<usize> {
    let apart = |object: &Object| {
        let to = |r: &crate::scene::Reflector| (r.x_metres - x).hypot(r.y_metres.abs() - y.abs());
        object.reflectors().iter().map(to).fold(f64::INFINITY, f64::min)
    };
    let apart = objects.iter().map(apart).enumerate().filter(|(_, metres)| *metres < SAME_PLACE_METRES);
    apart.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::User;
    use crate::radar::Radar;
    use crate::reconstruct::search::Nomp;
    use crate::reconstruct::{Reconstructor, Refusal, Request, Tried, Verdict};
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    fn panel(attempts: Vec<Attempt>, scene: Scene) -> Harness<'static, Vec<Command>> {
        let show = move |ui: &mut Ui, commands: &mut Vec<Command>| commands.extend(show(ui, &attempts, &scene.objects));
        let mut panel = Harness::builder().with_size([700.0, 300.0]).build_ui_state(show, Vec::new());
        panel.run();
        panel
    }

    fn attempt(tried: Tried, verdict: Verdict) -> Attempt {
        Attempt { rung: "tones", tried, gain_decades: 3.25, verdict, work: 12 }
    }

    #[test]
    fn attempts_are_listed_once_the_group_is_opened() {
        let point = attempt(Tried::Point { at_metres: [3.0, 9.0] }, Verdict::Refused(Refusal::EndsDisagree));
        let mut panel = panel(vec![point], Scene::default());
        assert!(panel.query_by_label("tones").is_none());
        panel.clicks(&[HEADING]);
        let _told = ["tones", "point at x +3.00 m, y +9.00 m", "3.25", "refused: the ends disagree on its strength"]
            .map(|text| panel.get_by_label(text));
    }

    #[test]
    fn a_click_selects_the_object_that_the_search_found() {
        let radar = Radar { elements: 64, samples: 128, ..Radar::default() };
        let scene = Scene::of_points([(0.0, 4.0), (3.0, 6.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let found = Nomp::default().reconstruct(&radar, &ends, &Request::default()).unwrap();
        let mut panel = panel(found.trace, scene);
        panel.clicks(&[HEADING, "point at x +3.00 m, y +6.00 m"]);
        assert_eq!(panel.state()[..], [Command::from(EditCommand::Select(vec![1], SelectionMode::Replace))]);
    }

    #[test]
    fn a_place_where_nothing_stands_selects_nothing() {
        let objects = Scene::of_points([(0.0, 4.0)]).objects;
        assert_eq!(nearest(&objects, [0.3, -4.2]), Some(0));
        assert_eq!(nearest(&objects, [5.0, 9.0]), None);
    }
}
