//! Running a plan.

use super::simd::{LANES_F32, LANES_F64};
use super::synthesis::Synthesis;
use super::{Algorithm, BeatSignal, Precision, SynthesisPlan, direct, exact};
use crate::radar::{BuiltArray, Radar};
use crate::scattering::Sources;
use crate::task::Task;
use ndarray::{Array2, s};
use num_complex::Complex64;
use std::ops::Range;

/// Runs a plan: the whole array's beat signal, noiseless. The scatterers must have passed [`crate::scene::Scene::validate`].
pub fn beat_signal<'a>(radar: &Radar, sources: impl Into<Sources<'a>>, plan: &SynthesisPlan) -> BeatSignal {
    let sources = sources.into();
    match plan.algorithm {
        Algorithm::Direct => direct::beat_signal(radar, sources),
        Algorithm::Exact => exact::beat_signal(radar, sources),
        _ => BeatSignal {
            samples: samples_of(radar, &BuiltArray::default(), sources, plan, 0..radar.elements, &Task::default()),
        },
    }
}

/// Noiseless samples of neighbouring elements at the true positions of `array`, by a block algorithm ([`Algorithm::is_fast`]), `[elements,
/// samples]`, with the bits of the whole array. Meaningless once `task` is cancelled.
pub(super) fn samples_of(
    radar: &Radar,
    array: &BuiltArray,
    sources: Sources<'_>,
    plan: &SynthesisPlan,
    elements: Range<usize>,
    task: &Task,
) -> Array2<Complex64> {
    let lanes = if plan.precision == Precision::F32 { LANES_F32 } else { LANES_F64 };
    // Whole blocks are computed: an element's neighbours in a vector may change its last bits.
    let begin = elements.start / lanes * lanes;
    let blocks = begin..elements.end.next_multiple_of(lanes).min(radar.elements);
    let mut samples = match plan.precision {
        Precision::F32 => Synthesis::<f32, LANES_F32>::new(radar, *plan).at(array).samples(sources, blocks, task),
        Precision::F64 => Synthesis::<f64, LANES_F64>::new(radar, *plan).at(array).samples(sources, blocks, task),
    };
    samples.slice_collapse(s![elements.start - begin..elements.end - begin, ..]);
    samples
}

#[cfg(test)]
mod tests {
    use super::super::judge;
    use super::super::plan::BEST_TOLERANCE;
    use super::super::simd::Simd;
    use super::*;
    use crate::radar::Carrier;
    use crate::scattering::EchoSources;
    use crate::scene::{Block, Object, Point, Post, Reflector, Scene, Wall};

    fn worst_error(radar: &Radar, reflectors: &[Reflector], chosen: &SynthesisPlan) -> f64 {
        let signal = beat_signal(radar, reflectors, chosen);
        let mut worst = 0.0f64;
        let mut peak = 0.0f64;
        for element in [0, 1, 7, 300, 511, 700, 1016, 1023] {
            for (a, b) in signal.samples.row(element).iter().zip(judge::element_signal(radar, reflectors, element)) {
                worst = worst.max((a - b).norm());
                peak = peak.max(b.norm());
            }
        }
        worst / peak
    }

    fn scattered(count: usize) -> Vec<Reflector> {
        let at = |i: usize| (f64::from(i as u32 * 37 % 61) - 30.0, 2.0 + f64::from(i as u32 * 53 % 33) + 0.37);
        Scene::of_points((0..count).map(at)).reflectors()
    }

    #[test]
    fn every_algorithm_keeps_its_promise_on_every_instruction_set() {
        let radar = Radar::default();
        for count in [1, 10, 60] {
            let reflectors = scattered(count);
            for simd in Simd::available() {
                for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
                    for algorithm in [Algorithm::Split, Algorithm::Gridded] {
                        let plan = SynthesisPlan::cheapest(count, 1.0, tolerance);
                        let chosen = SynthesisPlan { simd, algorithm, ..plan };
                        let error = worst_error(&radar, &reflectors, &chosen);
                        assert!(error < tolerance, "{count} reflectors, {chosen:?}: {error:e}");
                    }
                }
            }
            let best = SynthesisPlan::cheapest(count, 1.0, BEST_TOLERANCE);
            assert_eq!((best.algorithm, best.precision), (Algorithm::Split, Precision::F64));
            let error = worst_error(&radar, &reflectors, &best);
            assert!(error < 1e-14, "{count}: {error:e}");
        }
    }

    fn bodies() -> Scene {
        let objects = vec![
            Object::Wall(Wall { roughness_millimetres: 0.4, ..Wall::new(-3.0, 20.0, 2.0, 10.0) }),
            Object::Box(Block::new([1.0, 9.0], [4.5, 1.8], 80.0)),
            Object::Post(Post::new(-2.0, 12.0, 0.2)),
            Object::Point(Point::new(1.5, 25.0)),
            Object::Point(Point::new(-20.0, 5.0)),
        ];
        Scene { objects, ..Scene::default() }
    }

    #[test]
    fn every_algorithm_keeps_its_promise_for_bodies() {
        for carrier in [Carrier::OneWay, Carrier::TwoWay] {
            let radar = Radar { elements: 64, carrier, ..Radar::default() };
            let echoing = EchoSources::of(&radar, &bodies());
            let scale = crate::signal::plan::amplitude_bound(&radar, &echoing);
            let expected = judge::beat_signal(&radar, &echoing).samples;
            for algorithm in [Algorithm::Direct, Algorithm::Exact, Algorithm::Split, Algorithm::Gridded] {
                for tolerance in [1e-6, 1e-12] {
                    let plan = SynthesisPlan::cheapest(echoing.len(), 1.0, tolerance).with_algorithm(algorithm);
                    let found = beat_signal(&radar, &echoing, &plan).samples;
                    let worst = (&found - &expected).iter().fold(0.0f64, |m, v| m.max(v.norm())) / scale;
                    let bound = if algorithm == Algorithm::Direct { 1e-10 } else { tolerance };
                    assert!(worst < bound, "{algorithm} at {tolerance:e}: {worst:e}");
                }
            }
        }
    }

    /// Sums of any length stay within f32's tolerance, also where all roundings agree because all reflectors coincide.
    #[test]
    fn thousands_of_reflectors_keep_the_promise_in_single_precision() {
        let radar = Radar { elements: 32, end_elements: 4, ..Radar::default() };
        let together = |place: (f64, f64)| Scene::of_points(std::iter::repeat_n(place, 10_000)).reflectors();
        let scenes = [
            together((0.5, 9.0)),
            together((-20.0, 3.3)),
            together((3.0, 30.01)),
            [scattered(60), together((1.0, 7.7))].concat(),
            scattered(10_000),
            scattered(3_000),
        ];
        for reflectors in scenes {
            let count = reflectors.len();
            let best = SynthesisPlan::cheapest(count, 1.0, 1e-14);
            let coarse = SynthesisPlan::cheapest(count, 1.0, 1e-6);
            assert_eq!((best.precision, coarse.precision), (Precision::F64, Precision::F32));
            let expected = beat_signal(&radar, &reflectors, &best).samples;
            let found = beat_signal(&radar, &reflectors, &coarse).samples;
            // Relative to the amplitudes, as tolerances are.
            let scale = crate::signal::plan::amplitude_bound(&radar, &reflectors);
            let worst = (&found - &expected).iter().fold(0.0f64, |m, v| m.max(v.norm())) / scale;
            assert!(worst < 1e-6, "{count}: {worst:e}");
        }
    }
}
