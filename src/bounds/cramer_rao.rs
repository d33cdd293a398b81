//! The Cramer-Rao bound: the smallest error with which any unbiased estimator can place reflectors.
//!
//! S. M. Kay, "Fundamentals of Statistical Signal Processing: Estimation Theory", 1993, section 15.7: for samples
//! `y = s(p) + w` with white complex noise `w` of variance `v`, the Fisher information is `2/v * Re(J^H J)`, J being the
//! derivatives of `s`, and the errors of `p` have at least its inverse as covariance (chapter 3 for real samples and for what follows
//! from parameters by a function of them).
//!
//! Biased estimators, such as those with prior knowledge of the scene, may have smaller errors.

use crate::radar::{Decibels, Layout, Pair, Radar};
use crate::scene::Reflector;
use crate::signal::path::{PathChange, PolarCoordinate};
use crate::signal::phase::{Echo, EchoModel};
use faer::linalg::solvers::{DenseSolveCore, Llt};
use faer::{Mat, Side};
use num_complex::Complex64;

/// Standard deviations below which no unbiased estimate of one reflector's position can stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionBound {
    /// Standard deviation of the range from the array's centre, metres.
    pub range_metres: f64,
    /// Standard deviation of cos(theta).
    pub cos_theta: f64,
    /// Standard deviation of x, metres.
    pub x_metres: f64,
    /// Standard deviation of y, metres; infinite on the array's axis, where a line array can't tell a small y from none.
    pub y_metres: f64,
    /// Covariance of the errors of x and y, square metres; 0 where `y_metres` is infinite.
    pub xy_covariance_metres2: f64,
    /// Relative standard deviation of the amplitude (reflectivity), the place being estimated too; with a gain an end, of the mean of both.
    pub amplitude: f64,
}

/// The unknown gains with which elements receive a reflector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gains {
    /// One complex gain a reflector: all elements receive it coherently, the two ends of a sparse array included.
    #[default]
    One,
    /// One complex gain a reflector for each side of the array's middle: the phase between the ends of a sparse array is unknown.
    PerEnd,
}

impl PositionBound {
    /// Root of the mean square distance between the estimate and the reflector, metres.
    pub fn position_metres(&self) -> f64 {
        self.x_metres.hypot(self.y_metres)
    }

    /// [`PositionBound::amplitude`] in decibels, to first order.
    pub fn amplitude_db(&self) -> f64 {
        20.0 / std::f64::consts::LN_10 * self.amplitude
    }
}

type PositionBounds = Result<Vec<PositionBound>, BoundsError>;

/// A reason for which there is no bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum BoundsError {
    #[error(
        "the samples of {elements} elements don't determine {reflectors} reflectors: some coincide, have no echo, or there are too few elements"
    )]
    NotIdentifiable { elements: usize, reflectors: usize },
    #[error("the noise variance must be finite and above 0")]
    Noise,
}

/// Variance of the white complex noise that leaves `reflector` alone this signal-to-noise ratio a sample, averaged over `layout`.
pub fn noise_variance(radar: &Radar, layout: &Layout, reflector: &Reflector, snr: Decibels) -> f64 {
    let model = EchoModel::new(radar);
    let power: f64 = layout.pairs().into_iter().map(|pair| model.echo(pair, reflector).amplitude.powi(2)).sum();
    power / layout.len().max(1) as f64 / snr.power_ratio()
}

/// Bounds on the position of each of `reflectors` seen together by `layout` under white complex noise of `noise_variance` a
/// sample, every reflector's range, cos(theta) and complex gain being unknown.
///
/// The gain takes in the phase of the reflection, so that the absolute carrier phase tells nothing about the range; it is one
/// for the whole layout: both ends of a sparse array receive the same reflector coherently. [`cramer_rao_of`] bounds it where they don't.
/// # Errors
/// [`BoundsError`] when the parameters can't be distinguished, or the noise is not a positive number.
pub fn cramer_rao(radar: &Radar, layout: &Layout, reflectors: &[Reflector], noise_variance: f64) -> PositionBounds {
    cramer_rao_of(radar, layout, reflectors, noise_variance, Gains::One)
}

/// [`cramer_rao`] with one or several unknown gains a reflector.
/// # Errors
/// [`BoundsError`] when the parameters can't be distinguished, or the noise is not a positive number.
pub fn cramer_rao_of(
    radar: &Radar,
    layout: &Layout,
    reflectors: &[Reflector],
    noise_variance: f64,
    gains: Gains,
) -> PositionBounds {
    if !(noise_variance.is_finite() && noise_variance > 0.0) {
        return Err(BoundsError::Noise);
    }
    let model = Model::new(radar, layout, reflectors, gains);
    let not_identifiable = || BoundsError::NotIdentifiable { elements: layout.len(), reflectors: reflectors.len() };
    let covariance = invert(&model.information(radar)).ok_or_else(not_identifiable)?;
    let bound = |(l, r): (usize, &Reflector)| {
        let first = model.parameters() * l;
        let at = |i: usize, j: usize| noise_variance / 2.0 * covariance[(first + i, first + j)];
        let (range, cos, both) = (at(RANGE, RANGE), at(COS, COS), at(RANGE, COS));
        let weights = model.amplitude_weights(l);
        let pairs = weights.iter().flat_map(|a| weights.iter().map(move |b| (a, b)));
        let amplitude: f64 = pairs.map(|((i, a), (j, b))| a * b * at(*i, *j)).sum();
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
            amplitude: amplitude.max(0.0).sqrt(),
        }
    };
    Ok(reflectors.iter().enumerate().map(bound).collect())
}

