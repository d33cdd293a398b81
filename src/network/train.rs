//! Training, with scenes simulated as they are needed, and checkpoints from which a run continues as if it had never stopped.

use super::checkpoint;
use super::lesson::lesson;
use super::recipe::Recipe;
use super::run::{RunPart, RunProgress, TrainError, TrainingRun, file};
use super::trainable_network::TrainableNetwork;
use super::validation::{export, validate};
use crate::maps::RangeAngleMap;
use crate::platform::Instant;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use burn::optim::{GradientsParams, ModuleOptimizer};
use burn::tensor::{Device, Tensor, TensorData};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Trains by `recipe` until the recipe or a limit of `run` ends it. `resume` continues from the folder's checkpoint; `watch` is called after every step.
/// # Errors
/// [`TrainError`].
pub fn train<S: TrainableNetwork>(
    recipe: &Recipe,
    config: &S::Config,
    run: &TrainingRun,
    resume: bool,
    mut watch: impl FnMut(&RunProgress),
) -> Result<RunProgress, TrainError> {
    let has_time = run.max_steps != Some(0) && run.max_time != Some(Duration::ZERO);
    refuse_untrained(run, resume || has_time)?;
    let device = run.device.clone().autodiff();
    let at = run.folder.join("checkpoint");
    let (mut network, mut optimizer, mut progress) = begin::<S>(recipe, config, run, resume.then_some(&at), &device)?;
    if !resume && at.exists() {
        return Err(TrainError::Occupied { folder: run.folder.clone() });
    }
    fs::create_dir_all(&run.folder).map_err(file(&run.folder))?;
    let log_path = run.folder.join("log.csv");
    let mut log = log_at(&log_path, resume).map_err(file(&log_path))?;
    let generator = Generator::new(&run.radar, Reading::Program, Purpose::Training, recipe.seed);
    let (before, began, mut saved) = (progress.seconds, Instant::now(), Instant::now());
    let finished = |p: &RunProgress| {
        run.max_steps.is_some_and(|most| p.step >= most) || run.max_time.is_some_and(|most| began.elapsed() >= most)
    };
    'training: while progress.epoch < recipe.epochs {
        let order = epoch_order(recipe, progress.epoch);
        let rate = recipe.learning_rate(progress.epoch);
        // A last, smaller batch is left out: batch statistics of very few scenes would disturb.
        for scenes in order.chunks_exact(recipe.batch).skip(progress.step_of_epoch as usize) {
            if finished(&progress) {
                break 'training;
            }
            let lesson = |scene: &(Kind, u32)| lesson::<S>(config, run, &generator, *scene);
            let lessons = scenes.par_iter().map(lesson).collect::<Result<Vec<_>, _>>()?;
            let (moved, loss) = step(network, &mut optimizer, recipe, rate, lessons, &device);
            if !loss.is_finite() {
                return Err(TrainError::NotFinite { step: progress.step, loss, folder: run.folder.clone() });
            }
            network = moved;
            let now = began.elapsed().as_secs_f64();
            progress.step(scenes.len() as u64, f64::from(loss), [before + now, now]);
            write_step(&mut log, &progress, rate, loss.into()).map_err(file(&log_path))?;
            watch(&progress);
            if saved.elapsed() >= run.checkpoint_every {
                checkpoint::save(&at, recipe, &network, &optimizer, &progress)?;
                saved = Instant::now();
            }
        }
        progress.epoch += 1;
        progress.step_of_epoch = 0;
    }
    checkpoint::save(&at, recipe, &network, &optimizer, &progress)?;
    refuse_untrained(run, progress.maps > 0)?;
    let validation = validate::<S>(&network.valid(), recipe, config, run)?;
    export::<S>(&network.valid(), recipe, run, &progress, &validation)?;
    Ok(progress)
}

fn refuse_untrained(run: &TrainingRun, is_trained: bool) -> Result<(), TrainError> {
    if is_trained || run.untrained { Ok(()) } else { Err(TrainError::Untrained) }
}

fn begin<S: TrainableNetwork>(
    recipe: &Recipe,
    config: &S::Config,
    run: &TrainingRun,
    from: Option<&PathBuf>,
    device: &Device,
) -> Result<(S, ModuleOptimizer, RunProgress), TrainError> {
    device.seed(recipe.seed);
    let mut network = S::fresh(config, device);
    let mut optimizer = recipe.optimizer.fresh();
    let (mut progress, mut initial) = (RunProgress::default(), None);
    if let Some(folder) = from {
        let (found, weights_sha256) = checkpoint::load(folder, recipe, &mut network, &mut optimizer)?;
        (progress, initial) = (found, Some(weights_sha256));
    }
    progress.parts.push(RunPart::starting(run, initial, progress.maps));
    Ok((network, optimizer, progress))
}

fn step<S: TrainableNetwork>(
    network: S,
    optimizer: &mut ModuleOptimizer,
    recipe: &Recipe,
    rate: f64,
    lessons: Vec<(Vec<f32>, RangeAngleMap)>,
    device: &Device,
) -> (S, f32) {
    let (inputs, targets): (Vec<_>, Vec<_>) = lessons.into_iter().unzip();
    let (rows, columns) = targets.first().map_or((0, 0), |target| target.lambda.dim());
    let cells: Vec<f32> = targets.iter().flat_map(|target| &target.lambda).copied().collect();
    let target = Tensor::from_data(TensorData::new(cells, [targets.len(), rows, columns]), device);
    let loss = recipe.loss.of(network.estimate(&inputs, [rows, columns], device), target);
    let value = loss.clone().into_scalar::<f32>();
    if !value.is_finite() {
        return (network, value);
    }
    let gradients = GradientsParams::from_grads(loss.backward(), &network);
    (optimizer.step(rate, network, gradients), value)
}

