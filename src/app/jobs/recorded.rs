//! A recording in the place of a scene: its maps, and what the reflectors laid over it leave unexplained.

use crate::engine::{EngineFrame, EngineReport, EngineStage, MapRequest, ReadyMap, StageOutcome, StageReport};
use crate::maps::{LambdaScale, LogMap, Normalisation, RangeAngleMap};
use crate::picture::maps_of;
use crate::platform::Instant;
use crate::radar::{BuiltArray, End, Radar};
use crate::recording::explain::explain;
use crate::recording::{Recorded, Recording};
use crate::scene::Scene;
use crate::signal::{TwoEnds, apply_responses};
use std::sync::Arc;
use std::time::Duration;

/// What reflectors leave of a recording.
#[derive(Debug, Clone)]
pub struct Unexplained {
    /// The map of what is left, in the colours of the recording's own.
    pub map: ReadyMap,
    /// Part of the recording's power that the reflectors explain, 0 to 1.
    pub explained: f64,
}

/// What one scene leaves of the recording.
struct Left {
    of: Arc<Scene>,
    /// The map of it and the part that the scene explains, or why it can't be fitted.
    map: Result<(LogMap, f64), String>,
}

/// The maps of one recording, kept until another radar looks at it.
pub struct RecordedMaps {
    recording: Arc<Recording>,
    elements: BuiltArray,
    /// The recording as the radar on screen takes it: with that radar's window and ends.
    seen: Recording,
    ends: Arc<TwoEnds>,
    logs: [Option<LogMap>; 3],
    normalisation: Option<Normalisation>,
    ready: [Option<ReadyMap>; 3],
    left: Option<Left>,
    shown: Option<Result<Unexplained, String>>,
    took: Duration,
}

/// `recording` as `radar` takes it, which may have another window and, where every element was recorded, other ends; its samples
/// multiplied with what `elements` do, where something is wrong with them.
pub fn seen_by(recording: &Recording, radar: &Radar, elements: &BuiltArray) -> Recording {
    let mut seen = Recording { radar: radar.clone(), ..recording.clone() };
    if elements.is_ideal() {
        return seen;
    }
    let dead = |n: &usize| elements.element(*n).dead;
    match &mut seen.samples {
        Recorded::All(signal) => apply_responses(elements, signal),
        Recorded::Ends(ends) => {
            for (samples, end) in [(&mut ends.first, End::First), (&mut ends.last, End::Last)] {
                for (mut samples, n) in samples.outer_iter_mut().zip(radar.end_range(end)) {
                    let response = elements.element(n).response();
                    samples.iter_mut().for_each(|v| *v *= response);
                }
            }
        }
    }
    seen.missing.extend((0..radar.elements).filter(dead));
    seen.missing.sort_unstable();
    seen.missing.dedup();
    seen
}

impl RecordedMaps {
    /// Transforms `recording`.
    pub fn new(recording: &Arc<Recording>, radar: &Radar, elements: &BuiltArray) -> Self {
        let start = Instant::now();
        let seen = seen_by(recording, radar, elements);
        let ([first, last], full) = maps_of(&seen);
        let ends = Arc::new(seen.two_ends());
        RecordedMaps {
            recording: recording.clone(),
            elements: elements.clone(),
            seen,
            ends,
            logs: [Some(first), Some(last), full],
            normalisation: None,
            ready: [None, None, None],
            left: None,
            shown: None,
            took: start.elapsed(),
        }
    }

    /// Whether these are the maps of `recording` seen by `radar` with `elements`.
    pub fn is_of(&self, recording: &Arc<Recording>, radar: &Radar, elements: &BuiltArray) -> bool {
        Arc::ptr_eq(&self.recording, recording) && self.seen.radar == *radar && self.elements == *elements
    }

