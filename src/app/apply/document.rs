//! Commands that open, save, make and share documents.

use super::{saving, shared};
use crate::app::jobs::{Jobs, is_live};
use crate::app::state::{DocumentCommand, LiveFrame, MapKind, Panel, Settings, State, Way};
use crate::interact::Document;
#[cfg(feature = "live")]
use crate::methods;
use crate::platform::Instant;
use crate::recording::raw::boards;
use crate::recording::{self, Recording, raw};
use crate::scene::file::SceneFile;
use crate::scene::generate::{Generator, Kind, Purpose as ScenePurpose, Reading};
use crate::scene::{Scene, presets};
use crate::signal::Floor;
use std::path::{Path, PathBuf};

/// Carries out a command.
///
/// # Errors
/// A sentence for the user where a preset, a weight file or a shared text can't be read. Errors of scene files and recordings are shown as notices.
pub fn apply(state: &mut State, jobs: &mut Jobs, command: DocumentCommand) -> Result<(), String> {
    match command {
        DocumentCommand::New => {
            let file = SceneFile { radar: state.radar().clone(), ..SceneFile::default() };
            state.set_document(Document::shipped(file));
        }
        DocumentCommand::OpenPath(path) => open(state, path)?,
        DocumentCommand::Save => saving::save_again(state, jobs),
        DocumentCommand::SaveTo(path) => saving::save(state, path),
        DocumentCommand::AnswerSave(answer) => saving::answer(state, jobs, answer),
        DocumentCommand::Recover(id) => state.scene_view.fit |= state.editor.recover(id),
        DocumentCommand::Discard(id) => state.editor.discard(id),
        DocumentCommand::Preset(index) => open_preset(state, index)?,
        DocumentCommand::Recording(index) => open_shipped_recording(state, index)?,
        DocumentCommand::Reread(way) => reread(state, way),
        DocumentCommand::ShowFrame(frame) => show_frame(state, jobs, frame),
        DocumentCommand::RandomScene(kind) => open_random_scene(state, kind),
        DocumentCommand::SetNextRandom { seed, number } => {
            (state.settings.random_seed, state.settings.random_number) = (seed, number);
        }
        DocumentCommand::OpenShared(text) => shared::open(state, &text)?,
    }
    Ok(())
}

/// Opens a scene file, a recording or a weight file. After an error the scene on screen stays.
fn open(state: &mut State, path: PathBuf) -> Result<(), String> {
    #[cfg(feature = "live")]
    if crate::files::ends_in(&path, &["safetensors"]) {
        return open_weights(state, &path);
    }
    if let Some(document) = read(state, &path) {
        show_document(state, document);
    }
    Ok(())
}

/// Adds the live network with the weights of a file, and selects it where it takes the radar on screen.
#[cfg(feature = "live")]
fn open_weights(state: &mut State, path: &Path) -> Result<(), String> {
    let method = methods::add_weights(path)?;
    let name = method.name();
    state.methods.add(method.clone());
    match method.check_array(state.radar()) {
        Ok(()) => {
            state.settings.method = name.to_owned();
            state.notices.info(format!("{name} is used: the live network with the weights of {}.", path.display()));
        }
        Err(error) => state.notices.info(format!("{name} is one of the methods now. {error}.")),
    }
    Ok(())
}

/// Shows a document, selects a method that takes its radar, and opens the panels of a recording.
fn show_document(state: &mut State, document: Document) {
    state.set_document(document);
    opened(state);
}

/// Selects a method that takes the radar of the document on screen, and opens the panels of a recording.
pub fn opened(state: &mut State) {
    select_usable_method(state);
    let Some(recording) = state.editor.document().recording() else { return };
    // The panel of the recording lists the doubts about it.
    let is_doubtful = recording.origin.is_some() || !recording.doubts.is_empty();
    let listed = [state.finds_reflectors().then_some(Panel::Found), is_doubtful.then_some(Panel::Recording)];
    // The map opened last is in front: the output.
    let maps = [MapKind::Unexplained, MapKind::Output].map(|kind| Some(Panel::Map(kind)));
    for panel in maps.into_iter().chain(listed).flatten() {
        state.arrangement.set_open(panel, true);
    }
}

/// Selects a method that takes the radar of the document on screen, or the layout in use, where the method in use doesn't. A notice tells the user.
pub fn select_usable_method(state: &mut State) {
    select_method_for_layout(state);
    if state.settings.layout.is_some() {
        return;
    }
    let Some(method) = state.method().filter(|method| method.check_array(state.radar()).is_err()) else { return };
    let name = method.name();
    if let Some(other) = state.methods.instead_of(name, state.radar()) {
        state.settings.method = other.to_owned();
        state.notices.info(format!("{name} can't do this radar: {other} is used instead."));
    }
}

