//! Training examples: input and target of one scene.

use super::run::{TrainError, TrainingRun};
use super::students::Student;
use crate::maps::RangeAngleMap;
use crate::scene::generate::{Generator, Kind};
use crate::signal::{Floor, simulate};

/// Input and target of scene `number` of a kind over the thesis' floor.
///
/// # Errors
/// [`TrainError`] when the scene can't be simulated or the network can't use its samples.
pub(super) fn lesson<S: Student>(
    config: &S::Config,
    run: &TrainingRun,
    generator: &Generator,
    (kind, number): (Kind, u32),
) -> Result<(Vec<f32>, RangeAngleMap), TrainError> {
    let scene = generator.scene(kind, number);
    let signal = simulate(&run.radar, &scene, Floor::Thesis, scene.noise_seed)?;
    let input = S::input(config, &run.radar, &signal.two_ends(&run.radar))?;
    Ok((input, S::target(config, &run.radar, &signal)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::thesis::{Thesis, ThesisConfig};
    use crate::radar::Radar;
    use crate::scene::generate::{Purpose, Reading};
    use std::time::Duration;

    #[test]
    fn a_lesson_lies_over_noise_of_its_own() {
        let radar = Radar { samples: 16, elements: 32, end_elements: 4, ..Radar::default() };
        let run = TrainingRun {
            folder: "none".into(),
            device: burn::tensor::Device::flex(),
            radar: radar.clone(),
            max_steps: None,
            max_time: None,
            untrained: false,
            checkpoint_every: Duration::ZERO,
            origin: Default::default(),
        };
        let config = ThesisConfig { filters: 2, levels: 2, alive_output: false };
        let generator = |purpose| Generator::new(&radar, Reading::Program, purpose, 0);
        let target = |purpose| lesson::<Thesis>(&config, &run, &generator(purpose), (Kind::Set1, 0)).unwrap().1.lambda;
        let scene = |purpose| generator(purpose).scene(Kind::Set1, 0);
        assert_ne!(scene(Purpose::Training).noise_seed, scene(Purpose::Test).noise_seed);
        let plain = simulate(&radar, &scene(Purpose::Training), Floor::Thesis, 0).unwrap();
        let plain = Thesis::target(&config, &radar, &plain).lambda;
        assert_ne!(target(Purpose::Training), plain, "not the seed that every scene once shared");
    }
}
