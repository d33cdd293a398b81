//! How the file of a recording was read: the layouts it could have as small range profiles, its frames, its antennas, and what is doubtful.

use crate::app::content::{Content, Cx, Nothing};
use crate::app::state::{Command, DocumentCommand, Way};
use crate::app::widgets::labelled::{choice_told, labelled};
use crate::app::widgets::padded::scrolled;
use crate::app::widgets::theme;
use crate::recording::raw::boards;
use crate::recording::{Offer, Origin, Recording};
use eframe::egui::{self, Sense, Slider, Ui, vec2};
use egui_plot::{Line, Plot, PlotPoints};

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
    scrolled(ui, |ui, asked| {
        let Some(recording) = input.recording else {
            ui.weak("No recording is on screen. Drop a capture, an array or the TOML of a recording on the window.");
            return;
        };
        ui.strong(&recording.name);
        let mut ways = Vec::new();
        match &recording.origin {
            None => _ = ui.weak("Read as its TOML says."),
            Some(origin) => {
                match origin.offers.as_slice() {
                    [only] if only.power.is_empty() => _ = ui.weak(&only.described),
                    _ => layouts(ui, origin, &mut ways),
                }
                frames(ui, origin, &mut ways);
                board(ui, origin, &mut ways);
            }
        }
        for doubt in &recording.doubts {
            ui.colored_label(ui.visuals().warn_fg_color, doubt);
        }
        if let Some(origin) = &recording.origin {
            ui.add_space(6.0);
            origin.sentences.iter().for_each(|sentence| _ = ui.weak(sentence));
        }
        asked.extend(ways.into_iter().map(|way| Command::from(DocumentCommand::ReadAnotherWay(way))));
    })
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
            let clicked = profile(ui, n, offer, is_taken).on_hover_text(tooltip.as_str()).clicked();
            ui.vertical(|ui| {
                let text = ui.selectable_label(is_taken, &offer.described).on_hover_text(tooltip);
                if (clicked || text.clicked()) && !is_taken {
                    asked.push(Way::Layout(n));
                }
            });
        });
    }
}

/// Draws the powers of range bins as a small chart without axes.
fn profile(ui: &mut Ui, number: usize, offer: &Offer, is_taken: bool) -> egui::Response {
    let colour = if is_taken { theme::Inks::of(ui.visuals()).selected } else { ui.visuals().weak_text_color() };
    let peak = offer.power.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let decibels = |power: &f64| (10.0 * (power / peak).max(f64::MIN_POSITIVE).log10()).max(-SHOWN_DB);
    let points = offer.power.iter().enumerate().map(|(bin, power)| [bin as f64, decibels(power)]);
    let line = Line::new("", points.collect::<PlotPoints<'static>>()).color(colour).width(1.2);
    let plot = Plot::new(("profile", number)).width(PROFILE.x).height(PROFILE.y).min_size(PROFILE);
    let plot = plot.show_axes(false).show_grid(false).show_x(false).show_y(false).sense(Sense::click());
    let plot = plot.allow_zoom(false).allow_drag(false).allow_scroll(false).allow_boxed_zoom(false);
    let response = plot.include_y(0.0).include_y(-SHOWN_DB).show(ui, |plot| plot.line(line)).response;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Range profile"));
    response
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
        assert_eq!(panel.query_all_by_label("Range profile").count(), 2, "one a layout");
        panel.get_by_label("Q I in pairs").click();
        panel.run();
        assert_eq!(panel.state(), &[Command::Document(DocumentCommand::ReadAnotherWay(Way::Layout(1)))]);
    }

    #[test]
    fn no_recording_tells_what_to_drop() {
        let panel = panel(None);
        assert!(seen::texts(panel.output()).iter().any(|t| t.text.contains("Drop a capture")));
    }
}