/// Selects a method that takes the layout in use, where the method in use doesn't. Where the document on screen lacks elements of the layout, the two
/// ends are used in its place. A notice tells the user of either change.
pub fn select_method_for_layout(state: &mut State) {
    let Some(kind) = &state.settings.layout else { return };
    let has_ends_alone = state.editor.document().recording().is_some_and(|recording| recording.signal().is_none());
    let layout = match kind.numbers(state.radar()) {
        _ if has_ends_alone => Err("the recording has the samples of the two ends alone".to_owned()),
        numbers => numbers.map_err(|error| error.to_string()),
    };
    let layout = match layout {
        Ok(layout) => layout,
        Err(problem) => {
            state.settings.layout = None;
            return state.notices.info(format!("The two ends are heard: {problem}."));
        }
    };
    let Some(method) = state.method() else { return };
    let Err(refusal) = method.check_elements(state.radar(), &layout) else { return };
    if let Some(other) = state.methods.hearing(state.radar(), &layout) {
        state.settings.method = other.to_owned();
        state.notices.info(format!("{refusal}. {other} is used instead."));
    }
}

/// Reads a scene file or a recording. `None` after an error, which a notice tells the user.
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

fn open_preset(state: &mut State, index: usize) -> Result<(), String> {
    let Some(preset) = presets::ALL.get(index) else { return Ok(()) };
    let file = preset.load().map_err(|error| format!("Preset {}: {error}", preset.id))?;
    // A preset of a failure needs its own radar: its method fails with that radar.
    let keeps_radar = !preset.has_radar() && !preset.is_failure();
    let before = state.setup();
    preset.failing_method().into_iter().for_each(|name| state.settings.method = name.to_owned());
    let radar = if keeps_radar { state.radar().clone() } else { file.radar.clone() };
    let document = Document::shipped(SceneFile { radar, ..file });
    state.failures.wanted = preset.is_failure().then(|| document.id());
    state.set_document(document);
    select_usable_method(state);
    if preset.is_failure() {
        // Undo brings back the method together with the scene.
        let after = state.setup();
        state.guided.push(before, after);
    }
    Ok(())
}

fn open_shipped_recording(state: &mut State, index: usize) -> Result<(), String> {
    let Some(preset) = recording::presets::ALL.get(index) else { return Ok(()) };
    let read = Document::shipped_recording(preset);
    show_document(state, read.map_err(|error| format!("Recording {}: {error}", preset.id))?);
    Ok(())
}

/// Reads the file of the recording on screen with another layout, frame or board. After an error the recording stays as it is.
fn reread(state: &mut State, way: Way) {
    let Some(origin) = state.editor.document().recording().and_then(|r| r.origin.clone()) else { return };
    let read = match way {
        Way::Layout(taken) => origin.with(taken, 0),
        Way::Frame(frame) => origin.with(origin.taken, frame),
        Way::Board(name) => raw::import(&origin.data, origin.config.as_deref(), boards::by_name(name))
            .and_then(|imported| imported.origin.recording()),
    };
    match read {
        Ok(recording) => {
            let Some(document) = state.editor.document().reread(recording) else { return };
            if matches!(way, Way::Frame(_)) {
                state.editor.open_frame(document);
            } else {
                state.editor.open(document);
                select_usable_method(state);
            }
        }
        Err(error) => {
            state.timeline.play_frames(false);
            state.notices.error(format!("{error}\nThe recording on screen was kept."));
        }
    }
}

/// Shows the newest frame of a capture card. Where another document came on screen since the last frame, the reception of frames ends.
fn show_frame(state: &mut State, jobs: &mut Jobs, frame: LiveFrame) {
    let LiveFrame { recording, config, is_first } = frame;
    let recording = Recording::clone(&recording);
    if is_first {
        return show_document(state, Document::of_frame(recording, &config));
    }
    let on_screen = state.editor.document();
    let is_same_capture = on_screen.recording().is_some_and(|shown| is_live(shown, &config));
    match on_screen.reread(recording).filter(|_| is_same_capture) {
        Some(document) => state.editor.open_frame(document),
        None => {
            jobs.listening.stop();
            state.notices.info("The capture card is not listened to any more: something else is on screen.");
        }
    }
}

/// Starts or stops the playback of the recording's frames. It starts again at the first frame where the last is on screen.
pub fn play_frames(state: &mut State, is_playing: bool) {
    state.timeline.play_frames(is_playing);
    if is_playing && state.frames().is_some_and(|[frame, count]| frame + 1 >= count) {
        reread(state, Way::Frame(0));
        state.timeline.frame_took(0.0);
    }
}

/// Shows the recording's next frame where it is due. `step` is the time since the last call, seconds. Playback stops at the last frame.
pub fn next_frame(state: &mut State, step: f64) {
    let [frame, count] = state.frames().unwrap_or_default();
    if frame + 1 >= count {
        state.timeline.play_frames(false);
    } else if state.timeline.is_frame_due(step) {
        let began = Instant::now();
        reread(state, Way::Frame(frame + 1));
        state.timeline.frame_took(began.elapsed().as_secs_f64());
    }
}

fn open_random_scene(state: &mut State, kind: Kind) {
    let Settings { random_seed: seed, random_number: number, .. } = state.settings;
    let scene = Generator::new(state.radar(), Reading::Program, ScenePurpose::Test, seed).scene(kind, number);
    let scene = Scene { name: kind.scene_name(seed, number), ..scene };
    state.settings.random_number = number.wrapping_add(1);
    let file = SceneFile { scene, radar: state.radar().clone() };
    if kind == Kind::Noise && !state.settings.floor.has_level() {
        // In an empty scene only a thermal floor of a given level has noise.
        state.settings.floor = Floor::Level(state.settings.level);
    }
    state.set_document(Document::unsaved(None, file));
}
