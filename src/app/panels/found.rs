//! The found panel: the method's echoes as a list of angle, range and strength.

use crate::app::content::{Content, Cx};
use crate::app::jobs::Want;
use crate::app::state::{Command, EditCommand, MapKind, MethodSlot};
use crate::app::widgets::{CONVENTION, angle_degrees, headings, padded, plain, right_aligned, signed};
use crate::interact::SelectionMode;
use crate::reconstruct::search::{LADDER, MAX_ATTEMPTS};
use crate::reconstruct::{Attempt, Detection};
use crate::scene::Object;
use eframe::egui::{CollapsingHeader, Grid, ScrollArea, Ui};

const MAX_LISTED_LINES: usize = 200;

/// Opacity of a list that belongs to an earlier scene.
const OLD_LIST_OPACITY: f32 = 0.45;

const CONFIDENCE_TOOLTIP: &str = "How far the samples need this echo: of the energy around its range that the other echoes leave unexplained, the part \
    that it explains. Low: the other echoes, noise or side lobes would do without it. – where the method does not say";

/// The list of echoes, and the state of the method.
pub struct Input<'a> {
    /// Name of the method in use, where it draws a map and lists no echoes.
    pub draws_only: Option<&'static str>,
    pub method: Option<&'static str>,
    /// The found echoes, the strongest first; `None` until the list is computed.
    pub found: Option<&'a [Detection]>,
    /// Attempts of the method's search, in their order.
    pub attempts: &'a [Attempt],
    pub objects: &'a [Object],
    pub refusal: Option<&'a str>,
    /// Whether the list has belonged to an earlier scene for so long that the panel says so.
    pub stale: bool,
    /// Whether the echoes have ranges; a single sample measures none.
    pub has_ranges: bool,
}

pub const PANEL: Content =
    Content { wants: &[Want::Output, Want::Listed], marks_age: true, tells_answers: true, ..Content::drawn(draw) };

fn draw(ui: &mut Ui, cx: Cx<'_>) -> Vec<Command> {
    let (state, pipeline) = (&*cx.state, &cx.jobs.pipeline);
    let output = pipeline.output_of(state);
    let recording = state.editor.document().recording();
    let input = Input {
        draws_only: state.method().map(|m| m.name()).filter(|_| !state.finds_reflectors()),
        method: output.map(|o| o.method()),
        found: output.and_then(|o| o.found.as_deref()),
        attempts: output.map_or(&[], |o| o.attempts.as_slice()),
        objects: &state.editor.scene().objects,
        refusal: pipeline.method(MethodSlot::First).refusal().map(|r| r.reason.as_str()),
        stale: pipeline.is_stale(MapKind::Output),
        has_ranges: state.radar().samples > 1 || recording.is_some_and(|r| r.range_metres.is_some()),
    };
    show(ui, input)
}

pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    padded(ui, |ui, asked| {
        if let Some(method) = input.draws_only {
            ui.weak(format!("{method} draws a map and finds no echoes to list. Choose another method in Settings."));
            return;
        }
        let Some((method, found)) = input.method.zip(input.found).filter(|_| input.refusal.is_none()) else {
            match input.refusal {
                Some(reason) => _ = ui.colored_label(ui.visuals().error_fg_color, reason),
                None => _ = ui.weak("Nothing is listed yet."),
            }
            return;
        };
        if input.stale {
            ui.weak("out of date; updating…");
            ui.set_opacity(OLD_LIST_OPACITY);
        }
        let more = found.len().saturating_sub(MAX_LISTED_LINES);
        ui.weak(match found.len() {
            0 => format!("{method} found nothing."),
            1 => format!("{method} found one echo"),
            count => format!("{method} found {count} echoes, the strongest first"),
        });
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("found").num_columns(6).striped(true).spacing([18.0, 3.0]).show(ui, |ui| {
                if !found.is_empty() {
                    let cosine = "Cosine of the angle to the array's axis, as the maps count directions";
                    let power = "Power of the echo, relative to the strongest";
                    let range = ("range", "From the centre of the array");
                    let measured = [("angle", CONVENTION), ("cos θ", cosine), range, ("dB", power)];
                    headings(ui, [("", "")].into_iter().chain(measured).chain([("needed", CONFIDENCE_TOOLTIP)]));
                }
                found.iter().take(MAX_LISTED_LINES).enumerate().for_each(|(i, d)| line(ui, i + 1, d, input.has_ranges));
            });
            if more > 0 {
                ui.weak(format!("and {more} weaker ones"));
            }
            attempts(ui, input.attempts, input.objects, asked);
        });
    })
}