    /// The maps that are wanted; what did not change since the last call is the same `Arc` as then.
    pub fn frame(&mut self, wanted: &MapRequest) -> EngineFrame {
        let start = Instant::now();
        if self.normalisation.replace(wanted.normalisation) != Some(wanted.normalisation) {
            let ready = |log: &Option<LogMap>| log.as_ref().map(|log| ready(log, log.scale(wanted.normalisation)));
            self.ready = [0, 1, 2].map(|i| ready(&self.logs[i]));
            self.shown = None;
        }
        let took = std::mem::take(&mut self.took);
        let stage =
            |stage, took, what: &str| StageReport { stage, took, outcome: StageOutcome::Computed(what.to_owned()) };
        let stages = match took {
            Duration::ZERO => {
                vec![StageReport { stage: EngineStage::Signal, took, outcome: StageOutcome::Skipped("recorded") }]
            }
            took => vec![
                stage(EngineStage::Signal, Duration::ZERO, "recorded"),
                stage(EngineStage::FullMap, took, "all maps of the recording"),
            ],
        };
        EngineFrame {
            first: self.ready[0].clone().filter(|_| wanted.first),
            last: self.ready[1].clone().filter(|_| wanted.last),
            full: self.ready[2].clone().filter(|_| wanted.full),
            ends: Some(self.ends.clone()).filter(|_| wanted.ends),
            settled: true,
            report: EngineReport { stages, total: took + start.elapsed() },
        }
    }

    /// What the reflectors of `scene` leave, in the scale of the last [`RecordedMaps::frame`].
    ///
    /// # Errors
    /// Why they can't be fitted.
    pub fn unexplained(&mut self, scene: &Arc<Scene>) -> Result<Unexplained, String> {
        if !self.left.as_ref().is_some_and(|left| Arc::ptr_eq(&left.of, scene)) {
            let map = explain(&self.seen, scene).map_err(|e| e.to_string()).map(|found| {
                let ([first, _], full) = maps_of(&found.residual);
                (full.unwrap_or(first), found.explained)
            });
            (self.left, self.shown) = (Some(Left { of: scene.clone(), map }), None);
        }
        if self.shown.is_none() {
            let whole = self.logs[2].as_ref().or(self.logs[0].as_ref());
            let scale = whole.zip(self.normalisation).map(|(log, normalisation)| log.scale(normalisation));
            self.shown = self.left.as_ref().map(|left| {
                let (log, explained) = left.map.as_ref().map_err(String::clone)?;
                let scale = scale.ok_or_else(|| "the recording has no map yet".to_owned())?;
                Ok(Unexplained { map: ready(log, scale), explained: *explained })
            });
        }
        self.shown.clone().unwrap_or_else(|| Err("nothing was fitted".to_owned()))
    }
}

