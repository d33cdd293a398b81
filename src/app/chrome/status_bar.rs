//! One line at the bottom: the pointer's place, the number of objects, the time of the last update.

use crate::app::state::{Cursor, State};
use crate::app::widgets::angle_degrees;
use crate::platform;
use crate::radar::counted;
use crate::scattering::{PathEcho, array_centre_echoes};
use crate::scene::Scene;
use eframe::egui::{self, Align, Color32, Layout, TextStyle, Ui};
use std::time::Duration;

/// Gap between two texts, points.
const TEXT_GAP_POINTS: f32 = 18.0;

/// Draws as many texts as there is room for, the most important first. `took` is the time of the last update of maps and pictures.
pub fn show(ui: &mut Ui, state: &State, took: Option<Duration>) {
    let cursor = state.shown_cursor();
    let echo = cursor.and_then(|cursor| echo_at(state, &cursor));
    egui::Panel::bottom("status").show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = TEXT_GAP_POINTS;
            let (room, font) = (ui.available_width(), TextStyle::Monospace.resolve(ui.style()));
            let painter = ui.painter().clone();
            let width = |text: &str| painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE).size().x;
            let left = texts_of(state, cursor, echo.as_deref()).into_iter().rfind(|text| width(text) <= room);
            let left = left.unwrap_or_default();
            let mut rest = room - width(&left) - TEXT_GAP_POINTS;
            if cursor.is_some() {
                ui.monospace(left);
            } else {
                ui.weak(left);
            }
            let has_count = !(state.is_recorded() && state.editor.scene().objects.is_empty());
            let count = has_count.then(|| count_of(state.editor.scene(), state.is_predicting()));
            let took = took.map(|took| format!("maps {:.1} ms", took.as_secs_f64() * 1e3));
            // The monospaced width is the larger one.
            let mut fits = |text: &String| {
                let wanted = width(text) + TEXT_GAP_POINTS;
                let fits = wanted <= rest;
                rest -= if fits { wanted } else { 0.0 };
                fits
            };
            let alone = (!platform::has_threads()).then(|| "one thread".to_owned());
            let alone_tip = "This page has no threads, so the window stops while something is computed. It has them in a tab of its own, \
                where the browser isolates it from other pages.";
            let count_tip = "A body has no reflectors: each element gets a few echoes of it";
            let took_tip = "Time of the last update of maps and pictures; the Timing panel (F7) has the stages";
            let [alone, count, took] = [(alone, alone_tip), (count, count_tip), (took, took_tip)]
                .map(|(text, tip)| text.filter(&mut fits).map(|text| (text, tip)));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                for (text, tip) in [alone, took, count].into_iter().flatten() {
                    ui.weak(text).on_hover_text(tip);
                }
            });
        });
    });
}

/// Candidates for the left text, the shortest first. None while a lesson asks for something else.
fn texts_of(state: &State, cursor: Option<Cursor>, echo: Option<&str>) -> Vec<String> {
    let Some(c) = cursor else {
        let drag = (!state.editor.scene().objects.is_empty()).then_some("Drag a reflector");
        let add = if drag.is_some() { "double-click to add one" } else { "Double-click to add a reflector" };
        let hints: Vec<&str> = drag.into_iter().chain([add, "scroll to zoom", "right-click for more"]).collect();
        let most = if state.is_predicting() { 0 } else { hints.len() };
        return (1..=most).map(|count| hints[..count].join(" · ")).collect();
    };
    let range = format!("range {:6.2} m   {:+5.1}°", c.range_metres, angle_degrees(c.cos_theta));
    let polar = format!("{range}   cos θ {:+.3}", c.cos_theta);
    let place = format!("x {:+7.2} m   y {:+7.2} m", c.place.x_metres, c.place.y_metres);
    let cell = format!("bin {:5.1}   column {:6.1}", c.bin, c.column);
    let both = format!("{place}   {polar}");
    let texts = [range.clone(), polar, format!("{place}   {range}"), both.clone(), format!("{both}   {cell}")];
    let texts = texts.map(|text| text.replace('-', "−"));
    match echo {
        // The echo under the pointer tells more than a further number.
        Some(echo) => texts.map(|text| format!("{text}   {echo}")).to_vec(),
        None => texts.to_vec(),
    }
}

/// The numbers of objects with their reflectors, and of bodies with their echoes, for which a lesson may ask.
fn count_of(scene: &Scene, is_predicting: bool) -> String {
    let (objects, reflectors) = (scene.objects.len(), scene.reflector_count());
    let of_bodies: Vec<usize> = scene.objects.iter().filter_map(|o| o.body()).map(|body| body.echo_count()).collect();
    let bodies = of_bodies.len();
    let mut parts = Vec::new();
    if objects > bodies || bodies == 0 {
        parts.push(counted(objects, "object", "objects"));
        parts.push(counted(reflectors, "reflector", "reflectors"));
    }
    if bodies > 0 {
        parts.push(counted(bodies, "body", "bodies"));
        let echoes = || format!("up to {}", counted(of_bodies.iter().sum::<usize>(), "echo", "echoes"));
        parts.extend((!is_predicting).then(echoes));
    }
    parts.join(" · ")
}

