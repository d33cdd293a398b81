//! Examples to train on: example `i` is a function of (mixture, seed, i) alone, whoever asks, in whatever order.

use super::arrays::Arrays;
use super::constants::turn_columns;
use super::features::{FeatureExtractor, LiveInput};
use super::radars::Radars;
use crate::evaluate::sets::SceneSet;
use crate::maps::{fast::whole_map, range_transform_in_place};
use crate::network::domain::Domain;
use crate::network::floors::Floors;
use crate::radar::Radar;
use crate::reconstruct::ReconstructError;
use crate::scene::Scene;
use crate::scene::generate::{Generator, Kind, Mixture, Purpose, Reading};
use crate::signal::{Floor, TwoEnds, Unfinished, simulate_for};
use crate::task::Task;
use ndarray::Array2;

/// Makes examples.
#[derive(Debug)]
pub struct Examples {
    mixture: Mixture,
    purpose: Purpose,
    seed: u64,
    floors: Floors,
    arrays: Arrays,
    radars: Radars,
    /// Tables of the radar, where all scenes have the same.
    extractor: Option<FeatureExtractor>,
}

/// What is learned from one scene.
#[derive(Debug, Clone)]
pub struct Example {
    /// Kind of the scene.
    pub kind: Kind,
    /// Its floor.
    pub floor: Floor,
    /// Its radar.
    pub radar: Radar,
    /// The samples of both ends, heard by elements that may be off.
    pub ends: TwoEnds,
    /// The live network's input.
    pub input: LiveInput,
    /// The map of the whole array as it should be, `[512, 1024]`: decades of amplitude relative to [`LiveInput::gain`]. cos(theta) rises with the
    /// column in both conventions.
    pub decades: Array2<f32>,
}

