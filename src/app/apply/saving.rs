//! Saving the scene, with a question where the file can't hold all of it or was changed by another program.

use crate::app::jobs::Jobs;
use crate::app::state::{Doubt, Purpose, SaveAnswer, SaveQuestion, State};
use crate::interact::Saved;
use crate::platform::fs;
use std::path::{Path, PathBuf};

/// Writes the scene to its own file, or asks for one. A recording without edits needs no saving.
pub fn save_again(state: &mut State, jobs: &mut Jobs) {
    let document = state.editor.document();
    let is_bare = document.recording().is_some() && !document.is_modified();
    match document.path().map(Path::to_owned) {
        Some(path) => save(state, path),
        None if is_bare => {
            let advice = "Objects drawn over it are saved as a scene of their own.";
            state.notices.info(format!("Nothing to save: {} stays as it was measured. {advice}", document.name()));
        }
        None => jobs.choose_file(state, Purpose::SaveScene),
    }
}

/// Writes the scene to `path`, or asks first where that would lose part of the scene or another program's changes.
pub fn save(state: &mut State, mut path: PathBuf) {
    if path.extension().is_none() {
        path.set_extension("toml");
    }
    let doubt = match state.editor.losses(&path) {
        Ok(losses) if !losses.is_empty() => Some(Doubt::Losses(losses)),
        Ok(_) if state.editor.would_replace_anothers(&path) => Some(Doubt::Changed),
        // Writing meets the same error and tells the user.
        _ => None,
    };
    match doubt {
        Some(doubt) => state.save_question = Some(SaveQuestion { path, doubt }),
        None => write(state, path),
    }
}

/// Carries out the user's answer to the save question.
pub fn answer(state: &mut State, jobs: &mut Jobs, answer: SaveAnswer) {
    let Some(SaveQuestion { path, .. }) = state.save_question.take() else { return };
    let toml = path.with_extension("toml");
    match answer {
        SaveAnswer::Cancel => {}
        SaveAnswer::Anyway => write(state, path),
        // An existing file of that name is replaced only after a question.
        SaveAnswer::Elsewhere if fs::exists(&toml) => jobs.choose_file(state, Purpose::SaveScene),
        SaveAnswer::Elsewhere => write(state, toml),
    }
}

fn write(state: &mut State, path: PathBuf) {
    match state.editor.save(&path) {
        Ok(Saved::Whole) => {
            state.remember(&path);
            state.notices.info(format!("Saved {}", path.display()));
        }
        Ok(Saved::Copy(losses)) => {
            let lost = losses.join(", ");
            let document = state.editor.document();
            let advice = match document.path().filter(|_| !document.is_modified()) {
                Some(own) => format!("The scene itself is saved in {}.", own.display()),
                None => "The scene itself is still unsaved: save it as .toml to keep everything.".to_owned(),
            };
            state.notices.info(format!("{} holds a copy without {lost}. {advice}", path.display()));
        }
        Err(error) => {
            state.notices.error(format!("{error}\nNothing was written; choose another place with Save as…"));
        }
    }
}
