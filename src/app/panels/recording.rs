//! How the file of a recording was read: the layouts it could have as small range profiles, its frames, its antennas, and what is doubtful.

use crate::app::content::{Content, Cx, Nothing};
use crate::app::state::{Command, DocumentCommand, Way};
use crate::app::widgets::labelled::{choice_told, labelled};
use crate::app::widgets::theme;
use crate::recording::raw::boards;
use crate::recording::{Offer, Origin, Recording};
use eframe::egui::{self, Pos2, Rect, ScrollArea, Sense, Shape, Slider, Stroke, Ui, pos2, vec2};

/// Size of a small range profile, and how far below its peak it is drawn, decibels.
const PROFILE: egui::Vec2 = vec2(180.0, 44.0);
const SHOWN_DB: f64 = 80.0;

/// What is drawn.
pub struct Input<'a> {
    /// The recording in place of a scene, where there is one.
    pub recording: Option<&'a Recording>,
}

/// Draws [`Panel::Recording`](crate::app::state::Panel::Recording).
pub struct RecordingPanel;

impl Content for RecordingPanel {
    type Asks = Nothing;
    type Remembers = ();

    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
        let recording = cx.state.editor.document().recording().cloned();
        show(ui, Input { recording: recording.as_deref() })
    }
}

/// Draws the panel.
pub fn show(ui: &mut Ui, input: Input<'_>) -> Vec<Command> {
    let mut asked = Vec::new();
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 8)).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            let Some(recording) = input.recording else {
                ui.weak(
                    "No recording is on screen. Drop a capture, an array or the TOML of a recording on the window.",
                );
                return;
            };
            ui.strong(&recording.name);
            match &recording.origin {
                None => _ = ui.weak("Read as its TOML says."),
                Some(origin) => {
                    match origin.offers.as_slice() {
                        [only] if only.power.is_empty() => _ = ui.weak(&only.described),
                        _ => layouts(ui, origin, &mut asked),
                    }
                    frames(ui, origin, &mut asked);
                    board(ui, origin, &mut asked);
                }
            }
            for doubt in &recording.doubts {
                ui.colored_label(ui.visuals().warn_fg_color, doubt);
            }
            if let Some(origin) = &recording.origin {
                ui.add_space(6.0);
                origin.sentences.iter().for_each(|sentence| _ = ui.weak(sentence));
            }
        });
    });
    asked.into_iter().map(|way| DocumentCommand::ReadAnotherWay(way).into()).collect()
}

/// The layouts to choose from, the most likely first.
fn layouts(ui: &mut Ui, origin: &Origin, asked: &mut Vec<Way>) {
    let best = origin.offers.first().map_or(0.0, |offer| offer.log_odds);
    for (n, offer) in origin.offers.iter().enumerate() {
        ui.horizontal(|ui| {
            let less = if n > 0 {
                format!("\nlog-odds {:.1} less than the best", best - offer.log_odds)
            } else {
                String::new()
            };
            let tooltip = format!("Read the file so: range profile, {SHOWN_DB} dB{less}");
            let is_taken = n == origin.taken;
            let clicked = profile(ui, offer, is_taken).on_hover_text(tooltip.as_str()).clicked();
            ui.vertical(|ui| {
                let text = ui.selectable_label(is_taken, &offer.described).on_hover_text(tooltip);
                if (clicked || text.clicked()) && !is_taken {
                    asked.push(Way::Layout(n));
                }
            });
        });
    }
}

/// Draws a small range profile.
fn profile(ui: &mut Ui, offer: &Offer, is_taken: bool) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(PROFILE, Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Range profile"));
    let visuals = ui.visuals();
    ui.painter().rect_filled(rect, 2.0, visuals.extreme_bg_color);
    let colour = if is_taken { theme::MARK } else { visuals.weak_text_color() };
    ui.painter().add(Shape::line(line(&offer.power, rect.shrink(3.0)), Stroke::new(1.2, colour)));
    response
}