/// Why there are no examples.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExamplesError {
    /// Test scenes of a kind that makes none.
    #[error("{0} makes no scenes for tests; expected a purpose of training or validation")]
    ForTests(Kind),
    /// A kind whose objects find no room before a radar.
    #[error("scenes of {kind} need a radar that sees {needed} m far; this one sees {found:.1} m")]
    NoRoom {
        /// The kind.
        kind: Kind,
        /// Maximum range that it needs, metres.
        needed: f64,
        /// Least maximum range of the radars, metres.
        found: f64,
    },
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
    /// Examples of scenes of `mixture` before `radars`. `purpose` picks the streams of the scenes: those of different purposes never meet.
    ///
    /// # Errors
    /// [`ExamplesError`] names the kind or the radar that can't be.
    pub fn new(
        mixture: Mixture,
        purpose: Purpose,
        seed: u64,
        floors: Floors,
        arrays: Arrays,
        radars: Radars,
    ) -> Result<Self, ExamplesError> {
        if purpose == Purpose::Test && mixture.shares().iter().any(|(kind, _)| *kind == Kind::World) {
            return Err(ExamplesError::ForTests(Kind::World));
        }
        let found = radars.least_max_range_metres();
        let crowded = mixture.shares().iter().find(|(kind, _)| kind.needed_range_metres() > found);
        if let Some(&(kind, _)) = crowded {
            return Err(ExamplesError::NoRoom { kind, needed: kind.needed_range_metres(), found });
        }
        let extractor = match &radars {
            Radars::Fixed(radar) => Some(FeatureExtractor::new(radar)?),
            Radars::Random => None,
        };
        Ok(Examples { mixture, purpose, seed, floors, arrays, radars, extractor })
    }

    /// What a network that learns from them is trained for.
    pub fn domain(&self) -> Domain {
        self.radars.domain()
    }

    /// Example `index`.
    ///
    /// # Errors
    /// [`ExampleError`], also soon after `task` was cancelled.
    pub fn example(&self, index: u32, task: &Task) -> Result<Example, ExampleError> {
        let kind = self.mixture.kind(self.seed, index);
        let radar = self.radars.of(self.seed, self.purpose, index);
        let mut scene = Generator::new(&radar, Reading::Program, self.purpose, self.seed).scene(kind, index);
        let floor = SceneSet::Generated(kind).floor(self.floors.of(scene.noise_seed));
        let simulated = |scene: &Scene| {
            simulate_for(task, &radar, scene, floor, scene.noise_seed)
                .map_err(|source| ExampleError::Scene { index, source })
        };
        let signal = simulated(&scene)?;
        let array = self.arrays.of(scene.noise_seed, &radar);
        let ends = if array.is_ideal() {
            signal.two_ends(&radar)
        } else {
            scene.disturbances.elements = array;
            simulated(&scene)?.two_ends(&radar)
        };
        let input = match &self.extractor {
            Some(extractor) => extractor.extract(&ends),
            None => FeatureExtractor::new(&radar).and_then(|extractor| extractor.extract(&ends)),
        };
        let input = input.map_err(|source| ExampleError::Input { index, source })?;
        let mut decades = whole_map(&radar, &range_transform_in_place(&radar, signal));
        decades.mapv_inplace(|v| (f64::from(v) - input.gain) as f32);
        if let Some(cells) = decades.as_slice_mut() {
            turn_columns(&radar, cells);
        }
        Ok(Example { kind, floor, radar, ends, input, decades })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Convention, Decibels, Tolerances};
    use crate::signal::simulate;

    fn examples(seed: u64, floors: Floors) -> Examples {
        Examples::new("2=1,3=1".parse().unwrap(), Purpose::Training, seed, floors, Arrays::IDEAL, Radars::default())
            .unwrap()
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
        let off = Examples::new(
            mixture(),
            Purpose::Training,
            1,
            floors,
            Arrays { share: 1.0, tolerances },
            Radars::default(),
        )
        .unwrap();
        let ideal = Examples::new(mixture(), Purpose::Training, 1, floors, Arrays::IDEAL, Radars::default()).unwrap();
        let [off, ideal] = [off, ideal].map(|examples| examples.example(5, &Task::default()).unwrap());
        assert_ne!(off.ends, ideal.ends);
        let both = [&off, &ideal].map(|e| e.decades.iter().map(|v| f64::from(*v) + e.input.gain).collect::<Vec<_>>());
        assert!(both[0].iter().zip(&both[1]).all(|(a, b)| (a - b).abs() < 1e-5));
    }

    #[test]
    fn the_world_makes_no_test_examples() {
        let of = |purpose| {
            Examples::new(
                "world".parse().unwrap(),
                purpose,
                1,
                Floors::Fixed(Floor::Thesis),
                Arrays::IDEAL,
                Radars::Random,
            )
            .map(|_| ())
        };
        assert_eq!(of(Purpose::Test), Err(ExamplesError::ForTests(Kind::World)));
        assert_eq!((of(Purpose::Training), of(Purpose::Validation)), (Ok(()), Ok(())));
    }

    #[test]
    fn an_example_of_noise_lies_over_a_level_of_its_own() {
        let noise = examples_of("noise", Radars::default());
        assert!(matches!(noise.example(0, &Task::default()).unwrap().floor, Floor::Level(_)));
    }

    fn examples_of(mixture: &str, radars: Radars) -> Examples {
        let floors = Floors::Fixed(Floor::Thesis);
        Examples::new(mixture.parse().unwrap(), Purpose::Training, 1, floors, Arrays::IDEAL, radars).unwrap()
    }

    #[test]
    fn columns_of_a_physical_radar_rise_with_cos_theta() {
        let physical = Radar::default().in_convention(Convention::Physical);
        let generator = Generator::new(&physical, Reading::Program, Purpose::Training, 1);
        let cos_of = |index: u32| {
            let point = generator.scene(Kind::Set1, index).reflectors()[0];
            point.x_metres / point.x_metres.hypot(point.y_metres)
        };
        let index = (0..100).find(|index| (0.3..0.9).contains(&cos_of(*index).abs())).unwrap();
        let cos = cos_of(index);
        let maker = examples_of("1", Radars::Fixed(Box::new(physical)));
        let example = maker.example(index, &Task::default()).unwrap();
        let strongest = |cells: &[f32], columns: usize| {
            let at = cells.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
            ((at % columns) as f64 / columns as f64 - 0.5) * 2.0
        };
        // The whole array's target, what both ends agree on, and one end's beams.
        let target = strongest(example.decades.as_slice().unwrap(), 1024);
        let fine = strongest(&example.input.fine[..512 * 256], 256);
        let coarse = strongest(&example.input.coarse[..512 * 64], 64);
        for (found, off) in [(target, 0.12), (fine, 0.12), (coarse, 0.2)] {
            assert!((found - cos).abs() < off, "{found} for {cos}");
        }
    }

    #[test]
    fn an_example_of_a_random_radar_is_that_of_the_radar() {
        let random = examples_of("world", Radars::Random);
        for index in 0..6 {
            let example = random.example(index, &Task::default()).unwrap();
            let alone = examples_of("world", Radars::Fixed(Box::new(example.radar.clone())));
            let alone = alone.example(index, &Task::default()).unwrap();
            assert_eq!((example.input, example.decades), (alone.input, alone.decades), "{index}");
        }
    }

    #[test]
    fn a_kind_that_finds_no_room_is_named() {
        let near = Radar { bandwidth_hz: 6e9, ..Radar::default() };
        for radars in [Radars::Random, Radars::Fixed(Box::new(near))] {
            let floors = Floors::Fixed(Floor::Thesis);
            let made = Examples::new("2,street".parse().unwrap(), Purpose::Training, 1, floors, Arrays::IDEAL, radars);
            let told = made.unwrap_err().to_string();
            assert!(told.contains("scenes of street need a radar that sees 20 m far; this one sees 12.8 m"), "{told}");
        }
    }
}
