//! The networks for the radar on screen, in the menu of methods, or the commands that train one.

use crate::app::state::{Command, Purpose};
use crate::network::live::size::LiveSize;
use crate::radar::{Radar, counted};
use crate::reconstruct::{Family, Reconstructor};
use eframe::egui::{RichText, Ui};
use std::sync::Arc;

/// Number of maps in the training time that is shown. With so many the second edition of `live` was near its end (training/README.md).
const ESTIMATED_MAPS: f64 = 50_000.0;

/// Number of cores in the training time that is shown.
const ESTIMATED_CORES: f64 = 2.0;

/// Names the networks that take the radar, or shows the commands that train one.
pub fn networks(ui: &mut Ui, all: &[Arc<dyn Reconstructor>], radar: &Radar, asked: &mut Vec<Command>) {
    let takes = |method: &&dyn Reconstructor| method.family() == Family::Network && method.check_array(radar).is_ok();
    let fitting: Vec<&str> = all.iter().map(AsRef::as_ref).filter(takes).map(|method| method.name()).collect();
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        ui.strong("Networks for this radar");
        ui.label(if fitting.is_empty() { "none".to_owned() } else { fitting.join(", ") });
        let tip = "Weights of the live network for any radar, as training/train_live.py writes them (.safetensors)";
        if ui.small_button("Open weights…").on_hover_text(tip).clicked() {
            ui.close();
            asked.push(Purpose::Open.into());
        }
    });
    if fitting.is_empty() {
        training(ui, radar);
    }
}

fn training(ui: &mut Ui, radar: &Radar) {
    let size = match LiveSize::for_radar(radar) {
        Ok(size) => size,
        Err(why) => {
            ui.weak(format!("None can be trained: {why}."));
            return;
        }
    };
    let hours = ESTIMATED_MAPS * size.training_seconds_a_map() / ESTIMATED_CORES / 3600.0;
    let time = match hours {
        hours if hours < 2.0 => counted((60.0 * hours).ceil() as u32, "minute", "minutes"),
        hours => counted(hours.round() as u32, "hour", "hours"),
    };
    let minutes = (60.0 * hours).ceil();
    ui.weak(format!(
        "Save the scene as radar.toml, then train one: {ESTIMATED_MAPS} maps in about {time} on two processor cores."
    ));
    let commands = format!(
        "python3 training/train_live.py --radar radar.toml --out own --minutes {minutes} --threads 2\n\
         python3 training/train_live.py --radar radar.toml --out own --export own.safetensors --validation 24"
    );
    ui.label(RichText::new(&commands).monospace().small());
    if ui.small_button("Copy the commands").clicked() {
        ui.ctx().copy_text(commands);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, User};

    fn menu(radar: Radar) -> Harness<'static, Vec<Command>> {
        let all = crate::methods::all();
        let draw = move |ui: &mut Ui, asked: &mut Vec<Command>| {
            networks(ui, &all, &radar, asked);
        };
        let mut menu = Harness::builder().with_size([700.0, 200.0]).build_ui_state(draw, Vec::new());
        menu.run();
        menu
    }

    fn says(menu: &Harness<'_, Vec<Command>>, text: &str) -> bool {
        seen::texts(menu.output()).iter().any(|seen| seen.text.contains(text))
    }

    #[test]
    fn networks_that_take_the_radar_are_named() {
        let mut menu = menu(Radar::default());
        assert!(says(&menu, "live") && !says(&menu, "train_live.py"), "{:?}", seen::texts(menu.output()));
        menu.clicks(&["Open weights…"]);
        assert_eq!(menu.state(), &[Command::AskFile(Purpose::Open)]);
    }

    #[test]
    fn a_radar_without_a_network_is_told_how_to_get_one_or_why_not() {
        let of = |samples| menu(Radar { elements: 86, end_elements: 8, samples, ..Radar::default() });
        let some = of(256);
        for text in ["none", "50000 maps in about", "--radar radar.toml --out own --minutes "] {
            assert!(says(&some, text), "{text}: {:?}", seen::texts(some.output()));
        }
        let none = of(100);
        assert!(says(&none, "None can be trained: its network has rows of 100; expected a multiple of 8"));
        assert!(!says(&none, "train_live.py"));
    }
}
