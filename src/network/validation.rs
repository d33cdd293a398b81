//! Validation figures of a trained network, and the weight file that records them.

use super::lesson::lesson;
use super::recipe::Recipe;
use super::run::{RunProgress, TrainError, TrainingRun};
use super::trainable_network::TrainableNetwork;
use super::weights::RADAR_ENTRY;
use crate::evaluate::tables::PRINTED_EXPERIMENT_2;
use crate::evaluate::{Roc, squared_error};
use crate::radar::counted;
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use burn::store::{BurnToPyTorchAdapter, ModuleSnapshot, SafetensorsStore};
use ndarray::Array2;

/// Figures on the validation scenes of one set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SetFigures {
    /// SE.
    pub squared_error: f64,
    /// P_D at the thesis' P_FA, where a threshold reaches it.
    pub detection: Option<f64>,
}

/// The figures of a validation.
#[derive(Debug, Clone, PartialEq)]
pub struct Validation {
    /// One entry a set.
    pub sets: Vec<SetFigures>,
    /// Threshold at which the mean P_FA over the sets is the thesis' mean.
    pub eta: f32,
}

/// Figures on validation scenes, which share no random stream with training or test scenes.
/// # Errors
/// [`TrainError`] when a scene can't be simulated or the network can't use it.
pub fn validate<S: TrainableNetwork>(
    network: &S,
    recipe: &Recipe,
    config: &S::Config,
    run: &TrainingRun,
) -> Result<Validation, TrainError> {
    let generator = Generator::new(&run.radar, Reading::Program, Purpose::Validation, recipe.seed);
    let mut sets = Vec::new();
    let mut rocs = Vec::new();
    for (kind, printed) in Kind::TEST_SETS.into_iter().zip(PRINTED_EXPERIMENT_2) {
        let (mut roc, mut error) = (Roc::default(), 0.0);
        for number in 0..recipe.validation_scenes {
            let (input, target) = lesson::<S>(config, run, &generator, (kind, number))?;
            let (rows, columns) = target.lambda.dim();
            let estimate = network.estimate(&[input], [rows, columns], &run.device);
            let values = estimate.into_data().try_into_vec::<f32>().unwrap_or_default();
            let answer = Array2::from_shape_vec((rows, columns), values);
            let answer = answer.unwrap_or_else(|_| Array2::zeros((rows, columns)));
            error += squared_error(&target, &S::finish(answer.clone())) / f64::from(recipe.validation_scenes);
            roc.add(&target, &S::thresholded(answer));
        }
        let detection = roc.at_false_alarm(printed.false_alarm).map(|point| point.detection);
        sets.push(SetFigures { squared_error: error, detection });
        rocs.push(roc);
    }
    let sets_count = rocs.len() as f64;
    let wanted = PRINTED_EXPERIMENT_2.iter().map(|p| p.false_alarm).sum::<f64>() / sets_count;
    let mut alarms: Vec<(f32, f64)> = Vec::new();
    for (i, point) in rocs.iter().flat_map(|roc| roc.points().enumerate()) {
        match alarms.get_mut(i) {
            Some(sum) => sum.1 += point.false_alarm / sets_count,
            None => alarms.push((point.eta, point.false_alarm / sets_count)),
        }
    }
    let eta = alarms.iter().filter(|a| a.1 <= wanted).map(|a| a.0).fold(1.0, f32::min);
    Ok(Validation { sets, eta })
}

/// Writes `weights.safetensors`, with its record, into the run's folder.
/// # Errors
/// [`TrainError::Checkpoint`] when it can't be written.
pub fn export<S: TrainableNetwork>(
    network: &S,
    recipe: &Recipe,
    run: &TrainingRun,
    progress: &RunProgress,
    validation: &Validation,
) -> Result<(), TrainError> {
    let path = run.folder.join("weights.safetensors");
    let bad = |reason: String| TrainError::Checkpoint { path: path.clone(), reason };
    let of_set = |(number, set): (u32, &SetFigures)| {
        let detection = set.detection.map_or("-".into(), |d| format!("{:.2} %", 100.0 * d));
        format!("set {number}: SE {:.0}, P_D {detection} at the thesis' P_FA", set.squared_error)
    };
    let figures: Vec<String> = (1..).zip(&validation.sets).map(of_set).collect();
    let parts = serde_json::to_string(&progress.parts).map_err(|e| bad(e.to_string()))?;
    let radar = serde_json::to_string(&run.radar).map_err(|e| bad(e.to_string()))?;
    let mut store = SafetensorsStore::from_file(&path)
        .overwrite(true)
        .with_to_adapter(BurnToPyTorchAdapter)
        .metadata("network", S::NAME)
        .metadata("recipe", &recipe.name)
        .metadata("trainer", "apertura train")
        .metadata("optimiser", recipe.optimizer.name())
        .metadata("seed", recipe.seed.to_string())
        .metadata("steps", progress.step.to_string())
        .metadata("maps_seen", progress.maps.to_string())
        .metadata("minutes", format!("{:.0}", progress.seconds / 60.0))
        .metadata("loss", format!("{:.6}", progress.loss))
        .metadata("commit", &run.origin.commit)
        .metadata("parts", &parts)
        .metadata(RADAR_ENTRY, &radar)
        .metadata("eta", format!("{:.4}", validation.eta))
        .metadata(
            "validation",
            format!("{}: {}", counted(recipe.validation_scenes, "scene a set", "scenes a set"), figures.join("; ")),
        );
    network.save_into(&mut store).map_err(|e| bad(e.to_string()))
}
