use super::*;
use crate::app::panels::recording::tests::some_recording;
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::maps::LogMap;
use crate::scene::{Object, Point, Scene};
use eframe::egui::{Color32, ColorImage};
use std::sync::Arc;

fn radar(chirps: usize) -> Radar {
    Radar { elements: 64, samples: 32, chirps, ..Radar::default() }
}

fn result(radar: &Radar) -> DopplerResult {
    let mut decades = ndarray::Array2::from_elem((radar.samples, radar.chirps), -3.0);
    decades[[10, radar.chirps / 2]] = 0.0;
    let image = ColorImage::new([radar.chirps, radar.samples], vec![Color32::BLACK; radar.chirps * radar.samples]);
    DopplerResult { radar: radar.clone(), knows_interval: true, decades: LogMap::new(decades), image: Arc::new(image) }
}

fn drawn(size: [f32; 2], mut state: State, result: Option<DopplerResult>) -> Harness<'static, Vec<Command>> {
    state.settings.normalisation = Normalisation::DynamicRange(crate::radar::Decibels(60.0));
    let mut texture = Texture::default();
    seen::asking(size, move |ui| show(ui, &state, result.as_ref().map(Ok), &mut texture))
}

/// The panel of a recording of 20 frames.
fn recorded(result: Option<DopplerResult>) -> Harness<'static, Vec<Command>> {
    drawn([700.0, 420.0], State::recorded(some_recording()), result)
}

#[test]
fn frames_of_a_recording_play_without_their_clutter() {
    let mut panel = recorded(Some(result(&radar(64))));
    assert!(panel.reads("Frame of 20"));
    for label in ["Play", "Static clutter out"] {
        panel.clicks(&[label]);
    }
    let commands = [ViewCommand::TogglePlay, ViewCommand::TakeOutStaticClutter(true)].map(Command::View);
    assert_eq!(panel.state(), &commands);
}

#[test]
fn a_recording_shows_the_loops_of_its_frame() {
    let texts = |result: Option<DopplerResult>| {
        let panel = recorded(result);
        (seen::texts(panel.output()), panel.query_by_label("Range-Doppler map").is_some())
    };
    let (told, drawn) = texts(Some(result(&radar(64))));
    assert!(drawn && told.iter().any(|t| t.text.contains("in steps of")), "{told:?}");
    let (told, drawn) = texts(None);
    assert!(!drawn && told.iter().any(|t| t.text.contains("raw capture")), "{told:?}");
}

fn panel(size: [f32; 2], chirps: usize, velocity: f64, seconds: f64) -> Harness<'static, Vec<Command>> {
    let point = Point { velocity_y_metres_per_second: velocity, ..Point::new(0.0, 1.0) };
    let scene = Scene { objects: vec![Object::Point(point)], ..Scene::default() };
    let mut state = State::of(radar(chirps), scene);
    state.settings.show_reflectors = true;
    let State { timeline, editor, .. } = &mut state;
    timeline.set(editor.scene(), seconds);
    drawn(size, state, Some(result(&radar(chirps))))
}

#[test]
fn the_map_has_its_axes_in_a_wide_panel_or_a_narrow_one() {
    for size in [[700.0, 420.0], [360.0, 300.0]] {
        let panel = panel(size, 64, -9.0, 0.0);
        let rect = panel.get_by_label("Range-Doppler map").rect();
        assert!(rect.height() > 60.0 && rect.right() <= size[0], "{rect:?}");
        let told = ["radial velocity, m/s", "range, m", "1", "−78.0", "−50", "0", "50", "78.0"];
        seen::assert_reads(panel.output(), &told);
        seen::assert_readable(panel.output());
    }
}

#[test]
fn what_folds_is_said_with_what_helps() {
    let most = radar(64).unambiguous_velocity_metres_per_second();
    let panel = panel([700.0, 420.0], 64, 1.5 * most, 0.0);
    assert!(seen::texts(panel.output()).iter().any(|t| t.text.contains("beyond the unambiguous")));
    seen::assert_reads(panel.output(), &["1 folded"]);
}

#[test]
fn a_cell_tells_its_velocity_with_its_range() {
    let radar = radar(64);
    let found = told(&result(&radar), 0.01, radar.range_of_bin_metres(10.2)).unwrap();
    assert!(found.starts_with("0.00 m/s\nrange 0.75 m\n") && found.ends_with("0.0 dB below the peak"), "{found}");
    let away = told(&result(&radar), 2.0 * radar.velocity_resolution_metres_per_second(), 0.0).unwrap();
    assert!(away.contains("going away") && away.contains("60.0 dB"), "{away}");
    assert_eq!(told(&result(&radar), 1e4, 0.5), None);
}

#[test]
fn every_button_of_chirps_and_time_is_a_command() {
    for (label, command) in [("Play", ViewCommand::TogglePlay), ("Back to 0 s", ViewCommand::SetTime(0.0))] {
        let mut panel = panel([700.0, 420.0], 64, 5.0, 1.0);
        panel.clicks(&[label]);
        assert!(panel.state().contains(&Command::View(command)), "{label}: {:?}", panel.state());
    }
    let mut panel = panel([700.0, 420.0], 1, 5.0, 0.0);
    assert!(panel.query_by_label("Range-Doppler map").is_none());
    panel.clicks(&["Send 128 chirps"]);
    let sends = |c: &Command| matches!(c, Command::Radar(RadarCommand::Set(radar)) if radar.chirps == 128);
    assert!(panel.state().iter().any(sends), "{:?}", panel.state());
}
