//! One line at the bottom: the pointer's place, the number of objects, the time of the last update.

use crate::app::state::Cursor;
use crate::app::widgets::angle_degrees;
use crate::radar::counted;
use eframe::egui::{self, Align, Color32, Layout, TextStyle, Ui};
use std::time::Duration;

/// Content of the status bar.
pub struct Input {
    /// The pointer's place, if it is over a map or the scene.
    pub cursor: Option<Cursor>,
    /// Kind and body of the echo under the pointer, in words.
    pub echo: Option<String>,
    /// Objects of the scene.
    pub objects: usize,
    /// Reflectors of the scene.
    pub reflectors: usize,
    /// Objects that are bodies.
    pub bodies: usize,
    /// Most echoes that one element gets of the bodies; `None` while a lesson asks for a prediction.
    pub echoes: Option<usize>,
    /// Time of the last update of maps and pictures.
    pub took: Option<Duration>,
    /// Whether everything is computed on the thread that draws.
    pub alone: bool,
}

/// Gap between two texts, points.
const GAP: f32 = 18.0;

/// Draws as many texts as there is room for, the most important first.
pub fn show(ui: &mut Ui, input: Input) {
    egui::Panel::bottom("status").show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            let (room, font) = (ui.available_width(), TextStyle::Monospace.resolve(ui.style()));
            let painter = ui.painter().clone();
            let width = |text: &str| painter.layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE).size().x;
            let left = texts_of(input.cursor, input.echo.as_deref()).into_iter().rfind(|text| width(text) <= room);
            let left = left.unwrap_or_default();
            let mut rest = room - width(&left) - GAP;
            if input.cursor.is_some() {
                ui.monospace(left);
            } else {
                ui.weak(left);
            }
            let count = count_of(&input);
            let Input { took, alone, .. } = input;
            let took = took.map(|took| format!("maps {:.1} ms", took.as_secs_f64() * 1e3));
            // The monospaced width is the larger one.
            let mut fits = |text: &String| {
                let wanted = width(text) + GAP;
                let fits = wanted <= rest;
                rest -= if fits { wanted } else { 0.0 };
                fits
            };
            let alone = alone.then(|| "one thread".to_owned()).filter(&mut fits);
            let (count, took) = (Some(count).filter(&mut fits), took.filter(&mut fits));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if let Some(alone) = alone {
                    let tip = "This page has no threads, so the window stops while something is computed. It has them in a tab of its own, \
                        where the browser isolates it from other pages.";
                    ui.weak(alone).on_hover_text(tip);
                }
                if let Some(took) = took {
                    let tip = "Time of the last update of maps and pictures; the Timing panel (F7) has the stages";
                    ui.weak(took).on_hover_text(tip);
                }
                if let Some(count) = count {
                    ui.weak(count).on_hover_text("A body has no reflectors: each element gets a few echoes of it");
                }
            });
        });
    });
}

/// Candidates for the left text, the shortest first.
fn texts_of(cursor: Option<Cursor>, echo: Option<&str>) -> Vec<String> {
    let Some(c) = cursor else {
        let hints = ["Drag a reflector", "double-click to add one", "scroll to zoom", "right-click for more"];
        return (1..=hints.len()).map(|count| hints[..count].join(" · ")).collect();
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

/// The numbers of objects with their reflectors, and of bodies with their echoes.
fn count_of(input: &Input) -> String {
    let Input { objects, reflectors, bodies, echoes, .. } = *input;
    let mut parts = Vec::new();
    if objects > bodies || bodies == 0 {
        parts.push(counted(objects, "object", "objects"));
        parts.push(counted(reflectors, "reflector", "reflectors"));
    }
    if bodies > 0 {
        parts.push(counted(bodies, "body", "bodies"));
        parts.extend(echoes.map(|echoes| format!("up to {}", counted(echoes, "echo", "echoes"))));
    }
    parts.join(" · ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use crate::radar::Radar;
    use egui_kittest::Harness;

    fn of(objects: usize, reflectors: usize, bodies: usize) -> Input {
        let echoes = Some(4 * bodies);
        Input { cursor: None, echo: None, objects, reflectors, bodies, echoes, took: None, alone: false }
    }

    #[test]
    fn bodies_are_counted_by_their_echoes() {
        assert_eq!(count_of(&of(2, 40, 0)), "2 objects · 40 reflectors");
        assert_eq!(count_of(&of(9, 0, 9)), "9 bodies · up to 36 echoes");
        assert_eq!(count_of(&of(2, 1, 1)), "2 objects · 1 reflector · 1 body · up to 4 echoes");
        assert_eq!(count_of(&Input { echoes: None, ..of(1, 0, 1) }), "1 body", "a lesson asks for them");
    }

    #[test]
    fn the_cursor_is_told_in_degrees_from_straight_ahead() {
        let cursor = Cursor::at_place(&Radar::default(), crate::interact::Place::new(-10.0, 10.0));
        let texts = texts_of(Some(cursor), None);
        assert!(texts.iter().all(|text| text.contains("−45.0°")), "{texts:?}");
        assert!(texts.iter().any(|text| text.contains("−45.0°   cos θ −0.707")), "{texts:?}");
    }

    /// A bar `width` points wide, with the pointer over a map or not.
    fn bar(width: f32, has_cursor: bool) -> Harness<'static> {
        let cursor = has_cursor.then(|| Cursor::at_cell(&Radar::default(), 258.7, 448.7));
        Harness::builder().with_size([width, 60.0]).build_ui(move |ui| {
            let took = Some(Duration::from_secs_f64(12.3456));
            let input = Input { reflectors: 12_345, took, ..of(5, 0, 2) };
            show(ui, Input { cursor, ..input });
        })
    }

    #[test]
    fn nothing_is_overprinted_at_any_width() {
        for width in [300.0, 533.0, 853.0, 1440.0, 2560.0] {
            for has_cursor in [true, false] {
                seen::assert_readable(bar(width, has_cursor).output());
            }
        }
    }

    #[test]
    fn a_wider_bar_tells_more() {
        for (width, wanted) in [(300.0, "range"), (533.0, "x "), (853.0, "column"), (1440.0, "maps 12345.6 ms")] {
            let texts = seen::texts(bar(width, true).output());
            assert!(texts.iter().any(|t| t.text.contains(wanted)), "{width}: {texts:?}");
        }
    }
}
