//! Tests of the engine and its features against the same network in PyTorch.

use super::engine::{LiveEngine, LiveScratch};
use super::features::{FeatureExtractor, LiveInput};
use super::grid::{COARSE_COLUMNS, COLUMNS, CONSTANTS, FINE_COLUMNS, ROWS};
use super::size::LiveSize;
use crate::network::weights::WeightFile;
use crate::radar::Radar;
use crate::scene::Reflector;
use crate::signal::{TwoEnds, exact};

/// Written by `training/reference.py`: a tiny network, three reflectors, and PyTorch's results for them.
const REFERENCE: &[u8] = include_bytes!("../../../tests/data/live_reference.safetensors");
const WEIGHTS: &[u8] = include_bytes!("../../../tests/data/live_reference_weights.safetensors");

pub(super) fn reference() -> WeightFile<'static> {
    WeightFile::parse("reference", REFERENCE).unwrap()
}

pub(super) fn tiny(weights: &[u8]) -> LiveEngine {
    let size = LiveSize { channels: [4, 6, 8, 10], blocks: [1, 1, 1, 1], fine: 4, ..LiveSize::default() };
    LiveEngine::new(&WeightFile::parse("weights", weights).unwrap(), &size).unwrap()
}

/// The samples of a reference's three reflectors, and the network's input.
pub(super) fn heard(radar: &Radar, reference: &WeightFile) -> (TwoEnds, LiveInput) {
    let points = reference.tensor("points", &[3, 2]).unwrap();
    let of = |p: &[f32]| Reflector { x_metres: p[0].into(), y_metres: p[1].into(), reflectivity: 1.0 };
    let reflectors: Vec<Reflector> = points.chunks(2).map(of).collect();
    let ends = exact::beat_signal(radar, &reflectors).two_ends(radar);
    let input = FeatureExtractor::new(radar).unwrap().extract(&ends).unwrap();
    (ends, input)
}

fn input(reference: &WeightFile) -> LiveInput {
    heard(&Radar::default(), reference).1
}

/// Mean and largest distance of every `row`-th row and `column`-th column of `found` planes from a reference.
fn distance(found: &[f32], reference: &[f32], rows: usize, columns: usize, row: usize, column: usize) -> (f32, f32) {
    let picked: Vec<f32> = found
        .chunks(rows * columns)
        .flat_map(|plane| plane.chunks(columns).step_by(row).flat_map(move |line| line.iter().step_by(column).copied()))
        .collect();
    assert_eq!(picked.len(), reference.len());
    let gaps: Vec<f32> = picked.iter().zip(reference).map(|(a, b)| (a - b).abs()).collect();
    (gaps.iter().sum::<f32>() / gaps.len() as f32, gaps.into_iter().fold(0.0, f32::max))
}

#[test]
fn features_agree_with_the_twin() {
    let reference = reference();
    let found = input(&reference);
    let check = |name: &str, values: &[f32], shape: &[usize], rows, columns, row, column| {
        let expected = reference.tensor(name, shape).unwrap();
        let (mean, largest) = distance(values, &expected, rows, columns, row, column);
        assert!(mean < 1e-4 && largest < 5e-2, "{name}: mean {mean}, largest {largest}");
    };
    check("fine", &found.fine, &[4, 16, 32], ROWS, FINE_COLUMNS, 32, 8);
    check("coarse", &found.coarse, &[10, 16, 16], ROWS, COARSE_COLUMNS, 32, 4);
    check("rows", &found.rows, &[6, 64], 1, ROWS, 1, 8);
    check("scalars", &found.scalars, &[2], 1, 2, 1, 1);
    assert_eq!(found.constants, [0.0; CONSTANTS]);
    check("gain", &[found.gain as f32], &[1], 1, 1, 1, 1);
}

/// Weights of version 0.1.0 have no constants of the radar; their answers for the radar of their training stay the same.
#[test]
fn weights_of_version_0_1_answer_as_they_did() {
    let weights = include_bytes!("../../../tests/data/program-0.1.0/live_reference_weights.safetensors");
    let reference = include_bytes!("../../../tests/data/program-0.1.0/live_reference.safetensors");
    let reference = WeightFile::parse("reference", reference).unwrap();
    let found = tiny(weights).forward(&input(&reference), &mut LiveScratch::default());
    let (mean, largest) = distance(&found.map, &reference.tensor("log", &[16, 64]).unwrap(), ROWS, COLUMNS, 32, 16);
    assert!(mean < 1e-4 && largest < 1e-2, "mean {mean}, largest {largest}");
}

#[test]
fn the_engine_agrees_with_the_twin() {
    let (reference, engine) = (reference(), tiny(WEIGHTS));
    let input = input(&reference);
    let fast = engine.forward(&input, &mut LiveScratch::default());
    let expected = reference.tensor("log", &[16, 64]).unwrap();
    let (mean, largest) = distance(&fast.map, &expected, ROWS, COLUMNS, 32, 16);
    assert!(mean < 1e-4 && largest < 1e-2, "mean {mean}, largest {largest}");
    let minimum = reference.tensor("minimum", &[1]).unwrap()[0];
    assert!((fast.minimum - minimum).abs() < 1e-3, "{} for {minimum}", fast.minimum);

    // The same scene with the constants of another radar and another window.
    let constants = reference.tensor("constants", &[CONSTANTS]).unwrap().try_into().unwrap();
    let other = LiveInput { constants, ..input };
    let fast_other = engine.forward(&other, &mut LiveScratch::default());
    let expected = reference.tensor("other_log", &[16, 64]).unwrap();
    let (mean, largest) = distance(&fast_other.map, &expected, ROWS, COLUMNS, 32, 16);
    assert!(mean < 1e-4 && largest < 1e-2, "mean {mean}, largest {largest}");
    assert!(distance(&fast_other.map, &fast.map, ROWS, COLUMNS, 1, 1).0 > 0.05, "the constants say nothing");
}
