//! What is learned from one scene.

use super::run::{Run, TrainError};
use super::students::Student;
use crate::maps::RangeAngleMap;
use crate::scene::generate::{Generator, Kind};
use crate::signal::{Floor, simulate};

/// Input and target of scene `number` of a kind, over the thesis' floor with the scene's own noise.
///
/// # Errors
/// [`TrainError`] when the scene can't be simulated or the network can't use its samples.
pub(super) fn lesson<S: Student>(
    tables: &S::Tables,
    config: &S::Config,
    run: &Run,
    generator: &Generator,
    (kind, number): (Kind, u32),
) -> Result<(S::Input, RangeAngleMap), TrainError> {
    let scene = generator.scene(kind, number);
    let signal = simulate(&run.radar, &scene, Floor::Thesis, scene.noise_seed)?;
    let input = S::input(tables, &signal.two_ends(&run.radar))?;
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
    fn two_lessons_lie_over_different_noise() {
        let radar = Radar { samples: 16, elements: 32, end_elements: 4, ..Radar::default() };
        let run = Run {
            folder: "none".into(),
            device: burn::tensor::Device::flex(),
            radar: radar.clone(),
            max_steps: None,
            max_time: None,
            checkpoint_every: Duration::ZERO,
            origin: Default::default(),
        };
        let config = ThesisConfig { filters: 2, levels: 2, alive_output: false };
        let generator = |purpose| Generator::new(&radar, Reading::Program, purpose, 0);
        let target = |purpose, kind| {
            let lesson = lesson::<Thesis>(&radar, &config, &run, &generator(purpose), (kind, 0));
            lesson.unwrap().1.lambda
        };
        let seeds = |purpose| generator(purpose).noise_seed(Kind::Set1, 0);
        assert_ne!(seeds(Purpose::Training), seeds(Purpose::Test));
        let scene = generator(Purpose::Training).scene(Kind::Set1, 0);
        let plain = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
        let plain = Thesis::target(&config, &radar, &plain).lambda;
        assert_ne!(target(Purpose::Training, Kind::Set1), plain, "not the seed that every scene once shared");
    }
}