fn epoch_order(recipe: &Recipe, epoch: u32) -> Vec<(Kind, u32)> {
    let mut order = recipe.training_scenes();
    let mut rng = ChaCha8Rng::seed_from_u64(recipe.seed);
    rng.set_stream(1 + u64::from(epoch));
    order.shuffle(&mut rng);
    order
}

fn write_step(log: &mut fs::File, progress: &RunProgress, rate: f64, loss: f64) -> io::Result<()> {
    let RunProgress { step, epoch, maps, seconds, loss: smoothed, .. } = progress;
    writeln!(log, "{step},{epoch},{maps},{seconds:.1},{rate},{loss},{smoothed}")
}

/// The log at `path`, to which lines are added; without `goes_on` it begins anew.
fn log_at(path: &Path, goes_on: bool) -> io::Result<fs::File> {
    if goes_on && path.exists() {
        return fs::OpenOptions::new().append(true).open(path);
    }
    let mut log = fs::File::create(path)?;
    writeln!(log, "step,epoch,maps,seconds,learning_rate,loss,smoothed_loss")?;
    Ok(log)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::network::recipe::{Decay, KindShare, Network, Optimizer};
    use crate::network::thesis::{Thesis, ThesisConfig};
    use crate::radar::Radar;

    pub fn recipe() -> (Recipe, ThesisConfig) {
        let config = ThesisConfig { filters: 2, levels: 2, alive_output: false };
        let recipe = Recipe {
            seed: 5,
            epochs: 2,
            batch: 2,
            validation_scenes: 1,
            network: Network::Thesis(config),
            decay: Some(Decay { epochs: 1, factor: 0.5 }),
            scenes: vec![KindShare { kind: Kind::Points(2), count: 6 }],
            ..Recipe::shipped("experiment-1").unwrap().unwrap()
        };
        (recipe, config)
    }

    pub fn run(folder: &Path, max_steps: u64) -> TrainingRun {
        TrainingRun {
            folder: folder.to_owned(),
            device: Device::flex(),
            radar: Radar { samples: 16, elements: 32, end_elements: 4, ..Radar::default() },
            max_steps: Some(max_steps),
            max_time: None,
            untrained: false,
            checkpoint_every: Duration::from_secs(3600),
            origin: Default::default(),
        }
    }

    #[test]
    fn another_recipe_or_an_occupied_folder_is_refused() {
        let (recipe, config) = recipe();
        let folder = tempfile::tempdir().unwrap();
        train::<Thesis>(&recipe, &config, &run(folder.path(), 1), false, |_| {}).unwrap();
        let error = train::<Thesis>(&recipe, &config, &run(folder.path(), 2), false, |_| {}).unwrap_err();
        assert!(matches!(error, TrainError::Occupied { .. }), "{error}");
        let other = Recipe { batch: 3, ..recipe };
        let error = train::<Thesis>(&other, &config, &run(folder.path(), 2), true, |_| {}).unwrap_err().to_string();
        assert!(error.contains("another recipe"), "{error}");
    }

    #[test]
    fn weights_that_no_step_moved_are_not_written_unless_asked_for() {
        let (recipe, config) = recipe();
        let folder = tempfile::tempdir().unwrap();
        let weights = folder.path().join("weights.safetensors");
        let idle = run(folder.path(), 0);
        let error = train::<Thesis>(&recipe, &config, &idle, false, |_| {}).unwrap_err();
        assert!(matches!(error, TrainError::Untrained), "{error}");
        // A run whose time ends before its first step.
        let hurried = TrainingRun { max_steps: None, max_time: Some(Duration::from_nanos(1)), ..idle.clone() };
        let error = train::<Thesis>(&recipe, &config, &hurried, false, |_| {}).unwrap_err();
        assert!(matches!(error, TrainError::Untrained) && !weights.exists(), "{error}");
        let asked = TrainingRun { untrained: true, ..idle };
        train::<Thesis>(&recipe, &config, &asked, true, |_| {}).unwrap();
        assert!(weights.exists());
    }

    #[test]
    fn a_loss_that_explodes_keeps_the_checkpoint() {
        let (mut recipe, config) = recipe();
        let folder = tempfile::tempdir().unwrap();
        recipe.optimizer = Optimizer::Sgd { learning_rate: 1e30, momentum: 0.9 };
        let mut run = run(folder.path(), 6);
        run.checkpoint_every = Duration::ZERO;
        let error = train::<Thesis>(&recipe, &config, &run, false, |_| {}).unwrap_err();
        let TrainError::NotFinite { step, .. } = error else { panic!("{error}") };
        assert!(step >= 1 && folder.path().join("checkpoint").join(checkpoint::MODEL).exists());
    }

    #[test]
    fn epochs_shuffle_differently_but_repeatably() {
        let (recipe, _) = recipe();
        assert_eq!(epoch_order(&recipe, 0), epoch_order(&recipe, 0));
        assert_ne!(epoch_order(&recipe, 0), epoch_order(&recipe, 1));
    }
}