/// Unknowns of one reflector, in this order: range, cos(theta), real and imaginary part of each relative gain.
const RANGE: usize = 0;
const COS: usize = 1;
const GAIN: usize = 2;

struct PlacedEcho {
    echo: Echo,
    by: [PathChange; 2],
    carrier_turns_per_metre: f64,
    beat_turns_per_metre: f64,
}

impl PlacedEcho {
    fn new(radar: &Radar, model: &EchoModel, pair: Pair, r: &Reflector) -> Self {
        PlacedEcho {
            echo: model.echo(pair, r),
            by: [PolarCoordinate::Range, PolarCoordinate::CosTheta].map(|by| {
                let place = [r.x_metres, r.y_metres];
                PathChange::of_point(pair, place, by).through(radar.pattern(), pair, place, by)
            }),
            carrier_turns_per_metre: radar.carrier_turns_per_metre(),
            beat_turns_per_metre: radar.beat_turns_per_metre(1.0),
        }
    }

    fn relative_change(&self, sample: f64, parameter: usize) -> Complex64 {
        self.by[parameter].of_sample(self.carrier_turns_per_metre + self.beat_turns_per_metre * sample)
    }
}

/// Echoes of all reflectors at all elements, and the index of each element's gain.
///
/// Each reflector's derivatives by range and cos(theta) are made orthogonal to its own signal. This only reparametrises the gains, so the
/// bound on the position is unchanged. It keeps the matrix well conditioned: the carrier's hundreds of turns a metre belong to the gain.
struct Model {
    /// Echoes, `[reflectors][elements]`.
    echoes: Vec<Vec<PlacedEcho>>,
    /// Index of each element's gain, from 0.
    group: Vec<usize>,
    groups: usize,
    /// Mean relative change by range and by cos(theta), `[reflectors][gains]`: the part that the gains take up.
    own: Vec<Vec<[Complex64; 2]>>,
}

impl Model {
    fn new(radar: &Radar, layout: &Layout, reflectors: &[Reflector], gains: Gains) -> Model {
        let model = EchoModel::new(radar);
        let pairs = layout.pairs();
        let of_one = |r: &Reflector| pairs.iter().map(|pair| PlacedEcho::new(radar, &model, *pair, r)).collect();
        let echoes: Vec<Vec<PlacedEcho>> = reflectors.iter().map(of_one).collect();
        let has_both = layout.x_metres.iter().any(|x| *x < 0.0) && layout.x_metres.iter().any(|x| *x >= 0.0);
        let parts = gains == Gains::PerEnd && has_both;
        let group: Vec<usize> = layout.x_metres.iter().map(|x| usize::from(parts && *x >= 0.0)).collect();
        let groups = if parts { 2 } else { 1 };
        let middle = (radar.samples as f64 - 1.0) / 2.0;
        let own_of = |elements: &Vec<PlacedEcho>, g: usize| {
            let of_group = || elements.iter().zip(&group).filter(|(_, of)| **of == g).map(|(e, _)| e);
            let power: f64 = of_group().map(|e| e.echo.amplitude.powi(2)).sum();
            [RANGE, COS].map(|p| {
                let weighted: Complex64 =
                    of_group().map(|e| e.relative_change(middle, p) * e.echo.amplitude.powi(2)).sum();
                weighted / power
            })
        };
        let own = echoes.iter().map(|elements| (0..groups).map(|g| own_of(elements, g)).collect()).collect();
        Model { echoes, group, groups, own }
    }

    fn parameters(&self) -> usize {
        GAIN + 2 * self.groups
    }

    /// Relative error of reflector `l`'s amplitude: index and weight of parameters' errors. Reverts the derivatives' orthogonalisation.
    fn amplitude_weights(&self, l: usize) -> Vec<(usize, f64)> {
        let part = 1.0 / self.groups as f64;
        let own = |p: usize| self.own[l].iter().map(|own| part * own[p].re).sum::<f64>();
        let gains = (0..self.groups).map(|g| (GAIN + 2 * g, part));
        [(RANGE, -own(RANGE)), (COS, -own(COS))].into_iter().chain(gains).collect()
    }

    /// `Re(J^H J)` over every sample, in its lower half.
    fn information(&self, radar: &Radar) -> Mat<f64> {
        let each = self.parameters();
        let size = each * self.echoes.len();
        let mut information = Mat::zeros(size, size);
        let mut row = vec![Complex64::default(); size];
        for (element, group) in self.group.iter().enumerate() {
            row.fill(Complex64::default());
            for sample in 0..radar.samples {
                for (l, (elements, own)) in self.echoes.iter().zip(&self.own).enumerate() {
                    let echo = &elements[element];
                    let signal = echo.echo.sample(sample);
                    for p in [RANGE, COS] {
                        row[each * l + p] = signal * (echo.relative_change(sample as f64, p) - own[*group][p]);
                    }
                    row[each * l + GAIN + 2 * group] = signal;
                    row[each * l + GAIN + 2 * group + 1] = Complex64::I * signal;
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
mod tests;
