//! Maps of a recording in place of a scene, and of the part that the drawn reflectors leave unexplained.

use super::memo::Memo;
use crate::app::shared::Shared;
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

/// The part of a recording that reflectors leave unexplained.
#[derive(Debug, Clone)]
pub struct Unexplained {
    /// Map of the residual, on the scale of the recording's own map.
    pub map: ReadyMap,
    /// Part of the recording's power that the reflectors explain, 0 to 1.
    pub explained: f64,
}

/// The maps of one recording, for one radar and its errors of elements.
pub struct RecordedMaps {
    /// The recording with window and ends of the radar on screen.
    seen: Recording,
    ends: Arc<TwoEnds>,
    logs: [Option<LogMap>; 3],
    ready: Memo<Normalisation, [Option<ReadyMap>; 3]>,
    /// Map of the last scene's residual and the explained part, or the reason why it can't be fitted.
    left: Memo<Shared<Scene>, Result<(LogMap, f64), String>>,
    shown: Memo<(Shared<Scene>, Normalisation), Result<Unexplained, String>>,
    took: Duration,
}

/// `recording` with the window of `radar` and, where every element was recorded, its ends. Where `elements` is not ideal, their responses multiply the
/// samples.
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
    pub fn new(recording: &Arc<Recording>, radar: &Radar, elements: &BuiltArray) -> Self {
        let start = Instant::now();
        let seen = seen_by(recording, radar, elements);
        let ([first, last], full) = maps_of(&seen);
        let ends = Arc::new(seen.two_ends());
        RecordedMaps {
            seen,
            ends,
            logs: [Some(first), Some(last), full],
            ready: Memo::default(),
            left: Memo::default(),
            shown: Memo::default(),
            took: start.elapsed(),
        }
    }

    /// The wanted maps; unchanged ones are the same `Arc` as in the last call.
    pub fn frame(&mut self, wanted: &MapRequest) -> EngineFrame {
        let start = Instant::now();
        let [first, last, full] = self.ready.of(wanted.normalisation, |normalisation| {
            self.logs.each_ref().map(|log| log.as_ref().map(|log| ready(log, log.scale(*normalisation))))
        });
        let [first, last, full] = [(first, wanted.first), (last, wanted.last), (full, wanted.full)]
            .map(|(map, is)| map.clone().filter(|_| is));
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
            first,
            last,
            full,
            ends: Some(self.ends.clone()).filter(|_| wanted.ends),
            settled: true,
            report: EngineReport { stages, total: took + start.elapsed() },
        }
    }

    /// The residual of `recording` after a fit of the reflectors of `scene`, on the scale of the recording's own map.
    ///
    /// # Errors
    /// The reason why they can't be fitted.
    pub fn unexplained(&mut self, scene: &Arc<Scene>, normalisation: Normalisation) -> Result<Unexplained, String> {
        let left = self.left.of(scene.into(), |scene| {
            let found = explain(&self.seen, scene).map_err(|e| e.to_string())?;
            let ([first, _], full) = maps_of(&found.residual);
            Ok((full.unwrap_or(first), found.explained))
        });
        let whole = self.logs[2].as_ref().or(self.logs[0].as_ref());
        let shown = self.shown.of((scene.into(), normalisation), |_| {
            let (log, explained) = left.as_ref().map_err(String::clone)?;
            let scale = whole.ok_or_else(|| "the recording has no map".to_owned())?.scale(normalisation);
            Ok(Unexplained { map: ready(log, scale), explained: *explained })
        });
        shown.clone()
    }
}

pub fn ready(log: &LogMap, scale: LambdaScale) -> ReadyMap {
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
        let nothing = maps.unexplained(&Arc::default(), WANTED.normalisation).unwrap();
        assert_eq!((nothing.map.lambda, nothing.explained), (full.lambda.clone(), 0.0));
        let left = maps.unexplained(&Arc::new(Scene::of_points([(0.0, 3.0)])), WANTED.normalisation).unwrap();
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
    fn only_maps_of_another_radar_are_made_again() {
        let (radar, recording) = recorded();
        let mut maps = RecordedMaps::new(&recording, &radar, &BuiltArray::default());
        let (a, b) = (maps.frame(&WANTED), maps.frame(&WANTED));
        assert!(Arc::ptr_eq(&a.full.unwrap().lambda, &b.full.unwrap().lambda) && !b.report.ran(EngineStage::FullMap));
        let other = Radar { window: crate::radar::WindowFunction::Hamming, end_elements: 9, ..radar };
        let frame = RecordedMaps::new(&recording, &other, &BuiltArray::default()).frame(&WANTED);
        assert_eq!(frame.ends.unwrap().first.nrows(), 9);
    }

    #[test]
    fn two_ends_have_no_target_and_are_explained_by_their_own_map() {
        let (radar, recording) = recorded();
        let ends = Recording { samples: Recorded::Ends(recording.two_ends()), ..Recording::clone(&recording) };
        let mut maps = RecordedMaps::new(&Arc::new(ends), &radar, &BuiltArray::default());
        let frame = maps.frame(&WANTED);
        assert!(frame.full.is_none());
        let left = maps.unexplained(&Arc::default(), WANTED.normalisation).unwrap();
        assert_eq!(left.map.lambda, frame.first.unwrap().lambda);
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
