use super::*;
use crate::radar::{Decibels, Tolerances};
use crate::signal::simulate;

fn examples(seed: u64, floors: Floors) -> Examples {
    let mixture = "2=1,3=1".parse().unwrap();
    Examples::new(ExamplesRequest { mixture, seed, floors, ..ExamplesRequest::default() }).unwrap()
}

fn decades(example: &Example) -> &Array2<f32> {
    example.target(Target::Calibrated).unwrap()
}

#[test]
fn an_example_does_not_depend_on_earlier_calls() {
    let floors = Floors::Thermal { share: 0.5, from: Decibels(10.0), to: Decibels(60.0) };
    let task = Task::default();
    let first = examples(1, floors).example(7, &task).unwrap();
    let other = examples(1, floors);
    other.example(8, &task).unwrap();
    let again = other.example(7, &task).unwrap();
    assert_eq!((&first.input, first.floor, &first.targets), (&again.input, again.floor, &again.targets));
    assert_ne!(first.input, examples(2, floors).example(7, &task).unwrap().input, "another seed is another example");
}

#[test]
fn an_example_is_the_generators_scene() {
    let example = examples(1, Floors::Fixed(Floor::Thesis)).example(3, &Task::default()).unwrap();
    let radar = Radar::default();
    let scene = Generator::new(&radar, Reading::Program, Purpose::Training, 1).scene(example.kind.unwrap(), 3);
    let signal = simulate(&radar, &scene, Floor::Thesis, scene.noise_seed).unwrap();
    assert_eq!(example.ends(), Some(&signal.two_ends(&radar)));
    let map = crate::maps::LogMaps::of_signal(&radar, &signal).full;
    let off = decades(&example).iter().zip(map.decades()).map(|(a, b)| (f64::from(*a) + example.gain - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-5);
}

#[test]
fn the_world_makes_no_test_examples() {
    let of = |purpose| {
        let mixture = "world".parse().unwrap();
        let request = ExamplesRequest { mixture, purpose, radars: Radars::Random, ..ExamplesRequest::default() };
        Examples::new(request).map(drop)
    };
    assert!(of(Purpose::Test).unwrap_err().to_string().starts_with("world makes no scenes for tests"));
    assert_eq!((of(Purpose::Training), of(Purpose::Validation)), (Ok(()), Ok(())));
}

#[test]
fn an_example_of_noise_lies_over_a_level_of_its_own() {
    let noise = examples_of("noise", Radars::default());
    assert!(matches!(noise.example(0, &Task::default()).unwrap().floor, Floor::Level(_)));
}

fn examples_of(mixture: &str, radars: Radars) -> Examples {
    let mixture = mixture.parse().unwrap();
    Examples::new(ExamplesRequest { mixture, seed: 1, radars, ..ExamplesRequest::default() }).unwrap()
}

#[test]
fn an_example_of_a_random_radar_is_that_of_the_radar() {
    let random = examples_of("world", Radars::Random);
    for index in 0..6 {
        let example = random.example(index, &Task::default()).unwrap();
        let alone = examples_of("world", Radars::Fixed(Box::new(example.radar.clone())));
        let alone = alone.example(index, &Task::default()).unwrap();
        assert_eq!((example.input, example.targets), (alone.input, alone.targets), "{index}");
    }
}

#[test]
fn a_kind_that_finds_no_room_is_named() {
    let near = Radar { bandwidth_hz: 6e9, ..Radar::default() };
    for radars in [Radars::Random, Radars::Fixed(Box::new(near))] {
        let mixture = "2,street".parse().unwrap();
        let made = Examples::new(ExamplesRequest { mixture, radars, ..ExamplesRequest::default() });
        let told = made.unwrap_err().to_string();
        assert!(told.contains("scenes of street need a radar that sees 20 m far; this one sees 12.8 m"), "{told}");
    }
}

#[test]
fn targets_differ_in_noise_and_element_errors() {
    let floors = Floors::Fixed(Floor::Snr(Decibels(20.0)));
    let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 20.0, position_millimetres: 0.0 };
    let of = |arrays, targets| {
        let mixture = "2".parse().unwrap();
        let request = ExamplesRequest { mixture, floors, arrays, targets, ..ExamplesRequest::default() };
        Examples::new(request).unwrap().example(3, &Task::default()).unwrap()
    };
    let off = of(Arrays { share: 1.0, tolerances }, Target::ALL.to_vec());
    let ideal = of(Arrays::IDEAL, Target::ALL.to_vec());
    let maps = |e: &Example| Target::ALL.map(|target| e.target(target).unwrap().mapv(|v| f64::from(v) + e.gain));
    let ([of_ideal, of_measured, of_calibrated], [ideal, measured, calibrated]) = (maps(&off), maps(&ideal));
    let distance = |a: &Array2<f64>, b: &Array2<f64>| (a - b).mapv(f64::abs).mean().unwrap();
    assert_eq!(measured, calibrated, "no element is off");
    // Only cells well above the rounding of the transforms are compared in the map without noise.
    let peak = ideal.fold(f64::MIN, |most, v| v.max(most));
    let loud = |map: &Array2<f64>| map.mapv(|v| if v > peak - 8.0 { v } else { 0.0 });
    assert!(distance(&loud(&of_ideal), &loud(&ideal)) < 1e-3 && distance(&of_calibrated, &calibrated) < 1e-5);
    assert!(distance(&of_measured, &of_calibrated) > 0.01 && distance(&of_ideal, &of_calibrated) > 0.1);
}

#[test]
fn a_radar_of_another_shape_has_examples_without_features() {
    let radar = Radar { elements: 86, end_elements: 8, samples: 128, ..Radar::default() };
    let of = |features, layout| {
        let radars = Radars::Fixed(Box::new(radar.clone()));
        Examples::new(ExamplesRequest { radars, features, layout, ..ExamplesRequest::default() })
    };
    let with = of(Features::Needed, None).unwrap().example(0, &Task::default()).unwrap();
    assert_eq!(with.input.unwrap().fine.len(), 4 * 128 * 256);
    let example = of(Features::WherePossible, None).unwrap().example(0, &Task::default()).unwrap();
    assert!(example.input.is_none() && decades(&example).dim() == (128, 86));
    assert_eq!(example.ends().unwrap().first.dim(), (8, 128));
    let nested = vec![0, 1, 2, 3, 20, 40, 60, 85];
    let example = of(Features::WherePossible, Some(nested)).unwrap().example(0, &Task::default()).unwrap();
    assert!(matches!(&example.end_samples, EndSamples::Elements(samples) if samples.dim() == (8, 128)));
    let told = of(Features::No, Some(vec![3, 86])).unwrap_err().to_string();
    assert_eq!(told, "the layout has element 86; the radar has elements 0 to 85");
}
