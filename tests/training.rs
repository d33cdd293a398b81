//! A run that is stopped and resumed ends with the weights of one that never stopped.
//! Alone in its file: weights are drawn from a generator that all threads of a process share.
#![cfg(feature = "network")]

use apertura::network::backend::Backend;
use apertura::network::losses::TrainingLoss;
use apertura::network::recipe::{Decay, KindShare, Network, Optimizer, Recipe};
use apertura::network::run::TrainingRun;
use apertura::network::thesis::{Thesis, ThesisConfig};
use apertura::network::train::train;
use apertura::network::weights::WeightFile;
use apertura::radar::Radar;
use apertura::scene::generate::Kind;
use std::path::Path;
use std::time::Duration;

fn run(folder: &Path, max_steps: u64) -> TrainingRun {
    TrainingRun {
        folder: folder.to_owned(),
        device: Backend::Flex.device(),
        radar: Radar { samples: 16, elements: 32, end_elements: 4, ..Radar::default() },
        max_steps: Some(max_steps),
        max_time: None,
        untrained: false,
        checkpoint_every: Duration::from_secs(3600),
        origin: Default::default(),
    }
}

fn weights(folder: &Path) -> Vec<f32> {
    let bytes = std::fs::read(folder.join("weights.safetensors")).unwrap();
    let file = WeightFile::parse("weights", &bytes).unwrap();
    assert_eq!(file.network(), "thesis");
    file.all_values()
}

#[test]
fn a_run_in_two_parts_ends_where_a_whole_one_does() {
    let config = ThesisConfig { filters: 2, levels: 2, alive_output: false };
    let recipe = Recipe {
        name: "tiny".into(),
        description: String::new(),
        seed: 5,
        epochs: 2,
        batch: 2,
        loss: TrainingLoss::MeanSquare,
        validation_scenes: 1,
        network: Network::Thesis(config),
        optimizer: Optimizer::Sgd { learning_rate: 0.1, momentum: 0.9 },
        decay: Some(Decay { epochs: 1, factor: 0.5 }),
        scenes: vec![KindShare { kind: Kind::Points(2), count: 6 }],
    };
    let (whole, parts) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut steps = 0;
    train::<Thesis>(&recipe, &config, &run(whole.path(), 5), false, |_| steps += 1).unwrap();
    assert_eq!(steps, 5);
    train::<Thesis>(&recipe, &config, &run(parts.path(), 2), false, |_| {}).unwrap();
    let half = weights(parts.path());
    let end = train::<Thesis>(&recipe, &config, &run(parts.path(), 5), true, |_| {}).unwrap();
    assert_eq!((end.step, end.epoch, end.step_of_epoch, end.maps), (5, 1, 2, 10));
    assert_eq!(weights(whole.path()), weights(parts.path()), "exact resume");
    assert_ne!(half, weights(parts.path()), "the second part must have moved the weights");
    let [first, second] = &end.parts[..] else { panic!("two parts are recorded: {:?}", end.parts) };
    assert_eq!((first.maps_before, first.maps_seen, second.maps_before, second.maps_seen), (0, 4, 4, 6));
    assert_eq!(first.initial_weights_sha256, None, "drawn from the seed");
    let started = second.initial_weights_sha256.as_ref().expect("the second part went on from a file");
    assert!(started.len() == 64 && second.started_unix_seconds >= first.started_unix_seconds);
    let written = std::fs::read(parts.path().join("weights.safetensors")).unwrap();
    let record = WeightFile::parse("weights", &written).unwrap().provenance;
    assert!(record.get("parts").contains(started), "the weights say what they were made of");
    assert_eq!(record.optimiser(), "SGD");
    let log = std::fs::read_to_string(parts.path().join("log.csv")).unwrap();
    assert_eq!(log.lines().count(), 6, "a header and five steps");
}
