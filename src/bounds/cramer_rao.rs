//! The Cramer-Rao bound: the smallest error with which any unbiased estimator can place reflectors.
//!
//! S. M. Kay, "Fundamentals of Statistical Signal Processing: Estimation Theory", 1993, section 15.7: for samples
//! `y = s(p) + w` with white complex noise `w` of variance `v`, the Fisher information is `2/v * Re(J^H J)`, J being the
//! derivatives of `s`, and the errors of `p` have at least its inverse as covariance.

use crate::radar::{Decibels, Layout, Radar};
use crate::scene::Reflector;
use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::{Mat, Side};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Standard deviations below which no unbiased estimate of one reflector's position can stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionBound {
    /// Of the range from the array's centre, metres.
    pub range_metres: f64,
    /// Of cos(theta).
    pub cos_theta: f64,
    /// Of x, metres.
    pub x_metres: f64,
    /// Of y, metres; infinite on the array's axis, where a line array can't tell a small y from none.
    pub y_metres: f64,
    /// Covariance of the errors of x and y, square metres; 0 where `y_metres` is infinite.
    pub xy_covariance_metres2: f64,
}

impl PositionBound {
    /// Root of the mean square distance between the estimate and the reflector, metres.
    pub fn position_metres(&self) -> f64 {
        self.x_metres.hypot(self.y_metres)
    }
}

/// Why there is no bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum BoundsError {
    /// The samples don't determine every reflector's range, cos(theta) and gain.
    #[error(
        "the samples of {elements} elements don't determine {reflectors} reflectors: some coincide, have no echo, or there are too few elements"
    )]
    NotIdentifiable {
        /// Elements of the layout.
        elements: usize,
        /// Reflectors asked for.
        reflectors: usize,
    },
    /// The noise variance is not a positive number.
    #[error("the noise variance must be finite and above 0")]
    Noise,
}

/// Variance of the white complex noise that leaves this signal-to-noise ratio a sample, averaged over the samples of `layout`,
/// for `reflector` alone.
pub fn noise_variance(radar: &Radar, layout: &Layout, reflector: &Reflector, snr: Decibels) -> f64 {
    let power: f64 = layout.x_metres.iter().map(|&x| Echo::new(radar, x, reflector).amplitude.powi(2)).sum();
    power / layout.len().max(1) as f64 / snr.power_ratio()
}

/// Bounds on the position of each of `reflectors` seen together by `layout` under white complex noise of `noise_variance` a
/// sample, every reflector's range, cos(theta) and complex gain being unknown.
///
/// The gain takes in the phase of the reflection, so that the absolute carrier phase tells nothing about the range; it is one
/// for the whole layout: both ends of a sparse array hear the same reflector coherently.
///
/// # Errors
/// [`BoundsError`] when the parameters can't be told apart, or the noise is not a positive number.
pub fn cramer_rao(
    radar: &Radar,
    layout: &Layout,
    reflectors: &[Reflector],
    noise_variance: f64,
) -> Result<Vec<PositionBound>, BoundsError> {
    if !(noise_variance.is_finite() && noise_variance > 0.0) {
        return Err(BoundsError::Noise);
    }
    let information = information(radar, layout, reflectors);
    let not_identifiable = || BoundsError::NotIdentifiable { elements: layout.len(), reflectors: reflectors.len() };
    let covariance = invert(&information).ok_or_else(not_identifiable)?;
    let bound = |(l, r): (usize, &Reflector)| {
        let at = |i: usize, j: usize| noise_variance / 2.0 * covariance[(PARAMETERS * l + i, PARAMETERS * l + j)];
        let (range, cos, both) = (at(RANGE, RANGE), at(COS, COS), at(RANGE, COS));
        let polar = radar.polar_of(r.x_metres, r.y_metres);
        let sin = (1.0 - polar.cos_theta.powi(2)).max(0.0).sqrt();
        // x = range cos, y = range sin: the covariance goes through the derivatives of both.
        let y_by_cos = -polar.range_metres * polar.cos_theta / sin;
        let through = |by_range: f64, by_cos: f64| {
            (by_range.powi(2) * range + by_cos.powi(2) * cos + 2.0 * by_range * by_cos * both).max(0.0).sqrt()
        };
        PositionBound {
            range_metres: range.sqrt(),
            cos_theta: cos.sqrt(),
            x_metres: through(polar.cos_theta, polar.range_metres),
            y_metres: if sin > 0.0 { through(sin, y_by_cos) } else { f64::INFINITY },
            xy_covariance_metres2: if sin > 0.0 {
                polar.cos_theta * sin * range
                    + polar.range_metres * y_by_cos * cos
                    + (polar.cos_theta * y_by_cos + polar.range_metres * sin) * both
            } else {
                0.0
            },
        }
    };
    Ok(reflectors.iter().enumerate().map(bound).collect())
}

