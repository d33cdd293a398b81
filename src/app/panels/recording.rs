//! The recording panel: the layouts that the file may have, as small range profiles, its frames, its antennas, and doubts about it.

use crate::app::content::{Content, Cx};
use crate::app::state::{CardPlan, Command, DocumentCommand, Purpose, Way, WorkCommand};
use crate::app::widgets::{Inks, NumberField, button, choice, labelled, scrolled, warning};
use crate::platform;
use crate::recording::card::{CardSummary, USUAL_PORT};
use crate::recording::raw::boards;
use crate::recording::{Origin, ReadingOption, Recording};
use eframe::egui::{self, Sense, Slider, Ui, vec2};
use egui_plot::{Line, Plot, PlotPoints};

/// Size of a small range profile, points, and the decibels below its peak that it shows.
const PROFILE_SIZE_POINTS: egui::Vec2 = vec2(180.0, 44.0);
const SHOWN_DB: f64 = 80.0;

/// Remembers the UDP port in the field of a capture card.
pub const PANEL: Content<Option<u16>> = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_, Option<u16>>) -> Vec<Command> {
    let recording = cx.state.editor.document().recording().cloned();
    let listening = &cx.jobs.listening;
    let card = (!platform::IN_A_BROWSER).then(|| (listening.plan(), listening.summary()));
    show(ui, recording.as_deref(), card, cx.memory)
}

/// A capture card: port and configuration while the program listens, and numbers of frames and packets since then.
type Card<'a> = (Option<&'a CardPlan>, CardSummary);

/// Draws the recording in place of a scene, and the capture card, where there may be one.
pub fn show(
    ui: &mut Ui,
    recording: Option<&Recording>,
    of_card: Option<Card<'_>>,
    port: &mut Option<u16>,
) -> Vec<Command> {
    scrolled(ui, |ui, asked| {
        if let Some(of_card) = of_card {
            let origin = recording.and_then(|recording| recording.origin.as_deref());
            card(ui, of_card, origin, port.get_or_insert(USUAL_PORT), asked);
            ui.separator();
        }
        let Some(recording) = recording else {
            ui.weak("No recording is on screen. Drop a capture, an array or the TOML of a recording on the window.");
            return;
        };
        ui.strong(&recording.name);
        let mut ways = Vec::new();
        match &recording.origin {
            None => _ = ui.weak("Read as its TOML says."),
            Some(origin) => {
                match origin.offers.as_slice() {
                    [only] if only.power.is_empty() => _ = ui.weak(&only.description),
                    _ => layouts(ui, origin, &mut ways),
                }
                if origin.frames > 1 {
                    ui.horizontal_wrapped(|ui| ways.extend(frame_slider(ui, [origin.frame, origin.frames])));
                }
                board(ui, origin, &mut ways);
            }
        }
        for doubt in &recording.doubts {
            warning(ui, Some(doubt));
        }
        if let Some(origin) = &recording.origin {
            ui.add_space(6.0);
            origin.sentences.iter().for_each(|sentence| _ = ui.weak(sentence));
        }
        asked.extend(ways.into_iter().map(|way| Command::from(DocumentCommand::Reread(way))));
    })
}

/// Draws the state of a capture card, or the fields to listen to one.
fn card(ui: &mut Ui, (plan, summary): Card<'_>, origin: Option<&Origin>, port: &mut u16, asked: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| match plan {
        Some(plan) => {
            ui.label(format!("Listening on UDP port {}", plan.port)).on_hover_text(plan.config.display().to_string());
            button(ui, "Stop listening", WorkCommand::StopListening, true, asked);
            ui.weak(told(summary)).on_hover_text(summary.sentence());
        }
        None => {
            let field = NumberField::new(port).range(1..=u16::MAX);
            labelled(ui, "Capture card on UDP port", "The port of this machine that it sends to", field);
            if let Some(config) = origin.and_then(|origin| origin.config.clone()) {
                let plan = CardPlan { port: *port, config, board: origin.and_then(|origin| origin.board) };
                button(ui, "Listen", WorkCommand::Listen(plan), true, asked);
            }
            button(ui, "Listen with a .cfg…", Purpose::Listen(*port), true, asked);
        }
    });
}

/// Text of the numbers of received, dropped and incomplete frames.
fn told(summary: CardSummary) -> String {
    let CardSummary { frames, dropped, packets } = summary;
    if packets.packets == 0 {
        return "no packet came yet".to_owned();
    }
    let mut told = format!("{frames} frames came, {dropped} were dropped");
    let lost = packets.lost_bytes;
    if lost + packets.lost_frames > 0 {
        told += &format!(", {lost} bytes and {} whole frames lost", packets.lost_frames);
    }
    told
}

fn layouts(ui: &mut Ui, origin: &Origin, asked: &mut Vec<Way>) {
    let best = origin.offers.first().map_or(0.0, |offer| offer.log_odds);
    for (n, offer) in origin.offers.iter().enumerate() {
        ui.horizontal(|ui| {
            let mut tooltip = format!("Read the file so: range profile, {SHOWN_DB} dB");
            if n > 0 {
                tooltip += &format!("\nlog-odds {:.1} less than the best", best - offer.log_odds);
            }
            let is_taken = n == origin.taken;
            let clicked = profile(ui, n, offer, is_taken).on_hover_text(tooltip.as_str()).clicked();
            ui.vertical(|ui| {
                let text = ui.selectable_label(is_taken, &offer.description).on_hover_text(tooltip);
                if (clicked || text.clicked()) && !is_taken {
                    asked.push(Way::Layout(n));
                }
            });
        });
    }
}

