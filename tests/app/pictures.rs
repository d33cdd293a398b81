//! The app's panels as pictures, compared with those in `tests/snapshots`. Needs a Vulkan driver (lavapipe will do) and is skipped
//! without one. After a change that is meant to be seen: `UPDATE_SNAPSHOTS=1 cargo test --test app pictures`.

use crate::session::*;
use eframe::egui::Theme;
use egui_kittest::SnapshotOptions;
use egui_kittest::wgpu::WgpuTestRenderer;
use std::panic::catch_unwind;

const SCENE: &str = "[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\n\n\
                     [[object]]\nkind = \"point\"\nx_metres = -9.0\ny_metres = 20.0\n\n\
                     [[object]]\nkind = \"line\"\nx_metres = 8.0\ny_start_metres = 8.0\nspacing_metres = 0.5\ncount = 30\n";

fn renderer() -> Option<WgpuTestRenderer> {
    let made = catch_unwind(WgpuTestRenderer::new);
    if made.is_err() {
        eprintln!("skipped: there is no Vulkan driver here");
    }
    made.ok()
}

fn compare(name: &str, theme: Theme, panel: Panel, commands: Vec<Command>) {
    let Some(renderer) = renderer() else { return };
    let folder = tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let options = Options { scene: Some(scene), methods: baseline(), ..Options::default() };
    let mut app: Harness<'_, App> = Harness::builder()
        .with_size([560.0, 400.0])
        .renderer(renderer)
        .build_eframe(|creation| App::new(creation, options).unwrap());
    let light = (theme == Theme::Light).then_some(Command::Window(WindowCommand::ToggleTheme));
    for command in light.into_iter().chain(commands).chain([Command::Window(WindowCommand::Maximise(panel))]) {
        app.state_mut().ask(command);
        app.step();
    }
    let mut s = Session { app, folder };
    s.settle();
    // Times in the status line differ from run to run, and drivers round differently.
    let tolerant = SnapshotOptions::new().threshold(2.0).max_failed_pixels(2500usize);
    s.app.snapshot_options(name, &tolerant);
}

// One picture a test: the harness compares the pictures of one window a thread.
#[test]
fn the_scene_looks_as_in_its_picture() {
    compare("scene-light", Theme::Light, Panel::Scene, vec![EditCommand::SelectAll.into()]);
}

#[test]
fn the_target_looks_as_in_its_picture() {
    compare("target-dark", Theme::Dark, Panel::Map(MapKind::Target), vec![ViewCommand::ToggleReflectors.into()]);
}

#[test]
fn the_guide_looks_as_in_its_picture() {
    compare("guide-light", Theme::Light, Panel::Guide, vec![]);
}
