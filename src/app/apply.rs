//! What each command does: the only place that changes settings, and the only one that starts work.

mod hand;
mod lessons;
mod map_picture;
mod radar;
mod saving;
mod shared;

pub use shared::of as shared_text;

use super::jobs::{EvaluationPlan, Jobs, Purpose, tell};
use super::state::{
    Arrangement, Brightness, Command, EvaluationChoice, MapKind, MapViews, NewObject, Panel, PinnedCut, Projection,
    Settings, State, Units,
};
use crate::evaluate::campaign::Campaign;
use crate::interact::{Document, Place, SelectionMode};
use crate::recording;
use crate::scene::file::SceneFile;
use crate::scene::generate::{Generator, Kind, Purpose as ScenePurpose, Reading};
use crate::scene::{GaussianCluster, Line, Object, Point, presets};
use crate::signal::Floor;
use eframe::egui::ColorImage;
use std::path::{Path, PathBuf};

/// What a command asks of the window.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Light or dark.
    Brightness(Brightness),
    /// Another size of the interface, as a factor; back to normal where `None`.
    Zoom(Option<f32>),
    /// This text on the clipboard.
    Copy(String),
    /// This picture on the clipboard.
    CopyImage(ColorImage),
    /// Ask the system for the clipboard.
    RequestPaste,
    /// Show or hide the palette.
    Palette,
    /// Close.
    Close,
}

