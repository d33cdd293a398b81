//! Training examples: input and target of one scene.

use super::run::{TrainError, TrainingRun};
use super::trainable_network::TrainableNetwork;
use crate::maps::RangeAngleMap;
use crate::scene::generate::{Generator, Kind};
use crate::signal::{Floor, simulate};

/// Input and target of scene `number` of a kind over the thesis' floor.
/// # Errors
/// [`TrainError`] when the scene can't be simulated or the network can't use its samples.
pub(super) fn lesson<S: TrainableNetwork>(
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
    use crate::network::thesis::Thesis;
    use crate::network::train::tests::{recipe, run};
    use crate::scene::generate::{Purpose, Reading};
    use std::path::Path;

    #[test]
    fn a_lesson_lies_over_noise_of_its_own() {
        let (run, (_, config)) = (run(Path::new("none"), 1), recipe());
        let generator = Generator::new(&run.radar, Reading::Program, Purpose::Training, 0);
        let (_, target) = lesson::<Thesis>(&config, &run, &generator, (Kind::Set1, 0)).unwrap();
        let plain = simulate(&run.radar, &generator.scene(Kind::Set1, 0), Floor::Thesis, 0).unwrap();
        let plain = Thesis::target(&config, &run.radar, &plain).lambda;
        assert_ne!(target.lambda, plain, "not the seed that every scene once shared");
    }
}
