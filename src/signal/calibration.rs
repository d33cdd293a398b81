//! Calibration of a built array by a reflector at a known place.

use super::{ArrayEcho, BeatSignal};
use crate::radar::{BuiltArray, Decibels, ElementError, Radar, chirp_window};
use crate::scene::Reflector;
use ndarray::ArrayView1;
use num_complex::Complex64;

/// Element errors estimated from one reflector.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Gain and phase of each element, relative to the mean of those that receive; the others are dead.
    pub array: BuiltArray,
    /// Part of the samples' energy that the fit does not explain: other reflectors, noise, and errors other than gain and phase.
    pub unexplained: f64,
}

/// Gain and phase of every element from the echo of `reflector` in `signal`, by least squares under a Hann window against the echo at an
/// ideal element. Reflectors two range bins away or more disturb little. `None` where no element receives the echo.
pub fn calibrate(radar: &Radar, signal: &BeatSignal, reflector: &Reflector) -> Option<Calibration> {
    let polar = radar.polar_of(reflector.x_metres, reflector.y_metres);
    let (mut energy, mut residual_energy) = (0.0, 0.0);
    let window = chirp_window(radar.samples);
    let mean_weight = window.iter().sum::<f64>() / radar.samples as f64;
    let response = |(n, samples): (usize, ArrayView1<'_, Complex64>)| {
        let echo = ArrayEcho::at_pairs(radar, &[radar.pair(n)], polar.range_metres, polar.cos_theta);
        let samples = samples.to_vec();
        let weighted: Vec<Complex64> = samples.iter().zip(&window).map(|(v, w)| v * w).collect();
        let gain = echo.correlate(&weighted) / mean_weight;
        let all: f64 = samples.iter().map(Complex64::norm_sqr).sum();
        energy += all;
        let explained = 2.0 * (gain.conj() * echo.correlate(&samples)).re - gain.norm_sqr();
        residual_energy += (all - explained).max(0.0);
        gain / echo.norm()
    };
    let responses: Vec<Complex64> = signal.samples.outer_iter().enumerate().map(response).collect();
    let received: Vec<&Complex64> = responses.iter().filter(|r| r.norm_sqr() > 0.0 && r.is_finite()).collect();
    // The mean gain is that of decibels, and the mean phase that of the sum, which depends little on single elements.
    let mean_decades = received.iter().map(|r| r.norm().log10()).sum::<f64>() / received.len() as f64;
    let mean_phase = received.iter().map(|r| *r / r.norm()).sum::<Complex64>().arg();
    let element = |r: &Complex64| {
        if !(r.norm_sqr() > 0.0 && r.is_finite()) {
            return ElementError { dead: true, ..ElementError::default() };
        }
        ElementError {
            gain: Decibels(20.0 * (r.norm().log10() - mean_decades)),
            phase_degrees: (r * Complex64::cis(-mean_phase)).arg().to_degrees(),
            ..ElementError::default()
        }
    };
    (!received.is_empty()).then(|| Calibration {
        array: BuiltArray { elements: responses.iter().map(element).collect() },
        unexplained: residual_energy / energy,
    })
}

impl Calibration {
    /// Divides `signal` by the gains and phases; the samples of dead elements stay zero.
    pub fn divide_out(&self, signal: &mut BeatSignal) {
        for (n, mut samples) in signal.samples.outer_iter_mut().enumerate() {
            let response = self.array.element(n).response();
            if response.norm_sqr() > 0.0 {
                samples.iter_mut().for_each(|v| *v /= response);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::built::tests::{small, two_points};
    use super::*;
    use crate::radar::Tolerances;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate, simulate_built};

    #[test]
    fn calibration_removes_the_errors_of_elements() {
        let (radar, scene) = (small(), two_points());
        let tolerances = Tolerances { gain: Decibels(1.5), phase_degrees: 20.0, position_millimetres: 0.0 };
        let array = tolerances.build(&radar, 2);
        let floor = Floor::Snr(Decibels(30.0));
        let mut signal = simulate_built(&radar, &scene, &array, floor, 1).unwrap();
        let reflector = scene.reflectors()[0];
        let found = calibrate(&radar, &signal, &reflector).unwrap();
        // The other reflector is a hundred bins away: its side lobes are all that disturbs.
        let (first_gain, first_phase) = (array.elements[0].gain.0, array.elements[0].phase_degrees);
        for (f, e) in found.array.elements.iter().zip(&array.elements) {
            let gain = f.gain.0 - found.array.elements[0].gain.0 - (e.gain.0 - first_gain);
            let phase = f.phase_degrees - found.array.elements[0].phase_degrees - (e.phase_degrees - first_phase);
            assert!(gain.abs() < 0.3 && phase.abs() < 2.0, "{f:?} {e:?}");
        }
        let spread = found.array.spread();
        assert!(spread.gain.0 > 1.0 && spread.phase_degrees > 14.0, "{spread:?}");
        assert!(found.unexplained > 0.01 && found.unexplained < 0.5, "the other reflector: {}", found.unexplained);
        found.divide_out(&mut signal);
        let corrected = calibrate(&radar, &signal, &reflector).unwrap().array.spread();
        assert!(corrected.gain.0 < 1e-6 && corrected.phase_degrees < 1e-6, "{corrected:?}");
    }

    #[test]
    fn reflectors_a_few_bins_away_hardly_disturb_a_calibration() {
        let radar = small();
        let tolerances = Tolerances { gain: Decibels(1.5), phase_degrees: 20.0, position_millimetres: 0.0 };
        let array = tolerances.build(&radar, 2);
        // Eight bins further out, a little stronger.
        let scene = Scene::of_points([(0.0, 11.0), (1.0, 11.6)]);
        let signal = simulate_built(&radar, &scene, &array, Floor::Exact, 1).unwrap();
        let mut corrected = signal.clone();
        calibrate(&radar, &signal, &scene.reflectors()[0]).unwrap().divide_out(&mut corrected);
        let ideal = simulate(&radar, &scene, Floor::Exact, 1).unwrap();
        let ratio = |n: usize| corrected.samples[[n, 9]] / ideal.samples[[n, 9]];
        for n in 0..radar.elements {
            let off = ratio(n) / ratio(0);
            assert!((off - 1.0).norm() < 0.02, "element {n}: {off}");
        }
    }

    #[test]
    fn zeros_have_no_calibration() {
        let radar = small();
        let reflector = two_points().reflectors()[0];
        assert_eq!(calibrate(&radar, &BeatSignal::silence(&radar), &reflector), None);
    }
}
