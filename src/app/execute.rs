//! What each command does, and how keys and dropped files become commands.

use super::application::App;
use super::command::{Command, NewObject};
use super::files::{Answer, Purpose};
use super::layout::{Layout, Panel};
use super::settings::{Projection, Theme};
use super::view::Window;
use super::{export, theme};
use crate::interact::{Document, Place, Saved, Selection, SelectionMode};
use crate::maps::Normalisation;
use crate::scene::file::SceneFile;
use crate::scene::generate::{Generator, Kind, Purpose as ScenePurpose, Reading};
use crate::scene::{GaussianCluster, Line, Object, Point, presets};
use crate::signal::Floor;
use eframe::egui;
use eframe::egui::{Context, Event, Key, Modifiers};
use std::path::{Path, PathBuf};

/// Turns keys, clipboard events, dropped files and closed dialogs into commands.
pub(super) fn read_input(app: &mut App, ctx: &Context) {
    if let Some(Answer { purpose, path }) = app.files.answer() {
        file_chosen(app, ctx, purpose, path);
    }
    let dropped = ctx.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
    if let Some(path) = dropped {
        match path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
            true => watch(app, path),
            false => app.commands.push(Command::OpenPath(path)),
        }
    }
    export::poll(app);
    if ctx.input(|i| i.pointer.any_released()) {
        app.editor.seal();
    }
    if app.palette.is_open() {
        return;
    }
    if ctx.text_edit_focused() {
        return;
    }
    let events = ctx.input(|i| i.events.clone());
    for event in events {
        match event {
            Event::Copy => app.commands.push(Command::Copy),
            Event::Cut => app.commands.push(Command::Cut),
            Event::Paste(text) => app.commands.push(Command::PasteText(text)),
            _ => {}
        }
    }
    ctx.input_mut(|input| {
        // Longer shortcuts first: Ctrl+Shift+Z would also match Ctrl+Z.
        let mut commands: Vec<_> =
            Command::all().into_iter().filter_map(|c| c.spec().shortcut.map(|s| (s, c))).collect();
        commands.sort_by_key(|(s, _)| !(s.modifiers.shift || s.modifiers.alt));
        for (shortcut, command) in commands {
            // The system turns these three into events of their own.
            if !matches!(command, Command::Copy | Command::Cut | Command::Paste) && input.consume_shortcut(&shortcut) {
                app.commands.push(command);
            }
        }
        if input.consume_key(Modifiers::NONE, Key::Backspace) {
            app.commands.push(Command::Delete);
        }
        if input.consume_key(Modifiers::COMMAND, Key::Y) {
            app.commands.push(Command::Redo);
        }
        if input.consume_key(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::P) {
            app.commands.push(Command::Palette);
        }
    });
    nudge(app, ctx);
}

/// Arrow keys move the selection by one range bin, with Shift by ten, with Alt by a tenth.
fn nudge(app: &mut App, ctx: &Context) {
    if app.editor.selection().is_empty() || ctx.memory(|m| m.focused().is_some()) {
        return;
    }
    let bin = app.radar.range_resolution_metres();
    let (mut dx, mut dy) = (0.0, 0.0);
    ctx.input_mut(|input| {
        for (modifiers, step) in [(Modifiers::SHIFT, 10.0), (Modifiers::ALT, 0.1), (Modifiers::NONE, 1.0)] {
            let mut pressed = |key| input.count_and_consume_key(modifiers, key) as f64 * step;
            dx += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
            dy += pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
        }
    });
    if (dx, dy) != (0.0, 0.0) {
        app.editor.nudge(dx * bin, dy * bin);
    }
}

fn file_chosen(app: &mut App, ctx: &Context, purpose: Purpose, path: PathBuf) {
    match purpose {
        Purpose::Open => app.commands.push(Command::OpenPath(path)),
        Purpose::OpenLog => watch(app, path),
        Purpose::SaveScene => save(app, path),
        Purpose::ExportPicture => export::picture(app, ctx, path),
        Purpose::ExportMaps => export::maps(app, ctx, path),
        Purpose::ExportMetrics => export::metrics(app, &path),
    }
}

