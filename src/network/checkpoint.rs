//! Checkpoints, from which a run continues as if it had never stopped.

use super::recipe::Recipe;
use super::run::{RunProgress, TrainError, file};
use super::trainable_network::TrainableNetwork;
use crate::files::sha256;
use burn::optim::ModuleOptimizer;
use burn::store::{BurnpackStore, ModuleSnapshot};
use std::fs;
use std::path::{Path, PathBuf};

pub(super) const MODEL: &str = "model.bpk";
const OPTIMIZER: &str = "optimizer.bpk";
const PROGRESS: &str = "progress.toml";
const RECIPE: &str = "recipe.toml";

/// Replaces the checkpoint at `folder` in one step.
/// # Errors
/// [`TrainError`] when it can't be written; the older checkpoint is kept then.
pub fn save<S: TrainableNetwork>(
    folder: &Path,
    recipe: &Recipe,
    network: &S,
    optimizer: &ModuleOptimizer,
    progress: &RunProgress,
) -> Result<(), TrainError> {
    let next = folder.with_extension("next");
    if next.exists() {
        fs::remove_dir_all(&next).map_err(file(&next))?;
    }
    fs::create_dir_all(&next).map_err(file(&next))?;
    let bad = |reason: String| TrainError::Checkpoint { path: next.clone(), reason };
    let mut store = BurnpackStore::from_file(next.join(MODEL)).overwrite(true);
    // burn's batch norms keep their newest running statistics apart until `valid` merges them into the module.
    let _ = network.valid();
    network.save_into(&mut store).map_err(|e| bad(e.to_string()))?;
    optimizer.save(next.join(OPTIMIZER)).map_err(|e| bad(e.to_string()))?;
    for (name, text) in [
        (PROGRESS, toml::to_string(progress).map_err(|e| bad(e.to_string()))?),
        (RECIPE, toml::to_string(recipe).map_err(|e| bad(e.to_string()))?),
    ] {
        let path = next.join(name);
        fs::write(&path, text).map_err(file(&path))?;
    }
    // Two renames: a run resumed after a stop between them finds the older checkpoint under its second name.
    let old = folder.with_extension("old");
    if old.exists() && folder.exists() {
        fs::remove_dir_all(&old).map_err(file(&old))?;
    }
    if folder.exists() {
        fs::rename(folder, &old).map_err(file(folder))?;
    }
    fs::rename(&next, folder).map_err(file(&next))
}

/// The recipe of the run whose checkpoint is at `folder`.
/// # Errors
/// [`TrainError`] when there is no checkpoint or its recipe can't be read.
pub fn recipe(folder: &Path) -> Result<Recipe, TrainError> {
    let there = there(folder);
    let path = there.join(RECIPE);
    if !path.exists() {
        let reason = "there is none; expected it in the folder of a run that was started before".to_owned();
        return Err(TrainError::Checkpoint { path: folder.to_owned(), reason });
    }
    let text = fs::read_to_string(&path).map_err(file(&path))?;
    Ok(Recipe::parse(&path.display().to_string(), &text)?)
}

/// The checkpoint's folder: the second name of `folder` where a run was stopped during the replacement.
fn there(folder: &Path) -> PathBuf {
    let old = folder.with_extension("old");
    if !folder.exists() && old.exists() { old } else { folder.to_owned() }
}

/// Loads the checkpoint at `folder` into network and optimizer; the progress of its run, and the SHA-256 of its weights.
/// # Errors
/// [`TrainError`] when it is missing, damaged, or of another recipe.
pub fn load<S: TrainableNetwork>(
    folder: &Path,
    recipe: &Recipe,
    network: &mut S,
    optimizer: &mut ModuleOptimizer,
) -> Result<(RunProgress, String), TrainError> {
    let folder = there(folder);
    let bad = |reason: String| TrainError::Checkpoint { path: folder.clone(), reason };
    let read = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).map_err(file(&path))
    };
    if Recipe::parse(RECIPE, &read(RECIPE)?)? != *recipe {
        return Err(bad("it belongs to another recipe; resume with the recipe it was started with".into()));
    }
    let progress = toml::from_str(&read(PROGRESS)?).map_err(|e| bad(format!("{PROGRESS}: {e}")))?;
    let model = folder.join(MODEL);
    let weights_sha256 = sha256::of_file(&model).map_err(file(&model))?;
    let mut store = BurnpackStore::from_file(model);
    network.load_from(&mut store).map_err(|e| bad(format!("{MODEL}: {e}")))?;
    *optimizer = recipe.optimizer.fresh().load(folder.join(OPTIMIZER)).map_err(|e| bad(format!("{OPTIMIZER}: {e}")))?;
    Ok((progress, weights_sha256))
}
