//! The request and the answer of a reconstruction.

use super::{Attempt, NoisePrior};
use crate::maps::{Normalisation, RangeAngleMap};
use crate::radar::{Decibels, Polar, Radar};
use crate::scene::Reflector;
use crate::signal::{LayoutSamples, TwoEnds};
use crate::task::Task;
use ndarray::Array2;
use std::sync::Arc;

/// A request for a reconstruction: all that a method gets beside the samples.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Noise beneath the samples.
    pub noise: NoisePrior,
    /// Normalisation of the map, that of the map it is compared with.
    pub normalisation: Normalisation,
    /// Distance of the echoes of a single sample, metres, if it is known: one sample has no ranges. The echoes still count as plane waves.
    pub snapshot_range_metres: Option<f64>,
    /// Whether a method with a memory ([`Reconstructor::following`](super::Reconstructor::following)) may start from its last answer, as in a drag.
    pub may_follow: bool,
    /// Samples of another layout than the two ends, for methods that use them ([`Reconstructor::layout_support`](super::Reconstructor::layout_support)).
    pub layout_samples: Option<Arc<LayoutSamples>>,
    pub task: Task,
}

/// The radar whose ends are the halves of the array. Of an odd number of elements the middle one belongs to both.
pub(super) fn halves(radar: &Radar) -> Radar {
    Radar { end_elements: radar.elements.div_ceil(2), ..radar.clone() }
}

impl LayoutSamples {
    /// The [`halves`] of the array and their samples: zeros where the layout has no element. A middle element of both halves is filled in the first.
    pub(super) fn as_halves(&self, radar: &Radar) -> (Radar, TwoEnds) {
        let radar = halves(radar);
        let half = radar.end_elements;
        let silence = || Array2::zeros((half, radar.samples));
        let mut ends = TwoEnds { first: silence(), last: silence() };
        for (&element, samples) in self.layout.iter().zip(self.samples.outer_iter()) {
            match element.checked_sub(half) {
                None => ends.first.row_mut(element).assign(&samples),
                Some(_) => ends.last.row_mut(element - (radar.elements - half)).assign(&samples),
            }
        }
        (radar, ends)
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Reconstruction {
    /// Estimate of the whole array's Lambda, `[range bins, columns]`.
    pub lambda: RangeAngleMap,
    /// The reflectors that the method found, if it finds any. A reflectivity's sign is a guess where noise leaves the range uncertain by half a
    /// turn of the echo's phase; the sum of all is positive by convention.
    pub reflectors: Vec<Reflector>,
    /// Confidence of each of `reflectors`, 0 to 1 ([`Detection::confidence`]); empty for methods without confidences.
    pub confidences: Vec<f64>,
    /// The threshold for this answer, where the method derives one from its own estimate.
    pub eta: Option<f32>,
    /// Lambda that noise alone does not exceed in this map, where the method knows it: no threshold lies lower.
    /// [`reconstruct`](super::Reconstructor::reconstruct) has already raised `eta` to it.
    pub least_eta: Option<f32>,
    /// The method's estimate of its map's error, `[range bins, columns]`: nine of ten cells are no farther than this from the true Lambda, on
    /// scenes and over noise like those of its training. `None` for methods without such an estimate.
    pub doubt: Option<RangeAngleMap>,
    /// The attempts of a search, in their order; empty for other methods.
    pub trace: Vec<Attempt>,
}

/// A reflector in polar coordinates around the array's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Cosine of the angle between the array's axis (+x) and the reflector.
    pub cos_theta: f64,
    /// Distance from the array's centre, metres.
    pub range_metres: f64,
    /// Power of its echo, relative to the strongest one found.
    pub relative_power: Decibels,
    /// `w / (w + r)`, 0 to 1: the part of the energy around the echo's range, unexplained without it, that it explains. `w` is the growth of the
    /// unexplained energy where the echo is taken away and the gains of all others are fitted anew; `r` is the energy that all echoes together
    /// leave unexplained within two range bins of it, or the noise's there where that is more. Low where the other echoes, noise or remaining
    /// side lobes would do as well. `None` for methods without confidences.
    pub confidence: Option<f64>,
}

impl Detection {
    /// A reflector of reflectivity 1 at the detection's place, in front of the array.
    pub fn reflector(&self) -> Reflector {
        let Detection { cos_theta, range_metres, .. } = *self;
        let y_metres = range_metres * (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
        Reflector { x_metres: range_metres * cos_theta, y_metres, reflectivity: 1.0 }
    }
}

impl Reconstruction {
    /// The answer to silence: Lambda 0 everywhere, no reflector.
    pub fn silence(radar: &Radar) -> Self {
        Reconstruction::of_map(RangeAngleMap { lambda: Array2::zeros((radar.samples, radar.elements)) })
    }

