//! The source of the samples on screen.

use super::memo::Memo;
use super::recorded::seen_by;
use crate::app::shared::Shared;
use crate::app::state::State;
use crate::radar::Radar;
use crate::recording::Recording;
use crate::scene::Scene;
use crate::signal::{self, BeatSignal, Floor};

/// All that the samples depend on. Equal sources have equal samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    pub radar: Radar,
    /// The scene before the radar, or the one drawn over a recording.
    pub scene: Shared<Scene>,
    /// The recording in place of the scene's echoes.
    pub recording: Option<Shared<Recording>>,
    pub floor: Floor,
}

impl Source {
    pub fn of(state: &State) -> Source {
        Source {
            radar: state.radar().clone(),
            scene: state.scene().into(),
            recording: state.editor.document().recording().map(Shared::from),
            floor: state.settings.floor,
        }
    }

    /// The samples of every element, for panels that show every element.
    ///
    /// # Errors
    /// As [`Source::signal`].
    pub fn every_element(&self) -> Result<BeatSignal, String> {
        self.signal("The recording has the two ends alone; every element is needed here.")
    }

    /// The samples of every element.
    ///
    /// # Errors
    /// The reason why a scene can't be simulated, or `ends_alone` for a recording of the two ends.
    pub fn signal(&self, ends_alone: &str) -> Result<BeatSignal, String> {
        let Source { radar, scene, recording, floor } = self;
        match recording {
            None => signal::simulate(radar, scene, *floor, scene.noise_seed).map_err(|e| e.to_string()),
            Some(recording) => match seen_by(recording, radar, &scene.disturbances.elements).signal() {
                Some(signal) => Ok(signal.clone()),
                None => Err(ends_alone.to_owned()),
            },
        }
    }
}

/// The samples of the last source, kept for other cursors, elements and colours.
pub type KeptSignal = Memo<Source, BeatSignal>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_those_of_the_floor() {
        let scene = Shared::new(Scene::of_points([(0.2, 0.9)]));
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let source = Source { radar, scene, recording: None, floor: Floor::Thesis };
        let thesis = source.every_element().unwrap().samples;
        assert_ne!(thesis, Source { floor: Floor::Exact, ..source }.every_element().unwrap().samples);
    }
}
