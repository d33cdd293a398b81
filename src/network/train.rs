//! Training: scenes simulated as they are needed, checkpoints that a run goes on from as if it had never stopped.

use super::checkpoint;
use super::recipe::{Optimizer, Recipe, RecipeError};
use super::students::Student;
use super::validation::{export, validate};
use crate::maps::RangeAngleMap;
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::scene::SceneError;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::signal::{Floor, simulate};
use burn::optim::momentum::MomentumConfig;
use burn::optim::{AdamWConfig, GradientsParams, ModuleOptimizer, SgdConfig};
use burn::tensor::{Device, Tensor, TensorData};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What a run needs beside its recipe.
#[derive(Debug, Clone)]
pub struct Run {
    /// Folder of checkpoints, log and weights.
    pub folder: PathBuf,
    /// Where tensors live.
    pub device: Device,
    /// The radar.
    pub radar: Radar,
    /// Stop, with a checkpoint, after so many steps in all.
    pub max_steps: Option<u64>,
    /// Stop, with a checkpoint, after so long.
    pub max_time: Option<Duration>,
    /// Time between checkpoints.
    pub checkpoint_every: Duration,
    /// Recorded in the weights: the commit that trained them.
    pub commit: String,
}

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Progress {
    /// Whole epochs done.
    pub epoch: u32,
    /// Steps done in the epoch that is under way.
    pub step_of_epoch: u64,
    /// Steps done in all.
    pub step: u64,
    /// Maps seen.
    pub maps: u64,
    /// Seconds of training.
    pub seconds: f64,
    /// Smoothed loss.
    pub loss: f64,
}