/// Does a command.
pub fn apply(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Effect> {
    if let Command::Guided(commands) = command {
        let before = state.setup();
        for command in commands {
            apply(state, jobs, command);
        }
        let after = state.setup();
        state.guided.push(before, after);
        return None;
    }
    // Each looks for its own commands and hands the others on.
    let left = shared::apply(state, jobs, command)
        .and_then(|c| settings(&mut state.settings, c))
        .and_then(|c| edit(state, c))
        .and_then(|c| hand::apply(state, c))
        .and_then(|c| radar::apply(state, c))
        .and_then(|c| scenes(state, jobs, c))
        .and_then(|c| lessons::apply(state, jobs, c))
        .and_then(|c| panels(state, c))
        .and_then(|c| exports(state, jobs, c))
        .and_then(|c| work(state, jobs, c))?;
    window(state, jobs, left)
}

/// Commands that change what the user chose.
fn settings(settings: &mut Settings, command: Command) -> Option<Command> {
    match command {
        Command::ToggleProjection => {
            settings.projection = match settings.projection {
                Projection::RangeAngle => Projection::Cartesian,
                Projection::Cartesian => Projection::RangeAngle,
            }
        }
        Command::SetProjection(projection) => settings.projection = projection,
        Command::ToggleUnits => {
            settings.units = match settings.units {
                Units::Lambda => Units::Decibels,
                Units::Decibels => Units::Lambda,
            }
        }
        Command::SetUnits(units) => settings.units = units,
        Command::ToggleAbsoluteDifference => settings.difference.absolute ^= true,
        Command::ToggleWholeDifference => settings.difference.whole ^= true,
        Command::Colours(colours) => settings.colours = colours,
        Command::Normalise(normalisation) => settings.normalisation = normalisation,
        Command::SetFloor(floor) => {
            settings.floor = floor;
            if let Floor::Snr(snr) = floor {
                settings.snr = snr;
            }
        }
        Command::SetNextRandom { seed, number } => (settings.random_seed, settings.random_number) = (seed, number),
        Command::SetTargetEta(eta) => settings.target_eta = eta,
        Command::SetMethodEta(method, Some(eta)) => _ = settings.method_eta.insert(method.to_owned(), eta),
        Command::SetMethodEta(method, None) => _ = settings.method_eta.remove(method),
        Command::SetSnap(snap) => settings.snap = snap,
        Command::SetCoordinates(coordinates) => settings.coordinates = coordinates,
        Command::SetBounds(bounds) => settings.bounds = bounds,
        Command::MarkReflectors => settings.show_reflectors = true,
        Command::ToggleReflectors => settings.show_reflectors ^= true,
        Command::ToggleFound => settings.show_found ^= true,
        Command::ToggleFieldsOfView => settings.show_fields_of_view ^= true,
        Command::SetSeveral(several) => settings.several = *several,
        Command::ToggleTheory => settings.show_theory ^= true,
        Command::Method(name) => settings.method = name.to_owned(),
        other => return Some(other),
    }
    None
}

/// Commands that change the scene on screen or its selection.
fn edit(state: &mut State, command: Command) -> Option<Command> {
    let editor = &mut state.editor;
    match command {
        Command::Undo => state.undo(),
        Command::Redo => state.redo(),
        Command::Seal => editor.seal(),
        Command::PasteText(text) => {
            if let Err(error) = editor.paste(&text) {
                state.notices.error(format!("Nothing was pasted: {error}"));
            }
        }
        Command::Duplicate => {
            if let Err(error) = editor.duplicate_selected() {
                state.notices.error(format!("Nothing was duplicated: {error}"));
            }
        }
        Command::Delete => editor.delete_selected(),
        Command::SelectAll => editor.select_all(),
        Command::Nudge { dx_metres, dy_metres } => editor.nudge(dx_metres, dy_metres),
        Command::Add(kind, place) => add(state, kind, place),
        Command::SetNoiseSeed(seed) => {
            editor.edit("noise seed", Some("noise seed"), |scene, _| scene.noise_seed = seed);
        }
        other => return Some(other),
    }
    None
}

/// Commands that put another scene on screen, or this one in a file.
fn scenes(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Command> {
    match command {
        Command::New => {
            state.set_document("new scene", Document::default());
        }
        Command::Open => jobs.choose_file(state, Purpose::Open),
        Command::OpenPath(path) => open(state, path),
        Command::Save => match state.editor.document().path().map(Path::to_owned) {
            Some(path) => saving::save(state, path),
            None => jobs.choose_file(state, Purpose::SaveScene),
        },
        Command::SaveAs => jobs.choose_file(state, Purpose::SaveScene),
        Command::SaveTo(path) => saving::save(state, path),
        Command::AnswerLosses(answer) => saving::answer(state, jobs, answer),
        Command::Recover(id) => state.scene_view.fit |= state.editor.recover(id),
        Command::Discard(id) => state.editor.discard(id),
        Command::Preset(index) => preset(state, index),
        Command::Recording(index) => shipped_recording(state, index),
        Command::RandomScene(kind) => random_scene(state, kind),
        other => return Some(other),
    }
    None
}

/// Commands that move panels, or what they show.
fn panels(state: &mut State, command: Command) -> Option<Command> {
    match command {
        Command::Escape => escape(state),
        Command::Hover(cursor) => state.pointer.hover(cursor),
        Command::FitScene => state.scene_view.fit = true,
        Command::ResetMaps => state.map_views = MapViews::default(),
        Command::TogglePanel(panel) => state.arrangement.toggle(panel),
        Command::ClosePanel(panel) => state.arrangement.set_open(panel, false),
        Command::OpenPanel(panel) => state.arrangement.set_open(panel, true),
        Command::Maximise(panel) => state.arrangement.toggle_maximised(panel),
        Command::ResetLayout => {
            state.stop_presenting();
            state.arrangement = Arrangement::default();
        }
        Command::Present => state.present(),
        Command::CloseMessages => state.notices.clear(),
        other => return Some(other),
    }
    None
}

/// Commands that write for other programs.
fn exports(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Command> {
    let said = match command {
        Command::ExportPicture => return choose(state, jobs, Purpose::ExportPicture),
        Command::ExportMaps => return choose(state, jobs, Purpose::ExportMaps),
        Command::ExportMetrics => return choose(state, jobs, Purpose::ExportMetrics),
        Command::RecordDrag => return choose(state, jobs, Purpose::RecordDrag),
        Command::DrawLesson => return choose(state, jobs, Purpose::DrawLesson),
        Command::StopRecording => Ok(jobs.recorder.cancel().unwrap_or_else(|| "Nothing is recorded.".to_owned())),
        Command::RecordDragTo(path) => jobs.recorder.record_drag(path),
        Command::DrawLessonTo(path) => jobs.recorder.draw_lesson(state, path),
        Command::ExportPictureTo(path) => jobs.exports.picture(state, path),
        Command::ExportMapsTo(path) => jobs.exports.maps(state, path),
        Command::ExportMetricsTo(path) => jobs.exports.metrics(state, &jobs.pipeline, path),
        other => return Some(other),
    };
    tell(state, said);
    None
}

fn choose(state: &mut State, jobs: &mut Jobs, purpose: Purpose) -> Option<Command> {
    jobs.choose_file(state, purpose);
    None
}

/// Commands that start long work, or stop it.
fn work(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Command> {
    match command {
        Command::NextMethod => {
            let next = state.method().and_then(|now| state.methods.after(now.name()));
            next.into_iter().for_each(|name| state.settings.method = name.to_owned());
        }
        Command::PinCuts => {
            let (radar, cursor) = (state.radar().clone(), state.cut_cursor());
            state.pins.push(PinnedCut { radar, cursor, maps: jobs.pipeline.cut_maps() });
        }
        Command::Unpin(index) => state.pins.remove(index),
        Command::UnpinAll => state.pins.clear(),
        Command::CancelMethod => jobs.pipeline.cancel_method(),
        Command::Evaluate(choice) => jobs.evaluation.begin(evaluation_plan(state, &choice)),
        Command::CancelEvaluation => jobs.evaluation.cancel(),
        Command::Measure { thorough } => jobs.run_time.begin(state.radar().clone(), thorough),
        Command::CancelMeasurement => jobs.run_time.cancel(),
        Command::OpenLog => jobs.choose_file(state, Purpose::OpenLog),
        Command::WatchLog(path) => {
            jobs.training.follow(path);
            state.arrangement.set_open(Panel::Training, true);
        }
        Command::Train(recipe) => train(state, jobs, recipe),
        Command::CancelTraining => jobs.training.cancel(),
        other => return Some(other),
    }
    None
}

/// Commands that the window has to do.
fn window(state: &mut State, jobs: &Jobs, command: Command) -> Option<Effect> {
    Some(match command {
        Command::Cut => {
            let copied = copy(state);
            state.editor.delete_selected();
            return copied;
        }
        Command::Copy => return copy(state),
        Command::CopyShared => Effect::Copy(shared::text(state)?),
        Command::CopyEvaluation => Effect::Copy(jobs.evaluation.to_csv()),
        Command::Paste => Effect::RequestPaste,
        Command::CopyMap(kind) => return map_picture::copy(state, jobs, kind).map(Effect::CopyImage),
        Command::ToggleTheme => {
            state.settings.theme = if state.dark { Brightness::Light } else { Brightness::Dark };
            Effect::Brightness(state.settings.theme)
        }
        Command::ZoomIn => Effect::Zoom(Some(0.1)),
        Command::ZoomOut => Effect::Zoom(Some(-0.1)),
        Command::ZoomReset => Effect::Zoom(None),
        Command::Palette => Effect::Palette,
        Command::Quit => Effect::Close,
        unknown => {
            debug_assert!(false, "nobody does {unknown:?}");
            return None;
        }
    })
}

fn copy(state: &mut State) -> Option<Effect> {
    let copied = state.editor.copy().map(Effect::Copy);
    if copied.is_none() {
        state.notices.info("Nothing is selected: click an object, or drag a box around several.");
    }
    copied
}

/// Opens a scene file or a recording; on any error the scene on screen stays.
pub fn open(state: &mut State, path: PathBuf) {
    if let Some(document) = read(state, &path) {
        show(state, "open", document);
    }
}

/// Puts a document on screen, and where it is a recording, what recordings are looked at with.
fn show(state: &mut State, label: &str, document: Document) {
    let is_recording = document.recording().is_some();
    state.set_document(label, document);
    if is_recording {
        show_recording_panels(state);
    }
}

/// The list of what was found in front, and what reflectors leave unexplained behind the output.
pub fn show_recording_panels(state: &mut State) {
    for panel in [Panel::Map(MapKind::Unexplained), Panel::Map(MapKind::Output), Panel::Found] {
        state.arrangement.set_open(panel, true);
    }
}

/// Reads a scene file or a recording; says why where it can't.
pub fn read(state: &mut State, path: &Path) -> Option<Document> {
    let read = match recording::file::is_recording_at(path) {
        true => Document::read_recording(path).map_err(|e| e.to_string()),
        false => Document::read(path).map_err(|e| e.to_string()),
    };
    match read {
        Ok(document) => {
            state.remember(path);
            Some(document)
        }
        Err(error) => {
            state.notices.error(format!("{error}\nThe scene on screen was kept."));
            None
        }
    }
}

fn escape(state: &mut State) {
    if state.editor.dragged().is_some() {
        state.editor.cancel_drag();
    } else if state.arrangement.maximised().is_some() {
        state.arrangement.restore();
    } else if state.is_presenting() {
        state.stop_presenting();
    } else {
        state.editor.select([], SelectionMode::Replace);
    }
    state.scene_view.box_start = None;
}

fn preset(state: &mut State, index: usize) {
    let Some(preset) = presets::ALL.get(index) else { return };
    match preset.load() {
        Ok(file) => {
            state.set_document("preset", Document::shipped(file));
        }
        Err(error) => state.notices.error(format!("Preset {}: {error}", preset.id)),
    }
}

fn shipped_recording(state: &mut State, index: usize) {
    let Some(preset) = recording::presets::ALL.get(index) else { return };
    match Document::shipped_recording(preset) {
        Ok(document) => show(state, "recording", document),
        Err(error) => state.notices.error(format!("Recording {}: {error}", preset.id)),
    }
}

fn random_scene(state: &mut State, kind: Kind) {
    let Settings { random_seed: seed, random_number: number, .. } = state.settings;
    let scene = Generator::new(state.radar(), Reading::Program, ScenePurpose::Test, seed).scene(kind, number);
    state.settings.random_number = number.wrapping_add(1);
    let file = SceneFile { scene, radar: state.radar().clone() };
    state.set_document("random scene", Document::made(file));
}

/// Adds an object at `place`, or in the middle of the visible scene, beside whatever is there already.
fn add(state: &mut State, kind: NewObject, place: Option<Place>) {
    let (bin, view) = (state.radar().range_resolution_metres(), state.scene_view);
    let mut at = place.unwrap_or(Place::new(view.centre.x_metres, view.centre.y_metres.max(2.0)));
    if place.is_none() {
        while state.editor.hit(at, view.metres_per_point).is_some() {
            at.x_metres += 20.0 * view.metres_per_point;
        }
    }
    let Place { x_metres, y_metres } = at;
    state.editor.add(match kind {
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
            seed: state.editor.scene().objects.len() as u64,
            reflectivity: 1.0,
        }),
    });
}

fn evaluation_plan(state: &State, choice: &EvaluationChoice) -> EvaluationPlan {
    let campaign = Campaign {
        radar: state.radar().clone(),
        count: choice.count,
        seed: choice.seed,
        floor: state.settings.floor,
        normalisation: state.settings.normalisation,
        ..Campaign::default()
    };
    let methods = state.methods.all.iter().filter(|m| choice.methods.contains(&m.name())).cloned().collect();
    EvaluationPlan { campaign, sets: choice.sets.clone(), methods }
}

#[cfg(feature = "network")]
fn train(state: &mut State, jobs: &mut Jobs, name: &str) {
    use crate::network::recipe::{Recipe, SHIPPED};
    let shipped = SHIPPED.iter().find(|(shipped, _)| *shipped == name);
    let Some(recipe) = shipped.and_then(|(name, text)| Recipe::parse(name, text).ok()) else { return };
    let steps = recipe.training_scenes().len() / recipe.batch.max(1) * recipe.epochs as usize;
    let Some(folder) = jobs.new_run(name) else {
        return state.notices.error("There is no folder to train in; start it with apertura train instead.");
    };
    tell(
        state,
        match jobs.training.begin(name, &folder, Some(steps as u64)) {
            Ok(()) => Ok(format!("Training {name} in {}", folder.display())),
            Err(error) => Err(format!("{}: the training can't be started: {error}", folder.display())),
        },
    );
}

#[cfg(not(feature = "network"))]
fn train(state: &mut State, _: &mut Jobs, _: &str) {
    state.notices.error("This build can't train.");
}
