//! A fit within a few neighbouring range bins, by as few samples.
//!
//! The range bins around an atom are taken from the spectrum of each windowed channel, and transformed back into as many samples, which are spaced
//! evenly over the same chirp. A radar with those samples has the same range bins and a smaller maximum range, so that a [`Fitter`] works for it. The
//! far side lobes are cut off, some 1e-3 of an echo: enough to compare rows and to find their ends, not for the last digits.

use super::echoes::Samples;
use super::groups::BinSpans;
use super::refine::Fitter;
use crate::radar::{Radar, SPEED_OF_LIGHT, hann_at};
use num_complex::Complex64;
use rayon::prelude::*;
use rustfft::FftPlanner;
use std::f64::consts::TAU;

/// Range bins beside an atom's own that are part of the gate, for its side lobes.
const SIDE_LOBE_BINS: f64 = 8.0;

/// Ratios of the numbers of samples of a chirp and of a gate. The first that leaves enough range bins is used.
const DECIMATIONS: [usize; 2] = [4, 2];

/// Samples with the spectra of their channels.
pub struct Spectra<'a> {
    radar: &'a Radar,
    fitter: &'a Fitter<'a>,
    pub samples: &'a Samples,
    /// Spectrum of each windowed channel, `[channel][range bin]`.
    channels: Vec<Vec<Complex64>>,
}

/// Neighbouring range bins of samples, and a fitter for them.
pub struct RangeGate<'a> {
    /// A fitter for a radar with fewer samples; it counts work in the same budget.
    pub fitter: Fitter<'a>,
    pub samples: Samples,
    /// Energy of the windowed samples at both ends.
    pub energy: f64,
    /// The first and the last range bin of each end whose side lobes are in the gate.
    pub intact: BinSpans,
}

impl<'a> Spectra<'a> {
    /// The spectra of `samples` under the Hann window of `fitter`.
    pub fn new(radar: &'a Radar, fitter: &'a Fitter<'a>, samples: &'a Samples) -> Self {
        let fft = FftPlanner::new().plan_fft_forward(radar.samples);
        let flat = samples.flat(&fitter.sensor);
        let of_channel = |samples: &[Complex64]| {
            let mut spectrum: Vec<Complex64> =
                samples.iter().zip(&fitter.squared).map(|(v, squared)| v * squared.sqrt()).collect();
            fft.process(&mut spectrum);
            spectrum
        };
        let channels = flat.par_chunks_exact(radar.samples).map(of_channel).collect();
        Spectra { radar, fitter, samples, channels }
    }

    /// The range bins of `spans` and `beyond_bins` to each side; all range bins where more than half of them are needed.
    pub fn gate(&self, spans: &BinSpans, beyond_bins: f64) -> RangeGate<'a> {
        let margin = SIDE_LOBE_BINS + beyond_bins;
        let needed = spans.iter().map(|(low, high)| high - low + 2.0 * margin).fold(0.0, f64::max);
        let all = self.radar.samples;
        let fits = |part: &&usize| all.is_multiple_of(**part) && needed <= (all / **part) as f64;
        let Some(part) = DECIMATIONS.iter().find(fits) else {
            return RangeGate {
                fitter: self.fitter.clone(),
                samples: self.samples.clone(),
                energy: self.fitter.energy(self.samples),
                intact: [(f64::NEG_INFINITY, f64::INFINITY); 2],
            };
        };
        self.decimated(spans, all / part)
    }

    /// The `bins` range bins around the middle of `spans` at each end.
    fn decimated(&self, spans: &BinSpans, bins: usize) -> RangeGate<'a> {
        let (all, every) = (self.radar.samples as f64, (self.radar.samples / bins) as f64);
        // The first sample; all are symmetric about the middle of the chirp.
        let start = (every - 1.0) / 2.0;
        let first = spans.map(|(low, high)| ((low + high - bins as f64) / 2.0).round());
        let weights: Vec<f64> = (0..bins).map(|m| hann_at(self.radar.samples, m as f64 * every + start)).collect();
        let fft = FftPlanner::new().plan_fft_inverse(bins);
        let end_elements = self.radar.end_elements;
        let turned = first.map(|first| {
            let turned =
                |i: usize| Complex64::from_polar(all.recip(), TAU * ((first + i as f64) * start / all).fract());
            (0..bins).map(turned).collect::<Vec<_>>()
        });
        let of_channel = |(channel, spectrum): (usize, &Vec<Complex64>)| {
            let first = first[channel / end_elements] as i64;
            let mut decimated = vec![Complex64::default(); bins];
            for (bin, turned) in (first..).zip(&turned[channel / end_elements]) {
                decimated[bin.rem_euclid(bins as i64) as usize] =
                    spectrum[bin.rem_euclid(self.radar.samples as i64) as usize] * turned;
            }
            fft.process(&mut decimated);
            decimated
        };
        let windowed: Vec<Vec<Complex64>> = self.channels.par_iter().enumerate().map(of_channel).collect();
        let energy = every * windowed.iter().flatten().map(Complex64::norm_sqr).sum::<f64>();
        let flat: Vec<Complex64> =
            windowed.iter().flat_map(|samples| samples.iter().zip(&weights).map(|(v, w)| v / w)).collect();
        // A slightly higher carrier has the phase of the first sample, so that the middle of the chirp keeps its phase.
        let turns = self.radar.carrier.turns_per_wavelength();
        let carrier_hz = self.radar.carrier_hz + SPEED_OF_LIGHT * start / (turns * self.radar.max_range_metres());
        let radar = Radar { samples: bins, carrier_hz, ..self.radar.clone() };
        let fitter = self.fitter.sampled_as(&radar, weights.iter().map(|w| w * w * every).collect());
        let samples = Samples::new(&fitter.sensor, &flat);
        let intact = first.map(|first| (first + SIDE_LOBE_BINS, first + bins as f64 - SIDE_LOBE_BINS));
        RangeGate { fitter, samples, energy, intact }
    }
}