fn line(ui: &mut Ui, number: usize, found: &Detection, has_ranges: bool) {
    ui.weak(number.to_string());
    let range = if has_ranges { format!("{:.2} m", found.range_metres) } else { "–".to_owned() };
    let angle = format!("{}°", signed(angle_degrees(found.cos_theta), 2));
    for text in [angle, signed(found.cos_theta, 4), range, plain(found.relative_power.0, 1)] {
        right_aligned(ui, |ui| ui.monospace(text));
    }
    // The last column takes all the room that is left: nothing is aligned to its end.
    ui.monospace(found.confidence.map_or("–".to_owned(), |c| format!("{:.0} %", 100.0 * c)));
    ui.end_row();
}

/// Largest distance from an attempt's place to the object that a click selects, metres.
const SAME_PLACE_METRES: f64 = 1.0;

const ATTEMPTS_HEADING: &str = "How the search found them";

/// Heading and tooltip of each column of attempts.
const ATTEMPT_COLUMNS: [(&str, &str); 4] = [
    ("step", "The step of the search that tried it."),
    ("tried", "A reflector or a row, at the place where it was tried."),
    ("gain", "Decades by which the unexplained energy falls with it. One decade is 10 dB."),
    ("verdict", "Whether the search kept it, or the reason why not."),
];

/// Draws the folded group; nothing where there is no attempt. `objects` are those of the scene on screen.
fn attempts(ui: &mut Ui, attempts: &[Attempt], objects: &[Object], asked: &mut Vec<Command>) {
    if attempts.is_empty() {
        return;
    }
    CollapsingHeader::new(ATTEMPTS_HEADING).id_salt("attempts").show_unindented(ui, |ui| {
        Grid::new("attempts").num_columns(4).striped(true).spacing([14.0, 3.0]).show(ui, |ui| {
            headings(ui, ATTEMPT_COLUMNS);
            for attempt in attempts {
                asked.extend(attempt_line(ui, attempt, objects));
            }
        });
        if attempts.len() == MAX_ATTEMPTS {
            ui.weak(format!("The search tried more. The first {MAX_ATTEMPTS} attempts are listed."));
        }
    });
}