/// Watches the log of a training.
fn watch(app: &mut App, path: PathBuf) {
    app.training.follow(path);
    app.layout.set_open(Panel::Training, true);
}

fn save(app: &mut App, mut path: PathBuf) {
    if path.extension().is_none() {
        path.set_extension("toml");
    }
    match app.editor.save(&path) {
        Ok(Saved::Whole) => {
            app.files.remember(&path);
            app.info(format!("Saved {}", path.display()));
        }
        Ok(Saved::Copy(losses)) => {
            let lost: Vec<String> = losses.iter().map(ToString::to_string).collect();
            let lost = lost.join(", ");
            app.info(format!(
                "{} holds a copy without {lost}. The scene itself is still unsaved: save it as .toml to keep everything.",
                path.display()
            ));
        }
        Err(message) => app.error(format!("{message}\nNothing was written; choose another place with Save as…")),
    }
}

fn ask_file(app: &mut App, ctx: &Context, purpose: Purpose) {
    let ctx = ctx.clone();
    if let Err(error) = app.files.ask(purpose, app.editor.document().path(), move || ctx.request_repaint()) {
        app.error(format!("The file dialog could not be opened: {error}. Drop a file on the window instead."));
    }
}

/// Does a command.
pub(super) fn run(app: &mut App, ctx: &Context, command: Command) {
    match command {
        Command::New => {
            app.set_document("new scene", Document::default());
        }
        Command::Open => ask_file(app, ctx, Purpose::Open),
        Command::OpenPath(path) => app.open(path),
        Command::Save => match app.editor.document().path().map(Path::to_owned) {
            Some(path) => save(app, path),
            None => ask_file(app, ctx, Purpose::SaveScene),
        },
        Command::SaveAs => ask_file(app, ctx, Purpose::SaveScene),
        Command::Preset(index) => preset(app, index),
        Command::RandomScene(kind) => random_scene(app, kind),
        Command::OpenLog => ask_file(app, ctx, Purpose::OpenLog),
        Command::ExportPicture => ask_file(app, ctx, Purpose::ExportPicture),
        Command::ExportMaps => ask_file(app, ctx, Purpose::ExportMaps),
        Command::ExportMetrics => ask_file(app, ctx, Purpose::ExportMetrics),
        Command::Undo => {
            app.editor.undo();
            app.follow_document();
        }
        Command::Redo => {
            app.editor.redo();
            app.follow_document();
        }
        Command::Cut => {
            copy(app, ctx);
            app.editor.delete_selected();
        }
        Command::Copy => copy(app, ctx),
        Command::Paste => ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
        Command::PasteText(text) => {
            if let Err(error) = app.editor.paste(&text) {
                app.error(format!("Nothing was pasted: {error}"));
            }
        }
        Command::Duplicate => {
            if let Err(error) = app.editor.duplicate_selected() {
                app.error(format!("Nothing was duplicated: {error}"));
            }
        }
        Command::Delete => app.editor.delete_selected(),
        Command::SelectAll => app.editor.select_all(),
        Command::Escape => escape(app),
        Command::Add(kind, place) => add(app, kind, place),
        Command::FitScene => app.scene_view.fit = true,
        Command::ResetMaps => (app.range_angle, app.cartesian) = (Window::default(), Window::default()),
        Command::TogglePanel(panel) => app.layout.toggle(panel),
        Command::ClosePanel(panel) => app.layout.set_open(panel, false),
        Command::OpenPanel(panel) => app.layout.set_open(panel, true),
        Command::Maximise(panel) => app.layout.toggle_maximised(panel),
        Command::ResetLayout => app.layout = Layout::default(),
        Command::ToggleProjection => {
            app.settings.projection = match app.settings.projection {
                Projection::RangeAngle => Projection::Cartesian,
                Projection::Cartesian => Projection::RangeAngle,
            }
        }
        Command::SetProjection(projection) => app.settings.projection = projection,
        Command::Colours(colours) => app.settings.colours = colours,
        Command::Normalise(normalisation) => {
            app.settings.normalisation = normalisation;
            if let Normalisation::DynamicRange(db) = normalisation {
                app.settings.dynamic_range = db;
            }
        }
        Command::SetFloor(floor) => {
            app.settings.floor = floor;
            if let Floor::Snr(snr) = floor {
                app.settings.snr = snr;
            }
        }
        Command::SetCarrier(carrier) => app.edit_radar("carrier", |r| r.carrier = carrier),
        Command::SetWindow(window) => app.edit_radar("window", |r| r.window = window),
        Command::ToggleReflectors => app.settings.show_reflectors ^= true,
        Command::ToggleFieldsOfView => app.settings.show_fields_of_view ^= true,
        Command::Method(name) => app.settings.method = name.to_owned(),
        Command::NextMethod => next_method(app),
        Command::CancelMethod => app.pipeline.cancel_method(),
        Command::CloseMessages => app.messages.clear(),
        Command::ToggleTheme => {
            app.settings.theme = if ctx.theme() == egui::Theme::Dark { Theme::Light } else { Theme::Dark };
            theme::apply(ctx, app.settings.theme);
        }
        Command::ZoomIn => ctx.set_zoom_factor((ctx.zoom_factor() + 0.1).min(3.0)),
        Command::ZoomOut => ctx.set_zoom_factor((ctx.zoom_factor() - 0.1).max(0.5)),
        Command::ZoomReset => ctx.set_zoom_factor(1.0),
        Command::Palette => app.palette.toggle(),
        Command::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
    }
    ctx.request_repaint();
}

