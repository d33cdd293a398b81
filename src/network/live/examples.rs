//! Examples to train on: example `i` is a function of (mixture, seed, i) alone, whoever asks, in whatever order.

use super::arrays::Arrays;
use super::features::{FeatureExtractor, LiveInput};
use crate::evaluate::sets::SceneSet;
use crate::maps::{fast::whole_map, range_transform_in_place};
use crate::network::floors::Floors;
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::scene::Scene;
use crate::scene::generate::{Generator, Kind, Mixture, Purpose, Reading};
use crate::signal::{Floor, TwoEnds, Unfinished, simulate_for};
use crate::task::Task;
use ndarray::Array2;

/// Makes examples; holds the tables that depend on the radar alone.
#[derive(Debug)]
pub struct Examples {
    mixture: Mixture,
    seed: u64,
    floors: Floors,
    arrays: Arrays,
    generator: Generator,
    extractor: FeatureExtractor,
    radar: Radar,
}

/// What is learned from one scene.
#[derive(Debug, Clone)]
pub struct Example {
    /// Kind of the scene.
    pub kind: Kind,
    /// Its floor.
    pub floor: Floor,
    /// The samples of both ends, heard by elements that may be off.
    pub ends: TwoEnds,
    /// The live network's input.
    pub input: LiveInput,
    /// The map of the whole array as it should be, `[512, 1024]`: decades of amplitude relative to [`LiveInput::gain`].
    pub decades: Array2<f32>,
}

/// Why there are no examples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExamplesError {
    /// Test scenes of a kind that makes none.
    #[error("{0} makes no scenes for tests; expected a purpose of training or validation")]
    ForTests(Kind),
    /// The network can't use the radar.
    #[error(transparent)]
    Radar(#[from] ReconstructError),
}

/// Why there is no example.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExampleError {
    /// The scene can't be simulated, or the task was cancelled.
    #[error("example {index}: {source}")]
    Scene {
        /// Number of the example.
        index: u32,
        /// Why.
        source: Unfinished,
    },
    /// The network can't use its samples.
    #[error("example {index}: {source}")]
    Input {
        /// Number of the example.
        index: u32,
        /// Why.
        source: ReconstructError,
    },
}

impl Examples {
    /// Examples of the default radar, which the live network is for. `purpose` picks the streams of the scenes: those of different purposes
    /// never meet.
    ///
    /// # Errors
    /// [`ExamplesError`] names the kind or the radar that can't be.
    pub fn new(
        mixture: Mixture,
        purpose: Purpose,
        seed: u64,
        floors: Floors,
        arrays: Arrays,
    ) -> Result<Self, ExamplesError> {
        if purpose == Purpose::Test && mixture.shares().iter().any(|(kind, _)| *kind == Kind::World) {
            return Err(ExamplesError::ForTests(Kind::World));
        }
        let radar = Radar::default();
        let generator = Generator::new(&radar, Reading::Program, purpose, seed);
        Ok(Examples { mixture, seed, floors, arrays, generator, extractor: FeatureExtractor::new(&radar)?, radar })
    }

    /// Example `index`.
    ///
    /// # Errors
    /// [`ExampleError`], also soon after `task` was cancelled.
    pub fn example(&self, index: u32, task: &Task) -> Result<Example, ExampleError> {
        let kind = self.mixture.kind(self.seed, index);
        let mut scene = self.generator.scene(kind, index);
        let floor = SceneSet::Generated(kind).floor(self.floors.of(scene.noise_seed));
        let simulated = |scene: &Scene| {
            simulate_for(task, &self.radar, scene, floor, scene.noise_seed)
                .map_err(|source| ExampleError::Scene { index, source })
        };
        let signal = simulated(&scene)?;
        let array = self.arrays.of(scene.noise_seed, &self.radar);
        let ends = if array.is_ideal() {
            signal.two_ends(&self.radar)
        } else {
            scene.disturbances.elements = array;
            simulated(&scene)?.two_ends(&self.radar)
        };
        let input = self.extractor.extract(&ends).map_err(|source| ExampleError::Input { index, source })?;
        let map = whole_map(&self.radar, &range_transform_in_place(&self.radar, signal));
        let decades = map.mapv_into(|v| (f64::from(v) - input.gain) as f32);
        Ok(Example { kind, floor, ends, input, decades })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Decibels, Tolerances};
    use crate::signal::simulate;