/// Draws the line of an attempt. A click selects the object at its place.
fn attempt_line(ui: &mut Ui, attempt: &Attempt, objects: &[Object]) -> Option<Command> {
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
    let selected = |place| EditCommand::Select(nearest(objects, place).into_iter().collect(), SelectionMode::Replace);
    place.filter(|_| clicked).map(|place| selected(place).into())
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
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use crate::radar::{Decibels, Radar};
    use crate::reconstruct::search::Nomp;
    use crate::reconstruct::{AttemptVerdict, Proposal, Reconstructor, Refusal, Request};
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    fn panel(found: Option<Vec<Detection>>, change: fn(Input<'_>) -> Input<'_>) -> Harness<'static> {
        let mut panel = Harness::builder().with_size([360.0, 300.0]).build_ui(move |ui| {
            let input = Input {
                draws_only: None,
                method: Some("iaa"),
                found: found.as_deref(),
                attempts: &[],
                objects: &[],
                refusal: None,
                stale: false,
                has_ranges: true,
            };
            assert!(show(ui, change(input)).is_empty());
        });
        panel.run();
        panel
    }

    fn detection(degrees: f64, range_metres: f64, db: f64) -> Detection {
        let (cos_theta, confidence) = (degrees.to_radians().sin(), Some(0.4 + 0.1 * db));
        Detection { cos_theta, range_metres, relative_power: Decibels(db), confidence }
    }

    fn two() -> Vec<Detection> {
        vec![detection(6.96, 15.0, 0.0), detection(-3.5, 7.25, -2.04)]
    }

    #[test]
    fn angles_ranges_and_decibels_are_listed() {
        let shown = panel(Some(two()), |input| input);
        let _heading = shown.get_by_label("iaa found 2 echoes, the strongest first");
        for line in [["+6.96°", "+0.1212", "15.00 m", "40 %"], ["−3.50°", "7.25 m", "−2.0", "20 %"]] {
            let _told = line.map(|text| shown.get_by_label(text));
        }
    }

    #[test]
    fn what_is_not_listed_is_told() {
        let many = (0..250).map(|i| detection(0.0, f64::from(i), -1.0)).collect();
        type Case = (Option<Vec<Detection>>, fn(Input<'_>) -> Input<'_>, &'static str);
        let cases: [Case; 4] = [
            (Some(two()), |input| Input { draws_only: Some("live"), ..input }, "live draws a map"),
            (Some(Vec::new()), |input| input, "iaa found nothing."),
            (Some(many), |input| input, "and 50 weaker ones"),
            (None, |input| Input { refusal: Some("needs 4 samples"), ..input }, "needs 4 samples"),
        ];
        for (found, change, told) in cases {
            let panel = panel(found, change);
            assert!(panel.query_by_label_contains(told).is_some(), "{told}");
            assert!(panel.query_by_label("15.00 m").is_none() || told.contains("weaker"), "{told}");
        }
        let snapshot = panel(Some(two()), |input| Input { has_ranges: false, ..input });
        assert!(snapshot.query_by_label("15.00 m").is_none(), "one sample tells no range");
    }

    fn attempts_panel(attempts: Vec<Attempt>, scene: Scene) -> Harness<'static, Vec<Command>> {
        let draw = move |ui: &mut Ui, commands: &mut Vec<Command>| {
            super::attempts(ui, &attempts, &scene.objects, commands);
        };
        let mut panel = Harness::builder().with_size([700.0, 300.0]).build_ui_state(draw, Vec::new());
        panel.run();
        panel
    }

    fn attempt(tried: Proposal, verdict: AttemptVerdict) -> Attempt {
        Attempt { rung: "tones", tried, gain_decades: 3.25, verdict, work: 12 }
    }

    #[test]
    fn attempts_are_listed_once_the_group_is_opened() {
        let point = attempt(Proposal::Point { at_metres: [3.0, 9.0] }, AttemptVerdict::Refused(Refusal::EndsDisagree));
        let mut panel = attempts_panel(vec![point], Scene::default());
        assert!(panel.query_by_label("tones").is_none());
        panel.clicks(&[ATTEMPTS_HEADING]);
        let _told = ["tones", "point at x +3.00 m, y +9.00 m", "3.25", "refused: the ends disagree on its strength"]
            .map(|text| panel.get_by_label(text));
    }

    #[test]
    fn a_click_selects_the_object_that_the_search_found() {
        let radar = Radar { elements: 64, samples: 128, ..Radar::default() };
        let scene = Scene::of_points([(0.0, 4.0), (3.0, 6.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let found = Nomp::default().reconstruct(&radar, &ends, &Request::default()).unwrap();
        let mut panel = attempts_panel(found.trace, scene);
        panel.clicks(&[ATTEMPTS_HEADING, "point at x +3.00 m, y +6.00 m"]);
        assert_eq!(panel.state()[..], [Command::from(EditCommand::Select(vec![1], SelectionMode::Replace))]);
    }

    #[test]
    fn a_place_where_nothing_stands_selects_nothing() {
        let objects = Scene::of_points([(0.0, 4.0)]).objects;
        assert_eq!(nearest(&objects, [0.3, -4.2]), Some(0));
        assert_eq!(nearest(&objects, [5.0, 9.0]), None);
    }
}