/// Unknowns of one reflector, in this order: range, cos(theta), real and imaginary part of the relative gain.
const PARAMETERS: usize = 4;
const RANGE: usize = 0;
const COS: usize = 1;

/// One reflector's echo at one element, and how it changes with the reflector's place.
struct Echo {
    amplitude: f64,
    carrier_turns: f64,
    turns_per_sample: f64,
    /// Relative change of the signal for a metre of distance: `decay + j (carrier_rate + beat_rate n1)`.
    decay: f64,
    carrier_rate: f64,
    beat_rate: f64,
    /// Change of the distance with range and with cos(theta).
    by: [f64; 2],
}

impl Echo {
    fn new(radar: &Radar, element_x: f64, r: &Reflector) -> Echo {
        let polar = radar.polar_of(r.x_metres, r.y_metres);
        let distance = (r.x_metres - element_x).hypot(r.y_metres);
        let carrier = radar.carrier.turns_per_wavelength() / radar.wavelength_metres();
        let beat = 1.0 / radar.max_range_metres();
        Echo {
            amplitude: radar.transmit_power_watts * r.reflectivity / distance.powi(2),
            carrier_turns: (carrier * distance).fract(),
            turns_per_sample: (beat * distance).fract(),
            decay: -2.0 / distance,
            carrier_rate: TAU * carrier,
            beat_rate: TAU * beat,
            // distance^2 = range^2 - 2 range x cos + x^2
            by: [
                (polar.range_metres - element_x * polar.cos_theta) / distance,
                -polar.range_metres * element_x / distance,
            ],
        }
    }

    fn signal(&self, sample: usize) -> Complex64 {
        Complex64::from_polar(self.amplitude, TAU * (self.carrier_turns + self.turns_per_sample * sample as f64))
    }

    fn relative_change(&self, sample: f64, parameter: usize) -> Complex64 {
        Complex64::new(self.decay, self.carrier_rate + self.beat_rate * sample) * self.by[parameter]
    }
}

/// `Re(J^H J)` over every sample, `[4 L, 4 L]`.
///
/// Each reflector's derivatives by range and cos(theta) are taken orthogonal to its own signal. That only says the gain by
/// other numbers, so the bound on the position stays as it is, and keeps the matrix well conditioned: the carrier turns 250
/// times for each metre, and all of that belongs to the unknown gain.
fn information(radar: &Radar, layout: &Layout, reflectors: &[Reflector]) -> Mat<f64> {
    let echoes: Vec<Vec<Echo>> =
        reflectors.iter().map(|r| layout.x_metres.iter().map(|&x| Echo::new(radar, x, r)).collect()).collect();
    let middle = (radar.samples as f64 - 1.0) / 2.0;
    let own: Vec<[Complex64; 2]> = echoes
        .iter()
        .map(|elements| {
            let power: f64 = elements.iter().map(|e| e.amplitude.powi(2)).sum();
            [RANGE, COS].map(|p| {
                let weighted: Complex64 =
                    elements.iter().map(|e| e.relative_change(middle, p) * e.amplitude.powi(2)).sum();
                weighted / power
            })
        })
        .collect();

    let size = PARAMETERS * reflectors.len();
    let mut information = Mat::zeros(size, size);
    let mut row = vec![Complex64::default(); size];
    for element in 0..layout.len() {
        for sample in 0..radar.samples {
            for (l, (elements, own)) in echoes.iter().zip(&own).enumerate() {
                let echo = &elements[element];
                let signal = echo.signal(sample);
                row[PARAMETERS * l + RANGE] = signal * (echo.relative_change(sample as f64, RANGE) - own[RANGE]);
                row[PARAMETERS * l + COS] = signal * (echo.relative_change(sample as f64, COS) - own[COS]);
                row[PARAMETERS * l + 2] = signal;
                row[PARAMETERS * l + 3] = Complex64::I * signal;
            }
            for i in 0..size {
                for j in 0..=i {
                    information[(i, j)] += row[i].re * row[j].re + row[i].im * row[j].im;
                }
            }
        }
    }
    information
}

