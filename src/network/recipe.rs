//! Training recipes, which determine a training run, as TOML.

use super::losses::TrainingLoss;
use super::thesis::ThesisConfig;
use super::unet::UnetConfig;
use crate::scene::generate::Kind;
use burn::optim::momentum::MomentumConfig;
use burn::optim::{AdamWConfig, ModuleOptimizer, SgdConfig};
use serde::{Deserialize, Serialize};
use std::fmt::Display;

/// The recipes that come with the program, by name.
pub const SHIPPED: [(&str, &str); 5] = [
    ("experiment-1", include_str!("../../assets/recipes/experiment-1.toml")),
    ("experiment-1-small", include_str!("../../assets/recipes/experiment-1-small.toml")),
    ("experiment-2", include_str!("../../assets/recipes/experiment-2.toml")),
    ("experiment-2-small", include_str!("../../assets/recipes/experiment-2-small.toml")),
    ("unet", include_str!("../../assets/recipes/unet.toml")),
];

/// The network of a recipe, with its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Network {
    /// The thesis' encoder-decoder.
    Thesis(ThesisConfig),
    /// The thesis' failing U-Net.
    Unet(UnetConfig),
}

/// The optimizer and its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Optimizer {
    /// Stochastic gradient descent.
    Sgd {
        /// Step size.
        learning_rate: f64,
        /// Part of the last step that is added to the next.
        momentum: f64,
    },
    /// Adam with decoupled weight decay 1e-4.
    AdamW {
        /// Step size.
        learning_rate: f64,
    },
}

impl Optimizer {
    pub(super) fn fresh(&self) -> ModuleOptimizer {
        match self {
            Optimizer::Sgd { momentum, .. } => {
                SgdConfig::new().with_momentum(Some(MomentumConfig::new().with_momentum(*momentum))).init()
            }
            Optimizer::AdamW { .. } => AdamWConfig::new().with_weight_decay(1e-4).init(),
        }
    }

    /// The optimizer's name in weight files.
    pub fn name(&self) -> &'static str {
        match self {
            Optimizer::Sgd { .. } => "SGD",
            Optimizer::AdamW { .. } => "AdamW",
        }
    }

    /// Step size before any decay.
    pub fn learning_rate(&self) -> f64 {
        match self {
            Optimizer::Sgd { learning_rate, .. } | Optimizer::AdamW { learning_rate } => *learning_rate,
        }
    }
}

/// The learning rate is multiplied by `factor` after every `epochs` epochs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Decay {
    /// Epochs between two decays.
    pub epochs: u32,
    /// The factor.
    pub factor: f64,
}

/// Number of training scenes of a kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KindShare {
    /// The kind.
    pub kind: Kind,
    /// Number of scenes.
    pub count: u32,
}

/// Most scenes a step, training scenes and validation scenes of a set: lists of them and the maps of a batch are in memory.
const MAX_BATCH: usize = 1024;
const MAX_SCENES: u64 = 10_000_000;
const MAX_VALIDATION_SCENES: u32 = 10_000;

/// A training run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Name, as in `apertura train NAME`.
    pub name: String,
    /// One line for `apertura train --list`.
    pub description: String,
    /// Seed of the weights, the scenes and their order.
    pub seed: u64,
    /// Passes over the training scenes.
    pub epochs: u32,
    /// Scenes a step.
    pub batch: usize,
    /// The loss to minimise.
    pub loss: TrainingLoss,
    /// Validation scenes of each of the three sets.
    pub validation_scenes: u32,
    /// The network.
    pub network: Network,
    /// The optimizer.
    pub optimizer: Optimizer,
    /// Learning-rate decay.
    pub decay: Option<Decay>,
    /// The training scenes. They, the validation and the test scenes come from disjoint random streams.
    pub scenes: Vec<KindShare>,
}

/// A fault of a recipe.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("recipe {0}")]
pub struct RecipeError(String);

/// Whether an entry is usable, its name, its value, and what was expected.
type Check<'a> = (bool, &'static str, &'a dyn Display, &'static str);

impl Recipe {
    /// Reads and checks a recipe; messages call it `name`.
    /// # Errors
    /// [`RecipeError`] names the fault and its place.
    pub fn parse(name: &str, text: &str) -> Result<Recipe, RecipeError> {
        let recipe: Recipe = toml::from_str(text).map_err(|error| RecipeError(format!("{name}: {error}")))?;
        recipe.check(name)?;
        Ok(recipe)
    }

    /// The shipped recipe called `name`.
    pub fn shipped(name: &str) -> Option<Result<Recipe, RecipeError>> {
        SHIPPED.iter().find(|(known, _)| *known == name).map(|(name, text)| Recipe::parse(name, text))
    }

