//! The incremental engine, without threads: whoever owns it decides where it runs.

use super::{Frame, LiveMap, Report, Stage, Wanted};
use crate::maps::{Aperture, LogMap, angle_transform, range_transform};
use crate::radar::{End, Radar};
use crate::scene::{Scene, SceneError};
use crate::signal::{self, BeatSignal, TwoEnds};
use std::sync::Arc;
use std::time::Instant;

/// Keeps what it computed for one radar and recomputes only what a change touches.
#[derive(Debug)]
pub struct Engine {
    radar: Radar,
    last: Option<Computed>,
}

#[derive(Debug)]
struct Computed {
    scene: Scene,
    wanted: Wanted,
    signal: BeatSignal,
    ends: Option<Arc<TwoEnds>>,
    logs: [Option<LogMap>; 3],
    maps: [Option<LiveMap>; 3],
}

const APERTURES: [Aperture; 3] = [Aperture::End(End::First), Aperture::End(End::Last), Aperture::Full];
const STAGES: [Stage; 3] = [Stage::FirstMap, Stage::LastMap, Stage::FullMap];

impl Engine {
    /// An engine that has computed nothing yet. The radar must be valid ([`Radar::validate`]).
    pub fn new(radar: Radar) -> Self {
        Engine { radar, last: None }
    }

    /// The radar it simulates.
    pub fn radar(&self) -> &Radar {
        &self.radar
    }

    /// Computes what is wanted of `scene`; what did not change since the last call is the same `Arc` as then.
    ///
    /// # Errors
    /// [`SceneError`] when the scene can't be simulated. The engine stays usable.
    pub fn update(&mut self, scene: &Scene, wanted: &Wanted) -> Result<Frame, SceneError> {
        let begin = Instant::now();
        let mut report = Report::default();
        let same = |l: &Computed| {
            l.scene.objects == scene.objects && l.wanted.floor == wanted.floor && l.wanted.seed == wanted.seed
        };
        let mut state = match self.last.take().filter(same) {
            Some(last) => {
                report.skipped(Stage::Signal, "the scene did not change");
                last
            }
            None => {
                let signal = signal::simulate(&self.radar, scene, wanted.floor, wanted.seed)?;
                report.computed(Stage::Signal, begin.elapsed(), format!("{} reflectors", scene.reflector_count()));
                let (scene, wanted) = (scene.clone(), *wanted);
                Computed { scene, wanted, signal, ends: None, logs: [None, None, None], maps: [None, None, None] }
            }
        };
        if wanted.ends && state.ends.is_none() {
            let start = Instant::now();
            state.ends = Some(Arc::new(state.signal.two_ends(&self.radar)));
            report.computed(Stage::Ends, start.elapsed(), "copied");
        } else {
            report.skipped(Stage::Ends, if wanted.ends { "unchanged" } else { "not looked at" });
        }
        let visible = [wanted.first, wanted.last, wanted.full];
        let mut profiles = None;
        for i in 0..3 {
            if !visible[i] || state.logs[i].is_some() {
                report.skipped(STAGES[i], if visible[i] { "unchanged" } else { "not looked at" });
                continue;
            }
            let start = Instant::now();
            let profiles = profiles.get_or_insert_with(|| range_transform(&self.radar, &state.signal));
            state.logs[i] = Some(angle_transform(&self.radar, profiles, APERTURES[i]).log_magnitude());
            state.maps[i] = None;
            report.computed(STAGES[i], start.elapsed(), "all rows");
        }
        if state.wanted.normalisation != wanted.normalisation {
            state.maps = [None, None, None];
        }
        let start = Instant::now();
        let mut normalised = 0;
        for (log, map) in state.logs.iter().zip(&mut state.maps) {
            if let (Some(log), None) = (log, &map) {
                let lambda = Arc::new(log.normalise(wanted.normalisation));
                *map = Some(LiveMap { lambda, scale: log.scale(wanted.normalisation) });
                normalised += 1;
            }
        }
        if normalised > 0 {
            report.computed(Stage::Normalise, start.elapsed(), format!("{normalised} maps"));
        } else {
            report.skipped(Stage::Normalise, "unchanged");
        }
        report.total = begin.elapsed();
        state.wanted = *wanted;
        let shown = |i: usize| visible[i].then(|| state.maps[i].clone()).flatten();
        let frame = Frame {
            first: shown(0),
            last: shown(1),
            full: shown(2),
            ends: state.ends.clone().filter(|_| wanted.ends),
            report,
        };
        self.last = Some(state);
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::Normalisation;
    use crate::radar::Decibels;

    fn small() -> Radar {
        Radar { elements: 64, samples: 32, ..Radar::default() }
    }

    #[test]
    fn unchanged_results_are_the_same_arc() {
        let mut engine = Engine::new(small());
        let scene = Scene::of_points([(0.3, 1.0)]);
        let a = engine.update(&scene, &Wanted::default()).unwrap();
        let b = engine.update(&scene, &Wanted::default()).unwrap();
        let lambda = |f: &Frame| f.full.as_ref().unwrap().lambda.clone();
        assert!(Arc::ptr_eq(&lambda(&a), &lambda(&b)));
        assert!(a.report.ran(Stage::Signal) && !b.report.ran(Stage::Signal));
        let other = Wanted { normalisation: Normalisation::DynamicRange(Decibels(60.0)), ..Wanted::default() };
        let c = engine.update(&scene, &other).unwrap();
        assert!(!c.report.ran(Stage::FullMap) && c.report.ran(Stage::Normalise));
        assert!(!Arc::ptr_eq(&lambda(&a), &lambda(&c)));
    }

    #[test]
    fn hidden_maps_are_not_computed() {
        let mut engine = Engine::new(small());
        let wanted = Wanted { first: false, full: false, ends: false, ..Wanted::default() };
        let frame = engine.update(&Scene::of_points([(0.3, 1.0)]), &wanted).unwrap();
        assert!(frame.first.is_none() && frame.full.is_none() && frame.ends.is_none() && frame.last.is_some());
        assert!(!frame.report.ran(Stage::FullMap));
    }

    #[test]
    fn a_bad_scene_is_refused_and_the_engine_lives_on() {
        let mut engine = Engine::new(small());
        assert!(engine.update(&Scene::of_points([(f64::NAN, 1.0)]), &Wanted::default()).is_err());
        assert!(engine.update(&Scene::default(), &Wanted::default()).is_ok());
    }
}