/// Inverse of a symmetric matrix given by its lower half, `None` when it is not safely positive definite.
fn invert(matrix: &Mat<f64>) -> Option<Mat<f64>> {
    // Unit diagonal first: the parameters have different units.
    let scale: Vec<f64> = (0..matrix.nrows()).map(|i| matrix[(i, i)].sqrt().recip()).collect();
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let unit = Mat::from_fn(matrix.nrows(), matrix.nrows(), |i, j| matrix[(i.max(j), i.min(j))] * scale[i] * scale[j]);
    let inverse = Llt::new(unit.as_ref(), Side::Lower).ok()?.inverse();
    let largest = (0..inverse.nrows()).map(|i| inverse[(i, i)]).fold(0.0, f64::max);
    // An inverse this large is rounding error: 1/largest is at most the smallest eigenvalue times the size.
    (largest < 1e12)
        .then(|| Mat::from_fn(inverse.nrows(), inverse.nrows(), |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::End;

    fn at(range: f64, cos: f64) -> Reflector {
        Reflector { x_metres: range * cos, y_metres: range * (1.0 - cos * cos).sqrt(), reflectivity: 1.0 }
    }

    fn alone(layout: &Layout, r: Reflector) -> PositionBound {
        let radar = Radar::default();
        cramer_rao(&radar, layout, &[r], noise_variance(&radar, layout, &r, Decibels(0.0))).unwrap()[0]
    }

    /// Bounds on range, metres, and on cos(theta) at 0 dB a sample, by differences of the samples as the formula of a point has them, each
    /// taken orthogonal to the samples themselves: what stands along them belongs to the unknown gain.
    fn by_differences(radar: &Radar, layout: &Layout, range: f64, cos: f64) -> [f64; 2] {
        let samples = |range: f64, cos: f64| -> Vec<Complex64> {
            let (x, y) = (range * cos, range * (1.0 - cos * cos).sqrt());
            let of_element = |element: &f64| {
                let distance = (x - element).hypot(y);
                let amplitude = radar.transmit_power_watts / (distance * distance);
                (0..radar.samples).map(move |n| {
                    let beat = n as f64 / radar.samples as f64 * distance / radar.range_resolution_metres();
                    Complex64::from_polar(amplitude, TAU * (beat - distance / radar.wavelength_metres()))
                })
            };
            layout.x_metres.iter().flat_map(of_element).collect()
        };
        let product = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| a.conj() * b).sum::<Complex64>();
        let own = samples(range, cos);
        let power = product(&own, &own).re;
        let step = 1e-6;
        let change = |after: Vec<Complex64>, before: Vec<Complex64>| -> Vec<Complex64> {
            let change: Vec<_> = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * step)).collect();
            let along = product(&own, &change) / power;
            change.iter().zip(&own).map(|(c, o)| c - o * along).collect()
        };
        let by_range = change(samples(range + step, cos), samples(range - step, cos));
        let by_cos = change(samples(range, cos + step), samples(range, cos - step));
        // At 0 dB the noise has the mean power of a sample.
        let weight = 2.0 * own.len() as f64 / power;
        let [rr, rc, cc] =
            [(&by_range, &by_range), (&by_range, &by_cos), (&by_cos, &by_cos)].map(|(a, b)| weight * product(a, b).re);
        let determinant = rr * cc - rc * rc;
        [(cc / determinant).sqrt(), (rr / determinant).sqrt()]
    }

    #[test]
    fn the_bound_is_that_of_the_samples_differences() {
        let radar = Radar::default();
        for layout in [Layout::two_ends(&radar), Layout::one_end(&radar, End::First), Layout::uniform(&radar)] {
            let [range_metres, cos_theta] = by_differences(&radar, &layout, 20.0, 0.3);
            let bound = alone(&layout, at(20.0, 0.3));
            assert!((bound.range_metres / range_metres - 1.0).abs() < 1e-3, "{bound:?}, {range_metres}");
            assert!((bound.cos_theta / cos_theta - 1.0).abs() < 1e-3, "{bound:?}, {cos_theta}");
        }
        // Figures of an independent program, to the digits that it gave.
        let two_ends = alone(&Layout::two_ends(&radar), at(20.0, 0.3));
        assert_eq!(format!("{:.2} mm", 1e3 * two_ends.range_metres), "0.26 mm");
        assert_eq!(format!("{:.4} columns", 512.0 * two_ends.cos_theta), "0.0021 columns");
    }

    #[test]
    fn far_ahead_the_closed_forms_hold() {
        // Ahead of a symmetric layout range and cos(theta) part: the first is the frequency of a line in M N samples with unknown
        // phase (Rife and Boorstyn, 1974), the second a phase slope over the elements.
        let radar = Radar::default();
        let layout = Layout::two_ends(&radar);
        let bound = alone(&layout, at(1e4, 0.0));
        let (elements, samples) = (layout.len() as f64, radar.samples as f64);
        let frequency = (6.0 / (elements * samples * (samples * samples - 1.0))).sqrt();
        let range = frequency * radar.max_range_metres() / TAU;
        assert!((bound.range_metres / range - 1.0).abs() < 1e-3, "{} {range}", bound.range_metres);
        // The chirp's own phase runs against the carrier's: in the middle of the chirp it takes 2.6 % off the wave number.
        let wave_number = TAU / radar.wavelength_metres() - TAU * (samples - 1.0) / 2.0 / radar.max_range_metres();
        let spread: f64 = layout.x_metres.iter().map(|x| x * x).sum();
        let cos = (1.0 / (2.0 * samples * wave_number * wave_number * spread)).sqrt();
        assert!((bound.cos_theta / cos - 1.0).abs() < 1e-3, "{} {cos}", bound.cos_theta);
        assert!((bound.x_metres / (1e4 * cos) - 1.0).abs() < 1e-3, "x is range times cos");
        assert_eq!(bound.y_metres, bound.range_metres, "y is the range ahead of the array");
    }

    #[test]
    fn the_covariance_of_x_and_y_gives_the_range_back() {
        let bound = alone(&Layout::two_ends(&Radar::default()), at(15.0, 0.6));
        let (cos, sin) = (0.6, 0.8);
        let along = cos * cos * bound.x_metres.powi(2)
            + sin * sin * bound.y_metres.powi(2)
            + 2.0 * cos * sin * bound.xy_covariance_metres2;
        assert!((along.sqrt() / bound.range_metres - 1.0).abs() < 1e-6, "{bound:?}");
    }

    #[test]
    fn noise_scales_it_and_gain_does_not() {
        let radar = Radar::default();
        let layout = Layout::two_ends(&radar);
        let r = at(12.0, -0.4);
        let at_20_db = noise_variance(&radar, &layout, &r, Decibels(20.0));
        let bound = cramer_rao(&radar, &layout, &[r], at_20_db).unwrap()[0];
        assert!((alone(&layout, r).range_metres / bound.range_metres - 10.0).abs() < 1e-6);
        let faint = Reflector { reflectivity: 1e-20, ..r };
        let same = cramer_rao(&radar, &layout, &[faint], at_20_db * 1e-40).unwrap()[0];
        assert!((same.position_metres() / bound.position_metres() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_neighbour_costs_accuracy_only_when_near() {
        let radar = Radar::default();
        let layout = Layout::two_ends(&radar);
        let r = at(20.0, 0.1);
        let variance = noise_variance(&radar, &layout, &r, Decibels(0.0));
        let beside = |neighbour| cramer_rao(&radar, &layout, &[r, neighbour], variance).unwrap()[0].cos_theta;
        let alone = alone(&layout, r).cos_theta;
        let far = beside(at(30.0, -0.5)) / alone;
        assert!((far - 1.0).abs() < 0.01, "{far}");
        let near = beside(at(20.0, 0.1002)) / alone;
        assert!(near > 1.5, "{near}");
        assert!(beside(at(20.0, 0.1001)) / alone > near, "nearer is worse");
    }

    #[test]
    fn what_can_not_be_told_apart_is_an_error() {
        let radar = Radar::default();
        let layout = Layout::two_ends(&radar);
        let r = at(20.0, 0.1);
        for (layout, reflectors) in [
            (&layout, vec![r, r]),
            (&Layout { x_metres: vec![0.0] }, vec![r]),
            (&Layout { x_metres: Vec::new() }, vec![r]),
            (&layout, vec![Reflector { reflectivity: 0.0, ..r }]),
        ] {
            let error = cramer_rao(&radar, layout, &reflectors, 1.0).unwrap_err();
            assert!(matches!(error, BoundsError::NotIdentifiable { .. }), "{error}");
        }
        assert_eq!(cramer_rao(&radar, &layout, &[], 1.0), Ok(Vec::new()));
        assert_eq!(cramer_rao(&radar, &layout, &[r], 0.0), Err(BoundsError::Noise));
        let beside = cramer_rao(&radar, &layout, &[at(20.0, 1.0)], 1.0).unwrap()[0];
        assert!(beside.y_metres.is_infinite() && beside.x_metres.is_finite());
    }
}