    fn check(&self, name: &str) -> Result<(), RecipeError> {
        let (rate, validation_scenes) = (self.optimizer.learning_rate(), self.validation_scenes);
        let momentum = if let Optimizer::Sgd { momentum, .. } = self.optimizer { momentum } else { 0.0 };
        let decay = self.decay.clone().unwrap_or(Decay { epochs: 1, factor: 1.0 });
        let total: u64 = self.scenes.iter().map(|s| u64::from(s.count)).sum();
        let of_all: [Check; 9] = [
            (rate.is_finite() && rate > 0.0, "optimizer.learning_rate", &rate, "a number above 0"),
            ((0.0..1.0).contains(&momentum), "optimizer.momentum", &momentum, "at least 0 and below 1"),
            ((1..=MAX_BATCH).contains(&self.batch), "batch", &self.batch, "1 to 1024"),
            (self.epochs > 0, "epochs", &self.epochs, "at least 1"),
            (decay.epochs > 0, "decay.epochs", &decay.epochs, "at least 1"),
            (decay.factor > 0.0 && decay.factor <= 1.0, "decay.factor", &decay.factor, "above 0 and at most 1"),
            (total >= self.batch as u64, "scenes", &total, "at least one batch in all"),
            (total <= MAX_SCENES, "scenes", &total, "at most 10000000 in all"),
            (validation_scenes <= MAX_VALIDATION_SCENES, "validation_scenes", &validation_scenes, "at most 10000"),
        ];
        let of_network: Vec<Check> = match &self.network {
            Network::Thesis(ThesisConfig { filters, levels, .. }) => vec![
                ((1..=ThesisConfig::MAX_FILTERS).contains(filters), "network.filters", filters, "1 to 512"),
                ((1..=ThesisConfig::MAX_LEVELS).contains(levels), "network.levels", levels, "1 to 8"),
            ],
            Network::Unet(UnetConfig { channels, levels, rows }) => {
                let is_halved = (1..=6).contains(levels) && *rows > 0 && rows.is_multiple_of(1 << *levels);
                vec![
                    ((1..=6).contains(levels), "network.levels", levels, "1 to 6"),
                    ((1..=256).contains(channels), "network.channels", channels, "1 to 256"),
                    (is_halved, "network.rows", rows, "a multiple of two to the levels"),
                    (*rows <= 1 << 12, "network.rows", rows, "at most 4096"),
                ]
            }
        };
        match of_all.into_iter().chain(of_network).find(|(is_usable, ..)| !is_usable) {
            None => Ok(()),
            Some((_, field, value, expected)) => {
                Err(RecipeError(format!("{name}: {field} is {value}; expected {expected}")))
            }
        }
    }

    /// Learning rate of an epoch, counted from 0.
    pub fn learning_rate(&self, epoch: u32) -> f64 {
        let decays = self.decay.as_ref().map_or(1.0, |d| d.factor.powi((epoch / d.epochs) as i32));
        self.optimizer.learning_rate() * decays
    }

    /// Every training scene, as (kind, number).
    pub fn training_scenes(&self) -> Vec<(Kind, u32)> {
        self.scenes.iter().flat_map(|share| (0..share.count).map(|number| (share.kind, number))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shipped_recipes_follow_the_thesis() {
        for (name, text) in SHIPPED {
            let recipe = Recipe::parse(name, text).unwrap();
            assert_eq!(recipe.name, name);
            assert_eq!(toml::from_str::<Recipe>(&toml::to_string(&recipe).unwrap()).unwrap(), recipe);
        }
        let two = Recipe::shipped("experiment-2").unwrap().unwrap();
        assert_eq!((two.batch, two.epochs, two.loss), (32, 100, TrainingLoss::NormalisedSquare));
        assert_eq!(two.training_scenes().len(), 8000);
        assert!((two.learning_rate(25) - 0.1 * 0.64).abs() < 1e-12 && Recipe::shipped("nonsense").is_none());
    }

    #[test]
    fn bad_recipes_are_named() {
        let good = SHIPPED[0].1;
        for (from, to, expected) in [
            ("batch = 8", "batch = 0", "batch is 0"),
            ("batch = 8", "batch = 100000", "batch is 100000"),
            ("count = 200", "count = 4000000000", "at most 10000000 in all"),
            ("batch = 8", "batch = 8\ncolour = 3", "colour"),
            ("momentum = 0.9", "momentum = 1.5", "optimizer.momentum is 1.5"),
            ("learning_rate = 0.1", "learning_rate = nan", "optimizer.learning_rate is NaN"),
            ("factor = 0.8", "factor = 0.0", "decay.factor is 0"),
            ("levels = 5", "levels = 50", "network.levels is 50"),
            ("loss = \"mean-square\"", "loss = \"mean-cube\"", "mean-cube"),
        ] {
            assert!(good.contains(from), "{from} is not in the recipe");
            let error = Recipe::parse("test", &good.replace(from, to)).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