impl RangeGate<'_> {
    /// Whether all range bins of `spans` are intact.
    pub fn contains(&self, spans: &BinSpans) -> bool {
        spans.iter().zip(&self.intact).all(|(own, intact)| own.0 >= intact.0 && own.1 <= intact.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Carrier, hann};
    use crate::reconstruct::fit::atom::Atom;
    use crate::reconstruct::fit::groups::bin_spans;
    use crate::reconstruct::fit::refine::{Gains, Limits, Tie};
    use crate::scene::{Line, Object, Point, Scene};
    use crate::signal::{Floor, simulate};
    use crate::task::Task;

    /// Step from one reflector of the wall to the next, metres, and the wall's direction, degrees.
    const STEP_METRES: f64 = 0.11;
    const DIRECTION_DEGREES: f64 = 72.0;

    fn wall() -> Line {
        Line { direction_degrees: DIRECTION_DEGREES, ..Line::vertical(-4.0, 14.0, STEP_METRES, 40) }
    }

    #[test]
    fn a_fit_of_a_few_range_bins_is_that_of_all() {
        for carrier in [Carrier::OneWay, Carrier::TwoWay] {
            let radar = Radar { carrier, ..Radar::default() };
            let beside = |x, y| Object::Point(Point::new(x, y));
            let objects = vec![Object::Line(wall()), beside(1.0, 3.0), beside(9.0, 30.0)];
            let scene = Scene { objects, ..Scene::default() };
            let flat = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar).flat();
            let task = Task::default();
            let fitter = Fitter::new(&radar, &hann(radar.samples), &task, usize::MAX);
            let samples = Samples::new(&fitter.sensor, &flat);
            let (sin, cos) = DIRECTION_DEGREES.to_radians().sin_cos();
            let [dx_metres, dy_metres] = [cos, sin].map(|v| v * STEP_METRES);
            let truth = Atom::Row { x_metres: -4.0, y_metres: 14.0, dx_metres, dy_metres, count: 40 };
            let seed = truth.moved(&[0.002, -0.001, 1e-5, -2e-5]);
            let near = Spectra::new(&radar, &fitter, &samples).gate(&bin_spans(&radar, &seed), 0.0);
            assert_eq!(near.fitter.sensor.samples, 128);
            assert!(near.contains(&bin_spans(&radar, &truth)));
            assert!(!near.contains(&bin_spans(&radar, &Atom::Point { x_metres: 9.0, y_metres: 30.0 })));
            let all = fitter.energy(&samples);
            let explained = [
                all - fitter.solve_alone(&samples, seed).cost(),
                near.energy - near.fitter.solve_alone(&near.samples, seed).cost(),
            ];
            assert!((explained[1] / explained[0] - 1.0).abs() < 2e-3, "{explained:?}");
            let limits = Limits { max_steps: 20, min_decrease: 1e-4, ridge: 0.0 };
            let moved = near.fitter.refine(&near.samples, vec![seed], vec![Gains::default()], Tie::PerEnd, limits);
            for i in [0.0, 39.0] {
                let ([x, y], [true_x, true_y]) = (moved.atoms[0].position_metres(i), truth.position_metres(i));
                assert!((x - true_x).hypot(y - true_y) < 1e-3, "{carrier:?}: {:?}", moved.atoms[0]);
            }
            assert!(moved.cost() < 1e-3 * near.energy, "{} of {}", moved.cost(), near.energy);
        }
    }

    #[test]
    fn where_an_atom_fills_most_range_bins_all_are_kept() {
        let radar = Radar::default();
        let task = Task::default();
        let fitter = Fitter::new(&radar, &hann(radar.samples), &task, usize::MAX);
        let samples = Samples::new(&fitter.sensor, &vec![Complex64::from(1.0); fitter.sensor.sample_count()]);
        let near = Spectra::new(&radar, &fitter, &samples).gate(&[(100.0, 400.0); 2], 0.0);
        assert_eq!(near.samples, samples);
        assert!(near.contains(&[(-1e9, 1e9); 2]));
    }
}