/// Draws the powers of range bins as a small chart without axes.
fn profile(ui: &mut Ui, number: usize, offer: &ReadingOption, is_taken: bool) -> egui::Response {
    let colour = if is_taken { Inks::of(ui.visuals()).selected } else { ui.visuals().weak_text_color() };
    let peak = offer.power.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let decibels = |power: &f64| (10.0 * (power / peak).max(f64::MIN_POSITIVE).log10()).max(-SHOWN_DB);
    let points = offer.power.iter().enumerate().map(|(bin, power)| [bin as f64, decibels(power)]);
    let line = Line::new("", points.collect::<PlotPoints<'static>>()).color(colour).width(1.2);
    let plot = Plot::new(("profile", number))
        .width(PROFILE_SIZE_POINTS.x)
        .height(PROFILE_SIZE_POINTS.y)
        .min_size(PROFILE_SIZE_POINTS);
    let plot = plot.show_axes(false).show_grid(false).show_x(false).show_y(false).sense(Sense::click());
    let plot = plot.allow_zoom(false).allow_drag(false).allow_scroll(false).allow_boxed_zoom(false);
    let response = plot.include_y(0.0).include_y(-SHOWN_DB).show(ui, |plot| plot.line(line)).response;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Range profile"));
    response
}

/// Draws a slider over the frames of a file. Returns the chosen frame.
pub fn frame_slider(ui: &mut Ui, [frame, count]: [u64; 2]) -> Option<Way> {
    let mut chosen = frame;
    let slider = Slider::new(&mut chosen, 0..=count - 1);
    labelled(ui, format!("Frame of {count}"), "Which frame of the file all maps show", slider);
    (chosen != frame).then_some(Way::Frame(chosen))
}

fn board(ui: &mut Ui, origin: &Origin, asked: &mut Vec<Way>) {
    let is_file = origin.offers.iter().any(|offer| !offer.power.is_empty());
    if origin.config.is_none() || !is_file {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let tooltip = "The board whose antennas are taken; the guide of its maker says the places";
        let mut taken = origin.board.unwrap_or("the .cfg");
        let guide = |name: &str| boards::ALL.iter().find(|board| board.name == name).map_or("", |board| board.guide);
        let offered = boards::ALL.iter().map(|board| board.name);
        choice(ui, "Antennas of", tooltip, &mut taken, offered, |name| ((*name).to_owned(), guide(name)));
        if origin.board != Some(taken) && boards::ALL.iter().any(|board| board.name == taken) {
            asked.push(Way::Board(taken));
        }
    });
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};
    use crate::recording::packets::PacketCounts;

    /// A recording of 20 frames, whose layout is in doubt.
    pub fn some_recording() -> Recording {
        let offer = |description: &str, log_odds: f64| ReadingOption {
            description: description.to_owned(),
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
        let radar = crate::radar::Radar { elements: 8, end_elements: 3, samples: 64, ..crate::radar::Radar::default() };
        let silence = crate::signal::BeatSignal::silence(&radar);
        let doubts = vec!["Antennas are taken for granted.".to_owned()];
        Recording { origin: Some(std::sync::Arc::new(origin)), doubts, ..Recording::of_signal(radar, silence) }
    }

    fn panel(recording: Option<Recording>) -> Harness<'static, Vec<Command>> {
        listening(recording, None)
    }

    /// The panel while a card is listened to with this plan.
    fn listening(recording: Option<Recording>, plan: Option<CardPlan>) -> Harness<'static, Vec<Command>> {
        let packets = PacketCounts { packets: 90, lost_bytes: 1456, ..PacketCounts::default() };
        let summary = CardSummary { frames: 7, dropped: 2, packets };
        let mut port = None;
        seen::asking([520.0, 420.0], move |ui| show(ui, recording.as_ref(), Some((plan.as_ref(), summary)), &mut port))
    }

    #[test]
    fn layouts_frames_board_and_doubts_of_a_recording_are_shown() {
        let empty = panel(None);
        assert!(seen::texts(empty.output()).iter().any(|t| t.text.contains("Drop a capture")));
        let mut panel = panel(Some(some_recording()));
        seen::assert_reads(panel.output(), &["I Q in pairs", "Frame of 20", "xWR1642"]);
        seen::assert_reads(panel.output(), &["Antennas are taken for granted.", "One echo stands out."]);
        seen::assert_readable(panel.output());
        assert_eq!(panel.query_all_by_label("Range profile").count(), 2, "one a layout");
        panel.clicks(&["Q I in pairs"]);
        assert_eq!(panel.state(), &[Command::Document(DocumentCommand::Reread(Way::Layout(1)))]);
    }

    #[test]
    fn a_card_is_listened_to_with_what_is_on_screen() {
        let mut panel = panel(Some(some_recording()));
        panel.clicks(&["Listen"]);
        let plan = CardPlan { port: USUAL_PORT, config: "a.cfg".into(), board: Some("xWR1642") };
        assert_eq!(panel.state(), &[Command::Work(WorkCommand::Listen(plan.clone()))]);
        let mut panel = listening(Some(some_recording()), Some(plan));
        let said = "7 frames came, 2 were dropped, 1456 bytes and 0 whole frames lost";
        assert!(panel.reads(said), "{:?}", seen::texts(panel.output()));
        panel.clicks(&["Stop listening"]);
        assert_eq!(panel.state(), &[Command::Work(WorkCommand::StopListening)]);
    }
}