fn copy(app: &mut App, ctx: &Context) {
    match app.editor.copy() {
        Some(text) => ctx.copy_text(text),
        None => app.info("Nothing is selected: click an object, or drag a box around several."),
    }
}

fn escape(app: &mut App) {
    if app.editor.dragged().is_some() {
        app.editor.cancel_drag();
    } else if app.layout.maximised().is_some() {
        app.layout.restore();
    } else {
        app.editor.select([], SelectionMode::Replace);
    }
    app.box_start = None;
}

fn preset(app: &mut App, index: usize) {
    let Some(preset) = presets::ALL.get(index) else { return };
    match preset.load() {
        Ok(file) => app.set_document("preset", Document::shipped(file)),
        Err(error) => app.error(format!("Preset {}: {error}", preset.id)),
    }
}

fn random_scene(app: &mut App, kind: Kind) {
    let seed = app.settings.random_seed;
    let scene = Generator::new(&app.radar, Reading::Program, ScenePurpose::Test, seed).scene(kind, 0);
    app.settings.random_seed = seed.wrapping_add(1);
    app.set_document("random scene", Document::made(SceneFile { scene, radar: app.radar.clone() }));
}

/// Adds an object at `place`, or in the middle of the visible scene, beside whatever is there already.
fn add(app: &mut App, kind: NewObject, place: Option<Place>) {
    let bin = app.radar.range_resolution_metres();
    let mut at = place.unwrap_or(Place::new(app.scene_view.centre.x_metres, app.scene_view.centre.y_metres.max(2.0)));
    if place.is_none() {
        while app.editor.hit(at, app.scene_view.metres_per_point).is_some() {
            at.x_metres += 20.0 * app.scene_view.metres_per_point;
        }
    }
    let Place { x_metres, y_metres } = at;
    app.editor.add(match kind {
        NewObject::Point => Object::Point(Point::new(x_metres, y_metres)),
        NewObject::Line => {
            let (count, spacing_metres) = (75, 1.5 * bin);
            let y_start_metres = (y_metres - spacing_metres * (count - 1) as f64 / 2.0).max(bin);
            Object::Line(Line::vertical(x_metres, y_start_metres, spacing_metres, count))
        }
        NewObject::Cluster => Object::Gaussian(GaussianCluster {
            x_metres,
            y_metres,
            x_std_metres: 1.0,
            y_std_metres: 1.0,
            count: 40,
            seed: app.editor.scene().objects.len() as u64,
            reflectivity: 1.0,
        }),
    });
    debug_assert_eq!(app.editor.selection(), &Selection::of([app.editor.scene().objects.len() - 1]));
}

fn next_method(app: &mut App) {
    let Some(current) = app.method() else { return };
    let methods = &app.pipeline.methods;
    let index = methods.iter().position(|m| m.name() == current.name()).unwrap_or(0);
    app.settings.method = methods[(index + 1) % methods.len()].name().to_owned();
}