fn ready(log: &LogMap, scale: LambdaScale) -> ReadyMap {
    let lambda = RangeAngleMap { lambda: log.decades().mapv(|v| scale.lambda(v).clamp(0.0, 1.0) as f32) };
    ReadyMap { lambda: Arc::new(lambda), scale }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::signal::{Floor, simulate};

    fn recorded() -> (Radar, Arc<Recording>) {
        let radar = Radar { elements: 64, end_elements: 6, samples: 96, ..Radar::default() };
        let scene = Scene::of_points([(0.0, 3.0), (1.5, 4.0)]);
        let signal = simulate(&radar, &scene, Floor::Exact, 0).unwrap();
        (radar.clone(), Arc::new(Recording::of_signal(radar, signal)))
    }

    const WANTED: MapRequest = MapRequest {
        floor: Floor::Exact,
        seed: 0,
        normalisation: Normalisation::DynamicRange(Decibels(60.0)),
        first: true,
        last: true,
        full: true,
        ends: true,
    };

    #[test]
    fn only_what_is_laid_over_its_echo_turns_dark() {
        let (radar, recording) = recorded();
        let mut maps = RecordedMaps::new(&recording, &radar, &BuiltArray::default());
        let full = maps.frame(&WANTED).full.unwrap();
        let nothing = maps.unexplained(&Arc::default()).unwrap();
        assert_eq!((nothing.map.lambda, nothing.explained), (full.lambda.clone(), 0.0));
        let left = maps.unexplained(&Arc::new(Scene::of_points([(0.0, 3.0)]))).unwrap();
        let cell = |x: f64, y: f64| {
            let place = radar.polar_of(x, y);
            let bin = radar.bin_of_range(place.range_metres).round() as usize;
            [bin, radar.column_of_cos(place.cos_theta).round() as usize]
        };
        let (explained, other) = (cell(0.0, 3.0), cell(1.5, 4.0));
        assert!(left.map.lambda.lambda[explained] < full.lambda.lambda[explained] - 0.4);
        assert!((left.map.lambda.lambda[other] - full.lambda.lambda[other]).abs() < 0.05);
        assert!((0.3..0.95).contains(&left.explained), "{}", left.explained);
    }

    #[test]
    fn maps_of_an_unchanged_radar_are_not_made_again() {
        let (radar, recording) = recorded();
        let mut maps = RecordedMaps::new(&recording, &radar, &BuiltArray::default());
        let (a, b) = (maps.frame(&WANTED), maps.frame(&WANTED));
        assert!(Arc::ptr_eq(&a.full.unwrap().lambda, &b.full.unwrap().lambda) && !b.report.ran(EngineStage::FullMap));
    }

    #[test]
    fn a_radar_of_other_ends_has_maps_of_its_own() {
        let (radar, recording) = recorded();
        let maps = RecordedMaps::new(&recording, &radar, &BuiltArray::default());
        let hamming = Radar { window: crate::radar::WindowFunction::Hamming, end_elements: 9, ..radar.clone() };
        assert!(
            maps.is_of(&recording, &radar, &BuiltArray::default())
                && !maps.is_of(&recording, &hamming, &BuiltArray::default())
        );
        assert_eq!(
            RecordedMaps::new(&recording, &hamming, &BuiltArray::default()).frame(&WANTED).ends.unwrap().first.nrows(),
            9
        );
    }

    /// Maps of a recording by the two ends alone.
    fn of_two_ends() -> RecordedMaps {
        let (radar, recording) = recorded();
        let ends = Recording { samples: Recorded::Ends(recording.two_ends()), ..Recording::clone(&recording) };
        RecordedMaps::new(&Arc::new(ends), &radar, &BuiltArray::default())
    }

    #[test]
    fn two_ends_have_no_target() {
        let frame = of_two_ends().frame(&WANTED);
        assert!(frame.full.is_none() && frame.first.is_some());
    }

    #[test]
    fn two_ends_are_explained_by_their_own_map() {
        let mut maps = of_two_ends();
        let frame = maps.frame(&WANTED);
        assert_eq!(maps.unexplained(&Arc::default()).unwrap().map.lambda, frame.first.unwrap().lambda);
    }

    #[test]
    fn a_dead_element_is_silent_in_a_recording_too() {
        let (radar, recording) = recorded();
        let mut elements = BuiltArray::default().fitted(64);
        elements.elements = vec![crate::radar::ElementError::default(); 64];
        elements.elements[2].dead = true;
        elements.elements[63].gain = Decibels(20.0);
        let before = recording.two_ends();
        let ends = Recording { samples: Recorded::Ends(before.clone()), ..Recording::clone(&recording) };
        for recording in [Recording::clone(&recording), ends] {
            let seen = seen_by(&recording, &radar, &elements);
            assert_eq!(seen.missing, [2]);
            let after = seen.two_ends();
            assert_eq!(after.first.row(2).iter().map(|v| v.norm()).sum::<f64>(), 0.0);
            assert_eq!(after.first.row(1), before.first.row(1));
            assert!((after.last[[5, 7]] - before.last[[5, 7]] * 10.0).norm() < 1e-9 * before.last[[5, 7]].norm());
        }
    }
}