    /// An answer that has a map alone.
    pub fn of_map(lambda: RangeAngleMap) -> Self {
        let (reflectors, confidences, trace) = (Vec::new(), Vec::new(), Vec::new());
        Reconstruction { lambda, reflectors, confidences, eta: None, least_eta: None, doubt: None, trace }
    }

    /// Moves reflectors that were found in plane waves to `range_metres`, with the same echoes.
    pub(super) fn moved_to(mut self, range_metres: f64) -> Self {
        for r in &mut self.reflectors {
            let nearer = range_metres / r.x_metres.hypot(r.y_metres);
            r.x_metres *= nearer;
            r.y_metres *= nearer;
            r.reflectivity *= nearer * nearer;
        }
        self
    }

    /// The reflectors in polar coordinates around the array's centre, strongest first, without those of reflectivity 0.
    pub fn detections(&self, radar: &Radar) -> Vec<Detection> {
        let amplitude = |r: &Reflector| r.reflectivity.abs() / (r.x_metres.powi(2) + r.y_metres.powi(2));
        let with_amplitude = |(i, r)| (amplitude(r), r, self.confidences.get(i).copied());
        let heard = self.reflectors.iter().enumerate().map(with_amplitude);
        let mut heard: Vec<_> = heard.filter(|(a, ..)| a.is_finite() && *a > 0.0).collect();
        heard.sort_by(|a, b| b.0.total_cmp(&a.0));
        let strongest = heard.first().map_or(1.0, |(a, ..)| *a);
        let detection = |(amplitude, r, confidence): (f64, &Reflector, Option<f64>)| {
            let Polar { range_metres, cos_theta } = radar.polar_of(r.x_metres, r.y_metres);
            // Samples of one range bin have no ranges; else ranges wrap where those of the map do.
            let range_metres = match radar.samples {
                1 => range_metres,
                _ => range_metres.rem_euclid(radar.max_range_metres()),
            };
            let relative_power = Decibels(20.0 * (amplitude / strongest).log10());
            Detection { cos_theta, range_metres, relative_power, confidence }
        };
        heard.into_iter().map(detection).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn detections_are_measured_from_the_centre() {
        let radar = Radar::default();
        let at = Reflector::at;
        let reflectors = vec![at([0.0, 20.0], -2.0), at([6.0, 8.0], 1.0), at([1.0, 1.0], 0.0)];
        let confidences = vec![0.25, 0.75, 1.0];
        let detections =
            Reconstruction { reflectors, confidences, ..Reconstruction::silence(&radar) }.detections(&radar);
        assert_eq!(detections.len(), 2, "nothing is heard of the third");
        let [near, far] = [detections[0], detections[1]];
        assert_eq!((near.cos_theta, near.range_metres, near.relative_power.0), (0.6, 10.0, 0.0));
        assert_eq!((far.cos_theta, far.range_metres), (0.0, 20.0));
        assert_eq!((near.confidence, far.confidence), (Some(0.75), Some(0.25)), "each keeps its own");
        assert!((far.relative_power.0 - 20.0 * 0.5f64.log10()).abs() < 1e-12, "twice the size at twice the distance");
    }

    #[test]
    fn ranges_beyond_the_axis_wrap_as_the_map_does() {
        let radar = Radar::default();
        let reflectors = vec![Reflector::at([0.0, radar.max_range_metres() + 1.5], 1.0)];
        let found = Reconstruction { reflectors, ..Reconstruction::silence(&radar) }.detections(&radar);
        assert!((found[0].range_metres - 1.5).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn what_moves_nearer_sounds_the_same() {
        let radar = Radar::default();
        let reflectors = vec![Reflector::at([600.0, 800.0], 4.0)];
        let found = Reconstruction { reflectors, ..Reconstruction::silence(&radar) }.moved_to(10.0);
        let [r] = found.reflectors[..] else { panic!("{found:?}") };
        let off = [(r.x_metres, 6.0), (r.y_metres, 8.0), (r.reflectivity, 4e-4)];
        assert!(off.iter().all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{r:?}");
    }
}