/// Most bodies among which the echo under the pointer is searched.
const MAX_SEARCHED_BODIES: usize = 60;
/// Largest distance of the pointer from an echo, in range bins and columns.
const MAX_ECHO_DISTANCE_CELLS: [f64; 2] = [1.5, 8.0];

/// Kind and body of the strongest echo under the pointer, in words.
fn echo_at(state: &State, cursor: &Cursor) -> Option<String> {
    let (radar, scene) = (state.radar(), state.editor.scene());
    let bodies = scene.objects.iter().filter(|o| o.body().is_some()).count();
    if !(1..=MAX_SEARCHED_BODIES).contains(&bodies) {
        return None;
    }
    let [bins, columns] = MAX_ECHO_DISTANCE_CELLS;
    let near = |(_, echo): &(usize, PathEcho)| {
        let [x, y] = echo.place_metres;
        let bin = radar.bin_of_range(echo.range_metres - cursor.range_metres).abs();
        let column = (x / x.hypot(y) - cursor.cos_theta).abs() * radar.elements as f64 / radar.fold_period_cos();
        bin < bins && column < columns
    };
    let strength = |(_, echo): &(usize, PathEcho)| echo.amplitude.norm_sqr();
    let all = array_centre_echoes(radar, scene).into_iter().filter(near);
    let (index, echo) = all.max_by(|a, b| strength(a).total_cmp(&strength(b)))?;
    Some(format!("{} of {}", echo.kind.name(), scene.objects[index].called(index)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness};
    use crate::radar::Radar;
    use crate::scene::{GaussianCluster, Object, Wall};

    /// A scene of so many walls, and of clusters of so many reflectors.
    fn scene(walls: usize, clusters: &[usize]) -> Scene {
        let wall = |i: usize| Object::Wall(Wall::new(-15.0, 5.0 + i as f64, 1.0, 0.0));
        let cluster = |count: &usize| Object::Gaussian(GaussianCluster::new([0.0, 9.0], [1.0, 1.0], *count));
        let objects = (0..walls).map(wall).chain(clusters.iter().map(cluster)).collect();
        Scene { objects, ..Scene::default() }
    }

    #[test]
    fn bodies_are_counted_by_their_echoes() {
        assert_eq!(count_of(&scene(0, &[39, 1]), false), "2 objects · 40 reflectors");
        assert_eq!(count_of(&scene(9, &[]), false), "9 bodies · up to 27 echoes");
        assert_eq!(count_of(&scene(1, &[1]), false), "2 objects · 1 reflector · 1 body · up to 3 echoes");
        assert_eq!(count_of(&scene(1, &[]), true), "1 body", "a lesson asks for them");
    }

    #[test]
    fn the_cursor_is_told_in_degrees_from_straight_ahead() {
        let cursor = Cursor::at_place(&Radar::default(), crate::interact::Place::new(-10.0, 10.0));
        let texts = texts_of(&State::of(Radar::default(), Scene::default()), Some(cursor), None);
        assert!(texts.iter().all(|text| text.contains("−45.0°")), "{texts:?}");
        assert!(texts.iter().any(|text| text.contains("−45.0°   cos θ −0.707")), "{texts:?}");
    }

    #[test]
    fn hints_are_true_of_a_scene_a_recording_and_a_question() {
        let longest = |state: &State| texts_of(state, None, None).pop().unwrap_or_default();
        assert!(longest(&State::of(Radar::default(), scene(1, &[]))).starts_with("Drag a reflector · double-click"));
        let empty = longest(&State::of(Radar::default(), Scene::default()));
        assert!(empty.starts_with("Double-click to add a reflector · scroll"), "{empty}");
    }

    fn bar(width: f32, has_cursor: bool) -> Harness<'static> {
        let mut state = State::of(Radar::default(), scene(2, &[12_343, 1, 1]));
        state.pointer.now = has_cursor.then(|| Cursor::at_cell(&Radar::default(), 258.7, 448.7));
        Harness::builder().with_size([width, 60.0]).build_ui(move |ui| {
            show(ui, &state, Some(Duration::from_secs_f64(12.3456)));
        })
    }

    #[test]
    fn a_wider_bar_tells_more_and_overprints_nothing() {
        let all = "maps 12345.6 ms";
        for (width, wanted) in [(300.0, "range"), (533.0, "x "), (853.0, "column"), (1440.0, all), (2560.0, all)] {
            seen::assert_readable(bar(width, false).output());
            let bar = bar(width, true);
            seen::assert_readable(bar.output());
            let texts = seen::texts(bar.output());
            assert!(texts.iter().any(|t| t.text.contains(wanted)), "{width}: {texts:?}");
        }
    }
}
