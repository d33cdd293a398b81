//! Commands on the rows of the failures: try methods, open a row, search for worse scenes, keep a scene.

use super::work;
use crate::app::jobs::{FailuresPlan, Jobs, is_table_of_rows, keep, tell};
use crate::app::state::{FailureChoice, OpenedRow, Panel, RowsCommand, State};
use crate::evaluate::campaign::Campaign;
use crate::evaluate::sets::{SceneFolder, SceneSet};
use crate::platform::fs;
use std::path::Path;

pub fn apply(state: &mut State, jobs: &mut Jobs, command: RowsCommand) -> Result<(), String> {
    match command {
        RowsCommand::Try(choice) => jobs.failures.begin(plan(state, jobs, &choice)?),
        RowsCommand::CancelTrying => jobs.failures.run.cancel(),
        RowsCommand::OpenTable(path) if !is_table_of_rows(&path) => work::watch(state, jobs, path),
        RowsCommand::OpenFile(path) | RowsCommand::OpenTable(path) => {
            jobs.failures.open(path);
            if !state.arrangement.is_maximised(Panel::Failures) {
                state.arrangement.set_open(Panel::Failures, true);
            }
        }
        RowsCommand::SaveTo(path) => tell(state, jobs.exports.rows(&jobs.failures.table, path)),
        RowsCommand::Clear => jobs.failures.clear(),
        RowsCommand::BringBack => jobs.failures.bring_back(),
        RowsCommand::Show(index) => open_row(state, jobs, index)?,
        RowsCommand::Search(search) => jobs.failures.search.begin(state, *search),
        RowsCommand::CancelSearch => jobs.failures.search.job.cancel(),
        RowsCommand::TakeFinding => take_finding(state, jobs),
        RowsCommand::ForgetSearch => jobs.failures.search.forget(),
        RowsCommand::KeepScene(note) => keep_scene(state, jobs, &note)?,
        RowsCommand::SetOwnScenes(path) => {
            let folder = if fs::is_dir(&path) { Some(path.as_path()) } else { path.parent() };
            state.settings.own_scenes = folder.map(Path::to_path_buf);
        }
    }
    Ok(())
}

fn plan(state: &State, jobs: &Jobs, choice: &FailureChoice) -> Result<FailuresPlan, String> {
    let mut sets: Vec<SceneSet> = choice.kinds.iter().copied().map(SceneSet::Generated).collect();
    if choice.own {
        let folder = jobs.own_scenes(state).ok_or("There is no folder of your own scenes: choose one first.")?;
        let folder =
            SceneFolder::open(&folder).map_err(|e| format!("{e}\nKeep a scene first, or choose another folder."))?;
        sets.push(SceneSet::Folder(folder));
    }
    let methods = state.methods.all.iter().filter(|m| choice.methods.contains(&m.name())).cloned().collect();
    let campaign = state.settings.campaign(state.radar());
    let campaign = Campaign { count: choice.count, seed: choice.seed, ..campaign };
    Ok(FailuresPlan { campaign, sets, methods })
}

/// Opens a row's scene as another document, with the row's floor and method in the settings. One undo takes back all rows opened without a change between.
fn open_row(state: &mut State, jobs: &mut Jobs, index: usize) -> Result<(), String> {
    let table = &jobs.failures.table;
    let Some(row) = table.rows().get(index).cloned() else { return Ok(()) };
    let generation = table.generation();
    let conditions = table.conditions();
    let document = conditions.document(&row).map_err(|error| format!("{error}\nThe scene on screen was kept."))?;
    let is_row = state.row_on_screen().is_some() && !state.editor.is_modified();
    if is_row && state.guided.can_undo(&state.setup()) {
        state.undo();
    }
    let before = state.setup();
    state.settings.floor = SceneSet::by_name(&row.set).map_or(conditions.floor, |set| set.floor(conditions.floor));
    state.settings.normalisation = conditions.normalisation;
    state.settings.layout = row.layout.parse().ok();
    match state.methods.called(&row.method) {
        Some(method) => {
            state.settings.method = row.method.to_string();
            // The method's own threshold, also where it was raised above the noise; otherwise the row's threshold.
            let is_own = method.reads_eta() || method.eta() <= row.eta;
            state.settings.set_method_eta(&row.method, (!is_own).then_some(row.eta));
        }
        None => state.notices.info(format!("There is no method \"{}\" here; the one in use stays.", row.method)),
    }
    // Compare shows another method of the rows beside this one.
    let offered = |name: &&String| **name != *row.method && state.methods.called(name).is_some();
    if let Some(second) = table.methods().iter().find(offered) {
        state.settings.compare.second.clone_from(second);
    }
    let opened = document.id();
    state.set_document(document);
    let after = state.setup();
    state.guided.push(before, after);
    state.failures.opened = Some(OpenedRow { row, index, generation, document: opened });
    jobs.failures.search.keep_to(opened);
    Ok(())
}

fn take_finding(state: &mut State, jobs: &Jobs) {
    let search = &jobs.failures.search;
    let [_, .., found] = search.job.rows() else { return };
    let found = found.scene.clone();
    // The scene on screen, near which the search looked, keeps its name and notes.
    state.editor.edit(None, |scene, _| (scene.objects, scene.noise_seed) = (found.objects, found.noise_seed));
}

fn keep_scene(state: &mut State, jobs: &Jobs, note: &str) -> Result<(), String> {
    let folder = jobs.own_scenes(state).ok_or("There is no folder to keep scenes in: choose one first.")?;
    let path = keep(&folder, state.editor.document().to_file(), note)
        .map_err(|error| format!("{error}\nThe scene was not kept; choose another folder."))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let advice = format!("apertura evaluate --scenes \"{}\" tries methods on all kept scenes.", folder.display());
    state.notices.info(format!("Kept as {name}. {advice}"));
    Ok(())
}
