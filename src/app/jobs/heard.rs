//! Samples and map of a layout of elements other than the two ends.

use super::memo::Memo;
use super::recorded::{ready, seen_by};
use super::source::Source;
use crate::app::shared::Shared;
use crate::engine::ReadyMap;
use crate::maps::focus::layout_map;
use crate::maps::{LogMap, Normalisation};
use crate::signal::{self, BeatSignal, LayoutSamples, SimulationError};
use crate::task::Task;

pub struct Heard {
    pub samples: Shared<LayoutSamples>,
    log: LogMap,
    shown: Memo<Normalisation, ReadyMap>,
}

impl Heard {
    /// The samples of a scene, or of a recording of every element; `None` for a recording of the two ends alone.
    ///
    /// # Errors
    /// [`SimulationError`] when the scene can't be simulated, or `task` was cancelled.
    pub fn of(task: &Task, source: &Source, layout: &[usize]) -> Result<Option<Heard>, SimulationError> {
        let Source { radar, scene, recording, floor } = source;
        let elements = &scene.disturbances.elements;
        let heard = |signal: &BeatSignal| {
            let samples = signal.of_layout(layout);
            let log = layout_map(radar, elements, &samples).log_magnitude();
            Heard { samples: Shared::new(samples), log, shown: Memo::default() }
        };
        Ok(match recording {
            None => Some(heard(&signal::simulate_for(task, radar, scene, *floor, scene.noise_seed)?)),
            Some(recording) => seen_by(recording, radar, elements).signal().map(heard),
        })
    }

    pub fn map(&mut self, normalisation: Normalisation) -> ReadyMap {
        self.shown.of(normalisation, |normalisation| ready(&self.log, self.log.scale(*normalisation))).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::Aperture;
    use crate::maps::focus::map_of;
    use crate::radar::{BuiltArray, Radar};
    use crate::recording::{Recorded, Recording};
    use crate::scene::Scene;
    use crate::signal::Floor;

    #[test]
    fn every_element_of_the_array_hears_the_target() {
        let radar = Radar { elements: 64, end_elements: 6, samples: 32, ..Radar::default() };
        let scene = Shared::new(Scene::of_points([(0.2, 0.9)]));
        let mut source = Source { radar: radar.clone(), scene, recording: None, floor: Floor::Thesis };
        let signal = source.every_element().unwrap();
        let target = map_of(&radar, &BuiltArray::default(), &signal, Aperture::Full).log_magnitude();
        let every: Vec<usize> = (0..64).collect();
        let heard = |source: &Source, layout: &[usize]| Heard::of(&Task::default(), source, layout).unwrap();
        assert_eq!(*heard(&source, &every).unwrap().log.decades(), *target.decades());
        let few = heard(&source, &[0, 9, 63]).unwrap();
        assert_eq!(few.samples.samples.row(1), signal.samples.row(9));
        let mut recording = Recording::of_signal(radar.clone(), signal.clone());
        source.recording = Some(Shared::new(recording.clone()));
        assert_eq!(heard(&source, &[0, 9, 63]).unwrap().samples.samples, few.samples.samples);
        recording.samples = Recorded::Ends(signal.two_ends(&radar));
        source.recording = Some(Shared::new(recording));
        assert!(heard(&source, &[0, 9, 63]).is_none());
    }
}