/// Why training stopped early or could not start.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// The loss is NaN or infinite.
    #[error("the loss is {loss} at step {step}; the last good checkpoint is kept in {}", folder.display())]
    NotFinite {
        /// The step.
        step: u64,
        /// The loss.
        loss: f32,
        /// The run's folder.
        folder: PathBuf,
    },
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A checkpoint can't be used.
    #[error("checkpoint {}: {reason}", path.display())]
    Checkpoint {
        /// The checkpoint.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The folder already holds another run.
    #[error("{} already holds a run; go on with it with --resume, or choose another folder", folder.display())]
    Occupied {
        /// The folder.
        folder: PathBuf,
    },
    /// The recipe is unsound.
    #[error(transparent)]
    Recipe(#[from] RecipeError),
    /// A scene could not be simulated.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The network can't use the samples.
    #[error(transparent)]
    Input(#[from] ReconstructError),
}

/// Trains by `recipe` until it ends or `run` says stop. `resume` goes on from the folder's checkpoint; `watch` is told after every step.
///
/// # Errors
/// [`TrainError`].
pub fn train<S: Student>(
    recipe: &Recipe,
    config: &S::Config,
    run: &Run,
    resume: bool,
    mut watch: impl FnMut(&Progress),
) -> Result<Progress, TrainError> {
    let device = run.device.clone().autodiff();
    device.seed(recipe.seed);
    let mut network = S::fresh(config, &device);
    let mut optimizer = optimizer_of(&recipe.optimizer);
    let mut progress = Progress::default();
    let at = run.folder.join("checkpoint");
    if resume {
        progress = checkpoint::load(&at, recipe, &mut network, &mut optimizer)?;
    } else if at.exists() {
        return Err(TrainError::Occupied { folder: run.folder.clone() });
    }
    fs::create_dir_all(&run.folder).map_err(file(&run.folder))?;
    let mut log = Log::open(&run.folder.join("log.csv"), resume)?;
    let tables = S::tables(config, &run.radar)?;
    let generator = Generator::new(&run.radar, Reading::Program, Purpose::Training, recipe.seed);
    let began = Instant::now();
    let before = progress.seconds;
    let mut saved = Instant::now();
    let finished = |p: &Progress| {
        run.max_steps.is_some_and(|most| p.step >= most) || run.max_time.is_some_and(|most| began.elapsed() >= most)
    };
    'training: while progress.epoch < recipe.epochs {
        let order = epoch_order(recipe, progress.epoch);
        // A last, smaller batch is left out: batch statistics of very few scenes would disturb.
        for scenes in order.chunks_exact(recipe.batch).skip(progress.step_of_epoch as usize) {
            if finished(&progress) {
                break 'training;
            }
            let lessons = scenes
                .par_iter()
                .map(|(kind, number)| lesson::<S>(&tables, config, run, &generator, *kind, *number))
                .collect::<Result<Vec<_>, _>>()?;
            let (inputs, targets): (Vec<_>, Vec<_>) = lessons.into_iter().unzip();
            let output = network.estimate(&inputs, &device);
            let loss = recipe.loss.of(output, target_tensor(&targets, &device));
            let value = loss.clone().into_scalar::<f32>();
            if !value.is_finite() {
                return Err(TrainError::NotFinite { step: progress.step, loss: value, folder: run.folder.clone() });
            }
            let gradients = GradientsParams::from_grads(loss.backward(), &network);
            network = optimizer.step(recipe.learning_rate(progress.epoch), network, gradients);
            progress.step += 1;
            progress.step_of_epoch += 1;
            progress.maps += scenes.len() as u64;
            progress.seconds = before + began.elapsed().as_secs_f64();
            let value = f64::from(value);
            progress.loss = if progress.step == 1 { value } else { 0.95 * progress.loss + 0.05 * value };
            log.line(&progress, value, recipe.learning_rate(progress.epoch))?;
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
    let validation = validate::<S>(&network.valid(), recipe, config, run)?;
    export::<S>(&network.valid(), recipe, run, &progress, &validation)?;
    Ok(progress)
}

/// A fresh optimizer.
pub(super) fn optimizer_of(optimizer: &Optimizer) -> ModuleOptimizer {
    match optimizer {
        Optimizer::Sgd { momentum, .. } => {
            SgdConfig::new().with_momentum(Some(MomentumConfig::new().with_momentum(*momentum))).init()
        }
        Optimizer::AdamW { .. } => AdamWConfig::new().with_weight_decay(1e-4).init(),
    }
}

/// The training scenes of an epoch in the order that recipe and epoch alone decide.
fn epoch_order(recipe: &Recipe, epoch: u32) -> Vec<(Kind, u32)> {
    let mut order = recipe.training_scenes();
    let mut rng = ChaCha8Rng::seed_from_u64(recipe.seed);
    rng.set_stream(1 + u64::from(epoch));
    order.shuffle(&mut rng);
    order
}

/// Input and target of one scene.
pub(super) fn lesson<S: Student>(
    tables: &S::Tables,
    config: &S::Config,
    run: &Run,
    generator: &Generator,
    kind: Kind,
    number: u32,
) -> Result<(S::Input, RangeAngleMap), TrainError> {
    let scene = generator.scene(kind, number);
    let signal = simulate(&run.radar, &scene, Floor::Thesis, scene.noise_seed)?;
    let input = S::input(tables, &signal.two_ends(&run.radar))?;
    Ok((input, S::target(config, &run.radar, &signal)))
}

fn target_tensor(targets: &[RangeAngleMap], device: &Device) -> Tensor<3> {
    let (rows, columns) = targets.first().map_or((0, 0), |t| t.lambda.dim());
    let values: Vec<f32> = targets.iter().flat_map(|t| t.lambda.iter().copied()).collect();
    Tensor::from_data(TensorData::new(values, vec![targets.len(), rows, columns]), device)
}

/// For `map_err`: an error about the file `path`.
pub(super) fn file(path: &Path) -> impl FnOnce(std::io::Error) -> TrainError {
    let path = path.to_owned();
    move |source| TrainError::File { path, source }
}

/// The run's CSV log.
struct Log {
    path: PathBuf,
    file: fs::File,
}

impl Log {
    fn open(path: &Path, append: bool) -> Result<Self, TrainError> {
        let exists = append && path.exists();
        let mut options = fs::OpenOptions::new();
        if exists {
            options.append(true)
        } else {
            options.write(true).create(true).truncate(true)
        };
        let mut log = Log { path: path.to_owned(), file: options.open(path).map_err(file(path))? };
        if !exists {
            log.write("step,epoch,maps,seconds,learning_rate,loss,smoothed_loss")?;
        }
        Ok(log)
    }

    fn line(&mut self, p: &Progress, loss: f64, rate: f64) -> Result<(), TrainError> {
        self.write(&format!("{},{},{},{:.1},{rate},{loss},{}", p.step, p.epoch, p.maps, p.seconds, p.loss))
    }

    fn write(&mut self, line: &str) -> Result<(), TrainError> {
        writeln!(self.file, "{line}").map_err(file(&self.path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::recipe::{Decay, Network, Share};
    use crate::network::thesis::{Thesis, ThesisConfig};

    fn radar() -> Radar {
        Radar { samples: 16, elements: 32, end_elements: 4, ..Radar::default() }
    }

    fn recipe() -> (Recipe, ThesisConfig) {
        let config = ThesisConfig { filters: 2, levels: 2, alive_output: false };
        let recipe = Recipe {
            name: "tiny".into(),
            description: String::new(),
            seed: 5,
            epochs: 2,
            batch: 2,
            loss: crate::network::losses::Loss::MeanSquare,
            validation_scenes: 1,
            network: Network::Thesis(config),
            optimizer: Optimizer::Sgd { learning_rate: 0.1, momentum: 0.9 },
            decay: Some(Decay { epochs: 1, factor: 0.5 }),
            scenes: vec![Share { kind: Kind::Points(2), count: 6 }],
        };
        (recipe, config)
    }

    fn run(folder: &Path, max_steps: u64) -> Run {
        Run {
            folder: folder.to_owned(),
            device: Device::flex(),
            radar: radar(),
            max_steps: Some(max_steps),
            max_time: None,
            checkpoint_every: Duration::from_secs(3600),
            commit: "none".into(),
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
    fn a_loss_that_explodes_stops_the_run_and_keeps_the_checkpoint() {
        let (mut recipe, config) = recipe();
        let folder = tempfile::tempdir().unwrap();
        recipe.optimizer = Optimizer::Sgd { learning_rate: 1e30, momentum: 0.9 };
        let mut run = run(folder.path(), 6);
        run.checkpoint_every = Duration::ZERO;
        let error = train::<Thesis>(&recipe, &config, &run, false, |_| {}).unwrap_err();
        let TrainError::NotFinite { step, .. } = error else { panic!("{error}") };
        assert!(step >= 1);
        assert!(folder.path().join("checkpoint").join(checkpoint::MODEL).exists());
    }

    #[test]
    fn epochs_shuffle_differently_but_repeatably() {
        let (recipe, _) = recipe();
        assert_eq!(epoch_order(&recipe, 0), epoch_order(&recipe, 0));
        assert_ne!(epoch_order(&recipe, 0), epoch_order(&recipe, 1));
    }
}
