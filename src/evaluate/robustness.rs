//! Errors of methods on arrays with element errors.

use super::campaign::CampaignError;
use super::estimate::Estimate;
use super::metrics::Metrics;
use super::trial::Trial;
use crate::maps::Normalisation;
use crate::radar::{Radar, Tolerances, check_layout};
use crate::reconstruct::{Reconstructor, Request};
use crate::scene::generate::{Generator, Kind, Purpose, Reading};
use crate::scene::{Reflector, SceneError};
use crate::signal::{BeatSignal, Floor, calibrate, simulate_built};
use crate::task::Task;
use serde::Serialize;
use std::sync::Arc;

/// A run of methods on scenes of arrays with element errors.
#[derive(Debug, Clone)]
pub struct Robustness {
    /// The radar with exact elements.
    pub radar: Radar,
    /// Numbers of the elements whose samples methods get in place of the two ends.
    pub layout: Option<Vec<usize>>,
    /// Kind of the test scenes.
    pub kind: Kind,
    /// Seed of the scenes, of their noise and of the elements' errors.
    pub seed: u64,
    /// Number of scenes; each meets an array of its own.
    pub count: u32,
    /// Noise of the scene.
    pub floor: Floor,
    /// Errors at scale 1.
    pub tolerances: Tolerances,
    /// Factors of the tolerances, in the order of the answer.
    pub scales: Vec<f64>,
    /// Whether the array is first calibrated on the scene's strongest reflector.
    pub calibrated: bool,
}

/// One method at one scale of errors; figures against the map of the exact array.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobustnessRow {
    /// Name of the method.
    pub method: &'static str,
    /// Factor of the tolerances.
    pub scale: f64,
    /// Standard deviation of the elements' gains.
    pub gain_decibels: f64,
    /// Standard deviation of the elements' phases.
    pub phase_degrees: f64,
    /// Standard deviation of the elements' places.
    pub position_millimetres: f64,
    /// SE.
    pub squared_error: Estimate,
    /// P_D at the method's own threshold.
    pub detection: Estimate,
    /// P_FA at the method's own threshold.
    pub false_alarm: Estimate,
}

impl Robustness {
    /// Tries every method at every scale, on the same scenes and with errors that differ by the scale alone. `on_map` is called after every map.
    /// # Errors
    /// [`CampaignError`] names the scene, and the method that failed or was cancelled through `task`.
    pub fn run(
        &self,
        methods: &[&dyn Reconstructor],
        task: &Task,
        mut on_map: impl FnMut(),
    ) -> Result<Vec<RobustnessRow>, CampaignError> {
        self.kind.check_room(&self.radar)?;
        let has_elements = self.layout.iter().try_for_each(|layout| check_layout(layout, self.radar.elements));
        has_elements.map_err(CampaignError::Refused)?;
        let mut metrics = vec![vec![Vec::new(); self.scales.len()]; methods.len()];
        let request = Request { noise: self.floor.into(), task: task.clone(), ..Request::default() };
        let set = || self.kind.to_string();
        for index in 0..self.count {
            let failed = |error: SceneError| CampaignError::Refused(format!("scene {index} of {}: {error}", set()));
            let (mut trial, signals) = self.trial(index).map_err(failed)?;
            for (i, signal) in signals.into_iter().enumerate() {
                trial.ends = signal.two_ends(&self.radar);
                trial.layout_samples = self.layout.as_ref().map(|layout| Arc::new(signal.of_layout(layout)));
                for (method, metrics) in methods.iter().zip(&mut metrics) {
                    let answer = trial.ask(*method, &request).map_err(|source| CampaignError::Method {
                        method: method.name(),
                        set: set(),
                        index,
                        source,
                    })?;
                    metrics[i].push(answer.metrics);
                    on_map();
                }
            }
        }
        let rows = methods.iter().zip(&metrics).flat_map(|(method, metrics)| {
            self.scales.iter().zip(metrics).map(|(scale, metrics)| self.row(method.name(), *scale, metrics))
        });
        Ok(rows.collect())
    }

    fn row(&self, method: &'static str, scale: f64, metrics: &[Metrics]) -> RobustnessRow {
        let estimate =
            |of: fn(&Metrics) -> Option<f64>| Estimate::of(&metrics.iter().filter_map(of).collect::<Vec<f64>>());
        let tolerances = self.tolerances.times(scale);
        RobustnessRow {
            method,
            scale,
            gain_decibels: tolerances.gain.0,
            phase_degrees: tolerances.phase_degrees,
            position_millimetres: tolerances.position_millimetres,
            squared_error: estimate(|m| Some(m.squared_error)),
            detection: estimate(|m| m.detection),
            false_alarm: estimate(|m| Some(m.false_alarm)),
        }
    }

    /// Scene `number`, and the signal of the array at each scale.
    fn trial(&self, number: u32) -> Result<(Trial, Vec<BeatSignal>), SceneError> {
        let radar = &self.radar;
        let scene = Generator::new(radar, Reading::Program, Purpose::Test, self.seed).scene(self.kind, number);
        let trial = Trial::new(radar, &scene, self.floor, Normalisation::MinMax)?;
        let loudness = |r: &Reflector| r.reflectivity.abs() / (r.x_metres.powi(2) + r.y_metres.powi(2));
        let loudest = scene.reflectors().into_iter().max_by(|a, b| loudness(a).total_cmp(&loudness(b)));
        let signal = |scale: &f64| {
            let array = self.tolerances.times(*scale).build(radar, self.seed.wrapping_add(u64::from(number)));
            let mut signal = simulate_built(radar, &scene, &array, self.floor, scene.noise_seed)?;
            let on = loudest.filter(|_| self.calibrated).and_then(|r| calibrate(radar, &signal, &r));
            if let Some(calibration) = on {
                calibration.divide_out(&mut signal);
            }
            Ok(signal)
        };
        let signals = self.scales.iter().map(signal).collect::<Result<_, SceneError>>()?;
        Ok((trial, signals))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Decibels;
    use crate::reconstruct::{MatchedFilter, Omp};

    #[test]
    fn calibration_lowers_the_cost_of_element_errors() {
        let tolerances = Tolerances { gain: Decibels(1.0), phase_degrees: 40.0, position_millimetres: 0.0 };
        let robustness = Robustness {
            radar: Radar { elements: 256, samples: 256, ..Radar::default() },
            layout: None,
            kind: Kind::Set1,
            seed: 3,
            count: 2,
            floor: Floor::Snr(Decibels(40.0)),
            tolerances,
            scales: vec![0.0, 1.0],
            calibrated: false,
        };
        let methods: [&dyn Reconstructor; 2] = [&Omp::default(), &MatchedFilter::Incoherent];
        let mut maps = 0;
        let rows = robustness.run(&methods, &Task::default(), || maps += 1).unwrap();
        assert_eq!((rows.len(), maps), (4, 8));
        assert_eq!((rows[0].method, rows[0].scale, rows[1].phase_degrees), ("omp", 0.0, 40.0));
        let error = |row: &RobustnessRow| row.squared_error.mean;
        assert!(error(&rows[1]) > error(&rows[0]), "{rows:?}");
        // One point alone calibrates its own array.
        let calibrated = Robustness { calibrated: true, ..robustness }.run(&methods, &Task::default(), || ()).unwrap();
        assert!(error(&calibrated[1]) < 0.5 * (error(&rows[0]) + error(&rows[1])), "{calibrated:?} {rows:?}");
    }
}