/// The powers of range bins as a line, the strongest on top.
fn line(power: &[f64], rect: Rect) -> Vec<Pos2> {
    let peak = power.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let last = power.len().saturating_sub(1).max(1) as f32;
    let place = |(bin, power): (usize, &f64)| {
        let below = (-10.0 * (power / peak).max(f64::MIN_POSITIVE).log10()).clamp(0.0, SHOWN_DB);
        pos2(rect.left() + rect.width() * bin as f32 / last, rect.top() + rect.height() * (below / SHOWN_DB) as f32)
    };
    power.iter().enumerate().map(place).collect()
}

fn frames(ui: &mut Ui, origin: &Origin, asked: &mut Vec<Way>) {
    if origin.frames < 2 {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let mut frame = origin.frame;
        let slider = Slider::new(&mut frame, 0..=origin.frames - 1);
        let tooltip = "Which frame of the file the maps show";
        if labelled(ui, format!("Frame of {}", origin.frames), tooltip, slider).changed() && frame != origin.frame {
            asked.push(Way::Frame(frame));
        }
    });
}

fn board(ui: &mut Ui, origin: &Origin, asked: &mut Vec<Way>) {
    if origin.config.is_none() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let tooltip = "The board whose antennas are taken; the guide of its maker says the places";
        let mut taken = origin.board.unwrap_or("the .cfg");
        let guide = |name: &str| boards::ALL.iter().find(|board| board.name == name).map_or("", |board| board.guide);
        let offered = boards::ALL.iter().map(|board| board.name);
        choice_told(ui, "Antennas of", tooltip, &mut taken, offered, |name| ((*name).to_owned(), guide(name)));
        if origin.board != Some(taken) && boards::ALL.iter().any(|board| board.name == taken) {
            asked.push(Way::Board(taken));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen;
    use crate::radar::Radar;
    use crate::signal::BeatSignal;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use std::sync::Arc;

    fn recording() -> Recording {
        let offer = |described: &str, log_odds: f64| Offer {
            described: described.to_owned(),
            log_odds,
            power: (0..64).map(|bin| if bin == 9 { 1e6 } else { 1.0 }).collect(),
            toml: String::new(),
        };
        let origin = Origin {
            data: "a.bin".into(),
            config: Some("a.cfg".into()),
            offers: vec![offer("I Q in pairs", 9.0), offer("Q I in pairs", 2.0)],
            taken: 0,
            sentences: vec!["One echo stands out.".to_owned()],
            doubts: Vec::new(),
            board: Some("xWR1642"),
            frames: 20,
            frame: 3,
        };
        let radar = Radar { elements: 8, end_elements: 3, samples: 64, ..Radar::default() };
        let silence = BeatSignal::silence(&radar);
        let doubts = vec!["Antennas are taken for granted.".to_owned()];
        Recording { origin: Some(Arc::new(origin)), doubts, ..Recording::of_signal(radar, silence) }
    }

    fn panel(recording: Option<Recording>) -> Harness<'static, Vec<Command>> {
        let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
            asked.extend(show(ui, Input { recording: recording.as_ref() }));
        };
        Harness::builder().with_size([520.0, 420.0]).build_ui_state(draw, Vec::new())
    }

    #[test]
    fn layouts_frames_board_and_doubts_are_shown() {
        let mut panel = panel(Some(recording()));
        let texts = seen::texts(panel.output());
        for text in
            ["I Q in pairs", "Frame of 20", "xWR1642", "Antennas are taken for granted.", "One echo stands out."]
        {
            assert!(texts.iter().any(|t| t.text == text), "{text} in {texts:?}");
        }
        seen::assert_readable(panel.output());
        panel.get_by_label("Q I in pairs").click();
        panel.run();
        assert_eq!(panel.state(), &[Command::Document(DocumentCommand::ReadAnotherWay(Way::Layout(1)))]);
    }

    #[test]
    fn no_recording_tells_what_to_drop() {
        let panel = panel(None);
        assert!(seen::texts(panel.output()).iter().any(|t| t.text.contains("Drop a capture")));
        let line = line(&[1.0, 100.0, 0.0], Rect::from_min_size(Pos2::ZERO, vec2(10.0, 8.0)));
        assert_eq!(line, [pos2(0.0, 2.0), pos2(5.0, 0.0), pos2(10.0, 8.0)]);
    }
}