    fn examples(seed: u64, floors: Floors) -> Examples {
        Examples::new("2=1,3=1".parse().unwrap(), Purpose::Training, seed, floors, Arrays::IDEAL).unwrap()
    }

    #[test]
    fn an_example_does_not_depend_on_what_was_asked_before() {
        let floors = Floors::Thermal { share: 0.5, from: Decibels(10.0), to: Decibels(60.0) };
        let task = Task::default();
        let first = examples(1, floors).example(7, &task).unwrap();
        let other = examples(1, floors);
        other.example(8, &task).unwrap();
        let again = other.example(7, &task).unwrap();
        assert_eq!((&first.input, first.floor, &first.decades), (&again.input, again.floor, &again.decades));
        assert_ne!(
            first.input,
            examples(2, floors).example(7, &task).unwrap().input,
            "another seed is another example"
        );
    }

    #[test]
    fn an_example_is_the_generators_scene() {
        let example = examples(1, Floors::Fixed(Floor::Thesis)).example(3, &Task::default()).unwrap();
        let radar = Radar::default();
        let scene = Generator::new(&radar, Reading::Program, Purpose::Training, 1).scene(example.kind, 3);
        let signal = simulate(&radar, &scene, Floor::Thesis, scene.noise_seed).unwrap();
        assert_eq!(example.ends, signal.two_ends(&radar));
        let map = crate::maps::LogMaps::of_signal(&radar, &signal).full;
        let off =
            example.decades.iter().zip(map.decades()).map(|(a, b)| (f64::from(*a) + example.input.gain - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-5);
    }

    #[test]
    fn elements_that_are_off_change_the_input_alone() {
        let floors = Floors::Fixed(Floor::Thesis);
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 20.0, position_millimetres: 0.1 };
        let mixture = || "2".parse().unwrap();
        let off = Examples::new(mixture(), Purpose::Training, 1, floors, Arrays { share: 1.0, tolerances }).unwrap();
        let ideal = Examples::new(mixture(), Purpose::Training, 1, floors, Arrays::IDEAL).unwrap();
        let [off, ideal] = [off, ideal].map(|examples| examples.example(5, &Task::default()).unwrap());
        assert_ne!(off.ends, ideal.ends);
        let both = [&off, &ideal].map(|e| e.decades.iter().map(|v| f64::from(*v) + e.input.gain).collect::<Vec<_>>());
        assert!(both[0].iter().zip(&both[1]).all(|(a, b)| (a - b).abs() < 1e-5));
    }

    #[test]
    fn the_world_makes_no_test_examples() {
        let of = |purpose| {
            Examples::new("world".parse().unwrap(), purpose, 1, Floors::Fixed(Floor::Thesis), Arrays::IDEAL).map(|_| ())
        };
        assert_eq!(of(Purpose::Test), Err(ExamplesError::ForTests(Kind::World)));
        assert_eq!((of(Purpose::Training), of(Purpose::Validation)), (Ok(()), Ok(())));
    }

    #[test]
    fn an_example_of_noise_lies_over_a_level_of_its_own() {
        let noise =
            Examples::new("noise".parse().unwrap(), Purpose::Training, 1, Floors::Fixed(Floor::Thesis), Arrays::IDEAL)
                .unwrap();
        assert!(matches!(noise.example(0, &Task::default()).unwrap().floor, Floor::Level(_)));
    }
}
